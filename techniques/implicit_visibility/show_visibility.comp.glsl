// V of each light of a batch: the mean of the leaves around the pixel.
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(r16) writeonly uniform image2DArray visibility;
layout(std430) readonly buffer Seen { float seen[]; };
uniform uint slots;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, gl_WorkGroupID.z);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = 1.0;
  if (pixel_depth(at.xy) > 0.0) {
    Around a = around_pixel(at.xy);
    uvec3 from = uint(at.z) * slots + a.slots;
    if (a.found) v = dot(a.weights, vec3(seen[from.x], seen[from.y], seen[from.z]));
  }
  imageStore(visibility, at, vec4(v));
}
