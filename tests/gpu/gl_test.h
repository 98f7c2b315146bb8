// Fixture for tests that need OpenGL: one context per test suite, from the back end named by
// LIMN_TEST_BACKEND (egl by default), on the EGL device LIMN_TEST_DEVICE if there is one. A test fails when
// it leaves an OpenGL error or a live object behind.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/error.h"
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

  static int testDevice(Backend backend) {
    const char* text = std::getenv("LIMN_TEST_DEVICE");
    return text == nullptr || backend != Backend::egl ? -1 : std::atoi(text);
  }

  /// Whether the tests of this program meet the very same renderer when they run under EGL.
  static bool sameRendererUnderEgl() {
    if (testBackend() == Backend::egl) return false;
    const ContextScope scope(nullptr);
    try {
      const ContextInfo own = context().info(), other = Context::create({.backend = Backend::egl})->info();
      return other.renderer == own.renderer && other.version == own.version;
    } catch (const Error&) {
      return false;  // no EGL here
    }
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

  /// Programs that live on for other tests of the suite do not count as left behind by this one.
  void keepPrograms() { before_.programs = device().counters().programs; }

  static Context& context() { return *suite_->context; }
  static gpu::Device& device() { return suite_->device; }
  static const gl::Functions& gl() { return suite_->context->gl(); }

  /// What two programs that compute the same may differ by, of values near 1: a GPU's compiler contracts
  /// products and sums as each program suggests, llvmpipe's nowhere.
  static float contraction() { return device().software() ? 0 : 1e-6f; }

  /// A bound on the depth of a plane, times what GPUs need: they snap vertices to a 256th of a pixel.
  static float snapped(float bound) { return device().software() ? bound : 4 * bound; }

  /// The message of the Error that `action` throws; empty when it throws none.
  static std::string errorOf(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

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
        : context(Context::create(
              {.backend = backend, .device = testDevice(backend), .debug = true, .visible = false})),
          device(*context) {}
    std::unique_ptr<Context> context;
    gpu::Device device;
  };
  static inline std::unique_ptr<Suite> suite_;

  std::optional<gpu::ShaderLibrary> shaders_;
  gpu::Counters before_;
};

/// Compiles each program once for all tests of a suite, which mount no two texts under one name. Whether any
/// is left behind shows at the end of the suite.
class SharedProgramsTest : public GlTest {
 public:
  static void SetUpTestSuite() {
    GlTest::SetUpTestSuite();
    library_.emplace(device());
    library_->mount("", embeddedSources());
  }
  static void TearDownTestSuite() {
    if (library_) {  // not where there was no context
      library_.reset();
      EXPECT_EQ(device().counters().programs, 0) << "live programs";
    }
    GlTest::TearDownTestSuite();
  }

 protected:
  void TearDown() override {
    keepPrograms();
    GlTest::TearDown();
  }

  /// The library of the suite, with limn's own sources.
  static gpu::ShaderLibrary& shaders() { return *library_; }

 private:
  static inline std::optional<gpu::ShaderLibrary> library_;
};

/// Laws of techniques take minutes and say of one renderer the same twice: under OSMesa they are skipped
/// where EGL has that renderer, too, unless LIMN_TEST_EVERYTHING is set. Contexts, resources, shadow maps,
/// the frame graph and every technique's golden picture are tested with both.
template <class Base>
class OncePerRenderer : public Base {
 protected:
  void SetUp() override {
    Base::SetUp();
    static const bool again = std::getenv("LIMN_TEST_EVERYTHING") == nullptr && Base::sameRendererUnderEgl();
    if (again)
      GTEST_SKIP() << "EGL has the same renderer and runs this (LIMN_TEST_EVERYTHING=1 runs it here, too)";
  }
};

}  // namespace limn
