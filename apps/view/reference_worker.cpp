#include "apps/view/reference_worker.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "core/base/error.h"
#include "core/base/failure.h"

namespace limn::app {
namespace {

constexpr int kFirstSpp = 4, kLastSpp = 1 << 14;
constexpr int kFirstKeptSpp = 64;   // coarser ones are there again in no time
constexpr double kFinest = 0.002;   // noise at which nothing more is to be seen
constexpr int kFewestBlack = 4096;  // samples of a black picture that is taken for one without light

bool isBlack(const Image& image) {
  const std::array<int, 3> rgb = image.rgbChannels();
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (const int channel : rgb)
        if (image.at(x, y, channel) != 0) return false;
  return true;
}

/// Whether more samples show nothing more. Where light is rare, the first ones may all miss it: such a
/// picture has no noise, either.
bool isFinest(const reference::Result& result) {
  if (result.noiseRms != 0) return result.noiseRms < kFinest;
  return result.spp >= kFewestBlack || !isBlack(result.image);
}

}  // namespace

void ReferenceWorker::start(Task task) {
  stop();
  busy_ = true;
  state_.running = true;
  thread_ = std::jthread([this, task = std::move(task)](const std::stop_token& stop) {
    try {
      work(stop, task);
    } catch (const std::exception&) {
      change(stop, [&, why = currentFailure()] { state_.problem = why; });
    }
    change(stop, [&] { state_.running = false; });
    busy_ = false;
    news_();
  });
}

void ReferenceWorker::cancel() {
  thread_.request_stop();
  const std::scoped_lock lock(mutex_);
  state_ = {};
  picture_.reset();
}

void ReferenceWorker::stop() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

/// What is cancelled says nothing any more.
template <class F>
void ReferenceWorker::change(const std::stop_token& stop, const F& f) {
  {
    const std::scoped_lock lock(mutex_);
    if (stop.stop_requested()) return;
    f();
  }
  news_();
}

void ReferenceWorker::deliver(const std::stop_token& stop, reference::Result result, bool fromDisk) {
  change(stop, [&] {
    state_.spp = result.spp;
    state_.noise = result.noiseRms;
    state_.fraction = 0;
    state_.fromDisk = fromDisk;
    picture_ = std::move(result.image);
  });
}

void ReferenceWorker::keep(const std::stop_token& stop, const reference::Request& request,
                           const reference::Result& result) {
  if (cache_.empty() || request.spp < kFirstKeptSpp || !state().unkept.empty()) return;
  try {
    reference::Cache(cache_).put(reference::contentHash(request), result);
  } catch (const Error& error) {
    change(stop, [&] { state_.unkept = error.what(); });
  }
}

std::optional<int> ReferenceWorker::resume(const std::stop_token& stop, const reference::Request& wanted) {
  if (cache_.empty()) return kFirstSpp;
  const reference::Cache cache(cache_);
  for (int spp = kLastSpp; spp >= kFirstKeptSpp && !stop.stop_requested(); spp /= 4) {
    reference::Request request = wanted;
    request.spp = spp;
    if (auto found = cache.get(reference::contentHash(request))) {
      const bool finest = isFinest(*found);
      deliver(stop, *std::move(found), true);
      return finest ? std::nullopt : std::optional(4 * spp);
    }
  }
  return kFirstSpp;
}

void ReferenceWorker::work(const std::stop_token& stop, const Task& task) {
  // Nothing but its scene is taken from the view, whose time and light are set meanwhile.
  reference::Request request{
      .scene = task.view->scene, .pose = task.pose, .camera = task.camera, .progress = {}, .checkpoint = {}};
  request.width = task.size.x;
  request.height = task.size.y;
  request.aa = task.aa;
  request.term = task.term;
  request.unshadowed = task.unshadowed;
  request.reliefPaths = task.reliefPaths;
  request.subsurface = task.subsurface;
  request.light = task.light == scene::kNone ? reference::kAllLights : task.light;
  request.bounces = task.bounces;
  request.interfaces = task.interfaces;
  request.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
  request.stop = stop;
  auto told = std::chrono::steady_clock::now();
  request.progress = [&](const reference::Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    if (now - told > std::chrono::milliseconds(100)) {
      told = now;
      change(stop, [&] { state_.fraction = progress.fraction; });
    }
    return true;
  };
  const std::optional<int> first = resume(stop, request);
  if (!first) return;
  for (request.spp = *first; request.spp <= kLastSpp && !stop.stop_requested(); request.spp *= 4) {
    reference::Result result = reference::render(request);
    const bool finest = isFinest(result);
    keep(stop, request, result);
    deliver(stop, std::move(result), false);
    if (finest) return;
  }
}

ReferenceWorker::State ReferenceWorker::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

std::optional<Image> ReferenceWorker::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(picture_, std::nullopt);
}

}  // namespace limn::app
