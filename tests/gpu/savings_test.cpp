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
    scene::Scene scene = asset("balls");
    scene::Node node = *std::ranges::find_if(scene.nodes, [](const scene::Node& n) { return n.light == 0; });
    scene::LightSource dark = scene.lights.at(0);
    node.name = dark.name = "dark";
    dark.intensity = 0;
    node.light = static_cast<int>(scene.lights.size());
    node.mesh = node.camera = scene::none;
    scene.lights.push_back(dark);
    scene.nodes.push_back(node);
    return scene;
  }

  std::vector<SavingResult> savings(const scene::Scene& scene, const std::string& name,
                                    render::Output output) {
    render::Renderer renderer(device(), scene);
    return bench::measureSavings(renderer, renderer.pose().cameras.at(0),
                                 settings(64, 48, output, {quick(name)}), nullptr,
                                 {.frames = 3, .warmup = 0});
  }

  static const SavingResult& named(const std::vector<SavingResult>& results, const std::string& name) {
    const auto found = std::ranges::find(results, name, &SavingResult::name);
    EXPECT_NE(found, results.end()) << name;
    return *found;
  }
};

TEST_F(SavingsTest, WholePassesLeaveEveryTechniquesPictureAsItIs) {
  const scene::Scene scene = ballsWithDarkLight();
  for (const TechniquePlugin* plugin : registry().all())
    for (const SavingResult& r : savings(scene, plugin->info->name, render::Output::final))
      EXPECT_TRUE(!r.exact || r.holds())
          << plugin->info->name << ", " << r.name << ": " << r.largestDifference;
}

TEST_F(SavingsTest, FindWhatASceneDoesNotNeed) {
  const auto results = savings(ballsWithDarkLight(), "hard_shadow_map", render::Output::final);
  const SavingResult& dark = named(results, "dark lights");
  EXPECT_TRUE(dark.applies);
  EXPECT_THAT(dark.passes, testing::ElementsAre("core: light dark"));
  EXPECT_GT(dark.forced.memoryBytes, dark.without.memoryBytes);
  EXPECT_THAT(named(results, "environment light").passes, testing::ElementsAre("core: environment light"));
  EXPECT_THAT(named(results, "unchanged results").passes, testing::Contains("shadow: shadow maps"));
  EXPECT_EQ(dark.forced.ms.size(), 3u);

  const auto lit = savings(asset("balls"), "hard_shadow_map", render::Output::final);
  EXPECT_FALSE(named(lit, "dark lights").applies);
  EXPECT_THAT(bench::toMarkdown(lit), testing::HasSubstr("nothing to leave out"));
  EXPECT_EQ(nlohmann::json::parse(bench::toJson(lit)).at("savings").size(), lit.size());
}

}  // namespace
}  // namespace limn
