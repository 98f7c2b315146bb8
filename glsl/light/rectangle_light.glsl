// A rectangle as seen from a receiver: the part above a horizon, its area, solid angle, uniform sampling, and
// the exact irradiance it gives (Lambert 1760; vector form as in Arvo 1994, The Irradiance Jacobian).
//
// Polygons live in the rectangle's own coordinates: (a, b) in [-1/2, 1/2]^2 stands for centre + a u + b v.
// Vertex differences are then exact to rounding however far the receiver is, which is what keeps the formulas
// below free of cancellation: the relative error is below (1e-6 + 2e-7 long side / short side) / cosine at
// the light, from touching distance to 1e5 sizes away and at any scale; where the inputs' own rounding
// decides (light seen edge-on or on the horizon) it is below 1e-6 of what the same light would give facing
// the receiver.
#ifndef LIMN_RECTANGLE_LIGHT_GLSL
#define LIMN_RECTANGLE_LIGHT_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
LIMN_BEGIN

// A rectangle relative to a receiver.
struct Rectangle {
  vec3 centre;  // from the receiver to the rectangle's centre
  vec3 u;       // sides
  vec3 v;
};

LIMN_CONST int rectangle_part_vertices = 7;

// Convex part of a rectangle in (a, b), in the order of the corners. count is 0, or 3 to 4 + the number of
// cuts (at most 3).
struct RectanglePart {
  int count;
  int most;  // count cannot be greater; a constant wherever the functions below are inlined
  vec2 vertex[rectangle_part_vertices];
};

// Of a distant rectangle: in units of its plane's distance.
LIMN_FN Rectangle rectangle_from(Light light, vec3 receiver) {
  Rectangle r;
  r.centre = light.position;
  if (light.type != light_directional) r.centre = r.centre - receiver;
  r.u = light.axis_u * light.length_u;
  r.v = light.axis_v * light.length_v;
  return r;
}

LIMN_FN vec3 rectangle_point(Rectangle r, vec2 ab) {
  return r.centre + ab.x * r.u + ab.y * r.v;
}

// The same of a light, in world space: of a distant rectangle in its plane, of one without sides its position.
LIMN_FN vec3 rectangle_point(Light light, vec2 ab) {
  return light.position + ab.x * light.length_u * light.axis_u + ab.y * light.length_v * light.axis_v;
}

// +1 where the receiver is in front of the light, -1 behind it, 0 in its plane.
LIMN_FN float rectangle_side(Light light, vec3 receiver) {
  float height = dot(light.direction, receiver - light.position);
  return height > 0.0f ? 1.0f : height < 0.0f ? -1.0f : 0.0f;
}

// Whether the light emits towards the receiver at all: towards its side, inside the cone and within the range.
LIMN_FN bool rectangle_emits_towards(Light light, vec3 receiver) {
  if (light.type == light_directional) return true;
  float side = rectangle_side(light, receiver);
  bool facing = (light.flags & light_flag_two_sided) != 0u ? side != 0.0f : side > 0.0f;
  return facing && receiver_factor(light, receiver) > 0.0f;
}

LIMN_FN RectanglePart rectangle_whole() {
  RectanglePart p;
  p.count = 4;
  p.most = 4;
  p.vertex[0] = vec2(-0.5f, -0.5f);
  p.vertex[1] = vec2(0.5f, -0.5f);
  p.vertex[2] = vec2(0.5f, 0.5f);
  p.vertex[3] = vec2(-0.5f, 0.5f);
  for (int i = 4; i < rectangle_part_vertices; ++i) p.vertex[i] = p.vertex[3];
  return p;
}

// What shading calls for every pixel loops over vertices with constant bounds and places them by comparison, so that the
// array lives in registers: indexed at run time it would live in memory, which software renderers read lane by lane.

// The last vertex.
LIMN_FN vec2 rectangle_part_last(RectanglePart p) {
  vec2 last = p.vertex[0];
  for (int i = 1; i < rectangle_part_vertices; ++i) last = i < p.most && i < p.count ? p.vertex[i] : last;
  return last;
}

// Appends a vertex to a part that has fewer than `places` so far.
LIMN_FN void rectangle_part_add(LIMN_INOUT(RectanglePart) p, int places, vec2 v) {
  for (int i = 0; i < rectangle_part_vertices; ++i) {
    if (i < places && i == p.count) p.vertex[i] = v;
  }
  ++p.count;
}

// The points of `part` with dot(normal, point) >= 0 (normal: any length but 0). Height is affine in (a, b),
// so that cutting needs no vertex position. Points within rounding of the plane count as above it or below it
// as they fall.
LIMN_FN RectanglePart rectangle_part_above(Rectangle r, RectanglePart part, vec3 normal) {
  float height = dot(normal, r.centre);
  vec2 slope = vec2(dot(normal, r.u), dot(normal, r.v));
  RectanglePart cut = part;
  cut.count = 0;
  cut.most = min(part.most + 1, rectangle_part_vertices);
  vec2 here = rectangle_part_last(part);
  float h0 = height + dot(slope, here);
  for (int i = 0; i < rectangle_part_vertices; ++i) {
    if (i < part.most && i < part.count) {
      vec2 next = part.vertex[i];
      float h1 = height + dot(slope, next);
      if ((h0 >= 0.0f) != (h1 >= 0.0f)) rectangle_part_add(cut, i + 2, here + h0 / (h0 - h1) * (next - here));
      if (h1 >= 0.0f) rectangle_part_add(cut, i + 2, next);
      here = next;
      h0 = h1;
    }
  }
  cut.count = cut.count < 3 ? 0 : cut.count;
  return cut;
}

// The part of the whole rectangle with dot(normal, point) >= 0.
LIMN_FN RectanglePart rectangle_above(Rectangle r, vec3 normal) {
  return rectangle_part_above(r, rectangle_whole(), normal);
}

// Share of the rectangle's area, in [0, 1].
LIMN_FN float rectangle_part_share(RectanglePart p) {
  float twice = 0.0f;
  for (int i = 2; i < rectangle_part_vertices; ++i) {
    if (i < p.most && i < p.count) {
      vec2 d0 = p.vertex[i - 1] - p.vertex[0];
      vec2 d1 = p.vertex[i] - p.vertex[0];
      twice += d0.x * d1.y - d0.y * d1.x;
    }
  }
  return 0.5f * twice;
}

// A point (a, b) of the part, uniform in area, for u in [0, 1)^2. The whole rectangle keeps u's
// stratification.
LIMN_FN vec2 rectangle_part_sample(RectanglePart p, vec2 u) {
  if (p.count == 4 && rectangle_part_share(p) == 1.0f) return u - vec2(0.5f);
  float wanted = u.x * rectangle_part_share(p);
  for (int i = 1; i + 1 < p.count; ++i) {
    vec2 d0 = p.vertex[i] - p.vertex[0];
    vec2 d1 = p.vertex[i + 1] - p.vertex[0];
    float share = 0.5f * (d0.x * d1.y - d0.y * d1.x);
    if (wanted < share || i + 2 == p.count) {
      float reach = sqrt(clamp(wanted / max(share, 1e-30f), 0.0f, 1.0f));
      return p.vertex[0] + reach * (d0 + u.y * (d1 - d0));
    }
    wanted -= share;
  }
  return p.vertex[0];
}

// The part of the light that a visibility V is about: above the receiver's geometric tangent plane (normal
// ng) and, as a whole, in front of the light (design: V is uniform in area over this part; count 0: V = 1,
// masked).
LIMN_FN RectanglePart rectangle_visible_part(Light light, vec3 receiver, vec3 ng) {
  if (rectangle_emits_towards(light, receiver)) return rectangle_above(rectangle_from(light, receiver), ng);
  RectanglePart none = rectangle_whole();
  none.count = 0;
  return none;
}

// A vertex while irradiance is summed, in units of the farthest vertex's distance r_0.
struct RectangleVertex {
  vec2 ab;
  vec3 point;
  float inverse_r;
  float excess;  // 1 / r - 1 / r_0, from r_0^2 - r^2 = (P_0 - P) . (P_0 + P)
};

// least: its distance is taken for no less.
LIMN_FN RectangleVertex rectangle_vertex(Rectangle r, vec2 ab, vec2 far, vec3 farthest, float least) {
  RectangleVertex x;
  x.ab = ab;
  x.point = rectangle_point(r, ab);
  float radius = max(length(x.point), least);
  vec2 d = far - ab;
  x.inverse_r = 1.0f / radius;
  x.excess = dot(d.x * r.u + d.y * r.v, x.point + farthest) / (radius * (1.0f + radius));
  return x;
}

// Sum over edges while irradiance is summed.
struct RectangleSum {
  RectangleVertex here;  // where the next edge starts
  vec3 edges;            // (w_i - w) P_i x e_i, see rectangle_vector_irradiance
};

// Adds the edge that ends in vertex i, if there is one.
LIMN_FN RectangleSum rectangle_sum_edge(RectangleSum sum, Rectangle r, RectanglePart p, int i, vec2 far,
                                        vec3 farthest, float least) {
  if (i < p.most && i < p.count) {
    RectangleVertex next = rectangle_vertex(r, p.vertex[i], far, farthest, least);
    vec2 d = next.ab - sum.here.ab;
    vec3 normal = cross(sum.here.point, d.x * r.u + d.y * r.v);
    float inverse_rr = sum.here.inverse_r * next.inverse_r;
    float bend = angle_over_sine_minus_one(length(normal) * inverse_rr, dot(sum.here.point, next.point) * inverse_rr);
    sum.edges += (bend * inverse_rr + sum.here.excess * next.inverse_r + next.excess) * normal;
    sum.here = next;
  }
  return sum;
}

// Vector irradiance of the part for radiance 1: dot(n, result) is the irradiance (W/m^2 per W/(sr m^2)) on a
// surface with normal n for which the part is above the horizon. Positive towards the light where cross(u, v)
// points away from the receiver, else negated.
//
// Lambert's sum 1/2 sum_i theta_i gamma_i over edges (P_i, P_i + e_i) is rewritten as 1/2 sum_i w_i P_i x e_i
// with w_i = (theta_i / sin theta_i) / (r_i r_i+1). For a small or distant light all w_i agree to first order
// and the sum cancels; subtracting the common w = 1/r_0^2 of the farthest vertex leaves that part as w * area
// * normal, in closed form, and the differences w_i - w >= 0 come from products of non-negative numbers.
LIMN_FN vec3 rectangle_vector_irradiance(Rectangle r, RectanglePart p) {
  float distance2 = 0.0f;
  vec2 far = vec2(0.0f);
  for (int i = 0; i < rectangle_part_vertices; ++i) {
    if (i < p.most && i < p.count) {
      vec3 point = rectangle_point(r, p.vertex[i]);
      float d2 = dot(point, point);
      far = d2 > distance2 ? p.vertex[i] : far;
      distance2 = max(d2, distance2);
    }
  }
  if (!(distance2 > 0.0f)) return vec3(0.0f);
  // From here on in units of the farthest vertex's distance r_0: r_0 = w = 1.
  float unit = 1.0f / sqrt(distance2);
  Rectangle scaled;
  scaled.centre = r.centre * unit;
  scaled.u = r.u * unit;
  scaled.v = r.v * unit;
  vec3 farthest = rectangle_point(scaled, far);
  // Where the receiver touches the rectangle both of its horizons pass through it, and so may a vertex, whose (a, b) are rounded:
  // nearer than that nothing is known of it, and the sines of its edges would exceed all bounds.
  float least = max(1e-7f * sqrt(max(dot(scaled.u, scaled.u), dot(scaled.v, scaled.v))), 1e-12f);
  RectangleSum sum;
  sum.here = rectangle_vertex(scaled, rectangle_part_last(p), far, farthest, least);
  sum.edges = vec3(0.0f);
  // Not a loop: the body is too large for compilers to unroll one, see above rectangle_part_last.
  sum = rectangle_sum_edge(sum, scaled, p, 0, far, farthest, least);
  sum = rectangle_sum_edge(sum, scaled, p, 1, far, farthest, least);
  sum = rectangle_sum_edge(sum, scaled, p, 2, far, farthest, least);
  sum = rectangle_sum_edge(sum, scaled, p, 3, far, farthest, least);
  sum = rectangle_sum_edge(sum, scaled, p, 4, far, farthest, least);
  sum = rectangle_sum_edge(sum, scaled, p, 5, far, farthest, least);
  sum = rectangle_sum_edge(sum, scaled, p, 6, far, farthest, least);
  return rectangle_part_share(p) * cross(scaled.u, scaled.v) + 0.5f * sum.edges;
}

// Irradiance (per unit radiance) on a surface with unit normal n from the whole rectangle, clipped by the
// horizon; the same from both of its faces. In [0, pi].
LIMN_FN float rectangle_irradiance(Rectangle r, vec3 n) {
  float irradiance = dot(rectangle_vector_irradiance(r, rectangle_above(r, n)), n);
  return clamp(abs(irradiance), 0.0f, pi);
}

// Solid angle (sr) of the part seen from the receiver (Van Oosterom and Strackee 1983, on a fan of triangles;
// the triple product is taken of vertex differences, so small angles keep their relative precision).
LIMN_FN float rectangle_solid_angle(Rectangle r, RectanglePart p) {
  if (p.count == 0) return 0.0f;
  vec3 p0 = rectangle_point(r, p.vertex[0]);
  float scale = dot(p0, p0) > 0.0f ? 1.0f / length(p0) : 1.0f;
  p0 *= scale;
  float volume = abs(dot(p0, cross(r.u * scale, r.v * scale)));
  if (volume == 0.0f) return 0.0f;  // in the rectangle's plane
  float total = 0.0f;
  for (int i = 1; i + 1 < p.count; ++i) {
    vec3 p1 = scale * rectangle_point(r, p.vertex[i]);
    vec3 p2 = scale * rectangle_point(r, p.vertex[i + 1]);
    vec2 d1 = p.vertex[i] - p.vertex[0];
    vec2 d2 = p.vertex[i + 1] - p.vertex[0];
    float r0 = length(p0);
    float r1 = length(p1);
    float r2 = length(p2);
    float denominator = r0 * r1 * r2 + dot(p0, p1) * r2 + dot(p1, p2) * r0 + dot(p2, p0) * r1;
    total += 2.0f * atan(volume * abs(d1.x * d2.y - d1.y * d2.x), denominator);
  }
  return min(total, 2.0f * pi);
}

LIMN_END
#endif  // LIMN_RECTANGLE_LIGHT_GLSL
