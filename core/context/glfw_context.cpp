// A window. GLFW stays initialised until the process ends, because other windows may still use it.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/context/private/backends.h"

namespace limn {
namespace {

constexpr int kLargestWindow = 16384;  // pixels; GLFW and X do not survive every number

std::string lastProblem() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description == nullptr ? "no reason given" : description;
}

class GlfwContext final : public Context {
 public:
  explicit GlfwContext(const ContextOptions& options) {
    if (!glfwInit()) {
      throw Error(
          fmt::format("no window can be opened ({}): a display is needed; limn render makes pictures "
                      "without one (--backend egl)",
                      lastProblem()));
    }
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window_ = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
      throw Error(fmt::format("no window of {} x {} pixels with OpenGL 4.5 core can be opened ({})",
                              options.width, options.height, lastProblem()));
    }
  }

  ~GlfwContext() override {
    if (isCurrent()) release();
    const ContextScope none(nullptr);
    glfwDestroyWindow(window_);
  }

  void initialise(const ContextOptions& options) {
    Context::initialise(options,
                        [](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); });
  }

  GLFWwindow* window() const override { return window_; }

 private:
  void bind() override {
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_) {
      throw Error(fmt::format("GLFW does not make the window's context current ({})", lastProblem()));
    }
  }

  void unbind() noexcept override { glfwMakeContextCurrent(nullptr); }

  GLFWwindow* window_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> createGlfwContext(const ContextOptions& options) {
  if (options.device >= 0) {
    throw UsageError(
        fmt::format("device {} cannot be chosen with --backend glfw: only egl has devices", options.device));
  }
  if (std::min(options.width, options.height) < 1 ||
      std::max(options.width, options.height) > kLargestWindow) {
    throw UsageError(fmt::format("window of {} x {} pixels: accepted are 1 to {} each way", options.width,
                                 options.height, kLargestWindow));
  }
  auto context = std::make_unique<GlfwContext>(options);
  context->initialise(options);
  return context;
}

}  // namespace limn
