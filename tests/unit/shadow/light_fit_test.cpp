// Laws of the maps that lights have (core/shadow/light_fit.h).
#include "core/shadow/light_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "glsl/light/light_view.glsl"
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

/// However large the scene is: near planes are a part of the farthest that is lit.
TEST(LightFit, MapsFittedToTheViewEndWithTheRangeOfALight) {
  const std::vector<scene::Bounds> boxes{{vec3(-3, 0, -3), vec3(3, 0, 3)},
                                         {vec3(100, -50, 100), vec3(1e5f, 5e4f, 1e5f)}};
  glsl::Light lights[] = {test::rectangleLight({0, 2, 0}, {0, -1, 0}, 0.3f, 0.3f),
                          test::spotLight({0, 2, 0}, {0, -1, 0}, 0.9f), test::pointLight({0, 2, 0})};
  const ShadowMapDesc desc{.size = 64, .fit = MapFit::view};
  for (glsl::Light& light : lights) {
    SCOPED_TRACE(light.type);
    light.range = 3;
    std::vector<glsl::ShadowView> views;
    std::vector<glsl::ShadowLight> maps;
    appendViews(light, 0, fitLayout(light, boxes, desc), boxes, desc, nullptr, views, maps);
    ASSERT_EQ(views.size(), light.type == glsl::light_point ? 6u : 1u);
    int lit = 0;
    for (int i = 0; i < 100; ++i) {
      const vec3 p(0.5f * static_cast<float>(i % 10) - 2.25f, 0, 0.5f * static_cast<float>(i / 10) - 2.25f);
      if (glsl::light_view(light, p, {0, 1, 0}, -1).masked) continue;
      ++lit;
      const glsl::ShadowView& view = views[glsl::shadow_face(maps[0].faces, views[0], p)];
      const glsl::ShadowPoint q = glsl::shadow_project(view, p);
      EXPECT_TRUE(glsl::shadow_inside(q)) << i;
      EXPECT_GE(q.depth, view.near) << i;
      EXPECT_LE(q.depth, view.far) << i;
    }
    EXPECT_GT(lit, 20);
  }
}

}  // namespace
}  // namespace limn::shadow
