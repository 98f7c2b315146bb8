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
  return reflective_map_rectangle_intensity(light, -p, p, n, samples).x;
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

/// The face of a cube, seen from its middle over a solid angle of 2 pi / 3, gives a surface that faces it pi
/// F per radiance, with the form factor F = 4 / pi sqrt(1/2) atan(sqrt(1/2)) of a square half its side away
/// (Lambert 1760), and one that is tilted and sees the whole of it, by symmetry, the cosine times as much.
TEST(ReflectiveMap, DistantRectanglesGiveTheirExactIrradiance) {
  Light light = rectangle(2, 2);
  light.type = light_directional;
  light.position = vec3(0, 0, 1);
  light.flags = light_flag_environment;
  light.solid_angle = 2 * pi / 3;
  ASSERT_TRUE(reflective_map_is_rectangle(light));
  const double factor = 4 / double(pi) * std::sqrt(0.5) * std::atan(std::sqrt(0.5));
  const double facing = 3 * double(pi) * factor / (2 * double(pi) / 3);
  for (const float tilt : {0.f, 0.5f})
    for (const int samples : {1, 4}) {
      const vec3 n(std::sin(tilt), 0, std::cos(tilt));
      const double given =
          reflective_map_rectangle_intensity(light, vec3(0, 0, 1), vec3(7, 8, 9), n, samples).x;
      EXPECT_NEAR(given * samples / facing, 1, 1e-5) << tilt;
    }
  light.flags |= light_flag_centre;
  EXPECT_FALSE(reflective_map_is_rectangle(light)) << "it is reflected as one direction";
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, vec3(7, 8, 9), 1).x, 3);
}

TEST(ReflectiveMap, PointsHaveNoExtentToSample) {
  Light light = rectangle(0, 0);
  light.type = light_point;
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, vec3(0, 0, 1), 4).x, 3);
  light.type = light_directional;
  EXPECT_FLOAT_EQ(reflective_map_intensity(light, vec3(0, 0, 1), 4).x, 3);
}

/// The directions to a disc, even in solid angle, have the mean cosine (1 + cos a) / 2 to its middle, a half
/// its angle: with it together they give a surface that faces it the light's irradiance.
TEST(ReflectiveMap, DirectionsToADiscGiveItsIrradianceTogether) {
  Light light = rectangle(0, 0);
  light.type = light_directional;
  for (const float diameter : {0.1f, 1.f, 2.5f}) {
    light.angular_diameter = diameter;
    const double mean = 0.5 * (1 + std::cos(0.5 * double(diameter)));
    EXPECT_FLOAT_EQ(reflective_map_intensity(light, vec3(0, 0, 1), 1).x, 3) << "all of it from its middle";
    EXPECT_NEAR(4 * double(reflective_map_intensity(light, vec3(0, 0, 1), 4).x) * mean, 3, 1e-5) << diameter;
  }
}

}  // namespace
}  // namespace limn::glsl
