// The panel that searches for the best setting: a process of its own, whose answer is taken with a click.
#include <fmt/format.h>

#include "tests/view/viewer_window_test.h"

namespace limn::test {
namespace {

const char* const kArguments = "cornell_box --technique vssm --size 300x432 --open budget --save a.exr";

class ViewerBudgetTest : public ViewerWindowTest {
 protected:
  /// Types the techniques to choose from, and makes no step from their defaults.
  static std::string choose(const std::string& techniques) {
    return "click 250 210; enter " + techniques + "; click 112 233\n";
  }
  /// Starts the search; `tune` holds its process then, and `command` its arguments.
  static std::string search() {
    return "click 37 304; pgrep -P $viewer > tune; tr '\\0' ' ' < /proc/$(cat tune)/cmdline > command\n";
  }
  /// Waits until the search measures, in a process of its own, which `worker` holds then.
  static std::string measures() {
    return "for i in $(seq 1200); do pgrep -P $(cat tune) > worker && break; alive; sleep .05; done\n";
  }
  /// Says whether the process does nothing any more, though nobody may have asked how it ended.
  bool hasEnded(const std::string& name) const {
    const std::string stat =
        contents("/proc/" + std::to_string(std::stoi(contents(folder_ / name))) + "/stat");
    return stat.empty() || stat.find(") Z ") != std::string::npos;
  }
};

/// What is searched is what the window shows: its camera, which was moved, and its light, which was changed.
TEST_F(ViewerBudgetTest, SearchesWhatItShowsAndTakesTheAnswer) {
  const Outcome outcome = view(
      std::string(kArguments) + " --set-light key.intensity=3",
      kDrag + choose("hard_shadow_map") + "click 375 187\n" + search() +
          "frames 2; save meanwhile.exr; hear 'searched cornell_box, into out/tune$' 1; frames 2; sleep 2\n"
          "pgrep -P $viewer > left; click 355 416; save taken.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(
      contents(folder_ / "command"),
      testing::AllOf(testing::HasSubstr("limn tune cornell_box --eye "), testing::HasSubstr(" --target "),
                     testing::HasSubstr(" --size 300x432 --set-light key.intensity=3 --term direct "),
                     testing::HasSubstr(" --techniques hard_shadow_map --steps 0 --max-ms "),
                     testing::HasSubstr(" --out out/tune")));
  EXPECT_EQ(contents(folder_ / "left"), "");
  EXPECT_THAT(command("meanwhile.exr"), testing::HasSubstr("--technique vssm"));
  EXPECT_THAT(command("taken.exr"), testing::HasSubstr("--technique hard_shadow_map"));
  // Another window finds what was measured.
  ASSERT_EQ(view(kArguments, "frames 2; sleep 2; click 375 210; click 355 416; save again.exr").status, 0);
  EXPECT_THAT(command("again.exr"), testing::HasSubstr("--technique hard_shadow_map"));
}

/// No process is left behind, whether a search is cancelled or the window is closed; what is cancelled can be
/// started again.
TEST_F(ViewerBudgetTest, CancellingAndLeavingEndTheSearch) {
  const Outcome outcome =
      view(kArguments, search() + measures() +
                           "frames 2; click 37 304; hear 'stopped; Search goes on in out/tune$' 1\n"
                           "pgrep -P $viewer > left; mv tune tune1; mv worker worker1\n" +
                           search() + measures());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(contents(folder_ / "left"), "");
  EXPECT_NE(contents(folder_ / "tune"), contents(folder_ / "tune1"));
  for (const char* process : {"tune1", "worker1", "tune", "worker"})
    EXPECT_TRUE(hasEnded(process)) << process;
}

TEST_F(ViewerBudgetTest, SaysWhyASearchFailed) {
  const Outcome outcome = view(kArguments, choose("soft_shadows_by_magic") + search() +
                                               "hear 'unknown technique .soft_shadows_by_magic' 1; frames 2\n"
                                               "pgrep -P $viewer > left");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(contents(folder_ / "left"), "");
}

}  // namespace
}  // namespace limn::test
