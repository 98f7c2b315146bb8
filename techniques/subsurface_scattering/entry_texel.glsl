// What a point that falls on a pixel asks for, in two texels: the plane of its surface (eye_plane) with its instance, and the
// light that enters there.
#ifndef ENTRY_TEXEL_GLSL
#define ENTRY_TEXEL_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Three floats from 0 on in two words: their exponents and the first 13 digits of their mantissas, rounded, so that they keep
// the range of floats and 1 part in 16384. `bits`: floatBitsToUint of each.
LIMN_FN uint entry_digits(uint bits) { return min(bits + 0x1ffu + ((bits >> 10u) & 1u), 0x7f7ffc00u) >> 10u; }
LIMN_FN uvec2 entry_pack(uvec3 bits) {
  uint third = entry_digits(bits.z);
  return uvec2(entry_digits(bits.x) << 11u | third >> 10u, entry_digits(bits.y) << 11u | (third & 0x3ffu));
}
LIMN_FN uvec3 entry_unpack(uvec2 words) {
  return uvec3((words.x & 0xfffff800u) >> 1u, (words.y & 0xfffff800u) >> 1u,
               (words.x & 0x7ffu) << 20u | (words.y & 0x3ffu) << 10u);
}

LIMN_END
#endif  // ENTRY_TEXEL_GLSL
