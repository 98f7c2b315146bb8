// The truth of a view, computed beside the window and refined while one looks at it.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/limn/options.h"
#include "core/image/image.h"
#include "core/reference/reference.h"

namespace limn::app {

/// One thread, which itself renders with all cores but one. Every picture has four times the samples of the
/// one before and starts anew, so that the last holds three quarters of all work done.
class ReferenceWorker {
 public:
  ReferenceWorker() = default;
  ~ReferenceWorker() { stop(); }
  ReferenceWorker(const ReferenceWorker&) = delete;
  ReferenceWorker& operator=(const ReferenceWorker&) = delete;

  /// Forgets what was there and begins. `view` is not changed while the work goes on. `bounces`: as in the
  /// request.
  void start(std::shared_ptr<const View> view, const scene::CameraPose& camera, glm::ivec2 size,
             reference::Term term, int bounces);
  /// Waits for the current pass over the picture to end.
  void stop();
  /// stop(), and nothing is known of any picture.
  void forget();
  bool running() const { return running_; }

  struct State {
    int spp = 0;          ///< of the picture
    double noise = 0;     ///< of the picture, RMS relative to the mean
    double fraction = 0;  ///< of the next picture that is done
    std::string problem;  ///< why the work ended; empty: it did not
  };
  State state() const;
  /// The newest picture, if there is one that the caller has not had.
  std::optional<Image> take();

 private:
  void work(const std::shared_ptr<const View>& view, const scene::CameraPose& camera, glm::ivec2 size,
            reference::Term term, int bounces);

  std::thread thread_;
  std::atomic<bool> stop_{false}, running_{false};
  mutable std::mutex mutex_;
  State state_;
  std::optional<Image> picture_;
};

}  // namespace limn::app
