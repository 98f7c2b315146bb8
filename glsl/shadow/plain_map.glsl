// The plain test of a shadow map (Williams 1978), which bounds measure: a matrix, one texel, one comparison of depths.
// For perspective views.
#ifndef LIMN_PLAIN_MAP_GLSL
#define LIMN_PLAIN_MAP_GLSL
#include "glsl/shadow/visibility.glsl"

// A point in the map of a view.
struct PlainPoint {
  vec2 place;   // texels
  float depth;  // metres, less the bias
};

PlainPoint plain_point(ShadowView view, vec3 p) {
  vec3 r = shadow_local(view, p);
  float texels = float(view.size);
  vec2 place = texels * view.middle + (texels * view.scale / r.z) * r.xy;
  return PlainPoint(r.z > 0.0 ? place : vec2(-1.0), r.z - bias * shadow_footprint(view, r.z));
}

bool plain_texel_lit(ShadowView view, uint layer, ivec2 texel, float depth) {
  return shadow_metres(view, texelFetch(shadow_depth, ivec3(texel, layer), 0).r) >= depth;
}

// Whether the map shows the point lit. What lies outside the map is.
bool plain_map_lit(ShadowView view, uint layer, vec3 p) {
  PlainPoint at = plain_point(view, p);
  return plain_texel_lit(view, layer, ivec2(at.place), at.depth) || !map_holds(view, at.place);
}

#endif  // LIMN_PLAIN_MAP_GLSL
