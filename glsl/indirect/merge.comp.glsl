// Puts sub-buffers together to a screen.
#include "glsl/scene/blocks.glsl"
#include "glsl/indirect/gather_parts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2DArray split;
layout(rgba32f) writeonly uniform image2DArray merged;
uniform int block;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = ivec2(frame.frame_size);
  if (any(greaterThanEqual(at.xy, size))) return;
  imageStore(merged, at, texelFetch(split, ivec3(split_texel(at.xy, block, size), at.z), 0));
}
