// What the viewer shows is what `limn render` and `limn bench` make of what it saves.
#include "tests/view/viewer_window_test.h"

namespace limn::test {
namespace {

class ViewerPixelsTest : public ViewerWindowTest {};

/// After the mouse turned the camera, the saved command gives the saved picture, bit for bit.
TEST_F(ViewerPixelsTest, ShowsWhatRenderRenders) {
  expectSamePixels("cornell_box --technique pcss --set pcss.filter_samples=16 --size 160x212",
                   std::string(kDrag) + "xdotool click 4; frames 2", "--eye");
}

/// Several samples in each pixel, on a floor.
TEST_F(ViewerPixelsTest, ShowsTheSamplesThatRenderTakes) {
  expectSamePixels("gem --technique hard_shadow_map --aa 3 --floor on --size 120x90", kDrag, "--aa 3");
}

/// Frames over which techniques average, alone and with several samples in each pixel.
TEST_F(ViewerPixelsTest, ShowsTheFramesThatRenderAverages) {
  const std::string arguments =
      "cornell_box --technique instant_radiosity --set instant_radiosity.vpls=16 --set "
      "instant_radiosity.history=4 --size 120x90";
  expectSamePixels(arguments, kDrag, "history=4");
  expectSamePixels(arguments + " --aa 2", kDrag, "--aa 2");
}

/// The exposure that the picture determines is that of limn render.
TEST_F(ViewerPixelsTest, ExposesAsRenderDoes) {
  const std::string question = "cornell_box --technique pcss --exposure auto --tonemap agx --size 160x132";
  const Outcome outcome = view(question + " --save a.png", "xdotool key F5; await a.png");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Outcome rendered = run({"/bin/sh", "-c",
                                "cd '" + folder_.path().string() + "' && '" + kBinaries + "limn' render " +
                                    question + " --out b.png"});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_EQ(colours(picture("a.png")), colours(picture("b.png")));
}

/// Lights that were moved, and default lights, which stand by the camera.
TEST_F(ViewerPixelsTest, ShowsTheLightsThatRenderShows) {
  expectSamePixels(
      "lights --technique pcss --size 160x212 --set-light key.position=0.2,1.7,0.3 "
      "--set-light key.rotation=-80,10,0",
      "", "--set-light key.position=0.2,1.7,0.3");
  expectSamePixels("gem --default-lights on --technique hard_shadow_map --size 160x212", kDrag,
                   "--default-lights on");
}

/// Also one that is a mesh, and has been made smaller and blue.
TEST_F(ViewerPixelsTest, ShowsTheMeshesThatRenderShows) {
  const std::string arguments =
      "cornell_box --technique pcss --size 160x212 --set-light key.position=0.2,1.6,0.1 "
      "--set-light key.rotation=-70,20,0 --set-light key.size=0.3,0.2 --set-light key.colour=0.2,0.4,1";
  expectSamePixels(arguments, "", "--set-light key.size=0.3,0.2");
}

/// What a saved suite measures is what was shown: lights, camera and environment as they were changed.
TEST_F(ViewerPixelsTest, SuitesMeasureWhatItShows) {
  const Outcome outcome = view(
      "cornell_box --technique pcss --size 160x212 --set-light key.position=0.2,1.6,0.1 --set-light "
      "key.rotation=-70,20,0 --environment sky --environment-rotation 40 --environment-scale 0.5 --save "
      "a.png",
      "xdotool key F5; await a.png; rm a.png; point 470 100; xdotool mousedown 1; frames 2; point 500 110\n"
      "xdotool mouseup 1; frames 2; xdotool key F5; await a.png");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string suite = contents(folder_ / "a.toml");
  EXPECT_THAT(suite, testing::HasSubstr("eye = "));
  EXPECT_THAT(suite, testing::HasSubstr("set_light = "));
  const Outcome bench = run(
      {"/bin/sh", "-c",
       "cd '" + folder_.path().string() +
           "' && sed -i 's/^reference = .*/reference = {spp = 1}\\nframes = 1\\nwarmup = 0/' a.toml && '" +
           kBinaries +
           "limn' bench a.toml --out bench && cp bench/pictures/$(sed -n "
           "'s|.*\"picture\":\"pictures/\\([^\"]*\\)\".*|\\1|p' bench/results.jsonl) bench.png"});
  ASSERT_EQ(bench.status, 0) << bench.err;
  EXPECT_EQ(colours(picture("bench.png")), colours(picture("a.png")));
}

}  // namespace
}  // namespace limn::test
