// Flux of each layer, W: the sum over its tiles (SAMPLED 0), or over the virtual lights that were sampled from it
// (SAMPLED 1).
#define THREADS 64
#include "glsl/indirect/virtual_light.glsl"
#include "glsl/numeric/work_group.glsl"

layout(local_size_x = THREADS) in;
#if SAMPLED
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
#else
layout(std430) readonly buffer Tiles { vec4 tiles[]; };
#endif
layout(std430) writeonly buffer LayerFlux { vec4 layer_flux[]; };
uniform uint count;  // of tiles in a layer, of virtual lights in all

void main() {
  uint layer = gl_WorkGroupID.x;
  vec3 sum = vec3(0.0);
  for (uint i = gl_LocalInvocationIndex; i < count; i += uint(THREADS)) {
#if SAMPLED
    vec4 flux = virtual_lights[i].flux;
    if (uint(flux.w) == layer) sum += flux.rgb;
#else
    sum += tiles[layer * count + i].rgb;
#endif
  }
  vec4 flux = total(vec4(sum, 0.0));
  if (gl_LocalInvocationIndex == 0u) layer_flux[layer] = flux;
}
