// Which lights need no caustic rays (core/caustics/private/light_reach.h), against what lights send to
// places.
#include "core/caustics/private/light_reach.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "glsl/light/light_intensity.glsl"
#include "glsl/light/rectangle_light.glsl"

namespace limn::caustics {
namespace {

using glm::vec2;
using glm::vec3;
using scene::Bounds;

glsl::Light lightOf(uint32_t type, const vec3& direction) {
  glsl::Light light{};
  light.type = type;
  light.direction = direction;
  light.emission = vec3(1);
  light.own_instance = glsl::no_instance;
  const glsl::Frame frame = glsl::frame_around(-direction);
  light.axis_u = frame.t;
  light.axis_v = frame.b;
  return light;
}

void giveCone(glsl::Light& light, float halfAngle) {
  light.flags |= glsl::light_flag_cone;
  light.cos_inner = 1;
  light.cos_outer = std::cos(halfAngle);
}

Bounds cube(const vec3& centre, float half) {
  return {centre - half, centre + half};
}

bool reaches(const glsl::Light& light, const Bounds& box) {
  return mayReach(light, {&box, 1});
}

TEST(LightReach, NothingThatIsLitIsLeftOut) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform;
  const auto place = [&] { return vec3(normal(random), normal(random), normal(random)); };
  const auto inBox = [&](const Bounds& box) {
    return glm::mix(box.low, box.high, vec3(uniform(random), uniform(random), uniform(random)));
  };
  int lit = 0, leftOut = 0;
  for (const float scale : {1e-4f, 1.f, 1e4f})
    for (int i = 0; i < 3000; ++i) {
      glsl::Light light = lightOf(
          std::array{glsl::light_point, glsl::light_spot, glsl::light_rectangle}[static_cast<size_t>(i % 3)],
          glm::normalize(place()));
      light.position = scale * place();
      if (light.type == glsl::light_rectangle) {
        light.length_u = scale * uniform(random);
        light.length_v = scale * uniform(random);
        if (i % 4 == 0) light.flags |= glsl::light_flag_two_sided;
      }
      if (light.type == glsl::light_spot || i % 5 == 0) giveCone(light, 1.5f * uniform(random) + 0.01f);
      if (i % 7 == 0) light.range = 3 * scale * uniform(random) + 1e-3f * scale;
      const vec3 corner = 2.f * place();
      const Bounds box{scale * corner,
                       scale * (corner + vec3(uniform(random), uniform(random), i % 2 ? 0 : 1))};
      bool any = false;
      for (int k = 0; k < 30; ++k) {
        const vec3 origin = glsl::rectangle_point(light, vec2(uniform(random), uniform(random)) - 0.5f);
        any |= glsl::light_point_intensity(light, origin, inBox(box), 1) != vec3(0);
      }
      lit += any;
      leftOut += !reaches(light, box);
      EXPECT_TRUE(!any || reaches(light, box)) << scale << " " << i;
    }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(leftOut, 1000);
}

TEST(LightReach, ConesEndAtTheirSides) {
  glsl::Light spot = lightOf(glsl::light_spot, {0, 0, 1});
  giveCone(spot, 0.5f);
  const float radius = 0.1f * std::sqrt(3.f), spread = std::asin(radius / 2);
  const auto aside = [](float angle) { return cube(2.f * vec3(std::sin(angle), 0, std::cos(angle)), 0.1f); };
  EXPECT_TRUE(reaches(spot, aside(0.45f)));
  EXPECT_TRUE(reaches(spot, aside(0.5f + spread - 0.001f)));
  EXPECT_FALSE(reaches(spot, aside(0.5f + spread + 0.001f)));
  EXPECT_FALSE(reaches(spot, aside(3.14159f)));
  EXPECT_TRUE(reaches(spot, cube(vec3(0, 0, -0.05f), 0.1f))) << "it lies in the box";
}

TEST(LightReach, RangesEndIt) {
  glsl::Light point = lightOf(glsl::light_point, {0, 0, 1});
  EXPECT_TRUE(reaches(point, cube({0, 0, -100}, 0.1f)));
  point.range = 3;
  EXPECT_TRUE(reaches(point, cube({0, 3.1f, 0}, 0.1f)));
  EXPECT_FALSE(reaches(point, cube({0, 3.2f, 0}, 0.1f)));
}

TEST(LightReach, RectanglesShineToOneSideOrToBoth) {
  glsl::Light rectangle = lightOf(glsl::light_rectangle, {0, 0, 1});
  rectangle.length_u = rectangle.length_v = 1;
  EXPECT_TRUE(reaches(rectangle, cube({5, 0, -0.1f}, 0.1f)));
  EXPECT_FALSE(reaches(rectangle, cube({5, 0, -0.2f}, 0.1f)));
  rectangle.flags |= glsl::light_flag_two_sided;
  EXPECT_TRUE(reaches(rectangle, cube({5, 0, -0.2f}, 0.1f)));
}

TEST(LightReach, TheSunReachesAllAndNothingReachesNoBox) {
  const glsl::Light sun = lightOf(glsl::light_directional, {0, 0, 1});
  EXPECT_TRUE(reaches(sun, cube({0, 0, -100}, 0.1f)));
  EXPECT_FALSE(mayReach(sun, {}));
}

TEST(LightReach, OneBoxOfSeveralIsEnough) {
  glsl::Light spot = lightOf(glsl::light_spot, {0, 0, 1});
  giveCone(spot, 0.5f);
  const std::array boxes{cube({0, 0, -2}, 0.1f), cube({0, 0, 2}, 0.1f)};
  EXPECT_TRUE(mayReach(spot, boxes));
  EXPECT_FALSE(mayReach(spot, {&boxes[0], 1}));
}

}  // namespace
}  // namespace limn::caustics
