#include "core/context/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "core/base/error.h"
#include "core/gpu/objects.h"

namespace limn {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string rendererOf(const Context& context) {
  const GLubyte* text = context.gl().GetString(GL_RENDERER);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

/// Clears a small framebuffer to `value` and reads a pixel back: black where the dispatch is lost.
float drawnValue(Context& context, float value) {
  gpu::Device device(context);
  const gpu::Texture target(device, "target", {.format = GL_RGBA32F, .width = 8, .height = 8});
  const gpu::Attachment attachments[] = {{&target}};
  const gpu::Framebuffer framebuffer(device, "target", attachments);
  const float colour[] = {value, 0, 0, 1};
  context.gl().ClearNamedFramebufferfv(framebuffer.id(), GL_COLOR, 0, colour);
  std::array<float, 8 * 8 * 4> pixels{};
  target.read(0, GL_RGBA, GL_FLOAT, pixels.data(), sizeof pixels);
  return pixels[4 * 63];
}

bool hasOsmesa() {
  const std::vector<DeviceDescription> devices = listDevices();
  return std::ranges::any_of(devices, [](const DeviceDescription& device) {
    return device.backend == Backend::osmesa && device.problem.empty();
  });
}

/// Of machines with a GPU some have no Mesa.
class BackEndsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hasOsmesa()) GTEST_SKIP() << "OSMesa is not installed";
  }
};

TEST(ContextTest, everyBackEndHasItsNameAndNoOther) {
  for (const Backend backend : {Backend::egl, Backend::osmesa, Backend::glfw}) {
    EXPECT_EQ(parseBackend(name(backend)), backend);
  }
  EXPECT_THROW(
      {
        try {
          parseBackend("vulkan");
        } catch (const UsageError& error) {
          EXPECT_STREQ(error.what(), "unknown back end 'vulkan': accepted are egl, osmesa, glfw");
          throw;
        }
      },
      UsageError);
}

TEST_F(BackEndsTest, saysWhatItIs) {
  for (const Backend backend : {Backend::egl, Backend::osmesa}) {
    const auto context = Context::create({.backend = backend});
    EXPECT_TRUE(context->isCurrent());
    EXPECT_EQ(context->info().backend, backend);
    EXPECT_EQ(context->info().renderer, rendererOf(*context));
    EXPECT_THAT(context->info().version, HasSubstr("4."));
    EXPECT_EQ(context->window(), nullptr);
  }
}

// A pitfall of Mesa: an OSMesa context that replaces a current EGL one without a release leaves no dispatch.
TEST_F(BackEndsTest, backEndsAlternateInOneProcess) {
  for (int i = 0; i < 20; ++i) {
    const auto context =
        Context::create({.backend = i % 2 == 0 ? Backend::egl : Backend::osmesa, .debug = true});
    ASSERT_THAT(rendererOf(*context), Not(IsEmpty())) << "alternation " << i;
    ASSERT_EQ(drawnValue(*context, static_cast<float>(i + 1)), static_cast<float>(i + 1))
        << "alternation " << i;
    EXPECT_THAT(context->takeErrors(), IsEmpty());
  }
}

TEST_F(BackEndsTest, liveContextsOfSeveralBackEndsTakeTurns) {
  const auto egl = Context::create({.backend = Backend::egl, .debug = true});
  const auto osmesa = Context::create({.backend = Backend::osmesa, .debug = true});
  const auto secondEgl = Context::create({.backend = Backend::egl, .debug = true});
  const std::array contexts = {egl.get(), osmesa.get(), secondEgl.get()};
  for (int i = 0; i < 21; ++i) {
    Context& context = *contexts[static_cast<size_t>(i) % contexts.size()];
    context.makeCurrent();
    ASSERT_EQ(Context::current(), &context);
    ASSERT_EQ(rendererOf(context), context.info().renderer) << "turn " << i;
    ASSERT_EQ(drawnValue(context, static_cast<float>(i + 1)), static_cast<float>(i + 1)) << "turn " << i;
  }
  for (Context* context : contexts) EXPECT_THAT(context->takeErrors(), IsEmpty());
}

TEST_F(BackEndsTest, destroyingOneLeavesAnotherBackEndsContextWorking) {
  const auto egl = Context::create({.backend = Backend::egl});
  auto osmesa = Context::create({.backend = Backend::osmesa});
  egl->makeCurrent();
  osmesa.reset();
  EXPECT_TRUE(egl->isCurrent());
  EXPECT_THAT(rendererOf(*egl), Not(IsEmpty()));
  EXPECT_EQ(drawnValue(*egl, 3), 3);
}

TEST_F(BackEndsTest, objectsDieInTheirOwnContext) {
  const auto egl = Context::create({.backend = Backend::egl, .debug = true});
  gpu::Device eglDevice(*egl);
  gpu::Buffer first(eglDevice, "first", 64);
  const auto osmesa = Context::create({.backend = Backend::osmesa, .debug = true});
  gpu::Device osmesaDevice(*osmesa);
  const uint32_t value = 7;
  const gpu::Buffer second(osmesaDevice, "second", sizeof value, gpu::BufferUse::fixed, &value);
  ASSERT_EQ(first.id(), second.id()) << "the point of the test is that both have the same name";
  first = gpu::Buffer();
  EXPECT_TRUE(osmesa->isCurrent());
  uint32_t readBack = 0;
  second.read(0, &readBack, sizeof readBack);
  EXPECT_EQ(readBack, value);
  EXPECT_THAT(egl->takeErrors(), IsEmpty());
  EXPECT_THAT(osmesa->takeErrors(), IsEmpty());
}

TEST(ContextTest, aFailedCreationLeavesTheCurrentContextCurrent) {
  const auto context = Context::create({.backend = Backend::egl});
  EXPECT_THROW(Context::create({.backend = Backend::egl, .device = 99}), Error);
  EXPECT_TRUE(context->isCurrent());
  EXPECT_EQ(rendererOf(*context), context->info().renderer);
}

TEST(ContextTest, unknownDevicesAreRefusedWithTheRange) {
  try {
    Context::create({.backend = Backend::egl, .device = 99});
    FAIL() << "device 99 was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("EGL device 99 does not exist: accepted are 0 to "));
  }
  EXPECT_THROW(Context::create({.backend = Backend::osmesa, .device = 0}), UsageError);
}

TEST(ContextTest, errorsOfTheDriverAreCollectedOnce) {
  const auto context = Context::create({.backend = Backend::egl, .debug = true});
  context->gl().Enable(GL_TEXTURE_2D);  // not in the core profile
  const auto errors = context->takeErrors();
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_THAT(errors[0], HasSubstr("OpenGL (API): "));
  EXPECT_THAT(errors[0], Not(HasSubstr("\n")));
  EXPECT_THAT(context->takeErrors(), IsEmpty());
  EXPECT_NO_THROW(context->throwErrors());
  context->gl().Enable(GL_TEXTURE_2D);
  try {
    context->throwErrors();
    ADD_FAILURE() << "the error is not thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), errors[0]);
  }
  EXPECT_NO_THROW(context->throwErrors());
}

TEST(ContextTest, aScopeLeavesCurrentWhatWasCurrentBeforeIt) {
  Context::release();
  std::unique_ptr<Context> context;
  {
    const ContextScope none(nullptr);
    context = Context::create({.backend = Backend::egl});
  }
  EXPECT_EQ(Context::current(), nullptr) << "another thread could not make it current";
  context->makeCurrent();
  {
    const ContextScope same(context.get());
    Context::release();
  }
  EXPECT_TRUE(context->isCurrent());
}

TEST(ContextTest, listsWhatThisMachineOffers) {
  const auto context = Context::create({.backend = Backend::egl});
  bool egl = false;
  for (const DeviceDescription& device : listDevices()) {
    EXPECT_NE(device.description.empty(), device.problem.empty());
    egl |= device.backend == Backend::egl && device.problem.empty();
  }
  EXPECT_TRUE(egl);
  EXPECT_TRUE(hasOsmesa() || !context->info().software) << "the tests of several back ends would be skipped";
  EXPECT_TRUE(context->isCurrent());
  EXPECT_THAT(rendererOf(*context), Not(IsEmpty()));
}

// In a process of its own: the vendor library is chosen when libEGL is first used.
TEST(ContextDeathTest, aMachineWithoutEglIsToldSo) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
        try {
          Context::create({.backend = Backend::egl});
        } catch (const Error& error) {
          fprintf(stderr, "%s\n", error.what());
          std::_Exit(1);
        }
        std::_Exit(0);
      },
      ::testing::ExitedWithCode(1), "^no EGL driver offers .*--backend osmesa.\n$");
}

/// Makes a context with a limit on what the process may use; ends it with the message.
[[noreturn]] void createWithin(Backend backend, int resource, rlim_t limit) {
  rlimit limits{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limits);
  limits.rlim_cur = limit;
  if (setrlimit(static_cast<__rlimit_resource>(resource), &limits) != 0) std::_Exit(2);
  try {
    Context::create({.backend = backend});
  } catch (const Error& error) {
    fprintf(stderr, "%s\n", error.what());
    std::_Exit(1);
  }
  std::_Exit(0);
}

TEST(ContextDeathTest, tooFewOpenFilesAreNamedAsTheCause) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const Backend backend : {Backend::egl, Backend::osmesa}) {
    EXPECT_EXIT(createWithin(backend, RLIMIT_NOFILE, 3), ::testing::ExitedWithCode(1),
                "(EGL|OSMesa) cannot be .*Too many open files.*ulimit -n");
  }
}

#if !defined(LIMN_SANITIZED)  // whose shadow memory takes terabytes of addresses
TEST(ContextDeathTest, tooLittleMemoryIsNamedAsTheCause) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  unsigned long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t used = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  for (const Backend backend : {Backend::egl, Backend::osmesa}) {
    EXPECT_EXIT(createWithin(backend, RLIMIT_AS, used + (20 << 20)), ::testing::ExitedWithCode(1),
                "(EGL|OSMesa) cannot be .*too little memory.*512 MiB");
  }
}
#endif

TEST(ContextDeathTest, aMachineWithoutADisplayIsToldSo) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        unsetenv("DISPLAY");
        unsetenv("WAYLAND_DISPLAY");
        try {
          Context::create({.backend = Backend::glfw});
        } catch (const Error& error) {
          fprintf(stderr, "%s\n", error.what());
          std::_Exit(1);
        }
        std::_Exit(0);
      },
      ::testing::ExitedWithCode(1), "^no window can be opened .*--backend egl.\n$");
}

}  // namespace
}  // namespace limn
