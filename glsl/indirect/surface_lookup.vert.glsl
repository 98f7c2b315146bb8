// The triangles between surfels, as the camera sees them: which leaves lie around a pixel. Clip depth as in the G-buffer.
#include "glsl/indirect/surface_leaf.glsl"
#include "glsl/scene/blocks.glsl"

layout(std430) readonly buffer Leaves { Leaf leaves[]; };
layout(std430) readonly buffer Corners { uint corners[]; };
uniform float near_plane;

layout(location = 0) out vec2 place;  // barycentric coordinates of the second and third corner
layout(location = 1) flat out uvec3 around;

void main() {
  int first = gl_VertexID / 3 * 3;
  int corner = gl_VertexID - first;
  around = uvec3(corners[first], corners[first + 1], corners[first + 2]);
  place = vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
  vec4 clip = frame.world_to_clip * vec4(leaves[corners[gl_VertexID]].vertex, 1.0);
  gl_Position = vec4(clip.xy, near_plane, clip.w);
}
