// Every scene of limn opened in a window, and every technique switched on by the mouse.
#include <algorithm>
#include <numeric>

#include "core/technique/registry.h"
#include "tests/view/viewer_window_test.h"

namespace limn::test {
namespace {

class ViewerScenesTest : public ViewerWindowTest {
 protected:
  /// Those of build/assets that lie between two letters, sorted; without soldiers, whose ten million
  /// triangles take seconds a picture where there is no GPU.
  static std::vector<std::filesystem::path> scenes(char first, char last) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(kBinaryDir) + "/assets")) {
      const std::string name = entry.path().filename().string();
      const std::filesystem::path file = entry.path() / (name + ".glb");
      if (name[0] >= first && name[0] <= last && name != "soldiers" && std::filesystem::exists(file))
        files.push_back(file);
    }
    std::ranges::sort(files);
    return files;
  }

  /// Drops them on one window after another.
  void open(const std::vector<std::filesystem::path>& files) {
    std::string script = "save first.exr\n";
    int opened = 1;
    for (const auto& file : files)
      script += "drop " + file.string() + "; hear opened " + std::to_string(++opened) + "; save " +
                file.stem().string() + ".exr\n";
    const Outcome outcome = view("gem --technique hard_shadow_map --size 60x92 --save a.exr", script);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const auto& file : files) {
      SCOPED_TRACE(file);
      const std::string name = file.stem().string() + ".exr";
      EXPECT_THAT(command(name), testing::HasSubstr(file.filename().string()));
      EXPECT_EQ(picture(name).width(), 60);
      const std::vector<float> shown = colours(picture(name));
      if (file.stem() != "water") {  // where all light comes through its surface, by caustics
        EXPECT_GT(std::reduce(shown.begin(), shown.end()), 0) << "there is light";
      }
    }
  }
};

TEST_F(ViewerScenesTest, OpensScenesFromAToF) {
  open(scenes('a', 'f'));
}

TEST_F(ViewerScenesTest, OpensScenesFromGToP) {
  open(scenes('g', 'p'));
}

TEST_F(ViewerScenesTest, OpensScenesFromQToZ) {
  open(scenes('q', 'z'));
}

/// Where a technique has something to do, quickly.
std::string stageOf(const TechniqueInfo& info) {
  if (info.places) return "bump_wall";
  const TermSet terms = info.terms;
  if (terms == termSet(Term::environment)) return "balls --environment sky";
  if (contains(terms, Term::subsurface)) return "translucent_spheres";
  if (contains(terms, Term::surface)) return "fresnel_spheres";
  if (contains(terms, Term::media) || contains(terms, Term::caustic) || contains(terms, Term::specular))
    return "gem";
  return contains(terms, Term::environment) ? "teapot_pattern" : "cornell_box";
}

class ViewerTechniquesTest : public ViewerWindowTest, public ::testing::WithParamInterface<const char*> {};

/// Each technique of the list is chosen, alone, and removed: with it the picture is another one, without it
/// the first one again.
TEST_P(ViewerTechniquesTest, SwitchesThemOnAndOff) {
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
  std::vector<std::string> chosen;
  std::string script = "save first.exr\n";
  int row = 0;  // of the list, whose first one is 24 pixels below the button that opens it
  for (const TechniquePlugin* plugin : registry.all()) {
    const int y = 90 + 18 * row++;
    if (stageOf(*plugin->info) != GetParam()) continue;
    chosen.emplace_back(plugin->info->name);
    script +=
        "click 200 66; click 100 " + std::to_string(y) + "; save " + chosen.back() + ".exr; click 348 66\n";
  }
  ASSERT_FALSE(chosen.empty());
  const Outcome outcome = view(std::string(GetParam()) + " --size 112x692 --open techniques --save a.exr",
                               script + "save last.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const std::string& name : chosen) {
    SCOPED_TRACE(name);
    EXPECT_THAT(command(name + ".exr"), testing::HasSubstr("--technique " + name + " "));
    EXPECT_NE(colours(picture(name + ".exr")), colours(picture("first.exr")));
  }
  EXPECT_EQ(colours(picture("last.exr")), colours(picture("first.exr")));
}

constexpr const char* kStages[] = {"cornell_box",     "teapot_pattern", "balls --environment sky", "gem",
                                   "fresnel_spheres", "bump_wall",      "translucent_spheres"};

INSTANTIATE_TEST_SUITE_P(Stages, ViewerTechniquesTest, testing::ValuesIn(kStages));

TEST_F(ViewerScenesTest, HasAStageForEveryTechnique) {
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
  for (const TechniquePlugin* plugin : registry.all())
    EXPECT_THAT(kStages, testing::Contains(stageOf(*plugin->info))) << plugin->info->name;
}

}  // namespace
}  // namespace limn::test
