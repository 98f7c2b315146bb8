// Adds the light that leaves translucent surfaces where it entered them, the local limit: B = A E of a half space.
#include "glsl/diffusion/pixel_exit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform sampler2D entering;  // E / pi

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec3 light = texelFetch(entering, pixel, 0).rgb;
  if (light == vec3(0.0)) return;
  GBufferSurface surface = pixel_surface(pixel);
  light *= surface.base_colour * pixel_exit(pixel, diffusion_boundary(surface.ior));
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
