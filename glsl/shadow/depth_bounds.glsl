// What lookups of depth bounds in boxes of texels have in common, whatever holds the bounds.
#ifndef LIMN_DEPTH_BOUNDS_GLSL
#define LIMN_DEPTH_BOUNDS_GLSL

// Least and greatest depth of what four texels stand for, which cover all of a box inside the map: those at low and high
// and at the other two corners between them. Where the box is not `inside` the map, its rest has depth 1.
vec2 depth_bounds_of_four(sampler2DArray bounds, ivec2 low, ivec2 high, int layer, int level, bool inside) {
  vec2 t00 = texelFetch(bounds, ivec3(low, layer), level).xy;
  vec2 t10 = texelFetch(bounds, ivec3(high.x, low.y, layer), level).xy;
  vec2 t01 = texelFetch(bounds, ivec3(low.x, high.y, layer), level).xy;
  vec2 t11 = texelFetch(bounds, ivec3(high, layer), level).xy;
  float least = min(min(t00.x, t10.x), min(t01.x, t11.x));
  float greatest = max(max(t00.y, t10.y), max(t01.y, t11.y));
  return vec2(least, inside ? greatest : 1.0);
}

#endif  // LIMN_DEPTH_BOUNDS_GLSL
