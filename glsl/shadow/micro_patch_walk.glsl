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
#include "glsl/shadow/blocker_search.glsl"
#include "glsl/shadow/micro_patches.glsl"

uniform int patches;        // along each side of a kernel, at most
uniform int search_rounds;  // of narrow_box, at most

// Takes in a patch that blocks where found.blocks, its left and lower sides moved to the neighbours there.
void add_patch(PatchProjection projection, MicroPatch found);
// Whether no further patch can change the answer.
bool patches_suffice();

// A patch's left or lower side (its own are `low` and `high`), moved to where the neighbour ends if that blocks, too: no
// light leaks between texels of one blocker, and without LIMN_PATCH_UNION what both cover counts once.
float side_or_neighbour(float low, float high, bool blocks, float neighbour) {
#if LIMN_PATCH_UNION
  return blocks ? min(neighbour, low) : low;
#else
  return blocks ? min(neighbour, high) : low;
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
  int level = max(findMSB(uint(max(extent.x, extent.y) / most)), 0);
  for (int i = 0; i < 2; ++i) {
    ivec2 cells = (box.high >> level) - (box.low >> level);
    if (max(cells.x, cells.y) >= most) ++level;
  }
  return level;
}

// Narrows the box to the cells of a pyramid level, at most 4 x 4, in which something may block; gap: the widest of it.
// False: there are none.
bool narrow_box(ShadowCursor cursor, PatchProjection projection, inout TexelBox box, inout float gap) {
  int size = int(cursor.view.size);
  int level = min(box_level(box, 4), textureQueryLevels(shadow_min_max) - 1);
  ivec2 last = ivec2(max(size >> level, 1) - 1);
  ivec2 from = min(box.low >> level, last);
  ivec2 to = min(box.high >> level, last);
  ivec2 low = ivec2(size);
  ivec2 high = ivec2(-1);
  float widest = 0.0;
  for (int y = from.y; y <= to.y; ++y) {
    for (int x = from.x; x <= to.x; ++x) {
      ivec2 at = ivec2(x, y);
      // The last cells reach to the map's edge.
      ivec2 a = at << level;
      ivec2 b = mix((at + 1) << level, ivec2(size), equal(at, last));
      vec2 stored = texelFetch(shadow_min_max, ivec3(at, cursor.layer), level).xy;
      vec2 z = vec2(shadow_metres(cursor.view, stored.x), shadow_metres(cursor.view, stored.y));
      float reach;
      bool blocks = patches_may_block(projection, vec2(a), vec2(b), z, reach) && stored.x < 1.0;
      low = blocks ? min(low, a) : low;
      high = blocks ? max(high, b - 1) : high;
      widest = blocks ? max(widest, reach) : widest;
    }
  }
  gap = min(gap, widest);
  box = TexelBox(max(box.low, low), min(box.high, high));
  return high.x >= 0;
}

// The texels of one face in which something may block: of the kernel at the near plane, then narrowed by ever finer
// levels of the pyramid. False: there are none. umbra: all texels of the kernel at the widest gap block.
bool blocker_box(inout ShadowCursor cursor, VisibilityQuery q, uint face, float gap, out TexelBox box,
                 out PatchProjection projection, out bool umbra) {
  umbra = true;
  ShadowKernel kernel;
  if (!shadow_kernel_in_face(cursor, q, face, gap, kernel)) return false;
  vec2 size = vec2(cursor.view.size);
  box.low = ivec2(floor(clamp(kernel.low, vec2(0.0), size)));
  box.high = ivec2(ceil(clamp(kernel.high, vec2(0.0), size))) - 1;
  umbra = false;
  if (any(greaterThan(box.low, box.high))) return false;
  projection = patch_projection(cursor.view, cursor.receiver, q.light, q.position, DISC_SIDE);
  for (int round = 0; round < search_rounds; ++round) {
    ivec2 former = box.high - box.low;
    if (!narrow_box(cursor, projection, box, gap)) return false;
    ivec2 extent = box.high - box.low;
    if (4 * max(extent.x, extent.y) >= 3 * max(former.x, former.y)) break;
  }
  if (!shadow_kernel_in_face(cursor, q, face, gap, kernel)) return false;
  ShadowKernel centres = kernel_centres(cursor, kernel);
  umbra = kernel_depth_bounds(cursor, kernel).y <
          map_threshold_range(cursor.view, cursor.in_map, centres.low, centres.high).x;
  return true;
}

// The patch of the cell `at` of 2^level texels, with the depth of the texel in its middle.
MicroPatch fetched_patch(ShadowCursor cursor, PatchProjection projection, ivec2 at, int level) {
  int cell = 1 << level;
  ivec2 texel = min((at << level) + (cell >> 1), ivec2(cursor.view.size) - 1);
  float stored = texelFetch(shadow_depth, ivec3(texel, cursor.layer), 0).r;
  // Placed where that texel is, half a texel beside the middle of a wider cell: elsewhere its depth is not the
  // surface's, and slopes shadow themselves.
  vec2 centre = vec2(texel) + 0.5;
  MicroPatch found =
      micro_patch(projection, centre, float(cell), shadow_metres(cursor.view, stored), PATCH_SPREAD);
  found.blocks = found.blocks && stored < 1.0;
  return found;
}

void walk_box(ShadowCursor cursor, PatchProjection projection, TexelBox box) {
  int level = box_level(box, patches - 1);
  ivec2 low = box.low >> level;
  // One more cell: what it covers between itself and its neighbour.
  ivec2 high = min((box.high >> level) + 1, ivec2(cursor.view.size - 1u) >> level);
  for (int y = low.y; y <= high.y; ++y) {
    MicroPatch left = fetched_patch(cursor, projection, ivec2(max(low.x - 1, 0), y), level);
    left.blocks = left.blocks && low.x > 0;
    for (int x = low.x; x <= high.x; ++x) {
      MicroPatch below = fetched_patch(cursor, projection, ivec2(x, max(y - 1, 0)), level);
      MicroPatch found = fetched_patch(cursor, projection, ivec2(x, y), level);
      MicroPatch own = found;
      found.low.x = side_or_neighbour(own.low.x, own.high.x, left.blocks, left.high.x);
      found.low.y = side_or_neighbour(own.low.y, own.high.y, below.blocks && y > 0, below.high.y);
      add_patch(projection, found);
      left = own;
    }
    if (patches_suffice()) return;
  }
}

// search_lit or search_umbra where the min-max pyramid is certain, else search_partial: then all patches that may matter
// have been added.
int walk_patches(inout ShadowCursor cursor, VisibilityQuery q) {
  float gap = shadow_near_gap(cursor, q);
  uint faces = shadow_face_count(q.maps.faces);
  TexelBox box;
  PatchProjection projection;
  bool lit = true;
  bool umbra = true;
  for (uint face = 0u; face < faces; ++face) {
    bool all;
    bool some = blocker_box(cursor, q, face, gap, box, projection, all);
    lit = lit && !some;
    umbra = umbra && all;
  }
  if (lit) return search_lit;
  if (umbra) return search_umbra;
  for (uint face = 0u; face < faces; ++face) {
    bool some = true;
    bool all;
    // A loop of at most one round, as in shadow_tap(): what a single view gave is still there.
    for (; faces > 1u; faces = faces) {
      some = blocker_box(cursor, q, face, gap, box, projection, all);
      break;
    }
    if (some) walk_box(cursor, projection, box);
  }
  return search_partial;
}

#endif  // LIMN_MICRO_PATCH_WALK_GLSL
