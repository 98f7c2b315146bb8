// Directions and equirectangular maps: u = 0.5 + atan2(d.x, -d.z) / 2 pi, v = acos(d.y) / pi, v from the top.
// The centre of the map looks along -z, its right half along +x.
#ifndef LIMN_EQUIRECTANGULAR_GLSL
#define LIMN_EQUIRECTANGULAR_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Direction (any length but 0) to (u, v) in [0, 1]^2. The angle from the pole is taken by atan2, which keeps its
// precision where acos loses it.
LIMN_FN vec2 equirectangular_uv(vec3 direction) {
  float horizontal = sqrt(direction.x * direction.x + direction.z * direction.z);
  float azimuth = horizontal > 0.0f ? atan(direction.x, -direction.z) : 0.0f;
  return vec2(0.5f + 0.5f * inverse_pi * azimuth, inverse_pi * atan(horizontal, direction.y));
}

// Inverse of equirectangular_uv: a unit direction.
LIMN_FN vec3 equirectangular_direction(vec2 uv) {
  float azimuth = 2.0f * pi * (uv.x - 0.5f);
  float polar = pi * uv.y;
  float horizontal = sin(polar);
  return vec3(horizontal * sin(azimuth), cos(polar), -horizontal * cos(azimuth));
}

// Solid angle (sr) of the pixels in row `row` of a map of width x height: exact, so that the rows sum to 4 pi.
LIMN_FN float equirectangular_pixel_solid_angle(int row, int width, int height) {
  float top = cos(pi * float(row) / float(height));
  float bottom = cos(pi * float(row + 1) / float(height));
  return 2.0f * pi / float(width) * (top - bottom);
}

// World direction to the direction in which an environment turned by `rotation` radians about +Y (counter-clockwise
// seen from above) is looked up.
LIMN_FN vec3 environment_lookup_direction(vec3 world, float rotation) {
  float c = cos(rotation);
  float s = sin(rotation);
  return vec3(c * world.x - s * world.z, world.y, s * world.x + c * world.z);
}

// Its inverse.
LIMN_FN vec3 environment_world_direction(vec3 lookup, float rotation) {
  return environment_lookup_direction(lookup, -rotation);
}

LIMN_END
#endif  // LIMN_EQUIRECTANGULAR_GLSL
