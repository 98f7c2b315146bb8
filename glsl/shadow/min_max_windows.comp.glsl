// Levels of the overlapping min-max windows of shadow maps: the first from the maps (BASE 1), further ones from the level before
// them, COARSER of them (1 to 3) at once: a dispatch of a small level waits longer than it works.
#include "glsl/shadow/min_max_windows.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#if BASE
uniform sampler2DArray depth;
layout(rg32f) writeonly uniform image2DArray level_0;

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

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (all(lessThan(at, imageSize(level_0)))) imageStore(level_0, at, vec4(value(at), 0.0, 0.0));
}

#else
layout(rg32f) readonly uniform image2DArray level_0;

// A window `steps` levels above the finer one: 2^steps of its windows along each axis, one beginning where the other ends. The
// last of them reach the map's edge. Loops end in their condition: llvmpipe would run the body once more otherwise.
vec2 value(ivec3 at, int steps) {
  ivec2 last = imageSize(level_0).xy - 1;
  ivec2 first = min(at.xy << steps, last);
  int count = 1 << steps;
  vec2 bounds = vec2(1.0, 0.0);
  int y = 0;
  do {
    int x = 0;
    do {
      ivec2 place = min(first + (ivec2(x, y) << min_max_overlap), last);
      vec2 z = imageLoad(level_0, ivec3(place, at.z)).xy;
      bounds = vec2(min(bounds.x, z.x), max(bounds.y, z.y));
    } while (++x < count);
  } while (++y < count);
  return bounds;
}

// Stores the texel of a level that the invocation has, if it has one. Levels lie below each other, each in whole work groups.
#define STORE(coarser, steps)                                                                                    \
  {                                                                                                              \
    ivec2 size = imageSize(coarser).xy;                                                                          \
    if (at.y >= 0 && all(lessThan(at.xy, size))) imageStore(coarser, at, vec4(value(at, steps), 0.0, 0.0));      \
    at.y -= 8 * ((size.y + 7) / 8);                                                                              \
  }

layout(rg32f) writeonly uniform image2DArray level_1;
#if COARSER >= 2
layout(rg32f) writeonly uniform image2DArray level_2;
#endif
#if COARSER >= 3
layout(rg32f) writeonly uniform image2DArray level_3;
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  STORE(level_1, 1)
#if COARSER >= 2
  STORE(level_2, 2)
#endif
#if COARSER >= 3
  STORE(level_3, 3)
#endif
}
#endif
