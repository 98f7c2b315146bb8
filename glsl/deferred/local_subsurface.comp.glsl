// Adds the light that leaves translucent surfaces where it entered them, the local limit: B = A E of a half space.
#include "glsl/diffusion/boundary.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform sampler2D entering;  // E / pi

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec3 light = texelFetch(entering, pixel, 0).rgb;
  if (light == vec3(0.0)) return;
  GBufferSurface surface = pixel_surface(pixel);
  float cosine = dot(surface.normal, -normalize(pixel_ray(pixel)));
  light *= surface.base_colour * (pi * diffusion_exit(diffusion_boundary(surface.ior), max(cosine, 0.0)));
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
