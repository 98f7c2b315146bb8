// Colours in 32 bits with one exponent for all channels: RGB9E5 as OpenGL has it (specification, section 8.5.2).
#ifndef LIMN_SHARED_EXPONENT_GLSL
#define LIMN_SHARED_EXPONENT_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

LIMN_CONST float shared_exponent_max = 65408.0f;

// 2^exponent, -126 to 127.
LIMN_FN float power_of_two(int exponent) { return uintBitsToFloat(uint(exponent + 127) << 23u); }

// Channels are clamped to [0, shared_exponent_max] and rounded: the largest within 1/1023 of itself where it is at least 2^-15,
// the others as far.
LIMN_FN uint shared_exponent_encode(vec3 colour) {
  vec3 c = clamp(colour, vec3(0.0f), vec3(shared_exponent_max));
  float largest = max(c.x, max(c.y, c.z));
  // floor(log2(largest)) + 1, from the float's own exponent.
  int exponent = max(int(floatBitsToUint(largest) >> 23u) - 126, -15);
  if (floor(largest * power_of_two(9 - exponent) + 0.5f) >= 512.0f) ++exponent;
  uvec3 parts = uvec3(floor(c * power_of_two(9 - exponent) + vec3(0.5f)));
  return parts.x | (parts.y << 9u) | (parts.z << 18u) | (uint(exponent + 15) << 27u);
}

LIMN_FN vec3 shared_exponent_decode(uint bits) {
  return power_of_two(int(bits >> 27u) - 24) * vec3(uvec3(bits, bits >> 9u, bits >> 18u) & uvec3(511u));
}

LIMN_END
#endif  // LIMN_SHARED_EXPONENT_GLSL
