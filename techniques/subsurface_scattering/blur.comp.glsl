// One direction of the blur over the pattern of interleaved pixels: a tent of `block` pixels to either side, so that each place
// in the pattern counts once, of pixels of the same instance that lie near the pixel's tangent plane and face the same way. Where
// one of two pixels that share a place does not count, the other does in full (glsl/indirect/blur.comp.glsl has the same rules
// for all surfaces, in parts of the scene's extent).
// VERTICAL 1: along columns.
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform usampler2D planes;
uniform sampler2D gathered;
layout(rgba32f) writeonly uniform image2D blurred;
uniform int block;  // pixels

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

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uvec4 own = texelFetch(planes, pixel, 0);
  if (own.w == no_instance) return;
  Centre centre;
  centre.instance = own.w;
  centre.plane = uintBitsToFloat(own.xyz);
  centre.place = pixel_ray(pixel) / dot(centre.plane, pixel_ray(pixel));
  centre.squared = dot(centre.plane, centre.plane);
#if VERTICAL
  const ivec2 axis = ivec2(0, 1);
#else
  const ivec2 axis = ivec2(1, 0);
#endif
  vec3 sum = texelFetch(gathered, pixel, 0).rgb;
  float weights = 1.0;
  for (int t = 1; t < block; ++t) {
    ivec2 after = pixel + t * axis;
    ivec2 before = after - block * axis;
    float share = float(t) / float(block);
    bool one = counts(centre, after);
    bool other = counts(centre, before);
    vec2 weight = vec2(one ? 1.0 - (other ? share : 0.0) : 0.0, other ? (one ? share : 1.0) : 0.0);
    if (one) sum += weight.x * texelFetch(gathered, after, 0).rgb;
    if (other) sum += weight.y * texelFetch(gathered, before, 0).rgb;
    weights += weight.x + weight.y;
  }
  imageStore(blurred, pixel, vec4(sum / weights, 0.0));
}
