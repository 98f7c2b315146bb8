// Specular radiance of leaves by their trees.
#ifndef LIMN_LEAF_TREE_GLSL
#define LIMN_LEAF_TREE_GLSL
#include "glsl/indirect/packed_tree.glsl"
#include "glsl/indirect/surface_leaf.glsl"
#include "glsl/numeric/geometry.glsl"

struct LeafTree {
  uint first;   // of the nodes of all trees, or no_tree
  float scale;  // of their values
};

layout(std430) readonly buffer Leaves { Leaf leaves[]; };
layout(std430) readonly buffer Trees { LeafTree trees[]; };

// Of a uniform basis: 2^level; 0: cells.
uniform uint grid;

const uint no_tree = 0xffffffffu;

// Radiance that a leaf sends towards `view` (unit, world).
vec3 leaf_radiance(uint slot, vec3 view) {
  LeafTree tree = trees[slot];
  if (tree.first == no_tree) return vec3(0.0);
  vec3 w = to_local(frame_around(leaves[slot].normal.xyz), view);
  w.z = max(w.z, 1e-3);
  return tree.scale * (grid > 0u ? packed_grid_value(tree.first, grid, w) : packed_tree_value(tree.first, w));
}

#endif  // LIMN_LEAF_TREE_GLSL
