// Where the radiance cache keeps a normal: a stereographic map around the direction to the camera, as wide as normals of surfaces
// that the camera sees may turn away.
#ifndef LIMN_CACHE_PLACE_GLSL
#define LIMN_CACHE_PLACE_GLSL
#include "glsl/numeric/geometry.glsl"
#include "glsl/numeric/language.glsl"
#include "glsl/numeric/stereographic.glsl"
LIMN_BEGIN

LIMN_CONST int cache_size = 128;  // texels along a side

// Radius of the map, 1 for normals that are perpendicular to the view. corner: length of the direction through the picture's corner
// that is one metre long along the view axis. A surface that is seen edge-on there turns away by that corner's angle.
LIMN_FN float cache_reach(float corner) { return corner + sqrt(max(corner * corner - 1.0f, 0.0f)); }

// Texture coordinates. towards: to the camera, unit; normals opposite to it, which are not seen, lie at the edge.
LIMN_FN vec2 cache_place(vec3 normal, vec3 towards, float reach) {
  vec3 local = to_local(frame_around(towards), normal);
  vec2 p = paraboloid_map(vec3(local.x, local.y, max(local.z, -0.999f)));
  return vec2(0.5f) + p * (0.5f * float(cache_size - 1) / (float(cache_size) * reach));
}

// Its inverse at the centre of a texel.
LIMN_FN vec3 cache_normal(ivec2 texel, vec3 towards, float reach) {
  vec2 p = (vec2(texel) - vec2(0.5f * float(cache_size - 1))) * (2.0f * reach / float(cache_size - 1));
  return from_local(frame_around(towards), paraboloid_direction(p));
}

LIMN_END
#endif  // LIMN_CACHE_PLACE_GLSL
