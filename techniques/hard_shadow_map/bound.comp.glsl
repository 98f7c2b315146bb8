// The bound of hard shadow maps: each texel that visibility.comp.glsl fetches, compared by its depth alone.
#include "glsl/shadow/plain_map.glsl"

layout(r16) writeonly uniform image2DArray visibility;

float plain_visibility(ShadowView view, uint layer, vec3 p) {
#if FILTER == 0
  return plain_map_lit(view, layer, p) ? 1.0 : 0.0;
#else
  PlainPoint at = plain_point(view, p);
  vec2 corner = floor(at.place - 0.5);
  vec2 weight = at.place - 0.5 - corner;
  vec2 lit[2];
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      ivec2 texel = clamp(ivec2(corner) + ivec2(x, y), ivec2(0), ivec2(view.size) - 1);
      lit[y][x] = plain_texel_lit(view, layer, texel, at.depth) ? 1.0 : 0.0;
    }
  }
  vec2 across = mix(vec2(lit[0].x, lit[1].x), vec2(lit[0].y, lit[1].y), weight.x);
  return map_holds(view, at.place) ? mix(across.x, across.y, weight.y) : 1.0;
#endif
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID.xy, light_layer());
  VisibilityQuery q = visibility_query(at.xy, uint(at.z));
  if (any(greaterThanEqual(at, imageSize(visibility)))) return;
  float v = q.masked ? 1.0 : plain_visibility(q.first, q.maps.first_layer, q.position);
  imageStore(visibility, at, vec4(v));
}
