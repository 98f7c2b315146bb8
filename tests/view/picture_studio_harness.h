// A rendering thread's work without its thread and without a window, a scene for it to open and a technique
// that takes its time.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "apps/view/picture_studio.h"
#include "core/base/file.h"
#include "core/context/context.h"
#include "core/gpu/device.h"
#include "core/technique/technique.h"
#include "tests/cli/process.h"
#include "tests/support/gltf_builder.h"

namespace limn::app {

/// Returns the file of a lamp of a mesh, a square that shines, seen from above.
inline std::vector<std::byte> lampFile(const char* name = "lamp") {
  test::GltfBuilder b;
  const int material = b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  const int corners = b.vec3({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  const int mesh = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), material);
  b.node({{"name", name}, {"mesh", mesh}});
  return b.glb();
}

/// Darkens everything, in frames that take so long that pictures are smaller while things move.
class SlowFrames : public Technique {
 public:
  static inline std::atomic<bool> ran = false;

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs&,
                                 const TermRequest& request) override {
    frame::PassBuilder pass = graph.addPass("clear", "slow_frames");
    const auto target = pass.write(request.target, frame::Access::copyTarget, "black");
    pass.execute([target](frame::PassContext& passContext) {
      ran = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      passContext.gl().ClearTexImage(passContext.texture(target).id(), 0, GL_RED, GL_FLOAT, nullptr);
    });
    return target;
  }
};

inline constexpr TechniqueInfo kSlowFrames{.name = "slow_frames",
                                           .title = "Slow frames",
                                           .source = "a test",
                                           .terms = termSet(Term::visibility),
                                           .parameters = {},
                                           .stress = {}};

inline const TechniquePlugin kSlowFramesPlugin{
    {},
    &kSlowFrames,
    [] { return std::span<const gpu::EmbeddedSource>(); },
    []() -> std::unique_ptr<Technique> { return std::make_unique<SlowFrames>(); }};

class PictureStudioTest : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const std::unique_ptr<Context> context = Context::create({});
  gpu::Device device{*context};
  PictureFacts facts;                              ///< the newest
  std::function<void(const PictureFacts&)> heard;  ///< is told of each before it is the newest; may be none
  PictureOrder order;
  PictureStudio studio{device,
                       {},
                       {},
                       [this](const PictureFacts& newest) {
                         if (heard) heard(newest);
                         facts = newest;
                       },
                       [] {}};

  PictureStudioTest() { order.size = {16, 12}; }

  /// Opens a scene of this file with what else the order says of it.
  void open(const std::vector<std::byte>& file) {
    const std::filesystem::path path = folder / "lamp.glb";
    writeFile(path, file);
    order.scene.scene = path.string();
    studio.open({.scene = order.scene});
    ASSERT_TRUE(facts.scene) << facts.message;
    order.of = facts.scene;
  }
  void step() {
    studio.step(order, [] { return false; });
  }
};

}  // namespace limn::app
