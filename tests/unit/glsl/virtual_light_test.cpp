// Laws of what virtual lights are made from (glsl/numeric/halton.glsl, glsl/indirect/reflective_map.glsl).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "glsl/indirect/reflective_map.glsl"
#include "glsl/numeric/halton.glsl"

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
  v.axis_x = vec3(1, 0, 0);
  v.scale = scale;
  v.axis_y = vec3(0, 1, 0);
  v.axis_z = vec3(0, 0, -1);
  v.far = 10;
  v.middle = vec2(0.5f, 0.5f);
  v.projection = kind;
  v.size = 64;
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

Light rectangle(float u, float v) {
  Light light{};
  light.direction = vec3(0, 0, -1);
  light.axis_u = vec3(1, 0, 0);
  light.length_u = u;
  light.axis_v = vec3(0, 1, 0);
  light.length_v = v;
  light.emission = vec3(3, 0, 0);
  light.type = light_rectangle;
  light.own_instance = no_instance;
  return light;
}

float fromRectangle(const Light& light, vec3 p, vec3 n, int samples) {
  return reflective_map_rectangle_intensity(light, vec3(0), p, n, samples).x;
}

/// Of radiance 3 and 1e-6 square metres.
TEST(ReflectiveMap, SmallRectanglesAreLambertianSenders) {
  Light light = rectangle(2e-3f, 0.5e-3f);
  const vec3 below = 2.f * vec3(0.6f, 0, -0.8f), above(0, 0, 1);
  const vec3 facing = normalize(vec3(0.2f, 0.3f, 1));
  EXPECT_NEAR(fromRectangle(light, below, facing, 1), 3e-6 * 0.8, 3e-11);
  EXPECT_NEAR(fromRectangle(light, below, facing, 4), 3e-6 * 0.8 / 4, 1e-11);
  EXPECT_EQ(fromRectangle(light, above, -facing, 1), 0);
  EXPECT_EQ(fromRectangle(light, vec3(0), facing, 1), 0);
  light.flags = light_flag_two_sided;
  EXPECT_NEAR(fromRectangle(light, above, vec3(0, 0, -1), 1), 3e-6, 3e-11);
}

/// A surface as close as one likes to a rectangle as wide as one likes gets pi times its radiance.
TEST(ReflectiveMap, LargeRectanglesGiveNoMoreThanTheirRadiance) {
  for (const float height : {1.f, 1e-3f}) {
    const float intensity =
        fromRectangle(rectangle(2e4f, 2e4f), vec3(0.1f * height, 0, -height), vec3(0, 0, 1), 1);
    const float d2 = 1.01f * height * height;
    EXPECT_NEAR(intensity / d2 * height / std::sqrt(d2), 3 * pi, 0.01f) << height;
  }
}

TEST(ReflectiveMap, SurfacesSeenEdgeOnStayFinite) {
  const float edgeOn = fromRectangle(rectangle(2, 2), vec3(0, 0, -1), vec3(1, 0, 1e-7f), 1);
  EXPECT_TRUE(std::isfinite(edgeOn));
  EXPECT_GE(edgeOn, 0);
}

TEST(ReflectiveMap, PointsHaveNoExtentToSample) {
  Light light = rectangle(0, 0);
  light.type = light_point;
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, vec3(0, 0, 1), 4).x, 3);
  light.type = light_directional;
  light.angular_diameter = 0.1f;
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, vec3(0, 0, 1), 4).x, 0.75f);
}

}  // namespace
}  // namespace limn::glsl
