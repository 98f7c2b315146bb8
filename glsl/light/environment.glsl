// Light of an environment on a surface, unoccluded: the exact irradiance for the diffuse part, a split sum
// for the glossy one (radiance filtered by the lobe at normal incidence, times the reflectance of the lobe).
//
// Maps are equirectangular (glsl/numeric/equirectangular.glsl) with rows from pole to pole, in the environment's own
// frame, by shading::filterEnvironment: irradiance in W/m^2, and radiance filtered at environment_levels
// roughnesses from 0 to 1, one per mip level, in half floats: divided by the square of the alpha channel, which is the same power
// of two everywhere and makes them fit.
#ifndef LIMN_ENVIRONMENT_GLSL
#define LIMN_ENVIRONMENT_GLSL
#include "glsl/surface/brdf.glsl"
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/light/ltc.glsl"
#include "glsl/surface/reflected_parts.glsl"
LIMN_BEGIN

LIMN_CONST int environment_irradiance_width = 64;  // texels; the height is half of it
LIMN_CONST int environment_filtered_width = 512;   // of level 0
LIMN_CONST int environment_levels = 6;

// Texture coordinates of a direction (in the environment's frame) in a map of `height` rows whose first and
// last rows lie on the poles.
LIMN_FN vec2 environment_place(vec3 direction, int height) {
  vec2 uv = equirectangular_uv(direction);
  return vec2(uv.x, (0.5f + uv.y * float(height - 1)) / float(height));
}

// Mip level of the filtered map for a lobe of width alpha.
LIMN_FN float environment_level(float alpha) {
  float low = sqrt(brdf_min_alpha);
  return clamp((sqrt(alpha) - low) / (1.0f - low), 0.0f, 1.0f) * float(environment_levels - 1);
}

// alpha at a level: inverse of environment_level.
LIMN_FN float environment_alpha(float level) {
  float low = sqrt(brdf_min_alpha);
  float root = mix(low, 1.0f, level / float(environment_levels - 1));
  return root * root;
}

// Direction of the glossy lobe's middle, where the filtered map is looked up: the mirror direction for smooth
// surfaces, drawn towards the normal as roughness grows.
LIMN_FN vec3 environment_lobe_direction(LtcTerms terms, vec3 n, vec3 v, float alpha) {
  return ltc_transform(terms, n, v, alpha).z;
}

// Share of the glossy lobe, as far as it lies above the horizon of the shading normal n, that lies above the horizon of the
// geometric normal ng as well: no light comes from below that. 1 where both are the same, and of smooth surfaces 0 where the mirror
// direction lies below the latter.
LIMN_FN float environment_lobe_share(LtcTerms terms, vec3 n, vec3 ng, vec3 v, float alpha) {
  LtcTransform lobe = ltc_transform(terms, n, v, alpha);
  return min(ltc_share_above(lobe, ng) / ltc_share_above(lobe, n), 1.0f);
}

// Reflected radiance. irradiance: at the shading normal; filtered: radiance at the lobe's middle and level.
LIMN_FN ReflectedParts environment_reflection(SurfaceBrdf s, LtcTerms terms, vec3 irradiance, vec3 filtered) {
  ReflectedParts light;
  light.diffuse = s.diffuse * irradiance * inverse_pi;
  light.lobe = vec3(0.0f);
  if (brdf_is_lambertian(s)) return light;
  light.diffuse *= ltc_diffuse_weight(s, terms);
  light.lobe = filtered * ltc_specular_reflectance(s, terms);
  return light;
}

#ifndef __cplusplus
uniform sampler2D environment_irradiance;
uniform sampler2D environment_filtered;

vec3 environment_filtered_level(vec3 direction, int level) {
  int height = environment_filtered_width / 2 >> level;
  vec4 scaled = textureLod(environment_filtered, environment_place(direction, height), float(level));
  return scaled.a * scaled.a * scaled.rgb;
}

// rotation in radians about +Y and scale as in FrameBlock.environment.
vec2 environment_irradiance_place(vec3 n, float rotation) {
  return environment_place(environment_lookup_direction(n, rotation), environment_irradiance_width / 2);
}
vec3 environment_irradiance_towards(vec3 n, float rotation, float scale) {
  return scale * textureLod(environment_irradiance, environment_irradiance_place(n, rotation), 0.0).rgb;
}

// n, ng: shading and geometric normal.
ReflectedParts environment_light(SurfaceBrdf s, vec3 n, vec3 ng, vec3 v, float rotation, float scale) {
  vec3 irradiance = environment_irradiance_towards(n, rotation, scale);
  LtcTerms terms = ltc_lookup(dot(n, v), s.alpha);
  vec3 filtered = vec3(0.0);
  if (!brdf_is_lambertian(s)) {
    vec3 middle = environment_lookup_direction(environment_lobe_direction(terms, n, v, s.alpha), rotation);
    float level = environment_level(s.alpha);
    int low = min(int(level), environment_levels - 2);
    filtered = scale * environment_lobe_share(terms, n, ng, v, s.alpha) *
               mix(environment_filtered_level(middle, low), environment_filtered_level(middle, low + 1), level - float(low));
  }
  return environment_reflection(s, terms, irradiance, filtered);
}
#endif

LIMN_END
#endif  // LIMN_ENVIRONMENT_GLSL
