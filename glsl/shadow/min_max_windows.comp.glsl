// One level of the overlapping min-max windows of shadow maps: the first from the maps (BASE 1), each further one from the one
// before.
#include "glsl/shadow/min_max_windows.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rg32f) writeonly uniform image2DArray coarser;

#if BASE
uniform sampler2DArray depth;

// Beyond the map's edge its last texels are repeated.
vec2 value(ivec3 at) {
  vec4 least = vec4(1.0);
  vec4 greatest = vec4(0.0);
  int quads = min_max_window(0) / 2;
  for (int i = 0; i < quads * quads; ++i) {
    vec2 corner = vec2(at.xy + 2 * ivec2(i % quads, i / quads) + 1);
    vec4 z = textureGather(depth, vec3(corner / vec2(textureSize(depth, 0).xy), at.z));
    least = min(least, z);
    greatest = max(greatest, z);
  }
  least.xy = min(least.xy, least.zw);
  greatest.xy = max(greatest.xy, greatest.zw);
  return vec2(min(least.x, least.y), max(greatest.x, greatest.y));
}

#else
layout(rg32f) readonly uniform image2DArray finer;

// The last of the finer windows reach the map's edge.
vec2 value(ivec3 at) {
  ivec2 last = imageSize(finer).xy - 1;
  ivec2 first = min(2 * at.xy, last);
  ivec2 second = min(first + (1 << min_max_overlap), last);
  vec2 t00 = imageLoad(finer, ivec3(first, at.z)).xy;
  vec2 t10 = imageLoad(finer, ivec3(second.x, first.y, at.z)).xy;
  vec2 t01 = imageLoad(finer, ivec3(first.x, second.y, at.z)).xy;
  vec2 t11 = imageLoad(finer, ivec3(second, at.z)).xy;
  return vec2(min(min(t00.x, t10.x), min(t01.x, t11.x)), max(max(t00.y, t10.y), max(t01.y, t11.y)));
}
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(coarser)))) return;
  imageStore(coarser, at, vec4(value(at), 0.0, 0.0));
}
