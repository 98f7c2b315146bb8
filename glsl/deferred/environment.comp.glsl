// Adds the light of the environment on every surface to the radiance, unoccluded (V = 1). MEDIUM 1: the medium takes its part.
#include "glsl/light/reflected_environment.glsl"
#if MEDIUM
#include "glsl/media/environment_transmittance.glsl"
#endif

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
  ReflectedParts light = reflected_environment(material, surface.normal, surface.geometric_normal, v);
#if MEDIUM
  light = environment_through_medium(light, has_coat(material), pixel_position(pixel, depth), surface.normal, v);
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(reflected_whole(light), 0.0));
}
