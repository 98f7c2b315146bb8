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

/// Scrambles all 32 bits of the number whose bits in reverse order are `reversed`, by hash-based Owen
/// scrambling (Burley 2020, Practical Hash-based Owen Scrambling, JCGT 9(4), section 3, with the permutation
/// of Laine and Karras 2011).
inline uint32_t owenScramble(uint32_t reversed, uint32_t seed) {
  uint32_t x = reversed + seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverseBits(x);
}

/// Returns the second Sobol dimension of index i with its bits in reverse order (the first is i itself in
/// that order). Bit j is the sum modulo 2 of those bits k of i for which the binomial coefficient of k over j
/// is odd: where k has all bits of j (Lucas 1878). Summed over one bit of j and k at a time.
inline uint32_t sobolSecondReversed(uint32_t i) {
  i ^= i >> 16;
  i ^= (i >> 8) & 0x00ff00ffu;
  i ^= (i >> 4) & 0x0f0f0f0fu;
  i ^= (i >> 2) & 0x33333333u;
  return i ^ ((i >> 1) & 0x55555555u);
}

/// Generates the random numbers of one pixel in one half of the samples: any pair of dimensions of any
/// sample, in any order.
class Sampler {
 public:
  Sampler(uint64_t seed, uint64_t pixel, uint32_t half) : seed_(combine(combine(seed, pixel), half)) {}

  void startSample(uint32_t index) { reversedIndex_ = reverseBits(index); }

  /// Returns a point in [0, 1)^2; every pair is a scrambled and shuffled (0, 2)-sequence over the sample
  /// index.
  glm::vec2 pair(uint32_t number) const {
    const uint64_t bits = combine(seed_, number);
    const uint32_t i = owenScramble(reversedIndex_, static_cast<uint32_t>(mixBits(bits)));
    return {toUnit(owenScramble(i, static_cast<uint32_t>(bits))),
            toUnit(owenScramble(sobolSecondReversed(i), static_cast<uint32_t>(bits >> 32)))};
  }

 private:
  static float toUnit(uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

  uint64_t seed_;
  uint32_t reversedIndex_ = 0;  ///< of the sample: its bits in reverse order
};

/// Returns the random numbers of light path `path`, of one half of the samples. They belong to no pixel. A
/// sampler has numbers for 2^32 samples: each 2^32 paths have one of their own, so that none repeats another.
inline Sampler pathSampler(uint64_t seed, uint32_t half, uint64_t path) {
  Sampler sampler(seed, ~(path >> 32), half);
  sampler.startSample(static_cast<uint32_t>(path));
  return sampler;
}

}  // namespace limn::reference
