// Adds up, over a batch of the lights that stand for the environment, what surfaces would reflect of each and what they do reflect
// of it, times V, W and the medium's transmittance (light_batch.glsl). After the last batch: adds the environment's own light to
// the radiance, as far as that of the lights is seen, the diffuse part and the lobe apart (the ratio estimator of Heitz, Hill and
// McGuire 2018). LIGHTS_FIRST, LIGHTS_LAST: no batch is before this one, or after.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/deferred/light_batch.glsl"
#include "glsl/light/environment_share.glsl"
#if LIGHTS_LAST
#include "glsl/light/reflected_environment.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
#if LIGHTS_LAST
layout(rgba32f) uniform image2D radiance;
#endif

struct LightSums {
  ReflectedParts seen;
  ReflectedParts all;
};

#if !LIGHTS_FIRST || !LIGHTS_LAST
layout(rgba32f) uniform image2D seen_sums;
layout(rgba32f) uniform image2D seen_lobe_sums;
layout(rgba32f) uniform image2D all_sums;
layout(rgba32f) uniform image2D all_lobe_sums;
#endif

LightSums sums_before(ivec2 pixel) {
#if LIGHTS_FIRST
  ReflectedParts none = ReflectedParts(vec3(0.0), vec3(0.0));
  return LightSums(none, none);
#else
  return LightSums(ReflectedParts(imageLoad(seen_sums, pixel).rgb, imageLoad(seen_lobe_sums, pixel).rgb),
                   ReflectedParts(imageLoad(all_sums, pixel).rgb, imageLoad(all_lobe_sums, pixel).rgb));
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 position = pixel_position(pixel, depth);
  vec3 v = -normalize(pixel_ray(pixel));
  SurfaceMaterial material = pixel_material(pixel, surface);
  SurfaceMaterial sharing = sharing_material(material);
  LightSums sums = sums_before(pixel);
  int i = 0;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    Light light = lights[light_indices[i]];
    ReflectedParts reflected = environment_share(light, sharing, surface.normal, surface.geometric_normal, v);
    add_parts(sums.all, reflected);
    add_parts(sums.seen, scaled_parts(reflected, light_factor(pixel, i) * light_transmittance(light, position)));
  } while (++i < LIGHT_COUNT);
#if LIGHTS_LAST
  ReflectedParts environment = reflected_environment(material, surface.normal, surface.geometric_normal, v);
  vec3 left = reflected_left(environment, hidden_parts(sums.seen, sums.all));
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(left, 0.0));
#else
  imageStore(seen_sums, pixel, vec4(sums.seen.diffuse, 0.0));
  imageStore(seen_lobe_sums, pixel, vec4(sums.seen.lobe, 0.0));
  imageStore(all_sums, pixel, vec4(sums.all.diffuse, 0.0));
  imageStore(all_lobe_sums, pixel, vec4(sums.all.lobe, 0.0));
#endif
}
