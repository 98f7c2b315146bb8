// Backprojection (Guennebaud, Barthe and Paulin 2006): V = 1 - the area that the micro-patches of a shadow map cover on
// the light.
#define DISC_SIDE square_of_disc
#define PATCH_SPREAD 0.0
#define LIMN_PATCH_UNION 0
#include "glsl/shadow/micro_patch_walk.glsl"
#include "glsl/shadow/visibility_main.glsl"

float covered = 0.0;  // of the box of the light's counted part
float counted = 1.0;  // of it

void add_patch(PatchProjection projection, MicroPatch found) {
  vec2 size = clamp(found.high, vec2(0.0), vec2(1.0)) - clamp(found.low, vec2(0.0), vec2(1.0));
  covered += found.blocks ? projection.area * max(size.x, 0.0) * max(size.y, 0.0) : 0.0;
}

bool patches_suffice() { return covered >= counted; }

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  covered = 0.0;
  counted = counted_share(cursor.view, q.light, square_of_disc);
  int answer = walk_patches(cursor, q);
  if (answer != search_partial) return answer == search_lit ? 1.0 : 0.0;
  return clamp(1.0 - covered / max(counted, 1e-6), 0.0, 1.0);
}
