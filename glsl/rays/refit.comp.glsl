// Boxes of one level of hierarchies whose triangles have moved, from the triangles and from the nodes below.
#include "glsl/numeric/work_items.glsl"
#include "glsl/rays/ray_node.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer RayNodes { RayNode ray_nodes[]; };
layout(std430) readonly buffer RayTriangles { vec4 ray_triangles[]; };
layout(std430) readonly buffer RefitNodes { uint refit_nodes[]; };  // level after level, the deepest first

uniform uint first_node;  // of the level, in refit_nodes
uniform uint node_count;

RayBox box_below(uint child) {
  if (!ray_is_leaf(child)) return ray_node_bounds(ray_nodes[child]);
  RayBox box = ray_box_empty();
  uint first = 3u * ray_leaf_first(child), after = first + 3u * ray_leaf_count(child);
  for (uint i = first; i < after; ++i) {
    vec3 p = ray_triangles[i].xyz;
    box.low = min(box.low, p);
    box.high = max(box.high, p);
  }
  return ray_box_grown(box);
}

void main() {
  uint i = work_item_index();
  if (i >= node_count) return;
  uint number = refit_nodes[first_node + i];
  uvec4 children = ray_nodes[number].child;
  RayBox boxes[4];
  RayBox around = ray_box_empty();
  for (int c = 0; c < 4; ++c) {
    if (children[c] == ray_no_child) continue;
    boxes[c] = box_below(children[c]);
    around = ray_box_join(around, boxes[c]);
  }
  RayNode node = ray_node_around(around);
  for (int c = 0; c < 4; ++c)
    if (children[c] != ray_no_child) ray_node_add(node, c, boxes[c], children[c]);
  ray_nodes[number] = node;
}
