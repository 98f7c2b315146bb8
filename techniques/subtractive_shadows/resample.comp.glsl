// Brings the shadow buffer to the pixels, and adds to the radiance what shadows leave of the unshadowed light, or what SHOW asks
// for in its place.
#include "techniques/subtractive_shadows/unshadowed.glsl"
#include "glsl/surface/block_upsampling.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
uniform sampler2D values;  // of each item of the grid: of the diffuse part, and of mirrors in the last lane
#if SAMPLE_PARTS
uniform sampler2D lobe_values;
#endif

// The lookup of the block alone that the pixel lies in; of nothing where its middle shows nothing that is lit.
BlockLookup own_block(ivec2 pixel) {
  BlockLookup b;
  b.first = pixel / BLOCK_SIDE;
  b.own = texelFetch(block_surfaces, b.first, 0).x != no_block_surface;
  for (int i = 0; i < 16; ++i) b.weights[i] = 0.0;
  return b;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
  float depth = pixel_depth(pixel);
  if (!pixel_is_lit(pixel, depth)) return;
  BlockLookup blocks;
  if (shown_part == SHOWN_SHADOW_BUFFER)
    blocks = own_block(pixel);
  else
    blocks = block_lookup(pixel, depth);
  vec4 diffuse_and_mirror = block_value(values, blocks);
  ShadowValues shadows = ShadowValues(ReflectedParts(diffuse_and_mirror.rgb, vec3(0.0)), diffuse_and_mirror.a);
#if SAMPLE_PARTS
  shadows.parts.lobe = block_value(lobe_values, blocks).rgb;
#endif
  SampledPixel p = sampled_pixel(pixel, depth);
  vec3 light = shown_light(p, unshadowed_light(pixel, p), shadows);
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(picture_share * light, 0.0));
}
