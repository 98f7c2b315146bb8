#include "apps/view/picture_studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "apps/limn/options.h"
#include "apps/view/display_image.h"
#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/question/question_fields.h"

namespace limn::app {
namespace {

constexpr double kFluentMs = 60;        // a frame while things move
constexpr double kReloadSeconds = 0.5;  // between looks at the shaders on disk
constexpr int kLargestReduction = 4;
constexpr double kSlower = 2;  // than what had passed of it a whole frame is held for that was given up

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

render::Settings settingsOf(const PictureOrder& order, int reduction, int light) {
  render::Settings settings;
  settings.size = glm::max(order.size / reduction, glm::ivec2(1));
  settings.term = parseTerm(order.scene.term);
  settings.light = light;
  settings.display = order.tone;
  settings.techniques = order.techniques;
  return settings;
}

/// Whether relight() may write to materials. It may where the pose lacks a light: a mesh may be none at the
/// time that was shown last, and one at the next.
bool changesMeshes(const session::View& view, const SceneQuestion& question) {
  try {
    return session::changeMeshes(view.pose, session::parseLightEdits(question.lightSettings));
  } catch (const UsageError&) {
    return true;
  }
}

std::shared_ptr<const SceneFacts> factsOf(const session::View& view, const SceneQuestion& question,
                                          uint64_t file) {
  auto facts = std::make_shared<SceneFacts>();
  facts->options = question;
  facts->file = file;
  facts->origin = view.scene.origin;
  facts->bounds = view.pose.bounds;
  facts->cameras = view.pose.cameras;
  const std::vector<std::string> names = session::findableNames(session::cameraNames(view.pose));
  for (size_t i = 0; i < names.size(); ++i) facts->cameras[i].name = names[i];
  facts->camera = view.camera;
  facts->environment = static_cast<bool>(view.scene.environment);
  facts->ownEnvironment = facts->environment && question.environment.empty() && !view.defaultLights;
  const auto& animations = view.scene.animations;
  const bool endless = !view.scene.dynamic.empty() || view.scene.medium.smoke;
  facts->animated = !animations.empty() || endless;
  if (!animations.empty() && !endless) {
    const double duration =
        static_cast<double>(animations[static_cast<size_t>(std::max(view.animation, 0))].duration);
    // One that is longer than times may be is never seen to its end, for which no slider has room.
    if (duration <= questionField("time").range.high) facts->seconds = duration;
  }
  return facts;
}

}  // namespace

PictureStudio::PictureStudio(gpu::Device& device, std::filesystem::path shaders, std::filesystem::path cache,
                             std::function<void(const PictureFacts&)> publish, std::function<void()> news)
    : device_(device),
      shaders_(std::move(shaders)),
      publish_(std::move(publish)),
      reference_(std::move(cache), std::move(news)) {}

void PictureStudio::publish() {
  facts_.saving = saving();
  publish_(facts_);
  if (std::exchange(printed_, facts_.messages) == facts_.messages) return;
  sayInTerminal(facts_.message);
}

void PictureStudio::say(std::string message, bool problem) {
  facts_.message = std::move(message);
  facts_.problem = problem;
  ++facts_.messages;
}

std::unique_ptr<ShownPicture> PictureStudio::makePicture(const session::View& view) {
  auto picture = std::make_unique<ShownPicture>(device_, view, shaders_);
  picture->renderer().setCompileProgress([this](int compiled, int wanted) {
    facts_.compiled = compiled;
    facts_.toCompile = wanted;
    publish();
  });
  return picture;
}

/// What the order changes of the one that it starts from, where that was refused, in the scene that is shown;
/// else the order's scene.
SceneQuestion PictureStudio::withoutRefused(const OpenOrder& order) const {
  SceneQuestion wanted = order.scene;
  if (!order.after || !refused_ || !sameFields(QuestionEffect::scene, *order.after, *refused_) ||
      !facts_.scene || facts_.scene->file != order.file)
    return wanted;
  for (const QuestionField& field : questionFields())
    if (field.effect == QuestionEffect::scene && printed(field, wanted) == printed(field, *order.after))
      copyField(field, wanted, facts_.scene->options);
  return wanted;
}

void PictureStudio::open(const OpenOrder& order) {
  const SceneQuestion wanted = withoutRefused(order);
  const bool whole = wanted == order.scene;
  facts_.job = "opening " + std::filesystem::path(wanted.scene).filename().string();
  publish();
  facts_.job.clear();
  try {
    auto view = std::make_shared<session::View>(session::open(wanted, warn));
    auto picture = makePicture(*view);
    std::vector<std::filesystem::path> files = filesRead(wanted);
    reference_.stop();
    truthKey_.clear();
    other_.reset();
    picture_ = std::move(picture);
    view_ = std::move(view);
    files_ = std::move(files);
    placed_ = wanted;
    rendered_.reset();
    facts_.settled = false;
    wholeMs_ = 0;
    facts_.scene = factsOf(*view_, wanted, order.file);
    facts_.asked = wanted;
    facts_.camera = view_->camera;
    describeLights();  // those of the scene before cannot be changed any more
    facts_.shaderProblem.clear();
    if (whole) say("opened " + wanted.scene);  // else the reason why something was left out stays
    refused_ = whole ? std::nullopt : std::optional(order.scene);
  } catch (const std::exception&) {
    if (order.needed) facts_.fatal = std::current_exception();
    say(currentFailure(), true);
    refused_ = order.scene;
  }
  ++facts_.opened;
  publish();
}

void PictureStudio::reloadShaders() {
  if (shaders_.empty() || now() - lastReload_ < kReloadSeconds) return;
  lastReload_ = now();
  bool changed = picture_->reloadShaders();
  if (other_) changed |= other_->reloadShaders();
  if (!changed) return;
  facts_.shaderProblem = picture_->shaderProblem();
  if (facts_.shaderProblem.empty() && other_) facts_.shaderProblem = other_->shaderProblem();
  if (facts_.shaderProblem.empty())
    say("shaders read again");
  else
    say("shaders read again, one does not compile: its last version goes on", true);
  rendered_.reset();
}

/// Time, camera and lights of the scene as the order has them.
void PictureStudio::place(const PictureOrder& order) {
  const SceneQuestion& s = order.scene;
  // For other reasons than time and camera.
  const bool relit = !placed_ || !sameFields(QuestionEffect::lights, s, *placed_);
  const bool turned = !placed_ || s.environmentRotation != placed_->environmentRotation ||
                      s.environmentScale != placed_->environmentScale;
  const bool painted = (relit || session::movingRelights(*view_, s, s.time)) &&
                       (changesMeshes(*view_, s) || (placed_ && changesMeshes(*view_, *placed_)));
  if (turned || painted) {  // it reads the environment and what surfaces emit
    reference_.stop();
    truthKey_.clear();  // what is asked may be the same: it is asked again
  }
  placed_.reset();  // where a light is refused the others may be set in part: the next order sets all again
  if (!relit) {
    session::moveTo(*view_, s, s.time);
  } else {
    view_->time = s.time;
    session::relight(*view_, s);
    if (turned) {
      picture_->forget();
      if (other_) other_->forget();
    }
  }
  placed_ = s;
  view_->aa = s.aa;
  session::chooseLight(*view_, s);
}

PictureStudio::Outcome PictureStudio::renderShot(ShownPicture& picture, const render::Settings& settings,
                                                 const PictureOrder& order,
                                                 const std::function<bool()>& cancelled, Shot& shot) {
  picture.configure(settings);
  const Outcome outcome =
      picture.render(view_->camera, view_->time, view_->animation, order.timed, cancelled);
  facts_.compiled = facts_.toCompile = 0;
  shot.problem = picture.problem();
  if (outcome != Outcome::done) return outcome;
  shot.image = readBack(*picture.display());
  shot.size = settings.size;
  shot.whole = settings.size == order.size;
  shot.ms = picture.frameMs();
  return outcome;
}

/// The second picture, which holds the scene once more: where there is no room for that, the first one stays.
PictureStudio::Outcome PictureStudio::renderBeside(const render::Settings& settings,
                                                   const PictureOrder& order,
                                                   const std::function<bool()>& cancelled, Shot& shot) {
  try {
    if (!other_) other_ = makePicture(*view_);
  } catch (const std::exception&) {
    shot.problem = currentFailure();
    return Outcome::failed;
  }
  return renderShot(*other_, settings, order, cancelled, shot);
}

/// Where it failed, facts_ say why; where it was cancelled, they show what they showed, without figures.
PictureStudio::Outcome PictureStudio::render(const PictureOrder& order,
                                             const std::function<bool()>& cancelled) {
  smooth_.reset();
  smoothOther_.reset();
  compared_ = false;
  facts_.metrics.reset();
  try {
    place(order);
  } catch (const Error& error) {
    facts_.picture.problem = error.what();
    inspect(order);  // the texture of the frame before is none of this order's
    return Outcome::failed;
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
  Shot picture = facts_.picture, other;  // told together: both are of one view
  const Outcome outcome = renderShot(*picture_, settings, order, cancelled, picture);
  if (outcome == Outcome::cancelled) return outcome;
  if (outcome == Outcome::done) ms += picture.ms;
  settings.inspect.reset();
  if (order.beside == Beside::techniques) {
    settings.techniques = order.others;
    other = facts_.other;
    const Outcome beside = renderBeside(settings, order, cancelled, other);
    if (beside == Outcome::cancelled) return beside;
    if (beside == Outcome::done) ms += other.ms;
  }
  facts_.picture = std::move(picture);
  facts_.other = std::move(other);
  wholeMs_ = ms * reduction_ * reduction_;
  ++facts_.pictures;
  describe(order);
  inspect(order);
  return outcome;
}

/// The lights as the view has them now.
void PictureStudio::describeLights() {
  facts_.lights.resize(view_->pose.lights.size());
  const std::vector<std::string> names = session::findableNames(view_->pose.lightNames);
  for (size_t i = 0; i < facts_.lights.size(); ++i) {
    LightFacts& light = facts_.lights[i];
    light.name = names[i];
    light.light = view_->pose.lights[i];
    light.editable = session::isEditable(view_->scene, view_->pose, static_cast<int>(i));
    light.now = session::describeLight(view_->scene, view_->pose, static_cast<int>(i));
  }
}

void PictureStudio::describe(const PictureOrder& order) {
  facts_.asked = order.scene;
  facts_.camera = view_->camera;
  describeLights();
  if (!facts_.picture.problem.empty()) return;
  auto frame = std::make_shared<FrameFacts>();
  frame->passes = picture_->passes();
  frame->times = picture_->times();
  frame->memoryBytes = picture_->renderer().memoryBytes();
  facts_.frame = std::move(frame);
}

/// Renders again if the order, or how small the picture may be, has changed; true if so.
bool PictureStudio::follow(const PictureOrder& order, const std::function<bool()>& outdated) {
  int wanted = 1;
  if (order.moving)
    while (wanted < kLargestReduction && wholeMs_ / (wanted * wanted) > kFluentMs) wanted *= 2;
  PictureOrder before = rendered_.value_or(order);
  before.moving = order.moving;  // which alone does not change a whole picture
  // Of what is shown already no smaller picture is needed.
  const bool again = !rendered_ || wanted < reduction_ || !same(order, before);
  rendered_ = order;
  if (!again) return false;
  reduction_ = wanted;
  facts_.settled = metered_ = false;
  facts_.exposureEv = order.tone.exposureEv;
  const double start = now();
  const auto milliseconds = [&] { return 1000 * (now() - start); };
  const bool smallest = order.moving && reduction_ == kLargestReduction;
  const bool slow = wholeMs_ / (reduction_ * reduction_) > kFluentMs;
  const auto cancelled = [&] {
    if (smallest) return false;
    // A GPU takes the commands of all passes long before it has done the first ones.
    if (slow) device_.gl().Finish();
    return milliseconds() > kFluentMs && outdated();
  };
  if (render(order, cancelled) == Outcome::cancelled) {
    rendered_.reset();
    wholeMs_ = std::max(wholeMs_, kSlower * milliseconds() * reduction_ * reduction_);
    return false;
  }
  wantedTruth(order);  // the one before is not to stand beside this picture
  publish();
  return true;
}

void PictureStudio::step(const PictureOrder& wanted, const std::function<bool()>& outdated) {
  if (!view_ || wanted.of != facts_.scene || wanted.size.x < 1 || wanted.size.y < 1) return;
  reloadShaders();
  PictureOrder order = exposed(wanted);
  bool changed = follow(order, outdated);
  if (!rendered_) return;  // given up
  if (meter(order)) {
    order = exposed(wanted);
    changed |= follow(order, outdated);
    metered_ = true;  // light is the same, whatever it is multiplied by
    if (!rendered_) return;
  }
  changed |= followReference(order);
  changed |= inspectAtRest(order);
  changed |= smooth(order, outdated);
  if (!rendered_) return;
  changed |= compare(order);
  if (!changed && facts_.settled != order.moving) return;
  facts_.settled = !order.moving;
  publish();
}

}  // namespace limn::app
