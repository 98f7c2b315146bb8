// An OpenGL 4.5 core context from one of three back ends, with the function table that belongs to it.
//
// gl* pointers differ per back end, so the table is owned by the context and there is no global one.
// At most one context is current on a thread. makeCurrent() first releases whatever other limn context is
// current on this thread: an OSMesa context that replaces a current EGL one without a release leaves no
// dispatch at all (GL_RENDERER is then null and every picture black).
#pragma once

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
/// Throws UsageError naming the accepted values.
LIMN_API Backend parseBackend(std::string_view text);

struct ContextOptions {
  Backend backend = Backend::egl;
  int device = -1;  ///< EGL device index as `limn info` lists them; -1: the first GPU, or else the
                    ///< surfaceless platform
  bool debug =
      false;         ///< KHR_debug output; errors and high-severity messages are collected, see takeErrors()
  int width = 1280;  ///< window only, pixels
  int height = 720;  ///< window only, pixels
  bool visible = true;  ///< window only
  std::string title = "limn";
  const Context* share = nullptr;  ///< window only: another window whose textures and buffers both see
};

struct ContextInfo {
  Backend backend;
  std::string renderer, vendor, version, glslVersion;
  bool software = false;  ///< llvmpipe, softpipe, swrast: timer queries of raster passes cannot be trusted
  bool debug = false;     ///< made with ContextOptions::debug
};

class LIMN_API Context {
 public:
  /// Creates a context and makes it current. Throws Error in one line when the back end, the device or
  /// OpenGL 4.5 is not to be had.
  static std::unique_ptr<Context> create(const ContextOptions& options);

  virtual ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// A context is current on at most one thread. GLFW windows are made and destroyed on the main thread, but
  /// their contexts may be current on others. Throws Error.
  void makeCurrent();
  /// Nothing is current afterwards, whichever context was.
  static void release();
  bool isCurrent() const;
  /// The limn context of this thread, or null.
  static Context* current();

  const gl::Functions& gl() const { return functions_; }
  const ContextInfo& info() const { return info_; }

  /// Errors that KHR_debug reported since the last call (type error or severity high), one line each. Empty
  /// without ContextOptions::debug.
  std::vector<std::string> takeErrors();

  /// The window of a GLFW context, otherwise null.
  virtual GLFWwindow* window() const { return nullptr; }

 protected:
  // A back end's destructor destroys its native context inside ContextScope(nullptr): even destroying one may
  // touch what another back end believes to be current.
  Context();
  virtual void bind() = 0;             ///< makes the native context current; throws Error
  virtual void unbind() noexcept = 0;  ///< makes no native context current
  /// Called once by create() after the native context exists: binds, loads the table, checks the version.
  void initialise(const ContextOptions& options, const gl::GetProcAddress& getProcAddress);

  gl::Functions functions_{};
  ContextInfo info_;

 private:
  struct DebugLog;
  std::unique_ptr<DebugLog> debugLog_;
};

/// Gives the thread another current context (or none) for a scope, and the former one back at its end.
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

/// What a back end offers on this machine, for `limn info`.
struct DeviceDescription {
  Backend backend;
  int device = -1;  ///< EGL device index or -1
  std::string description;
  std::string problem;  ///< empty when a context can be made
};
/// Tries every back end and EGL device by making a context; the current context is current again afterwards.
LIMN_API std::vector<DeviceDescription> listDevices();

}  // namespace limn
