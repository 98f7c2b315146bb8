// EGL without a window: the surfaceless platform (Mesa) or the device platform (Mesa and NVIDIA).
//
// A display is never terminated: EGL hands the same one to everybody in the process who asks for the same
// platform, so terminating it would take it from another context; EGL itself frees it at exit.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/context/private/backends.h"
#include "core/context/private/first_that_works.h"

namespace limn {
namespace {

std::string_view errorName(EGLint error) {
  switch (error) {
    case EGL_SUCCESS:
      return "no error given";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
      return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      return "another EGL error";
  }
}

bool listsExtension(const char* extensions, std::string_view wanted) {
  std::string_view rest = extensions == nullptr ? "" : extensions;
  while (!rest.empty()) {
    const size_t end = rest.find(' ');
    if (rest.substr(0, end) == wanted) return true;
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  return false;
}

bool clientOffers(std::string_view extension) {
  return listsExtension(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension);
}

EGLDisplay initialisedDisplay(EGLenum platform, void* native) {
  const EGLDisplay display = eglGetPlatformDisplay(platform, native, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_DISPLAY;
  return display;
}

std::vector<EGLDeviceEXT> eglDevices() {
  if (!clientOffers("EGL_EXT_device_enumeration") && !clientOffers("EGL_EXT_device_base")) return {};
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  EGLint count = 0;
  if (query == nullptr || !query(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<size_t>(count));
  if (!query(count, devices.data(), &count)) return {};
  devices.resize(static_cast<size_t>(count));
  return devices;
}

/// Throws: of a driver that cannot be loaded EGL says the same as of one that is not there.
[[noreturn]] void fail(const std::string& what) {
  const std::string shortage = driverShortage();
  throw Error(shortage.empty() ? what : "EGL cannot be started: " + shortage);
}

EGLDisplay openDevice(int index) {
  const std::vector<EGLDeviceEXT> devices = eglDevices();
  if (index < 0 || static_cast<size_t>(index) >= devices.size()) {
    fail(devices.empty()
             ? fmt::format("EGL device {} does not exist: EGL lists no device", index)
             : fmt::format("EGL device {} does not exist: accepted are 0 to {}", index, devices.size() - 1));
  }
  const EGLDisplay display = initialisedDisplay(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<size_t>(index)]);
  if (display == EGL_NO_DISPLAY) {
    fail(fmt::format("EGL device {} cannot be opened ({}): `limn info` lists those that can", index,
                     errorName(eglGetError())));
  }
  return display;
}

bool rendersOnProcessor(EGLDeviceEXT device) {
  const auto query =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
  return query != nullptr && listsExtension(query(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

/// Where a display comes from.
struct DisplayPlace {
  EGLenum platform;
  void* native;
  int gpu = -1;  ///< index of the device, if it is a GPU
};

/// The GPUs; then the surfaceless platform, which Mesa alone may serve where a GPU has another driver; then
/// devices that are none.
std::vector<DisplayPlace> defaultPlaces() {
  std::vector<DisplayPlace> places;
  const std::vector<EGLDeviceEXT> devices = eglDevices();
  const auto addDevices = [&](bool onProcessor) {
    for (size_t i = 0; i < devices.size(); ++i) {
      if (rendersOnProcessor(devices[i]) == onProcessor)
        places.push_back({EGL_PLATFORM_DEVICE_EXT, devices[i], onProcessor ? -1 : static_cast<int>(i)});
    }
  };
  addDevices(false);
  if (clientOffers("EGL_MESA_platform_surfaceless"))
    places.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
  addDevices(true);
  return places;
}

class EglContext final : public Context {
 public:
  EglContext(EGLDisplay display, const ContextOptions& options) : display_(display) {
    if (!listsExtension(eglQueryString(display_, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
      throw Error("this EGL driver makes no context current without a surface (EGL_KHR_surfaceless_context)");
    }
    if (!eglBindAPI(EGL_OPENGL_API))
      throw Error("this EGL driver offers OpenGL ES only: limn needs OpenGL 4.5 core");
    const EGLint configAttributes[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                       EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, configAttributes, &config, 1, &count) || count < 1) {
      fail("this EGL driver has no configuration for OpenGL: limn needs OpenGL 4.5 core");
    }
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 options.debug ? EGL_TRUE : EGL_FALSE,
                                 EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) {
      fail(
          fmt::format("EGL makes no OpenGL 4.5 core context on {} ({}); limn info lists devices, --device "
                      "chooses one",
                      options.device < 0 ? "the default device" : fmt::format("device {}", options.device),
                      errorName(eglGetError())));
    }
  }

  ~EglContext() override {
    if (isCurrent()) release();
    const ContextScope none(nullptr);
    eglDestroyContext(display_, context_);
  }

  void initialise(const ContextOptions& options) {
    Context::initialise(options,
                        [](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
  }

 private:
  void bind() override {
    eglBindAPI(EGL_OPENGL_API);  // a property of the thread, and the default is OpenGL ES
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      throw Error(
          fmt::format("EGL does not make the context current ({}): it may be current on another thread",
                      errorName(eglGetError())));
    }
  }

  void unbind() noexcept override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> createEglContext(const ContextOptions& options) {
  const auto create = [&](EGLDisplay display) {
    auto context = std::make_unique<EglContext>(display, options);
    context->initialise(options);
    return context;
  };
  if (options.device >= 0) return create(openDevice(options.device));
  std::string passedOver;
  auto context = firstThatWorks(
      defaultPlaces(),
      [&](const DisplayPlace& place) {
        const EGLDisplay display = initialisedDisplay(place.platform, place.native);
        return display == EGL_NO_DISPLAY ? nullptr : create(display);
      },
      [&](const DisplayPlace& place, const std::string& why) {
        if (place.gpu < 0 || !passedOver.empty()) return;
        passedOver = fmt::format("the GPU of EGL device {} is not used ({})", place.gpu,
                                 why.empty() ? errorName(eglGetError()) : why);
      });
  if (!context) {
    fail(
        "no EGL driver offers the surfaceless or the device platform: install one (Debian: libegl-mesa0) or "
        "choose another back end (--backend osmesa)");
  }
  if (!passedOver.empty() && options.warn)
    options.warn(fmt::format("{}; {} renders in its place", passedOver, context->info().renderer));
  return context;
}

int eglDeviceCount() {
  return static_cast<int>(eglDevices().size());
}

}  // namespace limn
