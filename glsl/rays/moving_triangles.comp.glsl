// Fetches the vertices of triangles that are skinned or morphed, in the order of the hierarchy's leaves.
#include "glsl/numeric/work_items.glsl"
#include "glsl/rays/ray_node.glsl"
#include "glsl/scene/blocks.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Positions { float positions[]; };
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer MovingCorners { RayCorners corners[]; };
layout(std430) buffer RayTriangles { vec4 ray_triangles[]; };

uniform uint first_triangle;
uniform uint triangles;

void main() {
  uint i = work_item_index();
  if (i >= triangles) return;
  RayCorners c = corners[i];
  for (uint k = 0u; k < 3u; ++k) {
    uint at = 3u * (instances[c.draw].first_vertex + c.vertex[k]);
    ray_triangles[3u * (first_triangle + i) + k] = vec4(positions[at], positions[at + 1u], positions[at + 2u], 0.0);
  }
}
