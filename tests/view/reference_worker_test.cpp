// The truth that the viewer refines in the background.
#include "apps/view/reference_worker.h"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "core/base/file.h"
#include "core/session/view.h"
#include "tests/cli/process.h"
#include "tests/support/gltf_builder.h"

namespace limn::app {
namespace {

/// Pictures of 64 samples and more are kept; where they cannot be, finer ones follow all the same.
TEST(ReferenceWorker, RefinesWhatCannotBeKept) {
  SceneQuestion question;
  question.scene = "cornell_box";
  const auto view = std::make_shared<const session::View>(session::open(question));
  ReferenceWorker worker("/proc/x", [] {});
  worker.start({.view = view, .pose = view->pose, .camera = view->camera, .size = {8, 8}});
  while (worker.busy() && worker.state().spp <= 64) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const ReferenceWorker::State state = worker.state();
  EXPECT_GT(state.spp, 64);
  EXPECT_EQ(state.problem, "");
  EXPECT_THAT(state.unkept, testing::HasSubstr("/proc/x"));
  EXPECT_TRUE(worker.take());
}

/// Where light is rare the first samples may all miss it: a picture that is still black is no truth yet,
/// though it has no noise.
TEST(ReferenceWorker, GoesOnWhileNothingIsSeen) {
  const test::TemporaryFolder folder;
  test::GltfBuilder b;
  b.triangle();
  const std::filesystem::path file = folder / "dark.glb";
  writeFile(file, b.glb());
  SceneQuestion question;
  question.scene = file.string();
  question.defaultLights = "off";
  const auto view = std::make_shared<const session::View>(session::open(question));
  ReferenceWorker worker({}, [] {});
  worker.start({.view = view, .pose = view->pose, .camera = view->camera, .size = {4, 4}});
  while (worker.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(worker.state().spp, 4096) << "until there is no hope";
  EXPECT_EQ(worker.state().problem, "");
}

}  // namespace
}  // namespace limn::app
