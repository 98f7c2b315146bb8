// A picture of the elements: each pixel in the colour of the leaf that is nearest to it, darker where the surface turns away.
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) writeonly uniform image2D radiance;
layout(std430) readonly buffer Colours { vec4 colours[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec3 colour = vec3(0.0);
  if (pixel_depth(pixel) > 0.0) {
    Around a = around_pixel(pixel);
    float facing = abs(dot(pixel_geometric_normal(pixel), normalize(pixel_ray(pixel))));
    if (a.found) colour = mix(0.4, 1.0, facing) * colours[a.slots[nearest_corner(a)]].rgb;
  }
  imageStore(radiance, pixel, vec4(colour, 1.0));
}
