// The compute pass of a technique that answers `visibility` from shadow maps: what is masked, lies outside the maps or
// comes from a light without extent is answered here, the rest by the technique's light_visibility().
// Define POINT_LIGHTS 1 before including this where light_visibility() answers for lights without extent, too.
#ifndef LIMN_VISIBILITY_MAIN_GLSL
#define LIMN_VISIBILITY_MAIN_GLSL
#include "glsl/light/light_part.glsl"
#include "glsl/shadow/visibility.glsl"

#ifndef POINT_LIGHTS
#define POINT_LIGHTS 0
#endif

layout(r16) writeonly uniform image2DArray visibility;

// V in [0, 1] of the query's light. The cursor stands in the view that sees the receiver.
float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel);

// V of a light, or of a part of one; 1 where it is masked or its maps do not cover the receiver.
float map_visibility(VisibilityQuery q, ivec2 pixel, out bool covered) {
  float v = 1.0;
  covered = true;
  if (!q.masked) {
    ShadowCursor cursor = shadow_cursor(q);
    covered = shadow_covers_receiver(cursor, q);
    if (covered) {
      if (POINT_LIGHTS == 1 || q.light.extended) {
        v = light_visibility(cursor, q, pixel);
      } else {
        v = shadow_tap(cursor, q, q.position).blocked ? 0.0 : 1.0;
      }
    }
  }
  return v;
}

#if LIGHT_PARTS_U * LIGHT_PARTS_V > 1
// maps: the first part's. Parts count by what of them lies above the receiver's tangent plane. Those whose maps do not cover
// the receiver do not, unless all are such.
float parts_visibility(VisibilityQuery whole, uint maps, ivec2 pixel, out bool covered) {
  const uvec2 count = uvec2(LIGHT_PARTS_U, LIGHT_PARTS_V);
  Light light = lights[whole.maps.light];
  uint kind = kind_of_light(light);
  float lit = 0.0;
  float total = 0.0;
  bool missed = false;
  uint part = 0u;
  do {
    VisibilityQuery q = whole;
    q.maps = maps_at(maps + part);
    q.first = view_of_layer(q.maps.first_layer);
    q.light = light_view_of_kind(light_part(light, kind, light_size, count, part), kind, q.position, q.normal, -1.0);
    float share = light_view_share(q.light);
    q.masked = whole.masked || share <= 0.0;
    float v = map_visibility(q, pixel, covered);
    missed = missed || !covered;
    share = covered ? share : 0.0;
    lit += share * v;
    total += share;
  } while (++part < count.x * count.y);
  covered = total > 0.0 || !missed;
  return total > 0.0 ? lit / total : 1.0;
}
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, light_layer());
  uint maps = uint(at.z * SHADOW_LIGHT_STRIDE);
  VisibilityQuery q = visibility_query(at.xy, maps);
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  bool covered;
#if LIGHT_PARTS_U * LIGHT_PARTS_V > 1
  float v = parts_visibility(q, maps, at.xy, covered);
#else
  float v = map_visibility(q, at.xy, covered);
#endif
  if (!covered) atomicAdd(uncovered_pixels, 1u);
  imageStore(visibility, at, vec4(v));
}

#endif  // LIMN_VISIBILITY_MAIN_GLSL
