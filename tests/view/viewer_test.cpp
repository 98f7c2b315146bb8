// The viewer in a real window, under Xvfb, with a real mouse and keyboard (xdotool).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/image/image.h"
#include "tests/cli/process.h"
#include "tests/support/paths.h"

namespace limn::test {
namespace {

// A frame of the window, milliseconds: 50 where nobody else uses the two cores, up to 900 measured with a
// dozen processes on them, where compilations and pictures take many seconds.
constexpr double longestMs = 2000;
constexpr double growthMiB =
    24;  // over three rounds; what a leak of one picture or program in each would exceed

const std::string binaries = std::string(binaryDir) + "/bin/";

class ViewerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run({"/bin/sh", "-c", "command -v xvfb-run && command -v xdotool"}).status != 0)
      GTEST_SKIP() << "needs xvfb-run and xdotool";
  }

  /// Starts limn-view with `arguments` in the folder, waits for its window, then does what `script` says.
  /// `await FILE` waits for a file, `save FILE` for the picture of the moment, which limn-view saves as
  /// a.exr; the window is closed at the end.
  Outcome view(const std::string& arguments, const std::string& script) {
    const std::string text =
        "cd '" + folder_.path().string() + "' || exit 9\n" +  //
        "await() { for i in $(seq 600); do [ -e \"$1\" ] && return; sleep .1; done; echo no $1 >&2; }\n" +
        "save() { xdotool key F5; await a.exr; mv a.exr $1; }\n" + "'" + binaries + "limn-view' " +
        arguments + " --debug & viewer=$!\n" +
        "window=$(timeout 60 xdotool search --sync --onlyvisible --name '^limn$' | head -n 1)\n" +
        "until xdotool windowfocus $window 2> unfocused; do sleep .1; done\n" + script +
        "\nxdotool key ctrl+q\nwait $viewer\n";
    return run({"/usr/bin/timeout", "200", "/usr/bin/xvfb-run", "-a", "-s", "-screen 0 1000x700x24",
                "/bin/sh", "-c", text});
  }
  /// The picture that the window shows after `script` is the one that the command kept in it renders.
  void expectSamePixels(const std::string& arguments, const std::string& script, const std::string& said) {
    std::filesystem::remove(folder_ / "shown.exr");
    const Outcome outcome = view(arguments + " --save a.exr", script + "\nsave shown.exr");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Image shown = picture("shown.exr");
    std::string command = shown.metadata().at("command");
    EXPECT_THAT(command, testing::HasSubstr(said));
    command.replace(command.find("a.exr"), 5, "rendered.exr");
    const Outcome rendered =
        run({"/bin/sh", "-c", "cd '" + folder_.path().string() + "' && '" + binaries + "'" + command});
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
  static std::vector<float> colours(const Image& image) {
    const Image rgb = image.select({"R", "G", "B"});
    return {rgb.data().begin(), rgb.data().end()};
  }
  TemporaryFolder folder_;
};

/// A drag across the picture, slow enough for a window whose frames take long; `save` before it waits for the
/// first picture.
const char* const drag =
    "save first.exr; xdotool mousemove 470 100 mousedown 1; sleep .4; xdotool mousemove_relative 30 10; "
    "sleep .4\n"
    "xdotool mouseup 1; sleep .4; ";

/// After the mouse turned the camera, the saved command gives the saved picture, bit for bit.
TEST_F(ViewerTest, ShowsWhatRenderRenders) {
  expectSamePixels("cornell_box --technique pcss --set pcss.filter_samples=16 --size 560x240",
                   std::string(drag) + "xdotool click 4; sleep 1", "--eye");
}

/// Lights that were moved, and default lights, which stand by the camera.
TEST_F(ViewerTest, ShowsTheLightsThatRenderShows) {
  expectSamePixels(
      "lights --technique pcss --size 560x240 --set-light key.position=0.2,1.7,0.3 "
      "--set-light key.rotation=-80,10,0",
      "", "--set-light key.position=0.2,1.7,0.3");
  expectSamePixels("gem --default-lights on --technique hard_shadow_map --size 560x240",
                   std::string(drag) + "sleep 1", "--default-lights on");
}

TEST_F(ViewerTest, SurvivesABrokenSceneAndEveryTechnique) {
  std::filesystem::copy_file(std::string(binaryDir) + "/assets/lights/lights.glb", folder_ / "mine.glb");
  std::string script = "save first.exr; echo broken > mine.glb; xdotool key F4; sleep 1\n";
  for (int i = 0; i < 16; ++i) script += "xdotool key F2; save " + std::to_string(i) + ".exr\n";
  const Outcome outcome = view("mine.glb --size 500x128 --save a.exr", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(picture("15.exr").width(), 100);
  EXPECT_NE(colours(picture("0.exr")), colours(picture("first.exr")));
}

/// Moved from one size to another, hidden and shown, as small as a window gets.
TEST_F(ViewerTest, ResizesHidesAndComparesWithTheTruth) {
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 500x120 --save a.exr",
           "xdotool key F3; sleep 1; xdotool key F3; sleep 2\n"
           "xdotool windowsize $window 620 400; sleep 1; save b.exr\n"
           "xdotool windowunmap $window; sleep 1; xdotool windowmap $window; xdotool windowfocus $window\n"
           "xdotool windowsize $window 120 90; sleep 1; xdotool windowsize $window 1 1; sleep 1\n"
           "xdotool windowsize $window 500 300; sleep 1; xdotool windowfocus $window; xdotool key F6\n"
           "await a.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(picture("b.exr").width(), 220);
  EXPECT_THAT(contents(folder_ / "a.toml"), testing::HasSubstr("hard_shadow_map"));
}

/// Shaders are read again when they change; one that does not compile leaves its last good version running.
TEST_F(ViewerTest, ReloadsShaders) {
  for (const char* shaders : {"glsl", "techniques"})
    std::filesystem::copy(std::filesystem::path(sourceDir) / shaders, folder_ / shaders,
                          std::filesystem::copy_options::recursive);
  const std::string shader = "techniques/hard_shadow_map/visibility.comp.glsl";
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 500x120 --shaders . --save a.exr",
           "save first.exr\ncp " + shader + " good; echo 'not a shader' >> " + shader +
               "; sleep 1.5; save broken.exr\nsed 's/? 0.0 : 1.0/? 0.0 : 0.5/' good > " + shader +
               "; sleep 1.5; save changed.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(colours(picture("broken.exr")), colours(picture("first.exr")));
  EXPECT_NE(colours(picture("changed.exr")), colours(picture("first.exr")));
}

/// Every texture that a frame writes can be looked at, and looking changes no pixel.
TEST_F(ViewerTest, InspectsEveryTexture) {
  std::string script = "save first.exr\n";
  for (int i = 0; i < 24; ++i) script += "xdotool key F8; sleep .2\n";
  const Outcome outcome = view("cornell_box --technique vssm --size 640x240 --open frame --save a.exr",
                               script + "save last.exr; xdotool key Escape; sleep .3");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(colours(picture("first.exr")), colours(picture("last.exr")));
}

/// The frames of a sequence are those of limn render.
TEST_F(ViewerTest, SavesSequences) {
  const Outcome outcome = view("metaballs --technique hard_shadow_map --size 500x120 --save a.exr",
                               "xdotool key F10; await a.0029.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Image frame = picture("a.0007.exr");
  const Outcome rendered =
      run({binaries + "limn", "render", "metaballs", "--technique", "hard_shadow_map", "--size",
           std::to_string(frame.width()) + "x" + std::to_string(frame.height()), "--frames", "7:7", "--out",
           (folder_ / "b.exr").string()});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_EQ(colours(frame), colours(picture("b.0007.exr")));
}

/// What the window computed of the truth is what `limn reference` finds in the same cache.
TEST_F(ViewerTest, KeepsTheTruthOnDisk) {
  const auto kept = [&] {
    const std::filesystem::path folder = folder_ / "out/references";
    return std::filesystem::exists(folder) ? std::distance(std::filesystem::directory_iterator(folder), {})
                                           : 0;
  };
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 500x120 --compare truth --save a.exr",
           "for i in $(seq 300); do ls out/references/*.exr > files 2> none && break; sleep .1; done\n"
           "save b.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  ASSERT_GT(kept(), 0);
  const auto before = kept();
  const Image shown = picture("b.exr");
  const Outcome reference =
      run({"/bin/sh", "-c",
           "cd '" + folder_.path().string() + "' && '" + binaries +
               "limn' reference cornell_box --term final --size " + std::to_string(shown.width()) + "x" +
               std::to_string(shown.height()) + " --spp 64 --cache out/references --out c.exr"});
  ASSERT_EQ(reference.status, 0) << reference.err;
  EXPECT_EQ(kept(), before) << "it was found";
}

/// Input is answered while techniques compile, slow pictures are rendered and the truth is computed.
TEST_F(ViewerTest, StaysResponsive) {
  std::string script;
  for (int i = 0; i < 12; ++i)
    script += "xdotool key F2 mousemove 600 200 mousedown 1 mousemove_relative 20 5 mouseup 1; sleep .7\n";
  const Outcome outcome =
      view("robot --technique vssm --size 900x600 --compare truth --open frame --stats stats.json", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LT(number("longest_ms"), longestMs) << contents(folder_ / "stats.json");
  EXPECT_GE(number("pictures"), 2);
}

/// Switching techniques and scenes over and over, the process does not grow after it has seen them all.
TEST_F(ViewerTest, DoesNotGrow) {
  const std::string round =
      "for k in 1 2 3 4 5 6; do xdotool key F2 F8 F3; sleep .6; done; xdotool key F4; sleep 1\n"
      "cut -d ' ' -f 2 /proc/$viewer/statm >> pages\n";
  std::string script;
  for (int i = 0; i < 9; ++i) script += round;
  const Outcome outcome =
      view("cornell_box --technique pcss --size 560x160 --open frame --cache '' --save a.exr", script);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::ifstream file(folder_ / "pages");
  const std::vector<double> pages{std::istream_iterator<double>(file), {}};
  ASSERT_EQ(pages.size(), 9u);
  const auto middle = [&](size_t from) {
    std::vector<double> three(pages.begin() + static_cast<long>(from),
                              pages.begin() + static_cast<long>(from) + 3);
    std::ranges::sort(three);
    return three[1] * 4096 / (1 << 20);
  };
  EXPECT_LT(middle(6), middle(3) + growthMiB) << contents(folder_ / "pages");
}

}  // namespace
}  // namespace limn::test
