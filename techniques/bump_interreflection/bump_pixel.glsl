// What a pass that adds light from bump to bump asks of a pixel. ENTERING 1: the light that enters translucent bumps is asked for.
// MATERIAL_MODELS: bit 1 << kind of each model of the scene; 0: the program knows metallic-roughness alone.
#ifndef BUMP_PIXEL_GLSL
#define BUMP_PIXEL_GLSL
#include "glsl/light/light_centre.glsl"
#include "glsl/light/light_texture.glsl"
#include "glsl/numeric/sampling.glsl"
#include "glsl/relief/relief_field.glsl"
#include "glsl/relief/relief_input.glsl"
#include "glsl/surface/brdf.glsl"
#if MATERIAL_MODELS
#include "glsl/materials/material_model.glsl"
#if (MATERIAL_MODELS & 8) != 0
#include "glsl/materials/banks.glsl"
#endif
#if (MATERIAL_MODELS & 32) != 0
#include "glsl/materials/coated.glsl"
#endif

layout(std430) readonly buffer MaterialModels { MaterialModel material_models[]; };  // of each material
#endif

layout(rgba32f) uniform image2D radiance;
layout(std430) readonly buffer Lights { Light lights[]; };
#if VISIBILITY
uniform sampler2DArray visibility;
#endif
#if FLAT_BASES
layout(std430) readonly buffer BasesOfInstances { uint bases_of_instances[]; };
#endif

#if ENTERING
uniform sampler2D body_albedo;
#endif

// Albedo of a pixel's diffuse part, under a coat as well; 0 of specular surfaces, which take no indirect light.
vec3 pixel_albedo(ivec2 pixel) {
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) != 0u) return vec3(0.0);
#if MATERIAL_MODELS
  MaterialModel model = material_models[instances[pixel_instance(pixel)].material];
#if (MATERIAL_MODELS & 8) != 0
  if (model.kind == model_banks) return banks_diffuse_albedo(model);
#endif
#if (MATERIAL_MODELS & 32) != 0
  if (model.kind == model_coated) return coated_albedo(model);
#endif
  if (model.kind != model_none) return model.kd;
#endif
  SurfaceBrdf brdf =
      surface_brdf(s.base_colour, s.metallic, s.roughness, s.specular_factor, s.specular_colour, s.ior);
  return brdf.diffuse * brdf_diffuse_weight(brdf, 1.0);
}

// Albedo of the bumps that send light to a pixel with that albedo, which look like its own: of what enters a body, here without
// regard to directions, the body's albedo leaves again.
vec3 sender_albedo(ivec2 pixel, vec3 albedo) {
#if ENTERING
  return albedo * gbuffer_colour_decode(texelFetch(body_albedo, pixel, 0).rgb);
#else
  return albedo;
#endif
}

// Irradiance across the direction of a light that is number `layer` of its batch.
vec3 arriving_light(Light light, vec3 position, ivec2 pixel, int layer) {
  vec3 sent = light_centre_irradiance(light, position) * light_texture(light, position);
#if VISIBILITY
  sent *= texelFetch(visibility, ivec3(pixel, layer), 0).x;
#endif
  return sent;
}

// Where in the map the light of a pixel is looked up for the i-th of `count` times, in texels. size: of the pixel in the map, in
// texels.
vec2 footprint_place(vec2 place, float size, int i, int count) {
  return place + size * (r2_point(uint(i), uint(count)) - 0.5);
}

uint nearest_texel(ivec2 size, bool clamped, vec2 place) {
  vec2 texel = floor(place + 0.5);
  return uint(size.x * relief_wrapped(texel.y, size.y, clamped) + relief_wrapped(texel.x, size.x, clamped));
}

#endif  // BUMP_PIXEL_GLSL
