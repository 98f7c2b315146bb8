// Values of the items of a grid at each pixel (core/gpu_scene/pixel_blocks.h): the pixel's own, or the mean over the blocks
// around it. BLOCK_SIDE: of a block, pixels.
#ifndef LIMN_BLOCK_UPSAMPLING_GLSL
#define LIMN_BLOCK_UPSAMPLING_GLSL
#include "glsl/surface/block_surfaces.glsl"

uniform usampler2D lone_items;

struct BlockLookup {
  bool own;  // the item `first` is the pixel's own
  ivec2 first;
  float weights[16];  // of the 4 x 4 items from `first` on, in rows; their sum is 1
};

BlockLookup block_lookup(ivec2 pixel, float depth) {
  BlockLookup b;
  uint item = texelFetch(lone_items, pixel, 0).x;
  b.own = item != 0u;
  if (b.own) {
    int width = int(frame.frame_size.x);
    b.first = ivec2(int(item - 1u) % width, block_grid().y + int(item - 1u) / width);
    return b;
  }
  BlockReceiver receiver = block_receiver(pixel, depth);
  b.first = receiver.tents.first;
  float sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    b.weights[i] = block_weight(receiver, i);
    sum += b.weights[i];
  }
  for (int i = 0; i < 16; ++i) b.weights[i] /= sum;
  return b;
}

// values: a texel for each item.
vec4 block_value(sampler2D values, BlockLookup b) {
  if (b.own) return texelFetch(values, b.first, 0);
  vec4 value = vec4(0.0);
  for (int i = 0; i < 16; ++i)
    if (b.weights[i] > 0.0) value += b.weights[i] * texelFetch(values, b.first + ivec2(i % 4, i / 4), 0);
  return value;
}

#endif  // LIMN_BLOCK_UPSAMPLING_GLSL
