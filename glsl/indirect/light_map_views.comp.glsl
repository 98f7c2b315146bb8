// A paraboloid view from every virtual light, a hair off its surface, so that the surface's own plane lies behind it.
// Those without flux look out of the scene: nothing is drawn for them.
#include "glsl/shadow/paraboloid.glsl"
#include "glsl/indirect/virtual_light.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430) writeonly buffer Views { ShadowView views[]; };
uniform uint count;
uniform uint batch;  // layers of an array of maps
uniform uint texels;
uniform float extent;  // diagonal of the scene's bounds, m

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
  VirtualPointLight light = virtual_lights[index];
  bool dark = light.flux.x + light.flux.y + light.flux.z == 0.0;
  float offset = extent * (dark ? 1e3 : 1e-4);
  vec3 origin = light.position + offset * light.normal.xyz;
  views[index] = paraboloid_view(origin, light.normal.xyz, 1e-4 * extent, 1.001 * extent, index % batch, texels);
}
