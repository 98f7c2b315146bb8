#include "core/context/context.h"

#include <fmt/format.h>

#include <array>
#include <mutex>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/context/private/backends.h"

namespace limn {
namespace {

// OpenGL keeps the current context per thread, and only this file may change it: without knowing which of
// limn's contexts is current, one back end could not be released before another is bound (see context.h).
thread_local Context* currentContext = nullptr;

constexpr std::array<std::pair<std::string_view, Backend>, 3> kBackendNames = {
    {{"egl", Backend::egl}, {"osmesa", Backend::osmesa}, {"glfw", Backend::glfw}}};

bool isSoftwareRenderer(std::string_view renderer) {
  for (std::string_view part : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer", "SWR"}) {
    if (renderer.find(part) != std::string_view::npos) return true;
  }
  return false;
}

std::string_view sourceName(GLenum source) {
  switch (source) {
    case GL_DEBUG_SOURCE_API:
      return "API";
    case GL_DEBUG_SOURCE_WINDOW_SYSTEM:
      return "window system";
    case GL_DEBUG_SOURCE_THIRD_PARTY:
      return "third party";
    case GL_DEBUG_SOURCE_APPLICATION:
      return "application";
    default:
      return "other";
  }
}

}  // namespace

std::string_view name(Backend backend) {
  for (const auto& [text, value] : kBackendNames) {
    if (value == backend) return text;
  }
  return "unknown";
}

Backend parseBackend(std::string_view text) {
  for (const auto& [known, value] : kBackendNames) {
    if (known == text) return value;
  }
  throw UsageError(fmt::format("unknown back end '{}': accepted are egl, osmesa, glfw", text));
}

struct Context::DebugLog {
  static constexpr size_t capacity = 100;  // an error in every draw call must not eat the memory
  std::mutex mutex;                        // drivers may report from their own threads
  std::vector<std::string> errors;

  static void receive(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                      const GLchar* message, const void* user) {
    // A shader that does not compile is reported by ShaderLibrary, with the file it came from.
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
    if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
    auto* log = static_cast<DebugLog*>(const_cast<void*>(user));
    const std::lock_guard lock(log->mutex);
    if (log->errors.size() >= capacity) return;
    const std::string text = length < 0 ? std::string(message) : std::string(message, size_t(length));
    log->errors.push_back(oneLine(fmt::format("OpenGL ({}): {}", sourceName(source), text)));
  }
};

std::unique_ptr<Context> Context::create(const ContextOptions& options) {
  Context* const previous = currentContext;
  release();
  try {
    switch (options.backend) {
      case Backend::egl:
        return createEglContext(options);
      case Backend::osmesa:
        return createOsmesaContext(options);
      case Backend::glfw:
        return createGlfwContext(options);
    }
    throw UsageError("unknown back end: accepted are egl, osmesa, glfw");
  } catch (...) {
    if (previous != nullptr) previous->makeCurrent();
    throw;
  }
}

Context::Context() = default;
Context::~Context() = default;

void Context::makeCurrent() {
  if (currentContext == this) return;
  release();
  bind();
  currentContext = this;
}

void Context::release() {
  if (currentContext == nullptr) return;
  currentContext->unbind();
  currentContext = nullptr;
}

bool Context::isCurrent() const {
  return currentContext == this;
}

Context* Context::current() {
  return currentContext;
}

void Context::initialise(const ContextOptions& options, const gl::GetProcAddress& getProcAddress) {
  makeCurrent();
  // Asked before the table is complete: a driver below 4.5 should be refused by its version, not by a missing
  // command.
  using GetString = const GLubyte* (*)(GLenum);
  const auto getString = reinterpret_cast<GetString>(getProcAddress("glGetString"));
  const auto text = [&](GLenum what) {
    const GLubyte* value = getString == nullptr ? nullptr : getString(what);
    return value == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(value));
  };
  info_ = {options.backend, text(GL_RENDERER), text(GL_VENDOR), text(GL_VERSION),
           text(GL_SHADING_LANGUAGE_VERSION)};
  if (info_.renderer.empty()) {
    throw Error(
        fmt::format("the {} context has no OpenGL dispatch (GL_RENDERER is null)", name(options.backend)));
  }
  info_.software = isSoftwareRenderer(info_.renderer);
  info_.debug = options.debug;

  std::string missing;
  const bool complete = functions_.load(getProcAddress, missing);
  GLint major = 0, minor = 0;
  if (functions_.GetIntegerv != nullptr) {
    functions_.GetIntegerv(GL_MAJOR_VERSION, &major);
    functions_.GetIntegerv(GL_MINOR_VERSION, &minor);
  }
  if (!complete || std::pair(major, minor) < std::pair(4, 5)) {
    throw Error(fmt::format("{} offers OpenGL {}{}: limn needs OpenGL 4.5 core", info_.renderer,
                            info_.version, complete ? "" : " without " + missing));
  }
  if (options.debug) {
    debugLog_ = std::make_unique<DebugLog>();
    functions_.Enable(GL_DEBUG_OUTPUT);
    functions_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    functions_.DebugMessageCallback(&DebugLog::receive, debugLog_.get());
  }
}

std::vector<std::string> Context::takeErrors() {
  if (!debugLog_) return {};
  const std::lock_guard lock(debugLog_->mutex);
  return std::exchange(debugLog_->errors, {});
}

void Context::throwErrors() {
  for (const std::string& error : takeErrors()) throw Error(error);
}

ContextScope::ContextScope(Context* context) : previous_(currentContext), context_(context) {
  if (context == nullptr) {
    Context::release();
  } else {
    context->makeCurrent();
  }
}

ContextScope::~ContextScope() {
  if (previous_ == context_ && currentContext == context_) return;  // nor was another made current meanwhile
  Context::release();
  if (previous_ != nullptr) previous_->makeCurrent();
}

std::vector<DeviceDescription> listDevices() {
  const ContextScope none(nullptr);
  const auto describe = [](const ContextOptions& options) {
    DeviceDescription description{options.backend, options.device, {}, {}};
    try {
      const auto context = Context::create(options);
      description.description = context->info().renderer + ", OpenGL " + context->info().version;
    } catch (const Error& error) {
      description.problem = error.what();
    }
    return description;
  };
  std::vector<DeviceDescription> devices;
  devices.push_back(describe({.backend = Backend::egl}));
  for (int device = 0; device < eglDeviceCount(); ++device) {
    devices.push_back(describe({.backend = Backend::egl, .device = device}));
  }
  devices.push_back(describe({.backend = Backend::osmesa}));
  devices.push_back(describe({.backend = Backend::glfw, .visible = false}));
  return devices;
}

}  // namespace limn
