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
layout(std430) readonly buffer Directions { vec4 directions[]; };  // towards each sample; w unused
uniform sampler2D environment_map;

// How much of the mirrored light's visibility a sample stands for: more samples, narrower. Its ends keep sums above 0 in floats.
float mirror_weight(vec3 mirror, vec3 direction) {
  return exp(clamp(0.25 * float(total_samples), 1.0, 40.0) * (dot(mirror, direction) - 1.0));
}

// What the coat mirrors, for samples of this batch whose weights have the sum `seen`, of those that are seen.
vec3 mirrored_light(MaterialModel m, GBufferSurface s, vec3 v, vec3 mirror, float seen) {
  if (dot(s.geometric_normal, mirror) <= 0.0) return vec3(0.0);
  float all = 0.0;
  for (int i = 0; i < total_samples; ++i) {
    vec3 direction = directions[i].xyz;
    if (dot(s.normal, direction) > 0.0 && dot(s.geometric_normal, direction) > 0.0) all += mirror_weight(mirror, direction);
  }
  vec2 uv = equirectangular_uv(environment_lookup_direction(mirror, frame.environment_rotation));
  vec3 light = frame.environment_scale * textureLod(environment_map, uv, 0.0).rgb;
  return all > 0.0 ? coated_mirror(m, dot(s.normal, v)) * light * (seen / all) : vec3(0.0);
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
  float mirror_seen = 0.0;
#endif
  for (int i = 0; i < batch_samples; ++i) {
    ShadowLight maps = maps_at(uint(i));
    vec3 direction = maps.origin;
    float cosine = dot(s.normal, direction);
    if (cosine <= 0.0 || dot(q.normal, direction) <= 0.0) continue;
    q.light.axis = -direction;
    if (!sample_visible(q, maps, uncovered)) continue;
    sum += surface_response(surface, s.normal, to_viewer, direction) * irradiance[first_sample + i].rgb;
#if (MATERIAL_MODELS & 32) != 0
    mirror_seen += mirror_weight(mirror, direction);
#endif
  }
  count_uncovered(uncovered);
  vec3 light = sum / float(total_samples);
#if (MATERIAL_MODELS & 32) != 0
  if (surface.model.kind == model_coated) light += mirrored_light(surface.model, s, to_viewer, mirror, mirror_seen);
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
