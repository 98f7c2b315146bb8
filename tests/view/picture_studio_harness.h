// A rendering thread's work without its thread and without a window, and a scene for it to open.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "apps/view/picture_studio.h"
#include "core/base/file.h"
#include "core/context/context.h"
#include "core/gpu/device.h"
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
