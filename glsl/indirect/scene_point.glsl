// A point on a triangle, as it is chosen and as it is where the triangle is now. Layouts that C++ and GLSL share.
#ifndef LIMN_SCENE_POINT_GLSL
#define LIMN_SCENE_POINT_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Element of a storage buffer.
struct ScenePoint {
  uvec3 corners;  // vertices of the triangle, counted from the primitive's first
  uint instance;  // draw instance
  vec2 place;     // barycentric coordinates of the second and third corner
  uvec2 unused;
};

struct PlacedPoint {
  vec4 position;  // world, m
  vec4 normal;    // unit, either side
};

LIMN_END
#endif  // LIMN_SCENE_POINT_GLSL
