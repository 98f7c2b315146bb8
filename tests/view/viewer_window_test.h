// A viewer in a real window, under Xvfb, with a real mouse and keyboard (xdotool).
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "tests/cli/process.h"
#include "tests/support/paths.h"

namespace limn::test {

inline const std::string kBinaries = std::string(kBinaryDir) + "/bin/";

class ViewerWindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run({"/bin/sh", "-c", "command -v xvfb-run && command -v xdotool"}).status != 0)
      GTEST_SKIP() << "needs xvfb-run and xdotool";
  }

  /// Starts limn-view with `arguments` in the folder, waits for its window, then does what `script` says.
  /// `await FILE` waits for a file, `hear TEXT N` until the text was said N times, `frames N` until the
  /// window has been drawn so often with all that was done before, `save FILE` for the picture of the moment,
  /// which limn-view saves as a.exr, `focused` until keys reach the window. `point X Y` and `click X Y` are
  /// the mouse's, `enter TEXT` types it and Return, `drop FILE` drops one on the window; the window is closed
  /// at the end. At most `seconds`. Ends with status 8 as soon as the viewer has ended by itself.
  Outcome view(const std::string& arguments, const std::string& script, int seconds = 400,
               const std::map<std::string, std::string>& environment = {}) {
    const std::string text =
        "cd '" + folder_.path().string() + "' || exit 9\nexport XDG_STATE_HOME=\"$PWD/state\"\n" +  //
        "alive() { kill -0 $viewer 2> none || exit 8; }\n" +
        "await() { for i in $(seq 1200); do [ -e \"$1\" ] && return; alive; sleep .05; done; echo no $1 >&2; "
        "}\n" +
        "hear() { for i in $(seq 1200); do [ $(grep -c \"$1\" said) -ge $2 ] && return; alive; sleep .05; "
        "done; "
        "echo not said: $1 >&2; }\n" +  //
        // Keys are answered once in a frame, except while the dialog is open, and function keys also while a
        // text field has the keyboard; F6 writes a suite right away.
        "frames() { for n in $(seq $1); do rm -f a.toml; xdotool key F6; await a.toml; done; }\n" +
        "save() { xdotool key F5; await a.exr; mv a.exr $1; }\n" +  //
        "focused() { until xdotool windowfocus $window 2> unfocused; do alive; sleep .1; done; }\n" +
        "point() { xdotool mousemove $1 $2; frames 2; }\n" +
        // Down, up, and what opens shows itself two frames later.
        "click() { point $1 $2; xdotool click 1; frames 4; }\n" +                      //
        "enter() { xdotool type -- $1; frames 2; xdotool key Return; frames 2; }\n" +  //
        "drop() { '" + kBinaryDir +
        "/tests/limn_drop_files' $window \"$1\" || echo $1 was not taken >&2; }\n" + "'" + kBinaries +
        "limn-view' " + arguments + " --gl-debug > said & viewer=$!\n" +
        "window=$(timeout 60 xdotool search --sync --onlyvisible --name 'limn$' | head -n 1)\n" +
        "focused\n" + script + "\nxdotool key ctrl+q\nwait $viewer\n";
    return run({"/usr/bin/timeout", std::to_string(seconds), "/usr/bin/xvfb-run", "-a", "-s",
                "-screen 0 1000x760x24", "/bin/sh", "-c", text},
               environment);
  }
  /// The picture that the window shows after `script` is the one that the command kept in it renders.
  void expectSamePixels(const std::string& arguments, const std::string& script, const std::string& said) {
    std::filesystem::remove(folder_ / "shown.exr");
    const Outcome outcome = view(arguments + " --save a.exr", script + "\nsave shown.exr");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Image shown = picture("shown.exr");
    std::string again = command("shown.exr");
    EXPECT_THAT(again, testing::HasSubstr(said));
    again.replace(again.find("a.exr"), 5, "rendered.exr");
    const Outcome rendered =
        run({"/bin/sh", "-c", "cd '" + folder_.path().string() + "' && '" + kBinaries + "'" + again});
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    EXPECT_EQ(colours(picture("rendered.exr")), colours(shown));
  }
  /// Of stats.json.
  double number(const std::string& key) const {
    const std::string text = contents(folder_ / "stats.json");
    const size_t at = text.find("\"" + key + "\": ");
    return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + key.size() + 4, nullptr);
  }
  Image picture(const std::string& name) const { return readImage(folder_ / name); }
  /// That renders it, as limn-view wrote into it.
  std::string command(const std::string& name) const { return picture(name).metadata().at("command"); }
  static std::vector<float> colours(const Image& image) {
    const Image rgb = image.select({"R", "G", "B"});
    return {rgb.data().begin(), rgb.data().end()};
  }
  TemporaryFolder folder_;
};

/// A drag across the picture; `save` before it waits for the first picture.
inline const char* const kDrag =
    "save first.exr; point 470 100; xdotool mousedown 1; frames 2; point 500 110; xdotool mouseup 1; frames "
    "2\n";

}  // namespace limn::test
