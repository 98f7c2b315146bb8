// Generates low-discrepancy points: Owen-scrambled Sobol pairs, independent between pixels, pairs and halves.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace limn::reference {

inline uint32_t reverseBits(uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

/// Mixes 64 bits (finaliser of SplitMix64; Steele, Lea and Flood 2014, doi:10.1145/2714064.2660195).
inline uint64_t mixBits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

inline uint64_t combine(uint64_t a, uint64_t b) {
  return mixBits(a * 0x9e3779b97f4a7c15ull + b + 1);
}

/// Scrambles all 32 bits by hash-based Owen scrambling (Burley 2020, Practical Hash-based Owen Scrambling,
/// JCGT 9(4), section 3, with the permutation of Laine and Karras 2011).
inline uint32_t owenScramble(uint32_t x, uint32_t seed) {
  x = reverseBits(x);
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverseBits(x);
}

/// Returns the second Sobol dimension of index i (the first is reverseBits(i)).
inline uint32_t sobolSecond(uint32_t i) {
  uint32_t result = 0;
  for (uint32_t direction = 1u << 31; i != 0; i >>= 1, direction ^= direction >> 1)
    if (i & 1u) result ^= direction;
  return result;
}

/// Generates the random numbers of one pixel in one half of the samples: any pair of dimensions of any
/// sample, in any order.
class Sampler {
 public:
  Sampler(uint64_t seed, uint64_t pixel, uint32_t half) : seed_(combine(combine(seed, pixel), half)) {}

  void startSample(uint32_t index) { index_ = index; }

  /// Returns a point in [0, 1)^2; every pair is a scrambled and shuffled (0, 2)-sequence over the sample
  /// index.
  glm::vec2 pair(uint32_t number) const {
    const uint64_t bits = combine(seed_, number);
    const uint32_t i = owenScramble(index_, static_cast<uint32_t>(mixBits(bits)));
    return {toUnit(owenScramble(reverseBits(i), static_cast<uint32_t>(bits))),
            toUnit(owenScramble(sobolSecond(i), static_cast<uint32_t>(bits >> 32)))};
  }

 private:
  static float toUnit(uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

  uint64_t seed_;
  uint32_t index_ = 0;
};

/// Returns the random numbers of light path `path`, of one half of the samples. They belong to no pixel. A
/// sampler has numbers for 2^32 samples: each 2^32 paths have one of their own, so that none repeats another.
inline Sampler pathSampler(uint64_t seed, uint32_t half, uint64_t path) {
  Sampler sampler(seed, ~(path >> 32), half);
  sampler.startSample(static_cast<uint32_t>(path));
  return sampler;
}

}  // namespace limn::reference
