// The walk of glsl/shadow/micro_patch_walk.glsl with all that a receiver fixes worked out, which bounds measure: the box is
// narrowed as the techniques do it, and a patch is one texel, its comparison and four multiply-adds. One perspective view sees all
// of the light, which is a rectangle.
//
// Bounds define add_patch() and patches_suffice(), and before they include this LIMN_PATCH_UNION (glsl/shadow/patch_box.glsl).
#ifndef LIMN_PATCH_TAPS_GLSL
#define LIMN_PATCH_TAPS_GLSL
#define DISC_SIDE 1.0
#include "glsl/shadow/map_taps.glsl"
#include "glsl/shadow/patch_box.glsl"

// Takes in a patch, which lies within [0, 1]^2 where it blocks.
void add_patch(MicroPatch found);
// Whether no further patch can change the answer.
bool patches_suffice();

// What the patches of a receiver share. Depths are as the map stores them.
struct PatchTaps {
  AlignedPatches aligned;
  MapTest test;
  float receiver;
  uint layer;
};

PatchTaps patch_taps(ShadowCursor cursor, AlignedPatches aligned) {
  float range = cursor.view.far - cursor.view.near;
  PatchTaps taps;
  taps.aligned = aligned;
  taps.aligned.over_gap = aligned.over_gap / range;
  taps.aligned.over_gap_step = aligned.over_gap_step / range;
  taps.test = map_test(cursor);
  taps.receiver = (aligned.depth - cursor.view.near) / range;
  taps.layer = cursor.layer;
  return taps;
}

// aligned_patch() of the cell where they meet, cut to the light.
MicroPatch patch_tap(PatchTaps taps, PatchLine column, PatchLine row) {
  float stored = texelFetch(shadow_depth, ivec3(column.texel, row.texel, taps.layer), 0).r;
  float inverse = 1.0 / (taps.receiver - stored);
  vec2 low = vec2(inverse * column.low.x - column.low.y, inverse * row.low.x - row.low.y);
  vec2 high = vec2(inverse * column.high.x - column.high.y, inverse * row.high.x - row.high.y);
  return MicroPatch(map_test_blocks(taps.test, column.rise + row.rise, stored), clamp(low, vec2(0.0), vec2(1.0)),
                    clamp(high, vec2(0.0), vec2(1.0)));
}

void tap_box(ShadowCursor cursor, AlignedPatches aligned, TexelBox box) {
  PatchTaps taps = patch_taps(cursor, aligned);
  int level = box_level(box, patches - 1);
  ivec2 low = box.low >> level;
  ivec2 high = min((box.high >> level) + 1, ivec2(cursor.view.size - 1u) >> level);
  int y = low.y;
  do {
    PatchLine rows[strip + 1];
    for (int i = 0; i <= strip; ++i) rows[i] = cell_row(cursor, taps.aligned, level, y + i - 1);
    PatchLine column = cell_column(cursor, taps.aligned, level, low.x - 1);
    float left[strip];  // where the neighbours of each row end
    for (int i = 0; i < strip; ++i) {
      MicroPatch beside = patch_tap(taps, column, rows[i + 1]);
      left[i] = beside.blocks && low.x > 0 ? beside.high.x : no_neighbour;
    }
    int x = low.x;
    do {
      column = cell_column(cursor, taps.aligned, level, x);
      MicroPatch beside = patch_tap(taps, column, rows[0]);
      float below = beside.blocks && y > 0 ? beside.high.y : no_neighbour;
      for (int i = 0; i < strip; ++i) {
        MicroPatch own = patch_tap(taps, column, rows[i + 1]);
        vec2 start = vec2(side_or_neighbour(own.low.x, own.high.x, left[i]),
                          side_or_neighbour(own.low.y, own.high.y, below));
        add_patch(MicroPatch(own.blocks && y + i <= high.y, start, own.high));
        left[i] = own.blocks ? own.high.x : no_neighbour;
        below = own.blocks ? own.high.y : no_neighbour;
      }
    } while (++x <= high.x);
    y += strip;
  } while (y <= high.y && !patches_suffice());
}

// walk_patches() in the one view.
int tap_patches(ShadowCursor cursor, VisibilityQuery q) {
  TexelBox box;
  PatchProjection projection;
  AlignedPatches aligned;
  bool umbra;
  if (!blocker_box(cursor, q, 0u, shadow_near_gap(cursor, q), box, projection, aligned, umbra)) return search_lit;
  if (umbra) return search_umbra;
  tap_box(cursor, aligned, box);
  return search_partial;
}

#endif  // LIMN_PATCH_TAPS_GLSL
