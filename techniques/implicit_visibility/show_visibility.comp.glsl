// V of each light of a batch: the mean of the leaves around the pixel. With LISTED that of the pixel itself, where the leaf that
// is nearest to it has a list of what may hide the light.
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/surface/gbuffer_input.glsl"
#if LISTED
#include "techniques/implicit_visibility/listed_visibility.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(r16) writeonly uniform image2DArray visibility;
layout(std430) readonly buffer Seen { float seen[]; };
#if LISTED
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Indices { uint indices[]; };
#endif
uniform uint slots;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, gl_WorkGroupID.z);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = 1.0;
  float depth = pixel_depth(at.xy);
  if (depth > 0.0) {
    Around a = around_pixel(at.xy);
    uvec3 from = uint(at.z) * slots + a.slots;
    if (a.found) v = dot(a.weights, vec3(seen[from.x], seen[from.y], seen[from.z]));
#if LISTED
    int second = a.weights.y > a.weights.x ? 1 : 0;
    uvec2 range = a.found ? ranges[from[a.weights.z > a.weights[second] ? 2 : second]] : uvec2(0u, unlisted);
    if (range.y != unlisted)
      v = listed_visibility(lights[indices[at.z]], pixel_position(at.xy, depth), pixel_geometric_normal(at.xy), range);
#endif
  }
  imageStore(visibility, at, vec4(v));
}
