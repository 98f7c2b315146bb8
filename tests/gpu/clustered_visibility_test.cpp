// Indirect light with clustered visibility: what its soft shadows promise.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/gpu/technique_harness.h"
#include "tests/gpu/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;
using Settings = std::map<std::string, std::string>;

/// A floor (y = 0) and a wall (x = 1) and, where asked, a plate between them. A spot above lights the floor.
struct Corner {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera = scene::lookAt({-2, 1.5f, 2}, {0.8f, 0.4f, 0}, 0.7f);

  Corner(float halfAngle, bool plate, float spotX = 0) {
    scene::Material lambert;
    lambert.baseColour = glm::vec4(0.6f, 0.6f, 0.6f, 1);
    lambert.metallic = 0;
    lambert.specularFactor = 0;
    const int material = addMaterial(scene, lambert);
    const int mesh = addMesh(scene, floorPrimitive(1, material));
    const glm::mat4 upright = glm::rotate(glm::mat4(1), 0.5f * glsl::pi, vec3(0, 0, 1));
    addInstance(scene, pose, mesh);
    addInstance(scene, pose, mesh, glm::translate(glm::mat4(1), {1, 1, 0}) * upright);
    if (plate)
      addInstance(scene, pose, addMesh(scene, floorPrimitive(0.15f, material)),
                  glm::translate(glm::mat4(1), {0.5f, 0.4f, 0}) * upright);
    glsl::Light light = spotLight({spotX, 1, 0}, {0, -1, 0}, halfAngle);
    light.emission = glm::vec4(1000);
    addLight(pose, light);
  }
  vec3 position(const Answer& v, int x, int y) const {
    glsl::FrameBlock frame{};
    scene::setCamera(frame, camera, pose.bounds, v.width, v.height);
    return vec3(frame.camera_position) +
           v.depth[static_cast<size_t>(y * v.width + x)] *
               (vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                static_cast<float>(y) * vec3(frame.view_ray_dy));
  }
};

class ClusteredVisibilityTest : public TechniqueTest {
 protected:
  Answer answer(const std::string& name, const Corner& s, Settings settings) {
    settings.insert({{"block", "1"}, {"clamp", "0"}});
    Answer v = visibility(name, settings, s.scene, s.pose, s.camera, {}, Term::indirect);
    for (const float value : v.lights[0]) EXPECT_TRUE(std::isfinite(value) && value >= 0);
    return v;
  }
};

/// Without blockers there are no shadows: no surface shadows itself, whatever the number of area lights.
TEST_F(ClusteredVisibilityTest, NothingBetweenMeansNoShadow) {
  const Corner s(0.5f, false);
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "256"}});
  for (const char* vals : {"1", "8", "30"}) {
    for (const char* kernel : {"exact", "thesis"}) {
      const Answer seen =
          answer("clustered_visibility", s, {{"vpls", "256"}, {"vals", vals}, {"kernel", kernel}});
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          ASSERT_NEAR(seen.at(0, x, y), all.at(0, x, y), 0.01f * all.at(0, x, y) + 1e-4f)
              << vals << " area lights, " << kernel << " kernel, " << x << "," << y;
    }
  }
}

/// A speck of light is nearly a point: what the plate hides is dark, what it does not is as without shadows.
TEST_F(ClusteredVisibilityTest, APlateHidesASpeckFromTheWall) {
  const Corner s(0.05f, true);
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "64"}});
  for (const char* vals : {"1", "4", "64"}) {
    const Answer seen = answer("clustered_visibility", s, {{"vpls", "64"}, {"vals", vals}});
    int hidden = 0, lit = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (all.instance[static_cast<size_t>(y * side + x)] != 1) continue;
        const vec3 p = s.position(all, x, y);
        // On the plate's plane, x = 1/2, the ray from the origin is at half of p; the speck is 0.1 m wide.
        const float outside = std::max(std::abs(0.5f * p.y - 0.4f), std::abs(0.5f * p.z)) - 0.15f;
        if (outside < -0.07f) {
          EXPECT_NEAR(seen.at(0, x, y), 0, 0.06f * all.at(0, x, y)) << x << "," << y;
          ++hidden;
        } else if (outside > 0.07f) {
          EXPECT_NEAR(seen.at(0, x, y), all.at(0, x, y), 0.02f * all.at(0, x, y) + 1e-4f) << x << "," << y;
          ++lit;
        }
      }
    }
    EXPECT_GT(hidden, 50);
    EXPECT_GT(lit, 300);
  }
}

/// One area light for a wide pool of light has a penumbra about as wide as many have: on the line across the
/// shadow's edge the light rises steadily.
TEST_F(ClusteredVisibilityTest, AreaLightsCastSoftShadows) {
  const Corner s(0.25f, true);
  const auto shadow = [&](const char* vals) {
    const Answer all = answer("reflective_shadow_map", s, {{"vpls", "512"}});
    const Answer seen = answer("clustered_visibility", s, {{"vpls", "512"}, {"vals", vals}});
    double partial = 0, dark = 0;
    for (size_t i = 0; i < seen.lights[0].size(); ++i) {
      if (all.instance[i] != 1 || all.lights[0][i] <= 0) continue;
      const float v = seen.lights[0][i] / all.lights[0][i];
      partial += v > 0.1f && v < 0.9f;
      dark += 1 - v;
    }
    return std::pair(partial, dark);
  };
  const auto [softMany, darkMany] = shadow("128");
  for (const char* vals : {"1", "4", "16"}) {
    const auto [soft, dark] = shadow(vals);
    EXPECT_NEAR(soft / softMany, 1, 0.5) << vals;
    EXPECT_NEAR(dark / darkMany, 1, 0.15) << vals;
  }
}

/// A spot that moves: the picture changes little more from frame to frame than without shadows.
TEST_F(ClusteredVisibilityTest, AMovingLightDoesNotFlicker) {
  double worst = 0;
  std::vector<float> before;
  for (int frame = 0; frame <= 10; ++frame) {
    const Corner s(0.3f, true, -0.2f + 0.005f * static_cast<float>(frame));
    const Answer all = answer("reflective_shadow_map", s, {{"vpls", "512"}});
    const Answer seen = answer("clustered_visibility", s, {{"vpls", "512"}, {"vals", "16"}});
    std::vector<float> now(seen.lights[0].size(), 1.f);
    for (size_t i = 0; i < now.size(); ++i)
      if (all.instance[i] == 1 && all.lights[0][i] > 0) now[i] = seen.lights[0][i] / all.lights[0][i];
    if (!before.empty())
      for (size_t i = 0; i < now.size(); ++i)
        worst = std::max(worst, static_cast<double>(std::abs(now[i] - before[i])));
    before = now;
  }
  RecordProperty("worst_change", std::to_string(worst));
  EXPECT_LT(worst, 0.12) << "of visibility, for steps of 5 mm of 600 mm";
}

}  // namespace
}  // namespace limn
