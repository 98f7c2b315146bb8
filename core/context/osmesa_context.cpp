// OSMesa, Mesa's software renderer without any window system. It is opened at run time: distributions drop it
// (upstream Mesa did in 25.1), and limn must start without it.
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "core/base/error.h"
#include "core/context/private/backends.h"

namespace limn {
namespace {

// From Mesa's interface; its header is not needed to build.
using NativeContext = struct osmesa_context*;
constexpr int kOsmesaFormat = 0x22, kOsmesaDepthBits = 0x30, kOsmesaStencilBits = 0x31, kOsmesaProfile = 0x33,
              kOsmesaCoreProfile = 0x34, kOsmesaMajorVersion = 0x36, kOsmesaMinorVersion = 0x37;

struct Library {
  NativeContext (*createContextAttribs)(const int* attributes, NativeContext shared) = nullptr;
  void (*destroyContext)(NativeContext) = nullptr;
  GLboolean (*makeCurrent)(NativeContext, void* buffer, GLenum type, GLsizei width, GLsizei height) = nullptr;
  void* (*getProcAddress)(const char* name) = nullptr;
};

Library openLibrary() {
  void* handle = nullptr;
  // Never closed: Mesa and LLVM leave thread-local destructors behind that must stay loaded.
  for (const char* file : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    if (handle == nullptr) handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  }
  if (handle == nullptr) {
    const std::string shortage = driverShortage();
    if (!shortage.empty()) throw Error("OSMesa cannot be loaded: " + shortage);
    throw Error(
        "OSMesa is not installed (libOSMesa.so.8, .so.6 and .so were tried): install it (Debian: libosmesa6) "
        "or choose "
        "another back end (--backend egl)");
  }
  Library library;
  const auto find = [&](const char* name, auto& function) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
    if (function == nullptr) throw Error(fmt::format("libOSMesa lacks {}: Mesa 12 or later is needed", name));
  };
  find("OSMesaCreateContextAttribs", library.createContextAttribs);
  find("OSMesaDestroyContext", library.destroyContext);
  find("OSMesaMakeCurrent", library.makeCurrent);
  find("OSMesaGetProcAddress", library.getProcAddress);
  return library;
}

class OsmesaContext final : public Context {
 public:
  OsmesaContext() : library_(openLibrary()) {
    const int attributes[] = {kOsmesaFormat,
                              GL_RGBA,
                              kOsmesaDepthBits,
                              0,
                              kOsmesaStencilBits,
                              0,
                              kOsmesaProfile,
                              kOsmesaCoreProfile,
                              kOsmesaMajorVersion,
                              4,
                              kOsmesaMinorVersion,
                              5,
                              0};
    context_ = library_.createContextAttribs(attributes, nullptr);
    if (context_ == nullptr) throw Error("OSMesa makes no OpenGL 4.5 core context");
  }

  ~OsmesaContext() override {
    if (isCurrent()) release();
    const ContextScope none(nullptr);
    library_.destroyContext(context_);
  }

  void initialise(const ContextOptions& options) { Context::initialise(options, library_.getProcAddress); }

 private:
  static constexpr int bufferSize = 16;  // pixels; limn draws into framebuffer objects only

  void bind() override {
    if (!library_.makeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, bufferSize, bufferSize)) {
      throw Error("OSMesa does not make the context current");
    }
  }

  void unbind() noexcept override { library_.makeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

  Library library_;
  NativeContext context_ = nullptr;
  std::array<uint32_t, bufferSize * bufferSize> buffer_{};
};

}  // namespace

std::unique_ptr<Context> createOsmesaContext(const ContextOptions& options) {
  if (options.device >= 0) {
    throw UsageError(fmt::format("device {} cannot be chosen with --backend osmesa: only egl has devices",
                                 options.device));
  }
  auto context = std::make_unique<OsmesaContext>();
  context->initialise(options);
  return context;
}

}  // namespace limn
