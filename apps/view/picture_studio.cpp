#include "apps/view/picture_studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/base/error.h"

namespace limn::app {
namespace {

constexpr double fluentMs = 60;        // a frame while things move
constexpr double reloadSeconds = 0.5;  // between looks at the shaders on disk
constexpr int largestReduction = 4;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

render::Settings settingsOf(const PictureOrder& order, int reduction, int light) {
  render::Settings settings;
  settings.size = glm::max(order.size / reduction, glm::ivec2(1));
  settings.output = order.output;
  settings.light = light;
  settings.displayEv = order.exposure;
  settings.techniques = order.techniques;
  return settings;
}

/// Whether relight() would change something for other reasons than time and camera.
bool sameLights(const SceneOptions& a, const SceneOptions& b) {
  return a.lightSize == b.lightSize && a.lightSettings == b.lightSettings &&
         a.environmentRotation == b.environmentRotation && a.environmentScale == b.environmentScale;
}

std::shared_ptr<const SceneFacts> factsOf(const View& view, const SceneOptions& options) {
  auto facts = std::make_shared<SceneFacts>();
  facts->options = options;
  facts->bounds = view.pose.bounds;
  facts->cameras = view.pose.cameras;
  facts->camera = view.camera;
  const auto& animations = view.scene.animations;
  const bool endless = !view.scene.dynamic.empty() || view.scene.medium.smoke;
  facts->animated = !animations.empty() || endless;
  if (!animations.empty() && !endless)
    facts->seconds =
        static_cast<double>(animations[static_cast<size_t>(std::max(view.animation, 0))].duration);
  return facts;
}

}  // namespace

PictureStudio::PictureStudio(gpu::Device& device, std::filesystem::path shaders, std::filesystem::path cache,
                             std::function<void(const PictureFacts&)> publish, std::function<void()> news)
    : device_(device),
      shaders_(std::move(shaders)),
      publish_(std::move(publish)),
      pool_(device),
      reference_(std::move(cache), std::move(news)) {}

void PictureStudio::publish() {
  device_.gl().Finish();  // another context draws what was made here
  publish_(facts_);
}

void PictureStudio::say(std::string message) {
  facts_.message = std::move(message);
  ++facts_.messages;
}

std::unique_ptr<ShownPicture> PictureStudio::makePicture(const View& view) {
  auto picture = std::make_unique<ShownPicture>(device_, view, shaders_);
  picture->renderer().setCompileProgress([this](int compiled, int wanted) {
    facts_.compiled = compiled;
    facts_.toCompile = wanted;
    publish();
  });
  return picture;
}

/// Replaces what is shown; leaves everything as it is when that fails.
void PictureStudio::open(const SceneOptions& wanted) {
  facts_.job = "opening " + wanted.scene.filename().string();
  publish();
  facts_.job.clear();
  try {
    auto view = std::make_shared<View>(app::open(wanted));
    auto picture = makePicture(*view);
    reference_.stop();
    truthKey_.clear();
    other_.reset();
    picture_ = std::move(picture);
    view_ = std::move(view);
    placed_ = wanted;
    rendered_.reset();
    wholeMs_ = 0;
    facts_.scene = factsOf(*view_, wanted);
    say("opened " + wanted.scene.string());
  } catch (const std::exception& error) {
    if (!facts_.scene) facts_.fatal = std::current_exception();
    say(error.what());
  }
  publish();
}

void PictureStudio::reloadShaders() {
  if (shaders_.empty() || now() - lastReload_ < reloadSeconds) return;
  lastReload_ = now();
  bool changed = picture_->reloadShaders();
  if (other_) changed |= other_->reloadShaders();
  if (!changed) return;
  facts_.shaderProblem = picture_->shaderProblem();
  if (facts_.shaderProblem.empty() && other_) facts_.shaderProblem = other_->shaderProblem();
  rendered_.reset();
}

/// Time, camera and lights of the scene as the order has them.
void PictureStudio::place(const PictureOrder& order) {
  const SceneOptions& s = order.scene;
  if (placed_ && sameLights(s, *placed_)) {
    moveTo(*view_, s, s.time);
  } else {
    const bool turned = !placed_ || s.environmentRotation != placed_->environmentRotation ||
                        s.environmentScale != placed_->environmentScale;
    if (turned) reference_.stop();  // it reads the environment
    placed_.reset();                // should relight() fail
    view_->time = s.time;
    relight(*view_, s);
    placed_ = s;
    if (turned) {
      picture_->forget();
      if (other_) other_->forget();
    }
  }
  view_->light = s.light.empty() ? scene::none : findNamed("light", s.light, view_->pose.lightNames);
}

bool PictureStudio::renderShot(ShownPicture& picture, const render::Settings& settings,
                               const PictureOrder& order, Shot& shot) {
  picture.configure(settings);
  const bool done = picture.render(view_->camera, view_->time, view_->animation, order.timed);
  facts_.compiled = facts_.toCompile = 0;
  shot.problem = picture.problem();
  if (!done) return false;
  shot.texture = pool_.copyOf(*picture.display(), GL_LINEAR);
  shot.size = settings.size;
  shot.whole = settings.size == order.size;
  shot.ms = picture.frameMs();
  return true;
}

/// False where that failed: facts_ say why.
bool PictureStudio::render(const PictureOrder& order) {
  try {
    place(order);
  } catch (const Error& error) {
    facts_.picture.problem = error.what();
    return false;
  }
  render::Settings settings = settingsOf(order, reduction_, view_->light);
  if (order.inspect) {
    settings.inspect = order.inspect->texture;
    picture_->renderer().setInspectionView(
        facts_.inspected && order.inspect->automatic
            ? render::InspectionView{order.inspect->view.level, order.inspect->view.layer,
                                     order.inspect->view.channel, facts_.inspected->view.low,
                                     facts_.inspected->view.high}
            : order.inspect->view);
  }
  double ms = 0;
  const bool done = renderShot(*picture_, settings, order, facts_.picture);
  if (done) ms += facts_.picture.ms;
  settings.inspect.reset();
  if (order.beside == Beside::techniques) {
    if (!other_) other_ = makePicture(*view_);
    settings.techniques = order.others;
    if (renderShot(*other_, settings, order, facts_.other)) ms += facts_.other.ms;
  } else {
    facts_.other = {};
  }
  wholeMs_ = ms * reduction_ * reduction_;
  ++facts_.pictures;
  describe();
  inspect(order);
  pool_.trim();
  return done;
}

void PictureStudio::describe() {
  facts_.camera = view_->camera;
  facts_.lights.resize(view_->pose.lights.size());
  for (size_t i = 0; i < facts_.lights.size(); ++i) {
    LightFacts& light = facts_.lights[i];
    light.name = view_->pose.lightNames[i];
    light.light = view_->pose.lights[i];
    light.editable = isEditable(view_->scene, static_cast<int>(i));
    light.now = describeLight(view_->scene, view_->pose, static_cast<int>(i));
  }
  if (!facts_.picture.problem.empty()) return;
  auto frame = std::make_shared<FrameFacts>();
  frame->passes = picture_->passes();
  frame->times = picture_->times();
  frame->memoryBytes = picture_->renderer().memoryBytes();
  facts_.frame = std::move(frame);
}

/// Renders anew if the order, or how small the picture may be, has changed; true if so.
bool PictureStudio::follow(const PictureOrder& order) {
  int wanted = 1;
  if (order.moving)
    while (wanted < largestReduction && wholeMs_ / (wanted * wanted) > fluentMs) wanted *= 2;
  PictureOrder before = rendered_.value_or(order);
  before.moving = order.moving;  // which alone does not change a whole picture
  const bool again = !rendered_ || wanted != reduction_ || !same(order, before);
  rendered_ = order;
  reduction_ = wanted;
  if (!again) return false;
  facts_.settled = compared_ = false;
  facts_.metrics.reset();
  render(order);
  publish();
  return true;
}

void PictureStudio::step(const PictureOrder& order) {
  if (!view_ || order.size.x < 1 || order.size.y < 1) return;  // minimised
  reloadShaders();
  bool changed = follow(order);
  changed |= followReference(order);
  changed |= inspectAtRest(order);
  changed |= compare(order);
  if (!changed && facts_.settled != order.moving) return;
  facts_.settled = !order.moving;
  publish();
}

}  // namespace limn::app
