// What the surface of a pixel reflects of samples of the environment's light, unoccluded.
//
// Define SAMPLE_PARTS 1 for the diffuse part apart; else all light counts as diffuse. MEDIUM 1: light is attenuated.
#ifndef LIMN_SAMPLED_PIXEL_GLSL
#define LIMN_SAMPLED_PIXEL_GLSL
#include "glsl/light/environment_sample.glsl"
#include "glsl/media/medium_input.glsl"
#include "glsl/surface/surface_response.glsl"

struct SampledPixel {
  GBufferSurface surface;
  SurfaceMaterial material;
  vec3 position;
  vec3 to_viewer;  // unit
};

SampledPixel sampled_pixel(ivec2 at, float depth) {
  SampledPixel p;
  p.surface = pixel_surface(at);
  p.material = pixel_material(at, p.surface);
  p.position = pixel_position(at, depth);
  p.to_viewer = normalize(frame.camera_position.xyz - p.position);
  return p;
}

bool above_horizon(SampledPixel p, vec3 direction) {
  return dot(p.surface.normal, direction) > 0.0 && dot(p.surface.geometric_normal, direction) > 0.0;
}

// light: above the horizon.
ReflectedParts reflected_sample(SampledPixel p, EnvironmentSample light) {
  vec3 arriving = light.irradiance;
#if MEDIUM
  Medium medium = scene_medium();
  arriving *= medium_transmittance(medium, medium_length(medium, p.position, light.direction, 3.0e38));
#endif
#if SAMPLE_PARTS
  ReflectedParts response = surface_response_parts(p.material, p.surface.normal, p.to_viewer, light.direction);
  return ReflectedParts(response.diffuse * arriving, response.lobe * arriving);
#else
  vec3 response = surface_response(p.material, p.surface.normal, p.to_viewer, light.direction);
  return ReflectedParts(response * arriving, vec3(0.0));
#endif
}

bool is_coated(SampledPixel p) { return has_coat(p.material); }

#endif  // LIMN_SAMPLED_PIXEL_GLSL
