// Internal to the construction of links: computes with four numbers at once. The code compiles to the vector
// instructions of the target.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace limn::radiosity {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));
using Float2 = float __attribute__((vector_size(8)));
using Int2 = int32_t __attribute__((vector_size(8)));

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
/// Loads two numbers each from two places.
inline Float4 loadPairs(const float* low, const float* high) {
  Float2 a, b;
  std::memcpy(&a, low, sizeof a);
  std::memcpy(&b, high, sizeof b);
  return __builtin_shufflevector(a, b, 0, 1, 2, 3);
}
inline Int4 loadIntPairs(const uint32_t* low, const uint32_t* high) {
  Int2 a, b;
  std::memcpy(&a, low, sizeof a);
  std::memcpy(&b, high, sizeof b);
  return __builtin_shufflevector(a, b, 0, 1, 2, 3);
}
inline void storePairs(float* low, float* high, Float4 v) {
  const Float2 a = __builtin_shufflevector(v, v, 0, 1), b = __builtin_shufflevector(v, v, 2, 3);
  std::memcpy(low, &a, sizeof a);
  std::memcpy(high, &b, sizeof b);
}
inline void storeIntPairs(uint32_t* low, uint32_t* high, Int4 v) {
  const Int2 a = __builtin_shufflevector(v, v, 0, 1), b = __builtin_shufflevector(v, v, 2, 3);
  std::memcpy(low, &a, sizeof a);
  std::memcpy(high, &b, sizeof b);
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
/// Returns not-a-number where the comparison is true, else v.
inline Float4 missing(Int4 comparison, Float4 v) {
  Int4 bits;
  std::memcpy(&bits, &v, sizeof bits);
  bits |= comparison;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}
/// Returns the greater number; b where either is not a number, as does the function below: the behaviour of
/// the target's instructions.
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
/// Returns bit k where lane k of a comparison is true.
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
