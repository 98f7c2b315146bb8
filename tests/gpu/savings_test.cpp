// What limn leaves out of a frame changes nothing: with any technique, the picture is the same when it is
// done.
#include "core/bench/savings.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/gpu/render_test.h"

namespace limn {
namespace {

using bench::SavingResult;

class SavingsTest : public RenderTest {
 protected:
  /// Balls with a second light that emits nothing.
  static scene::Scene ballsWithDarkLight() {
    scene::Scene scene = coarse("balls");
    scene::Node node = *std::ranges::find_if(scene.nodes, [](const scene::Node& n) { return n.light == 0; });
    scene::LightSource dark = scene.lights.at(0);
    node.name = dark.name = "dark";
    dark.intensity = 0;
    node.light = static_cast<int>(scene.lights.size());
    node.mesh = node.camera = scene::kNone;
    scene.lights.push_back(dark);
    scene.nodes.push_back(node);
    return scene;
  }

  static std::vector<SavingResult> savings(render::Renderer& renderer, const std::string& name, int frames) {
    return bench::measureSavings(renderer, renderer.pose().cameras.at(0),
                                 settings(64, 48, Term::final, {smallest(name)}), nullptr,
                                 {.frames = frames, .warmup = 0});
  }

  static const SavingResult& named(const std::vector<SavingResult>& results, const std::string& name) {
    const auto found = std::ranges::find(results, name, &SavingResult::name);
    EXPECT_NE(found, results.end()) << name;
    return *found;
  }
};

TEST_F(SavingsTest, WholePassesLeaveEveryTechniquesPictureAsItIs) {
  const scene::Scene scene = ballsWithDarkLight();
  render::Renderer renderer(device(), scene);
  for (const TechniquePlugin* plugin : testedTechniques())
    for (const SavingResult& r : savings(renderer, plugin->info->name, 0))
      EXPECT_TRUE(!r.exact || r.holds())
          << plugin->info->name << ", " << r.name << ": " << r.largestDifference;
}

TEST_F(SavingsTest, FindWhatASceneDoesNotNeed) {
  const scene::Scene withDark = ballsWithDarkLight(), balls = coarse("balls");
  render::Renderer renderer(device(), withDark), litRenderer(device(), balls);
  const auto results = savings(renderer, "hard_shadow_map", 3);
  const SavingResult& dark = named(results, "dark lights");
  EXPECT_TRUE(dark.applies);
  EXPECT_THAT(dark.passes, testing::ElementsAre("core: light dark"));
  EXPECT_GT(dark.forced.memoryBytes, dark.without.memoryBytes);
  EXPECT_THAT(named(results, "environment light").passes, testing::ElementsAre("core: environment light"));
  EXPECT_EQ(named(results, "environment light").without.memoryBytes, dark.without.memoryBytes)
      << "the maps of an environment that is not there";
  EXPECT_THAT(named(results, "unchanged results").passes, testing::Contains("shadow: shadow maps"));
  EXPECT_EQ(dark.forced.ms.size(), 3u);

  const auto lit = savings(litRenderer, "hard_shadow_map", 0);
  EXPECT_FALSE(named(lit, "dark lights").applies);
  EXPECT_THAT(bench::toMarkdown(lit), testing::HasSubstr("nothing to leave out"));
  EXPECT_EQ(nlohmann::json::parse(bench::toJson(lit)).at("savings").size(), lit.size());
}

TEST_F(SavingsTest, SkinnedSurfacesThatDoNotMoveAreNotDeformedAgain) {
  const scene::Scene robot = asset("robot");
  render::Renderer renderer(device(), robot);
  const auto results = savings(renderer, "hard_shadow_map", 0);
  const SavingResult& unchanged = named(results, "unchanged results");
  EXPECT_THAT(unchanged.passes, testing::IsSupersetOf({"core: deform", "shadow: shadow maps"}));
  EXPECT_TRUE(unchanged.holds());
}

}  // namespace
}  // namespace limn
