// Airlight: light of one source that is scattered once on its way to the eye, along a stretch of the viewing ray that the
// source lights.
//
// With t = s0 + h tan(angle) (s0, h: closest approach of ray and source) dt / r^2 = d(angle) / h: what is left to integrate
// is smooth (Kulla and Fajardo 2012, equiangular sampling; Sun et al. 2005 tabulate the same integral). Callers divide the
// ray evenly in the angle; each stretch is integrated by the Gauss-Legendre rule with two nodes.
//
// Where a point stands for a part of an area light, the inverse square would grow without bound near it. On the axis of a
// disc of radius R and radiance L the light that passes a place at distance d, whatever its direction, is
// 2 pi L (1 - d / sqrt(d^2 + R^2)) (solid angle of the disc). pi R^2 L / (d^2 + R^2 / 2) is the same far away and on the
// disc and at most (1 + sqrt(2)) / 2 = 1.21 times as much between (at 0.46 R), and keeps the integral what it is with
// h^2 + R^2 / 2 in place of h^2.
#ifndef LIMN_AIRLIGHT_GLSL
#define LIMN_AIRLIGHT_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/light/light_intensity.glsl"
#include "glsl/scene/media.glsl"
LIMN_BEGIN

// Node of the Gauss-Legendre rule with two points on [-1, 1], whose weights are 1.
LIMN_CONST float gauss_node = 0.57735026918963f;

// A source has this size, in radii of the medium's ball: nearer to it the radiance grows no further.
LIMN_CONST float airlight_least_distance = 1e-4f;

// One light, or a point on it, as a viewing ray sees it.
struct AirlightRay {
  vec3 eye;
  vec3 direction;  // unit
  vec3 source;     // position; directional lights: unused
  float nearest;   // s0: where the ray passes the source, m
  float distance;  // h: how far from it, m; of parts of area lights sqrt(h^2 + R^2 / 2)
  bool parallel;   // directional light: no inverse square
};

// Of a light, what one of `samples` points on it stands for, m^2; 0: a point.
LIMN_FN float airlight_part(Light light, int samples) {
  return light.type == light_rectangle ? light.length_u * light.length_v / float(samples) : 0.0f;
}

// part: airlight_part; 0 where points are chosen at random and averaged.
LIMN_FN AirlightRay airlight_ray(Medium m, Light light, vec3 source, float part, vec3 eye, vec3 direction) {
  AirlightRay r;
  r.eye = eye;
  r.direction = direction;
  r.source = source;
  r.parallel = light.type == light_directional;
  r.nearest = dot(source - eye, direction);
  vec3 across = source - eye - r.nearest * direction;
  r.distance = max(sqrt(dot(across, across) + part / (2.0f * pi)), airlight_least_distance * m.ball.radius);
  return r;
}

// The variable that a stretch is divided evenly in, and back to metres along the ray.
LIMN_FN float airlight_variable(AirlightRay r, float t) {
  return r.parallel ? t : atan((t - r.nearest) / r.distance);
}
LIMN_FN float airlight_metres(AirlightRay r, float variable) {
  return r.parallel ? variable : r.nearest + r.distance * tan(variable);
}

// Where the ray is in the light's cone: t in [x, y]; x > y where it misses. All of it where there is no cone. A cone is
// convex (of up to 90 degrees from its axis), so there is one piece. With w the ray's and d the cone's direction, c the cosine
// of its angle and p from the apex to a place, (d . p)^2 = c^2 p^2 on the cone and on its mirror image behind the apex.
LIMN_FN vec2 light_cone_range(Light light, vec3 eye, vec3 w) {
  const float far = 3.0e38f;
  if ((light.flags & light_flag_cone) == 0u) return vec2(-far, far);
  float c2 = light.cos_outer * light.cos_outer;
  vec3 d = light.direction;
  vec3 apex = light.position;
  float middle = dot(apex - eye, w);  // the quadratic's variable counts from where the ray passes the apex
  vec3 o = eye + middle * w - apex;
  float dw = dot(d, w);
  float d_o = dot(d, o);
  float a = dw * dw - c2;
  float b = dw * d_o;
  float c = d_o * d_o - c2 * dot(o, o);
  float discriminant = b * b - a * c;
  if (discriminant < 0.0f && a < 0.0f) return vec2(1.0f, -1.0f);
  if (abs(a) < 1e-20f) a = 1e-20f;  // beside the cone's side: one of the roots is as good as infinite
  float root = sqrt(max(discriminant, 0.0f));  // never below 0 where a > 0, but for rounding
  float q = b < 0.0f ? root - b : -root - b;
  float first = q / a;
  float second = q == 0.0f ? first : c / q;
  float low = min(first, second);
  float high = max(first, second);
  if (a > 0.0f) return dw > 0.0f ? vec2(middle + high, far) : vec2(-far, middle + low);
  return d_o + 0.5f * (low + high) * dw > 0.0f ? vec2(middle + low, middle + high) : vec2(1.0f, -1.0f);
}

// Where the ray is within the light's range: t in [x, y]; x > y where it misses. All of it where the range is unlimited.
LIMN_FN vec2 light_ball_range(Light light, vec3 eye, vec3 w) {
  const float far = 3.0e38f;
  if (light.type == light_directional || !(light.range > 0.0f)) return vec2(-far, far);
  Ball ball;
  ball.centre = light.position;
  ball.radius = light.range;
  return ball_range(ball, eye, w);
}

// A place on the ray, and the light that comes there.
struct AirlightPoint {
  vec3 place;
  vec3 from;      // unit, of the light's propagation
  vec3 sent;      // W/sr; directional: W/m^2
  float measure;  // of the variable, per metre of ray and inverse square; directional: 1
};

LIMN_FN AirlightPoint airlight_point(Light light, AirlightRay r, float t, int samples) {
  AirlightPoint p;
  p.place = r.eye + t * r.direction;
  p.from = light.direction;
  p.sent = light_point_intensity(light, r.source, p.place, samples) * light_fluence(light);
  p.measure = 1.0f;
  if (r.parallel) return p;
  vec3 offset = p.place - r.source;
  p.from = offset / max(length(offset), 1e-30f);
  p.measure = 1.0f / r.distance;
  return p;
}

// Radiance per unit of the variable that is scattered there towards the eye and arrives; length_inside: of the medium
// between light, place and eye. Times the density at the place where it is not 1.
LIMN_FN vec3 airlight_scattered(Medium m, AirlightRay r, AirlightPoint p, float length_inside) {
  return m.scattering * p.sent * medium_transmittance(m, length_inside) *
         (phase_function(m.g, p.from, -r.direction) * p.measure);
}

// The same in a homogeneous medium, at t metres.
LIMN_FN vec3 airlight_density(Medium m, Light light, AirlightRay r, float t, int samples) {
  AirlightPoint p = airlight_point(light, r, t, samples);
  float to_light = r.parallel ? ball_length(m.ball, p.place, -p.from, 3.0e38f)
                              : ball_length_between(m.ball, r.source, p.place);
  float to_eye = ball_length(m.ball, r.eye, r.direction, t);
  return airlight_scattered(m, r, p, to_light + to_eye);
}

// Over one stretch, given in the variable.
LIMN_FN vec3 airlight_stretch(Medium m, Light light, AirlightRay r, float a, float b, int samples) {
  float middle = 0.5f * (a + b);
  float step = 0.5f * (b - a) * gauss_node;
  return (0.5f * (b - a)) * (airlight_density(m, light, r, airlight_metres(r, middle - step), samples) +
                             airlight_density(m, light, r, airlight_metres(r, middle + step), samples));
}

LIMN_END
#endif  // LIMN_AIRLIGHT_GLSL
