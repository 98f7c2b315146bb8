// Laws of the parts of a light (glsl/light/light_part.glsl).
#include "glsl/light/light_part.glsl"

#include <gtest/gtest.h>

#include <random>

#include "core/shadow/light_fit.h"

namespace limn::glsl {
namespace {

Light rectangle() {
  Light light{};
  light.type = light_rectangle;
  light.position = {0.3f, 2, -0.4f};
  light.direction = {0, -1, 0};
  light.axis_u = {1, 0, 0};
  light.axis_v = {0, 0, 1};
  light.length_u = 1.2f;
  light.length_v = 0.5f;
  light.emission = vec3(1);
  light.own_instance = no_instance;
  return light;
}

Light disc(float diameter) {
  Light light{};
  light.type = light_directional;
  light.direction = normalize(vec3(0.3f, -1, 0.2f));
  light.angular_diameter = diameter;
  light.emission = vec3(1);
  light.own_instance = no_instance;
  return light;
}

/// A rectangle at distance 1 from every receiver.
Light distant() {
  Light light = rectangle();
  light.type = light_directional;
  light.position = {0, 1, 0};
  light.axis_v = {0, 0, -1};  // cross(axis_v, axis_u) points from the light
  return light;
}

TEST(LightPart, PartsOfARectangleTileIt) {
  const Light light = rectangle();
  for (const float size : {-1.f, 0.8f}) {
    const vec2 sides = light_sides(light, light_kind_rectangle, size);
    std::vector<vec2> corners;
    for (uint i = 0; i < 6; ++i) {
      const Light part = light_part(light, light_kind_rectangle, size, {3, 2}, i);
      EXPECT_NEAR(part.length_u, sides.x / 3, 1e-6f);
      EXPECT_NEAR(part.length_v, sides.y / 2, 1e-6f);
      const vec3 r = part.position - light.position;
      const vec2 low =
          (vec2(r.x - 0.5f * part.length_u, r.z - 0.5f * part.length_v) / sides + 0.5f) * vec2(3, 2);
      EXPECT_NEAR(low.x, float(i % 3), 1e-5f);
      EXPECT_NEAR(low.y, float(i / 3), 1e-5f);
    }
  }
}

TEST(LightPart, DiscsHaveTheSolidAngleAndTheSpreadOfTheWholeDisc) {
  for (const float diameter : {0.01f, 0.2f}) {
    const Light light = disc(diameter);
    const auto cap = [](float angle) { return 1 - std::cos(0.5 * double{angle}); };
    for (const uint n : {2u, 3u, 4u, 5u}) {
      double solid = 0, spread = 0;
      vec3 middle(0);
      for (uint i = 0; i < n * n; ++i) {
        const Light part = light_part(light, light_kind_disc, -1, uvec2(n), i);
        const double own = cap(part.angular_diameter);
        solid += own;
        middle += part.direction;
        // 1 - cosine from the axis, on average over the part: half of its cap more than at its centre.
        spread += 1 - dot(dvec3(part.direction), dvec3(light.direction)) + 0.5 * own;
      }
      EXPECT_NEAR(solid / cap(diameter), 1, 2e-3) << n;
      EXPECT_NEAR(spread / (n * n) / (0.5 * cap(diameter)), 1, 0.02) << n;
      EXPECT_NEAR(dot(normalize(middle), light.direction), 1, 1e-6f) << n;
    }
  }
}

TEST(LightPart, ShareIsThatOfThePointsAboveTheHorizon) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (const Light& light : {rectangle(), distant(), disc(1)}) {
    for (int trial = 0; trial < 40; ++trial) {
      const vec3 receiver(uniform(random), 0, uniform(random));
      // Nearly along the horizon of the light's centre.
      const vec3 to =
          light_kind(light) == light_kind_rectangle ? light.position - receiver : -light.direction;
      const vec3 aside = normalize(cross(to, vec3(uniform(random), uniform(random), uniform(random))));
      const vec3 normal = normalize(aside + 0.2f * uniform(random) * normalize(to));
      const LightView view = light_view(light, receiver, normal, -1);
      constexpr int cells = 128;
      int above = 0;
      for (int i = 0; i < cells * cells; ++i) {
        const vec2 u((float(i % cells) + 0.5f) / cells, (float(i / cells) + 0.5f) / cells);
        above += dot(light_view_point(view, u), normal) > 0;
      }
      // A disc is not quite flat.
      const float share = float(above) / (cells * cells);
      EXPECT_NEAR(light_view_share(view), share, view.cone ? 0.03f : 0.006f);
      if (view.masked) continue;
      const vec2 box = view.high - view.low;
      EXPECT_GE(light_view_box_share(view), view.cone ? 0 : 0.5f);
      if (box.x * box.y > 0.05f) {
        EXPECT_NEAR(light_view_box_share(view), share / (box.x * box.y), 0.13f);
      }
    }
  }
}

TEST(LightPart, LayoutsCutLightsInProportion) {
  scene::Bounds box;
  box.add(vec3(-2, -2, -2));
  box.add(vec3(2, 1, 2));
  const auto partsOf = [&](const Light& light, int views, float size = -1) {
    const shadow::ShadowMapDesc desc{.views = views, .lightSize = size};
    const shadow::LightLayout layout = shadow::fitLayout(light, {&box, 1}, desc);
    std::vector<ShadowView> maps;
    std::vector<ShadowLight> lights;
    shadow::appendViews(light, 0, layout, {&box, 1}, desc, nullptr, maps, lights);
    EXPECT_EQ(lights.size(), layout.parts());
    EXPECT_EQ(maps.size(), layout.parts() * shadow_face_count(layout.faces));
    return uvec2(layout.partsU, layout.partsV);
  };
  EXPECT_EQ(partsOf(rectangle(), 1), uvec2(1));
  EXPECT_EQ(partsOf(rectangle(), 2), uvec2(2, 1));
  EXPECT_EQ(partsOf(rectangle(), 5), uvec2(5, 3));
  EXPECT_EQ(partsOf(rectangle(), 2, 0.7f), uvec2(2));
  EXPECT_EQ(partsOf(disc(0.1f), 3), uvec2(3));
  EXPECT_EQ(partsOf(disc(0), 3), uvec2(1)) << "no extent";
  EXPECT_EQ(partsOf(rectangle(), 2, 0), uvec2(1)) << "taken for a point";
  // Chosen by the size in texels.
  EXPECT_EQ(partsOf(rectangle(), 0, 0.01f), uvec2(1));
  EXPECT_EQ(partsOf(rectangle(), 0, 1.5f), uvec2(2));
  EXPECT_EQ(partsOf(disc(0.009f), 0), uvec2(1)) << "the sun";
  EXPECT_EQ(partsOf(disc(0.3f), 0), uvec2(2));
  Light square = distant();
  square.flags = light_flag_environment;
  EXPECT_EQ(partsOf(square, 0), uvec2(1)) << "one of many";
}

/// Every receiver that the light's own view holds is held by a part's, and by all from an eighth of the depth
/// on.
TEST(LightPart, ViewsOfPartsHoldWhatTheLightsDoes) {
  scene::Bounds box;
  box.add(vec3(-3, -2, -3));
  box.add(vec3(3, 1.99f, 3));  // to the light's plane: its cone is all that limits the view
  Light light = rectangle();
  light.flags = light_flag_cone;
  light.cos_outer = std::cos(0.9f);
  light.cos_inner = 1;
  const shadow::ShadowMapDesc one{}, cut{.views = 2};
  std::vector<ShadowView> whole, views;
  std::vector<ShadowLight> lights;
  shadow::appendViews(light, 0, shadow::fitLayout(light, {&box, 1}, one), {&box, 1}, one, nullptr, whole,
                      lights);
  shadow::appendViews(light, 0, shadow::fitLayout(light, {&box, 1}, cut), {&box, 1}, cut, nullptr, views,
                      lights);
  ASSERT_EQ(whole.size(), 1u);
  ASSERT_EQ(views.size(), 2u);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  int near = 0, far = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 p(3 * uniform(random), 2 * uniform(random) - 0.001f, 3 * uniform(random));
    if (!shadow_inside(shadow_project(whole[0], p))) continue;
    const bool deep = light.position.y - p.y > 0.125f * whole[0].far;
    int held = 0;
    for (const ShadowView& view : views) held += shadow_inside(shadow_project(view, p));
    EXPECT_GE(held, deep ? 2 : 1);
    (deep ? far : near) += 1;
  }
  EXPECT_GT(near, 20);
  EXPECT_GT(far, 1000);
}

}  // namespace
}  // namespace limn::glsl
