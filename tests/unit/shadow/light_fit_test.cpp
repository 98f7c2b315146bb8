// Laws of the maps that lights have (core/shadow/light_fit.h).
#include "core/shadow/light_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/test_scenes.h"

namespace limn::shadow {
namespace {

using glm::vec2;
using glm::vec3;

/// The cone is the centre's: seen from a point of the light aside of it, it is wider.
TEST(LightFit, MapsOfSamplesHoldWhatTheConeOfTheLightLights) {
  constexpr float halfAngle = 0.785f, height = 2;
  glsl::Light light = test::rectangleLight({0, height, 0}, {0, -1, 0}, 1, 1);
  light.flags = glsl::light_flag_cone;
  light.cos_inner = 1;
  light.cos_outer = std::cos(halfAngle);
  const std::vector<scene::Bounds> floor{{vec3(-4, 0, -4), vec3(4, 0, 4)}};
  const ShadowMapDesc desc{.samples = {vec2(0, 0.5f), vec2(1, 0.5f)}};
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> lights;
  appendViews(light, 0, fitLayout(light, floor, desc), floor, desc, nullptr, views, lights);
  ASSERT_EQ(views.size(), 2u);
  const float reach = 0.99f * height * std::tan(halfAngle);
  for (const glsl::ShadowView& view : views) {
    for (int i = 0; i < 16; ++i) {
      const float angle = 2 * glsl::pi * static_cast<float>(i) / 16;
      const vec3 receiver(reach * std::cos(angle), 0, reach * std::sin(angle));
      EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(view, receiver))) << angle;
    }
  }
}

/// At most a quarter wider than what it shows: two texels on each side are more than all of a map of few.
TEST(LightFit, MapsOfFewTexelsAreHardlyWiderThanWhatTheyShow) {
  const std::vector<scene::Bounds> box{{vec3(-0.5f), vec3(0.5f)}};
  const glsl::Light lights[] = {test::rectangleLight({0, 3, 0}, {0, -1, 0}, 0, 0),
                                test::spotLight({0, 3, 0}, {0, -1, 0}, 0.3f),
                                test::directionalLight({0, -1, 0}, 0)};
  for (const glsl::Light& light : lights) {
    const auto width = [&](int size) {
      const ShadowMapDesc desc{.size = size};
      std::vector<glsl::ShadowView> views;
      std::vector<glsl::ShadowLight> maps;
      appendViews(light, 0, fitLayout(light, box, desc), box, desc, nullptr, views, maps);
      return double(1 / views.at(0).scale);
    };
    const double exact = width(1 << 20);
    for (const int size : {1, 2, 3, 8, 15}) EXPECT_NEAR(width(size) / exact, 1.25, 1e-4) << size;
    for (const int size : {16, 256}) EXPECT_NEAR(width(size) / exact, 1 + 4.0 / size, 1e-4) << size;
  }
}

}  // namespace
}  // namespace limn::shadow
