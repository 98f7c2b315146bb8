// What leaves a translucent body towards the camera.
#ifndef LIMN_DIFFUSION_PIXEL_EXIT_GLSL
#define LIMN_DIFFUSION_PIXEL_EXIT_GLSL
#include "glsl/diffusion/boundary.glsl"
#include "glsl/surface/gbuffer_input.glsl"

// Radiance that a pixel shows for a radiosity of pi, the factor on light that is counted as E / pi where it enters.
float pixel_exit(ivec2 pixel, DiffusionBoundary boundary) {
  float cosine = -dot(pixel_normal(pixel), normalize(pixel_ray(pixel)));
  return pi * diffusion_exit(boundary, cosine);
}

#endif  // LIMN_DIFFUSION_PIXEL_EXIT_GLSL
