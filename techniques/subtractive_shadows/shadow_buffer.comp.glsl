// The shadow buffer: what samples of the environment tell of the shadows at each item of the grid; where every pixel is an item,
// at once the light that is left. SAMPLES_FIRST, SAMPLES_LAST: no batch of samples is before this one, or after.
#include "techniques/subtractive_shadows/combine.glsl"
#include "glsl/shadow/environment_samples.glsl"
#include "glsl/surface/block_items.glsl"

#if !SAMPLES_LAST || !SAMPLES_FIRST
// What a batch hands on to the next, shares of the mean over all samples; the sums of weights for mirrors in the last lanes of
// seen_sums and seen_lobe_sums.
layout(rgba32f) uniform image2D seen_sums;
#if SAMPLE_TOTALS
layout(rgba32f) uniform image2D all_sums;
#endif
#if SAMPLE_PARTS
layout(rgba32f) uniform image2D seen_lobe_sums;
#if SAMPLE_TOTALS
layout(rgba32f) uniform image2D all_lobe_sums;
#endif
#endif

SampleSums load_sums(ivec2 item) {
  SampleSums sums = no_samples();
  vec4 seen = imageLoad(seen_sums, item);
  sums.seen.diffuse = seen.rgb;
  sums.mirror_seen = seen.a;
#if SAMPLE_TOTALS
  sums.all.diffuse = imageLoad(all_sums, item).rgb;
#endif
#if SAMPLE_PARTS
  vec4 lobe = imageLoad(seen_lobe_sums, item);
  sums.seen.lobe = lobe.rgb;
  sums.mirror_all = lobe.a;
#if SAMPLE_TOTALS
  sums.all.lobe = imageLoad(all_lobe_sums, item).rgb;
#endif
#endif
  return sums;
}

void store_sums(ivec2 item, SampleSums sums) {
  imageStore(seen_sums, item, vec4(sums.seen.diffuse, sums.mirror_seen));
#if SAMPLE_TOTALS
  imageStore(all_sums, item, vec4(sums.all.diffuse, 0.0));
#endif
#if SAMPLE_PARTS
  imageStore(seen_lobe_sums, item, vec4(sums.seen.lobe, sums.mirror_all));
#if SAMPLE_TOTALS
  imageStore(all_lobe_sums, item, vec4(sums.all.lobe, 0.0));
#endif
#endif
}
#endif

#if SAMPLES_LAST
#if BLOCK_SIDE > 1
layout(VALUE_FORMAT) writeonly uniform image2D values;
#if SAMPLE_PARTS
layout(VALUE_FORMAT) writeonly uniform image2D lobe_values;
#endif
#else
#include "techniques/subtractive_shadows/unshadowed.glsl"
layout(rgba32f) uniform image2D radiance;
#endif

vec3 without_colour(vec3 light, vec3 colour) {
  return mix(vec3(0.0), light / max(colour, vec3(1e-6)), greaterThan(colour, vec3(0.0)));
}

// From the means over all samples.
ReflectedParts shadow_values(SampledPixel p, SampleSums sums) {
  ReflectedParts seen = sums.seen, all = sums.all, values;
#if COMBINE == COMBINE_RATIO
  values.diffuse = values.lobe = hidden_share(reflected_whole(seen), reflected_whole(all), vec3(0.0));
#elif COMBINE == COMBINE_RATIO_SPLIT
  values = hidden_parts(seen, all);
#else
  if (SAMPLE_TOTALS == 1) seen = ReflectedParts(all.diffuse - seen.diffuse, all.lobe - seen.lobe);
  ReflectedParts colours = surface_colours(p);
  values.diffuse = without_colour(seen.diffuse, colours.diffuse);
  values.lobe = without_colour(seen.lobe, colours.lobe);
#endif
  // Where no sample is above the horizon, coats mirror nothing that is added up, and all that shadows are taken from.
  if (is_coated(p)) values.lobe = vec3(1.0 - mirror_share(sums, SAMPLE_TOTALS == 1 ? 1.0 : 0.0));
  return values;
}
#endif

void main() {
  ivec2 item = ivec2(gl_GlobalInvocationID.xy);
  ivec2 pixel;
  if (!item_pixel(item, pixel)) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  SampledPixel p = sampled_pixel(pixel, depth);
  if ((p.surface.flags & gbuffer_flag_specular) != 0u) return;
  SampleSums sums = no_samples();
  add_samples(p, sums);
  vec3 share = vec3(1.0 / counted_samples());
  sums.seen = scaled_parts(sums.seen, share);
  sums.all = scaled_parts(sums.all, share);
#if !SAMPLES_FIRST
  SampleSums earlier = load_sums(item);
  add_parts(sums.seen, earlier.seen);
  add_parts(sums.all, earlier.all);
  sums.mirror_all += earlier.mirror_all;
  sums.mirror_seen += earlier.mirror_seen;
#endif
#if !SAMPLES_LAST
  store_sums(item, sums);
#elif BLOCK_SIDE > 1
  ReflectedParts shadows = shadow_values(p, sums);
  imageStore(values, item, vec4(shadows.diffuse, 0.0));
#if SAMPLE_PARTS
  imageStore(lobe_values, item, vec4(shadows.lobe, 0.0));
#endif
#else
  vec3 light = shadowed_light(p, unshadowed_light(pixel, p), shadow_values(p, sums));
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
#endif
}
