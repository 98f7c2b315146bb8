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

// Weights of the 4 x 4 blocks around a pixel, in rows; outside the picture and where nothing is lit 0. Returns their sum.
float block_weights(ivec2 pixel, float depth, out ivec2 first, out float weights[16]) {
  vec3 position = pixel_position(pixel, depth);
  vec3 normal = pixel_normal(pixel);
  float block_width = depth * length(frame.view_ray_dx.xyz) * float(BLOCK_SIDE);
  BlockTents tents = block_tents(pixel, BLOCK_SIDE);
  first = tents.first;
  ivec2 grid = block_grid();
  float sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    ivec2 block = first + ivec2(i % 4, i / 4);
    weights[i] = 0.0;
    if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block, grid))) continue;
    uvec4 stored = texelFetch(block_surfaces, block, 0);
    if (stored.x == no_block_surface) continue;
    float apart = length(position - uintBitsToFloat(stored.xyz)) / block_width;
    vec3 other = octahedral_decode(unpackSnorm2x16(stored.w));
    float likeness = block_likeness(apart, normal, other, block_position_width, block_normal_width);
    weights[i] = tents.across[i % 4] * tents.down[i / 4] * likeness;
    sum += weights[i];
  }
  return sum;
}

#endif  // LIMN_BLOCK_SURFACES_GLSL
