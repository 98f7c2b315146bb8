// The matter below a pixel.
// NORMALISED: see glsl/diffusion/profile.glsl. TEXTURED 1: the base colour of pixels may say what absorbs.
#ifndef PIXEL_BODY_GLSL
#define PIXEL_BODY_GLSL
#include "glsl/diffusion/profile.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#include "techniques/subsurface_scattering/diffusion_body.glsl"

layout(std430) readonly buffer Bodies { DiffusionBody bodies[]; };
layout(std430) readonly buffer BodiesOfInstances { uint bodies_of_instances[]; };

vec3 pixel_absorption(DiffusionBody body, DiffusionBoundary boundary, ivec2 pixel) {
#if TEXTURED
  vec3 albedo = gbuffer_colour_decode(texelFetch(gbuffer_albedo, pixel, 0).rgb);
  vec3 absorption = walk_absorption(walk_reflectance(boundary), albedo);
  return body.textured != 0u ? absorption : body.absorption;
#else
  return body.absorption;
#endif
}

// Pixels at that depth in one unit of the body's length.
float pixels_of_unit(DiffusionBody body, float depth) { return body.unit / (depth * length(frame.view_ray_dx.xyz)); }

#endif  // PIXEL_BODY_GLSL
