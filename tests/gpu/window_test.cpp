// The GLFW back end. Needs a display: ctest runs these under Xvfb, elsewhere they are skipped without one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "core/base/error.h"
#include "core/context/context.h"
#include "core/gpu/objects.h"

namespace limn {
namespace {

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr)
      GTEST_SKIP() << "no display";
  }

  static std::unique_ptr<Context> create(Backend backend) {
    return Context::create({.backend = backend, .debug = true, .width = 64, .height = 48});
  }
};

TEST_F(WindowTest, opensWithOpenGl45) {
  const auto context = create(Backend::glfw);
  EXPECT_NE(context->window(), nullptr);
  EXPECT_EQ(context->info().backend, Backend::glfw);
  GLint major = 0, minor = 0;
  context->gl().GetIntegerv(GL_MAJOR_VERSION, &major);
  context->gl().GetIntegerv(GL_MINOR_VERSION, &minor);
  EXPECT_GE(10 * major + minor, 45);
  EXPECT_THAT(context->takeErrors(), ::testing::IsEmpty());
}

TEST_F(WindowTest, takesTurnsWithTheOtherBackEnds) {
  const std::array contexts = {create(Backend::glfw), create(Backend::egl), create(Backend::osmesa)};
  for (int i = 0; i < 21; ++i) {
    Context& context = *contexts[static_cast<size_t>(i) % contexts.size()];
    context.makeCurrent();
    const GLubyte* renderer = context.gl().GetString(GL_RENDERER);
    ASSERT_NE(renderer, nullptr) << "turn " << i;
    EXPECT_EQ(context.info().renderer, reinterpret_cast<const char*>(renderer));

    gpu::Device device(context);
    gpu::Texture texture(device, "turn", {.format = GL_R32F, .width = 2, .height = 2});
    texture.clear({static_cast<float>(i), 0, 0, 0});
    std::array<float, 4> texels{};
    texture.read(0, GL_RED, GL_FLOAT, texels.data(), sizeof texels);
    ASSERT_EQ(texels[3], static_cast<float>(i));
  }
  for (const auto& context : contexts) EXPECT_THAT(context->takeErrors(), ::testing::IsEmpty());
}

TEST_F(WindowTest, impossibleSizesAreRefused) {
  EXPECT_THROW(Context::create({.backend = Backend::glfw, .width = -1}), UsageError);
  EXPECT_THROW(Context::create({.backend = Backend::glfw, .height = 1 << 30}), UsageError);
  EXPECT_THROW(Context::create({.backend = Backend::glfw, .device = 0}), UsageError);
}

}  // namespace
}  // namespace limn
