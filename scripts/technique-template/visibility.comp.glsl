// The lit share of taps x taps texels around the receiver's, seen from the light's centre.
#include "glsl/visibility.glsl"

layout(binding = 0, r16) writeonly uniform image2DArray visibility;
uniform int taps;

float filtered(VisibilityQuery q) {
  ShadowCursor cursor = shadow_cursor(q);
  if (!shadow_covers_receiver(cursor, q)) return 1.0;
  ShadowView view = cursor.view;
  float texel = shadow_footprint(view, shadow_depth_of(view, shadow_local(view, q.position)));
  int lit = 0;
  for (int i = 0; i < taps * taps; ++i) {
    vec2 step = vec2(i % taps, i / taps) - 0.5 * float(taps - 1);
    vec3 offset = texel * (step.x * view.axis_x.xyz + step.y * view.axis_y.xyz);
    if (!shadow_tap(cursor, q, q.position + offset).blocked) ++lit;
  }
  return float(lit) / float(taps * taps);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, gl_WorkGroupID.z);  // pixel, and light of the batch
  VisibilityQuery q = visibility_query(at.xy, gl_WorkGroupID.z);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  imageStore(visibility, at, vec4(q.masked ? 1.0 : filtered(q)));
}
