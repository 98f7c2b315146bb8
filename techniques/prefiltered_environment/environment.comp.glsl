// Adds the light of the environment that surfaces reflect, unoccluded (V = 1): lookups in the prefiltered maps. MEDIUM 1: times
// the medium's transmittance along the normal.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/light/prefiltered.glsl"
#include "glsl/media/medium_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform sampler2DArray irradiance_map;  // W/m^2 on surfaces that face the direction
uniform sampler2DArray sharp_map;       // level 0: radiance
uniform sampler2DArray filtered_map;    // filtered for the widths of environment_level() 1, 2, ...

vec3 irradiance_towards(vec3 n) {
  vec3 direction = environment_lookup_direction(n, frame.environment_rotation);
  return frame.environment_scale * prefiltered_lookup(irradiance_map, direction, 0);
}

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

// Radiance that a glTF surface reflects towards v.
vec3 gltf_reflection(GBufferSurface surface, vec3 v) {
  SurfaceBrdf s = surface_brdf(surface.base_colour, surface.metallic, surface.roughness, surface.specular_factor,
                               surface.specular_colour, surface.ior);
  vec3 irradiance = irradiance_towards(surface.normal);
  if (brdf_is_lambertian(s)) return s.diffuse * irradiance * inverse_pi;
  LtcTerms terms = ltc_lookup(dot(surface.normal, v), s.alpha);
  vec3 towards = prefiltered_direction(LOOKUP, terms, surface.normal, v, s.alpha);
  return environment_reflection(s, terms, irradiance, filtered_radiance(towards, s.alpha));
}

// The answer of the surface's model.
vec3 reflected_environment(GBufferSurface surface, vec3 v) { return gltf_reflection(surface, v); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 light = reflected_environment(surface, -normalize(pixel_ray(pixel)));
#if MEDIUM
  Medium medium = scene_medium();
  light *= medium_transmittance(medium, medium_length(medium, pixel_position(pixel, depth), surface.normal, 3.0e38));
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
