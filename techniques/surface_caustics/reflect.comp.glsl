// Adds what surfaces reflect of the caustics' irradiance, diffusely. Where it comes from is not known any more: what Fresnel's
// term leaves to the diffuse part is its mean over all directions of light.
// MATERIAL_MODELS, SURFACE_TANGENTS, SURFACE_PLACES: see surface_response.glsl. TRANSLUCENT 1: some surfaces are translucent.
#include "glsl/light/ltc.glsl"
#include "glsl/surface/surface_response.glsl"
#if TRANSLUCENT
#include "glsl/diffusion/boundary.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D irradiance;
layout(rgba32f) uniform image2D radiance;

// Of the diffuse part, which of a coat is its base; cosine: n.v.
vec3 diffuse_reflectance(SurfaceMaterial material, float cosine) {
#if (MATERIAL_MODELS & 32) != 0
  if (material.model.kind == model_coated)
    return coated_base(material.model, vec3(1.0) - coated_mirror(material.model, cosine));
#endif
#if MATERIAL_MODELS
  if (has_model(material)) return model_diffuse_albedo(material.model);
#endif
  if (brdf_is_lambertian(material.brdf)) return material.brdf.diffuse;
  return material.brdf.diffuse * ltc_diffuse_weight(material.brdf, ltc_lookup(cosine, material.brdf.alpha));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec3 arriving = texelFetch(irradiance, pixel, 0).rgb;
  if (arriving == vec3(0.0)) return;
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) != 0u) return;
  float cosine = -dot(s.normal, normalize(pixel_ray(pixel)));
  vec3 reflectance = diffuse_reflectance(pixel_material(pixel, s), cosine);
#if TRANSLUCENT
  // The local limit, A F_t / (1 - F_de) of what enters, which of light from all sides is 1 - F_de of what arrives.
  if ((s.flags & gbuffer_flag_translucent) != 0u)
    reflectance = s.base_colour * diffusion_entry(diffusion_boundary(s.ior), cosine);
#endif
  vec3 reflected = arriving * reflectance * inverse_pi;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(reflected, 0.0));
}
