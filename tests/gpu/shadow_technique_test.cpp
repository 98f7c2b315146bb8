// What every shadow-map technique must hold.
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "tests/gpu/ball_scene.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

class ShadowTechniqueTest : public BallTest {
 protected:
  /// What cuts surfaces into elements takes seconds for those of the fine ball.
  static bool cuts(const TechniquePlugin& plugin) { return has(plugin, "longest_edge"); }
  static BallScene ballFor(const TechniquePlugin& plugin, float scale = 1) {
    return BallScene(scale, true, glm::mat4(1), cuts(plugin) ? 16 : 64);
  }
  static std::map<std::string, std::string> settingsFor(const TechniquePlugin& plugin) {
    auto settings = quick(plugin);
    if (cuts(plugin)) settings["longest_edge"] = "0.1";
    return settings;
  }
};

TEST_F(ShadowTechniqueTest, LightsGiveTheSameAloneAndTogether) {
  drawn = 64;  // to the bit, pictures and maps of any size
  for (const TechniquePlugin* plugin : techniques()) {
    const std::string name = plugin->info->name;
    auto settings = settingsFor(*plugin);
    if (has(*plugin, "shadow_map_size")) settings["shadow_map_size"] = "64";
    const BallScene s = ballFor(*plugin);
    const Answer together = visibility(name, settings, s.scene, s.pose, s.camera);
    for (uint32_t l = 0; l < s.pose.lights.size(); ++l) {
      const Answer alone = visibility(name, settings, s.scene, s.pose, s.camera, {l});
      EXPECT_EQ(alone.lights[0], together.lights[l]) << name << " light " << l;
    }
  }
}

TEST_F(ShadowTechniqueTest, PlanesDoNotShadowThemselvesAtAnySlopeAndLightSize) {
  for (const float tilt : {0.f, 0.4f, 1.1f}) {
    const BallScene s(1, false, glm::rotate(glm::mat4(1), tilt, {1, 0, 0.3f}));
    for (const TechniquePlugin* plugin : techniques()) {
      for (const char* size : {"-1", "0.3", "2"}) {
        auto settings = quick(*plugin);
        if (has(*plugin, "light_size")) settings["light_size"] = size;
        const Answer v = visibility(plugin->info->name, settings, s.scene, s.pose, s.camera);
        for (size_t l = 0; l < v.lights.size(); ++l) {
          EXPECT_EQ(*std::ranges::min_element(v.lights[l]), 1.f)
              << plugin->info->name << " tilt " << tilt << " light " << l << " size " << size;
        }
        if (!has(*plugin, "light_size")) break;
      }
    }
  }
}

TEST_F(ShadowTechniqueTest, ScaleChangesNothing) {
  for (const TechniquePlugin* plugin : techniques()) {
    const auto settings = settingsFor(*plugin);
    const BallScene one = ballFor(*plugin);
    const Answer expected = visibility(plugin->info->name, settings, one.scene, one.pose, one.camera);
    for (const float scale : {1e-4f, 1e4f}) {
      const BallScene s = ballFor(*plugin, scale);
      const Answer v = visibility(plugin->info->name, settings, s.scene, s.pose, s.camera);
      for (size_t l = 0; l < v.lights.size(); ++l) {
        double squares = 0;
        for (size_t i = 0; i < v.lights[l].size(); ++i)
          squares += std::pow(double{v.lights[l][i]} - expected.lights[l][i], 2);
        EXPECT_LT(std::sqrt(squares / static_cast<double>(v.lights[l].size())), 5e-3)
            << plugin->info->name << " scale " << scale << " light " << l;
      }
    }
  }
}

/// What all of a pixel's neighbours agree on, within what a texel decides, no fit of the maps changes.
TEST_F(ShadowTechniqueTest, MapsFittedToTheViewLoseNoShadow) {
  BallScene s;
  addInstance(s.scene, s.pose, 1, at(0.4f, 2.6f, -0.2f, 0.3f));  // near the lights, out of sight
  addInstance(s.scene, s.pose, 1, at(1.2f, 0.3f, 0.4f, 0.5f));   // cut by the edge of the picture
  const auto camera = scene::lookAt({0.4f, 0.9f, 2.2f}, {0.4f, 0.1f, 0.1f}, 0.7f);
  for (const TechniquePlugin* plugin : techniques()) {
    if (!has(*plugin, "shadow_map_fit")) continue;
    const auto draw = [&](const char* fit) {
      auto settings = quick(*plugin);
      settings["shadow_map_size"] = "512";
      settings["shadow_map_fit"] = fit;
      return visibility(plugin->info->name, settings, s.scene, s.pose, camera);
    };
    const Answer whole = draw("scene"), cut = draw("view");
    EXPECT_EQ(cut.uncovered, whole.uncovered) << plugin->info->name;
    for (size_t l = 0; l < whole.lights.size(); ++l) {
      int certain = 0, wrong = 0;
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          float low = 1, high = 0;
          for (int dy = -3; dy <= 3; ++dy) {
            for (int dx = -3; dx <= 3; ++dx) {
              const float v = whole.at(l, std::clamp(x + dx, 0, side - 1), std::clamp(y + dy, 0, side - 1));
              low = std::min(low, v);
              high = std::max(high, v);
            }
          }
          if (high - low > 0.02f) continue;
          ++certain;
          if (std::abs(cut.at(l, x, y) - whole.at(l, x, y)) > 0.06f) ++wrong;
        }
      }
      EXPECT_GT(certain, side * side / 8) << plugin->info->name << " light " << l;
      EXPECT_LE(wrong, certain / 500) << plugin->info->name << " light " << l;
    }
  }
}

/// The ball under a point light, a disc, a long light, one that the floor cuts, and a wide one.
BallScene wideLights(bool ball) {
  BallScene s(1, ball);
  s.pose.lights = {s.pose.lights[0], s.pose.lights[2]};
  s.pose.lights[1].angular_diameter = 0.04f;  // fewer texels than what is cut
  s.pose.lightNames.resize(2);
  addLight(s.pose, rectangleLight({0, 3, 0}, {0, -1, 0}, 2.4f, 0.3f));
  addLight(s.pose, rectangleLight({2, 1, 0}, {-1, 0, 0}, 3, 3));
  addLight(s.pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2.5f, 2.5f));
  return s;
}

TEST_F(ShadowTechniqueTest, PartsOfALightAddUp) {
  const BallScene bare = wideLights(false), s = wideLights(true);
  for (const TechniquePlugin* plugin : techniques()) {
    if (!has(*plugin, "views")) continue;
    const char* name = plugin->info->name;
    auto settings = quick(*plugin);
    const auto draw = [&](const BallScene& scene, const char* views) {
      settings["views"] = views;
      return visibility(name, settings, scene.scene, scene.pose, scene.camera);
    };
    const Answer unoccluded = draw(bare, "2");
    EXPECT_EQ(unoccluded.uncovered, 0u) << name;
    for (size_t l = 0; l < unoccluded.lights.size(); ++l)
      EXPECT_GT(*std::ranges::min_element(unoccluded.lights[l]), 0.999f) << name << " light " << l;
    const Answer cut = draw(s, "2"), whole = draw(s, "1"), chosen = draw(s, "0");
    EXPECT_EQ(cut.lights[0], whole.lights[0]) << name << ": a point";
    EXPECT_EQ(chosen.lights[0], whole.lights[0]) << name << ": a point";
    EXPECT_EQ(chosen.lights[1], whole.lights[1]) << name << ": a small disc";
    EXPECT_EQ(chosen.lights[4], cut.lights[4]) << name << ": a wide light";
    for (size_t l = 1; l < cut.lights.size(); ++l) EXPECT_NE(cut.lights[l], whole.lights[l]) << name << l;
    for (const uint32_t light : {3u, 4u}) {
      const Errors one = floorErrors(s, whole, light, ballHides),
                   four = floorErrors(s, cut, light, ballHides);
      EXPECT_GT(one.penumbra, 150);
      EXPECT_LT(four.rms, 0.8 * one.rms) << name << " light " << light;
      EXPECT_LT(four.rms, 0.1) << name << " light " << light;
    }
  }
}

/// llvmpipe leaves all loops of a thread after 65,535 steps. Had a light more samples in all, V would be that
/// of its first parts.
TEST_F(ShadowTechniqueTest, PartsOfALightHaveAllOfTheirSamplesOrAreRefused) {
  if (!context().info().software) GTEST_SKIP() << "loops of GPUs have no end of their own";
  drawn = 16;
  const BallScene s;
  for (const char* name : {"pcss", "savsm"}) {
    const auto draw = [&](const char* samples) {
      std::map<std::string, std::string> settings{
          {"shadow_map_size", "64"}, {"views", "8"}, {"blocker_samples", samples}};
      if (name == std::string_view("pcss")) settings["filter_samples"] = samples;
      return visibility(name, settings, s.scene, s.pose, s.camera, {3});
    };
    EXPECT_THAT([&] { draw("1024"); }, testing::ThrowsMessage<UsageError>(testing::HasSubstr("48 parts")))
        << name;
    const auto mean = [](const Answer& v) {
      return std::accumulate(v.lights[0].begin(), v.lights[0].end(), 0.0) /
             static_cast<double>(v.lights[0].size());
    };
    EXPECT_NEAR(mean(draw("600")), mean(draw("64")), 0.01) << name;
  }
}

/// A floor under a point light at (0, 2, 0), the faces of whose cube meet on it at 2 m along x and z, and on
/// the diagonals beyond.
struct FacesScene {
  scene::Scene scene;
  scene::Pose pose;

  FacesScene() {
    addMesh(scene, floorPrimitive(4, addMaterial(scene)));
    addMesh(scene, floorPrimitive(1, 0));
    addInstance(scene, pose, 0);
    addLight(pose, pointLight({0, 2, 0}));
  }
};

TEST_F(ShadowTechniqueTest, NoLightComesThroughWhereTheFacesOfACubeMeet) {
  FacesScene s;
  const float quarter = glm::half_pi<float>();
  for (const glm::mat4& turn :
       {glm::mat4(1), glm::rotate(glm::mat4(1), quarter, {1, 0, 0}),
        glm::rotate(glm::mat4(1), 2 * quarter, {1, 0, 0}), glm::rotate(glm::mat4(1), 3 * quarter, {1, 0, 0}),
        glm::rotate(glm::mat4(1), quarter, {0, 0, 1}), glm::rotate(glm::mat4(1), 3 * quarter, {0, 0, 1})}) {
    // Sides of a box around the light that reach past its edges.
    addInstance(s.scene, s.pose, 1, at(0, 2, 0) * turn * at(0, -0.5f, 0, 0.6f));
  }
  const auto camera = scene::lookAt({2, 4, 3.5f}, {2, 0, 2}, 0.5f);
  for (const char* name : {"savsm", "vssm", "cssm", "moment_soft_shadow_map"}) {
    const Answer v =
        visibility(name, {{"shadow_map_size", "64"}, {"light_size", "0.001"}}, s.scene, s.pose, camera);
    int floor = 0, lit = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] != 0) continue;
      ++floor;
      lit += v.lights[0][i] > 0 ? 1 : 0;
    }
    EXPECT_EQ(v.uncovered, 0u) << name;
    EXPECT_GT(floor, 10000) << name;
    EXPECT_EQ(lit, 0) << name;
  }
}

/// A search kernel wider than what blocks, so that bounds of its depths prove nothing, and a penumbra kernel
/// within a texel.
TEST_F(ShadowTechniqueTest, PenumbraKernelsWithinATexelAreSharedByTheFacesOfACube) {
  FacesScene s;
  addInstance(s.scene, s.pose, 1, at(1.8f, 0.2f, 0) * glm::scale(glm::mat4(1), {0.15f, 1, 1.5f}));
  addInstance(s.scene, s.pose, 1, at(0, 2.3f, 0, 0.05f));  // brings the near plane to the light
  const auto camera = scene::lookAt({3.5f, 1, 0.4f}, {2, 0, 0.4f}, 0.4f);
  for (const TechniquePlugin* plugin : techniques()) {
    const std::string name = plugin->info->name;
    if (name != "savsm" && name != "vssm" && name != "moment_soft_shadow_map") continue;
    std::map<std::string, std::string> settings{{"shadow_map_size", "128"}, {"light_size", "0.06"}};
    if (has(*plugin, "search_rounds")) settings["search_rounds"] = "1";
    if (name == "vssm") settings["contact"] = "jittered";
    const Answer v = visibility(name, settings, s.scene, s.pose, camera);
    int umbra = 0;
    float brightest = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const vec3 p = positionOf(v, camera, s.pose.bounds, x, y);
        if (v.instance[static_cast<size_t>(y * side + x)] != 0 || std::abs(p.x - 2) > 0.06f) continue;
        ++umbra;
        brightest = std::max(brightest, v.at(0, x, y));
      }
    }
    EXPECT_GT(umbra, 500) << name;
    EXPECT_LT(brightest, 0.02f) << name;
  }
}

/// A square lamp 1 m above a wide floor and a panel half way up beside it, which a face beside the light's
/// axis shows: along that axis it is nearer to the lamp than the near plane, which the floor below the lamp
/// gives all faces. From x the edge at 2.6 m is seen at 5.2 m - x on the lamp. A hard edge in the middle errs
/// by 1 / sqrt(12) = 0.29 over that penumbra. The map shows the panel's edge to within half a texel, 0.045 of
/// V there, patches of two texels to within one, and a box of the map stands for the kernel, which moves V by
/// 0.02 at most.
TEST_F(ShadowTechniqueTest, PanelsBesideALampHaveSoftShadows) {
  constexpr float lamp = 0.6f, edge = 2.6f;
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(10, addMaterial(scene)));
  addMesh(scene, floorPrimitive(1, 0));
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 1, at(edge - 0.3f, 0.5f, 0) * glm::scale(glm::mat4(1), {0.3f, 1, 3}));
  addLight(pose, rectangleLight({0, 1, 0}, {0, -1, 0}, lamp, lamp));
  const auto camera = scene::lookAt({6.4f, 1.1f, 0}, {5.2f, 0, 0}, 0.6f);
  for (const TechniquePlugin* plugin : techniques()) {
    const std::string name = plugin->info->name;
    if (name != "pcss" && name != "vssm" && name != "backprojection" && name != "bitmask_soft_shadows")
      continue;
    std::map<std::string, std::string> settings{{"shadow_map_size", "1024"}};
    for (const auto& [parameter, value] :
         {std::pair("views", "1"), {"patches", "256"}, {"sample_points", "256"}}) {
      if (has(*plugin, parameter)) settings[parameter] = value;
    }
    const Answer v = visibility(name, settings, scene, pose, camera);
    double squares = 0;
    int penumbra = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const vec3 p = positionOf(v, camera, pose.bounds, x, y);
        const float exact = (p.x - (2 * edge - 0.5f * lamp)) / lamp;
        if (v.instance[static_cast<size_t>(y * side + x)] != 0 || exact < 0 || exact > 1) continue;
        ++penumbra;
        squares += std::pow(double{v.at(0, x, y)} - exact, 2);
      }
    }
    EXPECT_EQ(v.uncovered, 0u) << name;
    EXPECT_GT(penumbra, 3000) << name;
    EXPECT_LT(std::sqrt(squares / penumbra), 0.14) << name;
  }
}

/// A lamp above a floor, and a panel over the floor's rim. The map ends where both do, and kernels of places
/// near the rim reach beyond it. Nothing blocks there, whether the lamp has another map for its other side or
/// not. Were kernels cut at the map's edge, V would be off by 0.10 (root mean square over the floor in
/// sight).
TEST_F(ShadowTechniqueTest, LampsWithTwoSidesShadowEachAsLampsWithOne) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  addMesh(scene, floorPrimitive(0.5f, 0));
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 1, at(1, 1, 0));
  addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2, 1));
  addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2, 1, true));
  const auto camera = scene::lookAt({4, 0.8f, 0}, {1.7f, 0, 0}, 0.4f);
  for (const TechniquePlugin* plugin : techniques()) {
    const std::string name = plugin->info->name;
    if (!has(*plugin, "shadow_map_size")) continue;
    auto settings = quick(*plugin);
    // The same map for both: pairs are not fitted to the view. As many patches as the kernel has texels, so
    // that programs that narrow it in other ways walk in the same steps.
    for (const auto& [parameter, value] :
         {std::pair("views", "1"), {"patches", "256"}, {"shadow_map_fit", "scene"}}) {
      if (has(*plugin, parameter)) settings[parameter] = value;
    }
    const Answer v = visibility(name, settings, scene, pose, camera);
    ASSERT_EQ(v.maps[1].layers, (has(*plugin, "samples") ? 4 : 1) * 2) << name;
    double squares = 0;
    int floor = 0, penumbra = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] != 0) continue;
      ++floor;
      penumbra += v.lights[0][i] > 0.1f && v.lights[0][i] < 0.9f ? 1 : 0;
      squares += std::pow(double{v.lights[1][i]} - v.lights[0][i], 2);
    }
    EXPECT_GT(floor, 3000) << name;
    EXPECT_LT(std::sqrt(squares / floor), 0.01) << name;
    if (has(*plugin, "light_size") && name != "pcf") {
      EXPECT_GT(penumbra, 1000) << name;
    }
  }
}

}  // namespace
}  // namespace limn
