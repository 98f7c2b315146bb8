// The viewer in a real window, under Xvfb, with a real mouse and keyboard (xdotool).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image.h"
#include "tests/cli/process.h"
#include "tests/support/paths.h"

namespace limn::test {
namespace {

const std::string binaries = std::string(binaryDir) + "/bin/";

class ViewerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run({"/bin/sh", "-c", "command -v xvfb-run && command -v xdotool"}).status != 0)
      GTEST_SKIP() << "needs xvfb-run and xdotool";
  }

  /// Starts limn-view with `arguments` in the folder, waits for its window, then does what `script` says.
  /// `await FILE` waits for a file; the window is closed at the end.
  Outcome view(const std::string& arguments, const std::string& script) {
    const std::string text =
        "cd '" + folder_.path().string() + "' || exit 9\n" +  //
        "await() { for i in $(seq 600); do [ -e \"$1\" ] && return; sleep .1; done; echo no $1 >&2; }\n" +
        "'" + binaries + "limn-view' " + arguments + " --debug & viewer=$!\n" +
        "window=$(timeout 60 xdotool search --sync --name '^limn$' | head -n 1)\n" +
        "xdotool windowfocus $window\n" + script + "\nxdotool key ctrl+q\nwait $viewer\n";
    return run({"/usr/bin/timeout", "200", "/usr/bin/xvfb-run", "-a", "-s", "-screen 0 1000x700x24",
                "/bin/sh", "-c", text});
  }
  Image picture(const std::string& name) const { return readImage(folder_ / name); }
  static std::vector<float> colours(const Image& image) {
    const Image rgb = image.select({"R", "G", "B"});
    return {rgb.data().begin(), rgb.data().end()};
  }
  TemporaryFolder folder_;
};

/// After the mouse turned the camera, the saved command gives the saved picture, bit for bit.
TEST_F(ViewerTest, ShowsWhatRenderRenders) {
  const Outcome outcome =
      view("cornell_box --technique pcss --set pcss.filter_samples=16 --size 560x240 --save shown.exr",
           "xdotool mousemove 470 100 mousedown 1 mousemove_relative 30 10 mouseup 1 click 4\n"
           "sleep 1; xdotool key F5; await shown.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Image shown = picture("shown.exr");
  std::string command = shown.metadata().at("command");
  EXPECT_THAT(command, testing::HasSubstr("--eye"));
  command.replace(command.find("shown.exr"), 9, "rendered.exr");
  const Outcome rendered =
      run({"/bin/sh", "-c", "cd '" + folder_.path().string() + "' && '" + binaries + "'" + command});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_EQ(colours(picture("rendered.exr")), colours(shown));
}

TEST_F(ViewerTest, SurvivesABrokenSceneAndEveryTechnique) {
  std::filesystem::copy_file(std::string(binaryDir) + "/assets/lights/lights.glb", folder_ / "mine.glb");
  std::string script = "xdotool key F5; await a.exr; echo broken > mine.glb; xdotool key F4; sleep 1\n";
  for (int i = 0; i < 12; ++i) script += "xdotool key F2; sleep .3\n";
  script +=
      "xdotool key F5; sleep .5; xdotool key F5; sleep 1; mv a.exr b.exr; xdotool key F5; await a.exr\n";
  const Outcome outcome = view("mine.glb --size 480x128 --save a.exr", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(picture("a.exr").width(), 100);
}

TEST_F(ViewerTest, ResizesAndComparesWithTheTruth) {
  const Outcome outcome = view("cornell_box --technique hard_shadow_map --size 480x120 --save a.exr",
                               "xdotool key F3; sleep 1; xdotool key F3; sleep 3\n"
                               "xdotool windowsize $window 600 400; sleep 1; xdotool key F5; await a.exr\n"
                               "xdotool windowsize $window 120 90; sleep 1\n"
                               "xdotool windowsize $window 500 300; sleep 1; xdotool key F6; await a.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(picture("a.exr").width(), 220);
  EXPECT_THAT(contents(folder_ / "a.toml"), testing::HasSubstr("hard_shadow_map"));
}

/// Shaders are read again when they change; one that does not compile leaves its last good version running.
TEST_F(ViewerTest, ReloadsShaders) {
  for (const char* shaders : {"glsl", "techniques"})
    std::filesystem::copy(std::filesystem::path(sourceDir) / shaders, folder_ / shaders,
                          std::filesystem::copy_options::recursive);
  const std::string shader = "techniques/hard_shadow_map/visibility.comp.glsl";
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 480x120 --shaders . --save a.exr",
           "save() { xdotool key F5; await a.exr; mv a.exr $1; }\nsave first.exr\n"
           "cp " +
               shader + " good; echo 'not a shader' >> " + shader +
               "; sleep 1.5; save broken.exr\n"
               "sed 's/? 0.0 : 1.0/? 0.0 : 0.5/' good > " +
               shader + "; sleep 1.5; save changed.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(colours(picture("broken.exr")), colours(picture("first.exr")));
  EXPECT_NE(colours(picture("changed.exr")), colours(picture("first.exr")));
}

}  // namespace
}  // namespace limn::test
