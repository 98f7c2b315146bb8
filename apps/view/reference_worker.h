// Computes the ground truth of a view in the background and refines it while the view is shown.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/image/image.h"
#include "core/reference/reference.h"
#include "core/session/view.h"

namespace limn::app {

/// Renders references on one thread, which itself uses all cores but one. Every picture has four times the
/// samples of the previous one and starts from zero, so that the last one accounts for three quarters of all
/// work. Finished pictures are kept on disk as `limn reference --cache` keeps them, and the worker starts
/// with the finest one found there.
class ReferenceWorker {
 public:
  struct Task {
    /// Holds the view. The worker reads its scene except for nodes and lights, which may change meanwhile.
    std::shared_ptr<const session::View> view;
    scene::Pose pose;
    scene::CameraPose camera;
    glm::ivec2 size{0};
    int aa = 1;  ///< x aa samples in each pixel
    Term term = Term::direct;
    int light = scene::kNone, bounces = 0, interfaces = 0;
    bool unshadowed = false;
    ReliefPaths reliefPaths = ReliefPaths::both;
    SubsurfaceModel subsurface = SubsurfaceModel::bssrdf;
  };

  /// Takes `cache`, a folder (empty for none), and `news`, which is called from any thread when state()
  /// changed.
  ReferenceWorker(std::filesystem::path cache, std::function<void()> news)
      : cache_(std::move(cache)), news_(std::move(news)) {}
  ~ReferenceWorker() { stop(); }
  ReferenceWorker(const ReferenceWorker&) = delete;
  ReferenceWorker& operator=(const ReferenceWorker&) = delete;

  /// Discards earlier results and starts the task. Only to be called while not busy().
  void start(Task task);
  /// Requests the end of the work and discards its results; returns at once.
  void cancel();
  /// Calls cancel() and waits for the end: for some blocks of pixels, or for Embree to build its hierarchies.
  void stop();
  /// Returns whether work is in progress, even if it has been cancelled.
  bool busy() const { return busy_; }

  struct State {
    int spp = 0;            ///< of the picture
    double noise = 0;       ///< of the picture, RMS relative to the mean
    double fraction = 0;    ///< of the next picture that is done
    bool running = false;   ///< a finer one is being computed
    bool fromDisk = false;  ///< the picture
    std::string problem;    ///< why the work ended; empty: it did not
    std::string unkept;     ///< why pictures are not kept on disk; empty: they are
    bool operator==(const State&) const = default;
  };
  State state() const;
  /// Returns the newest picture, if there is one that the caller has not taken yet.
  std::optional<Image> take();

 private:
  void work(const std::stop_token& stop, const Task& task);
  /// Delivers the finest picture on disk, if there is one. Returns how many samples per pixel the next
  /// picture has; nullopt where nothing more would be seen.
  std::optional<int> resume(const std::stop_token& stop, const reference::Request& request);
  void deliver(const std::stop_token& stop, reference::Result result, bool fromDisk);
  /// Keeps the picture on disk; the first time that it cannot, state() says why.
  void keep(const std::stop_token& stop, const reference::Request& request, const reference::Result& result);
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
