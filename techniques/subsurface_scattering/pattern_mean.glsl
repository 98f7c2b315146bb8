// One direction of the mean over the pattern of interleaved pixels (pattern_weights.glsl): of pixels of the same instance that lie
// near the pixel's tangent plane and face the same way. Where one of two pixels as far away does not count, the other does for
// both.
#ifndef PATTERN_MEAN_GLSL
#define PATTERN_MEAN_GLSL
#include "glsl/surface/gbuffer_input.glsl"
#include "techniques/subsurface_scattering/pattern_weights.glsl"

uniform usampler2D planes;
uniform sampler2D gathered;  // light, and in alpha pattern_pack()

const float least_cosine = 0.8;  // of two normals
const float most_slope = 0.6;    // of the way from one to the other against the plane

struct Centre {
  uint instance;
  vec3 plane;
  vec3 place;
  float squared;  // of the plane
};

// Without roots and divisions: the place is the ray over q, and everything is compared times q and squared.
bool counts(Centre c, ivec2 pixel) {
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return false;
  uvec4 texel = texelFetch(planes, pixel, 0);
  vec3 plane = uintBitsToFloat(texel.xyz);
  vec3 ray = pixel_ray(pixel);
  float q = dot(plane, ray);
  vec3 way = ray - q * c.place;
  float rise = dot(c.plane, ray) - q;
  float facing = dot(plane, c.plane);
  return texel.w == c.instance && facing > 0.0 &&
         facing * facing >= least_cosine * least_cosine * dot(plane, plane) * c.squared &&
         rise * rise <= most_slope * most_slope * dot(way, way) * c.squared;
}

// The light of a pixel whose texel of `planes` is `own`, with what it holds in alpha.
vec4 pattern_mean(ivec2 pixel, uvec4 own, ivec2 axis) {
  vec4 gathered_here = texelFetch(gathered, pixel, 0);
  int side = pattern_packed_side(gathered_here.a);
  if (side < 2) return gathered_here;
  Centre centre;
  centre.instance = own.w;
  centre.plane = uintBitsToFloat(own.xyz);
  centre.place = pixel_ray(pixel) / dot(centre.plane, pixel_ray(pixel));
  centre.squared = dot(centre.plane, centre.plane);
  bool narrow = pattern_packed_narrow(gathered_here.a);
  float weights = pattern_weight(side, narrow, 0);
  vec3 sum = weights * gathered_here.rgb;
  vec3 least = gathered_here.rgb;
  vec3 most = least;
  for (int t = 1, end = pattern_end(side, narrow); t <= end; ++t) {
    bool after = counts(centre, pixel + t * axis);
    bool before = counts(centre, pixel - t * axis);
    if (!after && !before) break;
    vec3 one = texelFetch(gathered, after ? pixel + t * axis : pixel - t * axis, 0).rgb;
    vec3 other = after && before ? texelFetch(gathered, pixel - t * axis, 0).rgb : one;
    float weight = pattern_weight(side, narrow, t);
    sum += weight * (one + other);
    weights += 2.0 * weight;
    least = min(least, min(one, other));
    most = max(most, max(one, other));
  }
  // Weights below 0 would let it pass all that it is the mean of.
  vec3 mean = mix(gathered_here.rgb, clamp(sum / weights, least, most), pattern_packed_shares(gathered_here.a));
  return vec4(mean, gathered_here.a);
}

#endif  // PATTERN_MEAN_GLSL
