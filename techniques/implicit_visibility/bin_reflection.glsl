// What a leaf reflects of what it sees through its bins, into one direction. SKY as in bin_lookup.glsl.
#ifndef LIMN_BIN_REFLECTION_GLSL
#define LIMN_BIN_REFLECTION_GLSL
#include "techniques/implicit_visibility/bin_lookup.glsl"

// Mean of radiance times BRDF, weighted as in gather.comp.glsl. n: shading normal; ng: geometric normal, from below which no light
// arrives.
vec3 reflected(uint row, SurfaceBrdf surface, vec3 n, vec3 ng, vec3 view) {
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint bin = 0u; bin < bin_count; ++bin) {
    BinDirection to = directions[bin];
    float weight = to.solid_angle * dot(n, to.direction);
    if (weight > 0.0) {
      weights += weight;
      if (dot(ng, to.direction) > 0.0)
        sum += weight * bin_radiance(row, bin, to.direction) * brdf(surface, n, view, to.direction);
    }
  }
  return weights > 0.0 ? pi / weights * sum : vec3(0.0);
}

#endif  // LIMN_BIN_REFLECTION_GLSL
