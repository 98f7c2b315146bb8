// Paraboloid maps (Brabec, Annen, Seidel 2002, Shadow Mapping for Hemispherical and Omnidirectional Light Sources): the
// hemisphere around an axis on a disc of radius 1, by (x, y) / (1 + z). That is the stereographic projection: circles on
// the sphere stay circles, great circles have the radius 1 / |z of their plane's normal|, and the local scale is the
// same in all directions. Directions are unit vectors in the view's axes, z along the axis.
//
// Kernels are fractions of the map's side, which is the disc's diameter.
#ifndef LIMN_PARABOLOID_GLSL
#define LIMN_PARABOLOID_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/numeric/stereographic.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

// The view of a map from `origin` around the unit vector `axis`. What lies nearer than near or farther than far, m, is not
// in it. layer: of the array it is drawn to.
LIMN_FN ShadowView paraboloid_view(vec3 origin, vec3 axis, float near, float far, uint layer, uint texels) {
  Frame around = frame_around(axis);
  ShadowView view;
  view.origin = origin;
  view.near = near;
  view.axis_x = around.t;
  view.scale = 0.5f;
  view.axis_y = -around.b;
  view.footprint = 4.0f / float(texels);
  view.axis_z = around.n;
  view.far = far;
  view.middle = vec2(0.5f, 0.5f);
  view.projection = shadow_paraboloid;
  view.layer = layer;
  view.size = texels;
  view.light = no_light;
  return view;
}

// --- Triangles ---

// How far, and to which side, the arc of a great circle leaves the chord between two points of the disc. normal: of the
// circle's plane, unit.
LIMN_FN vec2 paraboloid_bulge(vec2 p, vec2 q, vec3 normal) {
  vec2 chord = q - p;
  float quarter = 0.25f * dot(chord, chord);
  float slant = min(abs(normal.z), 1.0f);
  float height = quarter * slant / (1.0f + sqrt(max(1.0f - quarter * slant * slant, 0.0f)));
  vec2 across = vec2(-chord.y, chord.x) * (height / max(2.0f * sqrt(quarter), 1e-30f));
  // Away from the arc's centre (normal.x, normal.y) / normal.z.
  vec2 from_centre = 0.5f * (p + q) * normal.z - vec2(normal.x, normal.y);
  return dot(across, from_centre) * normal.z < 0.0f ? -across : across;
}

LIMN_FN vec3 paraboloid_towards(vec3 p) { return p / max(length(p), 1e-30f); }

// Extends a box (low, high) by the projection of the edge a-b.
LIMN_FN void paraboloid_include(LIMN_INOUT(vec4) box, vec3 a, vec3 b) {
  vec3 u = paraboloid_towards(a);
  vec3 v = paraboloid_towards(b);
  vec2 p = paraboloid_map(u);
  vec2 q = paraboloid_map(v);
  vec2 bulge = paraboloid_bulge(p, q, paraboloid_towards(cross(u, v)));
  vec2 low = min(p, q) + min(bulge, vec2(0.0f));
  vec2 high = max(p, q) + max(bulge, vec2(0.0f));
  box = vec4(min(box.x, low.x), min(box.y, low.y), max(box.z, high.x), max(box.w, high.y));
}

// Where the segment a-b meets the plane z = 0, which lies between its ends.
LIMN_FN vec3 paraboloid_rim(vec3 a, vec3 b) {
  float t = a.z / (a.z - b.z);
  return vec3(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0.0f);
}

LIMN_CONST vec4 paraboloid_nowhere = vec4(4.0f, 4.0f, -4.0f, -4.0f);

// The same for the part of the edge that lies in the hemisphere; `rim` takes the point where the edge leaves it.
LIMN_FN void paraboloid_include_part(LIMN_INOUT(vec4) box, vec3 a, vec3 b, LIMN_INOUT(vec3) rim) {
  bool front_a = a.z >= 0.0f;
  bool front_b = b.z >= 0.0f;
  if (!front_a && !front_b) return;
  vec3 from = a;
  vec3 to = b;
  if (front_a != front_b) {
    rim = paraboloid_rim(a, b);
    if (front_a) to = rim;
    if (front_b) from = rim;
  }
  paraboloid_include(box, from, to);
}

// Bounds (low, high) on the map of what the hemisphere sees of a triangle, corners relative to the view's origin in its
// axes; low > high where it sees nothing. Exact edges are arcs: a box around them, not the triangle of the projected
// corners.
LIMN_FN vec4 paraboloid_bounds(vec3 a, vec3 b, vec3 c) {
  vec4 box = paraboloid_nowhere;
  vec3 ab = vec3(0.0f);
  vec3 bc = vec3(0.0f);
  vec3 ca = vec3(0.0f);
  paraboloid_include_part(box, a, b, ab);
  paraboloid_include_part(box, b, c, bc);
  paraboloid_include_part(box, c, a, ca);
  // Two edges at most leave the hemisphere. What was cut off leaves an arc of the rim between them.
  bool cut_ab = (a.z >= 0.0f) != (b.z >= 0.0f);
  bool cut_bc = (b.z >= 0.0f) != (c.z >= 0.0f);
  bool cut_ca = (c.z >= 0.0f) != (a.z >= 0.0f);
  if (cut_ab && cut_bc) paraboloid_include(box, ab, bc);
  if (cut_bc && cut_ca) paraboloid_include(box, bc, ca);
  if (cut_ca && cut_ab) paraboloid_include(box, ca, ab);
  return box;
}

// Where the ray from the origin along `direction` meets the triangle: its distance in units of the direction, and the
// shares of the corners there. Negative distance: nowhere. Adjacent triangles leave no gap where this is compiled without
// contraction: an edge answers with the same magnitude from both sides, and its points belong to both.
LIMN_FN float paraboloid_hit(vec3 a, vec3 b, vec3 c, vec3 direction, LIMN_OUT(vec3) shares) {
  LIMN_PRECISE vec3 ab = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  LIMN_PRECISE vec3 bc = vec3(b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x);
  LIMN_PRECISE vec3 ca = vec3(c.y * a.z - c.z * a.y, c.z * a.x - c.x * a.z, c.x * a.y - c.y * a.x);
  LIMN_PRECISE float u = bc.x * direction.x + bc.y * direction.y + bc.z * direction.z;
  LIMN_PRECISE float v = ca.x * direction.x + ca.y * direction.y + ca.z * direction.z;
  LIMN_PRECISE float w = ab.x * direction.x + ab.y * direction.y + ab.z * direction.z;
  vec3 n = cross(b - a, c - a);
  float facing = dot(n, direction);
  float t = dot(n, a) / facing;
  bool inside = (u >= 0.0f && v >= 0.0f && w >= 0.0f) || (u <= 0.0f && v <= 0.0f && w <= 0.0f);
  shares = vec3(u, v, w) / (u + v + w);
  return inside && t > 0.0f ? t : -1.0f;
}

// --- Kernels (thesis, section 6.3.2) ---

// Angle that the penumbra of a sender `size` metres wide spans seen from its centre, radians: blockers at radial distance
// z, receiver at d. The receiver's slope cancels: p cos(beta) = size (d - z) / z and alpha = 2 atan(p cos(beta) / (2 d)).
LIMN_FN float paraboloid_penumbra_angle(float size, float d, float z) {
  return 2.0f * atan(size * max(d - z, 0.0f) / max(2.0f * d * z, 1e-30f));
}

// A disc on the map.
struct ParaboloidKernel {
  vec2 centre;  // on the disc of radius 1
  float width;  // of the map's side
};

// The circle to which the cone around `direction` with the opening angle alpha projects, exactly. direction.z >= 0,
// alpha < pi.
LIMN_FN ParaboloidKernel paraboloid_kernel(vec3 direction, float alpha) {
  float a = 0.5f * alpha;
  float divisor = direction.z + cos(a);
  ParaboloidKernel k;
  k.centre = vec2(direction.x, direction.y) / divisor;
  k.width = sin(a) / divisor;
  return k;
}

// The box on the map with the first two moments of the penumbra of a rectangular sender in the plane of the view's axes:
// receiver in `direction` at radial distance d, blockers at z, m. xy: centre on the disc of radius 1; zw: widths, of the
// map's side. The sender is foreshortened towards the receiver: by cos(theta) along the meridian.
LIMN_FN vec4 paraboloid_rectangle_kernel(vec3 direction, vec2 sides, float d, float z) {
  vec3 w = direction;
  float k = max(d - z, 0.0f) / max(d * max(z, 1e-12f * d), 1e-30f);
  vec2 p = paraboloid_map(w);
  // What the map's differential makes of the sides; over the scale: radians.
  vec2 side_x = sides.x * (vec2(1.0f - w.x * w.x, -w.x * w.y) + w.x * w.z * p);
  vec2 side_y = sides.y * (vec2(-w.y * w.x, 1.0f - w.y * w.y) + w.y * w.z * p);
  // Tangents of half the angles, and their cosines.
  vec2 t = 0.5f * k * vec2(sqrt(side_x.x * side_x.x + side_y.x * side_y.x), sqrt(side_x.y * side_x.y + side_y.y * side_y.y));
  t = min(t, vec2(1e15f));
  vec2 c = vec2(1.0f / sqrt(1.0f + t.x * t.x), 1.0f / sqrt(1.0f + t.y * t.y));
  // The mean of the penumbra is not the sender's middle on the map: what lies to either side of the meridian is projected
  // farther in, and what lies towards the receiver spans more. Both follow from the sender's second moments.
  float inward = 1.0f / (w.z + sqrt(1.0f + (t.x * t.x + t.y * t.y) / 3.0f));
  float part = inward * k;
  vec2 outward = part * (1.0f / d + part * w.z) / 12.0f * (sides.x * w.x * side_x + sides.y * w.y * side_y);
  float inverse = 1.0f / (w.z + min(c.x, c.y));
  return vec4(inward * w.x + outward.x, inward * w.y + outward.y, inverse * (t.x * c.x), inverse * (t.y * c.y));
}

// The same as published: the sender always seen head-on, angles as if spread evenly over the map. Narrow ones are 27 % too
// wide on the axis, right at 55 degrees and 36 % too narrow at the rim.
LIMN_FN vec4 paraboloid_rectangle_kernel_thesis(vec3 direction, vec2 sides, float d, float z) {
  vec2 p = paraboloid_map(direction);
  return vec4(p.x, p.y, inverse_pi * paraboloid_penumbra_angle(sides.x, d, z),
              inverse_pi * paraboloid_penumbra_angle(sides.y, d, z));
}

LIMN_END
#endif  // LIMN_PARABOLOID_GLSL
