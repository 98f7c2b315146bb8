// Indirect light with clustered visibility: what its soft shadows promise.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

/// Between the discs of points light leaks, and at outlines they stand out: what a shadow takes on the whole
/// is right.
TEST_F(ClusteredVisibilityTest, APlateOfPointsHidesASpeckFromTheWall) {
  const Corner s = withPlate(0.05f);
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "64"}});
  for (const char* vals : {"1", "4", "64"}) {
    const Answer seen =
        answer("clustered_visibility", s, {{"vpls", "64"}, {"vals", vals}, {"maps", "points"}});
    double hidden = 0, leaked = 0, lit = 0, open = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        if (all.instance[static_cast<size_t>(y * side + x)] != 1) continue;
        const glm::vec3 p = s.position(all, x, y);
        const float outside = std::max(std::abs(0.5f * p.y - 0.4f), std::abs(0.5f * p.z)) - 0.15f;
        if (outside < -0.07f) hidden += double(all.at(0, x, y)), leaked += double(seen.at(0, x, y));
        if (outside > 0.07f) open += double(all.at(0, x, y)), lit += double(seen.at(0, x, y));
      }
    EXPECT_LT(leaked, 0.3 * hidden) << vals;
    EXPECT_NEAR(lit / open, 1, 0.03) << vals;
  }
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

/// As many lights and areas as there may be, in one sub-buffer or at edges: llvmpipe leaves all loops of a
/// thread after 65,535 steps, of which each light takes one, and each area another.
TEST_F(ClusteredVisibilityTest, AsManyLightsAndAreasAsThereMayBeAllShine) {
  Corner s;
  s.camera = scene::lookAt({-20, 15, 20}, {0.8f, 0.4f, 0}, 0.7f);  // about a hundred pixels of wall
  const auto light = [&](const std::string& name, Settings settings) {
    const Answer v = answer(name, s, std::move(settings));
    return std::accumulate(v.lights[0].begin(), v.lights[0].end(), 0.0);
  };
  // That of every 64th of them, which no loop is too short for.
  const double all = light("reflective_shadow_map", {{"vpls", "1024"}});
  EXPECT_GT(all, 0);
  EXPECT_NEAR(light("reflective_shadow_map", {{"vpls", "65536"}}) / all, 1, 5e-3);
  const Settings many{{"vpls", "65536"}, {"vals", "1024"}, {"map_size", "64"}, {"iterations", "1"}};
  EXPECT_NEAR(light("clustered_visibility", many) / all, 1, 5e-3) << "one loop would lose 1.6 %";
  Settings edges = many;
  edges["block"] = "2";
  edges["edges"] = "1e-6";
  EXPECT_NEAR(light("clustered_visibility", edges) / all, 1, 5e-3) << "at edges";
}

/// The corner with a box of sides 2 `half` half a metre above the floor. Two spots light specks of opposite
/// sides of it, instead of one of the floor.
Corner withBox(float half) {
  Corner corner;
  const int plate = addMesh(corner.scene, floorPrimitive(half, 0));
  for (int i = 0; i < 6; ++i) {
    const float turn = 0.5f * glsl::pi * static_cast<float>(i < 4 ? i : 2 * i - 9);
    const glm::vec3 about = i < 4 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    addInstance(corner.scene, corner.pose, plate,
                at(0, 0.5f, 0) * glm::rotate(glm::mat4(1), turn, about) * at(0, half, 0));
  }
  corner.pose.lights.clear();
  corner.pose.lightNames.clear();
  for (const float x : {-0.6f, 0.6f}) {
    glsl::Light light = spotLight({x, 0.5f, 0}, {-x, 0, 0}, 0.03f);
    light.emission = glm::vec3(1000);
    addLight(corner.pose, light);
  }
  return corner;
}

/// Nothing stands in the way of the specks on either side of a box. One area light for both lies within it:
/// it takes no more light than there is, and none where the box is nearer than `near`. Areas of one side each
/// take none.
TEST_F(ClusteredVisibilityTest, AnAreaLightWithinABoxTakesNoMoreThanThereIs) {
  constexpr float near = 0.07f;  // m: 0.02 of the scene's diagonal
  for (const float half : {0.5f * near, 3 * near}) {
    const Corner s = withBox(half);
    const Answer all = answer("reflective_shadow_map", s, {{"vpls", "63"}});
    const auto seen = [&](const char* vals) {
      const Answer v = answer("clustered_visibility", s, {{"vpls", "63"}, {"vals", vals}, {"near", "0.02"}});
      double light = 0, most = 0;
      for (size_t i = 0; i < v.lights[0].size(); ++i) {
        EXPECT_LE(v.lights[0][i], 1.001f * all.lights[0][i] + 1e-5f) << vals;
        light += double(v.lights[0][i]), most += double(all.lights[0][i]);
      }
      EXPECT_GT(most, 0);
      return light / most;
    };
    EXPECT_NEAR(seen("9"), 1, 0.02) << half;
    if (half < near) {
      EXPECT_NEAR(seen("1"), 1, 0.02);
    } else {
      EXPECT_LT(seen("1"), 0.9) << "the box hides one side's";
    }
  }
}

/// A point of the floor that the spot lights, and its irradiance relative to others.
struct PoolPoint {
  glm::dvec3 position;
  double irradiance;
};

/// The pool of light below the corner's spot, on a grid.
std::vector<PoolPoint> poolOf(const Corner& s) {
  const glsl::Light& spot = s.pose.lights.at(0);
  const glm::dvec3 lamp(spot.position);
  const double cosInner = double(spot.cos_inner), cosOuter = double(spot.cos_outer);
  const double radius = lamp.y * std::sqrt(1 / (cosOuter * cosOuter) - 1);
  constexpr int n = 64;
  std::vector<PoolPoint> pool;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const glm::dvec3 at(lamp.x + (2 * (i + 0.5) / n - 1) * radius, 0,
                          lamp.z + (2 * (j + 0.5) / n - 1) * radius);
      const double distance = glm::length(at - lamp), cosine = lamp.y / distance;
      const double within = std::clamp((cosine - cosOuter) / (cosInner - cosOuter), 0.0, 1.0);
      if (within > 0) pool.push_back({at, within * within * cosine / (distance * distance)});
    }
  return pool;
}

/// The share of the pool's light that the point p of the wall gets past the plate at x = 1/2, 2 `halfWidth`
/// wide.
double poolVisibility(std::span<const PoolPoint> pool, const glm::dvec3& p, double halfWidth = 0.15) {
  double all = 0, seen = 0;
  for (const PoolPoint& point : pool) {
    const glm::dvec3 way = p - point.position;
    const double distance2 = glm::dot(way, way);
    const double light = point.irradiance * way.y * way.x / (distance2 * distance2);
    const glm::dvec3 passes = point.position + (0.5 - point.position.x) / way.x * way;
    all += light;
    if (std::abs(passes.y - 0.4) > 0.15 || std::abs(passes.z) > halfWidth) seen += light;
  }
  return seen / all;
}

/// Pixels of the wall in the penumbra, and the light that is missing there, in pixels. `all`: without
/// shadows; `visibility(x, y)`: what of it is left.
template <class Visibility>
std::pair<double, double> shadowOnWall(const Answer& all, const Visibility& visibility) {
  double partial = 0, dark = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      if (all.instance[static_cast<size_t>(y * all.width + x)] != 1 || !(all.at(0, x, y) > 0)) continue;
      const double v = visibility(x, y);
      partial += v > 0.1 && v < 0.9;
      dark += 1 - v;
    }
  return {partial, dark};
}

/// The shadow of a wide pool of light against its quadrature: how many pixels lie in the penumbra, and how
/// much light is missing. An area light is the rectangle around its virtual lights, which is larger than what
/// they light: exact visibility of the rectangles around the pool, its quarters and its sixteenths
/// puts 1.19, 1.18 and 1.07 times as many points of the wall into the penumbra, and takes 0.93, 0.93 and 0.98
/// times as much light. The technique may err by as much, to either side, and by 1 to 3 % at the ends of the
/// penumbra, where the 512 virtual lights and the pixels are too few to tell. A hard shadow has no penumbra
/// at all.
TEST_F(ClusteredVisibilityTest, AreaLightsCastSoftShadows) {
  const Corner s = withPlate(0.25f);
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "512"}});
  const std::vector<PoolPoint> pool = poolOf(s);
  const auto [partialTruth, darkTruth] = shadowOnWall(
      all, [&](int x, int y) { return poolVisibility(pool, glm::dvec3(s.position(all, x, y))); });
  EXPECT_GT(partialTruth, 1000);
  struct Bound {
    const char* vals;
    double partial, dark;  ///< relative
  };
  for (const auto& [vals, ofPartial, ofDark] :
       {Bound{"1", 0.2, 0.08}, Bound{"4", 0.2, 0.08}, Bound{"16", 0.1, 0.03}, Bound{"128", 0.05, 0.03}}) {
    const Answer seen = answer("clustered_visibility", s, {{"vpls", "512"}, {"vals", vals}});
    const auto [partial, dark] =
        shadowOnWall(all, [&](int x, int y) { return double(seen.at(0, x, y)) / double(all.at(0, x, y)); });
    EXPECT_NEAR(partial / partialTruth, 1, ofPartial) << vals;
    EXPECT_NEAR(dark / darkTruth, 1, ofDark) << vals;
  }
}

/// A strip 3 cm wide, half a metre from the pool: 3.4 degrees, four texels of an area light's map. From no
/// point of the wall does it hide the whole pool.
TEST_F(ClusteredVisibilityTest, ThinOccludersTakeTheirShareOfTheLight) {
  constexpr float halfWidth = 0.015f;
  Corner s(lambert(Corner::albedo), 0.25f);
  s.addPlate(0.5f, halfWidth);
  const Answer all = answer("reflective_shadow_map", s, {{"vpls", "512"}});
  const std::vector<PoolPoint> pool = poolOf(s);
  const auto exact = [&](int x, int y) {
    return poolVisibility(pool, glm::dvec3(s.position(all, x, y)), double{halfWidth});
  };
  const double darkTruth = shadowOnWall(all, exact).second;
  EXPECT_GT(darkTruth, 20);
  for (const char* vals : {"16", "128"}) {
    const Answer seen = answer("clustered_visibility", s, {{"vpls", "512"}, {"vals", vals}});
    double worst = 0;
    const double dark = shadowOnWall(all, [&](int x, int y) {
                          const double v = double(seen.at(0, x, y)) / double(all.at(0, x, y));
                          worst = std::max(worst, std::abs(v - exact(x, y)));
                          return v;
                        }).second;
    EXPECT_NEAR(dark / darkTruth, 1, 0.15)
        << vals << " area lights: " << dark << " pixels of light are missing, in truth " << darkTruth
        << "; visibility errs by at most " << worst;
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
