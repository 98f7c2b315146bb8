// Random numbers and directions, the same in every run.
#pragma once

#include <random>

#include "glsl/numeric/geometry.glsl"

namespace limn::glsl {

struct Random {
  std::mt19937 engine;

  explicit Random(unsigned seed) : engine(seed) {}

  float operator()(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine); }

  /// Uniform on the sphere.
  vec3 direction() {
    std::normal_distribution<float> normal;
    return normalize(vec3(normal(engine), normal(engine), normal(engine)));
  }
};

}  // namespace limn::glsl
