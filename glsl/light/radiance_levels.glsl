// An environment's radiance with coarser levels, from which samples of a lobe take the mean over what each of them stands for
// (Krivanek and Colbert 2008, Real-Time Shading with Filtered Importance Sampling). The map is equirectangular
// (glsl/numeric/equirectangular.glsl), in the environment's own frame; each level has half the rows and columns of the one before.
// ShadingMapService::radianceLevels() makes it.
#ifndef LIMN_RADIANCE_LEVELS_GLSL
#define LIMN_RADIANCE_LEVELS_GLSL
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Level, not negative and finite, of which a texel covers the solid angle `spread` (sr, positive) around a direction (unit, in the
// map's frame). size: of level 0, texels. Texels shrink towards the poles with the sine of the angle from there; of a spread that
// holds a pole it is the mean, 2/3 of the sine at the rim of a disc so large.
LIMN_FN float radiance_level(vec3 direction, float spread, ivec2 size) {
  float sine = max(length(vec2(direction.x, direction.z)), 0.376f * sqrt(spread));
  float texel = 2.0f * pi * pi / (float(size.x) * float(size.y)) * clamp(sine, 1e-6f, 1.0f);
  return max(0.5f * log2(spread / texel), 0.0f);
}

#ifndef __cplusplus
uniform sampler2D environment_levels_map;

// Mean radiance over `spread` (sr) around a world direction (unit); rotation in radians about +Y and scale: of the environment.
vec3 radiance_around(vec3 direction, float spread, float rotation, float scale) {
  vec3 towards = environment_lookup_direction(direction, rotation);
  float level = radiance_level(towards, spread, textureSize(environment_levels_map, 0));
  return scale * textureLod(environment_levels_map, equirectangular_uv(towards), level).rgb;
}
#endif

LIMN_END
#endif  // LIMN_RADIANCE_LEVELS_GLSL
