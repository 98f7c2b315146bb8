// Receivers whose tangent plane has the light's centre beneath it and a part of the light above: rays from
// the centre come up through the plane, so that what blocks lies behind it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/planes_scene.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;
using Settings = std::map<std::string, std::string>;

class TangentPlaneTest : public PlanesTest {};

/// Techniques whose thresholds, moments or bounds know nothing of what lies behind the tangent plane.
struct FromBeneath {
  const char* name;
  Settings settings;
  bool bounded = true;  ///< its bound is to answer the same
};

/// A wall that has part of the light before it, and a roof that reaches from the wall over all the rest.
struct Wall : Planes {
  explicit Wall(bool roof) {
    addPlane(1, at(0.15f, 1, 0) * glm::rotate(glm::mat4(1), -glsl::pi / 2, {0, 0, 1}));
    if (roof) addPlane(1, at(1.15f, 3, 0));
    camera = scene::lookAt({4, 1, 0}, {0.15f, 1, 0}, 0.4f);
  }
  /// The mean of V over the wall.
  double seen(const Answer& v) const {
    int onWall = 0;
    double sum = 0;
    for (int y = 0; y < v.height; ++y) {
      for (int x = 0; x < v.width; ++x) {
        const vec3 p = position(v, x, y);
        if (v.instance[static_cast<size_t>(y * v.width + x)] != 1 || std::abs(p.z) > 0.4f) continue;
        ++onWall;
        sum += v.at(0, x, y);
      }
    }
    EXPECT_GT(onWall, 100);
    return sum / onWall;
  }
};

/// The roof's edge lies on that of the kernel, so that half a texel of it may stay lit: in maps of 1024
/// texels the kernel is 30 of them wide or more.
TEST_F(TangentPlaneTest, WhatStandsAboveATangentPlaneBlocksAlthoughTheLightsCentreIsBeneath) {
  const FromBeneath cases[] = {
      {"vssm", {{"views", "1"}}, false},
      {"vssm", {{"views", "2"}}, false},
      {"cssm", {{"shadow_map_size", "1024"}}},
      {"moment_soft_shadow_map", {{"shadow_map_size", "1024"}}},
      {"savsm", {{"shadow_map_size", "1024"}}},
      {"pcss", {{"shadow_map_size", "1024"}, {"search", "narrowed"}}},
  };
  for (const bool roof : {false, true}) {
    const Wall s(roof);
    for (const FromBeneath& c : cases) {
      for (const bool ofBound : {false, true}) {
        if (ofBound && !c.bounded) continue;
        bound = ofBound;
        EXPECT_NEAR(s.seen(answer(s, c.settings, c.name)), roof ? 0 : 1, 0.03)
            << c.name << " " << c.settings.begin()->second << " bound " << ofBound;
      }
    }
  }
}

/// The same under a sun whose centre lies 2.9 degrees behind the wall and whose rim 5.7 degrees before it.
TEST_F(TangentPlaneTest, WhatStandsAboveATangentPlaneBlocksAlthoughTheSunsCentreIsBeneath) {
  const FromBeneath cases[] = {{"vssm", {{"views", "1"}}, false},
                               {"vssm", {{"views", "1"}, {"chebyshev", "pooled"}}, false},
                               {"vssm", {{"views", "1"}, {"subdivision", "adaptive"}}, false},
                               {"cssm", {}, false},
                               {"pcss", {{"search", "narrowed"}}, false}};
  for (const bool roof : {false, true}) {
    Wall s(roof);
    s.pose.lights[0] = directionalLight({0.05f, -1, 0}, 0.3f);
    for (FromBeneath c : cases) {
      c.settings.try_emplace("shadow_map_size", "1024");
      EXPECT_NEAR(s.seen(answer(s, c.settings, c.name)), roof ? 0 : 1, 0.03)
          << c.name << " " << c.settings.begin()->second;
    }
  }
}

/// A wall that has a third of the light before it, with a ledge on its upper edge, and something near the
/// light that covers no texel: from there the kernel is far from the ledge in the map.
struct Ledge : Planes {
  static constexpr float wall = 0.15f, height = 1.3f;

  Ledge() {
    addPlane(0.5f * height, at(wall, 0.5f * height, 0) * glm::rotate(glm::mat4(1), -glsl::pi / 2, {0, 0, 1}));
    addPlane(1, at(wall + 0.25f, height, 0) * glm::scale(glm::mat4(1), {0.25f, 1, 1}));
    addPlane(1e-5f, at(-0.4f, 3.5f, 0));
    camera = scene::lookAt({4, 0.6f, 0}, {wall, 0.6f, 0}, 0.4f);
  }
  /// Calls `use(x, y, p)` for pixels of the wall between two heights.
  void onWall(const Answer& v, float low, float high,
              const std::function<void(int, int, const vec3&)>& use) const {
    int count = 0;
    for (int y = 0; y < v.height; ++y) {
      for (int x = 0; x < v.width; ++x) {
        const vec3 p = position(v, x, y);
        if (v.instance[static_cast<size_t>(y * v.width + x)] != 1 || std::abs(p.z) > 0.4f) continue;
        if (p.y < low || p.y > high) continue;
        ++count;
        use(x, y, p);
      }
    }
    EXPECT_GT(count, 100);
  }
};

/// From between 0.3 and 0.8 m up the ledge hides all of the light that counts. The kernel at the ledge begins
/// at its edge in the map and is ten texels wide or more, of which half a one may stay lit.
TEST_F(TangentPlaneTest, BlockersNearTheReceiverAreFoundAlthoughTheLightsCentreIsBeneath) {
  std::vector<FromBeneath> cases{
      {"cssm", {}}, {"moment_soft_shadow_map", {}}, {"pcss", {{"search", "narrowed"}}}};
  for (const Settings& settings :
       {Settings{{"subdivision", "uniform"}}, Settings{{"subdivision", "adaptive"}},
        Settings{{"chebyshev", "pooled"}}, Settings{{"search_rounds", "1"}}})
    cases.push_back({"vssm", settings, false});
  const Ledge s;
  for (FromBeneath& c : cases) {
    for (const auto& [name, value] :
         {std::pair("views", "1"), {"shadow_map_fit", "scene"}, {"shadow_map_size", "1024"}})
      c.settings[name] = value;
    for (const bool ofBound : {false, true}) {
      if (ofBound && !c.bounded) continue;
      bound = ofBound;
      const Answer v = answer(s, c.settings, c.name);
      ASSERT_EQ(v.maps.size(), 1u);
      EXPECT_LT(v.maps[0].near, 0.51f);
      double sum = 0;
      int count = 0;
      s.onWall(v, 0.3f, 0.8f, [&](int x, int y, const vec3&) {
        sum += double{v.at(0, x, y)};
        ++count;
      });
      EXPECT_LT(sum / count, 0.1) << c.name << " " << c.settings.begin()->first << " bound " << ofBound;
    }
  }
}

/// Right below the ledge: the kernel of pcf, 5 texels wide, reaches under its edge, which the map shows to
/// within half a texel, a tenth of V.
TEST_F(TangentPlaneTest, TexelsBehindTheTangentPlaneBlockInFixedKernelsToo) {
  const Ledge s;
  constexpr float texel = 2.f / 1024;  // of a map 1 m before the light, which shows the floor's 8 m at 4 m
  for (const bool ofBound : {false, true}) {
    bound = ofBound;
    const Answer v = answer(s, {{"kernel", "5"}, {"shadow_map_size", "1024"}}, "pcf");
    s.onWall(v, 1.22f, 1.29f, [&](int x, int y, const vec3& p) {
      const float aside = Ledge::wall / (4 - Ledge::height) - Ledge::wall / (4 - p.y);
      EXPECT_NEAR(v.at(0, x, y), 0.5f + aside / (5 * texel), 0.12f) << p.y << " bound " << ofBound;
    });
  }
}

}  // namespace
}  // namespace limn
