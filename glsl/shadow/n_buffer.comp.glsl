// One level of the N-buffer of shadow maps: level 0 from the maps (BASE 1), each further one from four windows of the one
// before.
#include "glsl/shadow/n_buffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rg32f) uniform image2DArray windows;

#if BASE
uniform sampler2DArray depth;
#else
uniform int level;
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec2 size = imageSize(windows).xy;
  if (any(greaterThanEqual(at.xy, size))) return;
  int slice = at.z * n_buffer_levels(max(size.x, size.y));
#if BASE
  vec2 bounds = texelFetch(depth, at, 0).rr;
#else
  int finer = slice + level - 1;
  ivec2 next = min(at.xy + (1 << (level - 1)), size - 1);  // the last texel is part of what starts before it
  vec2 t00 = imageLoad(windows, ivec3(at.xy, finer)).xy;
  vec2 t10 = imageLoad(windows, ivec3(next.x, at.y, finer)).xy;
  vec2 t01 = imageLoad(windows, ivec3(at.x, next.y, finer)).xy;
  vec2 t11 = imageLoad(windows, ivec3(next, finer)).xy;
  vec2 bounds = vec2(min(min(t00.x, t10.x), min(t01.x, t11.x)), max(max(t00.y, t10.y), max(t01.y, t11.y)));
  slice += level;
#endif
  imageStore(windows, ivec3(at.xy, slice), vec4(bounds, 0.0, 0.0));
}
