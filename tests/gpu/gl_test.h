// Fixture for tests that need OpenGL: one context per test suite, from the back end named by
// LIMN_TEST_BACKEND (egl by default). A test fails when it leaves an OpenGL error or a live object behind.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "core/context/context.h"
#include "core/gpu/device.h"
#include "core/gpu/objects.h"
#include "core/gpu/shader_library.h"

namespace limn {

class GlTest : public ::testing::Test {
 public:
  static Backend testBackend() {
    const char* text = std::getenv("LIMN_TEST_BACKEND");
    return text == nullptr ? Backend::egl : parseBackend(text);
  }

  static void SetUpTestSuite() { suite_ = std::make_unique<Suite>(testBackend()); }
  static void TearDownTestSuite() { suite_.reset(); }

 protected:
  void SetUp() override {
    context().makeCurrent();
    before_ = device().counters();
  }

  /// A fixture that overrides this destroys its own GPU objects first and calls it last.
  void TearDown() override {
    shaders_.reset();
    for (const std::string& error : context().takeErrors()) ADD_FAILURE() << error;
    const gpu::Counters& now = device().counters();
    EXPECT_EQ(now.buffers, before_.buffers) << "live buffers";
    EXPECT_EQ(now.textures, before_.textures) << "live textures";
    EXPECT_EQ(now.framebuffers, before_.framebuffers) << "live framebuffers";
    EXPECT_EQ(now.programs, before_.programs) << "live programs";
    EXPECT_EQ(now.queries, before_.queries) << "live queries";
    EXPECT_EQ(now.samplers, before_.samplers) << "live samplers";
    EXPECT_EQ(now.vertexArrays, before_.vertexArrays) << "live vertex arrays";
    EXPECT_EQ(now.bufferBytes, before_.bufferBytes);
    EXPECT_EQ(now.textureBytes, before_.textureBytes);
  }

  static Context& context() { return *suite_->context; }
  static gpu::Device& device() { return suite_->device; }
  static const gl::Functions& gl() { return suite_->context->gl(); }

  /// A library of this test with limn's own sources; made at the first call.
  gpu::ShaderLibrary& shaders() {
    if (!shaders_) {
      shaders_.emplace(device());
      shaders_->mount("", embeddedSources());
    }
    return *shaders_;
  }

 private:
  struct Suite {
    explicit Suite(Backend backend)
        : context(Context::create({.backend = backend, .debug = true, .visible = false})), device(*context) {}
    std::unique_ptr<Context> context;
    gpu::Device device;
  };
  static inline std::unique_ptr<Suite> suite_;

  std::optional<gpu::ShaderLibrary> shaders_;
  gpu::Counters before_;
};

}  // namespace limn
