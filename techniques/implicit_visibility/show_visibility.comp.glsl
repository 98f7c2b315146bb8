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

#if LISTED
// Whether a pixel shows the surface between the leaves around it: at outlines they may be those of another, for which their
// lists do not hold.
bool is_between(Around a, vec3 position, float depth) {
  vec3 place = a.weights.x * leaves[a.slots.x].vertex + a.weights.y * leaves[a.slots.y].vertex +
               a.weights.z * leaves[a.slots.z].vertex;
  float footprint = 0.25 * depth * length(frame.view_ray_dx.xyz);
  vec3 off = place - position;
  return dot(off, off) <= footprint * footprint;
}
#endif

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
    vec3 position = pixel_position(at.xy, depth);
    uvec2 range = a.found ? ranges[from[nearest_corner(a)]] : uvec2(0u, unlisted);
    if (range.y != unlisted && is_between(a, position, depth))
      v = listed_visibility(lights[indices[at.z]], position, pixel_geometric_normal(at.xy), range);
#endif
  }
  imageStore(visibility, at, vec4(v));
}
