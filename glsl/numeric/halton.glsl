// The Halton sequence (Halton 1960, On the efficiency of certain quasi-random sequences of points).
#ifndef LIMN_HALTON_GLSL
#define LIMN_HALTON_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// The digits of i mirrored at the point, in [0, 1). base: 2 to 16. Exact to rounding for i < 2^20: reversed digits and
// their power of the base then fit 24 bits.
LIMN_FN float radical_inverse(uint base, uint i) {
  uint reversed = 0u;
  uint power = 1u;
  while (i > 0u) {
    reversed = reversed * base + i % base;
    power *= base;
    i /= base;
  }
  return min(float(reversed) / float(power), 0.99999994f);
}

// Point i of the sequence in bases 2, 3 and 5: any 2^a 3^b 5^c consecutive points lie one in each cell of a grid of
// 2^a x 3^b x 5^c.
LIMN_FN vec3 halton_point(uint i) {
  return vec3(radical_inverse(2u, i), radical_inverse(3u, i), radical_inverse(5u, i));
}

LIMN_END
#endif  // LIMN_HALTON_GLSL
