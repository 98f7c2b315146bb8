// Hard shadows: one test towards the light's centre (FILTER 0: the nearest texel; 1: 2 x 2 texels, bilinear).
#include "glsl/visibility.glsl"

layout(binding = 0, r16) writeonly uniform image2DArray visibility;

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, gl_WorkGroupID.z);
  VisibilityQuery q = visibility_query(at.xy, gl_WorkGroupID.z);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = 1.0;
  if (!q.masked) {
    ShadowCursor cursor = shadow_cursor(q);
    if (shadow_covers_receiver(cursor, q)) {
#if FILTER == 0
      v = shadow_tap(cursor, q, q.position).blocked ? 0.0 : 1.0;
#else
      v = shadow_tap_2x2(cursor, q.position);
#endif
    }
  }
  imageStore(visibility, at, vec4(v));
}
