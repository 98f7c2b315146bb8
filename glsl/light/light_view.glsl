// A light as one receiver sees it: which part of it counts, points on that part, and the axis that depths are measured
// along. For shadow techniques; the reference answers by the same definitions.
//
// A point of the light is given by its slope: the change of position per metre of depth towards the light. With the
// receiver x at depth d, x + slope (d - z) is where the ray to that point crosses the plane at depth z.
#ifndef LIMN_LIGHT_VIEW_GLSL
#define LIMN_LIGHT_VIEW_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/scene/light.glsl"
#include "glsl/light/rectangle_light.glsl"
LIMN_BEGIN

struct LightView {
  bool masked;    // no part of the light lies above the tangent plane, or it does not shine here: V = 1
  bool cone;      // directional light that is a disc: samples are directions
  bool extended;  // false: a single point or direction
  bool whole;     // all of the light lies above the tangent plane
  vec3 normal;    // of that plane
  vec3 axis;      // unit, from the light towards the receiver's side; directional: the direction of propagation;
                  // distant rectangle: across its plane
  float depth;    // of the receiver along the axis, from the light (disc: from the world's origin; distant rectangle:
                  // beyond all), metres
  vec3 centre;    // slope of the light's centre
  vec3 side_u;    // and of its sides
  vec3 side_v;
  float cap;      // directional: 1 - cos(half the angular diameter)
  vec2 low;       // box around the part above the tangent plane, in [-1/2, 1/2]^2 along the sides
  vec2 high;
};

// Bounds the part of the square [-1/2, 1/2]^2 where height + dot(slope, p) >= 0. At least half of the box belongs to it.
LIMN_FN void light_view_clip(LIMN_INOUT(LightView) v, float height, vec2 slope) {
  vec2 reach = 0.5f * abs(slope);
  v.whole = height >= reach.x + reach.y;
  v.masked = v.masked || height <= -reach.x - reach.y;
  vec2 limit = vec2(-(height + reach.y), -(height + reach.x));
  if (slope.x > 0.0f) v.low.x = clamp(limit.x / slope.x, -0.5f, 0.5f);
  if (slope.x < 0.0f) v.high.x = clamp(limit.x / slope.x, -0.5f, 0.5f);
  if (slope.y > 0.0f) v.low.y = clamp(limit.y / slope.y, -0.5f, 0.5f);
  if (slope.y < 0.0f) v.high.y = clamp(limit.y / slope.y, -0.5f, 0.5f);
}

// ng: the receiver's geometric normal. size < 0: the light as the scene has it; else the side of every rectangle, of a
// square that stands for a point or spot light and faces the receiver (metres), and the angular diameter of a
// directional light (radians; a distant rectangle becomes a square that spans this angle seen head-on).
// kind: the light's, a constant where a program is compiled for lights of one kind.
LIMN_FN LightView light_view_of_kind(Light light, uint kind, vec3 receiver, vec3 ng, float size) {
  LightView v;
  bool distant = kind == light_kind_distant_rectangle;
  v.cone = kind == light_kind_disc;
  v.masked = false;
  v.normal = ng;
  v.low = vec2(-0.5f);
  v.high = vec2(0.5f);
  v.axis = light.direction;
  v.cap = 0.0f;
  vec3 to_centre = light.position;
  if (!distant) to_centre = to_centre - receiver;
  float side = distant ? 2.0f * tan(min(0.5f * size, 1.5f)) : size;
  vec3 u = light.axis_u * (size < 0.0f ? light.length_u : side);
  vec3 w = light.axis_v * (size < 0.0f ? light.length_v : side);
  if (kind == light_kind_rectangle) {
    v.axis = v.axis * rectangle_side(light, receiver);
    v.masked = !rectangle_emits_towards(light, receiver);
  } else if (distant) {
    v.axis = cross(light.axis_v, light.axis_u);
  } else {
    v.masked = !(receiver_factor(light, receiver) > 0.0f);
    float distance = length(to_centre);
    if (!v.cone && distance > 0.0f) v.axis = -to_centre / distance;
    Frame facing = frame_around(-v.axis);
    u = facing.t * max(size, 0.0f);
    w = facing.b * max(size, 0.0f);
  }
  v.extended = dot(u, u) + dot(w, w) > 0.0f;
  v.depth = -dot(v.axis, to_centre);
  v.centre = to_centre / v.depth;
  v.side_u = u / v.depth;
  v.side_v = w / v.depth;
  if (v.cone) {
    float half_angle = min(0.5f * (size < 0.0f ? light.angular_diameter : size), 1.55f);
    float sine_half = sin(0.5f * half_angle);
    Frame facing = frame_around(-v.axis);
    v.cap = 2.0f * sine_half * sine_half;
    v.extended = half_angle > 0.0f;
    v.depth = dot(v.axis, receiver);
    v.centre = -v.axis;
    v.side_u = facing.t;  // scaled by light_view_cone_scale
    v.side_v = facing.b;
    float height = dot(ng, v.centre);
    v.masked = v.masked || !(height > -sin(half_angle));
    v.whole = height >= sin(half_angle);
    return v;
  }
  light_view_clip(v, dot(ng, to_centre), vec2(dot(ng, u), dot(ng, w)));
  // What lies in the tangent plane lights nothing.
  if (!v.extended) v.masked = v.masked || !(dot(ng, to_centre) > 0.0f);
  if (distant) v.depth = 3.0e38f;
  return v;
}

LIMN_FN LightView light_view(Light light, vec3 receiver, vec3 ng, float size) {
  return light_view_of_kind(light, light_kind(light), receiver, ng, size);
}

// Maps the disc of diameter 1 to slopes, uniformly in solid angle: factor of the sides at squared radius r2 (of a disc
// of radius 1).
LIMN_FN float light_view_cone_scale(LightView v, float r2) {
  float cap = r2 * v.cap;
  return 2.0f * sqrt(v.cap * (2.0f - cap)) / (1.0f - cap);
}

// A point of the part of the light that counts, for u in [0, 1)^2; uniform in area (directional: in solid angle) among
// the u for which the result is true. Of a rectangle at least half of them are, of a disc pi / 4 of the share above the tangent
// plane, which may be as good as none.
LIMN_FN bool light_view_sample(LightView v, vec2 u, LIMN_OUT(vec3) slope) {
  vec2 p = v.low + u * (v.high - v.low);
  float r2 = 4.0f * dot(p, p);
  float scale = v.cone ? light_view_cone_scale(v, min(r2, 1.0f)) : 1.0f;
  slope = v.centre + scale * (p.x * v.side_u + p.y * v.side_v);
  return (!v.cone || r2 <= 1.0f) && dot(slope, v.normal) > 0.0f;
}

// A point of the whole light, above the tangent plane or below it, for every u.
LIMN_FN vec3 light_view_point(LightView v, vec2 u) {
  vec2 p = u - vec2(0.5f);
  if (v.cone) {
    vec2 disc = sample_disc(u);
    p = 0.5f * light_view_cone_scale(v, min(dot(disc, disc), 1.0f)) * disc;
  }
  return v.centre + p.x * v.side_u + p.y * v.side_v;
}

// The point of the light that lies highest above the tangent plane.
LIMN_FN vec3 light_view_highest(LightView v) {
  vec3 along_u = dot(v.side_u, v.normal) < 0.0f ? -v.side_u : v.side_u;
  vec3 along_v = dot(v.side_v, v.normal) < 0.0f ? -v.side_v : v.side_v;
  if (!v.cone) return v.centre + 0.5f * (along_u + along_v);
  vec3 rise = v.normal - dot(v.normal, v.centre) * v.centre;
  return v.centre + (0.5f * light_view_cone_scale(v, 1.0f) / max(length(rise), 1e-20f)) * rise;
}

// The point that stands for a light of which no sample lies above the tangent plane: the centre, or, where that is below the plane,
// the highest. Above the plane unless the light is masked.
LIMN_FN vec3 light_view_single_point(LightView v) {
  return dot(v.centre, v.normal) > 0.0f ? v.centre : light_view_highest(v);
}

// Whether the ray with this slope meets the light, give or take `tolerance` metres per metre of depth.
LIMN_FN bool light_view_contains(LightView v, vec3 slope, float tolerance) {
  vec3 offset = slope - v.centre;
  float along_u = abs(dot(offset, v.side_u));
  float along_v = abs(dot(offset, v.side_v));
  if (v.cone) {
    float reach = 0.5f * light_view_cone_scale(v, 1.0f) + tolerance;
    return along_u * along_u + along_v * along_v <= reach * reach;
  }
  float uu = dot(v.side_u, v.side_u);
  float vv = dot(v.side_v, v.side_v);
  return along_u <= 0.5f * uu + tolerance * sqrt(uu) && along_v <= 0.5f * vv + tolerance * sqrt(vv);
}

LIMN_END
#endif  // LIMN_LIGHT_VIEW_GLSL
