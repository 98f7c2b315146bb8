// Each technique's picture against the one committed in its folder (techniques/NAME/golden.png; the core's
// own in tests/golden/unshadowed.png). llvmpipe renders the same bits everywhere, so the bound is one 8-bit
// step for differences between compilers. Mesa's zink generates other code for the same processor, and GPUs
// filter textures with weights of 8 bits, and where an edge passes through the middle of a pixel rounding
// decides who has it: two steps, but for one value in a thousand. LIMN_UPDATE_GOLDEN=NAME writes a new one of
// that technique (or unshadowed), =1 of all: look at them before committing.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/image/metrics.h"
#include "tests/gpu/render_test.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 128, kHeight = 96;
constexpr float kStep = 1.01f / 255;  // of the sRGB-encoded value

class GoldenTest : public PictureTest {
 protected:
  static bool overZink() { return context().info().renderer.starts_with("zink"); }

  /// A grey sky with a window of light in it.
  static scene::Environment sky() {
    scene::Environment e;
    e.width = 64;
    e.height = 32;
    for (int y = 0; y < e.height; ++y)
      for (int x = 0; x < e.width; ++x)
        e.texels.emplace_back(x >= 12 && x < 20 && y >= 6 && y < 12 ? 8.f : y < 16 ? 0.3f : 0.1f);
    return e;
  }

  /// What a picture shows side by side.
  struct Sights {
    std::vector<std::string> scenes;
    bool outdoors = false;  ///< lit by a sky alone
    bool operator==(const Sights&) const = default;
    bool operator<(const Sights& other) const {
      return std::tie(scenes, outdoors) < std::tie(other.scenes, other.outdoors);
    }
  };
  /// Techniques that answer the environment's light show scenes lit by a sky alone, and those that cut
  /// surfaces, answer media, caustics, specular or subsurface, or look into height maps, have scenes of their
  /// own.
  static Sights sightsOf(const std::vector<render::TechniqueUse>& techniques) {
    const auto answers = [&](Term term) {
      return std::ranges::any_of(techniques, [term](const render::TechniqueUse& use) {
        return contains(use.plugin->info->terms, term);
      });
    };
    std::vector<std::string> scenes{"cornell_box", "balls", "lights"};
    if (std::ranges::any_of(
            techniques, [](const render::TechniqueUse& use) { return cutsSurfaces(use.plugin->info->name); }))
      scenes = {"cornell_box", "glossy_sphere", "lights"};
    if (answers(Term::media) || answers(Term::caustic)) scenes = {"glass_sphere", "ring", "gem"};
    if (answers(Term::specular)) scenes = {"glassware", "ring", "gem"};
    if (answers(Term::surface)) scenes = {"torus_metal", "disk_and_sphere", "fresnel_spheres"};
    if (std::ranges::any_of(techniques,
                            [](const render::TechniqueUse& use) { return use.plugin->info->places; }))
      scenes = {"bump_wall", "egg_crate", "bump_sphere"};
    if (answers(Term::subsurface)) scenes = {"marble_statue", "translucent_spheres", "translucent_head"};
    return {std::move(scenes), answers(Term::environment)};
  }

  struct Stage {
    scene::Scene scene;
    render::Renderer renderer;
    explicit Stage(scene::Scene shown) : scene(std::move(shown)), renderer(device(), scene) {}
  };
  /// Scenes with their renderers, which the next picture has as well if it shows the same: scenes are read,
  /// and programs of core compiled, once. Nothing that a renderer drew before counts in a picture.
  struct Stages {
    Sights sights;
    std::vector<std::unique_ptr<Stage>> all;

    void show(Sights wanted) {
      if (!all.empty() && sights == wanted) return;
      all.clear();
      sights = std::move(wanted);
      for (const std::string& name : sights.scenes) {
        scene::Scene scene = asset(name);
        if (sights.outdoors) {
          for (scene::Node& node : scene.nodes) node.light = scene::kNone;
          scene.environment = sky();
        }
        all.push_back(std::make_unique<Stage>(std::move(scene)));
      }
    }
  };

  static Image strip(Stages& stages, const std::vector<render::TechniqueUse>& techniques) {
    stages.show(sightsOf(techniques));
    Image whole(kWidth * int(stages.all.size()), kHeight, {"R", "G", "B"});
    for (size_t s = 0; s < stages.all.size(); ++s) {
      const Image part = picture(stages.all[s]->renderer, settings(kWidth, kHeight, Term::final, techniques));
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          for (int c = 0; c < 3; ++c) whole.at(x + int(s) * kWidth, y, c) = part.at(x, y, c);
    }
    return whole;
  }

  static void check(Stages& stages, const std::string& name,
                    const std::vector<render::TechniqueUse>& techniques, const fs::path& golden) {
    SCOPED_TRACE(name);
    const char* variable = std::getenv("LIMN_UPDATE_GOLDEN");
    const std::string update = variable != nullptr ? variable : "";
    if (!update.empty() && update != "1" && update != name) return;
    const Image actual = strip(stages, techniques);
    if (!update.empty()) {
      fs::create_directories(golden.parent_path());
      writePng(golden, actual);
      return;
    }
    const fs::path failed = fs::path(test::kBinaryDir) / "failed";
    fs::create_directories(failed);
    // Several drivers may be tested at a time: what fails gets the common name.
    const fs::path ownFile = failed / (name + "." + std::to_string(getpid()) + ".png");
    const fs::path actualFile = failed / (name + ".actual.png");
    writePng(ownFile, actual);
    if (!fs::exists(golden)) {
      fs::rename(ownFile, actualFile);
      FAIL() << "no " << golden << "; look at " << actualFile
             << " and accept it with LIMN_UPDATE_GOLDEN=" << name << " " << test::kBinaryDir
             << "/bin/limn_gpu_tests --gtest_filter='GoldenTest.*'";
    }
    const Image8 a = readImage8(ownFile), b = readImage8(golden);
    ASSERT_EQ(a.data.size(), b.data.size());
    const bool sameBits = device().software() && !overZink();
    float worst = 0;
    size_t off = 0;
    for (size_t i = 0; i < a.data.size(); ++i) {
      const float difference = std::abs(a.data[i] - b.data[i]) / 255.f;
      worst = std::max(worst, difference);
      off += difference > (sameBits ? kStep : 2 * kStep) ? 1 : 0;
    }
    const size_t allowed = sameBits ? 0 : a.data.size() / 1000;
    EXPECT_LE(off, allowed) << "by up to " << worst << ", see " << failed << "/" << name
                            << ".{actual,expected,difference}.png";
    if (off <= allowed) {
      fs::remove(ownFile);
      return;
    }
    fs::rename(ownFile, actualFile);
    fs::copy_file(golden, failed / (name + ".expected.png"), fs::copy_options::overwrite_existing);
    writePng(failed / (name + ".difference.png"),
             differenceImage(compareImagesDetailed(readImage(actualFile), readImage(golden))));
  }
};

TEST_F(GoldenTest, Unshadowed) {
  Stages stages;
  check(stages, "unshadowed", {}, fs::path(test::kSourceDir) / "tests/golden/unshadowed.png");
}

TEST_F(GoldenTest, EveryTechnique) {
  std::vector<const TechniquePlugin*> plugins = testedTechniques();
  const auto sights = [](const TechniquePlugin* plugin) { return sightsOf({technique(plugin->info->name)}); };
  std::stable_sort(plugins.begin(), plugins.end(),
                   [&](const TechniquePlugin* a, const TechniquePlugin* b) { return sights(a) < sights(b); });
  Stages stages;
  for (const TechniquePlugin* plugin : plugins) {
    // The Vulkan driver beneath zink (lavapipe of Mesa 22.3) crashes in this one's pass "light points".
    if (overZink() && plugin->info->name == std::string_view("hierarchical_subsurface")) continue;
    check(stages, plugin->info->name, {technique(plugin->info->name)},
          fs::path(test::kSourceDir) / "techniques" / plugin->info->name / "golden.png");
  }
}

}  // namespace
}  // namespace limn
