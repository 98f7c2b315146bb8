// How much of a light what lies in a part of a shadow-map kernel hides. A texel of a kernel that is cut at one distance need
// not lie between receiver and light at its own: walls fill whole search kernels and hide nothing.
#ifndef LIMN_HIDDEN_SHARE_GLSL
#define LIMN_HIDDEN_SHARE_GLSL
#include "glsl/shadow_kernel.glsl"
LIMN_BEGIN

// Solid angle, or area, of all of the kernel at `gap`, relative to those at other gaps.
LIMN_FN float shadow_kernel_measure(ShadowView view, LightView light, vec3 receiver, float gap) {
  if (view.info.x != shadow_perspective) return gap * gap;
  vec3 r = receiver - vec3(view.origin);
  vec3 middle = r + gap * light.centre;
  float inverse = 1.0f / sqrt(max(dot(middle, middle), 1e-30f));
  return gap * gap * max(dot(light.axis, r) - gap, 0.0f) * inverse * inverse * inverse;
}

// What lies nearer to the receiver than this, relative to the gap of the kernel that it is found in, hides no more than
// what lies there.
LIMN_CONST float shadow_least_gap = 0.05f;

// Share of the light that what fills low..high, texels, hides, as the number of texels of kernel `of`, in which it was
// found, that would hide as much: it is compared to the kernel at its own gap, `own`, the cone to the light cut there.
// most: how many times as many texels as it has.
LIMN_FN float shadow_hidden_texels(ShadowKernel of, ShadowKernel own, vec2 low, vec2 high, float most) {
  const float blur = 0.5f;  // texels: how far kernels reach into texels that their edges cut
  vec2 first = max(of.low, own.low - vec2(blur));
  vec2 last = min(of.high, own.high + vec2(blur));
  vec2 extent = max(last - first, vec2(1e-6f));
  vec2 inside = max(min(high, last) - max(low, first), vec2(0.0f));
  vec2 whole = of.high - of.low;
  return inside.x * inside.y * min(whole.x * whole.y / (extent.x * extent.y), most);
}

LIMN_END
#endif  // LIMN_HIDDEN_SHARE_GLSL
