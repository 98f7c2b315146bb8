// The items of a grid that is shaded in place of pixels (glsl/surface/pixel_blocks.glsl): blocks, then rows of lone pixels.
// BLOCK_SIDE: of a block, pixels; 1: every pixel is an item, and the only one.
#ifndef LIMN_BLOCK_ITEMS_GLSL
#define LIMN_BLOCK_ITEMS_GLSL
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/surface/pixel_blocks.glsl"

#if BLOCK_SIDE > 1
layout(std430) readonly buffer LonePixels { uint lone_count; uint lone_pixels[]; };
#endif

// False: the item is no pixel of the picture.
bool item_pixel(ivec2 item, out ivec2 pixel) {
#if BLOCK_SIDE > 1
  ivec2 size = ivec2(frame.frame_size);
  ivec2 blocks = block_count(size, BLOCK_SIDE);
  pixel = block_middle(item, BLOCK_SIDE, size);
  if (item.y < blocks.y) return item.x < blocks.x;
  if (item.x >= size.x) return false;
  uint place = uint((item.y - blocks.y) * size.x + item.x);
  if (place >= lone_count) return false;
  pixel = ivec2(lone_pixels[place] & 0xffffu, lone_pixels[place] >> 16u);
  return true;
#else
  pixel = item;
  return all(lessThan(item, ivec2(frame.frame_size)));
#endif
}

#endif  // LIMN_BLOCK_ITEMS_GLSL
