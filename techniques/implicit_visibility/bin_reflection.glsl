// What a leaf reflects of what it sees through its bins, into one direction. SKY as in gather.comp.glsl.
#ifndef LIMN_BIN_REFLECTION_GLSL
#define LIMN_BIN_REFLECTION_GLSL
#include "techniques/implicit_visibility/elements.glsl"

layout(std430, binding = 0) readonly buffer Directions { vec4 directions[]; };
layout(std430, binding = 2) readonly buffer Links { uint links[]; };
layout(std430, binding = 3) readonly buffer Source { vec4 source[]; };  // radiance of elements, or of bins (SKY)

// Mean of radiance times BRDF, weighted as in gather.comp.glsl.
vec3 reflected(uint row, SurfaceBrdf surface, vec3 n, vec3 view) {
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint bin = 0u; bin < bin_count; ++bin) {
    vec4 direction = directions[bin];
    float weight = direction.w * dot(n, direction.xyz);
    if (weight > 0.0) {
      vec3 radiance = vec3(0.0);
      uint link = links[row * bin_count + bin];
#if SKY
      if (link == no_link) radiance = source[bin].rgb;
#else
      if (link < link_back) radiance = source[sent_index(link, -direction.xyz)].rgb;
#endif
      weights += weight;
      sum += weight * radiance * brdf(surface, n, view, direction.xyz);
    }
  }
  return weights > 0.0 ? pi / weights * sum : vec3(0.0);
}

#endif  // LIMN_BIN_REFLECTION_GLSL
