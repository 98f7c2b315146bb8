// Micro-patches (glsl/shadow/micro_patches.glsl) where the axes of the map are those of the light, and the light's axis is the
// view's: all of a texel is at one gap from the receiver, and each coordinate of the light's box is a function of that gap and
// of one coordinate of the map.
#ifndef LIMN_ALIGNED_PATCHES_GLSL
#define LIMN_ALIGNED_PATCHES_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/shadow/micro_patches.glsl"
LIMN_BEGIN

// A place of the map, in texels, at some gap is seen at over_gap / gap - fixed on the light, both affine in the place: of each
// the value at place 0 and what a texel adds.
struct AlignedPatches {
  vec2 over_gap;
  vec2 over_gap_step;
  vec2 fixed_part;
  vec2 fixed_step;
  vec3 rise;     // of the height over plane and bias: rise . (x, y, 1) and `height`, of which a perspective view multiplies
  float height;  // the former by the depth, an orthographic one the latter
  float depth;   // of the receiver, metres along the light's axis
};

LIMN_FN AlignedPatches aligned_patches(PatchProjection m, uint projection) {
  AlignedPatches a;
  a.depth = m.c0.z;
  a.fixed_part = vec2(m.d0.x, m.d0.y);
  a.over_gap = vec2(m.c0.x, m.c0.y) + a.depth * a.fixed_part;
  if (projection == shadow_orthographic) {
    a.fixed_step = vec2(0.0f);
    a.over_gap_step = vec2(m.cx.x, m.cy.y);
    a.rise = vec3(m.cx.w, m.cy.w, m.c0.w);
    a.height = m.d0.w;
  } else {
    a.fixed_step = vec2(m.dx.x, m.dy.y);
    a.over_gap_step = a.depth * a.fixed_step;
    a.rise = vec3(m.dx.w, m.dy.w, m.d0.w);
    a.height = m.c0.w;
  }
  return a;
}

// What all cells of a column or row of them share.
struct PatchLine {
  int texel;   // in their middle
  vec2 low;    // over_gap and fixed_part at their sides
  vec2 high;
  float rise;  // its part of it
};

// axis 0: a column, 1: a row, which has the constant part of the rise. cell: its width, texels.
LIMN_FN PatchLine patch_line(AlignedPatches a, int axis, int texel, float cell) {
  float centre = float(texel) + 0.5f;
  vec2 start = vec2(a.over_gap[axis], a.fixed_part[axis]);
  vec2 step = vec2(a.over_gap_step[axis], a.fixed_step[axis]);
  PatchLine line;
  line.texel = texel;
  line.low = start + (centre - 0.5f * cell) * step;
  line.high = start + (centre + 0.5f * cell) * step;
  line.rise = axis == 0 ? centre * a.rise.x : centre * a.rise.y + a.rise.z;
  return line;
}

// micro_patch() of the cell where they meet, with the depth z (metres); its sides mean nothing where it does not block.
LIMN_FN MicroPatch aligned_patch(AlignedPatches a, uint projection, PatchLine column, PatchLine row, float z) {
  float gap = a.depth - z;
  float inverse = 1.0f / gap;
  float rise = column.rise + row.rise;
  float height = projection == shadow_orthographic ? rise + z * a.height : z * rise + a.height;
  MicroPatch found;
  found.blocks = gap > 1e-6f * z && height > 0.0f;
  found.low = vec2(inverse * column.low.x - column.low.y, inverse * row.low.x - row.low.y);
  found.high = vec2(inverse * column.high.x - column.high.y, inverse * row.high.x - row.high.y);
  return found;
}

// What all boxes of texels between two places of one axis share.
struct PatchSpan {
  vec2 most;   // over_gap and fixed_part where places lie farthest on the light
  vec2 least;  // the same where they lie nearest; fixed_part and 1
  float rise;  // its greatest part
};

// axis 0: columns, 1: rows, which have the constant part of the rise.
LIMN_FN PatchSpan patch_span(AlignedPatches a, int axis, float low, float high) {
  vec2 start = vec2(a.over_gap[axis], a.fixed_part[axis]);
  vec2 step = vec2(a.over_gap_step[axis], a.fixed_step[axis]);
  float rise = axis == 0 ? a.rise.x : a.rise.y;
  PatchSpan span;
  span.most = start + high * step;
  span.least = start + low * step;
  span.least.y += 1.0f;
  span.rise = max(low * rise, high * rise);
  if (axis == 1) span.rise += a.rise.z;
  return span;
}

// patches_may_block() of the box where they meet.
LIMN_FN bool aligned_patches_may_block(AlignedPatches a, uint projection, PatchSpan columns, PatchSpan rows, vec2 z,
                                       LIMN_OUT(float) gap) {
  gap = a.depth - z.x;
  float narrow = a.depth - z.y;
  float rise = columns.rise + rows.rise;
  float height = projection == shadow_orthographic ? rise + max(z.x * a.height, z.y * a.height)
                                                   : max(z.x * rise, z.y * rise) + a.height;
  // Each side of the light, times the gap.
  vec2 fixed_most = vec2(columns.most.y, rows.most.y);
  vec2 fixed_least = vec2(columns.least.y, rows.least.y);
  vec2 above = vec2(columns.most.x, rows.most.x) - min(gap * fixed_most, narrow * fixed_most);
  vec2 below = max(gap * fixed_least, narrow * fixed_least) - vec2(columns.least.x, rows.least.x);
  return min(min(above.x, above.y), min(below.x, below.y)) > 0.0f && min(gap, height) > 0.0f;
}

LIMN_END
#endif  // LIMN_ALIGNED_PATCHES_GLSL
