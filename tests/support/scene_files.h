// What the loader's tests share.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/scene_io/load.h"
#include "tests/support/gltf_builder.h"

namespace limn::test {

inline scene::Scene loadBuilt(const GltfBuilder& builder) {
  return scene::loadMemory(builder.glb());
}

/// The message that loading ends in; empty if it succeeds. Every message must be one line.
inline std::string loadError(const std::vector<std::byte>& bytes, const scene::LoadLimits& limits = {}) {
  try {
    scene::loadMemory(bytes, limits);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return {};
}
inline std::string loadError(const std::filesystem::path& file) {
  try {
    scene::load(file);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return {};
}

/// An own folder, removed at the end.
class SceneFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("limn_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "scene");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& name, const std::vector<std::byte>& bytes) const {
    writeFile(folder_ / name, bytes);
    return folder_ / name;
  }
  std::filesystem::path folder_;
};

/// The finest level of a texture.
inline const scene::TextureImage::Level& imageOf(const scene::Scene& scene,
                                                 const scene::TextureRef& texture) {
  return scene.images.at(static_cast<std::size_t>(texture.image)).levels.at(0);
}

inline void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

}  // namespace limn::test
