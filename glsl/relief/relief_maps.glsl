// Lookups in the tables of relief_maps::ReliefMapService. RELIEF_AZIMUTHS: of horizon maps.
#ifndef LIMN_RELIEF_MAPS_GLSL
#define LIMN_RELIEF_MAPS_GLSL
#include "glsl/relief/horizon_map.glsl"
#include "glsl/relief/relief_field.glsl"

layout(std430) readonly buffer ReliefFields { ReliefField relief_fields[]; };
layout(std430) readonly buffer ReliefValues { uint relief_values[]; };

// The four texels around a place, as numbers within their level, and how far the place lies from the first of them.
struct ReliefTexels {
  ivec4 index;  // (0, 0), (1, 0), (0, 1), (1, 1)
  vec2 part;
};

// place: in texels of the level, texel (i, j) at (i, j).
ReliefTexels relief_texels(ivec2 size, bool clamped, vec2 place) {
  vec2 corner = floor(place);
  int x0 = relief_wrapped(corner.x, size.x, clamped);
  int x1 = relief_wrapped(corner.x + 1.0, size.x, clamped);
  int y0 = size.x * relief_wrapped(corner.y, size.y, clamped);
  int y1 = size.x * relief_wrapped(corner.y + 1.0, size.y, clamped);
  ReliefTexels t;
  t.index = ivec4(y0 + x0, y0 + x1, y1 + x0, y1 + x1);
  t.part = place - corner;
  return t;
}

vec4 relief_weights(vec2 part) {
  vec2 other = 1.0 - part;
  return vec4(other.x * other.y, part.x * other.y, other.x * part.y, part.x * part.y);
}

// Bilinear in this form, the mean of equal values is that value to the bit.
float relief_bilinear(vec4 values, vec2 part) {
  float low = values.x + part.x * (values.y - values.x);
  float high = values.z + part.x * (values.w - values.z);
  return low + part.y * (high - low);
}

// The place in texels of a level of coordinates in [0, 1].
vec2 relief_place(vec2 uv, ivec2 size) { return uv * vec2(size) - 0.5; }

// Metres over the base, at a place in texels of a table of heights.
float relief_height(ReliefField f, vec2 place) {
  ReliefTexels t = relief_texels(f.size, f.clamped != 0u, place);
  vec4 heights;
  for (int i = 0; i < 4; ++i) heights[i] = uintBitsToFloat(relief_values[f.first + uint(t.index[i])]);
  return relief_bilinear(heights, t.part);
}

ReliefEllipse relief_stored_ellipse(uint level_first, int texel) {
  uint word = level_first + uint(relief_ellipse_words * texel);
  return relief_ellipse_unpack(uvec3(relief_values[word], relief_values[word + 1u], relief_values[word + 2u]));
}

// Of the nearest texel.
ReliefEllipse relief_nearest_ellipse(ReliefField f, vec2 uv) {
  vec2 nearest = floor(uv * vec2(f.size));
  int x = relief_wrapped(nearest.x, f.size.x, f.clamped != 0u);
  int y = relief_wrapped(nearest.y, f.size.y, f.clamped != 0u);
  return relief_stored_ellipse(f.first, y * f.size.x + x);
}

// Number of the first texel of a level, which lies behind those of the levels before it.
uint relief_level_first(ivec2 size, int level) {
  uint first = 0u;
  for (int i = 0; i < level; ++i) {
    ivec2 before = relief_level_size(size, i);
    first += uint(before.x * before.y);
  }
  return first;
}

// Centres, covariances and spreads linear between texels and levels.
ReliefEllipse relief_ellipse(ReliefField f, vec2 uv, float level) {
  float limited = min(level, float(f.levels - 1));
  int lower = int(limited);
  float part = limited - float(lower);
  uint first = f.first + uint(relief_ellipse_words) * relief_level_first(f.size, lower);
  ReliefEllipse sum = relief_ellipse_unpack(uvec3(0u));
  // A loop of one or two rounds: software renderers run both sides of an `if`, but no round that nobody is in.
  int i = 0;
  do {
    ivec2 size = relief_level_size(f.size, lower + i);
    ReliefTexels t = relief_texels(size, f.clamped != 0u, relief_place(uv, size));
    vec4 weights = relief_weights(t.part) * (i == 0 ? 1.0 - part : part);
    for (int k = 0; k < 4; ++k)
      sum = relief_ellipse_add(sum, weights[k], relief_stored_ellipse(first, t.index[k]));
    first += uint(relief_ellipse_words * size.x * size.y);
  } while (++i < 2 && part > 0.0);
  return sum;
}

// Share of the sky, linear between texels and levels.
float relief_ambient(ReliefField f, vec2 uv, float level) {
  float limited = min(level, float(f.levels - 1));
  int lower = int(limited);
  float part = limited - float(lower);
  uint first = f.first + relief_level_first(f.size, lower);
  float sum = 0.0;
  int i = 0;
  do {  // as in relief_ellipse()
    ivec2 size = relief_level_size(f.size, lower + i);
    ReliefTexels t = relief_texels(size, f.clamped != 0u, relief_place(uv, size));
    vec4 shares;
    for (int k = 0; k < 4; ++k) shares[k] = uintBitsToFloat(relief_values[first + uint(t.index[k])]);
    sum += (i == 0 ? 1.0 - part : part) * relief_bilinear(shares, t.part);
    first += uint(size.x * size.y);
  } while (++i < 2 && part > 0.0);
  return sum;
}

#ifdef RELIEF_AZIMUTHS
float relief_stored_tangent(ReliefField f, int texel, int azimuth) {
  uint word = f.first + uint(relief_horizon_words(RELIEF_AZIMUTHS) * texel + azimuth / 2);
  vec2 both = unpackHalf2x16(relief_values[word]);
  return azimuth % 2 == 0 ? both.x : both.y;
}

// Tangent of the horizon's elevation along l, linear between azimuths and texels.
float relief_horizon(ReliefField f, ReliefTexels t, vec3 l) {
  HorizonPlace along = horizon_place(l, RELIEF_AZIMUTHS);
  vec4 tangents;
  for (int i = 0; i < 4; ++i) {
    float first = relief_stored_tangent(f, t.index[i], along.first);
    float second = relief_stored_tangent(f, t.index[i], along.second);
    tangents[i] = first + along.weight * (second - first);
  }
  return relief_bilinear(tangents, t.part);
}
#endif

#endif  // LIMN_RELIEF_MAPS_GLSL
