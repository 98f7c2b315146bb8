#include "shading_numerics.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Inputs { NumericsInput inputs[]; };
layout(std430) writeonly buffer Results { NumericsResult results[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < uint(inputs.length())) results[i] = numerics(inputs[i]);
}
