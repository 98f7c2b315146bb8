// The camera and the floor of scenes that have none.
#include "core/scene/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/error.h"
#include "core/scene/camera.h"
#include "core/scene/floor.h"

namespace limn::scene {
namespace {

/// Points of a thin diagonal stick, whose bounds are much larger than what is seen of it.
std::vector<glm::vec3> stick() {
  std::vector<glm::vec3> points;
  for (int i = 0; i <= 20; ++i) {
    const float t = static_cast<float>(i) / 20;
    points.emplace_back(40 + 3 * t, 5 - t, -7 + 2 * t);
  }
  return points;
}

/// Of the points in a square picture, -1 to 1.
Bounds inPicture(const CameraPose& camera, const std::vector<glm::vec3>& points) {
  Bounds world, seen;
  for (const glm::vec3& p : points) world.add(p);
  glsl::FrameBlock frame{};
  setCamera(frame, camera, world, 100, 100);
  for (const glm::vec3& p : points) {
    const glm::vec4 clip = frame.world_to_clip * glm::vec4(p, 1);
    EXPECT_GT(clip.w, 0);
    seen.add(glm::vec3(clip.x / clip.w, clip.y / clip.w, 0));
  }
  return seen;
}

TEST(Framing, PointsFillFourFifthsOfTheirLongerSideAndLieInTheMiddle) {
  for (const float scale : {1e-3f, 1.f, 1e3f}) {
    std::vector<glm::vec3> points = stick();
    Framing framing;
    for (glm::vec3& p : points) framing.add(p *= scale);
    const Bounds seen = inPicture(framing.camera(), points);
    const glm::vec3 extent = seen.high - seen.low;
    EXPECT_NEAR(std::max(extent.x, extent.y), 1.6f, 2e-3f);
    const bool wide = extent.x > extent.y;
    EXPECT_NEAR(wide ? seen.centre().x : seen.centre().y, 0, 2e-3f);
    EXPECT_LE(std::max({seen.high.x, -seen.low.x, seen.high.y, -seen.low.y}), 0.802f);
  }
}

TEST(Framing, NothingAndASinglePointHaveCameras) {
  Framing framing;
  EXPECT_NO_THROW(framing.camera());
  framing.add(glm::vec3(5, 0, 0));
  const Bounds seen = inPicture(framing.camera(), {{5, 0, 0}});
  EXPECT_NEAR(seen.low.x, 0, 0.02f);
}

/// A square mesh that an animation moves to the right.
Scene movingScene() {
  Scene scene;
  scene.materials.emplace_back();
  Primitive square;
  square.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  square.normals.assign(4, {0, 1, 0});
  square.indices = {0, 1, 2, 0, 2, 3};
  square.bounds = {{-1, 0, -1}, {1, 0, 1}};
  square.material = 0;
  scene.meshes.push_back({.name = "square", .primitives = {square}, .morphWeights = {}});
  Node node;
  node.mesh = 0;
  scene.nodes.push_back(node);
  Animation animation;
  animation.duration = 1;
  animation.channels.push_back({AnimationChannel::Path::translation,
                                AnimationChannel::Interpolation::linear,
                                0,
                                {0, 1},
                                {0, 0, 0, 10, 0, 0}});
  scene.animations.push_back(animation);
  return scene;
}

TEST(Framing, SeesWhereAnAnimationGoes) {
  const Scene scene = movingScene();
  const CameraPose camera = frameScene(scene);
  const Bounds seen = inPicture(camera, {{-1, 0, 0}, {9, 0, 0}});
  EXPECT_GT(seen.low.x, -1);
  EXPECT_LT(seen.high.x, 1);
}

TEST(Framing, RefusesAnimationsThatDoNotExist) {
  EXPECT_THROW(frameScene(movingScene(), std::numeric_limits<int>::max()), UsageError);
  EXPECT_THROW(frameScene(Scene{}, 0), UsageError);
}

TEST(Floor, LiesJustBelowAndIsDiffuse) {
  Scene scene = movingScene();
  const Bounds bounds = vertexBounds(scene, evaluate(scene, 0));
  EXPECT_EQ(bounds.low, glm::vec3(-1, 0, -1));
  EXPECT_EQ(bounds.high, glm::vec3(1, 0, 1));
  addFloor(scene, bounds);
  ASSERT_EQ(scene.nodes.size(), 2u);
  EXPECT_EQ(scene.nodes.back().name, "floor");
  EXPECT_TRUE(scene.materials.back().lambertian());
  const Bounds with = vertexBounds(scene, evaluate(scene, 0));
  EXPECT_LT(with.low.y, 0);
  EXPECT_GT(with.low.y, -1e-3f);
  EXPECT_GT(with.high.x - with.low.x, 4 * (bounds.high.x - bounds.low.x));
}

TEST(Floor, NothingStandsOnNothing) {
  Scene scene;
  addFloor(scene, Bounds());
  EXPECT_TRUE(scene.nodes.empty());
}

}  // namespace
}  // namespace limn::scene
