// Where the blocker searches of soft shadows look: `search_rounds` of pcss, vssm, cssm and
// moment_soft_shadow_map.
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

/// The edge of a square's shadow, with two more squares on either side, nearer to the light, that hide none
/// of it. They lie in the search kernel at the near plane, which a leaf in a corner brings close to the
/// light, and not in the one at their own depth, the nearest that is in the first.
struct SearchScene {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera = scene::lookAt({0.67f, 1.6f, 0.4f}, {0.67f, 0, 0}, 0.35f);

  SearchScene() {
    addMesh(scene, floorPrimitive(4, addMaterial(scene)));
    addMesh(scene, floorPrimitive(0.5f, 0));
    addInstance(scene, pose, 0);
    addInstance(scene, pose, 1, at(0, 1, 0));
    for (const float z : {-0.79f, 0.79f}) addInstance(scene, pose, 1, at(0.3f, 2, z));
    addInstance(scene, pose, 1, at(-0.96f, 2.8f, -0.96f, 0.1f));
    addLight(pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 0.8f, 0.8f));
  }
};

class BlockerSearchTest : public limn::test::TechniqueTest {
 protected:
  const SearchScene s;

  /// V of the floor where the kernels lie so. Bounds decide nothing there: the square and lit floor are in
  /// the kernel.
  std::vector<float> floor(const std::string& technique, std::map<std::string, std::string> settings) {
    for (const auto& [name, value] :
         {std::pair("views", "1"), {"shadow_map_fit", "scene"}, {"shadow_map_size", "512"}})
      settings[name] = value;
    if (technique == "pcss") settings["blocker_samples"] = settings["filter_samples"] = "256";
    const Answer v = visibility(technique, settings, s.scene, s.pose, s.camera);
    EXPECT_EQ(v.uncovered, 0u) << technique;
    std::vector<float> found;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const vec3 p = positionOf(v, s.camera, s.pose.bounds, x, y);
        const bool onFloor = v.instance[static_cast<size_t>(y * side + x)] == 0;
        if (onFloor && std::abs(p.z) < 0.1f && p.x > 0.5f && p.x < 0.83f) found.push_back(v.at(0, x, y));
      }
    }
    EXPECT_GT(found.size(), 1000u) << technique;
    return found;
  }
};

double rmsDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += std::pow(double{a[i]} - b[i], 2);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

TEST_F(BlockerSearchTest, WithoutRoundsPcssSearchesAtTheNearPlane) {
  const std::vector<float> near = floor("pcss", {{"search", "near"}}),
                           unmoved = floor("pcss", {{"search", "narrowed"}, {"search_rounds", "0"}}),
                           moved = floor("pcss", {{"search", "narrowed"}, {"search_rounds", "1"}});
  size_t different = 0;
  for (size_t i = 0; i < near.size(); ++i) different += std::abs(unmoved[i] - near[i]) > 1e-6f ? 1 : 0;
  // Two programs may round a sample that lies between two texels to either.
  EXPECT_LE(different, near.size() / 500);
  EXPECT_GT(rmsDifference(moved, near), 0.05);
}

TEST_F(BlockerSearchTest, WithoutRoundsPrefilteredSearchesAreAtTheNearPlane) {
  const std::vector<float> near = floor("pcss", {{"search", "near"}}),
                           moved = floor("pcss", {{"search", "narrowed"}, {"search_rounds", "1"}});
  // All that blocks in the search kernel counts, as published.
  const std::pair<const char*, std::map<std::string, std::string>> kernels[] = {
      {"vssm", {{"subdivision", "mixed"}, {"chebyshev", "pooled"}}},
      {"cssm", {{"blocker_passes", "1"}}},
      {"moment_soft_shadow_map", {{"search_blur", "1024"}, {"passes", "1"}}}};
  for (auto [name, settings] : kernels) {
    settings["search_rounds"] = "0";
    const std::vector<float> wide = floor(name, settings);
    EXPECT_LT(rmsDifference(wide, near), rmsDifference(wide, moved)) << name;
    settings["search_rounds"] = "1";
    const std::vector<float> narrow = floor(name, settings);
    EXPECT_LT(rmsDifference(narrow, moved), rmsDifference(narrow, near)) << name;
  }
}

}  // namespace
}  // namespace limn
