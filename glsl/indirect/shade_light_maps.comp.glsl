// One texel of a virtual light's own map against the receiver.
#include "glsl/indirect/gather_main.glsl"
#include "glsl/shadow_view.glsl"

layout(binding = 8) uniform sampler2DArray maps;
layout(std430, binding = 1) readonly buffer Views { ShadowView views[]; };
uniform float bias;  // texel footprints

float vpl_visibility(uint vpl, vec3 receiver, vec3 normal) {
  ShadowView view = views[vpl];
  ShadowPoint at = shadow_project(view, receiver);
  if (!shadow_inside(at)) return 1.0;
  ivec2 texel = min(ivec2(at.uv * float(view.info.z)), ivec2(view.info.z) - 1);
  float stored = texelFetch(maps, ivec3(texel, view.info.y), 0).r;
  vec3 axis = normalize(receiver - view.origin.xyz);
  ShadowReceiver plane = shadow_receiver(view, receiver, normal, axis, bias);
  bool blocked = stored < 1.0 && shadow_blocks(plane, shadow_texel_offset(view, texel, stored));
  return blocked ? 0.0 : 1.0;
}
