// Levels of a min-max pyramid over shadow maps: COARSER of them (0 to 3), each from the one before, by one thread for each texel
// of the last. BASE 1: the first of all, (depth, depth), is made along with them.
layout(local_size_x = 8, local_size_y = 8) in;

#if BASE
uniform sampler2DArray depth;
layout(rg32f) writeonly uniform image2DArray level_0;

vec2 made_0(ivec3 at) {
  vec2 bounds = texelFetch(depth, at, 0).rr;
  imageStore(level_0, at, vec4(bounds, 0.0, 0.0));
  return bounds;
}
#else
layout(rg32f) readonly uniform image2DArray level_0;

vec2 made_0(ivec3 at) { return imageLoad(level_0, at).xy; }
#endif

// The first (xy) and the last (zw) texel of the finer level that texel `at` of the coarser one bounds: four, and at the end of an
// odd row or column those left over.
ivec4 bounded(ivec2 at, ivec2 coarser, ivec2 finer) {
  ivec2 first = min(2 * at, finer - 1);
  return ivec4(first, mix(first + 1, finer - 1, equal(at, coarser - 1)));
}

// Loops end in their condition: llvmpipe would run the body once more otherwise.
#define MAKE(made, coarser, made_finer, finer)                                   \
  vec2 made(ivec3 at) {                                                          \
    ivec4 texels = bounded(at.xy, imageSize(coarser).xy, imageSize(finer).xy);   \
    vec2 bounds = vec2(1.0, 0.0);                                                \
    int y = texels.y;                                                            \
    do {                                                                         \
      int x = texels.x;                                                          \
      do {                                                                       \
        vec2 z = made_finer(ivec3(x, y, at.z));                                  \
        bounds = vec2(min(bounds.x, z.x), max(bounds.y, z.y));                   \
      } while (++x <= texels.z);                                                 \
    } while (++y <= texels.w);                                                   \
    imageStore(coarser, at, vec4(bounds, 0.0, 0.0));                             \
    return bounds;                                                               \
  }

#if COARSER >= 1
layout(rg32f) writeonly uniform image2DArray level_1;
MAKE(made_1, level_1, made_0, level_0)
#endif
#if COARSER >= 2
layout(rg32f) writeonly uniform image2DArray level_2;
MAKE(made_2, level_2, made_1, level_1)
#endif
#if COARSER >= 3
layout(rg32f) writeonly uniform image2DArray level_3;
MAKE(made_3, level_3, made_2, level_2)
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
#if COARSER == 0
  if (all(lessThan(at, imageSize(level_0)))) made_0(at);
#elif COARSER == 1
  if (all(lessThan(at, imageSize(level_1)))) made_1(at);
#elif COARSER == 2
  if (all(lessThan(at, imageSize(level_2)))) made_2(at);
#else
  if (all(lessThan(at, imageSize(level_3)))) made_3(at);
#endif
}
