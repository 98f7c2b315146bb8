// What a leaf sees through its bins. SKY 1: what empty bins see of the environment; 0: what links bring. MEDIUM 1, with SKY alone:
// less what the scene's medium takes of it.
#ifndef LIMN_BIN_LOOKUP_GLSL
#define LIMN_BIN_LOOKUP_GLSL
#include "techniques/implicit_visibility/elements.glsl"
#if SKY
#if MEDIUM
#include "glsl/media/medium_input.glsl"
#endif
#endif

struct BinDirection {
  vec3 direction;     // unit, in the space of the bins
  float solid_angle;  // sr
};

layout(std430) readonly buffer Directions { BinDirection directions[]; };
layout(std430) readonly buffer Links { uint links[]; };
layout(std430) readonly buffer Source { vec4 source[]; };  // radiance of elements of all levels, or of bins (SKY)

// Radiance that reaches `place` (world, m) through a bin of the leaf of `row`, which lies in `direction`.
vec3 bin_radiance(uint row, uint bin, vec3 place, vec3 direction) {
  vec3 radiance = vec3(0.0);
  uint link = links[row * bin_count + bin];
#if SKY
  if (link == no_link) {
    radiance = source[bin].rgb;
#if MEDIUM
    Medium medium = scene_medium();
    radiance *= medium_transmittance(medium, medium_length(medium, place, from_bins(direction), 3.0e38));
#endif
  }
#else
  if (link < link_back) radiance = source[sent_index(link, -direction)].rgb;
#endif
  return radiance;
}

#endif  // LIMN_BIN_LOOKUP_GLSL
