// Laws of what the camera sees of a scene (core/shadow/visible_scene.h, convex.h).
#include "core/shadow/visible_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/scene/camera.h"
#include "core/shadow/convex.h"
#include "tests/support/test_scenes.h"
#include "tests/unit/shadow/window_fits.h"

namespace limn::shadow {
namespace {

using namespace limn::test;
using glm::vec3;
using glm::vec4;

TEST(Convex, CutsKeepWhatLiesInsideAndNothingElse) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const scene::Bounds box{vec3(-1), vec3(1, 1, i % 3 == 0 ? -1 : 1)};  // some flat
    std::array<vec4, 3> planes;
    for (vec4& p : planes)
      p = vec4(glm::normalize(vec3(normal(random), normal(random), normal(random))), uniform(random));
    Convex solid;
    solid.setBox(boxCorners(box));
    for (const vec4& p : planes) solid.clip(p);
    for (const vec3& p : solid.corners()) {
      for (const vec4& plane : planes) EXPECT_GE(glm::dot(vec3(plane), p) + plane.w, -1e-5f);
      EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.00001f);
    }
    // What lies inside is nowhere farther along any direction than some corner.
    const vec3 direction(normal(random), normal(random), normal(random));
    float farthest = -1e9f;
    for (const vec3& p : solid.corners()) farthest = std::max(farthest, glm::dot(direction, p));
    for (int k = 0; k < 200; ++k) {
      const vec3 p = glm::clamp(vec3(uniform(random), uniform(random), uniform(random)), box.low, box.high);
      bool inside = true;
      for (const vec4& plane : planes) inside = inside && glm::dot(vec3(plane), p) + plane.w > 0;
      if (inside) {
        EXPECT_LE(glm::dot(direction, p), farthest + 1e-4f);
      }
    }
  }
}

TEST(VisibleSceneOf, FollowsWhatMovedAndIsLeftAsItIsOtherwise) {
  Cloud cloud(1);
  scene::CameraPose camera = scene::lookAt({0, 1.2f, 3.5f}, {0, 0.2f, 0}, 0.5f);
  float aspect = 1.3f;
  VisibleScene visible(cloud.scene);
  const auto expectToFollow = [&](const char* what) {
    SCOPED_TRACE(what);
    EXPECT_TRUE(visible.update(cloud.pose, cloud.boxes, camera, aspect));
    EXPECT_FALSE(visible.update(cloud.pose, cloud.boxes, camera, aspect));
    VisibleScene anew(cloud.scene);
    anew.update(cloud.pose, cloud.boxes, camera, aspect);
    EXPECT_EQ(visible.visible().size(), anew.visible().size());
    ASSERT_EQ(visible.parts().size(), anew.parts().size());
    for (size_t i = 0; i < anew.parts().size(); ++i)
      EXPECT_EQ(visible.parts()[i].bounds, anew.parts()[i].bounds) << i;
  };
  expectToFollow("the first time");
  camera = scene::lookAt({0.5f, 1.2f, 3.5f}, {0, 0.2f, 0}, 0.5f);
  expectToFollow("the camera");
  aspect = 1;
  expectToFollow("the picture's shape");
  cloud.pose.instances[1].objectToWorld *= glm::mat4(glm::mat3(-1, 0, 0, 0, 1, 0, 0, 0, -1));
  expectToFollow("an instance turned, within bounds that stay");
  cloud.pose.instances[1].deformed = 0;
  expectToFollow("an instance that is deformed now");
  cloud.boxes[1].high.y += 1;
  expectToFollow("its bounds");
}

TEST(VisibleSceneOf, CornersOfWhatIsSeenAreThoseOfItsFaces) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  visible.update(cloud.pose, cloud.boxes, scene::lookAt({0, 2, 8}, {0, 1, 0}, 0.6f), 1.3f);
  int whole = 0, cut = 0;
  for (const VisiblePart& part : visible.visible()) {
    const std::vector<vec3>& solid = part.solid.corners();
    for (const vec3& p : solid) EXPECT_NE(std::ranges::find(part.corners, p), part.corners.end());
    for (const vec3& p : part.corners) EXPECT_NE(std::ranges::find(solid, p), solid.end());
    const bool isWhole = solid.size() == 24;  // six faces of four
    EXPECT_TRUE(!isWhole || part.corners.size() == 8) << part.corners.size();
    ++(isWhole ? whole : cut);
  }
  EXPECT_GT(whole, 5);
  EXPECT_GT(cut, 5);
}

}  // namespace
}  // namespace limn::shadow
