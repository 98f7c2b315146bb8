// Adds the light of the environment on every surface to the radiance, unoccluded (V = 1). MEDIUM 1: times the medium's
// transmittance along the normal.
#include "glsl/light/reflected_environment.glsl"
#include "glsl/media/medium_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 v = -normalize(pixel_ray(pixel));
  SurfaceMaterial material = pixel_material(pixel, surface);
  vec3 light = reflected_whole(reflected_environment(material, surface.normal, surface.geometric_normal, v));
#if MEDIUM
  Medium medium = scene_medium();
  light *= medium_transmittance(medium, medium_length(medium, pixel_position(pixel, depth), surface.normal, 3.0e38));
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
