// Reflected light of the environment as a sum over directions, each shadowed by its own map and reflected by the whole
// BRDF. Each batch adds its part. Coats mirror the environment, too, as far as the samples around the mirror direction are seen;
// in scenes with coats SAMPLES_FIRST and SAMPLES_LAST say that no batch is before this one, or after.
#define SAMPLE_TOTALS 0
#define SAMPLE_PARTS 0
#define SAMPLE_FADE 0
#include "glsl/shadow/environment_samples.glsl"

layout(rgba32f) uniform image2D radiance;

#if (MATERIAL_MODELS & 32) != 0
#if SAMPLES_LAST
#include "glsl/shadow/mirrored_environment.glsl"
#endif
#if !SAMPLES_FIRST || !SAMPLES_LAST
layout(rg32f) uniform image2D mirror_sums;
#endif
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  SampledPixel p = sampled_pixel(pixel, depth);
  if ((p.surface.flags & gbuffer_flag_specular) != 0u) return;
  SampleSums sums = no_samples();
#if (MATERIAL_MODELS & 32) != 0 && !SAMPLES_FIRST
  vec2 mirror = imageLoad(mirror_sums, pixel).xy;
  sums.mirror_all = mirror.x;
  sums.mirror_seen = mirror.y;
#endif
  add_samples(p, 0, batch_samples, sums);
  vec3 light = sums.seen.diffuse / float(total_samples);
#if (MATERIAL_MODELS & 32) != 0
#if SAMPLES_LAST
  if (is_coated(p)) light += mirrored_environment(p) * mirror_share(sums, 0.0);
#else
  imageStore(mirror_sums, pixel, vec4(sums.mirror_all, sums.mirror_seen, 0.0, 0.0));
#endif
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
