#ifndef LIMN_ON_PLANE_GLSL
#define LIMN_ON_PLANE_GLSL

// d moved along a direction (unit) onto the plane through 0 of normal n (unit), as if they met at a cosine of `least` or more.
vec3 on_plane(vec3 d, vec3 n, vec3 direction, float least) {
  float facing = dot(n, direction);
  return d - direction * (dot(n, d) / (facing < 0.0 ? min(facing, -least) : max(facing, least)));
}

#endif  // LIMN_ON_PLANE_GLSL
