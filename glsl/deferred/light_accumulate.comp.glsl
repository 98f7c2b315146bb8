// Adds sum of L_u V W over a batch of lights to the radiance: unshadowed reflected light, exact for diffuse surfaces, times
// visibility and relief (layer per light; V = 1, W = 1 where nobody was asked). MEDIUM 1: and times the transmittance from
// the light's centre.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/light/light_texture.glsl"
#include "glsl/deferred/light_batch.glsl"
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/surface/surface_response.glsl"
#if MATERIAL_MODELS
#include "glsl/light/model_light.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;

// L_u.
vec3 unshadowed(Light light, SurfaceMaterial material, vec3 position, GBufferSurface surface, vec3 v) {
#if MATERIAL_MODELS
  if (has_model(material))
    return model_light(light, material.model, material.frame, position, surface.geometric_normal, v);
#endif
  return unshadowed_light(light, material.brdf, position, surface.normal, surface.geometric_normal, v);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 position = pixel_position(pixel, depth);
  vec3 v = normalize(frame.camera_position.xyz - position);
  SurfaceMaterial material = pixel_material(pixel, surface);
  vec3 sum = vec3(0.0);
  int i = 0;
  do {  // the condition comes last: software renderers run a loop's body once more where it comes first
    float lit = light_factor(pixel, i);
    if (lit > 0.0 && !pixel_shows_light(pixel, lights[light_indices[i]])) {
      vec3 arriving = unshadowed(lights[light_indices[i]], material, position, surface, v) *
                      light_texture(lights[light_indices[i]], position);
#if MEDIUM
      arriving *= light_transmittance(lights[light_indices[i]], position);
#endif
      sum += lit * arriving;
    }
  } while (++i < LIGHT_COUNT);
  if (sum == vec3(0.0)) return;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sum, 0.0));
}
