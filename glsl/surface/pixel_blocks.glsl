// Blocks of pixels: what is shaded once for each block, at the pixel in its middle, and upsampled from the blocks around by how
// near and how like a pixel's surface theirs are (joint bilateral upsampling: Kopf, Cohen, Lischinski, Uyttendaele 2007).
// Lone pixels, whose surface none of the blocks around them sees, are shaded themselves.
//
// What is shaded are items of a grid: first the blocks, in their rows, then rows of lone pixels. core/gpu_scene/pixel_blocks.h
// declares its passes.
#ifndef LIMN_PIXEL_BLOCKS_GLSL
#define LIMN_PIXEL_BLOCKS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Below this sum of weights, 4 where all surfaces are alike, a pixel is alone: limbs and leaves narrower than blocks are.
LIMN_CONST float block_least_weight = 0.3f;

// Blocks that cover a picture of `size` pixels.
LIMN_FN ivec2 block_count(ivec2 size, int side) { return (size + ivec2(side - 1)) / side; }

// Pixel that a block is shaded at. side: of a block, pixels; size: of the picture.
LIMN_FN ivec2 block_middle(ivec2 block, int side, ivec2 size) {
  return min(block * side + ivec2(side / 2), size - ivec2(1));
}

// The 4 x 4 blocks around a pixel: `first` and the three after it in x and y, with weights of tents two blocks wide to each side,
// the product of `across` and `down`; the sum of each is 2.
struct BlockTents {
  ivec2 first;
  vec4 across, down;
};

LIMN_FN vec4 block_tent(float place) {
  return vec4(1.0f - 0.5f * (place + 1.0f), 1.0f - 0.5f * place, 0.5f + 0.5f * place, 0.5f * place);
}

LIMN_FN BlockTents block_tents(ivec2 pixel, int side) {
  // In blocks, from the middle of the first one; whole where a middle pixel is its block's.
  vec2 place = vec2(pixel - ivec2(side / 2)) / float(side);
  vec2 below = floor(place);
  BlockTents t;
  t.first = ivec2(below) - ivec2(1);
  t.across = block_tent(place.x - below.x);
  t.down = block_tent(place.y - below.y);
  return t;
}

// Likeness of two surfaces, [0, 1]. apart: in widths of a block at the pixel's depth; position_width, normal_width: standard
// deviations of that, and of unit normals.
LIMN_FN float block_likeness(float apart, vec3 n, vec3 other, float position_width, float normal_width) {
  vec3 turned = n - other;
  float p = apart / position_width;
  return exp(-0.5f * (p * p + dot(turned, turned) / (normal_width * normal_width)));
}

LIMN_END
#endif  // LIMN_PIXEL_BLOCKS_GLSL
