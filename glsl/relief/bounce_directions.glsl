// Directions along which light from bump to bump is gathered, unit vectors of the base's frame.
#ifndef LIMN_RELIEF_BOUNCE_DIRECTIONS_GLSL
#define LIMN_RELIEF_BOUNCE_DIRECTIONS_GLSL
#include "glsl/numeric/geometry.glsl"
LIMN_BEGIN

LIMN_CONST float golden_angle = 2.39996322972865f;

// Direction i of `paths` in the texel's own frame about its normal n, turned by `turn` radians: with a density of cosines, so
// that all have the weight pi / paths, the cosine included.
LIMN_FN vec3 own_frame_direction(int i, int paths, vec3 n, float turn) {
  float square = (float(i) + 0.5f) / float(paths);
  float sine = sqrt(square);
  float angle = float(i) * golden_angle + turn;
  return from_local(frame_around(n), vec3(sine * cos(angle), sine * sin(angle), sqrt(1.0f - square)));
}

// Direction i of `paths` that all texels share, uniform over the directions whose z is above `lowest`. 0 is the hemisphere of
// the base; the light that steep texels get from below its plane needs minus the sine of the steepest slope's angle.
LIMN_FN vec3 shared_direction(int i, int paths, float lowest) {
  float z = 1.0f - (1.0f - lowest) * (float(i) + 0.5f) / float(paths);
  float sine = sqrt(max(1.0f - z * z, 0.0f));
  float angle = float(i) * golden_angle;
  return vec3(sine * cos(angle), sine * sin(angle), z);
}

LIMN_END
#endif  // LIMN_RELIEF_BOUNCE_DIRECTIONS_GLSL
