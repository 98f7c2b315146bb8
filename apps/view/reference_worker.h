// The truth of a view, computed beside the window and refined while one looks at it.
#pragma once

#include <atomic>
#include <functional>
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
/// one before and starts anew, so that the last holds three quarters of all work done. Finished pictures are
/// kept on disk as `limn reference --cache` keeps them, and the finest one found there is where it starts.
class ReferenceWorker {
 public:
  struct Task {
    /// Its scene is read, all but its nodes and lights: they may change meanwhile.
    std::shared_ptr<const View> view;
    scene::Pose pose;
    scene::CameraPose camera;
    glm::ivec2 size{0};
    reference::Term term = reference::Term::direct;
    int light = scene::none, bounces = 0, interfaces = 0;
  };

  /// `cache`: folder, empty for none. `news` is called, from any thread, when state() changed.
  ReferenceWorker(std::filesystem::path cache, std::function<void()> news)
      : cache_(std::move(cache)), news_(std::move(news)) {}
  ~ReferenceWorker() { stop(); }
  ReferenceWorker(const ReferenceWorker&) = delete;
  ReferenceWorker& operator=(const ReferenceWorker&) = delete;

  /// Forgets what was there and begins. Only while not busy().
  void start(Task task);
  /// Asks the work to end and forgets what is known; returns at once.
  void cancel();
  /// cancel(), and waits: for some blocks of pixels, or for Embree to build its hierarchies.
  void stop();
  /// There is work going on, be it cancelled.
  bool busy() const { return busy_; }

  struct State {
    int spp = 0;            ///< of the picture
    double noise = 0;       ///< of the picture, RMS relative to the mean
    double fraction = 0;    ///< of the next picture that is done
    bool running = false;   ///< a finer one is on its way
    bool fromDisk = false;  ///< the picture
    std::string problem;    ///< why the work ended; empty: it did not
    bool operator==(const State&) const = default;
  };
  State state() const;
  /// The newest picture, if there is one that the caller has not had.
  std::optional<Image> take();

 private:
  void work(const std::stop_token& stop, const Task& task);
  /// Samples per pixel of the finest picture on disk; 0: none.
  int resume(const std::stop_token& stop, const reference::Request& request);
  void deliver(const std::stop_token& stop, reference::Result result, bool fromDisk);
  template <class F>
  void change(const std::stop_token& stop, const F& f);

  std::filesystem::path cache_;
  std::function<void()> news_;
  std::jthread thread_;
  std::atomic<bool> busy_{false};
  mutable std::mutex mutex_;
  State state_;
  std::optional<Image> picture_;
};

}  // namespace limn::app
