// The light and the camera that scenes get when they bring none.
#include "core/scene/default_lights.h"

#include <gtest/gtest.h>

#include "core/scene/camera.h"

namespace limn::scene {
namespace {

Bounds box() {
  Bounds bounds;
  bounds.add(glm::vec3(-30, 5, 2));
  bounds.add(glm::vec3(10, 8, 90));
  return bounds;
}

TEST(DefaultLights, LightAWhiteSurfaceAsStatedAtAnyScale) {
  for (const float scale : {1e-4f, 1.f, 1e4f}) {
    Bounds bounds;
    bounds.add(scale * box().low);
    bounds.add(scale * box().high);
    Scene scene;
    const CameraPose camera = frameBounds(bounds);
    addDefaultLights(scene, camera, bounds);
    const Pose pose = evaluate(scene, 0);
    ASSERT_EQ(pose.lightNames, (std::vector<std::string>{"key", "headlight"}));
    const glm::vec3 centre = bounds.centre();
    EXPECT_NEAR(glsl::punctual_irradiance(pose.lights[0], centre).x / glsl::pi, 0.7f, 1e-4f);
    EXPECT_NEAR(glsl::punctual_irradiance(pose.lights[1], centre).x / glsl::pi, 0.15f, 1e-4f);
    const glm::vec4 shines(pose.lights[0].direction, 0);
    const glm::vec3 seen(camera.worldToView * shines);
    EXPECT_GT(seen.x, 0.3f);   // from the left,
    EXPECT_LT(seen.y, -0.3f);  // from above,
    EXPECT_LT(seen.z, -0.3f);  // from behind the camera
  }
}

TEST(DefaultLights, NothingToLightGetsNone) {
  Scene scene;
  addDefaultLights(scene, CameraPose{}, Bounds{});
  EXPECT_TRUE(scene.lights.empty());
}

TEST(DefaultCamera, SeesEveryCornerAndFillsThePicture) {
  const Bounds bounds = box();
  glsl::FrameBlock frame{};
  setCamera(frame, frameBounds(bounds), bounds, 100, 100);
  float farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 clip = frame.world_to_clip * glm::vec4((corner & 1) ? bounds.high.x : bounds.low.x,
                                                           (corner & 2) ? bounds.high.y : bounds.low.y,
                                                           (corner & 4) ? bounds.high.z : bounds.low.z, 1.f);
    ASSERT_GT(clip.w, 0);
    farthest = std::max({farthest, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
  }
  EXPECT_LE(farthest, 0.901f);
  EXPECT_GE(farthest, 0.5f);
}

}  // namespace
}  // namespace limn::scene
