// Hard shadows: one test towards the light's centre (FILTER 0: the nearest texel; 1: 2 x 2 texels, bilinear).
#define POINT_LIGHTS 1
#include "glsl/shadow/visibility_main.glsl"

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
#if FILTER == 0
  return shadow_tap(cursor, q, q.position).blocked ? 0.0 : 1.0;
#else
  return shadow_tap_2x2(cursor, q, q.position);
#endif
}
