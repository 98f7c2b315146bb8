// Adds what surfaces reflect of the caustics' irradiance, diffusely. Where it comes from is not known any more: what Fresnel's
// term leaves to the diffuse part is its mean over all directions of light.
#include "glsl/light/ltc.glsl"
#include "glsl/surface/brdf.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D irradiance;
layout(rgba32f) uniform image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec3 arriving = texelFetch(irradiance, pixel, 0).rgb;
  if (arriving == vec3(0.0)) return;
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) != 0u) return;
  SurfaceBrdf material =
      surface_brdf(s.base_colour, s.metallic, s.roughness, s.specular_factor, s.specular_colour, s.ior);
  float weight = 1.0;
  if (!brdf_is_lambertian(material)) {
    float cosine = -dot(s.normal, normalize(pixel_ray(pixel)));
    weight = ltc_diffuse_weight(material, ltc_lookup(cosine, material.alpha));
  }
  vec3 reflected = arriving * (material.diffuse * weight) * inverse_pi;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(reflected, 0.0));
}
