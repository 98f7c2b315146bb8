// The scenes that were opened lately.
#include "apps/view/recent_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/cli/process.h"

namespace limn::app {
namespace {

namespace fs = std::filesystem;

class RecentScenes : public testing::Test {
 protected:
  RecentScenes() { setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1); }
  ~RecentScenes() override { unsetenv("XDG_STATE_HOME"); }
  fs::path scene(const std::string& name) const {
    std::ofstream(folder_ / name) << "a scene";
    return folder_ / name;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(RecentScenes, TheLastOneIsTheFirst) {
  EXPECT_THAT(recentScenes(), testing::IsEmpty());
  const fs::path a = scene("a.glb"), b = scene("b c.glb");
  noteRecentScene(a);
  noteRecentScene(b);
  EXPECT_THAT(recentScenes(), testing::ElementsAre(b, a));
  noteRecentScene(folder_.path() / "." / "a.glb");
  EXPECT_THAT(recentScenes(), testing::ElementsAre(a, b)) << "each once";
  fs::remove(a);
  EXPECT_THAT(recentScenes(), testing::ElementsAre(b)) << "what is gone is not offered";
}

TEST_F(RecentScenes, NamesAndWhatCannotBeKeptAreLeftAlone) {
  noteRecentScene("cornell_box");
  noteRecentScene(scene("two\nlines.glb"));
  EXPECT_THAT(recentScenes(), testing::IsEmpty());
  EXPECT_FALSE(fs::exists(folder_ / "state"));
  for (int i = 0; i < 12; ++i) noteRecentScene(scene(std::to_string(i) + ".glb"));
  EXPECT_EQ(recentScenes().size(), 10u);
  std::ofstream(folder_ / "no_folder") << "a file";
  setenv("XDG_STATE_HOME", (folder_ / "no_folder").c_str(), 1);
  noteRecentScene(scene("a.glb"));
  EXPECT_THAT(recentScenes(), testing::IsEmpty());
}

}  // namespace
}  // namespace limn::app
