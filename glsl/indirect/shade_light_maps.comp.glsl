// One texel of a virtual light's own map against the receiver.
#include "glsl/indirect/gather_main.glsl"
#include "glsl/shadow/shadow_view.glsl"

uniform sampler2DArray maps;
layout(std430) readonly buffer Views { ShadowView views[]; };
uniform float bias;  // texel footprints

float vpl_visibility(uint vpl, vec3 receiver, vec3 normal) {
  ShadowView view = views[vpl];
  ShadowPoint at = shadow_project(view, receiver);
  if (!shadow_inside(at)) return 1.0;
  ivec2 texel = min(ivec2(at.uv * float(view.size)), ivec2(view.size) - 1);
  float stored = texelFetch(maps, ivec3(texel, view.layer), 0).r;
  vec3 axis = normalize(receiver - view.origin);
  ShadowReceiver plane = shadow_receiver(view, receiver, normal, axis, bias);
  bool blocked = stored < 1.0 && shadow_blocks(plane, shadow_texel_offset(view, texel, stored));
  return blocked ? 0.0 : 1.0;
}
