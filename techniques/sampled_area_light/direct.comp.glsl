// Reflected direct light, each sample of a light shadowed by its own map and reflected by the whole BRDF or model. Each batch adds
// its part. MEDIUM 1: times the medium's transmittance from the sample.
#include "glsl/light/light_texture.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/shadow/shadow_samples.glsl"
#include "glsl/surface/surface_response.glsl"

layout(rgba32f) uniform image2D radiance;
uniform int light_count;

// Irradiance of one sample on a surface that faces it, were it all of the light.
vec3 sample_irradiance(Light light, LightView view, vec3 receiver, vec3 offset) {
  if (!view.extended) return punctual_irradiance(light, receiver);
  if (view.cone) {
    // Uniform radiance E / (pi sin^2) over the solid angle 2 pi (1 - cos), with sin^2 = (1 - cos) (1 + cos).
    return light.emission * (2.0 / (2.0 - view.cap));
  }
  if (light_is_distant_rectangle(light)) {
    // Uniform in the rectangle's plane: solid angle of a piece of its area, by the cube of the cosine.
    float cosine = -dot(view.axis, offset);
    return rectangle_radiance(light) * (light.length_u * light.length_v * cosine * cosine * cosine);
  }
  float distance2 = dot(offset, offset);
  float cosine = abs(dot(light.direction, offset)) * inversesqrt(distance2);
  return light.emission * (receiver_factor(light, receiver) * light.length_u * light.length_v * cosine / distance2);
}

vec3 light_from(VisibilityQuery q, Light light, int l, SurfaceMaterial surface, vec3 normal, vec3 to_viewer,
                inout uint uncovered) {
  vec3 sum = vec3(0.0);
  int samples = q.light.extended ? batch_samples : first_sample == 0 ? 1 : 0;
  for (int s = 0; s < samples; ++s) {
    ShadowLight maps = maps_at(uint(l * batch_samples + s));
    vec3 offset = sample_offset(q, maps);
    vec3 direction = normalize(offset);
    if (dot(offset, q.normal) <= 0.0 || dot(offset, normal) <= 0.0 || !sample_visible(q, maps, uncovered)) continue;
    vec3 reflected = surface_response(surface, normal, to_viewer, direction) *
                     sample_irradiance(light, q.light, q.position, offset);
#if MEDIUM
    Medium medium = scene_medium();
    float inside = maps.finite > 0.0 ? medium_length_between(medium, q.position, maps.origin)
                                       : medium_length(medium, q.position, direction, 3.0e38);
    reflected *= medium_transmittance(medium, inside);
#endif
    sum += reflected;
  }
  sum *= light_texture(light, q.position);
  return q.light.extended ? sum / float(total_samples) : sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
  if (pixel_depth(pixel) == 0.0) return;
  GBufferSurface s = pixel_surface(pixel);
  if ((s.flags & gbuffer_flag_specular) != 0u) return;
  SurfaceMaterial surface = pixel_material(pixel, s);
  vec3 sum = vec3(0.0);
  uint uncovered = 0u;
  for (int l = 0; l < light_count; ++l) {
    VisibilityQuery q = visibility_query(pixel, uint(l * batch_samples));
    if (q.masked) continue;
    vec3 to_viewer = normalize(frame.camera_position.xyz - q.position);
    sum += light_from(q, lights[q.maps.light], l, surface, s.normal, to_viewer, uncovered);
  }
  count_uncovered(uncovered);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
