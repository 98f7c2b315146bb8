// A small counter-based generator, so that a scene has the same bytes wherever it is made.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace limn::assets {

class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed * 747796405u + 2891336453u) {}

  /// Uniform in [0, 1). PCG-RXS-M-XS (O'Neill 2014).
  float uniform() {
    state_ = state_ * 747796405u + 2891336453u;
    const std::uint32_t word = ((state_ >> ((state_ >> 28u) + 4u)) ^ state_) * 277803737u;
    return static_cast<float>(((word >> 22u) ^ word) >> 8u) * 0x1p-24f;
  }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }

 private:
  std::uint32_t state_;
};

}  // namespace limn::assets
