// The rendering thread itself: how it ends.
#include "apps/view/picture_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/view/picture_studio_harness.h"

namespace limn::app {
namespace {

/// Waits until `arrived`, at most a minute.
template <class Arrived>
bool waitFor(Arrived arrived) {
  for (int i = 0; i < 12000 && !arrived(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return arrived();
}

/// As where F5 is pressed while a picture is made, and the window is closed at once.
TEST(PictureThread, SavesWhatWasOrderedBeforeItEnds) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "lamp.glb", saved = folder / "a.png";
  writeFile(file, lampFile());
  {
    PictureThread pictures(PictureThreadOptions{});
    PictureOrder order;
    order.scene.scene = file.string();
    order.size = {16, 12};
    order.techniques.push_back(
        {&kSlowFramesPlugin, ParameterValues(kSlowFrames.name, kSlowFrames.parameters)});
    pictures.open({.scene = order.scene});
    ASSERT_TRUE(waitFor([&] { return pictures.facts()->scene != nullptr; })) << pictures.facts()->message;
    order.of = pictures.facts()->scene;
    SlowFrames::ran = false;
    pictures.show(order);
    ASSERT_TRUE(waitFor([] { return SlowFrames::ran.load(); })) << pictures.facts()->picture.problem;
    pictures.save({.picture = order, .file = saved, .command = {}, .frames = {}});
  }
  EXPECT_TRUE(std::filesystem::exists(saved));
}

}  // namespace
}  // namespace limn::app
