// V as the mean of frames, of which `traced` has the sum and the number: r / a. Of a light without extent one ray is exact, and V
// that of this frame.
#include "glsl/scene/light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer Lights { Light lights[]; };
layout(r16) writeonly uniform image2DArray visibility;
uniform sampler2DArray traced;
uniform sampler2DArray this_frame;  // r / a, too
uniform uint light_indices[LIGHT_COUNT];

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  bool extended = light_has_extent(lights[light_indices[at.z]]);
  vec4 sum = extended ? texelFetch(traced, at, 0) : texelFetch(this_frame, at, 0);
  imageStore(visibility, at, vec4(sum.a > 0.0 ? sum.r / sum.a : 1.0));
}
