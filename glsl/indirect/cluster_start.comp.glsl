// Where each cluster starts: at virtual light floor(k N / M), or the next one before the next cluster's that carries flux.
#include "glsl/indirect/virtual_area_light.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430) writeonly buffer Clusters { VirtualAreaLight clusters[]; };
uniform uint light_count;    // N
uniform uint cluster_count;  // M

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= cluster_count) return;
  VirtualAreaLight cluster = VirtualAreaLight(vec3(0.0), -1.0, vec4(0.0), vec2(0.0), uvec2(0u));
  uint end = cluster_start(k + 1u, light_count, cluster_count);
  for (uint i = cluster_start(k, light_count, cluster_count); i < end; ++i) {
    if (!virtual_light_shines(virtual_lights[i])) continue;
    cluster.position = virtual_lights[i].position;
    cluster.count = 0.0;
    cluster.normal = vec4(virtual_lights[i].normal, 0.0);
    break;
  }
  clusters[k] = cluster;
}
