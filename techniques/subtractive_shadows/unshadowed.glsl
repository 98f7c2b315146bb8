// U: the light of the environment that a pixel reflects, were nothing in its way. UNSHADOWED: where it comes from. What is added
// up from visible samples needs it for what coats mirror alone.
#ifndef LIMN_UNSHADOWED_GLSL
#define LIMN_UNSHADOWED_GLSL

#define UNSHADOWED_PREFILTERED 0
#define UNSHADOWED_BRDF_SAMPLES 1
#define UNSHADOWED_CACHE 2
#define UNSHADOWED_LIGHTS 3

#include "techniques/subtractive_shadows/combine.glsl"

#if (MATERIAL_MODELS & 32) != 0 && (UNSHADOWED == UNSHADOWED_LIGHTS || COMBINE == COMBINE_ADD)
#include "glsl/shadow/mirrored_environment.glsl"

vec3 mirrored_light(SampledPixel p) { return is_coated(p) ? mirrored_environment(p) : vec3(0.0); }
#else
vec3 mirrored_light(SampledPixel p) { return vec3(0.0); }
#endif

#if COMBINE == COMBINE_ADD

ReflectedParts unshadowed_light(ivec2 pixel, SampledPixel p) { return ReflectedParts(vec3(0.0), mirrored_light(p)); }

#elif UNSHADOWED != UNSHADOWED_LIGHTS
#if MEDIUM
#include "glsl/media/environment_transmittance.glsl"
#endif
#if UNSHADOWED == UNSHADOWED_BRDF_SAMPLES
#include "techniques/subtractive_shadows/brdf_samples.glsl"
#elif UNSHADOWED == UNSHADOWED_CACHE
#include "techniques/subtractive_shadows/cached_environment.glsl"
#else
#include "glsl/light/reflected_environment.glsl"
#endif

ReflectedParts unshadowed_light(ivec2 pixel, SampledPixel p) {
#if UNSHADOWED == UNSHADOWED_BRDF_SAMPLES
  ReflectedParts light = sampled_environment(p);
#elif UNSHADOWED == UNSHADOWED_CACHE
  ReflectedParts light = cached_environment(pixel, p);
#else
  ReflectedParts light =
      reflected_environment(p.material, p.surface.normal, p.surface.geometric_normal, p.to_viewer);
#endif
#if MEDIUM
  light = environment_through_medium(light, is_coated(p), p.position, p.surface.normal, p.to_viewer);
#endif
  return light;
}

#else
layout(std430) readonly buffer UnshadowedSamples { EnvironmentSample unshadowed_samples[]; };

ReflectedParts unshadowed_light(ivec2 pixel, SampledPixel p) {
  ReflectedParts sum = ReflectedParts(vec3(0.0), vec3(0.0));
  int count = unshadowed_samples.length();
  for (int i = 0; i < count; ++i)
    if (above_horizon(p, unshadowed_samples[i].direction)) add_parts(sum, reflected_sample(p, unshadowed_samples[i]));
  sum = scaled_parts(sum, vec3(1.0 / float(count)));
  sum.lobe += mirrored_light(p);
  return sum;
}
#endif

#endif  // LIMN_UNSHADOWED_GLSL
