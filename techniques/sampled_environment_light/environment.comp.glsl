// Reflected light of the environment as a sum over directions, each shadowed by its own map and reflected by the whole
// BRDF. Each batch adds its part.
#include "glsl/shadow/shadow_samples.glsl"
#include "glsl/surface/surface_response.glsl"

layout(rgba32f) uniform image2D radiance;
layout(std430) readonly buffer Irradiance { vec4 irradiance[]; };  // on surfaces that face the sample, were it all

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) != 0u) return;
  SurfaceMaterial surface = pixel_material(pixel, s);
  VisibilityQuery q;
  q.position = pixel_position(pixel, depth);
  q.normal = s.geometric_normal;
  vec3 to_viewer = normalize(frame.camera_position.xyz - q.position);
  vec3 sum = vec3(0.0);
  uint uncovered = 0u;
  for (int i = 0; i < batch_samples; ++i) {
    ShadowLight maps = maps_at(uint(i));
    vec3 direction = maps.origin;
    float cosine = dot(s.normal, direction);
    if (cosine <= 0.0 || dot(q.normal, direction) <= 0.0) continue;
    q.light.axis = -direction;
    if (!sample_visible(q, maps, uncovered)) continue;
    sum += surface_response(surface, s.normal, to_viewer, direction) * irradiance[first_sample + i].rgb;
  }
  count_uncovered(uncovered);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum / float(total_samples), 0.0));
}
