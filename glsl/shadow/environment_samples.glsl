// Samples of the environment's light (core/shadow/environment_samples.h), each shadowed by its own map, as the surface of a pixel
// reflects them by the whole BRDF.
//
// Define SAMPLE_TOTALS 1 for what all samples would bring, were they seen; SAMPLE_PARTS and MEDIUM: as in sampled_pixel.glsl.
// SAMPLE_FADE 1: a picture lies between those of two numbers of samples, both prefixes of all; share_of_more is of the larger one.
#ifndef LIMN_ENVIRONMENT_SAMPLES_GLSL
#define LIMN_ENVIRONMENT_SAMPLES_GLSL
#include "glsl/shadow/sampled_pixel.glsl"
#include "glsl/shadow/shadow_samples.glsl"

layout(std430) readonly buffer EnvironmentSamples { EnvironmentSample environment_samples[]; };

#if SAMPLE_FADE
#define SAMPLE_LEVELS 2
uniform int fewer_samples;
uniform int more_samples;
uniform float share_of_more;
#else
#define SAMPLE_LEVELS 1
#endif

// Number of the samples that a level, below SAMPLE_LEVELS, is the mean of.
int level_samples(int level) {
#if SAMPLE_FADE
  return min(level == 0 ? fewer_samples : more_samples, total_samples);
#else
  return total_samples;
#endif
}

// The first sample of this batch that the level is without, counted in the batch.
int level_end(int level) { return clamp(level_samples(level) - first_sample, 0, batch_samples); }

// How many samples tell what a coat's mirror sees.
float mirror_samples() {
#if SAMPLE_FADE
  return mix(float(fewer_samples), float(more_samples), share_of_more);
#else
  return float(total_samples);
#endif
}

struct SampleSums {
  ReflectedParts seen;  // of the samples that are seen
  ReflectedParts all;   // SAMPLE_TOTALS
  float mirror_all;     // of coats: weights around the mirror direction of samples above the horizon
  float mirror_seen;    // of those of them that are seen
};

SampleSums no_samples() {
  return SampleSums(ReflectedParts(vec3(0.0), vec3(0.0)), ReflectedParts(vec3(0.0), vec3(0.0)), 0.0, 0.0);
}

// Adds the samples first .. end - 1 of this batch.
void add_samples(SampledPixel p, int first, int end, inout SampleSums sums) {
  VisibilityQuery q;
  q.position = p.position;
  q.normal = p.surface.geometric_normal;
  uint uncovered = 0u;
#if (MATERIAL_MODELS & 32) != 0
  vec3 mirror = 2.0 * dot(p.surface.normal, p.to_viewer) * p.surface.normal - p.to_viewer;
  // How much of the mirrored light's visibility a sample stands for: more samples, narrower. Its ends keep sums above 0 in floats.
  float sharpness = clamp(0.25 * mirror_samples(), 1.0, 40.0);
#endif
  for (int i = first; i < end; ++i) {
    EnvironmentSample light = environment_samples[first_sample + i];
    if (!above_horizon(p, light.direction)) continue;
#if (MATERIAL_MODELS & 32) != 0
    float weight = exp(sharpness * (dot(mirror, light.direction) - 1.0));
    sums.mirror_all += weight;
#endif
#if SAMPLE_TOTALS
    ReflectedParts reflected = reflected_sample(p, light);
    add_parts(sums.all, reflected);
#endif
    q.light.axis = -light.direction;
    if (!sample_visible(q, maps_at(uint(i)), uncovered)) continue;
#if SAMPLE_TOTALS
    add_parts(sums.seen, reflected);
#else
    add_parts(sums.seen, reflected_sample(p, light));
#endif
#if (MATERIAL_MODELS & 32) != 0
    sums.mirror_seen += weight;
#endif
  }
  count_uncovered(uncovered);
}

// The part of what the pixel's coat mirrors that is seen, from the sums over all batches; where no sample is above the horizon,
// `otherwise`.
float mirror_share(SampleSums sums, float otherwise) {
  return sums.mirror_all > 0.0 ? sums.mirror_seen / sums.mirror_all : otherwise;
}

#endif  // LIMN_ENVIRONMENT_SAMPLES_GLSL
