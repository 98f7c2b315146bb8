// Declares an OpenGL 4.5 core context, created by one of three back ends, with the function table that
// belongs to it.
//
// The gl* pointers differ between back ends, so each context owns its table and there is no global one. At
// most one context is current on a thread. makeCurrent() first releases any other limn context that is
// current on this thread: if an OSMesa context replaces a current EGL one without a release, no dispatch
// table is left (GL_RENDERER is then null and every picture black).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/context/gl_functions.h"

struct GLFWwindow;

namespace limn {

class Context;

enum class Backend { egl, osmesa, glfw };

LIMN_API std::string_view name(Backend backend);
/// Returns the back end of that name. Throws UsageError naming the accepted values.
LIMN_API Backend parseBackend(std::string_view text);

struct ContextOptions {
  Backend backend = Backend::egl;
  int device = -1;  ///< EGL device index as `limn info` lists them; -1: the first GPU with OpenGL 4.5, or
                    ///< else the surfaceless platform
  bool debug =
      false;         ///< KHR_debug output; errors and high-severity messages are collected, see takeErrors()
  int width = 1280;  ///< window only, pixels
  int height = 720;  ///< window only, pixels
  bool visible = true;  ///< window only
  std::string title = "limn";
  /// Receives one line where a GPU cannot be used and another device is, none having been asked for; empty:
  /// nothing is said.
  std::function<void(const std::string&)> warn = {};
};

struct ContextInfo {
  Backend backend;
  std::string renderer, vendor, version, glslVersion;
  bool software = false;  ///< llvmpipe, softpipe, swrast: timer queries of raster passes cannot be trusted
  bool debug = false;     ///< made with ContextOptions::debug
};

class LIMN_API Context {
 public:
  /// Creates a context and makes it current. Throws Error with one line when the back end, the device or
  /// OpenGL 4.5 is not available.
  static std::unique_ptr<Context> create(const ContextOptions& options);

  virtual ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes this context current on the calling thread; a context is current on at most one thread. GLFW
  /// windows are created and destroyed on the main thread, but their contexts may be current on others.
  /// Throws Error when that fails.
  void makeCurrent();
  /// Releases whichever context is current on this thread; afterwards none is.
  static void release();
  bool isCurrent() const;
  /// Returns the limn context that is current on this thread, or null.
  static Context* current();

  const gl::Functions& gl() const { return functions_; }
  const ContextInfo& info() const { return info_; }

  /// Returns the errors that KHR_debug reported since the last call (type error or severity high), one line
  /// each. Always empty without ContextOptions::debug.
  std::vector<std::string> takeErrors();
  /// Throws Error with the first of these errors, if there are any.
  void throwErrors();

  /// Returns the window of a GLFW context, otherwise null.
  virtual GLFWwindow* window() const { return nullptr; }

 protected:
  // A back end's destructor destroys its native context inside ContextScope(nullptr): even destroying one may
  // touch what another back end believes to be current.
  Context();
  virtual void bind() = 0;             ///< makes the native context current; throws Error
  virtual void unbind() noexcept = 0;  ///< makes no native context current
  /// Binds the context, loads the function table and checks the version. Called once by create() after the
  /// native context exists.
  void initialise(const ContextOptions& options, const gl::GetProcAddress& getProcAddress);

  gl::Functions functions_{};
  ContextInfo info_;

 private:
  struct DebugLog;
  std::unique_ptr<DebugLog> debugLog_;
};

/// Makes another context (or none) current on this thread for a scope, and restores the former one at its
/// end.
class LIMN_API ContextScope {
 public:
  explicit ContextScope(Context* context);
  ~ContextScope();
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;

 private:
  Context* previous_;
  Context* context_;
};

/// Describes a device that a back end offers on this machine, for `limn info`.
struct DeviceDescription {
  Backend backend;
  int device = -1;  ///< EGL device index or -1
  std::string description;
  std::string problem;  ///< empty when a context can be made
};
/// Returns all back ends and EGL devices, each tried by creating a context; restores the current context.
LIMN_API std::vector<DeviceDescription> listDevices();

}  // namespace limn
