// Radiance filtered by a lobe around each direction: samples of the lobe, each from the level of the chain in which a texel
// covers as much as it does. POWER_LOBES 0: GGX lobes at normal incidence; 1: power lobes. FILTERED_FORMAT: of the map, which holds
// numbers as large as those of the source.
#if POWER_LOBES
#include "glsl/light/prefiltered_models.glsl"
#else
#include "glsl/light/prefiltered.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(FILTERED_FORMAT) writeonly uniform image2DArray filtered;
uniform sampler2DArray source;
uniform float alpha;
uniform int samples;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec3 extent = imageSize(filtered);
  if (any(greaterThanEqual(at, extent))) return;
  Frame around = frame_around(prefiltered_texel_direction(vec2(at.xy) + 0.5, at.z, extent.xy));
  int size = textureSize(source, 0).y;
  int last = textureQueryLevels(source) - 1;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < samples; ++i) {
#if POWER_LOBES
    PrefilterSample s = power_prefilter_sample(alpha, i, samples);
#else
    PrefilterSample s = prefilter_sample(alpha, i, samples);
#endif
    if (s.weight == 0.0) continue;
    vec3 direction = from_local(around, s.direction);
    float level = min(prefilter_source_level(s.spread, prefiltered_density_towards(direction, size)), float(last));
    int low = min(int(level), last - 1);
    sum += s.weight * mix(prefiltered_lookup(source, direction, low), prefiltered_lookup(source, direction, low + 1),
                          level - float(low));
    weights += s.weight;
  }
  imageStore(filtered, at, vec4(sum / weights, 1.0));
}
