// What a leaf reflects of what it sees through its bins, into one direction. SKY, MEDIUM as in bin_lookup.glsl.
#ifndef LIMN_BIN_REFLECTION_GLSL
#define LIMN_BIN_REFLECTION_GLSL
#include "techniques/implicit_visibility/bin_lookup.glsl"

// Mean of radiance times BRDF at `place` (world, m), weighted as in gather.comp.glsl. n: shading normal; ng: geometric normal, from
// below which no light arrives.
vec3 reflected(uint row, vec3 place, SurfaceBrdf surface, vec3 n, vec3 ng, vec3 view) {
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint bin = 0u; bin < bin_count; ++bin) {
    BinDirection to = directions[bin];
    float weight = to.solid_angle * dot(n, to.direction);
    if (weight > 0.0) {
      weights += weight;
      if (dot(ng, to.direction) > 0.0)
        sum += weight * bin_radiance(row, bin, place, to.direction) * brdf(surface, n, view, to.direction);
    }
  }
  return weights > 0.0 ? pi / weights * sum : vec3(0.0);
}

#endif  // LIMN_BIN_REFLECTION_GLSL
