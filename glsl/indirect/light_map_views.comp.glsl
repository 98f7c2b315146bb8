// The paraboloid views of virtual lights.
#include "glsl/indirect/light_map.glsl"

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
  views[index] = light_map_view(virtual_lights[index], light_maps(extent, texels), index % batch);
}
