// Whether other surfaces keep a light's centre from the base of a pixel's bumps: the nearest texel of a shadow map.
#define POINT_LIGHTS 1
#include "glsl/shadow/visibility_main.glsl"

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  return shadow_tap(cursor, q, q.position).blocked ? 0.0 : 1.0;
}
