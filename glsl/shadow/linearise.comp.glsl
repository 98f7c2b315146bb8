// Rasterised depth to linear depth in [0, 1]. What is not a finite depth in range becomes 1: nothing there.
#include "glsl/shadow_view.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = 0) uniform sampler2DArray rasterised;
layout(binding = 0, r32f) writeonly uniform image2DArray linear_depth;
layout(std430, binding = 0) readonly buffer Views { ShadowView views[]; };

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel, imageSize(linear_depth)))) return;
  float z = texelFetch(rasterised, texel, 0).r;
  imageStore(linear_depth, texel, vec4(shadow_stored_from_clip(views[texel.z], z)));
}
