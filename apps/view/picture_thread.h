// Declares the rendering thread, with an OpenGL context of its own, so that the window keeps responding
// whatever a compilation, a slow technique or a scene from disk takes. The two contexts share nothing;
// pictures pass through memory. Mesa's llvmpipe crashes where one context of a display draws while another
// shows its frame (it walks the lists of resources of all contexts without a lock), so that a shared picture
// would crash the viewer.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <variant>

#include "apps/view/picture_order.h"
#include "core/context/context.h"

namespace limn::app {

struct PictureThreadOptions {
  int device = -1;                ///< as in ContextOptions
  bool debug = false;             ///< OpenGL errors are fatal
  std::filesystem::path shaders;  ///< folder that overrides the embedded ones, watched for changes
  std::filesystem::path cache;    ///< of references; empty: none
};

class PictureThread {
 public:
  /// Starts the thread. The context that is current on the calling thread stays current. Throws Error when no
  /// EGL context can be created.
  explicit PictureThread(const PictureThreadOptions& options);
  /// Ends the thread. Pictures that were to be saved are written first, but no more frames of a sequence.
  ~PictureThread();
  PictureThread(const PictureThread&) = delete;
  PictureThread& operator=(const PictureThread&) = delete;

  // None of these waits.
  /// Replaces the previous order.
  void show(PictureOrder order);
  /// Replaces the scene, unless that fails.
  void open(OpenOrder order);
  void save(SaveOrder order);
  /// Ends a sequence that is being saved.
  void cancelSaving();
  /// Returns the newest facts; the same object as before where nothing changed. Never null.
  std::shared_ptr<const PictureFacts> facts() const;

 private:
  struct Mailbox;
  void run(const std::stop_token& stop);

  PictureThreadOptions options_;
  std::unique_ptr<Context> context_;
  std::unique_ptr<gpu::Device> device_;
  std::unique_ptr<Mailbox> mailbox_;
  std::jthread thread_;
};

}  // namespace limn::app
