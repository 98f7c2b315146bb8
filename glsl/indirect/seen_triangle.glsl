// A triangle as seen from a receiver at the origin, for filling bins of directions (direction_bins.glsl).
#ifndef LIMN_SEEN_TRIANGLE_GLSL
#define LIMN_SEEN_TRIANGLE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// A ray d meets the triangle where no weight of a corner, dot(weight_a, d) and so on, is negative, at the distance
// height / dot(normal, d) along d. The weights are those of homogeneous rasterisation (Olano and Greer 1997), for which no corner
// has to lie in front of a face; triangles that share an edge share its weights, but for the sign.
struct SeenTriangle {
  vec3 weight_a;
  vec3 weight_b;
  vec3 weight_c;
  vec3 normal;   // away from the receiver, of any length
  float height;  // along the normal; 0: seen edge-on, which hides nothing
  bool back;     // its back is seen
};

LIMN_FN SeenTriangle seen_triangle(vec3 a, vec3 b, vec3 c) {
  SeenTriangle t;
  vec3 n = cross(b - a, c - a);
  float height = dot(a, n);
  t.back = height > 0.0f;
  float side = t.back ? 1.0f : -1.0f;
  t.weight_a = side * cross(b, c);
  t.weight_b = side * cross(c, a);
  t.weight_c = side * cross(a, b);
  t.normal = side * n;
  // Edge-on: its plane passes the receiver at less than 1e-4 of the triangle's size.
  float length2 = dot(n, n);
  t.height = height * height > 1e-8f * length2 * sqrt(length2) ? side * height : 0.0f;
  return t;
}

// Whether a corner lies more than `reach` below a receiver's horizon, whose normals differ from `up` by up to `spread`. A
// grazing angle of 1e-4 counts as below it.
LIMN_FN bool below_horizon(vec3 corner, vec3 up, float reach, float spread) {
  float size = abs(corner.x) + abs(corner.y) + abs(corner.z);
  return dot(corner, up) + reach + (spread - 1e-4f) * size <= 0.0f;
}

LIMN_END
#endif  // LIMN_SEEN_TRIANGLE_GLSL
