// Reflected light of the environment as a sum over directions, each shadowed by its own map and reflected by the whole
// BRDF. Each batch adds its part. Coats mirror the environment, too, as far as the samples around the mirror direction are seen.
#include "glsl/shadow/shadow_samples.glsl"
#include "glsl/surface/surface_response.glsl"
#if (MATERIAL_MODELS & 32) != 0
#include "glsl/materials/coated.glsl"
#include "glsl/numeric/equirectangular.glsl"
#endif

layout(rgba32f) uniform image2D radiance;
layout(std430) readonly buffer Irradiance { vec4 irradiance[]; };  // on surfaces that face the sample, were it all

#if (MATERIAL_MODELS & 32) != 0
uniform sampler2D environment_map;
// The sums of mirror_weight() that a batch hands on to the next. MIRROR_FIRST, MIRROR_LAST: no batch is before this one, or after.
#if !MIRROR_FIRST || !MIRROR_LAST
layout(rg32f) uniform image2D mirror_sums;
#endif

// How much of the mirrored light's visibility a sample stands for: more samples, narrower. Its ends keep sums above 0 in floats.
float mirror_weight(float sharpness, vec3 mirror, vec3 direction) { return exp(sharpness * (dot(mirror, direction) - 1.0)); }

// What the coat mirrors, of which `seen` is visible.
vec3 mirrored_light(MaterialModel m, GBufferSurface s, vec3 v, vec3 mirror, float seen) {
  if (dot(s.geometric_normal, mirror) <= 0.0) return vec3(0.0);
  vec2 uv = equirectangular_uv(environment_lookup_direction(mirror, frame.environment_rotation));
  vec3 light = frame.environment_scale * textureLod(environment_map, uv, 0.0).rgb;
  return coated_mirror(m, dot(s.normal, v)) * light * seen;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) != 0u) return;
  SurfaceMaterial surface = pixel_material(pixel, s);
  VisibilityQuery q;
  q.position = pixel_position(pixel, depth);
  q.normal = s.geometric_normal;
  vec3 to_viewer = normalize(frame.camera_position.xyz - q.position);
  vec3 sum = vec3(0.0);
  uint uncovered = 0u;
#if (MATERIAL_MODELS & 32) != 0
  vec3 mirror = 2.0 * dot(s.normal, to_viewer) * s.normal - to_viewer;
  float sharpness = clamp(0.25 * float(total_samples), 1.0, 40.0);
#if MIRROR_FIRST
  vec2 mirror_sum = vec2(0.0);  // weights of the samples above the horizon, and of those of them that are seen
#else
  vec2 mirror_sum = imageLoad(mirror_sums, pixel).xy;
#endif
#endif
  for (int i = 0; i < batch_samples; ++i) {
    ShadowLight maps = maps_at(uint(i));
    vec3 direction = maps.origin;
    float cosine = dot(s.normal, direction);
    if (cosine <= 0.0 || dot(q.normal, direction) <= 0.0) continue;
#if (MATERIAL_MODELS & 32) != 0
    float weight = mirror_weight(sharpness, mirror, direction);
    mirror_sum.x += weight;
#endif
    q.light.axis = -direction;
    if (!sample_visible(q, maps, uncovered)) continue;
    sum += surface_response(surface, s.normal, to_viewer, direction) * irradiance[first_sample + i].rgb;
#if (MATERIAL_MODELS & 32) != 0
    mirror_sum.y += weight;
#endif
  }
  count_uncovered(uncovered);
  vec3 light = sum / float(total_samples);
#if (MATERIAL_MODELS & 32) != 0
#if MIRROR_LAST
  if (surface.model.kind == model_coated && mirror_sum.x > 0.0)
    light += mirrored_light(surface.model, s, to_viewer, mirror, mirror_sum.y / mirror_sum.x);
#else
  imageStore(mirror_sums, pixel, vec4(mirror_sum, 0.0, 0.0));
#endif
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
