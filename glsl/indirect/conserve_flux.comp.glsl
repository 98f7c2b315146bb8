// Scales virtual lights so that each channel of their sum over a group is the flux that the group reflects, and what
// groups reflect that no sample met is shared among the rest. The light of a channel that no sample met at all is lost.
#include "glsl/indirect/map_groups.glsl"
#include "glsl/indirect/virtual_light.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Reflected { vec4 reflected[]; };      // by layer
layout(std430) readonly buffer Sampled { vec4 sampled_flux[]; };  // by group, at its first layer
layout(std430) buffer VirtualLights { VirtualPointLight virtual_lights[]; };
uniform uint count;  // of virtual lights

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
  vec4 flux = virtual_lights[index].flux;
  uint own = uint(flux.w);
  vec3 own_reflected = vec3(0.0);
  vec3 total = vec3(0.0);
  vec3 met = vec3(0.0);
  for (uint light = 0u; light < light_count; ++light) {
    LightLayers of_light = light_layers(light);
    for (uint face = 0u; face < of_light.faces; ++face) {
      uint group = of_light.first + face;
      vec3 group_reflected = vec3(0.0);
      for (uint point = 0u; point < of_light.points; ++point)
        group_reflected += reflected[group + point * of_light.faces].rgb;
      total += group_reflected;
      met += mix(vec3(0.0), group_reflected, greaterThan(sampled_flux[group].rgb, vec3(0.0)));
      if (group == own) own_reflected = group_reflected;
    }
  }
  for (int c = 0; c < 3; ++c) {
    bool some = met[c] > 0.0 && sampled_flux[own][c] > 0.0;  // sums are 0 where a map's mean is too small for a float
    if (flux[c] > 0.0) flux[c] = some ? flux[c] * (own_reflected[c] / sampled_flux[own][c] * (total[c] / met[c])) : 0.0;
  }
  virtual_lights[index].flux = vec4(flux.rgb, 0.0);
}
