// What comes from outside the window: files dropped on it, a window manager, the mouse on its panels.
#include "tests/view/viewer_window_test.h"

namespace limn::test {
namespace {

class ViewerInputTest : public ViewerWindowTest {};

/// Files dropped on the window: a scene replaces the one that is shown, one that cannot be read leaves it, a
/// map lights it.
TEST_F(ViewerInputTest, TakesWhatIsDroppedOnIt) {
  const std::string assets = std::string(kBinaryDir) + "/assets/";
  std::filesystem::copy_file(assets + "environments/sky.exr", folder_ / "sky.exr");
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 560x160 --save a.exr",
           "save first.exr; echo broken > broken.glb; drop broken.glb; hear broken.glb 1; save same.exr\n"
           "drop " +
               assets +
               "teapot/teapot.glb; hear opened 2; save teapot.exr\n"
               "drop missing.glb; hear missing.glb 1; drop sky.exr; hear opened 3; save sky.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(colours(picture("same.exr")), colours(picture("first.exr")));
  EXPECT_THAT(command("same.exr"), testing::HasSubstr("cornell_box"));
  EXPECT_THAT(command("teapot.exr"), testing::HasSubstr("teapot.glb"));
}

/// Minimised by a window manager and restored: no picture is made meanwhile, though the animation plays, and
/// the window goes on afterwards.
TEST_F(ViewerInputTest, RestsWhileMinimised) {
  if (run({"/bin/sh", "-c", "command -v 9wm && command -v xprop"}).status != 0)
    GTEST_SKIP() << "needs a window manager (9wm) and xprop";
  const std::string script =
      "ticks() { set -- $(cat /proc/$viewer/stat); echo $((${14} + ${15})); }\n"
      "visible() { xdotool search --onlyvisible --name '^limn$'; }\n"
      "9wm 2> 9wm.log &\n"
      "until xprop -id $window WM_STATE | grep -q state:; do sleep .1; done  # it manages the window\n"
      "focused; save first.exr; xdotool key space; sleep 2; frames 1\n"
      "xdotool windowminimize $window\n"
      "for i in $(seq 600); do [ -z \"$(visible)\" ] && break; sleep .1; done; visible > visible\n"
      "sleep 1; ticks > before; sleep 4; ticks > after\n"
      "xdotool windowmap $window; focused; frames 1; xdotool key space; save last.exr\n";
  const Outcome outcome = view("metaballs --technique pcss --size 560x240 --save a.exr", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(contents(folder_ / "visible"), "");
  const double ticks = std::stod(contents(folder_ / "after")) - std::stod(contents(folder_ / "before"));
  EXPECT_LT(ticks / static_cast<double>(sysconf(_SC_CLK_TCK)), 1) << "seconds of work in four";
  EXPECT_NE(colours(picture("last.exr")), colours(picture("first.exr")));
  EXPECT_EQ(picture("last.exr").width(), picture("first.exr").width());
}

/// The chooser offers the maps beside the present one, here those of the folder.
TEST_F(ViewerInputTest, ChoosesEnvironments) {
  std::filesystem::copy_file(std::string(kBinaryDir) + "/assets/environments/sky.exr", folder_ / "0.exr");
  auto choose = [opened = 1](int entry) mutable {
    return "click 250 116; click 250 " + std::to_string(140 + 18 * entry) + "; hear opened " +
           std::to_string(++opened) + "\n";
  };
  std::string script = "save none.exr\n";
  for (const auto& [entry, name] : {std::pair(3, "seen"), {1, "sky"}, {0, "last"}})
    script += choose(entry) + "save " + name + ".exr\n";
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 560x340 --open environment --save a.exr", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(command("seen.exr"), testing::HasSubstr("--environment ./0.exr"));
  EXPECT_THAT(command("sky.exr"), testing::HasSubstr("--environment sky"));
  EXPECT_EQ(colours(picture("seen.exr")), colours(picture("sky.exr"))) << "the same map";
  EXPECT_NE(colours(picture("sky.exr")), colours(picture("none.exr")));
  EXPECT_EQ(colours(picture("last.exr")), colours(picture("none.exr")));
}

/// Every slider of a technique goes from one end of its range to the other, and each x brings a default back.
TEST_F(ViewerInputTest, MovesSliders) {
  std::string sliders, resets;
  for (const char* row : {"86", "109", "178", "201", "247", "270", "293"}) {
    const std::string y = row;
    sliders += "point 270 " + y + "; xdotool mousedown 1; frames 2; point 183 " + y + "; point 360 " + y +
               "; point 240 " + y + "; xdotool mouseup 1; frames 2\n";
    resets += "click 375 " + y + "\n";
  }
  const Outcome outcome = view("cornell_box --technique pcss --size 500x330 --open techniques --save a.exr",
                               "save first.exr\n" + sliders + "save moved.exr\n" + resets + "save reset.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* parameter : {"blocker_samples", "filter_samples", "search_rounds", "shadow_map_size",
                                "views", "bias", "light_size"})
    EXPECT_THAT(command("moved.exr"), testing::HasSubstr(std::string("--set pcss.") + parameter));
  EXPECT_THAT(command("reset.exr"), testing::Not(testing::HasSubstr("--set ")));
  EXPECT_EQ(colours(picture("reset.exr")), colours(picture("first.exr")));
}

}  // namespace
}  // namespace limn::test
