// What enters at the clusters of one level: the mean of their children, weighted by area.
#include "glsl/numeric/work_items.glsl"
#include "techniques/hierarchical_subsurface/scatter_tree.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Nodes { ScatterNode nodes[]; };
layout(std430) buffer Entering { vec4 entering_light[]; };
uniform uint first_node;
uniform uint node_count;

void main() {
  uint item = work_item_index();
  if (item >= node_count) return;
  uint index = first_node + item;
  ScatterNode node = nodes[index];
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < node.child_count; ++k)
    sum += nodes[node.children + k].area * entering_light[node.children + k].rgb;
  entering_light[index] = vec4(node.area > 0.0 ? sum / node.area : vec3(0.0), 0.0);
}
