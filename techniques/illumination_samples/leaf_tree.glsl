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

const uint no_tree = 0xffffffffu;

// Lobes of at least this width (roughness 0.3) are looked up smoothly: narrower ones would be blurred.
const float smooth_alpha = 0.09;

// Radiance that a leaf sends towards `view` (unit, world); alpha: the GGX width of what is seen.
vec3 leaf_radiance(uint slot, vec3 view, float alpha) {
  LeafTree tree = trees[slot];
  if (tree.first == no_tree) return vec3(0.0);
  vec3 w = to_local(frame_around(leaves[slot].normal.xyz), view);
  w.z = max(w.z, 1e-3);
  return tree.scale * packed_tree_value(tree.first, w, alpha >= smooth_alpha);
}

#endif  // LIMN_LEAF_TREE_GLSL
