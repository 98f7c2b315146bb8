// What is done with a picture when nothing moves: the truth beside it, the error, the values of its textures,
// files. All of it reads from the GPU and may wait for it.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "apps/view/difference.h"
#include "apps/view/display_image.h"
#include "apps/view/picture_studio.h"
#include "apps/view/view_state.h"
#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/base/file.h"
#include "core/image/signature.h"
#include "core/question/question_fields.h"

namespace limn::app {
namespace {

/// Everything that determines the reference's picture.
std::string truthKeyOf(const PictureOrder& order) {
  SceneQuestion question = order.scene;
  question.width = order.size.x;
  question.height = order.size.y;
  const Term term = parseTerm(question.term);
  return fmt::format("{}|{}|{}", questionText(question), render::bouncesOf(term, order.techniques),
                     render::interfacesOf(term, order.techniques));
}

/// Of one channel, or of the first three; black and white where all values are equal.
std::pair<float, float> displayRange(const render::InspectedValues& values, int channel) {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  const int first = channel < 4 ? channel : 0,
            last = channel < 4 ? channel : std::min(values.components, 3) - 1;
  for (int c = first; c <= last; ++c) {
    const render::InspectedValues::Range range = values.range(c);
    low = std::min(low, range.low);
    high = std::max(high, range.high);
  }
  if (!(low < high)) high = low + 1;
  return {static_cast<float>(low), static_cast<float>(high)};
}

}  // namespace

/// What the reference is to be asked; "" where it is not shown. The truth of anything else is dropped, also
/// that of a scene whose key has been cleared.
std::string PictureStudio::wantedTruth(const PictureOrder& order) {
  std::string key = order.beside == Beside::reference ? truthKeyOf(order) : "";
  if (key == truthKey_ && (!key.empty() || !truth_)) return key;
  truthKey_.clear();
  reference_.cancel();
  facts_.reference = reference_.state();
  truth_.reset();
  facts_.truth.reset();
  facts_.difference.reset();
  facts_.metrics.reset();
  compared_ = false;
  return key;
}

bool PictureStudio::followReference(const PictureOrder& order) {
  const std::string key = wantedTruth(order);
  const bool wanted = !key.empty() && !order.moving && facts_.picture.problem.empty();
  if (wanted && truthKey_.empty() && !reference_.busy()) {
    truthKey_ = key;
    const Term term = parseTerm(order.scene.term);
    reference_.start({view_, view_->pose, view_->camera, order.size, order.scene.aa, term, view_->light,
                      render::bouncesOf(term, order.techniques), render::interfacesOf(term, order.techniques),
                      view_->unshadowed, view_->reliefPaths, view_->subsurface});
  }
  std::optional<Image> finer = reference_.take();
  const bool fresh = finer && !truthKey_.empty();
  if (fresh) truth_ = std::move(finer);
  if (truth_ && (fresh || truthTone_ != order.tone)) {
    truthTone_ = order.tone;
    facts_.truth = std::make_shared<const Image8>(toneMapped(*truth_, order.tone));
    compared_ = false;
  }
  const ReferenceWorker::State before = std::exchange(facts_.reference, reference_.state());
  return fresh || !(before == facts_.reference);
}

/// Sets why there are no figures; true if that is news.
bool PictureStudio::noMetrics(const char* why) {
  const bool news = facts_.whyNoMetrics != why || facts_.metrics;
  facts_.whyNoMetrics = why;
  facts_.metrics.reset();
  return news;
}

bool PictureStudio::compare(const PictureOrder& order) {
  if (order.beside == Beside::nothing) return noMetrics("");
  if (order.moving) {
    compared_ = false;  // at rest the figures come back, also where the picture has stayed the same
    return noMetrics("measured when the picture stands still");
  }
  if (!facts_.picture.problem.empty() || !facts_.other.problem.empty())
    return noMetrics("there is no picture to compare");
  if (order.beside == Beside::reference && !truth_)
    return noMetrics(facts_.reference.problem.empty() ? "the first picture of the truth is on its way"
                                                      : "there is no truth to compare with");
  if (compared_) return false;
  compared_ = true;
  try {
    const Image image = smooth_ ? *smooth_ : picture_->read();
    const Image against = order.beside == Beside::reference ? *truth_
                          : smoothOther_                    ? *smoothOther_
                                                            : other_->read();
    facts_.metrics = compareImages(
        image, against, {.exposureEv = order.tone.exposureEv, .useMask = false, .maskTermRange = {}});
    facts_.difference = std::make_shared<const Image8>(signedDifference(image, against, {}));
    facts_.whyNoMetrics.clear();
  } catch (const std::exception&) {
    noMetrics(currentFailure().c_str());
  }
  return true;
}

/// The order with the automatic exposure, if that is wanted.
PictureOrder PictureStudio::exposed(PictureOrder order) const {
  if (order.automaticExposure) order.tone.exposureEv = exposureEv_;
  return order;
}

/// Finds the automatic exposure of a picture at rest; true if it is another one than before.
bool PictureStudio::meter(const PictureOrder& order) {
  if (!order.automaticExposure || order.moving || metered_ || !facts_.picture.problem.empty()) return false;
  metered_ = true;
  const float before = std::exchange(exposureEv_, automaticExposure(picture_->read()));
  return exposureEv_ != before;
}

/// Shows a picture at rest with all its samples in each pixel and all frames over which techniques average.
/// Where `outdated` says that something else is wanted it is given up, and there is no rendered picture any
/// more; where a frame fails, the facts say why.
bool PictureStudio::smooth(const PictureOrder& order, const std::function<bool()>& outdated) {
  if (order.moving || smooth_ || !facts_.picture.problem.empty() || !facts_.other.problem.empty())
    return false;
  const int aa = order.scene.aa;
  const bool beside = order.beside == Beside::techniques;
  if (!picture_->takesMoreFrames(aa) && !(beside && other_->takesMoreFrames(aa))) return false;
  bool failed = false;
  const auto read = [&](ShownPicture& picture, std::optional<Image>& image, Shot& shot) {
    try {
      image = picture.read(view_->camera, aa, outdated);
    } catch (const std::exception&) {
      failed = true;
      shot.problem = currentFailure();
    }
    facts_.compiled = facts_.toCompile = 0;  // later frames may take programs of their own
    if (!image) return false;
    shot.image = std::make_shared<const Image8>(toneMapped(*image, order.tone));
    return true;
  };
  if (!read(*picture_, smooth_, facts_.picture) || (beside && !read(*other_, smoothOther_, facts_.other))) {
    if (!failed) rendered_.reset();
    return failed;
  }
  compared_ = false;
  return true;
}

/// Tells of the texture that the frame just rendered was asked to show.
void PictureStudio::inspect(const PictureOrder& order) {
  const std::optional<InspectedFacts> before = std::exchange(facts_.inspected, std::nullopt);
  if (!order.inspect) return;
  InspectedFacts& facts = facts_.inspected.emplace();
  facts.view = order.inspect->view;
  const render::TextureInspector* inspector = picture_->renderer().inspector();
  if (!facts_.picture.problem.empty() || inspector == nullptr) {
    facts.problem = "the frame has no such texture now";
    return;
  }
  if (order.inspect->automatic && before) {
    facts.view.low = before->view.low;
    facts.view.high = before->view.high;
  }
  facts.desc = inspector->desc();
  facts.view.level = std::clamp(facts.view.level, 0, facts.desc.levels - 1);
  facts.layers = inspector->layersOf(facts.view.level);
  facts.view.layer = std::clamp(facts.view.layer, 0, facts.layers - 1);
  facts.size = inspector->sizeOf(facts.view.level);
  try {
    facts.image = readBack(inspector->display());
  } catch (const std::exception&) {
    facts.problem = fmt::format("the texture cannot be shown: {}", currentFailure());
  }
}

bool PictureStudio::inspectAtRest(const PictureOrder& order) {
  if (order.moving || !facts_.inspected || facts_.inspected->values || !facts_.inspected->problem.empty())
    return false;
  std::shared_ptr<render::InspectedValues> values;
  try {
    values = std::make_shared<render::InspectedValues>(picture_->renderer().inspector()->read());
  } catch (const std::exception&) {  // OpenGL or the memory has a limit
    facts_.inspected->problem = fmt::format("the values cannot be read: {}", currentFailure());
    return true;
  }
  if (order.inspect->automatic) {
    const auto [low, high] = displayRange(*values, order.inspect->view.channel);
    if (low != facts_.inspected->view.low || high != facts_.inspected->view.high) {
      facts_.inspected->view.low = low;
      facts_.inspected->view.high = high;
      if (render(order) != Outcome::done) return true;
    }
  }
  facts_.inspected->values = std::move(values);
  return true;
}

void PictureStudio::save(const SaveOrder& order) {
  if (!view_) return;
  if (saving()) {
    say("not saved: the frames of a sequence are being written", true);
    publish();
    return;
  }
  if (order.frames) {
    sequence_ = {order, order.frames->first};
    return;
  }
  try {
    write(order, order.file);
    finishSaving("wrote " + order.file.string());
  } catch (const std::exception&) {
    finishSaving(currentFailure(), true);
  }
}

/// Returns the picture at its whole size, as limn render makes it. It is not rendered again where it is
/// shown.
Image PictureStudio::renderWhole(const PictureOrder& order) {
  const bool shown = rendered_ && same(*rendered_, order) && facts_.picture.whole;
  if (!shown || !facts_.picture.problem.empty()) {
    reduction_ = 1;
    rendered_.reset();
    const Outcome outcome = render(order);
    wantedTruth(order);  // the one before is not to stand beside this picture
    if (outcome != Outcome::done) throw Error(facts_.picture.problem);
  }
  if (smooth_) return *smooth_;
  const int aa = order.scene.aa;
  // The renderer ends with another frame than the one shown.
  if (picture_->takesMoreFrames(aa)) rendered_.reset();
  return *picture_->read(view_->camera, aa);
}

/// Returns and shows the picture of a sequence that follows the last one: what techniques average goes on.
Image PictureStudio::renderNext(const PictureOrder& order) {
  rendered_.reset();
  place(order);
  Image image = picture_->next(view_->camera, view_->time, view_->animation, view_->light, order.scene.aa);
  facts_.compiled = facts_.toCompile = 0;  // as in smooth()
  facts_.picture.image = std::make_shared<const Image8>(toneMapped(image, order.tone));
  ++facts_.pictures;
  describe(order);
  return image;
}

/// Writes the picture; in a sequence it `follows` the one that was written last.
void PictureStudio::write(const SaveOrder& order, const std::filesystem::path& file, bool follows) {
  const PictureOrder picture = exposed(order.picture);
  if (picture.of != facts_.scene) throw Error("not saved: another scene was opened meanwhile");
  checkApart({file}, files_);
  Image image = follows ? renderNext(picture) : renderWhole(picture);
  checkFinite(image, file, picture.scene.term, namesOf(picture.techniques));
  sign(image, order.command);
  if (file.has_parent_path()) createFolder(file.parent_path());
  ToneMapping tone = picture.tone;
  if (picture.automaticExposure) tone.exposureEv = sequenceEv_ ? *sequenceEv_ : automaticExposure(image);
  if (sequence_) sequenceEv_ = tone.exposureEv;  // the first picture's is that of all
  writePicture(file, image, tone);
}

void PictureStudio::saveNext() {
  const FrameRange range = *sequence_->order.frames;
  const int frame = sequence_->frame++;
  try {
    sequence_->order.picture.scene.time = frame / sequence_->order.fps;
    write(sequence_->order, numbered(sequence_->order.file, frame), frame > range.first);
  } catch (const std::exception&) {
    finishSaving(fmt::format("frame {}: {}", frame, currentFailure()), true);
    return;
  }
  const int done = frame - range.first + 1, all = range.last - range.first + 1;
  facts_.job = fmt::format("frame {} of {}", done, all);
  facts_.jobFraction = static_cast<double>(done) / all;
  if (frame < range.last) return publish();
  finishSaving(
      fmt::format("wrote {} frames, the last to {}", all, numbered(sequence_->order.file, frame).string()));
}

void PictureStudio::cancelSaving() {
  if (!sequence_) return;
  finishSaving(fmt::format("stopped before frame {} of {}", sequence_->frame, sequence_->order.frames->last));
}

void PictureStudio::finishSaving(std::string message, bool problem) {
  sequence_.reset();
  sequenceEv_.reset();
  facts_.job.clear();
  say(std::move(message), problem);
  publish();
}

}  // namespace limn::app
