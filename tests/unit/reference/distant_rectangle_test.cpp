// Distant rectangles: the limit of rectangle lights that grow with their distance.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/scene/private/world_light.h"
#include "core/shadow/light_fit.h"
#include "glsl/light/light_view.glsl"
#include "glsl/light/unshadowed_light.glsl"
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/shadow_kernel.glsl"

namespace limn {
namespace {

using glm::vec2;
using glm::vec3;

/// A part of the cube's face +z, off its middle, turned by the environment's rotation.
glsl::Light distant(vec2 centre, vec2 sides, float rotation = 0) {
  scene::DistantRectangle r;
  r.centre = vec3(centre, 1);
  r.sides = sides;
  r.irradiance = vec3(1, 2, 3);
  scene::Environment e;
  e.rotation = rotation;
  return scene::distantLight(r, e);
}

/// The same directions from the origin, from a rectangle at distance `far`.
glsl::Light nearby(const glsl::Light& light, float far) {
  glsl::Light r = light;
  r.type = glsl::light_rectangle;
  r.flags = 0;
  r.own_instance = glsl::no_instance;
  r.index = 0;
  r.position = far * light.position;
  r.direction = -glm::cross(light.axis_u, light.axis_v);
  r.texture_number = 0;
  r.length_u *= far;
  r.length_v *= far;
  r.emission = glsl::rectangle_radiance(light);
  r.solid_angle = 0;
  return r;
}

vec3 randomUnit(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(DistantRectangle, ViewsAreTheLimitOfDistantRectangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    const glsl::Light light = distant(vec2(unit(random), unit(random)) - 0.5f,
                                      0.2f + vec2(unit(random), unit(random)), 6 * unit(random));
    const glsl::Light far = nearby(light, 1e3f);
    const vec3 normal = randomUnit(random), receiver = 0.01f * randomUnit(random);
    const glsl::LightView a = glsl::light_view(light, receiver, normal, -1),
                          b = glsl::light_view(far, receiver, normal, -1);
    ASSERT_EQ(a.masked, b.masked);
    EXPECT_EQ(a.whole, b.whole);
    EXPECT_FALSE(a.cone);
    EXPECT_LT(glm::length(a.axis - b.axis), 1e-5f);
    const vec2 u(unit(random), unit(random));
    EXPECT_LT(glm::length(glsl::light_view_point(a, u) - glsl::light_view_point(b, u)), 1e-3f);
    EXPECT_NEAR(glm::dot(a.axis, glsl::light_view_point(a, u)), -1, 1e-5);
    vec3 slopeA, slopeB;
    EXPECT_EQ(glsl::light_view_sample(a, u, slopeA), glsl::light_view_sample(b, u, slopeB));
    EXPECT_LT(glm::length(slopeA - slopeB), 2e-3f);
    EXPECT_TRUE(glsl::light_view_contains(a, slopeA, 1e-4f));
  }
}

TEST(DistantRectangle, ReflectsAsARectangleFarAway) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    const glsl::Light light =
        distant(vec2(unit(random), unit(random)) - 0.5f, 0.2f + vec2(unit(random), unit(random)));
    const glsl::Light far = nearby(light, 1e3f);
    const glsl::SurfaceBrdf surface =
        glsl::surface_brdf(vec3(0.5f), unit(random), unit(random), 1, vec3(1), 1.5f);
    const vec3 n = randomUnit(random);
    vec3 v = randomUnit(random);
    if (glm::dot(v, n) < 0) v = -v;
    const vec3 a = glsl::unshadowed_light(light, surface, vec3(0), n, n, v),
               b = glsl::unshadowed_light(far, surface, vec3(0), n, n, v);
    EXPECT_LT(glm::length(a - b), 1e-4f * glm::length(b) + 1e-6f);
  }
}

TEST(DistantRectangle, EmissionIsItsIrradianceHeadOn) {
  const glsl::Light light = distant(vec2(0), vec2(0.01f));
  EXPECT_NEAR(light.solid_angle, 1e-4, 1e-8);
  const glsl::Rectangle r = glsl::rectangle_from(light, vec3(5, 6, 7));
  EXPECT_NEAR(glsl::rectangle_irradiance(r, vec3(0, 0, 1)) * glsl::rectangle_radiance(light).z, 3, 1e-3);
}

TEST(DistantRectangle, SizeZeroIsASingleDirection) {
  const glsl::Light light = distant(vec2(0.3f, 0.1f), vec2(0.5f));
  const glsl::LightView view = glsl::light_view(light, vec3(1, 2, 3), vec3(0, 0, 1), 0);
  EXPECT_FALSE(view.extended);
  EXPECT_FALSE(view.masked);
  EXPECT_TRUE(glsl::light_view(light, vec3(1, 2, 3), vec3(0, 0, -1), 0).masked);
  EXPECT_LT(glm::length(glm::normalize(view.centre) + light.direction), 1e-6f);
}

// The kernel is the box with the second moments of what the light's directions make in the map.
TEST(DistantRectangle, KernelsHaveTheMomentsOfTheLight) {
  const std::vector<scene::Bounds> boxes{{vec3(-1), vec3(1)}};
  for (const vec2 centre : {vec2(0), vec2(0.4f, 0), vec2(0.6f, 0.6f)}) {
    const glsl::Light light = distant(centre, vec2(0.4f, 0.6f), 0.3f);
    std::vector<glsl::ShadowView> views;
    std::vector<glsl::ShadowLight> lights;
    const shadow::ShadowMapDesc desc{.size = 512};
    const shadow::LightLayout layout = shadow::fitLayout(light, boxes, desc);
    ASSERT_EQ(layout.projection, glsl::shadow_orthographic);
    shadow::appendViews(light, 0, layout, boxes, desc, nullptr, views, lights);
    ASSERT_EQ(views.size(), 1u);
    const glsl::ShadowView& map = views[0];
    EXPECT_NEAR(glm::dot(map.axis_x, map.axis_y), 0, 1e-6);
    EXPECT_LT(glm::length(glm::cross(map.axis_x, map.axis_y) + map.axis_z), 1e-5f);
    const vec3 receiver(0.1f, -0.2f, 0.3f);
    const glsl::LightView view = glsl::light_view(light, receiver, -light.direction, -1);
    glsl::ShadowKernel kernel;
    const float gap = 0.4f;
    ASSERT_TRUE(glsl::shadow_kernel(map, view, receiver, gap, true, glsl::least_kernel_width, kernel));
    glm::dvec2 sum(0), squares(0);
    const int count = 20000;
    for (uint32_t i = 0; i < count; ++i) {
      const vec3 slope = glsl::light_view_point(view, glsl::r2_sequence(i));
      const glm::dvec2 texel(512.f * glsl::shadow_project(map, receiver + gap * slope).uv);
      sum += texel;
      squares += texel * texel;
    }
    const glm::dvec2 mean = sum / double(count), variance = squares / double(count) - mean * mean;
    for (int c = 0; c < 2; ++c) {
      const double side = double(kernel.high[c]) - double(kernel.low[c]);
      EXPECT_NEAR(0.5 * (double(kernel.high[c]) + double(kernel.low[c])), mean[c], 0.05);
      EXPECT_NEAR(side * side / 12, variance[c], 0.01 * variance[c]);
    }
  }
}

}  // namespace
}  // namespace limn
