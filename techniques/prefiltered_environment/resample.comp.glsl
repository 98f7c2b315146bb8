// One level of the chain of an environment's radiance, in the technique's own map: means over texels, by solid angle. The
// first from the environment's picture (BASE), each further one from the one before.
#include "glsl/light/prefiltered.glsl"
#include "glsl/numeric/sampling.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2DArray coarser;
uniform int samples_across;  // of a texel

#if BASE
uniform sampler2D environment_map;

vec3 radiance_towards(vec3 direction) { return textureLod(environment_map, equirectangular_uv(direction), 0.0).rgb; }

#else
layout(rgba32f) readonly uniform image2DArray finer;

vec3 texel_of(ivec2 at, int layer) {
  ivec2 extent = imageSize(finer).xy;
#if PREFILTERED_PARABOLOID
  at = clamp(at, ivec2(0), extent - 1);
#else
  at = ivec2((at.x + extent.x) % extent.x, clamp(at.y, 0, extent.y - 1));
#endif
  return imageLoad(finer, ivec3(at, layer)).rgb;
}

vec3 radiance_towards(vec3 direction) {
  ivec2 extent = imageSize(finer).xy;
  vec3 place = prefiltered_place(direction, extent.y);
  vec2 from = place.xy * vec2(extent) - 0.5;
  ivec2 corner = ivec2(floor(from));
  vec2 weight = from - vec2(corner);
  int layer = int(place.z);
  vec3 low = mix(texel_of(corner, layer), texel_of(corner + ivec2(1, 0), layer), weight.x);
  vec3 high = mix(texel_of(corner + ivec2(0, 1), layer), texel_of(corner + ivec2(1, 1), layer), weight.x);
  return mix(low, high, weight.y);
}
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec3 extent = imageSize(coarser);
  if (any(greaterThanEqual(at, extent))) return;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < samples_across * samples_across; ++i) {
    vec2 texel = vec2(at.xy) + grid_point(i, samples_across);
    float weight = prefiltered_density(texel, extent.xy);
    sum += weight * radiance_towards(prefiltered_texel_direction(texel, at.z, extent.xy));
    weights += weight;
  }
  imageStore(coarser, at, vec4(sum / weights, 1.0));
}
