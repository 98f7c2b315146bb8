// Colours with a shared exponent: what OpenGL's RGB9E5 is.
#include "glsl/numeric/shared_exponent.glsl"

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

TEST(SharedExponent, IsWithinHalfAStep) {
  Random random(8);
  for (int i = 0; i < 20000; ++i) {
    const float size = std::exp2(random(-6, 15));
    const vec3 colour = size * vec3(random(0.01f, 1), random(0, 1), random(0, 1));
    const float largest = max(colour.x, max(colour.y, colour.z));
    const vec3 kept = shared_exponent_decode(shared_exponent_encode(colour));
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(kept[c], colour[c], largest / 511) << size;
  }
}

TEST(SharedExponent, KeepsWhatItHolds) {
  Random random(8);
  for (int i = 0; i < 20000; ++i) {
    const auto bits = static_cast<uint>(random.engine());
    const vec3 colour = shared_exponent_decode(bits);
    ASSERT_EQ(colour, unpackF3x9_E1x5(bits));
    ASSERT_EQ(shared_exponent_decode(shared_exponent_encode(colour)), colour);
  }
}

TEST(SharedExponent, ClampsAndCarries) {
  EXPECT_EQ(shared_exponent_encode(vec3(0)), 0u);
  EXPECT_EQ(shared_exponent_encode(vec3(-1)), 0u);
  EXPECT_EQ(shared_exponent_decode(shared_exponent_encode(vec3(1e9f))), vec3(shared_exponent_max));
  // Rounds up to the next power of two.
  EXPECT_EQ(shared_exponent_decode(shared_exponent_encode(vec3(0.9999f, 0, 0))), vec3(1, 0, 0));
  EXPECT_EQ(shared_exponent_decode(shared_exponent_encode(vec3(1, 0.5f, 0.25f))), vec3(1, 0.5f, 0.25f));
}

}  // namespace
}  // namespace limn::glsl
