// Prefiltered environments: maps of an environment's radiance blurred by a surface's lobe, and where a surface looks into
// them (Kautz, Vazquez, Heidrich, Seidel 2000, A Unified Approach to Prefiltered Environment Maps; Karis 2013, Real Shading
// in Unreal Engine 4).
//
// Maps are layers of a 2D array, in the environment's own frame. A dual paraboloid map has two layers of size x size, the
// hemispheres around +z and -z; the discs end one texel before the edge, and the texels beyond the rim hold the directions
// that follow there, so that bilinear lookups need no other layer. An equirectangular map has one layer of 2 size x size,
// rows from pole to pole: as many texels. Where its size is no power of two, levels of it may have one column more than twice
// their rows, since both are halved and rounded down. Places are texture coordinates and the layer; `texel` is a position in
// texels, whose centres lie at halves.
#ifndef LIMN_PREFILTERED_GLSL
#define LIMN_PREFILTERED_GLSL
#include "glsl/light/environment.glsl"
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/numeric/stereographic.glsl"
#include "glsl/surface/brdf.glsl"
LIMN_BEGIN

// --- Dual paraboloid maps ---

// direction: unit.
LIMN_FN vec3 dual_paraboloid_place(vec3 direction, int size) {
  float scale = (0.5f - 1.0f / float(size)) / (1.0f + abs(direction.z));
  return vec3(0.5f + scale * direction.x, 0.5f + scale * direction.y, direction.z < 0.0f ? 1.0f : 0.0f);
}

// Position on the disc of radius 1.
LIMN_FN vec2 dual_paraboloid_disc(vec2 texel, int size) {
  return (texel - vec2(0.5f * float(size))) / (0.5f * float(size) - 1.0f);
}

LIMN_FN vec3 dual_paraboloid_direction(vec2 texel, int layer, int size) {
  vec3 direction = paraboloid_direction(dual_paraboloid_disc(texel, size));
  return vec3(direction.x, direction.y, layer == 0 ? direction.z : -direction.z);
}

// Solid angle of a texel by its scale at that position, sr.
LIMN_FN float dual_paraboloid_density(vec2 texel, int size) {
  vec2 disc = dual_paraboloid_disc(texel, size);
  float side = 1.0f / ((0.5f * float(size) - 1.0f) * paraboloid_scale(dot(disc, disc)));
  return side * side;
}

// The same around a direction, which is unit.
LIMN_FN float dual_paraboloid_density_towards(vec3 direction, int size) {
  float side = (1.0f + abs(direction.z)) / (0.5f * float(size) - 1.0f);
  return side * side;
}

// --- Equirectangular maps with rows on the poles ---

LIMN_FN vec3 polar_map_place(vec3 direction, int size) {
  vec2 place = environment_place(direction, size);
  return vec3(place.x, place.y, 0.0f);
}

// Radians from the pole +y; texels of the first and last row reach beyond the poles.
LIMN_FN float polar_map_angle(float row, int size) { return pi * (row - 0.5f) / float(size - 1); }

// size: columns and rows, here and in polar_map_density().
LIMN_FN vec3 polar_map_direction(vec2 texel, ivec2 size) {
  return equirectangular_direction(vec2(texel.x / float(size.x), polar_map_angle(texel.y, size.y) * inverse_pi));
}

LIMN_FN float polar_map_density(vec2 texel, ivec2 size) {
  float area = 2.0f * pi * pi / (float(size.x) * float(size.y - 1));
  return area * max(abs(sin(polar_map_angle(texel.y, size.y))), 1e-6f);
}

// --- Filtering ---

// One direction of the GGX lobe at normal incidence, in the frame of its axis.
struct PrefilterSample {
  vec3 direction;
  float weight;  // 0 below the horizon
  float spread;  // solid angle that the sample stands for, sr
};

// Sample i of `count`: a rank-1 lattice of the golden ratio through the density of visible normals.
LIMN_FN PrefilterSample prefilter_sample(float alpha, int i, int count) {
  vec2 u = vec2(fract(0.61803399f * float(i)), (float(i) + 0.5f) / float(count));
  vec3 h = sample_visible_normal(vec3(0.0f, 0.0f, 1.0f), vec2(alpha), u);
  PrefilterSample s;
  s.direction = vec3(2.0f * h.z * h.x, 2.0f * h.z * h.y, 2.0f * h.z * h.z - 1.0f);
  float pdf = 0.25f * ggx_distribution(h.z, h.x * h.x + h.y * h.y, alpha);
  float cosine = s.direction.z;
  s.weight = cosine > 0.0f ? ggx_visibility(1.0f, cosine, alpha) * cosine : 0.0f;
  s.spread = 1.0f / (float(count) * max(pdf, 1e-12f));
  return s;
}

// Level of a chain of maps, each half as large as the one before, in which a texel covers as much as the sample; density:
// solid angle of a texel of level 0 there. Half a level more hides the gaps between samples (Krivanek and Colbert 2008).
LIMN_FN float prefilter_source_level(float spread, float density) {
  return max(0.0f, 0.5f * log2(spread / density) + 0.5f);
}

// --- Lookups ---

LIMN_CONST int prefiltered_lookup_mirror = 0;        // along the mirror direction
LIMN_CONST int prefiltered_lookup_normal_drawn = 1;  // drawn towards the normal by alpha^2 (Filament)
LIMN_CONST int prefiltered_lookup_centroid = 2;      // along the middle of the lobe that was fitted to the BRDF
LIMN_CONST int prefiltered_lookup_uncut = 3;         // as mirror, with Phong's lobe whole: not times its share above the horizon

// Direction in which a GGX lobe looks into the map of its width: unit. terms: of n.v and alpha.
LIMN_FN vec3 prefiltered_direction(int lookup, LtcTerms terms, vec3 n, vec3 v, float alpha) {
  if (lookup == prefiltered_lookup_centroid) return environment_lobe_direction(terms, n, v, alpha);
  vec3 mirror = mirror_direction(n, v);
  if (lookup != prefiltered_lookup_normal_drawn) return mirror;
  vec3 drawn = mix(mirror, n, alpha * alpha);
  float size = length(drawn);
  return size > 1e-6f ? drawn / size : n;
}

// The width alpha that a Phong lobe (r.l)^p is as wide as: Beckmann's at normal incidence, p = 1 / (2 alpha^2) - 1/2.
LIMN_FN float power_lobe_alpha(float p) { return inversesqrt(2.0f * p + 1.0f); }

// The part of a Phong lobe (r.l)^p about the mirror direction r that lies above the horizon of the surface.
struct PhongPart {
  float share;  // of the whole lobe, in [0, 1]: what a map that was filtered with the whole lobe is multiplied by
  float lift;   // of the part's middle above r, towards the normal, radians
  float alpha;  // its width
};

// Across the horizon the lobe falls as a Gaussian of the elevation e of r, sin e = n.v, of variance 1 / (p + 3/4): the share is
// (1 + erf(e sqrt((p + 3/4) / 2))) / 2, within 2.4e-3 for p >= 10, 5e-3 for p = 5 and 0.025 for p = 1; 0.75 centres the errors.
// erf: Abramowitz and Stegun, 7.1.25, within 2.5e-5. Lift and width are those of the Gaussian cut off there, whose variance
// shrinks across the horizon and not along it.
LIMN_FN PhongPart phong_above_horizon(float n_dot_v, float p) {
  float cosine = min(abs(n_dot_v), 1.0f);
  float elevation = atan(cosine, sqrt(1.0f - cosine * cosine));
  float sharpness = sqrt(p + 0.75f);
  float x = elevation * sharpness * 0.70710678f;
  float t = 1.0f / (1.0f + 0.47047f * x);
  float tail = 0.5f * t * (0.3480242f + t * (-0.0958798f + t * 0.7478556f));  // of the Gaussian, over exp(-x^2)
  float gauss = exp(-x * x);
  bool below = n_dot_v < 0.0f;
  PhongPart part;
  part.share = below ? tail * gauss : 1.0f - tail * gauss;
  float slope = 0.39894228f * (below ? 1.0f / tail : gauss / part.share);
  part.lift = slope / sharpness;
  float shrunk = 1.0f - slope * ((below ? -1.41421356f : 1.41421356f) * x + slope);
  part.alpha = power_lobe_alpha(p) * sqrt(0.5f + 0.5f * clamp(shrunk, 0.0f, 1.0f));
  return part;
}

#ifndef __cplusplus
// The map that PREFILTERED_PARABOLOID chooses: 1, or 0 for an equirectangular one.

vec3 prefiltered_place(vec3 direction, int size) {
#if PREFILTERED_PARABOLOID
  return dual_paraboloid_place(direction, size);
#else
  return polar_map_place(direction, size);
#endif
}

// size: columns and rows of the level, here and in prefiltered_density().
vec3 prefiltered_texel_direction(vec2 texel, int layer, ivec2 size) {
#if PREFILTERED_PARABOLOID
  return dual_paraboloid_direction(texel, layer, size.y);
#else
  return polar_map_direction(texel, size);
#endif
}

float prefiltered_density(vec2 texel, ivec2 size) {
#if PREFILTERED_PARABOLOID
  return dual_paraboloid_density(texel, size.y);
#else
  return polar_map_density(texel, size);
#endif
}

// The density of a map of `size` rows around a direction, of an equirectangular one the mean.
float prefiltered_density_towards(vec3 direction, int size) {
#if PREFILTERED_PARABOLOID
  return dual_paraboloid_density_towards(direction, size);
#else
  return 2.0 * pi / float(size * size);
#endif
}

// Bilinear lookup in one level; direction: unit. Levels may differ between pixels, for which the size of a level is not asked:
// drivers are known to answer all pixels of a group with that of one.
vec3 prefiltered_lookup(sampler2DArray map, vec3 direction, int level) {
  return textureLod(map, prefiltered_place(direction, textureSize(map, 0).y >> level), float(level)).rgb;
}
#endif

LIMN_END
#endif  // LIMN_PREFILTERED_GLSL
