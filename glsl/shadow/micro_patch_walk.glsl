// The walk over the micro-patches between a receiver and a light: which texels of the shadow maps may cover the light, at
// which step they are visited, and how neighbours close the gaps between them.
//
// Techniques define add_patch() and patches_suffice(), and before they include this what glsl/shadow/patch_box.glsl asks for and
//   PATCH_SPREAD  see micro_patch().
#ifndef LIMN_MICRO_PATCH_WALK_GLSL
#define LIMN_MICRO_PATCH_WALK_GLSL
#include "glsl/shadow/patch_box.glsl"

// Takes in a patch that blocks where found.blocks, its left and lower sides moved to the neighbours there.
void add_patch(PatchProjection projection, MicroPatch found);
// Whether no further patch can change the answer.
bool patches_suffice();

// The cells of a walk, each of 2^level texels.
struct PatchCells {
  PatchProjection projection;
  AlignedPatches aligned;  // where patches_aligned()
  int level;
};

// The patch of the texel in the middle of a cell.
MicroPatch fetched_patch(ShadowCursor cursor, PatchCells cells, PatchLine column, PatchLine row) {
  float stored = texelFetch(shadow_depth, ivec3(column.texel, row.texel, cursor.layer), 0).r;
  float z = shadow_metres(cursor.view, stored);
  MicroPatch found;
  if (patches_aligned()) {
    found = aligned_patch(cells.aligned, cursor.view.projection, column, row, z);
  } else {
    vec2 centre = vec2(column.texel, row.texel) + 0.5;
    found = micro_patch(cells.projection, centre, float(1 << cells.level), z, PATCH_SPREAD);
  }
  found.blocks = found.blocks && stored < 1.0;
  return found;
}

void walk_box(ShadowCursor cursor, PatchProjection projection, AlignedPatches aligned, TexelBox box) {
  PatchCells cells;
  cells.projection = projection;
  cells.aligned = aligned;
  cells.level = box_level(box, patches - 1);
  ivec2 low = box.low >> cells.level;
  // One more cell: what it covers between itself and its neighbour.
  ivec2 high = min((box.high >> cells.level) + 1, ivec2(cursor.view.size - 1u) >> cells.level);
  int y = low.y;
  do {
    PatchLine rows[strip + 1];
    for (int i = 0; i <= strip; ++i) rows[i] = cell_row(cursor, aligned, cells.level, y + i - 1);
    PatchLine column = cell_column(cursor, aligned, cells.level, low.x - 1);
    float left[strip];  // where the neighbours of each row end
    for (int i = 0; i < strip; ++i) {
      MicroPatch beside = fetched_patch(cursor, cells, column, rows[i + 1]);
      left[i] = beside.blocks && low.x > 0 ? beside.high.x : no_neighbour;
    }
    int x = low.x;
    do {
      column = cell_column(cursor, aligned, cells.level, x);
      MicroPatch beside = fetched_patch(cursor, cells, column, rows[0]);
      float below = beside.blocks && y > 0 ? beside.high.y : no_neighbour;
      for (int i = 0; i < strip; ++i) {
        MicroPatch own = fetched_patch(cursor, cells, column, rows[i + 1]);
        MicroPatch found = own;
        found.blocks = own.blocks && y + i <= high.y;
        found.low.x = side_or_neighbour(own.low.x, own.high.x, left[i]);
        found.low.y = side_or_neighbour(own.low.y, own.high.y, below);
        add_patch(projection, found);
        left[i] = own.blocks ? own.high.x : no_neighbour;
        below = own.blocks ? own.high.y : no_neighbour;
      }
    } while (++x <= high.x);
    y += strip;
  } while (y <= high.y && !patches_suffice());
}

// search_lit or search_umbra where the min-max pyramid is certain, else search_partial: then all patches that may matter
// have been added.
int walk_patches(inout ShadowCursor cursor, VisibilityQuery q) {
  float gap = shadow_near_gap(cursor, q);
  uint faces = shadow_face_count(q.maps.faces);
  TexelBox box;
  PatchProjection projection;
  AlignedPatches aligned;
  bool lit = true;
  bool umbra = true;
  uint face = 0u;
  do {  // conditions come last: software renderers run a loop's body once more where they come first
    bool all;
    bool some = blocker_box(cursor, q, face, gap, box, projection, aligned, all);
    lit = lit && !some;
    umbra = umbra && all;
  } while (++face < faces);
  if (lit) return search_lit;
  if (umbra) return search_umbra;
  face = 0u;
  do {
    bool some = true;
    bool all;
    // What a single view gave is still there.
    if (faces > 1u) some = blocker_box(cursor, q, face, gap, box, projection, aligned, all);
    if (some) walk_box(cursor, projection, aligned, box);
  } while (++face < faces);
  return search_partial;
}

#endif  // LIMN_MICRO_PATCH_WALK_GLSL
