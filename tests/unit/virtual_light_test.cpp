// Laws of what virtual lights are made from (glsl/halton.glsl, glsl/reflective_map.glsl).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "glsl/halton.glsl"
#include "glsl/reflective_map.glsl"

namespace limn::glsl {
namespace {

TEST(Halton, DigitsAreMirrored) {
  EXPECT_FLOAT_EQ(radical_inverse(2, 1), 0.5f);
  EXPECT_FLOAT_EQ(radical_inverse(2, 6), 0.375f);   // 110 -> 0.011
  EXPECT_FLOAT_EQ(radical_inverse(3, 5), 7 / 9.f);  // 12 -> 0.21
  EXPECT_FLOAT_EQ(radical_inverse(5, 0), 0);
  for (uint32_t i = 0; i < 1u << 20; i += 37)
    for (const uint32_t base : {2u, 3u, 5u}) {
      EXPECT_GE(radical_inverse(base, i), 0);
      EXPECT_LT(radical_inverse(base, i), 1);
    }
}

TEST(Halton, ConsecutivePointsLieOneInEachCell) {
  for (const uint32_t first : {0u, 1u, 123u, 65000u}) {
    std::set<std::array<int, 3>> cells;
    for (uint32_t i = first; i < first + 4 * 9 * 5; ++i) {
      const vec3 p = halton_point(i);
      cells.insert(
          {static_cast<int>(4 * p.x), static_cast<int>(9 * p.y + 1e-4f), static_cast<int>(5 * p.z + 1e-4f)});
    }
    EXPECT_EQ(cells.size(), 4u * 9u * 5u) << first;
  }
}

ShadowView view(uint32_t kind, float scale) {
  ShadowView v{};
  v.axis_x = vec4(1, 0, 0, scale);
  v.axis_y = vec4(0, 1, 0, 0);
  v.axis_z = vec4(0, 0, -1, 10);
  v.info = uvec4(kind, 0, 64, 0);
  return v;
}

TEST(ReflectiveMap, MeasureOfAMapIsItsSolidAngleOrArea) {
  for (const float tangent : {0.1f, 1.f, 3.7f}) {
    double sum = 0;
    const ShadowView v = view(shadow_perspective, 0.5f / tangent);
    constexpr uint32_t n = 200000;
    for (uint32_t i = 0; i < n; ++i) {
      const vec3 p = halton_point(i);
      sum += reflective_map_measure(v, vec2(p.x, p.y));
    }
    const double exact = 4 * std::asin(tangent * tangent / (1.0 + tangent * tangent));
    EXPECT_NEAR(sum / n / exact, 1, 2e-4) << tangent;
  }
  EXPECT_FLOAT_EQ(reflective_map_measure(view(shadow_orthographic, 0.25f), vec2(0.3f)), 16);
}

TEST(ReflectiveMap, RectanglesAreLambertianSenders) {
  Light light{};
  light.direction = vec4(0, 0, -1, 0);
  light.axis_u = vec4(1, 0, 0, 2);
  light.axis_v = vec4(0, 1, 0, 0.5f);
  light.emission = vec4(3, 0, 0, 0);
  light.info = uvec4(light_rectangle, 0, no_instance, 0);
  const vec3 origin(0.5f, 0.1f, 0);
  const vec3 below = origin + 2.f * vec3(0.6f, 0, -0.8f), above = origin + vec3(0, 0, 1);
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, origin, below, 1).x, 3 * 0.8f);
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, origin, below, 4).x, 3 * 0.8f / 4);
  EXPECT_EQ(reflective_map_intensity(light, origin, above, 1).x, 0);
  EXPECT_EQ(reflective_map_intensity(light, origin, origin, 1).x, 0);
  light.info.y = light_flag_two_sided;
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, origin, above, 1).x, 3);
  light.info = uvec4(light_point, 0, no_instance, 0);
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, origin, above, 4).x, 3) << "no extent: no samples";
}

}  // namespace
}  // namespace limn::glsl
