// Backprojection: texels of a shadow map as micro-patches, rectangles that face the map at the depth it holds, projected
// from the receiver onto the light (Guennebaud, Barthe and Paulin 2006, Real-time Soft Shadow Mapping by Backprojection;
// Schwarz and Stamminger 2007, Bitmask Soft Shadows).
//
// Points of the light lie in the box of its counted part (LightView::low, high), mapped to [0, 1]^2. For a texel at depth
// z the numerators of that projection, its denominator and the height above the tangent plane are affine in the texel's
// position and in z: four values at once, C(x, y) + z D(x, y). Perspective and orthographic views only.
#ifndef LIMN_MICRO_PATCHES_GLSL
#define LIMN_MICRO_PATCHES_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/light/light_view.glsl"
#include "glsl/shadow/shadow_kernel.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

// From texels of a view to points of the light. The first coordinate of the result grows with the texel's x, the second
// with its y: patch_in_light() leads back to the light's own order. The vectors are four functions of texel and depth that
// are evaluated at once: two numerators, the metres from the receiver along the light's axis, and the height over plane and
// bias.
struct PatchProjection {
  vec4 c0;
  vec4 cx;  // per texel
  vec4 cy;
  vec4 d0;  // per metre of depth
  vec4 dx;
  vec4 dy;
  float reach;   // metres along the light's axis: what is as far away or farther lies beside or behind the light
  float area;    // of a patch, relative to that of the rectangle that stands for it: 1 where the map's axes are the light's
  bool swapped;  // first coordinate: along the light's side_v
  bvec2 flipped;
};

// A texel on the light.
struct MicroPatch {
  bool blocks;
  vec2 low;
  vec2 high;
};

// Adds the value dot(a, b) + k at offset b (of the view's axes, from its origin) as component i.
LIMN_FN void patch_value(LIMN_INOUT(PatchProjection) p, ShadowView view, int i, vec3 a, float k) {
  float step = 1.0f / (view.scale * float(view.size));
  float corner = -(a.x * view.middle.x + a.y * view.middle.y) / view.scale;
  bool flat_view = view.projection == shadow_orthographic;
  p.c0[i] = flat_view ? k + corner : k;
  p.cx[i] = flat_view ? a.x * step : 0.0f;
  p.cy[i] = flat_view ? a.y * step : 0.0f;
  p.d0[i] = flat_view ? a.z : a.z + corner;
  p.dx[i] = flat_view ? 0.0f : a.x * step;
  p.dy[i] = flat_view ? 0.0f : a.y * step;
}

// One coordinate of the light's box, as a vector whose product with an offset from the receiver is divided by the gap.
LIMN_FN vec3 patch_coordinate(LightView light, vec3 side, float low, float high) {
  float squared = max(dot(side, side), 1e-30f);
  // (dot(side, b / gap - centre) / squared - low) / (high - low), with gap = -dot(axis, b)
  float offset = dot(side, light.centre) / squared + low;
  return (side / squared + offset * light.axis) / max(high - low, 1e-6f);
}

// The sides of the light, or of what stands for it: a disc by the square of `disc` times its diameter along the view's
// axes, a line by a narrow rectangle.
LIMN_FN void patch_sides(ShadowView view, LightView light, float disc, LIMN_OUT(vec3) u, LIMN_OUT(vec3) v) {
  u = light.side_u;
  v = light.side_v;
  if (light.cone) {
    float scale = disc * light_view_cone_scale(light, 1.0f);
    u = scale * view.axis_x;
    v = scale * view.axis_y;
  }
  if (!(dot(u, u) > 0.0f)) u = 1e-4f * cross(v, light.axis);
  if (!(dot(v, v) > 0.0f)) v = 1e-4f * cross(light.axis, u);
}

// p: the receiver; disc: side of the square that stands for a disc, in its diameters.
LIMN_FN PatchProjection patch_projection(ShadowView view, ShadowReceiver receiver, LightView light, vec3 p,
                                         float disc) {
  vec3 u;
  vec3 v;
  patch_sides(view, light, disc, u, v);
  vec3 first = shadow_view_axes(view, patch_coordinate(light, u, light.low.x, light.high.x));
  vec3 second = shadow_view_axes(view, patch_coordinate(light, v, light.low.y, light.high.y));
  vec3 axis = receiver.axis;
  // How both change with the texel, but for a common positive factor, around the middle of the light.
  vec2 along_x = vec2(first.x, second.x) + 0.5f * axis.x;
  vec2 along_y = vec2(first.y, second.y) + 0.5f * axis.y;
  PatchProjection m;
  m.reach = light.cone ? 3.0e38f : light.depth;
  m.swapped = abs(along_x.x * along_y.y) < abs(along_x.y * along_y.x);
  if (m.swapped) {
    vec3 other = first;
    first = second;
    second = other;
    along_x = vec2(along_x.y, along_x.x);
    along_y = vec2(along_y.y, along_y.x);
  }
  m.flipped = bvec2(along_x.x < 0.0f, along_y.y < 0.0f);
  float whole = along_x.x * along_y.y;
  float cross_term = along_x.y * along_y.x;
  m.area = abs(whole) > 0.0f ? clamp(1.0f - cross_term / whole, 0.0f, 2.0f) : 1.0f;
  if (m.flipped.x) first = -axis - first;
  if (m.flipped.y) second = -axis - second;
  vec3 r = shadow_local(view, p);
  patch_value(m, view, 0, first, -dot(first, r));
  patch_value(m, view, 1, second, -dot(second, r));
  patch_value(m, view, 2, -axis, receiver.depth);
  patch_value(m, view, 3, receiver.normal, -receiver.height);
  return m;
}

// The square of `cell` texels around `centre` (texels) with the depth z (metres). spread 0: as wide and high as its middle
// lines, so that neighbours meet; 1: the box around it, which leaves no holes where the map is turned against the light.
LIMN_FN MicroPatch micro_patch(PatchProjection m, vec2 centre, float cell, float z, float spread) {
  vec4 at = m.c0 + centre.x * m.cx + centre.y * m.cy + z * (m.d0 + centre.x * m.dx + centre.y * m.dy);
  vec4 per_x = m.cx + z * m.dx;
  vec4 per_y = m.cy + z * m.dy;
  MicroPatch found;
  found.blocks = at.z > 1e-6f * z && at.z < m.reach && at.w > 0.0f;
  float least = 1e-6f * z;
  float inverse = 1.0f / max(at.z, least);
  vec2 middle = inverse * vec2(at.x, at.y);
  vec2 along_x = vec2(per_x.x, per_x.y) - per_x.z * middle;
  vec2 along_y = vec2(per_y.x, per_y.y) - per_y.z * middle;
  // Its ends are exact, also where the texel is seen so flatly that the denominator changes across it.
  vec2 step = 0.5f * cell * vec2(along_x.x, along_y.y);
  vec2 nearer = 0.5f * cell * vec2(per_x.z, per_y.z);
  vec2 first = middle - step / max(at.z - nearer, vec2(least));
  vec2 second = middle + step / max(at.z + nearer, vec2(least));
  vec2 wider = (0.5f * cell * inverse * spread) * abs(vec2(along_y.x, along_x.y));
  found.low = min(first, second) - wider;
  found.high = max(first, second) + wider;
  if (spread > 0.0f) {
    // Beside the receiver gaps change as much across a patch as they are wide, and what is linear across would reach past the
    // receiver's own direction, over all of the light: no box reaches farther than the corners of its patch.
    vec2 low = middle;
    vec2 high = middle;
    for (int i = 0; i < 4; ++i) {
      float right = (i & 1) == 0 ? -0.5f : 0.5f;
      float up = (i & 2) == 0 ? -0.5f : 0.5f;
      vec4 corner = at + cell * (right * per_x + up * per_y);
      vec2 p = vec2(corner.x, corner.y) / max(corner.z, least);
      low = min(low, p);
      high = max(high, p);
    }
    found.low = max(found.low, low);
    found.high = min(found.high, high);
  }
  return found;
}

// Whether anything in a box of texels, with depths between z.x and z.y, may cover a point of the light. gap: the widest
// that it may have, metres.
LIMN_FN bool patches_may_block(PatchProjection m, vec2 low, vec2 high, vec2 z, LIMN_OUT(float) gap) {
  vec2 centre = 0.5f * (low + high);
  vec2 reach = 0.5f * (high - low);
  vec4 c = m.c0 + centre.x * m.cx + centre.y * m.cy;
  vec4 d = m.d0 + centre.x * m.dx + centre.y * m.dy;
  // The greatest values of the numerators, of what is left of the denominator beyond them, and of the height: each is
  // affine in the position and in z.
  vec4 most = vec4(-3.0e38f);
  vec2 beyond = vec2(-3.0e38f);
  float nearest = 3.0e38f;
  for (int i = 0; i < 2; ++i) {
    float depth = i == 0 ? z.x : z.y;
    vec4 x = m.cx + depth * m.dx;
    vec4 y = m.cy + depth * m.dy;
    vec4 at = c + depth * d;
    most = max(most, at + reach.x * abs(x) + reach.y * abs(y));
    nearest = min(nearest, at.z - reach.x * abs(x.z) - reach.y * abs(y.z));
    beyond = max(beyond, at.z - vec2(at.x, at.y) + reach.x * abs(x.z - vec2(x.x, x.y)) +
                             reach.y * abs(y.z - vec2(y.x, y.y)));
  }
  gap = min(most.z, m.reach);
  return min(min(most.x, most.y), min(most.z, most.w)) > 0.0f && min(beyond.x, beyond.y) > 0.0f && nearest < m.reach;
}

// Share of the unit square where height + dot(slope, p - 1/2) >= 0.
LIMN_FN float half_plane_share(float height, vec2 slope) {
  // Along the steeper axis the border is at distance t; across it t varies by the ratio of the slopes.
  float steep = max(abs(slope.x), abs(slope.y));
  float ratio = min(abs(slope.x), abs(slope.y)) / max(steep, 1e-30f);
  float t = height / max(steep, 1e-30f) + 0.5f;
  float from = t - 0.5f * ratio;
  float to = t + 0.5f * ratio;
  if (ratio < 1e-3f) return clamp(t, 0.0f, 1.0f);
  // Mean of clamp(x, 0, 1) for x in [from, to].
  float a = clamp(from, 0.0f, 1.0f);
  float b = clamp(to, 0.0f, 1.0f);
  return (0.5f * (b - a) * (b + a) + max(to - 1.0f, 0.0f) - max(from - 1.0f, 0.0f)) / ratio;
}

// Height above the tangent plane of point p of the light's box: dot(result.xy, p - 1/2) + result.z, up to a factor.
LIMN_FN vec3 light_height(ShadowView view, LightView light, float disc) {
  vec3 u;
  vec3 v;
  patch_sides(view, light, disc, u, v);
  vec2 middle = 0.5f * (light.low + light.high);
  vec2 slope = vec2(dot(light.normal, u), dot(light.normal, v));
  float height = dot(light.normal, light.centre) + dot(middle, slope);
  return vec3(slope.x * (light.high.x - light.low.x), slope.y * (light.high.y - light.low.y), height);
}

// Share of that box that counts.
LIMN_FN float counted_share(ShadowView view, LightView light, float disc) {
  if (light.whole) return 1.0f;
  vec3 height = light_height(view, light, disc);
  return half_plane_share(height.z, vec2(height.x, height.y));
}

// A patch in the order of the light's own sides.
LIMN_FN MicroPatch patch_in_light(PatchProjection m, MicroPatch given) {
  MicroPatch placed = given;
  placed.low.x = m.flipped.x ? 1.0f - given.high.x : given.low.x;
  placed.high.x = m.flipped.x ? 1.0f - given.low.x : given.high.x;
  placed.low.y = m.flipped.y ? 1.0f - given.high.y : given.low.y;
  placed.high.y = m.flipped.y ? 1.0f - given.low.y : given.high.y;
  if (m.swapped) {
    placed.low = vec2(placed.low.y, placed.low.x);
    placed.high = vec2(placed.high.y, placed.high.x);
  }
  return placed;
}

LIMN_END
#endif  // LIMN_MICRO_PATCHES_GLSL
