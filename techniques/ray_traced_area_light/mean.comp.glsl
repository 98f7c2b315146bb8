// V as the mean of frames, of which `traced` has the sum and the number: r / a.
layout(local_size_x = 8, local_size_y = 8) in;

layout(r16) writeonly uniform image2DArray visibility;
uniform sampler2DArray traced;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  vec4 sum = texelFetch(traced, at, 0);
  imageStore(visibility, at, vec4(sum.a > 0.0 ? sum.r / sum.a : 1.0));
}
