// The thread that renders, with an OpenGL context of its own: whatever it takes, a compilation, a slow
// technique, a scene from disk, the window goes on.
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
  bool debug = false;             ///< OpenGL errors are fatal
  std::filesystem::path shaders;  ///< folder that overrides the embedded ones, watched for changes
  std::filesystem::path cache;    ///< of references; empty: none
};

class PictureThread {
 public:
  /// `window`'s context is current on the calling thread, the main one, and stays so. It must outlive this.
  PictureThread(Context& window, const PictureThreadOptions& options);
  /// What facts() gave must have been dropped. On the main thread.
  ~PictureThread();
  PictureThread(const PictureThread&) = delete;
  PictureThread& operator=(const PictureThread&) = delete;

  // None of these waits.
  /// Replaces the order before.
  void show(PictureOrder order);
  /// Replaces the scene, unless that fails.
  void open(SceneOptions scene);
  void save(SaveOrder order);
  /// Ends a sequence that is being saved.
  void cancelSaving();
  /// The newest; the same object as before where nothing changed. Never null.
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
