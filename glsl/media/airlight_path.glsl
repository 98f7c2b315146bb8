// The airlight of one light, or of a point on it, along one viewing ray, with all worked out once that is the same at each of
// its points: the same as glsl/media/airlight.glsl, point by point, gives. Places on the ray are given by q, metres from where
// it passes the source (parallel light: from the eye).
//
// A stretch of the ray that is one of many of equal size in the angle (parallel light: length) is integrated by the rule with
// two nodes over that variable, as airlight_stretch() does, but without a tangent for each node: with e = (cos, h sin) of the
// angles at its ends, a place on it is the quotient of the components of their mean, and the weights that give the nodes are
// the same for all stretches.
#ifndef LIMN_AIRLIGHT_PATH_GLSL
#define LIMN_AIRLIGHT_PATH_GLSL
#include "glsl/media/airlight.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_FN bool airlight_parallel(uint kind) { return kind == light_kind_disc || kind == light_kind_distant_rectangle; }

struct AirlightPath {
  vec3 base;       // the place with q = 0
  float nearest;   // its distance from the eye, m
  vec3 direction;  // unit
  float distance;  // h, as AirlightRay's
  vec3 sent;       // radiance per unit of the variable where airlight_path_factor() is 1 and nothing is lost on the way
  float g;
  float across2;       // square of the source's distance from the ray, m^2
  vec2 axial;          // metres along the light's direction from the source: .x + .y q
  float centre_axial;  // from the light's centre: this instead of .x
  vec2 centre;         // square of the distance from the centre: .x + q (.y + q)
  vec2 ramp;           // the root of the cone's factor before it is clamped: .x cosine + .y
  float window;        // 1 / range^2 of the light; 0: unlimited
  float two_sided;     // 1, or 0
  vec3 from_eye;       // from the middle of the medium's ball to the eye
  vec3 across;         // from the source to the base; parallel light: its direction instead
  float radius2;       // of the ball, m^2
  float before;        // metres of ball between the eye and the base, less than 0 where it begins behind the base
};

// kind: the light's, a constant where a program is compiled for lights of one kind.
LIMN_FN AirlightPath airlight_path(Medium m, Light light, uint kind, AirlightRay ray, int samples) {
  bool parallel = airlight_parallel(kind);
  AirlightPath p;
  p.direction = ray.direction;
  p.nearest = parallel ? 0.0f : ray.nearest;
  p.distance = parallel ? 1.0f : ray.distance;
  p.base = ray.eye + p.nearest * ray.direction;
  vec3 across = p.base - ray.source;
  p.across2 = dot(across, across);
  p.g = m.g;
  float share = light_has_extent(light) ? 1.0f / float(samples) : 1.0f;
  if (kind == light_kind_rectangle) share *= light.length_u * light.length_v;
  if (kind == light_kind_disc) share *= light_fluence(light);
  // The phase function of parallel light is the same all along the ray; of other light, airlight_path_factor() has the rest.
  float phase = (1.0f - m.g * m.g) * 0.25f * inverse_pi;
  if (parallel) phase = phase_function(m.g, light.direction, -ray.direction);
  p.sent = (phase * share / p.distance) * (m.scattering * light.emission);
  float rate = dot(light.direction, ray.direction);
  p.axial = vec2(dot(light.direction, across), rate);
  vec3 from_centre = p.base - light.position;
  p.centre = vec2(dot(from_centre, from_centre), 2.0f * dot(from_centre, ray.direction));
  p.centre_axial = dot(light.direction, from_centre);
  p.two_sided = (light.flags & light_flag_two_sided) != 0u ? 1.0f : 0.0f;
  float slope = 1.0f / spot_ramp(light);
  p.ramp = (light.flags & light_flag_cone) != 0u ? vec2(slope, -slope * light.cos_outer) : vec2(0.0f, 1.0f);
  float inverse = light.range > 0.0f ? 1.0f / light.range : 0.0f;
  p.window = inverse * inverse;
  p.from_eye = ray.eye - m.ball.centre;
  p.across = parallel ? light.direction : across;
  p.radius2 = m.ball.radius * m.ball.radius;
  p.before = p.nearest - max(ball_range(m.ball, ray.eye, ray.direction).x, 0.0f);
  return p;
}

LIMN_FN vec3 airlight_path_place(AirlightPath p, float q) { return p.base + q * p.direction; }

// What p.sent is multiplied by at q, besides the transmittance: cone, range, cosine of a rectangle, and what of the phase
// function changes along the ray.
LIMN_FN float airlight_path_factor(AirlightPath p, uint kind, float q) {
  if (airlight_parallel(kind)) return 1.0f;
  float square = p.across2 + q * q;
  float inverse = inversesqrt(max(square, 1e-30f));
  // phase_function() takes the square of the difference between two directions, which is 2 (1 + cosine); where these are nearly
  // opposite, by the sine.
  float cosine = p.g >= 0.0f ? q * inverse : -q * inverse;
  float away = cosine >= 0.0f ? 2.0f + 2.0f * cosine : 2.0f * p.across2 * inverse * inverse / (1.0f - cosine);
  float a = abs(p.g);
  float root = inversesqrt((1.0f - a) * (1.0f - a) + a * away);
  float axial = p.axial.x + q * p.axial.y;
  float factor = root * root * root;
  if (kind == light_kind_rectangle) {
    factor *= max(axial, -p.two_sided * axial) * inverse;
    square = p.centre.x + q * (p.centre.y + q);
    inverse = inversesqrt(max(square, 1e-30f));
    axial = p.centre_axial + q * p.axial.y;
  }
  float cone = clamp(p.ramp.x * axial * inverse + p.ramp.y, 0.0f, 1.0f);
  float share = p.window * square;  // squared: its parts may have fourth powers that floats do not hold
  return factor * cone * cone * clamp(1.0f - share * share, 0.0f, 1.0f);
}

// Metres of the medium's ball between light, the place at q, which lies in it, and eye. The place is taken from the middle of
// the ball: of squares of its distances from the base, which may lie far outside, rounding would be more than the ball's.
LIMN_FN float airlight_path_length(AirlightPath p, uint kind, float q) {
  float distance = sqrt(max(p.across2 + q * q, 1e-30f));
  vec3 from_ball = p.from_eye + (p.nearest + q) * p.direction;
  // The way back to where the light enters the ball.
  bool parallel = airlight_parallel(kind);
  float middle = parallel ? dot(from_ball, p.across) : dot(from_ball, p.across + q * p.direction) / distance;
  float inside = p.radius2 - dot(from_ball, from_ball);
  float way = max(middle + sqrt(max(middle * middle + inside, 0.0f)), 0.0f);
  return (parallel ? way : min(way, distance)) + p.before + q;
}

// --- Stretches ---

// The variable that the ray is divided evenly in, at t metres from the eye.
LIMN_FN float airlight_path_variable(AirlightPath p, uint kind, float t) {
  return airlight_parallel(kind) ? t : atan((t - p.nearest) / p.distance);
}

// e of an end of a stretch.
LIMN_FN vec2 airlight_end(AirlightPath p, uint kind, float variable) {
  return airlight_parallel(kind) ? vec2(1.0f, variable) : vec2(cos(variable), p.distance * sin(variable));
}

// Where it lies: q.
LIMN_FN float airlight_place_of(vec2 end) { return end.y / end.x; }

// A place between two ends, q; share: -1 the first, 1 the second.
LIMN_FN float airlight_between(vec2 a, vec2 b, float share) {
  return airlight_place_of(a + b + share * (b - a));
}

// The tangent and the arc tangent with their relative precision at 0 (within 3e-7): GLSL promises none, and 0 for a small angle
// would be divided by.
LIMN_FN float airlight_tangent(float x) {
  if (abs(x) > 0.25f) return tan(x);
  float x2 = x * x;
  return x * (1.0f + x2 / 3.0f * (1.0f + 0.4f * x2 * (1.0f + 17.0f / 42.0f * x2 * (1.0f + 62.0f / 153.0f * x2))));
}
LIMN_FN float airlight_arc_tangent(float x) {
  if (abs(x) > 0.25f) return atan(x);
  float x2 = x * x;
  float tail = 1.0f / 7.0f - x2 * (1.0f / 9.0f - x2 / 11.0f);
  return x * (1.0f - x2 * (1.0f / 3.0f - x2 * (1.0f / 5.0f - x2 * tail)));
}

// The rule over a part of a stretch.
struct AirlightNodes {
  vec2 shares;   // of both nodes, as airlight_between() takes them
  float weight;  // of each
};

// Of the part between two shares of a stretch that is 2 `half_stretch` of the variable.
LIMN_FN AirlightNodes airlight_nodes(uint kind, float half_stretch, float from, float to) {
  bool parallel = airlight_parallel(kind);
  float reach = max(half_stretch, 1e-20f);
  float scale = parallel ? reach : airlight_tangent(reach);
  float a = parallel ? scale * from : airlight_arc_tangent(scale * from);
  float b = parallel ? scale * to : airlight_arc_tangent(scale * to);
  AirlightNodes nodes;
  nodes.weight = 0.5f * (b - a);
  vec2 at = vec2(0.5f * (a + b)) + (gauss_node * nodes.weight) * vec2(-1.0f, 1.0f);
  if (!parallel) at = vec2(airlight_tangent(at.x), airlight_tangent(at.y));
  nodes.shares = at / scale;
  return nodes;
}

LIMN_END
#endif  // LIMN_AIRLIGHT_PATH_GLSL
