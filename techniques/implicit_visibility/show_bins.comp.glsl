// Per-pixel gathering: the BRDF of the pixel's own normal and view over the bins of the leaves around it. SKY, MEDIUM
// as in bin_lookup.glsl. Leaves whose links are not bound are left to the passes that have them.
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/surface/brdf.glsl"
#include "techniques/implicit_visibility/bin_reflection.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform uint first_leaf;
uniform uint leaf_count;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  Around a = around_pixel(pixel);
  if (!a.found) return;
  SurfaceBrdf material = surface_brdf(surface.base_colour, surface.metallic, surface.roughness, surface.specular_factor,
                                      surface.specular_colour, surface.ior);
  material.alpha = binned_alpha(material.alpha, BINS);
  vec3 n = to_bins(surface.normal);
  vec3 ng = to_bins(surface.geometric_normal);
  vec3 v = to_bins(-normalize(pixel_ray(pixel)));
  vec3 place = pixel_position(pixel, depth);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 3; ++k) {
    uint row = a.slots[k] - first_leaf;
    if (a.weights[k] > 0.0 && row < leaf_count) sum += a.weights[k] * reflected(row, place, material, n, ng, v);
  }
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
