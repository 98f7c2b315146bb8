// Adds the light of the environment that surfaces reflect, unoccluded (V = 1): lookups in the prefiltered maps. MEDIUM 1: the
// medium takes its part. GGX_LOBES 0: metallic-roughness surfaces are Lambertian.
#include "glsl/surface/surface_response.glsl"
#include "glsl/light/prefiltered.glsl"
#if MATERIAL_MODELS
#include "glsl/light/prefiltered_models.glsl"
#endif
#if (MATERIAL_MODELS & 160) != 0
#include "glsl/light/coated_environment.glsl"
#endif
#if MEDIUM
#include "glsl/media/environment_transmittance.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform sampler2DArray irradiance_map;  // W/m^2 on surfaces that face the direction
uniform sampler2DArray sharp_map;       // level 0: radiance

vec3 irradiance_towards(vec3 n) {
  vec3 direction = environment_lookup_direction(n, frame.environment_rotation);
  return frame.environment_scale * prefiltered_lookup(irradiance_map, direction, 0);
}

#if GGX_LOBES
uniform sampler2DArray filtered_map;  // filtered for the widths of environment_level() 1, 2, ...

// Radiance around `towards`, filtered by a GGX lobe of that width.
vec3 filtered_radiance(vec3 towards, float alpha) {
  vec3 direction = environment_lookup_direction(towards, frame.environment_rotation);
  float level = environment_level(alpha);
  int low = min(int(level), environment_levels - 2);
  vec3 sharper = low == 0 ? prefiltered_lookup(sharp_map, direction, 0)
                          : prefiltered_lookup(filtered_map, direction, low - 1);
  vec3 wider = prefiltered_lookup(filtered_map, direction, low);
  return frame.environment_scale * mix(sharper, wider, level - float(low));
}
#endif

// Light that a metallic-roughness surface reflects towards v. n, ng: shading and geometric normal, here and below.
ReflectedParts brdf_reflection(SurfaceBrdf s, vec3 n, vec3 ng, vec3 v) {
  vec3 irradiance = irradiance_towards(n);
#if GGX_LOBES
  if (!brdf_is_lambertian(s)) {
    LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
    vec3 towards = prefiltered_direction(LOOKUP, terms, n, v, s.alpha);
    vec3 filtered = environment_lobe_share(terms, n, ng, v, s.alpha) * filtered_radiance(towards, s.alpha);
    return environment_reflection(s, terms, irradiance, filtered);
  }
#endif
  return ReflectedParts(s.diffuse * irradiance * inverse_pi, vec3(0.0));
}

#if (MATERIAL_MODELS & 22) != 0
uniform sampler2DArray power_map;  // filtered with power lobes of the widths power_level_alpha() 0, 1, ...

vec3 lobe_radiance(PrefilteredLobe lobe, vec3 n, vec3 ng) {
  vec3 direction = environment_lookup_direction(lobe.towards, frame.environment_rotation);
  PowerPlace place = power_place(lobe.alpha);
  vec3 narrower = place.wider == 0 ? prefiltered_lookup(sharp_map, direction, 0)
                                   : prefiltered_lookup(power_map, direction, max(place.wider, 1) - 1);
  vec3 wider = prefiltered_lookup(power_map, direction, place.wider);
  float share = prefiltered_lobe_share(lobe, n, ng);
  return share * lobe.reflectance * frame.environment_scale * mix(narrower, wider, place.weight);
}
#endif

#if (MATERIAL_MODELS & 6) != 0
uniform sampler2D microfacet_lobes;

MicrofacetLobe microfacet_lobe_entry(float n_dot_v, float alpha) {
  float size = float(microfacet_lobe_table_size);
  vec2 uv = (microfacet_lobe_place(n_dot_v, alpha) * (size - 1.0) + 0.5) / size;
  vec4 entry = textureLod(microfacet_lobes, uv, 0.0);
  return MicrofacetLobe(entry.x, entry.y, entry.z, entry.w);
}
#endif

#if (MATERIAL_MODELS & 160) != 0
uniform sampler2DArray grazing_map;  // as irradiance_map, of light weighted by schlick_weight(n.l)

vec3 grazing_light(vec3 n) {
  vec3 direction = environment_lookup_direction(n, frame.environment_rotation);
  return frame.environment_scale * prefiltered_lookup(grazing_map, direction, 0);
}
#endif

#if MATERIAL_MODELS
// Light that a surface with a model reflects towards v; of the kinds without an answer below it is that of the
// metallic-roughness surface next to it.
ReflectedParts model_reflection(SurfaceMaterial s, vec3 n, vec3 ng, vec3 v) {
  MaterialModel m = s.model;
#if (MATERIAL_MODELS & 6) != 0
  if (m.kind == model_torrance_sparrow || m.kind == model_ward) {
    MicrofacetLobe entry = microfacet_lobe_entry(dot(n, v), microfacet_lobe_alpha(m));
    return ReflectedParts(m.kd * irradiance_towards(n) * inverse_pi,
                          lobe_radiance(microfacet_prefiltered_lobe(m, entry, LOOKUP, n, v), n, ng));
  }
#endif
#if (MATERIAL_MODELS & 8) != 0
  if (m.kind == model_banks) return ReflectedParts(banks_albedo(m) * irradiance_towards(n) * inverse_pi, vec3(0.0));
#endif
#if (MATERIAL_MODELS & 16) != 0
  if (m.kind == model_phong)
    return ReflectedParts(m.kd * irradiance_towards(n) * inverse_pi, lobe_radiance(phong_prefiltered_lobe(m, LOOKUP, n, v), n, ng));
#endif
#if (MATERIAL_MODELS & 32) != 0
  if (m.kind == model_coated) {
    vec3 mirror = environment_lookup_direction(mirror_direction(n, v), frame.environment_rotation);
    vec3 mirrored = frame.environment_scale * prefiltered_lookup(sharp_map, mirror, 0);
    return coated_environment(m, n, ng, v, irradiance_towards(n), grazing_light(n), mirrored);
  }
#endif
#if (MATERIAL_MODELS & 128) != 0
  vec3 entering = entering_irradiance(m, vec3(1.0) - m.kd, irradiance_towards(n), grazing_light(n));
  return ReflectedParts(inverse_pi * entering, vec3(0.0));
#endif
  return brdf_reflection(nearest_brdf(s), n, ng, v);
}
#endif

// The answer of the surface's model.
ReflectedParts reflected_environment(SurfaceMaterial material, GBufferSurface surface, vec3 v) {
#if MATERIAL_MODELS
  if (has_model(material)) return model_reflection(material, surface.normal, surface.geometric_normal, v);
#endif
  return brdf_reflection(material.brdf, surface.normal, surface.geometric_normal, v);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 v = -normalize(pixel_ray(pixel));
  SurfaceMaterial material = pixel_material(pixel, surface);
  ReflectedParts light = reflected_environment(material, surface, v);
#if MEDIUM
  light = environment_through_medium(light, has_coat(material), pixel_position(pixel, depth), surface.normal, v);
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(reflected_whole(light), 0.0));
}
