// A light as one receiver sees it: which part of it counts, points on that part, and the axis that depths are measured
// along. For shadow techniques; the reference draws its samples from the same definitions.
#ifndef LIMN_LIGHT_VIEW_GLSL
#define LIMN_LIGHT_VIEW_GLSL
#include "glsl/geometry.glsl"
#include "glsl/language.glsl"
#include "glsl/light.glsl"
#include "glsl/rectangle_light.glsl"
LIMN_BEGIN

struct LightView {
  bool masked;          // no part of the light lies above the tangent plane and in front of the light: V = 1
  bool cone;            // directional: points are unit directions
  bool extended;        // false: a single point or direction
  vec3 centre;          // world position of the centre; directional: the world's origin
  vec3 axis;            // unit, from the light towards the receiver's side; directional: the direction of propagation
  float depth;          // of the receiver from the centre along the axis, metres
  Rectangle rectangle;  // relative to the receiver
  RectanglePart part;
  bool whole;           // the part is all of the rectangle
  Frame frame;          // directional: n points to the light
  float cap;            // directional: 1 - cos(half the angular diameter)
};

// ng: the receiver's geometric normal. size < 0: the light as the scene has it; else the side of every rectangle, of a
// square that stands for a point or spot light and faces the receiver (metres), and the angular diameter of a
// directional light (radians).
LIMN_FN LightView light_view(Light light, vec3 receiver, vec3 ng, float size) {
  LightView v;
  v.cone = light.info.x == light_directional;
  v.centre = vec3(light.position);
  v.axis = vec3(light.direction);
  v.part = rectangle_whole();
  v.whole = true;
  v.frame = frame_around(-v.axis);
  v.cap = 0.0f;
  if (v.cone) {
    float half_angle = min(0.5f * (size < 0.0f ? light.cone.w : size), 1.55f);
    float sine_half = sin(0.5f * half_angle);
    v.cap = 2.0f * sine_half * sine_half;
    v.extended = half_angle > 0.0f;
    v.masked = !(dot(v.frame.n, ng) > -sin(half_angle));
    v.centre = vec3(0.0f);
    v.rectangle = rectangle_from(light, receiver);
    v.depth = dot(v.axis, receiver);
    return v;
  }
  Light sized = light;
  if (size >= 0.0f) {
    sized.axis_u.w = size;
    sized.axis_v.w = size;
  }
  if (light.info.x != light_rectangle) {
    vec3 offset = receiver - v.centre;
    float distance = length(offset);
    v.axis = distance > 0.0f ? offset / distance : v.axis;
    Frame facing = frame_around(-v.axis);
    sized.axis_u = vec4(facing.t, max(size, 0.0f));
    sized.axis_v = vec4(facing.b, max(size, 0.0f));
    v.rectangle = rectangle_from(sized, receiver);
    v.part = rectangle_above(v.rectangle, ng);
    // A point on the tangent plane lights nothing; a square of size 0 is that point.
    if (!(size > 0.0f) && !(dot(ng, offset) < 0.0f)) v.part.count = 0;
  } else {
    v.rectangle = rectangle_from(sized, receiver);
    v.part = rectangle_visible_part(sized, receiver, ng);
    v.axis = v.axis * rectangle_side(light, receiver);
  }
  v.whole = v.part.count == 4 && rectangle_part_share(v.part) == 1.0f;
  v.extended = max(sized.axis_u.w, sized.axis_v.w) > 0.0f;
  v.masked = v.part.count == 0;
  v.depth = dot(v.axis, receiver - v.centre);
  return v;
}

// A point of the part, uniform in area (directional: in solid angle), for u in [0, 1)^2, as the change of position per
// metre of depth towards the light: receiver + slope (depth - z) is where the ray to that point crosses the plane at
// depth z.
LIMN_FN vec3 light_view_slope(LightView v, vec2 u) {
  if (v.cone) {
    vec2 disc = sample_disc(u);
    float cap = min(dot(disc, disc), 1.0f) * v.cap;
    float lateral = sqrt(v.cap * (2.0f - cap));
    vec3 direction = from_local(v.frame, vec3(lateral * disc.x, lateral * disc.y, 1.0f - cap));
    return direction / (1.0f - cap);
  }
  vec2 ab = v.whole ? u - vec2(0.5f) : rectangle_part_sample(v.part, u);
  return rectangle_point(v.rectangle, ab) / v.depth;
}

// The same for a point of the whole light, above the tangent plane or below it.
LIMN_FN vec3 light_view_whole_slope(LightView v, vec2 u) {
  if (v.cone) return light_view_slope(v, u);
  return rectangle_point(v.rectangle, u - vec2(0.5f)) / v.depth;
}

// Whether the ray with this slope meets the light (rectangle: all of it, not only the part), give or take `tolerance`
// metres per metre of depth.
LIMN_FN bool light_view_contains(LightView v, vec3 slope, float tolerance) {
  if (v.cone) {
    float cosine = 1.0f - v.cap;
    vec3 lateral = slope - v.frame.n * dot(slope, v.frame.n);
    return length(lateral) <= sqrt(v.cap * (2.0f - v.cap)) / cosine + tolerance;
  }
  vec3 offset = slope * v.depth - v.rectangle.centre;
  float u = dot(v.rectangle.u, v.rectangle.u);
  float w = dot(v.rectangle.v, v.rectangle.v);
  float reach = tolerance * v.depth;
  return abs(dot(offset, v.rectangle.u)) <= 0.5f * u + reach * sqrt(u) &&
         abs(dot(offset, v.rectangle.v)) <= 0.5f * w + reach * sqrt(w);
}

LIMN_END
#endif  // LIMN_LIGHT_VIEW_GLSL
