// Sorts the G-buffer into sub-buffers: pixels with the same place in their block side by side.
#include "glsl/surface/gbuffer_input.glsl"
#include "glsl/indirect/gather_parts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f) writeonly uniform image2D split_depth;
layout(rg16_snorm) writeonly uniform image2D split_normal;
layout(rg16_snorm) writeonly uniform image2D split_geometric_normal;
layout(rgba16) writeonly uniform image2D split_albedo;
layout(rgba8) writeonly uniform image2D split_material;
layout(rgba16f) writeonly uniform image2D split_emission;
uniform int block;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(frame.frame_size);
  if (any(greaterThanEqual(pixel, size))) return;
  ivec2 to = split_texel(pixel, block, size);
  imageStore(split_depth, to, texelFetch(gbuffer_depth, pixel, 0));
  imageStore(split_normal, to, texelFetch(gbuffer_normal, pixel, 0));
  imageStore(split_geometric_normal, to, texelFetch(gbuffer_geometric_normal, pixel, 0));
  imageStore(split_albedo, to, texelFetch(gbuffer_albedo, pixel, 0));
  imageStore(split_material, to, texelFetch(gbuffer_material, pixel, 0));
  imageStore(split_emission, to, texelFetch(gbuffer_emission, pixel, 0));
}
