// The nearest cluster of each virtual light: C(i).
#include "glsl/indirect/virtual_area_light.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430) readonly buffer Clusters { VirtualAreaLight clusters[]; };
layout(std430) writeonly buffer Mapping { uint mapping[]; };
uniform uint light_count;
uniform uint cluster_count;
uniform float per_extent;  // 1/m
uniform float weight_position;
uniform float weight_angle;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= light_count) return;
  VirtualPointLight light = virtual_lights[i];
  uint nearest = 0u;
  float least = 3.0e38;
  for (uint k = 0u; k < cluster_count; ++k) {
    float d = cluster_distance(light, clusters[k], per_extent, weight_position, weight_angle);
    if (clusters[k].count >= 0.0 && d < least) {
      least = d;
      nearest = k;
    }
  }
  mapping[i] = nearest;
}
