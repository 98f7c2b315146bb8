// The scene's medium as passes read it that bind the frame block. MEDIUM_STEPS 0: its density is 1 everywhere in its ball; else
// it is a volume (core/gpu_scene/gpu_medium.h declares and binds it), looked up at MEDIUM_STEPS points of a ray from one face of
// its box to the opposite one, and at points in proportion of a shorter or a longer ray.
#ifndef LIMN_MEDIUM_INPUT_GLSL
#define LIMN_MEDIUM_INPUT_GLSL
#include "glsl/scene/blocks.glsl"

Medium scene_medium() {
  return frame_medium(frame.medium_extinction, frame.medium_scattering, frame.medium_asymmetry, frame.medium_ball);
}

#if MEDIUM_STEPS > 0

uniform sampler3D medium_volume;

// Density at p (world).
float medium_density(vec3 p) {
  vec3 place = (frame.medium_to_box * vec4(p, 1.0)).xyz;
  bool inside = all(greaterThanEqual(place, vec3(0.0))) && all(lessThanEqual(place, vec3(1.0)));
  return inside ? textureLod(medium_volume, place, 0.0).x : 0.0;
}

// Where there may be density on the ray: t in [x, y]; x > y where there is none.
vec2 medium_range(Medium m, vec3 origin, vec3 direction) {
  vec2 ball = ball_range(m.ball, origin, direction);
  vec2 box = unit_box_range((frame.medium_to_box * vec4(origin, 1.0)).xyz, mat3(frame.medium_to_box) * direction);
  return vec2(max(ball.x, box.x), min(ball.y, box.y));
}

// Metres of medium of density 1 that weigh as much as the ray's piece with 0 < t < end, by the midpoint rule.
float medium_length(Medium m, vec3 origin, vec3 direction, float end) {
  vec2 range = medium_range(m, origin, direction);
  range = vec2(max(range.x, 0.0), min(range.y, end));
  if (!(range.x < range.y)) return 0.0;
  vec3 place = (frame.medium_to_box * vec4(origin + range.x * direction, 1.0)).xyz;
  vec3 way = mat3(frame.medium_to_box) * ((range.y - range.x) * direction);
  // Not by clamp(): where Mesa sees a bound of a few steps it unrolls them, and llvmpipe then takes several times as long.
  int steps = max(min(int(ceil(float(MEDIUM_STEPS) * length(way))), 2 * MEDIUM_STEPS), 1);
  float sum = 0.0;
  for (int i = 0; i < steps; ++i)
    sum += textureLod(medium_volume, place + (float(i) + 0.5) / float(steps) * way, 0.0).x;
  return sum * ((range.y - range.x) / float(steps));
}

float medium_length_between(Medium m, vec3 a, vec3 b) {
  vec3 d = b - a;
  float size = length(d);
  return size > 0.0 ? medium_length(m, a, d / size, size) : 0.0;
}

#else

float medium_density(vec3 p) { return 1.0; }
vec2 medium_range(Medium m, vec3 origin, vec3 direction) { return ball_range(m.ball, origin, direction); }
float medium_length(Medium m, vec3 origin, vec3 direction, float end) {
  return ball_length(m.ball, origin, direction, end);
}
float medium_length_between(Medium m, vec3 a, vec3 b) { return ball_length_between(m.ball, a, b); }

#endif

#endif  // LIMN_MEDIUM_INPUT_GLSL
