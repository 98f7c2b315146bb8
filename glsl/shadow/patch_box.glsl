// Where a walk over micro-patches goes: the texels of the shadow maps that may cover the light, in cells of one texel or more, and
// how neighbours close the gaps between them.
//
// Define before including this
//   DISC_SIDE     side of the square that a directional light's disc is drawn in, in its diameters;
//   LIMN_PATCH_UNION  1: a patch keeps its own sides where a neighbour overlaps it, 0: it ends where the neighbour does
//                     (what several patches of one row cover beyond their neighbours still counts more than once).
#ifndef LIMN_PATCH_BOX_GLSL
#define LIMN_PATCH_BOX_GLSL
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
  // Kernels hold the square as large as a disc; what is drawn of it may reach beyond that. Patches do not ask for a disc's sides.
  if (q.light.cone) {
    q.light.side_u *= DISC_SIDE / square_of_disc;
    q.light.side_v *= DISC_SIDE / square_of_disc;
  }
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

// The texel in the middle of a cell of 2^level texels, the one with number `at` along an axis. Patches are placed where it is, half
// a texel beside the middle of a wider cell: elsewhere its depth is not the surface's, and slopes shadow themselves.
int cell_texel(ShadowCursor cursor, int level, int at) {
  int cell = 1 << level;
  return clamp((at << level) + (cell >> 1), 0, int(cursor.view.size) - 1);
}

PatchLine cell_column(ShadowCursor cursor, AlignedPatches aligned, int level, int x) {
  return patch_line(aligned, 0, cell_texel(cursor, level, x), float(1 << level));
}

PatchLine cell_row(ShadowCursor cursor, AlignedPatches aligned, int level, int y) {
  return patch_line(aligned, 1, cell_texel(cursor, level, y), float(1 << level));
}

const int strip = 5;  // rows that are walked together: the one below them is fetched once

#endif  // LIMN_PATCH_BOX_GLSL
