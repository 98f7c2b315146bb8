// Illumination samples in scenes of assets/: how many cells of directions the light takes that one surface
// sends to another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/radiosity/light_samples.h"
#include "core/scene_io/load.h"
#include "tests/support/paths.h"
#include "tests/unit/radiosity/sample_world.h"

namespace limn::radiosity {
namespace {

/// A scene after one bounce of the light of its lights, as the technique has it.
class LitScene {
 public:
  LitScene(const std::string& name, float longestEdge, const SampleSettings& settings)
      : scene_(scene::load(std::filesystem::path(test::kBinaryDir) / "assets" / name / (name + ".glb"))),
        pose_(scene::evaluate(scene_, 0)),
        elements_(scene_, pose_, longestEdge, 1u << 20),
        solver_(elements_.surfels(), elements_.forest(), elements_.space(), elements_.materials(), settings) {
    elements_.update(pose_);
    const auto occlusion = sceneOcclusion(scene_, pose_);
    solver_.begin();
    lightLeaves(elements_, pose_.lights, *occlusion, 16, solver_);
    solver_.reflect();
    solver_.shoot(*occlusion);
  }

  /// Returns the mean number of cells of the trees that surfaces sent their light by.
  double cells() const {
    const Forest& forest = elements_.forest();
    std::vector<bool> glossy(forest.slots());
    for (const uint32_t leaf : forest.leafOf())
      for (uint32_t slot = leaf; slot != glsl::no_link && solver_.glossy(leaf);
           slot = forest.parents()[slot / 4])
        glossy[slot] = true;
    return double(solver_.cellCount()) / double(std::count(glossy.begin(), glossy.end(), true));
  }

  /// Returns the RMSE of the irradiance of an instance over its mean in the other solution of the same scene.
  double errorOf(uint32_t instance, const LitScene& exact) const {
    double error = 0, light = 0, area = 0;
    const Surfels& surfels = elements_.surfels();
    for (size_t i = 0; i < surfels.size(); ++i) {
      if (surfels.objects[i] != instance) continue;
      const uint32_t leaf = elements_.forest().leafOf()[i];
      const glm::dvec3 wanted(exact.solver_.irradiance()[leaf]),
          off = glm::dvec3(solver_.irradiance()[leaf]) - wanted;
      error += double(surfels.areas[i]) * glm::dot(off, off) / 3;
      light += double(surfels.areas[i]) * (wanted.x + wanted.y + wanted.z) / 3;
      area += double(surfels.areas[i]);
    }
    return std::sqrt(error / area) / (light / area);
  }

 private:
  scene::Scene scene_;
  scene::Pose pose_;
  SceneElements elements_;
  SampleSolver solver_;
};

/// The wall of three_lights against the same elements with finer cells and links.
TEST(SampleScenes, AdaptiveCellsTakeAQuarterOfOneLevels) {
  const auto solved = [](const TreeSettings& tree, float linkError = 0.003f) {
    return LitScene("three_lights", 0.06f, {.linkError = linkError, .tree = tree});
  };
  const LitScene exact = solved({.error = 0.02f, .maxLevel = 9}, 1e-3f);
  const auto measured = [&](const char* what, const LitScene& scene) {
    const double error = scene.errorOf(1, exact);
    std::printf("three_lights, %s: %.0f cells, RMSE of the wall %.2f %%\n", what, scene.cells(), 100 * error);
    return error;
  };
  const LitScene adaptive = solved({.error = 0.09f}), coarse = solved({.error = 0.2f});
  const LitScene uniform = solved({.basis = TreeSettings::Basis::uniform, .maxLevel = 5}),
                 cells = solved({.minLevel = 5, .maxLevel = 5});
  const double error = measured("by error", adaptive);
  // As good, within what the finer solution leaves: 1.44 % both.
  EXPECT_LT(error, 1.01 * measured("linear between corners of level 5", uniform));
  EXPECT_LT(error, measured("cells of level 5", cells));
  EXPECT_LT(adaptive.cells(), 1000);
  EXPECT_LT(4 * adaptive.cells(), uniform.cells());
  EXPECT_LT(4 * adaptive.cells(), cells.cells());
  EXPECT_LT(measured("by an error of 0.2", coarse), 0.1);
}

}  // namespace
}  // namespace limn::radiosity
