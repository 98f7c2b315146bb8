// Laws of maps fitted to what the camera sees (core/shadow/private/window_fit.h).
#include "core/shadow/private/window_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <vector>

#include "core/scene/camera.h"
#include "core/shadow/light_fit.h"
#include "glsl/light/light_view.glsl"
#include "tests/support/test_scenes.h"
#include "tests/unit/shadow/window_fits.h"

namespace limn::shadow {
namespace {

using namespace limn::test;
using glm::vec2;
using glm::vec3;

class WindowFit : public ::testing::TestWithParam<int> {
 protected:
  glsl::Light light() const {
    switch (GetParam()) {
      case 0:
        return rectangleLight({-2.5f, 6.5f, 1}, {0.3f, -1, -0.1f}, 0.8f, 0.6f);
      case 1:
        return spotLight({-2.5f, 3.8f, 1}, {0.6f, -1, -0.2f}, 0.9f);
      case 2:
        return directionalLight({0.3f, -1, 0.2f}, 0.2f);
      default:
        return rectangleLight({0.5f, 5, 0}, {0, -1, 0}, 2.5f, 2.5f);
    }
  }
};

TEST_P(WindowFit, HoldsEveryReceiverAndWhatBlocksIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  const glsl::Light l = light();
  int receivers = 0, blockers = 0, smaller = 0;
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const Cloud cloud(seed);
    VisibleScene visible(cloud.scene);
    const scene::CameraPose camera = scene::lookAt({3 * uniform(random) - 1.5f, 0.6f + uniform(random), 3.5f},
                                                   {uniform(random), 0.2f, 0}, 0.5f);
    visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
    const Fitted whole = fit(cloud, l, {.size = 256}, &visible);
    const Fitted cut = fit(cloud, l, {.size = 256, .fit = MapFit::view}, &visible);
    std::vector<vec2> points;
    for (int i = 0; i < 8; ++i) points.emplace_back(uniform(random), uniform(random));
    const Fitted many = fit(cloud, l, {.size = 256, .samples = points, .fit = MapFit::view}, &visible);
    ASSERT_EQ(whole.views.size(), 1u);
    ASSERT_EQ(cut.views.size(), 1u);
    EXPECT_LE(sideOf(cut.views[0]), sideOf(whole.views[0]) * 1.0001f);
    if (sideOf(cut.views[0]) < 0.9f * sideOf(whole.views[0])) ++smaller;
    for (int i = 0; i < 4000; ++i) {
      const auto& t = cloud.triangles[i % 8 == 0 ? static_cast<size_t>(i / 8) % 2
                                                 : static_cast<size_t>(i) % cloud.triangles.size()];
      const float a = std::sqrt(uniform(random)), b = uniform(random);
      const vec3 p = t[0] + a * (1 - b) * (t[1] - t[0]) + a * b * (t[2] - t[0]);
      if (!seenBy(camera, 1.3f, p)) continue;
      if (!glsl::shadow_inside(glsl::shadow_project(whole.views[0], p))) continue;
      ++receivers;
      EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(cut.views[0], p)));
      for (const glsl::ShadowView& view : many.views)
        EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(view, p)));
      const glsl::LightView seen = glsl::light_view(l, p, {0, 1, 0}, -1);
      if (seen.masked) continue;
      const vec3 slope = glsl::light_view_point(seen, {uniform(random), uniform(random)});
      const vec3 end = p + slope * (seen.cone ? 20.f : seen.depth);
      for (const auto& blocker : cloud.triangles) {
        const std::optional<vec3> at = hit(blocker, p + 1e-3f * (end - p), end);
        if (!at || !glsl::shadow_inside(glsl::shadow_project(whole.views[0], *at))) continue;
        ++blockers;
        const glsl::ShadowPoint q = glsl::shadow_project(cut.views[0], *at);
        EXPECT_TRUE(glsl::shadow_inside(q)) << q.uv.x << " " << q.uv.y;
        EXPECT_GE(q.depth, cut.views[0].near);
      }
    }
  }
  EXPECT_GT(receivers, 500);
  EXPECT_GT(blockers, GetParam() == 1 ? 5 : 20);
  EXPECT_GE(smaller, 3);
}

TEST_P(WindowFit, StaysWhatItIsWhileTheCameraMovesLittle) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  std::optional<Fitted> before;
  int changes = 0;
  for (int i = 0; i < 50; ++i) {
    const float x = 0.001f * static_cast<float>(i);
    visible.update(cloud.pose, cloud.boxes, scene::lookAt({x, 1.2f, 3.5f}, {x, 0.2f, 0}, 0.5f), 1.3f);
    const Fitted now = fit(cloud, light(), {.size = 256, .fit = MapFit::view}, &visible);
    if (before && std::memcmp(&now.views[0], &before->views[0], sizeof(glsl::ShadowView)) != 0) ++changes;
    before = now;
  }
  EXPECT_LE(changes, 6);
}

TEST_P(WindowFit, ScalesWithTheScene) {
  const Cloud cloud(1);
  const scene::CameraPose camera = scene::lookAt({0, 1.2f, 3.5f}, {0, 0.2f, 0}, 0.5f);
  VisibleScene visible(cloud.scene);
  visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
  const glsl::ShadowView one = fit(cloud, light(), {.size = 256, .fit = MapFit::view}, &visible).views[0];
  for (const float scale : {1e-3f, 1e3f}) {
    const Cloud scaled = scaledBy(cloud, scale);
    visible.update(scaled.pose, scaled.boxes,
                   scene::lookAt(scale * vec3(0, 1.2f, 3.5f), scale * vec3(0, 0.2f, 0), 0.5f), 1.3f);
    glsl::Light l = light();
    for (int i = 0; i < 3; ++i) l.position[i] *= scale;
    if (l.type == glsl::light_rectangle) {
      l.length_u *= scale;
      l.length_v *= scale;
    }
    const glsl::ShadowView view = fit(scaled, l, {.size = 256, .fit = MapFit::view}, &visible).views[0];
    EXPECT_NEAR(view.middle.x, one.middle.x, 1e-3f);
    EXPECT_NEAR(view.near / scale, one.near, 1e-3f * one.near);
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, WindowFit, ::testing::Range(0, 4));

/// The square that stands for a spot faces the receiver: seen from one aside of the axis, a part of it lies
/// behind the spot, and what blocks there lies farther out in the map than beside it.
TEST(FitWindow, HoldsWhatBlocksBesideALightThatFacesTheReceiver) {
  const vec3 receiver(-8, 0, 4);
  for (const float size : {0.25f, 0.5f, 2.f, 6.f}) {
    const vec3 point =
        size * glm::normalize(vec3(-1, 0, -2));  // of the light, across the way to the receiver
    const float along = (0.2f - point.z) / (receiver.z - point.z);
    const vec3 blocker = point + along * (receiver - point);
    scene::Scene scene;
    scene::Pose pose;
    addMesh(scene, floorPrimitive(0.01f, addMaterial(scene)));
    std::vector<scene::Bounds> boxes;
    for (const vec3& place : {receiver, blocker}) {
      addInstance(scene, pose, 0, glm::translate(glm::mat4(1), place));
      boxes.push_back({place - vec3(0.01f, 0, 0.01f), place + vec3(0.01f, 0, 0.01f)});
    }
    VisibleScene visible(scene);
    visible.update(pose, boxes, scene::lookAt(receiver + vec3(0, 0.2f, 0.2f), receiver, 0.5f), 1);
    const MapEye eye{vec3(0), {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, true, vec3(size)};
    MapWindow window;
    std::vector<vec3> receivers;
    ASSERT_TRUE(
        fitWindow(eye, visible, glsl::no_instance, {vec2(-1e3f), vec2(1e3f), 0.01f, 20}, window, receivers));
    EXPECT_LE(window.low.x, blocker.x / blocker.z) << size;
    EXPECT_LE(window.near, blocker.z) << size;
    EXPECT_GE(window.high.x, receiver.x / receiver.z);
  }
}

TEST(WindowFitOf, CubesAndWhatSeesEverythingCoversTheScene) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  visible.update(cloud.pose, cloud.boxes, scene::lookAt({0, 60, 1}, {0, 0, 0}, 1), 1);
  for (const glsl::Light& light : {pointLight({0, 5, 0}), directionalLight({0.3f, -1, 0.2f}, 0),
                                   rectangleLight({0, 30, 0}, {0, -1, 0}, 1, 1)}) {
    const Fitted whole = fit(cloud, light, {.size = 64}, &visible);
    const Fitted cut = fit(cloud, light, {.size = 64, .fit = MapFit::view}, &visible);
    ASSERT_EQ(cut.views.size(), whole.views.size());
    for (size_t i = 0; i < cut.views.size(); ++i)
      EXPECT_EQ(std::memcmp(&cut.views[i], &whole.views[i], sizeof(glsl::ShadowView)), 0);
  }
}

}  // namespace
}  // namespace limn::shadow
