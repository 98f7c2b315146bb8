// Scales virtual lights so that each channel of their sum over a layer is the flux that the layer reflects, and what
// layers reflect that no sample met is shared among the rest.
#include "glsl/virtual_light.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Reflected { vec4 reflected[]; };  // by layer
layout(std430, binding = 1) readonly buffer Sampled { vec4 sampled_flux[]; };
layout(std430, binding = 2) buffer VirtualLights { VirtualPointLight virtual_lights[]; };
uniform uint count;
uniform uint layers;

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
  vec3 total = vec3(0.0);
  vec3 met = vec3(0.0);
  for (uint l = 0u; l < layers; ++l) {
    total += reflected[l].rgb;
    met += mix(vec3(0.0), reflected[l].rgb, greaterThan(sampled_flux[l].rgb, vec3(0.0)));
  }
  vec4 flux = virtual_lights[index].flux;
  uint layer = uint(flux.w);
  for (int c = 0; c < 3; ++c) {
    if (flux[c] > 0.0) flux[c] *= reflected[layer][c] / sampled_flux[layer][c] * (total[c] / met[c]);
  }
  virtual_lights[index].flux = vec4(flux.rgb, 0.0);
}
