// The lit share of taps x taps texels around the receiver's, seen from the light's centre.
#include "glsl/shadow/visibility_main.glsl"

uniform int taps;

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  ShadowView view = cursor.view;
  float texel = shadow_footprint(view, shadow_depth_of(view, shadow_local(view, q.position)));
  int lit = 0;
  for (int i = 0; i < taps * taps; ++i) {
    vec2 step = vec2(i % taps, i / taps) - 0.5 * float(taps - 1);
    vec3 offset = texel * (step.x * view.axis_x + step.y * view.axis_y);
    if (!shadow_tap(cursor, q, q.position + offset).blocked) ++lit;
  }
  return float(lit) / float(taps * taps);
}
