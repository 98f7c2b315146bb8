// Lists the pixels whose surface none of the blocks around them sees. BLOCK_SIDE: pixels.
#include "glsl/surface/block_surfaces.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r32ui) writeonly uniform uimage2D lone_items;  // place in the list + 1; 0: upsampled
layout(std430) buffer LonePixels { uint lone_count; uint lone_pixels[]; };

bool is_middle(int i) { return i == 5 || i == 6 || i == 9 || i == 10; }

// Looks at the four blocks in the middle first, which most pixels are like.
bool is_alone(ivec2 pixel, float depth) {
  if (!pixel_is_lit(pixel, depth)) return false;
  BlockReceiver receiver = block_receiver(pixel, depth);
  float sum = 0.0;
  for (int i = 5; i <= 10; ++i)
    if (is_middle(i)) sum += block_weight(receiver, i);
  if (sum >= block_least_weight) return false;
  for (int i = 0; i < 16; ++i)
    if (!is_middle(i)) sum += block_weight(receiver, i);
  return sum < block_least_weight;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uint item = 0u;
  if (is_alone(pixel, pixel_depth(pixel))) {
    uint place = atomicAdd(lone_count, 1u);
    lone_pixels[place] = uint(pixel.x) | uint(pixel.y) << 16u;
    item = place + 1u;
  }
  imageStore(lone_items, pixel, uvec4(item, 0u, 0u, 0u));
}
