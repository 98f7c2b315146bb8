// Horizon maps (Max 1988, Horizon Mapping: Shadows for Bump-Mapped Surfaces): tangents of the horizon's elevation along
// evenly spread azimuths, linear between them. Number 0 lies along T, the next ones turn towards B.
#ifndef LIMN_RELIEF_HORIZON_MAP_GLSL
#define LIMN_RELIEF_HORIZON_MAP_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// The two azimuths around a direction.
struct HorizonPlace {
  int first;
  int second;
  float weight;  // of the second
};

LIMN_FN HorizonPlace horizon_place(vec3 l, int azimuths) {
  float turns = (l.x == 0.0f && l.y == 0.0f) ? 0.0f : atan(l.y, l.x) * (0.5f * inverse_pi);
  float place = (turns - floor(turns)) * float(azimuths);
  float below = min(floor(place), float(azimuths - 1));
  HorizonPlace result;
  result.first = int(below);
  result.second = result.first + 1 == azimuths ? 0 : result.first + 1;
  result.weight = place - below;
  return result;
}

// Whether a unit vector of the base's frame points above the horizon.
LIMN_FN bool horizon_lit(vec3 l, float tangent) {
  return l.z > 0.0f && l.z >= tangent * length(vec2(l));
}

LIMN_END
#endif  // LIMN_RELIEF_HORIZON_MAP_GLSL
