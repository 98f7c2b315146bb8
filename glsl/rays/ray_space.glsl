// A ray against boxes and triangles.
#ifndef LIMN_RAY_SPACE_GLSL
#define LIMN_RAY_SPACE_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/rays/ray_node.glsl"
LIMN_BEGIN

// A ray in the space of the scene or of a body: the same multiple of the direction is the same point in each.
struct RaySpace {
  vec3 origin;
  vec3 direction;
  vec3 inverse;  // of the direction; finite
};

LIMN_FN RaySpace ray_space(vec3 origin, vec3 direction) {
  RaySpace r;
  r.origin = origin;
  r.direction = direction;
  vec3 size = abs(direction);
  float least = max(1e-12f * max(max(size.x, size.y), size.z), 1e-30f);
  r.inverse = mix(vec3(1.0f), vec3(-1.0f), lessThan(direction, vec3(0.0f))) / max(size, vec3(least));
  return r;
}

LIMN_FN vec3 ray_body_turn(RayBody b, vec3 v) {
  return vec3(dot(b.row_x, v), dot(b.row_y, v), dot(b.row_z, v));
}
LIMN_FN RaySpace ray_into_body(RayBody b, vec3 origin, vec3 direction) {
  return ray_space(ray_body_turn(b, origin) + vec3(b.shift_x, b.shift_y, b.shift_z), ray_body_turn(b, direction));
}

LIMN_FN vec4 ray_sides(uint word) {
  return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & uvec4(255u));
}

// Which children's boxes the segment up to `end` meets. Steps of the boxes go straight into parameters of the ray.
LIMN_FN bvec4 ray_meets_children(RayNode n, RaySpace r, float end) {
  vec3 first = (n.origin - r.origin) * r.inverse;
  vec3 steps = n.scale * r.inverse;
  bvec3 back = lessThan(r.inverse, vec3(0.0f));
  vec4 near = max(max(ray_sides(back.x ? n.high_x : n.low_x) * steps.x + first.x,
                      ray_sides(back.y ? n.high_y : n.low_y) * steps.y + first.y),
                  max(ray_sides(back.z ? n.high_z : n.low_z) * steps.z + first.z, vec4(0.0f)));
  vec4 far = min(min(ray_sides(back.x ? n.low_x : n.high_x) * steps.x + first.x,
                     ray_sides(back.y ? n.low_y : n.high_y) * steps.y + first.y),
                 min(ray_sides(back.z ? n.low_z : n.high_z) * steps.z + first.z, vec4(end)));
  // A few units in the last place, so that rounding loses no box that is grazed (Ize 2013).
  bvec4 crossed = lessThanEqual(near, far * 1.0000008f);
  bvec4 there = notEqual(n.child, uvec4(ray_no_child));
  return bvec4(crossed.x && there.x, crossed.y && there.y, crossed.z && there.z, crossed.w && there.w);
}

// Whether the triangle lies between the ends of the segment, the weights of its corners, times a common factor, and in `end` where
// the ray meets it. The three edge functions, Pluecker products, come from the same numbers on both sides of an edge, so that no
// ray slips between neighbours (Davidovic et al. 2012), and only a hit divides: most rays miss.
LIMN_FN bool ray_meets_triangle(RaySpace r, vec3 a, vec3 b, vec3 c, LIMN_INOUT(float) end, LIMN_OUT(vec3) weights) {
  a = a - r.origin;
  b = b - r.origin;
  c = c - r.origin;
  vec3 edge_ca = c - a;
  vec3 edge_ab = a - b;
  vec3 edge_bc = b - c;
  weights = vec3(dot(cross(b + c, edge_bc), r.direction), dot(cross(c + a, edge_ca), r.direction),
                 dot(cross(a + b, edge_ab), r.direction));
  float least = min(min(weights.x, weights.y), weights.z);
  float most = max(max(weights.x, weights.y), weights.z);
  vec3 normal = cross(edge_ca, edge_ab);
  float slope = dot(normal, r.direction);
  float depth = slope < 0.0f ? -dot(normal, a) : dot(normal, a);
  bool met = (least >= 0.0f || most <= 0.0f) && slope != 0.0f && depth > 0.0f && depth <= end * abs(slope);
  if (met) end = depth / abs(slope);
  return met;
}

LIMN_END
#endif  // LIMN_RAY_SPACE_GLSL
