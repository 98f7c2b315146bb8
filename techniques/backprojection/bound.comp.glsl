// The bound of backprojection: the texels and the decisions of visibility.comp.glsl, and the area of each patch that blocks. One
// view sees all of the light, which is a rectangle.
#define LIMN_PATCH_UNION 0
#include "glsl/shadow/patch_taps.glsl"
#include "glsl/shadow/visibility_main.glsl"

float covered = 0.0;  // of the box of the light's counted part
float counted = 1.0;  // of it

void add_patch(MicroPatch found) {
  vec2 size = found.high - found.low;
  covered += found.blocks ? size.x * size.y : 0.0;
}

bool patches_suffice() { return covered >= counted; }

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  covered = 0.0;
  counted = counted_share(cursor.view, q.light, DISC_SIDE);
  int answer = tap_patches(cursor, q);
  if (answer != search_partial) return answer == search_lit ? 1.0 : 0.0;
  return clamp(1.0 - covered / max(counted, 1e-6), 0.0, 1.0);
}
