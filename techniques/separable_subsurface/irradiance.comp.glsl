// Stores what lines of taps look up at translucent pixels: entering light times the root of the material's reflectance, and the
// depth of the pixel.
#include "techniques/separable_subsurface/line_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D entering;  // E / pi
layout(rgba32f) writeonly uniform image2D spread;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uint row = line_material_of(pixel_instance(pixel));
  if (row == no_line_material) return;
  vec3 light = texelFetch(entering, pixel, 0).rgb * root_reflectance(line_materials[row], pixel);
  imageStore(spread, pixel, vec4(light, pixel_depth(pixel)));
}
