// Puts what is seen in specular surfaces over what is seen beside them.
#include "glsl/surface/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D gbuffer_material;
uniform sampler2D gbuffer_emission;
uniform sampler2D beside;
uniform sampler2D seen;
layout(rgba32f) writeonly uniform image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
  uint flags = gbuffer_stored_flags(texelFetch(gbuffer_material, pixel, 0));
  vec4 light = texelFetch(beside, pixel, 0);
  if ((flags & gbuffer_flag_specular) != 0u) {
    light.rgb = texelFetch(gbuffer_emission, pixel, 0).rgb + texelFetch(seen, pixel, 0).rgb;
  }
  imageStore(radiance, pixel, light);
}
