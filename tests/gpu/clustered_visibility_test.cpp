// Indirect light with clustered visibility: what its soft shadows promise.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/gpu/corner_scene.h"

namespace limn {
namespace {

using namespace limn::test;
using ClusteredVisibilityTest = CornerTest;

/// The corner with a spot of `halfAngle` radians at `spotX`, and the plate.
Corner withPlate(float halfAngle, float spotX = 0) {
  Corner corner(lambert(Corner::albedo), halfAngle, spotX);
  corner.addPlate();
  return corner;
}

/// Without blockers there are no shadows: no surface shadows itself, whatever the number of area lights.
TEST_F(ClusteredVisibilityTest, NothingBetweenMeansNoShadow) {
  const Corner s(lambert(Corner::albedo), 0.5f);
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
  const Corner s = withPlate(0.05f);
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "64"}});
  for (const char* vals : {"1", "4", "64"})
    expectPlateHides(s, all, answer("clustered_visibility", s, {{"vpls", "64"}, {"vals", vals}}),
                     {0.06f, 0.02f, 0.07f, 300});
}

/// 2 cm before the wall, where a series of four terms cannot tell the plate from it.
TEST_F(ClusteredVisibilityTest, APlateJustBeforeTheWallHidesIt) {
  Corner s;
  s.addPlate(0.98f);
  s.camera = scene::lookAt({0.9f, 0.05f, 0}, {1, 0.26f, 0}, 0.7f);  // up into the gap
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "64"}});
  for (const char* vals : {"1", "4"}) {
    const Answer seen = answer("clustered_visibility", s, {{"vpls", "64"}, {"vals", vals}});
    int hidden = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (all.instance[static_cast<size_t>(y * side + x)] != 1) continue;
        const glm::vec3 p = s.position(all, x, y);
        if (p.y < 0.28f || p.y > 0.5f || std::abs(p.z) > 0.12f) continue;
        EXPECT_NEAR(seen.at(0, x, y), 0, 0.05f * all.at(0, x, y)) << x << "," << y;
        ++hidden;
      }
    }
    EXPECT_GT(hidden, 50) << vals;
  }
}

/// One area light for a wide pool of light has a penumbra about as wide as many have: on the line across the
/// shadow's edge the light rises steadily.
TEST_F(ClusteredVisibilityTest, AreaLightsCastSoftShadows) {
  const Corner s = withPlate(0.25f);
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
    const Corner s = withPlate(0.3f, -0.2f + 0.005f * static_cast<float>(frame));
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
