// The rendering thread itself: how it ends.
#include "apps/view/picture_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <span>
#include <thread>

#include "core/technique/technique.h"
#include "tests/view/picture_studio_harness.h"

namespace limn::app {
namespace {

/// Darkens everything, in frames that take long enough for something to happen meanwhile.
class LongFrames : public Technique {
 public:
  static inline std::atomic<bool> begun = false;

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs&,
                                 const TermRequest& request) override {
    frame::PassBuilder pass = graph.addPass("clear", "long_frames");
    const auto target = pass.write(request.target, frame::Access::copyTarget, "black");
    pass.execute([target](frame::PassContext& passContext) {
      begun = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      passContext.gl().ClearTexImage(passContext.texture(target).id(), 0, GL_RED, GL_FLOAT, nullptr);
    });
    return target;
  }
};

constexpr TechniqueInfo kLongFrames{.name = "long_frames",
                                    .title = "Long frames",
                                    .source = "a test",
                                    .terms = termSet(Term::visibility),
                                    .parameters = {},
                                    .stress = {}};

const TechniquePlugin kLongFramesPlugin{
    {},
    &kLongFrames,
    [] { return std::span<const gpu::EmbeddedSource>(); },
    []() -> std::unique_ptr<Technique> { return std::make_unique<LongFrames>(); }};

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
        {&kLongFramesPlugin, ParameterValues(kLongFrames.name, kLongFrames.parameters)});
    pictures.open({.scene = order.scene});
    ASSERT_TRUE(waitFor([&] { return pictures.facts()->scene != nullptr; })) << pictures.facts()->message;
    order.of = pictures.facts()->scene;
    pictures.show(order);
    ASSERT_TRUE(waitFor([] { return LongFrames::begun.load(); })) << pictures.facts()->picture.problem;
    pictures.save({.picture = order, .file = saved, .command = {}, .frames = {}});
  }
  EXPECT_TRUE(std::filesystem::exists(saved));
}

}  // namespace
}  // namespace limn::app
