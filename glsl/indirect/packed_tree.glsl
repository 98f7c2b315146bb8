// Light over directions as a tree of triangles (core/radiosity/directional_tree.h), 8 bytes a node: its first child, counted
// from the tree's first node, 0 for none, and its value over the tree's scale (shared_exponent_encode). The four faces of the
// hemisphere around the normal come first. In the uniform basis there are the values at the corners of a level
// instead, two in the place of a node.
#ifndef LIMN_PACKED_TREE_GLSL
#define LIMN_PACKED_TREE_GLSL
#include "glsl/numeric/octahedral_cells.glsl"
#include "glsl/numeric/octahedral_grid.glsl"
#include "glsl/numeric/shared_exponent.glsl"
LIMN_BEGIN

// Where a tree begins, and its node i.
#ifdef __cplusplus
using PackedTree = const uvec2*;
LIMN_FN uvec2 packed_node(PackedTree tree, uint i) { return tree[i]; }
#else
#define PackedTree uint
layout(std430) readonly buffer DirectionNodes { uvec2 direction_nodes[]; };
uvec2 packed_node(uint tree, uint i) { return direction_nodes[tree + i]; }
#endif

// The value of the brightest channel of a tree whose scale is 1: the format holds values down to 2^-30 of it.
LIMN_CONST float packed_tree_brightest = 32768.0f;

// The cell of direction w (any length but 0), which a tree of the hemisphere has above the horizon alone. `edge`: that of the
// cell, as a part of its face's.
LIMN_FN uvec2 packed_tree_cell(PackedTree tree, vec3 w, LIMN_OUT(float) edge) {
  vec3 place = octahedral_place(w);
  uvec2 node = packed_node(tree, octahedral_face(w));
  edge = 1.0f;
  while (node.x != 0u) {
    node = packed_node(tree, node.x + octahedral_descend(place));
    edge *= 0.5f;
  }
  return node;
}

// The value in direction w, w.z >= 0, of a tree of the hemisphere, over its scale: the mean of six values over the footprint of
// w's cell.
LIMN_FN vec3 packed_tree_value(PackedTree tree, vec3 w) {
  float edge;
  packed_tree_cell(tree, w, edge);
  vec3 place = octahedral_place(w);
  vec3 signs = octahedral_signs(octahedral_face(w));
  vec3 sum = vec3(0.0f);
  for (uint i = 0u; i < 6u; ++i) {
    vec3 tap = octahedral_tap(place, signs, edge, i);
    float unused;
    sum += shared_exponent_decode(packed_tree_cell(tree, vec3(tap.x, tap.y, abs(tap.z)), unused).y);
  }
  return sum / 6.0f;
}

// The same in the uniform basis, linear between the corners of the level with n = 2^level.
LIMN_FN vec3 packed_grid_value(PackedTree tree, uint n, vec3 w) {
  OctahedralGridPlace place = octahedral_grid_place(w, n);
  vec3 sum = vec3(0.0f);
  for (int k = 0; k < 3; ++k) {
    uvec2 pair = packed_node(tree, place.corner[k] / 2u);
    sum += place.weight[k] * shared_exponent_decode((place.corner[k] & 1u) == 0u ? pair.x : pair.y);
  }
  return sum;
}

LIMN_END
#endif  // LIMN_PACKED_TREE_GLSL
