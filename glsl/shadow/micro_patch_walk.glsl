// The walk over the micro-patches between a receiver and a light: which texels of the shadow maps may cover the light, at
// which step they are visited, and how neighbours close the gaps between them.
//
// Techniques define add_patch() and patches_suffice(), and before they include this
//   DISC_SIDE     side of the square that a directional light's disc is drawn in, in its diameters;
//   PATCH_SPREAD  see micro_patch();
//   LIMN_PATCH_UNION  1: a patch keeps its own sides where a neighbour overlaps it, 0: it ends where the neighbour does
//                     (what several patches of one row cover beyond their neighbours still counts more than once).
#ifndef LIMN_MICRO_PATCH_WALK_GLSL
#define LIMN_MICRO_PATCH_WALK_GLSL
#include "glsl/shadow/aligned_patches.glsl"
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/micro_patches.glsl"

uniform int patches;        // along each side of a kernel, at most
uniform int search_rounds;  // of narrow_box, at most

// Whether the map's axes are the light's, so that patches are those of glsl/shadow/aligned_patches.glsl: a rectangle or a disc
// that one view along its axis sees.
bool patches_aligned() {
#if defined(SHADOW_FACES) && defined(LIGHT_KIND)
  return uint(SHADOW_FACES) == shadow_faces_single &&
         (uint(LIGHT_KIND) == light_kind_rectangle || uint(LIGHT_KIND) == light_kind_disc);
#else
  return false;
#endif
}

// Takes in a patch that blocks where found.blocks, its left and lower sides moved to the neighbours there.
void add_patch(PatchProjection projection, MicroPatch found);
// Whether no further patch can change the answer.
bool patches_suffice();

const float no_neighbour = 3.0e38;  // where one ends that does not block

// A patch's left or lower side (its own are `low` and `high`), moved to where the neighbour ends if that blocks, too: no
// light leaks between texels of one blocker, and without LIMN_PATCH_UNION what both cover counts once.
float side_or_neighbour(float low, float high, float neighbour) {
#if LIMN_PATCH_UNION
  return min(neighbour, low);
#else
  return neighbour < no_neighbour ? min(neighbour, high) : low;
#endif
}

// Texels low..high of a map, both included.
struct TexelBox {
  ivec2 low;
  ivec2 high;
};

// The least level at which no side of the box takes more than `most` cells.
int box_level(TexelBox box, int most) {
  ivec2 extent = box.high - box.low;
  int level = findMSB(uint(max(max(extent.x, extent.y) / most, 1)));
  for (int i = 0; i < 2; ++i) {
    ivec2 cells = (box.high >> level) - (box.low >> level);
    if (max(cells.x, cells.y) >= most) ++level;
  }
  return level;
}

// The places between which a cell of a pyramid level lies along an axis; the last one reaches to the map's edge.
ivec2 cell_ends(int at, int last, int level, int size) {
  return ivec2(at << level, at == last ? size : (at + 1) << level);
}

// Narrows the box to the cells of a pyramid level, at most 4 x 4, in which something may block; gap: the widest of it.
// False: there are none.
bool narrow_box(ShadowCursor cursor, PatchProjection projection, AlignedPatches aligned, inout TexelBox box,
                inout float gap) {
  int size = int(cursor.view.size);
  int level = min(box_level(box, 4), textureQueryLevels(shadow_min_max) - 1);
  int last = max(size >> level, 1) - 1;
  ivec2 from = min(box.low >> level, ivec2(last));
  ivec2 to = min(box.high >> level, ivec2(last));
  ivec2 low = ivec2(size);
  ivec2 high = ivec2(-1);
  float widest = 0.0;
  int y = from.y;
  do {
    ivec2 across = cell_ends(y, last, level, size);
    PatchSpan rows = patch_span(aligned, 1, float(across.x), float(across.y));
    int x = from.x;
    do {
      ivec2 along = cell_ends(x, last, level, size);
      vec2 stored = texelFetch(shadow_min_max, ivec3(x, y, cursor.layer), level).xy;
      vec2 z = vec2(shadow_metres(cursor.view, stored.x), shadow_metres(cursor.view, stored.y));
      float reach;
      bool blocks;
      if (patches_aligned()) {
        PatchSpan columns = patch_span(aligned, 0, float(along.x), float(along.y));
        blocks = aligned_patches_may_block(aligned, cursor.view.projection, columns, rows, z, reach);
      } else {
        vec2 first = vec2(along.x, across.x);
        blocks = patches_may_block(projection, first, vec2(along.y, across.y), z, reach);
      }
      blocks = blocks && stored.x < 1.0;
      low = blocks ? min(low, ivec2(along.x, across.x)) : low;
      high = blocks ? max(high, ivec2(along.y, across.y) - 1) : high;
      widest = blocks ? max(widest, reach) : widest;
    } while (++x <= to.x);
  } while (++y <= to.y);
  gap = min(gap, widest);
  box = TexelBox(max(box.low, low), min(box.high, high));
  return high.x >= 0;
}

// The texels of one face in which something may block: of the kernel at the near plane, then narrowed by ever finer
// levels of the pyramid. False: there are none. umbra: all texels of the kernel at the widest gap block.
bool blocker_box(inout ShadowCursor cursor, VisibilityQuery q, uint face, float gap, out TexelBox box,
                 out PatchProjection projection, out AlignedPatches aligned, out bool umbra) {
  umbra = true;
  ShadowKernel kernel;
  if (!shadow_kernel_in_face(cursor, q, face, gap, least_kernel_width, kernel)) return false;
  vec2 size = vec2(cursor.view.size);
  box.low = ivec2(floor(clamp(kernel.low, vec2(0.0), size)));
  box.high = ivec2(ceil(clamp(kernel.high, vec2(0.0), size))) - 1;
  umbra = false;
  if (any(greaterThan(box.low, box.high))) return false;
  projection = patch_projection(cursor.view, cursor.receiver, q.light, q.position, DISC_SIDE);
  aligned = aligned_patches(projection, cursor.view.projection);
  for (int round = 0; round < search_rounds; ++round) {
    ivec2 former = box.high - box.low;
    if (!narrow_box(cursor, projection, aligned, box, gap)) return false;
    ivec2 extent = box.high - box.low;
    if (4 * max(extent.x, extent.y) >= 3 * max(former.x, former.y)) break;
  }
  if (!shadow_kernel_in_face(cursor, q, face, gap, least_kernel_width, kernel)) return false;
  ShadowKernel centres = kernel_centres(cursor, kernel);
  umbra = kernel_depth_bounds(cursor, kernel).y <
          map_threshold_range(cursor.view, cursor.in_map, centres.low, centres.high).x;
  return true;
}

// The cells of a walk, each of 2^level texels.
struct PatchCells {
  PatchProjection projection;
  AlignedPatches aligned;  // where patches_aligned()
  int level;
};

// The texel in the middle of cell `at` along an axis. Patches are placed where it is, half a texel beside the middle of a
// wider cell: elsewhere its depth is not the surface's, and slopes shadow themselves.
int cell_texel(ShadowCursor cursor, PatchCells cells, int at) {
  int cell = 1 << cells.level;
  return clamp((at << cells.level) + (cell >> 1), 0, int(cursor.view.size) - 1);
}

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

PatchLine cell_column(ShadowCursor cursor, PatchCells cells, int x) {
  return patch_line(cells.aligned, 0, cell_texel(cursor, cells, x), float(1 << cells.level));
}

PatchLine cell_row(ShadowCursor cursor, PatchCells cells, int y) {
  return patch_line(cells.aligned, 1, cell_texel(cursor, cells, y), float(1 << cells.level));
}

const int strip = 5;  // rows that are walked together: the one below them is fetched once

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
    for (int i = 0; i <= strip; ++i) rows[i] = cell_row(cursor, cells, y + i - 1);
    PatchLine column = cell_column(cursor, cells, low.x - 1);
    float left[strip];  // where the neighbours of each row end
    for (int i = 0; i < strip; ++i) {
      MicroPatch beside = fetched_patch(cursor, cells, column, rows[i + 1]);
      left[i] = beside.blocks && low.x > 0 ? beside.high.x : no_neighbour;
    }
    int x = low.x;
    do {
      column = cell_column(cursor, cells, x);
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
  for (uint face = 0u; face < faces; ++face) {
    bool all;
    bool some = blocker_box(cursor, q, face, gap, box, projection, aligned, all);
    lit = lit && !some;
    umbra = umbra && all;
  }
  if (lit) return search_lit;
  if (umbra) return search_umbra;
  for (uint face = 0u; face < faces; ++face) {
    bool some = true;
    bool all;
    // What a single view gave is still there.
    if (faces > 1u) some = blocker_box(cursor, q, face, gap, box, projection, aligned, all);
    if (some) walk_box(cursor, projection, aligned, box);
  }
  return search_partial;
}

#endif  // LIMN_MICRO_PATCH_WALK_GLSL
