// A node of the hierarchies that rays walk: the boxes of up to four children in 8 bits for each of their sides, relative to
// the box around all of them (Ylitie, Karras and Laine 2017, section 3.1, with four children where theirs have eight). The
// boxes contain what they stand for: low sides are rounded down and high sides up.
#ifndef LIMN_RAY_NODE_GLSL
#define LIMN_RAY_NODE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Storage buffer element, 64 bytes. Byte i of the words of sides belongs to child i.
struct RayNode {
  vec3 origin;  // lowest corner of all children, m
  uint low_x;
  vec3 scale;  // length of one step of the sides, m
  uint high_x;
  uint low_y;
  uint high_y;
  uint low_z;
  uint high_z;
  uvec4 child;  // ray_no_child, a leaf (ray_leaf), or the number of a node
};

LIMN_CONST uint ray_no_child = 0xffffffffu;
LIMN_CONST uint ray_leaf_flag = 0x80000000u;
LIMN_CONST uint ray_leaf_items = 4u;            // at most, in one leaf
LIMN_CONST uint ray_leaf_mask = 0x1fffffffu;    // the number of a leaf's first item
LIMN_CONST float ray_steps = 255.0f;
LIMN_CONST float ray_box_margin = 1.9073486e-6f;  // 2^-19, of the largest coordinate: room for the rounding of a ray's entry

// The items first .. first + count - 1; count is 1 to ray_leaf_items.
LIMN_FN uint ray_leaf(uint first, uint count) { return ray_leaf_flag | (count - 1u) << 29u | first; }
LIMN_FN bool ray_is_leaf(uint child) { return (child & ray_leaf_flag) != 0u; }
LIMN_FN uint ray_leaf_first(uint child) { return child & ray_leaf_mask; }
LIMN_FN uint ray_leaf_count(uint child) { return (child >> 29u & 3u) + 1u; }

struct RayBox {
  vec3 low;
  vec3 high;
};

LIMN_FN RayBox ray_box_empty() {
  RayBox b;
  b.low = vec3(3.0e38f);
  b.high = vec3(-3.0e38f);
  return b;
}

LIMN_FN RayBox ray_box_join(RayBox a, RayBox b) {
  a.low = min(a.low, b.low);
  a.high = max(a.high, b.high);
  return a;
}

// The box with the margin that its coordinates' rounding asks for.
LIMN_FN RayBox ray_box_grown(RayBox b) {
  vec3 reach = max(abs(b.low), abs(b.high));
  float margin = ray_box_margin * max(max(reach.x, reach.y), reach.z);
  b.low = b.low - margin;
  b.high = b.high + margin;
  return b;
}

LIMN_FN uint ray_pack_side(uint word, float value, int child) {
  return word | uint(value) << uint(8 * child);
}
LIMN_FN float ray_unpack_side(uint word, int child) { return float(word >> uint(8 * child) & 255u); }

// A node without children whose steps span `around`.
LIMN_FN RayNode ray_node_around(RayBox around) {
  RayNode n;
  n.origin = around.low;
  // A little more than the box: 255 steps must reach its end after rounding.
  n.scale = max((around.high - around.low) * (1.000001f / ray_steps), vec3(1e-35f));
  n.low_x = 0u;
  n.high_x = 0u;
  n.low_y = 0u;
  n.high_y = 0u;
  n.low_z = 0u;
  n.high_z = 0u;
  n.child = uvec4(ray_no_child);
  return n;
}

// Makes `value` child i of the node, which has none there; the box lies within that of ray_node_around().
LIMN_FN void ray_node_add(LIMN_INOUT(RayNode) n, int i, RayBox box, uint value) {
  vec3 low = clamp(floor((box.low - n.origin) / n.scale), vec3(0.0f), vec3(ray_steps));
  vec3 high = clamp(ceil((box.high - n.origin) / n.scale), vec3(0.0f), vec3(ray_steps));
  n.low_x = ray_pack_side(n.low_x, low.x, i);
  n.low_y = ray_pack_side(n.low_y, low.y, i);
  n.low_z = ray_pack_side(n.low_z, low.z, i);
  n.high_x = ray_pack_side(n.high_x, high.x, i);
  n.high_y = ray_pack_side(n.high_y, high.y, i);
  n.high_z = ray_pack_side(n.high_z, high.z, i);
  n.child[i] = value;
}

LIMN_FN RayBox ray_node_box(RayNode n, int i) {
  RayBox b;
  b.low = n.origin +
          vec3(ray_unpack_side(n.low_x, i), ray_unpack_side(n.low_y, i), ray_unpack_side(n.low_z, i)) * n.scale;
  b.high = n.origin +
           vec3(ray_unpack_side(n.high_x, i), ray_unpack_side(n.high_y, i), ray_unpack_side(n.high_z, i)) * n.scale;
  return b;
}

// The box around all children.
LIMN_FN RayBox ray_node_bounds(RayNode n) {
  RayBox b = ray_box_empty();
  for (int i = 0; i < 4; ++i)
    if (n.child[i] != ray_no_child) b = ray_box_join(b, ray_node_box(n, i));
  return b;
}

// What rays meet: one drawn copy of a primitive (storage buffer element, 64 bytes; its number is that of the draw instance).
struct RayBody {
  vec3 row_x;  // rows of the matrix from world space to the body's own, and what it shifts by, m
  float shift_x;
  vec3 row_y;
  float shift_y;
  vec3 row_z;
  float shift_z;
  uint root;            // node
  uint coverage;        // first word of what its alpha mask is made of (glsl/rays/ray_coverage.glsl), or ray_opaque
  uint first_triangle;  // of the body's mesh
  uint unused;
};
LIMN_CONST uint ray_opaque = 0xffffffffu;

// A triangle whose vertices move, by the numbers of its vertices in its primitive (storage buffer element).
struct RayCorners {
  uvec3 vertex;
  uint draw;  // instance
};

LIMN_END
#endif  // LIMN_RAY_NODE_GLSL
