// Writes the surface that each block of pixels is shaded at, and empties the list of lone pixels. BLOCK_SIDE: pixels.
#include "glsl/surface/block_surfaces.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32ui) writeonly uniform uimage2D surfaces;
layout(std430) buffer LonePixels { uint lone_count; uint lone_pixels[]; };

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (block == ivec2(0)) lone_count = 0u;
  if (any(greaterThanEqual(block, block_grid()))) return;
  ivec2 pixel = block_middle(block, BLOCK_SIDE, ivec2(frame.frame_size));
  float depth = pixel_depth(pixel);
  uvec4 stored = uvec4(no_block_surface, 0u, 0u, 0u);
  if (pixel_is_lit(pixel, depth))
    stored = uvec4(floatBitsToUint(pixel_position(pixel, depth)),
                   packSnorm2x16(texelFetch(gbuffer_normal, pixel, 0).xy));
  imageStore(surfaces, block, stored);
}
