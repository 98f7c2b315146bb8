// Internal to the construction of links: four numbers at once. Compiles to the vector instructions of the
// target.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace limn::radiosity {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

inline Float4 load(const float* values) {
  Float4 r;
  std::memcpy(&r, values, sizeof r);
  return r;
}
inline Int4 loadInts(const uint32_t* values) {
  Int4 r;
  std::memcpy(&r, values, sizeof r);
  return r;
}
inline void store(float* values, Float4 v) {
  std::memcpy(values, &v, sizeof v);
}
inline void storeInts(uint32_t* values, Int4 v) {
  std::memcpy(values, &v, sizeof v);
}
inline Float4 splat(float value) {
  return Float4{value, value, value, value};
}
inline Float4 root(Float4 v) {
#ifdef __SSE__
  return __builtin_ia32_sqrtps(v);
#else
  for (int k = 0; k < 4; ++k) v[k] = std::sqrt(v[k]);
  return v;
#endif
}
inline Float4 magnitude(Float4 v) {
  Int4 bits;
  std::memcpy(&bits, &v, sizeof bits);
  bits &= 0x7fffffff;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}
/// b where either is not a number, as below: what the target's instructions do.
inline Float4 greater(Float4 a, Float4 b) {
#ifdef __SSE__
  return __builtin_ia32_maxps(a, b);
#else
  return a > b ? a : b;
#endif
}
inline Float4 lesser(Float4 a, Float4 b) {
#ifdef __SSE__
  return __builtin_ia32_minps(a, b);
#else
  return a < b ? a : b;
#endif
}
/// Bit k where lane k of a comparison is true.
inline uint32_t laneMask(Int4 v) {
#ifdef __SSE__
  Float4 lanes;
  std::memcpy(&lanes, &v, sizeof lanes);
  return static_cast<uint32_t>(__builtin_ia32_movmskps(lanes));
#else
  const Int4 bits = v & Int4{1, 2, 4, 8};
  return static_cast<uint32_t>(bits[0] | bits[1] | bits[2] | bits[3]);
#endif
}

}  // namespace limn::radiosity
