// What comes from outside the window: files dropped on it, a window manager, the mouse on its panels.
#include <fmt/format.h>

#include <algorithm>

#include "core/session/find.h"
#include "tests/view/viewer_window_test.h"

namespace limn::test {
namespace {

class ViewerInputTest : public ViewerWindowTest {};

/// Files dropped on the window: a scene replaces the one that is shown, one that cannot be read leaves it, a
/// map lights it, also where the scene is read again before that has been loaded; it can be undone.
TEST_F(ViewerInputTest, TakesWhatIsDroppedOnIt) {
  const std::string assets = std::string(kBinaryDir) + "/assets/";
  std::filesystem::copy_file(assets + "environments/sky.exr", folder_ / "sky.exr");
  const Outcome outcome = view(
      "cornell_box --technique hard_shadow_map --size 160x432 --save a.exr",
      "save first.exr; echo broken > broken.glb; drop broken.glb; hear broken.glb 1; save same.exr\n"
      "drop " +
          assets +
          "teapot/teapot.glb; hear opened 2; save teapot.exr\n"
          "drop missing.glb; hear missing.glb 1; drop sky.exr; xdotool key F4; hear opened 4; save sky.exr\n"
          "xdotool key ctrl+z; hear opened 5; save undone.exr; xdotool key ctrl+y; hear opened 6; save "
          "redone.exr\n"
          "click 372 44; click 290 68; hear opened 7; save again.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(colours(picture("same.exr")), colours(picture("first.exr")));
  EXPECT_THAT(command("same.exr"), testing::HasSubstr("cornell_box"));
  EXPECT_THAT(command("teapot.exr"), testing::HasSubstr("teapot.glb"));
  EXPECT_THAT(contents(folder_ / "state/limn/scenes"), testing::EndsWith("/teapot/teapot.glb\n"))
      << "it is offered from now on";
  EXPECT_THAT(command("sky.exr"), testing::HasSubstr("sky.exr"));
  EXPECT_NE(colours(picture("sky.exr")), colours(picture("teapot.exr")));
  EXPECT_EQ(command("undone.exr"), command("teapot.exr"));
  EXPECT_EQ(colours(picture("undone.exr")), colours(picture("teapot.exr")));
  EXPECT_EQ(command("redone.exr"), command("sky.exr"));
  EXPECT_EQ(colours(picture("again.exr")), colours(picture("teapot.exr")));
}

/// What plays ends with its scene: one without animation stands still, and has no time.
TEST_F(ViewerInputTest, StopsPlayingWithTheScene) {
  const Outcome outcome =
      view("metaballs --technique hard_shadow_map --size 160x212 --frames 600 --save a.exr",
           "save first.exr; xdotool key space; frames 2; sleep .5; save playing.exr\n"
           "drop " +
               std::string(kBinaryDir) +
               "/assets/teapot/teapot.glb; hear opened 2; frames 2; sleep 1; save still.exr\n"
               "while kill -0 $viewer 2> none; do sleep .1; done  # its frames are shown at last");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(command("playing.exr"), testing::HasSubstr("--time"));
  EXPECT_THAT(command("still.exr"),
              testing::AllOf(testing::HasSubstr("teapot.glb"), testing::Not(testing::HasSubstr("--time"))));
}

/// Minimised by a window manager and restored: no picture is made meanwhile, though the animation plays, and
/// the window goes on afterwards.
TEST_F(ViewerInputTest, RestsWhileMinimised) {
  if (run({"/bin/sh", "-c", "command -v 9wm && command -v xprop"}).status != 0)
    GTEST_SKIP() << "needs a window manager (9wm) and xprop";
  const std::string script =
      "ticks() { set -- $(cat /proc/$viewer/stat); echo $((${14} + ${15})); }\n"
      "visible() { xdotool search --onlyvisible --name 'limn$'; }\n"
      "9wm 2> 9wm.log &\n"
      "until xprop -id $window WM_STATE | grep -q state:; do sleep .1; done  # it manages the window\n"
      "focused; save first.exr; xdotool key space; sleep 2; frames 1\n"
      "xdotool windowminimize $window\n"
      "for i in $(seq 600); do [ -z \"$(visible)\" ] && break; sleep .1; done; visible > visible\n"
      "sleep 1; ticks > before; sleep 4; ticks > after\n"
      "xdotool windowmap $window; focused; frames 1; xdotool key space; save last.exr\n";
  const Outcome outcome = view("metaballs --technique pcss --size 160x212 --save a.exr", script);
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
      view("cornell_box --technique hard_shadow_map --size 160x312 --open environment --save a.exr", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(command("seen.exr"), testing::HasSubstr("--environment 0.exr"));
  EXPECT_THAT(command("sky.exr"), testing::HasSubstr("--environment sky"));
  EXPECT_EQ(colours(picture("seen.exr")), colours(picture("sky.exr"))) << "the same map";
  EXPECT_NE(colours(picture("sky.exr")), colours(picture("none.exr")));
  EXPECT_EQ(colours(picture("last.exr")), colours(picture("none.exr")));
}

/// Without a scene the window says how to open one; one of limn's is chosen from its list, of two columns
/// here, and stands in the title then. Keys that were pressed before, here F2, do nothing, be it in a field.
TEST_F(ViewerInputTest, StartsWithoutAScene) {
  const std::vector<std::string> names = session::sceneNames();
  const auto entry = std::ranges::find(names, "cornell_box") - names.begin();
  const std::string place = fmt::format("{} {}", 440 + 276 * (entry % 2), 94 + 17 * (entry / 2));
  const Outcome outcome = view("--size 600x420 --technique hard_shadow_map --save a.exr",
                               "sleep 1; xdotool key F2; sleep 1\n"
                               "xdotool mousemove 200 44; sleep 1; xdotool click 1; sleep 1\n"
                               "xdotool key F2 Escape; sleep 1; xdotool mousemove " +
                                   place +
                                   "; sleep 1; xdotool click 1; hear opened 1\n"
                                   "save first.exr; xdotool getwindowname $window > title");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(contents(folder_ / "title"), "cornell_box - limn\n");
  EXPECT_THAT(command("first.exr"),
              testing::HasSubstr("limn render cornell_box --technique hard_shadow_map "));
  EXPECT_EQ(picture("first.exr").width(), 600);
  EXPECT_EQ(picture("first.exr").height(), 420);
}

/// What the command line says of the scene, and an environment that comes first, wait for one.
TEST_F(ViewerInputTest, TheFirstSceneIsSeenAndLitAsWasSaid) {
  const std::string assets = std::string(kBinaryDir) + "/assets/";
  std::filesystem::copy_file(assets + "environments/sky.exr", folder_ / "sky.exr");
  const Outcome outcome = view("--size 160x212 --technique hard_shadow_map --floor on --fov 30 --save a.exr",
                               "sleep 1; drop sky.exr; sleep 1; drop " + assets +
                                   "gem/gem.glb; hear opened 1; save first.exr\n"
                                   "drop " +
                                   assets + "teapot/teapot.glb; hear opened 2; save second.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(command("first.exr"),
              testing::AllOf(testing::HasSubstr("gem.glb"), testing::HasSubstr("--fov 30"),
                             testing::HasSubstr("--floor on"), testing::HasSubstr("sky.exr")));
  EXPECT_THAT(command("second.exr"),
              testing::AllOf(testing::HasSubstr("teapot.glb"), testing::Not(testing::HasSubstr("--fov")),
                             testing::Not(testing::HasSubstr("--floor"))));
}

/// Through a folder to a scene, and back; Escape closes the dialog.
TEST_F(ViewerInputTest, WalksThroughFoldersToAFile) {
  const std::string assets = std::string(kBinaryDir) + "/assets/";
  std::filesystem::create_directory(folder_ / "models");
  std::filesystem::copy_file(assets + "gem/gem.glb", folder_ / "models/gem.glb");
  std::filesystem::copy_file(assets + "environments/sky.exr", folder_ / "models/sky.exr");
  // Rows: the folder above, then what the folder holds.
  const auto row = [](int i) {
    return "xdotool mousemove 300 " + std::to_string(80 + 18 * i) + "; sleep 1; xdotool click 1; sleep 1\n";
  };
  const Outcome outcome = view("--size 600x420 --technique hard_shadow_map --save a.exr",
                               "sleep 1; xdotool key ctrl+o; sleep 1\n" + row(1) + row(1) +
                                   "hear opened 1; save gem.exr; xdotool key ctrl+o; sleep 1\n" + row(2) +
                                   "hear opened 2; save lit.exr; xdotool key ctrl+o; sleep 1\n"
                                   "xdotool key Escape; sleep 1; save closed.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(command("gem.exr"), testing::HasSubstr("models/gem.glb"));
  EXPECT_THAT(command("lit.exr"), testing::HasSubstr("models/sky.exr"));
  EXPECT_EQ(colours(picture("closed.exr")), colours(picture("lit.exr")));
}

/// A text field holds whatever a path may hold.
TEST_F(ViewerInputTest, LongPathsStayWhole) {
  std::string path;
  for (int i = 0; i < 6; ++i) path += std::string(200, 'd') + "/";
  path += "a.exr";
  const Outcome outcome = view("cornell_box --technique hard_shadow_map --size 160x132 --save " + path,
                               "xdotool key F5; await " + path);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(std::filesystem::exists(folder_ / path));
}

/// The dialog takes Escape for itself: the inspector below it stays.
TEST_F(ViewerInputTest, EscapeInTheDialogLeavesTheInspector) {
  const auto shown = [&](const std::string& script) {
    const Outcome outcome = view(
        "cornell_box --technique hard_shadow_map --size 400x300 --save a.exr --screenshot window.png",
        "save first.exr; point 500 250; xdotool key F8; frames 2; sleep 1\n" + script + "frames 2; sleep 1");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    // Where the inspector lies, without messages and times.
    const Image window = picture("window.png").select({"R", "G", "B"});
    std::vector<float> pixels;
    for (int y = 60; y < 150; ++y)
      for (int x = 420; x < 780; ++x) pixels.push_back(window.at(x, y, 1));
    return pixels;
  };
  const std::vector<float> without = shown("xdotool key Escape; frames 2\n");
  EXPECT_NE(shown("xdotool key ctrl+o; sleep 1; xdotool key Escape; sleep 1\n"), without);
}

/// Nor does any other key do anything behind it, not even one of a function.
TEST_F(ViewerInputTest, TheDialogLeavesWhatIsBehindIt) {
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 160x212 --save a.exr",
           std::string(kDrag) + "save moved.exr; sleep 1; xdotool key ctrl+o; sleep 1\n" +
               "xdotool key ctrl+z F2; sleep 1; xdotool key Escape; sleep 1; save after.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(command("after.exr"), command("moved.exr"));
}

TEST_F(ViewerInputTest, WithoutADisplayAdvisesWhatWorks) {
  for (const char* name : {"--gl-debug", "--debug"}) {
    const Outcome outcome = run({kBinaries + "limn-view", "balls", name}, {{"DISPLAY", ""}});
    EXPECT_EQ(outcome.status, 1) << name;
    EXPECT_THAT(outcome.err, testing::HasSubstr("limn render"));
  }
}

/// Files that could not be written at the end are refused at the start.
TEST_F(ViewerInputTest, RefusesFilesThatItCannotWrite) {
  const auto refused = [](const char* option, const char* file, int status, const char* reason) {
    const Outcome outcome = run({kBinaries + "limn-view", "balls", option, file}, {{"DISPLAY", ""}});
    EXPECT_EQ(outcome.status, status) << option;
    EXPECT_THAT(outcome.err, testing::AllOf(testing::HasSubstr(file), testing::HasSubstr(reason)));
  };
  refused("--screenshot", "window.jpg", 2, ".png");
  refused("--save", "picture.jpg", 2, ".exr or .png");
  refused("--screenshot", "/nowhere/window.png", 1, "cannot be written");
  refused("--stats", "/nowhere/stats.json", 1, "cannot be written");
  const Outcome outcome =
      run({kBinaries + "limn-view", "balls", "--environment", "view.exr", "--save", "./view.exr"},
          {{"DISPLAY", ""}});
  EXPECT_EQ(outcome.status, 2) << "it would be lost";
  EXPECT_THAT(outcome.err, testing::HasSubstr("./view.exr: cannot be written"));
}

/// Options that the window does not use are refused, and the device is the one that was named.
TEST_F(ViewerInputTest, RefusesOptionsThatItDoesNotUse) {
  const auto window = [](std::vector<std::string> command) {
    command.insert(command.begin(), {"/usr/bin/timeout", "60", "/usr/bin/xvfb-run", "-a"});
    return run(command);
  };
  const std::string chapter = kBinaries + "ch7-variance-soft-shadows";
  for (const char* option : {"--filter", "--backend"}) {
    const Outcome outcome = window({chapter, option, "egl"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, testing::AllOf(testing::HasSubstr(option), testing::HasSubstr("--headless")));
  }
  for (const std::string& program : {kBinaries + "limn-view", chapter}) {
    const Outcome outcome = window({program, "--device", "250"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, testing::HasSubstr("EGL device 250 does not exist"));
  }
}

/// The picture keeps its size where text and widgets are larger, and the panel's edge is dragged.
TEST_F(ViewerInputTest, PicturesHaveTheSizeThatIsLeft) {
  const Outcome outcome = view(
      "cornell_box --technique hard_shadow_map --size 160x132 --scale 1.5 --save a.exr --screenshot "
      "window.png",
      "save first.exr; point 599 50; xdotool mousedown 1; frames 2; point 559 50; xdotool mouseup 1; frames "
      "2\n"
      "save wider.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(picture("first.exr").width(), 160);
  EXPECT_EQ(picture("first.exr").height(), 132);
  EXPECT_EQ(picture("wider.exr").width(), 200);
  EXPECT_EQ(picture("window.png").width(), 600 + 160);
  EXPECT_EQ(picture("window.png").height(), 42 + 132);
}

/// Techniques, cameras and what is compared with come back, and go again. The scene being read again neither
/// takes back what is done meanwhile nor what was done before.
TEST_F(ViewerInputTest, UndoesAndRedoes) {
  const Outcome outcome = view(
      "cornell_box --technique pcss --size 160x132 --save a.exr",
      "save first.exr; xdotool key F2; save other.exr; sleep .5\n"
      "point 470 60; xdotool mousedown 1; frames 2; point 500 70; xdotool mouseup 1; frames 2; sleep .5\n"
      "save turned.exr; xdotool key ctrl+z; save once.exr; xdotool key ctrl+z; save twice.exr\n"
      "xdotool key ctrl+z; save first_of_all.exr; xdotool key ctrl+shift+z ctrl+y; save again.exr\n"
      "xdotool key F4 click 4; hear opened 2; save nearer.exr; xdotool key ctrl+z; save back.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(command("turned.exr"), command("other.exr"));
  EXPECT_EQ(command("once.exr"), command("other.exr"));
  EXPECT_EQ(command("twice.exr"), command("first.exr"));
  EXPECT_EQ(command("first_of_all.exr"), command("first.exr"));
  EXPECT_EQ(command("again.exr"), command("turned.exr"));
  EXPECT_NE(command("nearer.exr"), command("turned.exr"));
  EXPECT_EQ(command("back.exr"), command("turned.exr"));
  EXPECT_EQ(colours(picture("twice.exr")), colours(picture("first.exr")));
  EXPECT_EQ(colours(picture("again.exr")), colours(picture("turned.exr")));
}

/// Techniques to compare with that come by themselves are not what undo takes back.
TEST_F(ViewerInputTest, UndoGoesBeyondTheBeginningOfAComparison) {
  const Outcome outcome = view("cornell_box --technique pcss --size 160x132 --save a.exr",
                               "save first.exr; xdotool key F2; save other.exr; sleep .5\n"
                               "xdotool key F3; frames 2; xdotool key F3; frames 2; sleep 1\n"
                               "xdotool key ctrl+z; save back.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(command("other.exr"), command("first.exr"));
  EXPECT_EQ(command("back.exr"), command("first.exr"));
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
  const Outcome outcome = view("cornell_box --technique pcss --size 100x302 --open techniques --save a.exr",
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
