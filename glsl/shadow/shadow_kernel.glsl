// Kernels of prefiltered soft shadows: the box of a shadow map through which a receiver sees the light at some distance,
// and the depth below which a texel of that box blocks. What point samples do with shadow_blocks(), these do for whole
// boxes: the same light, tangent plane and bias.
#ifndef LIMN_SHADOW_KERNEL_GLSL
#define LIMN_SHADOW_KERNEL_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/light/light_view.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

struct ShadowKernel {
  vec2 low;      // texels, fractional; the part in another face of the light's maps is cut off, a part outside of all
  vec2 high;     // maps is not
  float weight;  // steradians or so: the share of this face, relative to the kernels in the other faces
};

// Half the side, relative to light_view_cone_scale(v, 1), of the square as large as the disc.
LIMN_CONST float square_of_disc = 0.886226925f;

// Lights so narrow that rounding leaves their kernels no width still have what lies in their texel: a thousandth of a texel
// is about the least that places in the largest maps resolve.
LIMN_CONST float least_kernel_width = 1e-3f;

LIMN_FN void widen_kernel(LIMN_INOUT(ShadowKernel) kernel) {
  vec2 widen = max(0.5f * (vec2(least_kernel_width) - (kernel.high - kernel.low)), vec2(0.0f));
  kernel.low -= widen;
  kernel.high += widen;
}

// The kernel `gap` metres nearer to the light than the receiver, along the light's axis: the counted part of the light
// (LightView::low, high) scaled down by gap / depth, projected, and boxed (framework, steps 1 and 3). False: nothing of
// it lies in this view. whole: the view is the light's only one, so what lies beyond its edge is unoccluded.
LIMN_FN bool shadow_kernel(ShadowView view, LightView light, vec3 receiver, float gap, bool whole,
                           LIMN_OUT(ShadowKernel) kernel) {
  vec3 centre = shadow_local(view, receiver);
  vec3 direction = shadow_view_axes(view, light.centre);
  float scale = light.cone ? square_of_disc * light_view_cone_scale(light, 1.0f) : 1.0f;
  vec3 u = scale * shadow_view_axes(view, light.side_u);
  vec3 v = scale * shadow_view_axes(view, light.side_v);
  float size = float(view.size);
  kernel.low = vec2(3.0e38f);
  kernel.high = vec2(-3.0e38f);
  kernel.weight = 1.0f;
  if (view.projection == shadow_orthographic && !light.cone) {
    // A distant rectangle that is not seen head-on is a parallelogram in the map: the box of the same second moments.
    vec2 middle = 0.5f * (light.low + light.high);
    vec3 r = centre + gap * (direction + middle.x * u + middle.y * v);
    vec2 texel = size * shadow_project_local(view, r).uv;
    vec3 reach_u = (light.high.x - light.low.x) * u;
    vec3 reach_v = (light.high.y - light.low.y) * v;
    vec2 reach = 0.5f * size * view.scale * gap *
                 vec2(sqrt(reach_u.x * reach_u.x + reach_v.x * reach_v.x),
                      sqrt(reach_u.y * reach_u.y + reach_v.y * reach_v.y));
    kernel.low = texel - reach;
    kernel.high = texel + reach;
    widen_kernel(kernel);
    return true;
  }
  bool seen = false;
  for (int i = 0; i < 4; ++i) {
    vec2 p = vec2((i & 1) == 0 ? light.low.x : light.high.x, (i & 2) == 0 ? light.low.y : light.high.y);
    vec3 r = centre + gap * (direction + p.x * u + p.y * v);
    seen = seen || r.z > 0.0f || view.projection != shadow_perspective;
    // What lies beside or behind a perspective view lies far outside its map, on the side it is on.
    if (view.projection == shadow_perspective) r.z = max(r.z, 1e-3f * max(abs(r.x), abs(r.y)));
    vec2 texel = size * shadow_project_local(view, r).uv;
    kernel.low = min(kernel.low, texel);
    kernel.high = max(kernel.high, texel);
  }
  if (!seen) return false;
  widen_kernel(kernel);
  if (!whole) {
    kernel.low = max(kernel.low, vec2(0.0f));
    kernel.high = min(kernel.high, vec2(size));
    if (!(kernel.low.x < kernel.high.x && kernel.low.y < kernel.high.y)) return false;
    // Solid angle of the box: its area times the inverse cube of its distance.
    vec2 extent = (kernel.high - kernel.low) / size;
    vec3 middle = shadow_unproject_local(view, 0.5f * (kernel.low + kernel.high) / size, 1.0f);
    float inverse = 1.0f / dot(middle, middle);
    kernel.weight = extent.x * extent.y * inverse * sqrt(inverse);
  }
  return true;
}

// Metres of depth at uv: where the tangent plane, raised by the bias, lies there, and where the light's axis has the
// receiver's depth.
LIMN_FN vec2 shadow_limits(ShadowView view, ShadowReceiver receiver, vec2 uv) {
  // Points behind uv are start + depth * step.
  vec3 start = vec3(0.0f);
  vec3 step = shadow_unproject_local(view, uv, 1.0f);
  if (view.projection == shadow_orthographic) {
    start = vec3(step.x, step.y, 0.0f);
    step = vec3(0.0f, 0.0f, 1.0f);
  }
  float axis = view.far;
  float along = dot(receiver.axis, step);
  if (along > 0.0f) axis = min(axis, (receiver.depth - dot(receiver.axis, start)) / along);
  float plane = view.far;
  float above = receiver.height - dot(receiver.normal, start);  // plane: dot(plane.xyz, step) depth > above
  float rise = dot(receiver.normal, step);
  if (rise < 0.0f) plane = min(plane, above / rise);
  if (rise >= 0.0f && above >= 0.0f) plane = view.near;
  return vec2(plane, axis);
}

// The stored depth below which a texel at uv blocks the receiver: the lesser of the tangent plane's, raised by the bias,
// and the receiver's own along the light's axis. In [0, 1]. shadow_blocks() says the same of a point, but for what
// little of a light lies above the tangent plane when its centre lies below: there nothing blocks.
LIMN_FN float shadow_threshold(ShadowView view, ShadowReceiver receiver, vec2 uv) {
  vec2 limits = shadow_limits(view, receiver, uv);
  return clamp(shadow_normalise(view, min(limits.x, limits.y)), 0.0f, 1.0f);
}

// Metres along the light's axis from what is stored at uv to the receiver.
LIMN_FN float shadow_gap(ShadowView view, ShadowReceiver receiver, vec2 uv, float stored) {
  return receiver.depth - dot(receiver.axis, shadow_unproject_local(view, uv, shadow_metres(view, stored)));
}

// Bounds of the thresholds in a kernel: as map_threshold_range() (glsl/shadow/map_space.glsl), for each plane by itself.
LIMN_FN vec2 shadow_threshold_range(ShadowView view, ShadowReceiver receiver, ShadowKernel kernel) {
  float size = float(view.size);
  vec2 least = vec2(view.far);
  vec2 most = vec2(-view.far);
  for (int i = 0; i < 4; ++i) {
    vec2 at = vec2((i & 1) == 0 ? kernel.low.x : kernel.high.x, (i & 2) == 0 ? kernel.low.y : kernel.high.y);
    vec2 limits = shadow_limits(view, receiver, at / size);
    least = min(least, limits);
    most = max(most, limits);
  }
  return clamp(vec2(shadow_normalise(view, min(least.x, least.y)), shadow_normalise(view, min(most.x, most.y))),
               vec2(0.0f), vec2(1.0f));
}

// The widest gap of anything in the kernel that is stored at `least` or farther.
LIMN_FN float shadow_gap_bound(ShadowView view, ShadowReceiver receiver, ShadowKernel kernel, float least) {
  float size = float(view.size);
  float gap = 0.0f;
  for (int i = 0; i < 4; ++i) {
    vec2 at = vec2((i & 1) == 0 ? kernel.low.x : kernel.high.x, (i & 2) == 0 ? kernel.low.y : kernel.high.y);
    gap = max(gap, shadow_gap(view, receiver, at / size, least));
  }
  return gap;
}

LIMN_END
#endif  // LIMN_SHADOW_KERNEL_GLSL
