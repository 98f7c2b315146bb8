// The truth that the viewer refines in the background.
#include "apps/view/reference_worker.h"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "core/session/view.h"

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

}  // namespace
}  // namespace limn::app
