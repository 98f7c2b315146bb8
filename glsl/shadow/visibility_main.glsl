// The compute pass of a technique that answers `visibility` from shadow maps: what is masked, lies outside the maps or
// comes from a light without extent is answered here, the rest by the technique's light_visibility().
// Define POINT_LIGHTS 1 before including this where light_visibility() answers for lights without extent, too.
#ifndef LIMN_VISIBILITY_MAIN_GLSL
#define LIMN_VISIBILITY_MAIN_GLSL
#include "glsl/shadow/visibility.glsl"

#ifndef POINT_LIGHTS
#define POINT_LIGHTS 0
#endif

layout(r16) writeonly uniform image2DArray visibility;

// V in [0, 1] of the query's light. The cursor stands in the view that sees the receiver.
float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel);

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, light_layer());
  VisibilityQuery q = visibility_query(at.xy, uint(at.z));
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = 1.0;
  if (!q.masked) {
    ShadowCursor cursor = shadow_cursor(q);
    if (shadow_covers_receiver(cursor, q)) {
      if (POINT_LIGHTS == 1 || q.light.extended) {
        v = light_visibility(cursor, q, at.xy);
      } else {
        v = shadow_tap(cursor, q, q.position).blocked ? 0.0 : 1.0;
      }
    }
  }
  imageStore(visibility, at, vec4(v));
}

#endif  // LIMN_VISIBILITY_MAIN_GLSL
