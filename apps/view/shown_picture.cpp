#include "apps/view/shown_picture.h"

#include <algorithm>
#include <chrono>

#include "apps/view/picture_order.h"
#include "core/base/failure.h"
#include "core/render/supersample.h"

namespace limn::app {
namespace {

bool same(const render::Settings& a, const render::Settings& b) {
  return a.size == b.size && a.term == b.term && a.light == b.light && a.display == b.display &&
         a.inspect == b.inspect && app::same(a.techniques, b.techniques);
}

}  // namespace

void ShownPicture::configure(const render::Settings& settings) {
  if (configured_ && same(settings, settings_)) return;
  settings_ = settings;
  settings_.dynamic = false;  // what did not change is not drawn again
  configured_ = false;
}

ShownPicture::Outcome ShownPicture::render(const scene::CameraPose& camera, double time, int animation,
                                           bool timed, const frame::FrameGraph::Cancelled& cancelled) {
  try {
    if (!configured_) {
      shown_ = false;
      render::checkTechniques(settings_.techniques, settings_.term);
      renderer_.configure(settings_);
      configured_ = true;
    }
    renderer_.setTime(time, animation);
    renderer_.setCamera(camera);
    const auto start = std::chrono::steady_clock::now();
    if (!renderer_.render(timed ? frame::preferredTiming(device_) : frame::Timing::off, cancelled))
      return Outcome::cancelled;
    renderer_.finish();
    frameMs_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    passes_ = renderer_.explain();
    times_.clear();
    if (timed) times_ = renderer_.graph().passTimes();
    shown_ = true;
    problem_.clear();
    return Outcome::done;
  } catch (const std::exception&) {  // also where the memory ends
    problem_ = currentFailure();
    configured_ = shown_ = false;
    return Outcome::failed;
  }
}

bool ShownPicture::takesMoreFrames(int aa) const {
  return aa > 1 || render::historyOf(settings_.term, settings_.techniques) > 1;
}

std::optional<Image> ShownPicture::read(const scene::CameraPose& camera, int aa,
                                        const std::function<bool()>& cancelled) {
  if (!takesMoreFrames(aa)) return read();
  struct Cancelled {};
  try {
    // The first frame of a sequence, as in limn render; without a history frames are what they are.
    if (render::historyOf(settings_.term, settings_.techniques) > 1) renderer_.configure(settings_);
    return render::supersample(renderer_, camera, settings_.size, aa, [&] {
      if (cancelled && cancelled()) throw Cancelled();
      renderer_.render();
    });
  } catch (const Cancelled&) {
    return std::nullopt;
  } catch (...) {
    forget();  // the renderer may have half of a frame
    throw;
  }
}

Image ShownPicture::next(const scene::CameraPose& camera, double time, int animation, int light, int aa) {
  try {
    if (light != settings_.light) {
      settings_.light = light;
      renderer_.configure(settings_);
    }
    renderer_.setTime(time, animation);
    return render::supersample(renderer_, camera, settings_.size, aa);
  } catch (...) {
    forget();  // as in read()
    throw;
  }
}

bool ShownPicture::reloadShaders() {
  const render::Renderer::Reload reload = renderer_.reloadShaders();
  shaderProblem_ = reload.errors.empty() ? "" : reload.errors.front();
  return reload.changed;
}

}  // namespace limn::app
