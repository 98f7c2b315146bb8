// Adds the light that leaves bodies: F_t(n.v) B / (pi (1 - F_de)), with B from the mean of the light that enters.
// BLUR 1: pixels whose light reaches over others have the mean over the pattern.
#include "techniques/subsurface_scattering/pixel_body.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform usampler2D planes;
uniform sampler2D gathered;
#if BLUR
uniform sampler2D blurred;
#endif
layout(rgba32f) uniform image2D radiance;

// Light that reaches less far than the first number of pixels is not blurred, beyond the second it is.
const vec2 blurred_reach = vec2(least_patterned_reach, 2.5);

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uint instance = texelFetch(planes, pixel, 0).w;
  if (instance == no_instance) return;
  uint body_index = bodies_of_instances[instance];
  if (body_index == no_body) return;
  DiffusionBody body = bodies[body_index];
  DiffusionBoundary boundary = diffusion_boundary(body.eta, body.entering);
  vec3 absorption = pixel_absorption(body, boundary, pixel);
  Colours colours = matter_colours(body.extinction, absorption, boundary);
  vec3 mean = texelFetch(gathered, pixel, 0).rgb;
#if BLUR
  vec3 reach = pixels_of_unit(body, pixel_depth(pixel)) * diffusion_reach(body.extinction, absorption, walk_reflectance(boundary));
  vec3 share = clamp((reach - blurred_reach.x) / (blurred_reach.y - blurred_reach.x), 0.0, 1.0);
  mean = mix(mean, texelFetch(blurred, pixel, 0).rgb, share);
#endif
  vec3 factor = colours.reflectance;
#if TEXTURED && ROOT
  if (body.textured != 0u) factor = sqrt(factor);
#endif
  float cosine = -dot(pixel_normal(pixel), normalize(pixel_ray(pixel)));
  vec3 light = pi * diffusion_exit(boundary, cosine) * factor * mean;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
