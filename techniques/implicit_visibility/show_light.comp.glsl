// Adds what surfaces reflect of the irradiance interpolated between leaves.
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/surface/reflectance.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
layout(std430) readonly buffer Irradiance { vec4 irradiance[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  if (pixel_depth(pixel) == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  Around a = around_pixel(pixel);
  if (!a.found) return;
  vec3 light = a.weights.x * irradiance[a.slots.x].rgb + a.weights.y * irradiance[a.slots.y].rgb +
               a.weights.z * irradiance[a.slots.z].rgb;
  SurfaceBrdf material = surface_brdf(surface.base_colour, surface.metallic, surface.roughness, surface.specular_factor,
                                      surface.specular_colour, surface.ior);
  vec3 reflected = hemispherical_reflectance(material) * light * inverse_pi;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(reflected, 0.0));
}
