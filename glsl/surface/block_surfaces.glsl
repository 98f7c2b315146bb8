// Surfaces of the blocks of a picture, and how like a pixel's they are. BLOCK_SIDE: of a block, pixels.
#ifndef LIMN_BLOCK_SURFACES_GLSL
#define LIMN_BLOCK_SURFACES_GLSL
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/surface/pixel_blocks.glsl"

uniform usampler2D block_surfaces;  // position, world, as bits; shading normal, octahedral, 2 x 16 bits
uniform float block_position_width;  // as in block_likeness()
uniform float block_normal_width;

const uint no_block_surface = 0xffffffffu;  // first word where a block's middle shows nothing that is lit

ivec2 block_grid() { return block_count(ivec2(frame.frame_size), BLOCK_SIDE); }

bool pixel_is_lit(ivec2 pixel, float depth) {
  uint flags = gbuffer_stored_flags(texelFetch(gbuffer_material, pixel, 0));
  return depth != 0.0 && (flags & gbuffer_flag_specular) == 0u;
}

// A pixel that takes values from the 4 x 4 blocks around it.
struct BlockReceiver {
  vec3 position;
  vec3 normal;
  float block_width;  // metres, at the pixel's depth
  BlockTents tents;
};

BlockReceiver block_receiver(ivec2 pixel, float depth) {
  return BlockReceiver(pixel_position(pixel, depth), pixel_normal(pixel),
                       depth * length(frame.view_ray_dx.xyz) * float(BLOCK_SIDE), block_tents(pixel, BLOCK_SIDE));
}

// Weight of the i-th of the 16 blocks, in rows; outside the picture and where nothing is lit 0.
float block_weight(BlockReceiver r, int i) {
  ivec2 block = r.tents.first + ivec2(i % 4, i / 4);
  float tent = r.tents.across[i % 4] * r.tents.down[i / 4];
  if (tent == 0.0 || any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block, block_grid()))) return 0.0;
  uvec4 stored = texelFetch(block_surfaces, block, 0);
  if (stored.x == no_block_surface) return 0.0;
  float apart = length(r.position - uintBitsToFloat(stored.xyz)) / r.block_width;
  vec3 other = octahedral_decode(unpackSnorm2x16(stored.w));
  return tent * block_likeness(apart, r.normal, other, block_position_width, block_normal_width);
}

#endif  // LIMN_BLOCK_SURFACES_GLSL
