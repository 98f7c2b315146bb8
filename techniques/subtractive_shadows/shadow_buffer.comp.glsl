// The shadow buffer: what samples of the environment tell of the shadows at each item of the grid; where every pixel is an item,
// at once the light that is left. SAMPLES_FIRST, SAMPLES_LAST: no batch of samples is before this one, or after.
#include "techniques/subtractive_shadows/combine.glsl"
#include "glsl/shadow/environment_samples.glsl"
#include "glsl/surface/block_items.glsl"

#if !SAMPLES_LAST || !SAMPLES_FIRST
// What a batch hands on to the next, shares of the mean over a level's samples, the second level's below the first one's; the
// sums of weights for mirrors in the last lanes of seen_sums and seen_lobe_sums.
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

ivec2 sums_place(ivec2 item, int level) { return item + ivec2(0, level * (imageSize(seen_sums).y / SAMPLE_LEVELS)); }
#endif

// What earlier batches hand on.
SampleSums earlier_sums(ivec2 item, int level) {
  SampleSums sums = no_samples();
#if !SAMPLES_FIRST
  ivec2 place = sums_place(item, level);
  vec4 seen = imageLoad(seen_sums, place);
  sums.seen.diffuse = seen.rgb;
  sums.mirror_seen = seen.a;
#if SAMPLE_TOTALS
  sums.all.diffuse = imageLoad(all_sums, place).rgb;
#endif
#if SAMPLE_PARTS
  vec4 lobe = imageLoad(seen_lobe_sums, place);
  sums.seen.lobe = lobe.rgb;
  sums.mirror_all = lobe.a;
#if SAMPLE_TOTALS
  sums.all.lobe = imageLoad(all_lobe_sums, place).rgb;
#endif
#endif
#endif
  return sums;
}

#if !SAMPLES_LAST
void store_sums(ivec2 place, SampleSums sums) {
  imageStore(seen_sums, place, vec4(sums.seen.diffuse, sums.mirror_seen));
#if SAMPLE_TOTALS
  imageStore(all_sums, place, vec4(sums.all.diffuse, 0.0));
#endif
#if SAMPLE_PARTS
  imageStore(seen_lobe_sums, place, vec4(sums.seen.lobe, sums.mirror_all));
#if SAMPLE_TOTALS
  imageStore(all_lobe_sums, place, vec4(sums.all.lobe, 0.0));
#endif
#endif
}
#endif

#if SAMPLES_LAST
#if BLOCK_SIDE > 1
layout(VALUE_FORMAT) writeonly uniform image2D values;  // of the diffuse part, and of mirrors in the last lane
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

// From the means over a level's samples.
ShadowValues shadow_values(SampledPixel p, SampleSums sums) {
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
  return ShadowValues(values, 1.0 - mirror_share(sums, SAMPLE_TOTALS == 1 ? 1.0 : 0.0));
}
#endif

// Blocks share what is hidden of a part, or seen, without the surface's colour, which a channel of 0 would not tell them: there the
// surface has next to none instead. By ratio a lobe without light has the diffuse part's share, and models keep their own lobes.
void keep_parts(inout SampledPixel p) {
  const vec3 least = vec3(1e-6);
  p.material.brdf.diffuse = max(p.material.brdf.diffuse, least);
#if DEMODULATE && !COMBINE_BY_RATIO
  p.material.brdf.f0 = max(p.material.brdf.f0, least);
  p.material.brdf.f90 = max(p.material.brdf.f90, least.x);
#endif
#if MATERIAL_MODELS
  p.material.model.kd = max(p.material.model.kd, least);
#endif
}

void main() {
  ivec2 item = ivec2(gl_GlobalInvocationID.xy);
  ivec2 pixel;
  if (!item_pixel(item, pixel)) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  SampledPixel p = sampled_pixel(pixel, depth);
  if ((p.surface.flags & gbuffer_flag_specular) != 0u) return;
  if (BLOCK_SIDE > 1) keep_parts(p);
  SampleSums here = no_samples();
  ShadowValues shadows = ShadowValues(ReflectedParts(vec3(0.0), vec3(0.0)), 0.0);
  int first = 0;
  for (int level = 0; level < SAMPLE_LEVELS; ++level) {
    int end = level_end(level);
    add_samples(p, first, end, here);
    first = end;
    SampleSums sums = earlier_sums(item, level);
    vec3 share = vec3(1.0 / float(level_samples(level)));
    add_parts(sums.seen, scaled_parts(here.seen, share));
    add_parts(sums.all, scaled_parts(here.all, share));
    sums.mirror_all += here.mirror_all;
    sums.mirror_seen += here.mirror_seen;
#if !SAMPLES_LAST
    store_sums(sums_place(item, level), sums);
#elif SAMPLE_FADE
    ShadowValues values_of_level = shadow_values(p, sums);
    float weight = level == 0 ? 1.0 : share_of_more;
    shadows.parts = mixed_parts(shadows.parts, values_of_level.parts, weight);
    shadows.mirror = mix(shadows.mirror, values_of_level.mirror, weight);
#else
    shadows = shadow_values(p, sums);
#endif
  }
#if SAMPLES_LAST && BLOCK_SIDE > 1
  imageStore(values, item, vec4(shadows.parts.diffuse, shadows.mirror));
#if SAMPLE_PARTS
  imageStore(lobe_values, item, vec4(shadows.parts.lobe, 0.0));
#endif
#elif SAMPLES_LAST
  vec3 light = shown_light(p, unshadowed_light(pixel, p), shadows);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(picture_share * light, 0.0));
#endif
}
