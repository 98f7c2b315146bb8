// Adds gathered indirect light to the radiance.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/indirect/gather_parts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2DArray gathered;
#if GATHER_RESIDUAL
uniform sampler2DArray spread;  // the residual alone
#endif
layout(rgba32f) uniform image2D radiance;

vec3 value_of(vec4 sum) { return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  GBufferSurface surface = pixel_surface(pixel);
  vec4 sum = texelFetch(gathered, ivec3(pixel, gather_part_diffuse), 0);
  if (sum.a == 0.0 || (surface.flags & gbuffer_flag_specular) != 0u) return;
  vec3 diffuse = value_of(sum);
#if GATHER_RESIDUAL
  diffuse += value_of(texelFetch(spread, ivec3(pixel, 0), 0));
#endif
  vec3 light = surface.base_colour * (1.0 - surface.metallic) * diffuse;
#if GATHER_SPECULAR
  light += value_of(texelFetch(gathered, ivec3(pixel, gather_part_specular), 0));
#endif
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
