// Laws of the faces of half cubes and cubes that are fitted to what the camera sees, and of maps of lights
// that shine on nothing of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <random>
#include <vector>

#include "core/scene/camera.h"
#include "core/shadow/light_fit.h"
#include "core/shadow/visible_scene.h"
#include "glsl/light/light_view.glsl"
#include "tests/support/test_scenes.h"
#include "tests/unit/shadow/window_fits.h"

namespace limn::shadow {
namespace {

using namespace limn::test;
using glm::vec2;
using glm::vec3;

/// The view of a light that sees p.
const glsl::ShadowView& viewOf(const Fitted& fitted, const glsl::ShadowLight& light, const vec3& p) {
  return fitted.views[light.first_layer + glsl::shadow_face(light.faces, fitted.views[light.first_layer], p)];
}

TEST(WindowFitOf, FacesOfSamplesHoldEveryReceiverAndWhatBlocksIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int kind = 0; kind < 3; ++kind) {
    const glsl::Light l = lightOfFaces(kind);
    int receivers = 0, blockers = 0;
    int smaller = 0;  // or empty
    for (uint32_t seed = 1; seed <= 6; ++seed) {
      const Cloud cloud(seed);
      VisibleScene visible(cloud.scene);
      const scene::CameraPose camera = scene::lookAt(
          {3 * uniform(random) - 1.5f, 0.6f + uniform(random), 3.5f}, {uniform(random), 0.2f, 0}, 0.5f);
      visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
      ShadowMapDesc desc{.size = 256, .fit = MapFit::view};
      for (int i = 0; i < 5; ++i) desc.samples.emplace_back(uniform(random), uniform(random));
      const Fitted cut = fit(cloud, l, desc, &visible);
      ASSERT_EQ(cut.views.size(), kind == 0 ? 25u : kind == 1 ? 6u : 30u);
      for (const glsl::ShadowView& view : cut.views)
        smaller += sideOf(view) < 1.8f || view.near >= 0.5f * view.far ? 1 : 0;
      for (int i = 0; i < 4000; ++i) {
        const auto& t = cloud.triangles[i % 8 == 0 ? static_cast<size_t>(i / 8) % 2
                                                   : static_cast<size_t>(i) % cloud.triangles.size()];
        const float a = std::sqrt(uniform(random)), b = uniform(random);
        const vec3 p = t[0] + a * (1 - b) * (t[1] - t[0]) + a * b * (t[2] - t[0]);
        if (!seenBy(camera, 1.3f, p)) continue;
        if (glsl::light_view(l, p, glm::normalize(l.position - p), -1).masked) continue;
        ++receivers;
        for (const glsl::ShadowLight& sample : cut.lights) {
          const glsl::ShadowView& view = viewOf(cut, sample, p);
          EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(view, p))) << kind;
          if (i % 4 != 1) continue;
          for (const auto& blocker : cloud.triangles) {
            const std::optional<vec3> at = hit(blocker, p + 1e-3f * (sample.origin - p), sample.origin);
            if (!at || glm::distance(*at, vec3(sample.origin)) < 0.01f) continue;
            ++blockers;
            const glsl::ShadowPoint q = glsl::shadow_project(view, *at);
            EXPECT_TRUE(glsl::shadow_inside(q)) << kind << ": " << q.uv.x << " " << q.uv.y;
            EXPECT_GE(q.depth, view.near);
            EXPECT_LE(q.depth, view.far);
          }
        }
      }
    }
    EXPECT_GT(receivers, 500);
    EXPECT_GT(blockers, 20);
    EXPECT_GE(smaller, 20);
  }
}

TEST(WindowFitOf, FacesScaleWithTheScene) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  const auto fitted = [&](const Cloud& world, int kind, float scale) {
    visible.update(world.pose, world.boxes,
                   scene::lookAt(scale * vec3(0, 1.2f, 3.5f), scale * vec3(0, 0.2f, 0), 0.5f), 1.3f);
    glsl::Light l = lightOfFaces(kind);
    for (int i = 0; i < 3; ++i) l.position[i] *= scale;
    l.length_u *= scale;
    l.length_v *= scale;
    return fit(world, l, {.size = 256, .samples = {{0.3f, 0.6f}}, .fit = MapFit::view}, &visible).views;
  };
  for (int kind = 0; kind < 3; ++kind) {
    const std::vector<glsl::ShadowView> one = fitted(cloud, kind, 1);
    for (const float scale : {1e-3f, 1e3f}) {
      const std::vector<glsl::ShadowView> views = fitted(scaledBy(cloud, scale), kind, scale);
      ASSERT_EQ(views.size(), one.size());
      for (size_t i = 0; i < views.size(); ++i) {
        EXPECT_EQ(showsNothing(views[i]), showsNothing(one[i])) << kind << ", face " << i;
        EXPECT_NEAR(views[i].middle.x, one[i].middle.x, 1e-2f) << kind << ", face " << i;
        EXPECT_NEAR(views[i].near / scale, one[i].near, 1e-3f * one[i].near) << kind << ", face " << i;
      }
    }
  }
}

TEST(WindowFitOf, FacesStayWhatTheyAreWhileTheCameraMovesLittle) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  std::optional<Fitted> before;
  int changes = 0;
  for (int i = 0; i < 50; ++i) {
    const float x = 0.001f * static_cast<float>(i);
    visible.update(cloud.pose, cloud.boxes, scene::lookAt({x, 1.2f, 3.5f}, {x, 0.2f, 0}, 0.5f), 1.3f);
    const Fitted now =
        fit(cloud, lightOfFaces(0), {.size = 256, .samples = {{0.3f, 0.6f}}, .fit = MapFit::view}, &visible);
    if (before && std::memcmp(now.views.data(), before->views.data(), 5 * sizeof(glsl::ShadowView)) != 0)
      ++changes;
    before = now;
  }
  EXPECT_LE(changes, 15);
}

/// Of a light that shines only where the camera does not look, nobody looks into the maps.
TEST(WindowFitOf, MapsOfLightsOnNothingThatIsSeenStayEmpty) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  const scene::CameraPose ahead = scene::lookAt({0, 1.2f, 3.5f}, {0, 0.2f, 8}, 0.5f),
                          up = scene::lookAt({0, 5, 0}, {0.1f, 60, 1}, 0.5f);
  const auto expectEmpty = [&](const glsl::Light& light, const scene::CameraPose& camera,
                               const ShadowMapDesc& desc) {
    visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
    EXPECT_EQ(visible.visible().empty(), &camera == &up);
    const Fitted cut = fit(cloud, light, desc, &visible);
    for (const glsl::ShadowView& view : cut.views) {
      EXPECT_TRUE(showsNothing(view)) << view.layer;
      for (const auto& triangle : cloud.triangles) {
        for (const vec3& p : triangle) {
          const glsl::ShadowPoint q = glsl::shadow_project(view, p);
          EXPECT_FALSE(glsl::shadow_inside(q) && q.depth >= view.near && q.depth <= view.far);
        }
      }
    }
    ShadowMapDesc ofScene = desc;
    ofScene.fit = MapFit::scene;
    const Fitted whole = fit(cloud, light, ofScene, &visible);
    for (const glsl::ShadowView& view : whole.views) EXPECT_FALSE(showsNothing(view)) << view.layer;
  };
  const std::vector<vec2> points{{0.5f, 0.5f}, {0.3f, 0.6f}};
  const glsl::Light rectangle = rectangleLight({-2.5f, 6.5f, 1}, {0.3f, -1, -0.1f}, 0.8f, 0.6f),
                    spot = spotLight({0, 3.8f, -3}, {0, -1, 0}, 0.3f),
                    sun = directionalLight({0.3f, -1, 0.2f}, 0.2f);
  for (const glsl::Light& light : {rectangle, spot, sun}) {
    const scene::CameraPose& camera = light.type == glsl::light_spot ? ahead : up;
    expectEmpty(light, camera, {.size = 64, .fit = MapFit::view});
    expectEmpty(light, camera, {.size = 64, .samples = points, .fit = MapFit::view});
    expectEmpty(light, camera, {.size = 64, .views = 2, .fit = MapFit::view});
  }
  for (int kind = 0; kind < 3; ++kind)
    expectEmpty(lightOfFaces(kind), up, {.size = 64, .samples = points, .fit = MapFit::view});
}

}  // namespace
}  // namespace limn::shadow
