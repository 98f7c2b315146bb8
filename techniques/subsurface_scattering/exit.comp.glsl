// Adds the light that leaves bodies: F_t(n.v) B / (pi (1 - F_de)), with B from the mean of the light that enters.
// BLUR 1: what is gathered is averaged over the pattern of interleaved pixels along rows, and is so along columns here.
#include "glsl/diffusion/pixel_exit.glsl"
#include "techniques/subsurface_scattering/pixel_body.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#if BLUR
#include "techniques/subsurface_scattering/pattern_mean.glsl"
#else
uniform usampler2D planes;
uniform sampler2D gathered;
#endif
layout(rgba32f) uniform image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uvec4 own = texelFetch(planes, pixel, 0);
  if (own.w == no_instance) return;
  uint body_index = bodies_of_instances[own.w];
  if (body_index == no_body) return;
#if BLUR
  vec3 mean = pattern_mean(pixel, own, ivec2(0, 1)).rgb;
#else
  vec3 mean = texelFetch(gathered, pixel, 0).rgb;
#endif
  DiffusionBody body = bodies[body_index];
  DiffusionBoundary boundary = diffusion_boundary(body.eta, body.entering);
  ProfileColours colours = profile_colours(body.extinction, pixel_absorption(body, boundary, pixel), boundary);
  vec3 factor = colours.reflectance;
#if TEXTURED && ROOT
  if (body.textured != 0u) factor = sqrt(factor);
#endif
  vec3 light = pixel_exit(pixel, boundary) * factor * mean;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
