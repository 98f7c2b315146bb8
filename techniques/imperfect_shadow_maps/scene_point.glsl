// A point on a triangle, as it is chosen and as it is where the triangle is now. Layouts that C++ and GLSL share.
#ifndef LIMN_SCENE_POINT_GLSL
#define LIMN_SCENE_POINT_GLSL
#include "glsl/language.glsl"
LIMN_BEGIN

// Element of a storage buffer.
struct ScenePoint {
  uvec4 corners;  // xyz: vertices of the triangle, counted from the primitive's first; w: index of the draw instance
  vec4 place;     // xy: barycentric coordinates of the second and third corner; zw: unused
};

struct PlacedPoint {
  vec4 position;  // xyz: world, m; w: unused
  vec4 normal;    // xyz: unit, either side; w: unused
};

LIMN_END
#endif  // LIMN_SCENE_POINT_GLSL
