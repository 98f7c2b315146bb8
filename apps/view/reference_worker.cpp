#include "apps/view/reference_worker.h"

#include <algorithm>

#include "core/base/error.h"

namespace limn::app {
namespace {

constexpr int firstSpp = 4, lastSpp = 1 << 14;
constexpr double finest = 0.002;  // noise at which nothing more is to be seen

}  // namespace

void ReferenceWorker::start(std::shared_ptr<const View> view, const scene::CameraPose& camera,
                            glm::ivec2 size, reference::Term term, int bounces) {
  forget();
  stop_ = false;
  running_ = true;
  thread_ = std::thread([this, view = std::move(view), camera, size, term, bounces] {
    work(view, camera, size, term, bounces);
  });
}

void ReferenceWorker::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void ReferenceWorker::forget() {
  stop();
  const std::scoped_lock lock(mutex_);
  state_ = {};
  picture_.reset();
}

void ReferenceWorker::work(const std::shared_ptr<const View>& view, const scene::CameraPose& camera,
                           glm::ivec2 size, reference::Term term, int bounces) {
  try {
    for (int spp = firstSpp; spp <= lastSpp && !stop_; spp *= 4) {
      reference::Request request = referenceRequest(*view, view->pose, camera, term);
      request.width = size.x;
      request.height = size.y;
      request.bounces = bounces;
      request.spp = spp;
      request.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
      request.progress = [this](const reference::Progress& progress) {
        const std::scoped_lock lock(mutex_);
        state_.fraction = progress.fraction;
        return !stop_;
      };
      reference::Result result = reference::render(request);
      const std::scoped_lock lock(mutex_);
      state_.spp = result.spp;
      state_.noise = result.noiseRms;
      picture_ = std::move(result.image);
      if (result.noiseRms < finest) break;
    }
  } catch (const Error& error) {
    const std::scoped_lock lock(mutex_);
    if (!stop_) state_.problem = error.what();
  }
  running_ = false;
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
