// What a texel of a shadow map is to be compared with, for any projection and straight from the definition:
// the law that the prepared thresholds of glsl/shadow/map_space.glsl and glsl/shadow/variance_kernel.glsl are
// tested against.
#pragma once

#include "glsl/shadow/shadow_kernel.glsl"

namespace limn::glsl {

/// Metres of depth at uv: where the tangent plane, raised by the bias, lies there, and where the light's axis
/// has the receiver's depth.
inline vec2 shadow_limits(const ShadowView& view, const ShadowReceiver& receiver, vec2 uv) {
  // Points behind uv are start + depth * step.
  vec3 start = vec3(0.0f);
  vec3 step = shadow_unproject_local(view, uv, 1.0f);
  if (view.projection == shadow_orthographic) {
    start = vec3(step.x, step.y, 0.0f);
    step = vec3(0.0f, 0.0f, 1.0f);
  }
  float axis = view.far;
  const float along = dot(receiver.axis, step);
  if (along > 0.0f) axis = min(axis, (receiver.depth - dot(receiver.axis, start)) / along);
  float plane = view.far;
  // What lies above the plane: rise * depth > above.
  const float above = receiver.height - dot(receiver.normal, start);
  const float rise = dot(receiver.normal, step);
  if (rise < 0.0f) plane = min(plane, above / rise);
  if (rise >= 0.0f && above >= 0.0f) plane = view.near;
  return vec2(plane, axis);
}

/// map_threshold() at uv.
inline float shadow_threshold(const ShadowView& view, const ShadowReceiver& receiver, vec2 uv) {
  const vec2 limits = shadow_limits(view, receiver, uv);
  return clamp(shadow_normalise(view, min(limits.x, limits.y)), 0.0f, 1.0f);
}

/// Metres along the light's axis from what is stored at uv to the receiver.
inline float shadow_gap(const ShadowView& view, const ShadowReceiver& receiver, vec2 uv, float stored) {
  return receiver.depth - dot(receiver.axis, shadow_unproject_local(view, uv, shadow_metres(view, stored)));
}

/// A corner of a kernel, uv.
inline vec2 kernel_corner(const ShadowView& view, const ShadowKernel& kernel, int i) {
  return vec2((i & 1) == 0 ? kernel.low.x : kernel.high.x, (i & 2) == 0 ? kernel.low.y : kernel.high.y) /
         float(view.size);
}

/// map_threshold_range() of a kernel.
inline vec2 shadow_threshold_range(const ShadowView& view, const ShadowReceiver& receiver,
                                   const ShadowKernel& kernel) {
  vec2 least = vec2(view.far);
  vec2 most = vec2(-view.far);
  for (int i = 0; i < 4; ++i) {
    const vec2 limits = shadow_limits(view, receiver, kernel_corner(view, kernel, i));
    least = min(least, limits);
    most = max(most, limits);
  }
  // Where the light comes from beneath the plane, what blocks lies behind it.
  const bool beneath =
      view.projection == shadow_orthographic ? receiver.normal.z >= 0.0f : receiver.height >= 0.0f;
  if (beneath) most.x = view.far;
  return clamp(
      vec2(shadow_normalise(view, min(least.x, least.y)), shadow_normalise(view, min(most.x, most.y))),
      vec2(0.0f), vec2(1.0f));
}

/// The widest gap of anything in the kernel that is stored at `least` or farther.
inline float shadow_gap_bound(const ShadowView& view, const ShadowReceiver& receiver,
                              const ShadowKernel& kernel, float least) {
  float gap = 0.0f;
  for (int i = 0; i < 4; ++i)
    gap = max(gap, shadow_gap(view, receiver, kernel_corner(view, kernel, i), least));
  return gap;
}

}  // namespace limn::glsl
