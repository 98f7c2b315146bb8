// A picture of the clusters: each pixel in the colour of the cluster that a virtual light would belong to there, and the
// virtual lights as dots of the colours of theirs.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/numeric/sampling.glsl"
#include "glsl/indirect/virtual_area_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer VirtualLights { VirtualPointLight virtual_lights[]; };
layout(std430) readonly buffer Clusters { VirtualAreaLight clusters[]; };
layout(rgba32f) writeonly uniform image2D radiance;
uniform float weight_position;
uniform float weight_angle;

const float dot_radius = 0.004;  // of the scene's extent

vec3 colour_of(uint cluster) { return mix(vec3(0.1), vec3(1.0), pixel_noise(cluster, 17u, 3u)); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  float extent = 2.0 * frame.scene_radius;
  VirtualPointLight here;
  here.position = pixel_position(pixel, depth);
  here.cluster = 0.0;
  here.normal = pixel_geometric_normal(pixel);
  uint nearest = 0u;
  float least = 3.0e38;
  for (uint k = 0u; k < uint(clusters.length()); ++k) {
    float distance = cluster_distance(here, clusters[k], 1.0 / extent, weight_position, weight_angle);
    if (clusters[k].count > 0.0 && distance < least) {
      least = distance;
      nearest = k;
    }
  }
  vec3 colour = 0.5 * colour_of(nearest);
  for (uint i = 0u; i < uint(virtual_lights.length()); ++i) {
    vec3 offset = virtual_lights[i].position - here.position;
    if (virtual_light_shines(virtual_lights[i]) && dot(offset, offset) < dot_radius * dot_radius * extent * extent)
      colour = colour_of(uint(virtual_lights[i].cluster));
  }
  imageStore(radiance, pixel, vec4(depth > 0.0 && least < 3.0e38 ? colour : vec3(0.0), 1.0));
}
