// The stereographic projection of the sphere from the pole -z onto a plane: (x, y) / (1 + z). It is what paraboloid maps
// keep (Brabec, Annen, Seidel 2002): the hemisphere around +z fills the disc of radius 1, the local scale is the same in all
// directions, and what lies below the horizon follows outside of the disc.
#ifndef LIMN_STEREOGRAPHIC_GLSL
#define LIMN_STEREOGRAPHIC_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// direction: unit, z > -1.
LIMN_FN vec2 paraboloid_map(vec3 direction) {
  return vec2(direction.x, direction.y) / (1.0f + direction.z);
}

LIMN_FN vec3 paraboloid_direction(vec2 p) {
  float k = 2.0f / (1.0f + dot(p, p));
  return vec3(k * p.x, k * p.y, k - 1.0f);
}

// Disc radii per radian at squared radius rho2 of the disc.
LIMN_FN float paraboloid_scale(float rho2) { return 0.5f * (1.0f + rho2); }

LIMN_END
#endif  // LIMN_STEREOGRAPHIC_GLSL
