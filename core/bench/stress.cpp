#include "core/bench/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "core/base/error.h"
#include "core/bench/private/stress_scene.h"
#include "core/image/metrics.h"
#include "core/question/term.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "core/render/supersample.h"

namespace limn::bench {
namespace {

constexpr double kBenignFloor = 0.01;  // smaller errors are all the same
constexpr double kMaxMasked = 0.05;    // edges count for more in small pictures than in the bench's

constexpr StressCase kCommon[] = {
    {.name = "scale 1e-4", .change = StressChange::sceneScale, .amount = 1e-4},
    {.name = "scale 1e4", .change = StressChange::sceneScale, .amount = 1e4},
    {.name = "light without size", .change = StressChange::lightSize, .amount = 0},
    {.name = "light of 10 scene radii", .change = StressChange::lightSize, .amount = 10},
    {.name = "depth range 1e6", .change = StressChange::depthRange, .amount = 1e6},
    {.name = "1 x 1 pixel", .change = StressChange::imageWidth, .amount = 1, .factor = 0},
    {.name = "8192 x 1 pixels", .change = StressChange::imageWidth, .amount = 8192, .factor = 0},
    {.name = "one triangle", .change = StressChange::oneTriangle},
    {.name = "degenerate triangles", .change = StressChange::degenerate},
    {.name = "NaN vertex", .change = StressChange::invalidVertices},
    {.name = "11.5 million triangles", .scene = "soldiers"},
    {.name = "albedo 0", .change = StressChange::albedo, .amount = 0},
    {.name = "albedo 0.999", .change = StressChange::albedo, .amount = 0.999},
    {.name = "radiance 1e-6", .change = StressChange::radiance, .amount = 1e-6},
    {.name = "radiance 1e6", .change = StressChange::radiance, .amount = 1e6},
    {.name = "no light", .change = StressChange::noLight},
    {.name = "camera inside an object", .change = StressChange::cameraInside},
    {.name = "contact at 1e-6", .change = StressChange::contact, .amount = 1e-6},
    {.name = "floor edge-on", .change = StressChange::edgeOn},
    {.name = "foliage", .scene = "plant"},
};

/// A term without a picture of its own is shown by that of direct light, which it is a part of.
bool partOfDirect(Term term) {
  return termInfo(term).picture == TermPicture::none;
}

/// What shows an answered term under a change of the scene.
Term shown(Term answered, StressChange change) {
  switch (answered) {
    case Term::media:
    case Term::caustic:
    case Term::specular:
      return answered;
    default:
      break;
  }
  switch (change) {
    case StressChange::noLight:
      return Term::final;
    case StressChange::radiance:
    case StressChange::albedo:
      return answered == Term::indirect || answered == Term::subsurface ? answered : Term::direct;
    default:
      return partOfDirect(answered) ? Term::direct : answered;
  }
}

ParameterValues parametersOf(const TechniquePlugin& technique, const char* settings) {
  ParameterValues values(technique.info->name, technique.info->parameters);
  std::istringstream words(settings);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw UsageError(fmt::format("stress case of {}: '{}' is not NAME=VALUE", technique.info->name, word));
    values.set(word.substr(0, equals), word.substr(equals + 1));
  }
  return values;
}

/// Throws Error for values that no picture may have.
void checkValues(const Image& image, Term term) {
  std::size_t notFinite = 0, outOfRange = 0;
  for (const int channel : image.rgbChannels())
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
      const float v =
          image
              .data()[i * static_cast<std::size_t>(image.channelCount()) + static_cast<std::size_t>(channel)];
      notFinite += !std::isfinite(v);
      outOfRange += v < 0 || (isFactor(term) && v > 1);
    }
  if (notFinite > 0) throw std::range_error(fmt::format("{} values are not finite", notFinite));
  if (outOfRange > 0) throw std::range_error(fmt::format("{} values are out of range", outOfRange));
}

double meanOf(const Image& image) {
  double sum = 0;
  for (const int channel : image.rgbChannels())
    for (std::size_t i = 0; i < image.pixelCount(); ++i)
      sum +=
          image
              .data()[i * static_cast<std::size_t>(image.channelCount()) + static_cast<std::size_t>(channel)];
  return sum / static_cast<double>(3 * std::max<std::size_t>(1, image.pixelCount()));
}

bool anyCoverage(const Image& reference) {
  const int channel = reference.channel("coverage");
  for (std::size_t i = 0; i < reference.pixelCount(); ++i)
    if (reference.data()[i * static_cast<std::size_t>(reference.channelCount()) +
                         static_cast<std::size_t>(channel)] > 0)
      return true;
  return false;
}

/// The settings of the unchanged scene: a technique's own form of a common case has them there as well, since
/// its defaults would take hours.
const char* unchangedSettings(const StressCase& c) {
  const bool isCommon = std::ranges::any_of(
      kCommon, [&](const StressCase& common) { return std::string_view(common.name) == c.name; });
  return isCommon ? c.settings : "";
}

}  // namespace

/// A term that a technique answers, and the term whose picture shows it.
struct StressRun::Asked {
  Term answered, shown;

  std::string name() const {
    return partOfDirect(answered) && shown == Term::direct ? limn::name(answered) : limn::name(shown);
  }
};

/// A scene, changed, and the camera that looks at it.
struct StressRun::Question {
  std::string key;
  scene::Scene scene;
  render::Renderer renderer;
  scene::CameraPose camera;
  glm::ivec2 size;

  Question(gpu::Device& device, std::string text, scene::Scene changed)
      : key(std::move(text)), scene(std::move(changed)), renderer(device, scene) {}

  /// V and W are those of one light.
  int light(Term term) { return isFactor(term) && !renderer.pose().lights.empty() ? 0 : scene::kNone; }
};

std::span<const StressCase> commonStressCases() {
  return kCommon;
}

StressCase stressCaseFor(const TechniqueInfo& technique, StressCase stressCase) {
  const bool anyScene = std::string_view(stressCase.scene) == "balls";
  if (anyScene && technique.places) stressCase.scene = "bump_wall";
  if (anyScene && contains(technique.terms, Term::subsurface)) stressCase.scene = "translucent_head";
  const bool wantsShadows = (technique.terms & (Term::surface | Term::subsurface)) != 0;
  if (wantsShadows && *stressCase.beside == '\0') stressCase.beside = "ray_traced_area_light";
  return stressCase;
}

StressRun::StressRun(gpu::Device& device, const TechniqueRegistry& registry,
                     std::function<scene::Scene(const std::string&)> scene, StressOptions options)
    : device_(device), registry_(registry), scene_(std::move(scene)), options_(options) {}
StressRun::~StressRun() = default;

std::vector<StressRun::Asked> StressRun::askedOf(TermSet answered, StressChange change) {
  std::vector<Asked> all;
  for (const TermInfo& info : kTerms) {
    if (!contains(answered, info.term)) continue;
    const Asked asked{info.term, shown(info.term, change)};
    if (std::ranges::find(all, asked.name(), &Asked::name) == all.end()) all.push_back(asked);
  }
  // Terms of one scene follow each other, since few scenes are kept.
  std::ranges::stable_sort(all, {}, [](const Asked& asked) {
    return asked.answered == Term::environment ? 1 : asked.answered == Term::surface ? 2 : 0;
  });
  return all;
}

std::vector<std::string> StressRun::terms(TermSet answered, StressChange change) {
  std::vector<std::string> names;
  for (const Asked& asked : askedOf(answered, change)) names.push_back(asked.name());
  return names;
}

StressRun::Question& StressRun::question(const Asked& asked, const StressCase& c) {
  const bool sky = asked.answered == Term::environment;
  const bool fog = asked.answered == Term::media || asked.answered == Term::caustic;
  const bool glass = asked.answered == Term::specular;
  const bool models = asked.answered == Term::surface;
  const std::string key =
      fmt::format("{} {} {}{}{}{}{}", c.scene, static_cast<int>(c.change), c.amount, sky ? " sky" : "",
                  fog ? " fog" : "", glass ? " glass" : "", models ? " models" : "");
  const auto known = std::ranges::find(
      questions_, key, [](const std::unique_ptr<Question>& kept) -> const std::string& { return kept->key; });
  if (known != questions_.end()) {
    std::rotate(known, known + 1, questions_.end());
    return *questions_.back();
  }
  const auto most = static_cast<std::size_t>(std::max(1, options_.scenes));
  if (questions_.size() >= most) questions_.erase(questions_.begin());
  scene::Scene scene = scene_(c.scene);
  if (sky) scene = litBySkyAlone(std::move(scene));
  if (fog) scene = inFog(std::move(scene));
  if (glass) scene = withGlass(std::move(scene));
  if (models) scene = withModels(std::move(scene));
  auto question = std::make_unique<Question>(device_, key, stressed(std::move(scene), c.change, c.amount));
  const scene::Pose& pose = question->renderer.pose();
  question->camera = pose.cameras.at(0);
  if (c.change == StressChange::cameraInside || c.change == StressChange::cameraNear)
    question->camera =
        cameraAtSmallest(question->scene, pose, question->camera, static_cast<float>(c.amount));
  question->size = {options_.width, options_.height};
  if (c.change == StressChange::imageWidth) question->size = {static_cast<int>(c.amount), 1};
  questions_.push_back(std::move(question));
  return *questions_.back();
}

/// The RMSE against the reference, relative to its mean unless it is a factor of a light. Throws
/// std::range_error for values that no picture may have, Error where something refuses.
double StressRun::error(const TechniquePlugin& technique, const StressCase& c, const Asked& asked) {
  Question& q = question(asked, c);
  const Term term = asked.shown;
  const int light = q.light(term);
  render::Settings settings;
  settings.size = q.size;
  settings.term = term;
  settings.light = light;
  settings.channels = true;
  settings.techniques = {{&technique, parametersOf(technique, c.settings)}};
  if (*c.beside != '\0') {
    const TechniquePlugin& other = registry_.find(c.beside);
    settings.techniques.push_back({&other, parametersOf(other, "")});
  }
  const int interfaces = render::interfacesOf(term, settings.techniques);
  const int bounces = render::bouncesOf(term, settings.techniques);
  q.renderer.configure(std::move(settings));
  const Image image = render::supersample(q.renderer, q.camera, q.size, 1);  // all frames of its history
  checkValues(image, term);

  const auto [known, isNew] =
      references_.try_emplace(fmt::format("{} {} {} {}", q.key, name(term), interfaces, bounces));
  if (isNew) {
    reference::Request request{
        .scene = q.scene, .pose = q.renderer.pose(), .camera = q.camera, .progress = {}, .checkpoint = {}};
    request.width = q.size.x;
    request.height = q.size.y;
    request.term = term;
    request.light = light == scene::kNone ? reference::kAllLights : light;
    request.spp = options_.spp;
    request.bounces = bounces;
    request.interfaces = interfaces;
    try {
      known->second = reference::render(request).image;
    } catch (...) {
      references_.erase(known);
      throw;
    }
  }
  const Image& reference = known->second;
  if (!anyCoverage(reference)) return 0;
  const double rmse =
      compareImages(
          image, reference,
          {.maxMaskedShare = kMaxMasked, .background = termInfo(term).background, .maskTermRange = {}})
          .rmse;
  if (isFactor(term)) return rmse;
  const double mean = meanOf(reference);
  return mean > 0 ? rmse / mean : rmse;
}

double StressRun::benign(const TechniquePlugin& technique, const StressCase& c, const Asked& asked) {
  const StressCase unchanged{
      .name = "unchanged", .scene = c.scene, .settings = unchangedSettings(c), .beside = c.beside};
  const std::string key = fmt::format("{} {} {} {} {} {}", technique.info->name, c.scene,
                                      name(asked.answered), name(asked.shown), c.beside, unchanged.settings);
  if (const auto known = benign_.find(key); known != benign_.end()) return known->second;
  return benign_[key] = error(technique, unchanged, asked);
}

StressAnswer StressRun::answer(const TechniquePlugin& technique, const StressCase& c, const Asked& asked) {
  StressAnswer answer{.term = asked.name()};
  try {
    answer.benign = benign(technique, c, asked);
    const bool unchanged =
        c.change == StressChange::none && std::string_view(c.settings) == unchangedSettings(c);
    answer.error = unchanged ? answer.benign : error(technique, c, asked);
    answer.factor = answer.error / std::max(answer.benign, kBenignFloor);
    answer.verdict = c.factor > 0 && answer.factor > c.factor ? StressVerdict::degraded : StressVerdict::pass;
  } catch (const std::range_error& bad) {
    answer.verdict = StressVerdict::failed;
    answer.message = bad.what();
  } catch (const Error& refusal) {
    answer.verdict = StressVerdict::refused;
    answer.message = refusal.what();
  }
  return answer;
}

StressResult StressRun::run(const TechniquePlugin& technique, const StressCase& stressCase, bool own) {
  const StressCase c = stressCaseFor(*technique.info, stressCase);
  StressResult result{.technique = technique.info->name,
                      .name = c.name,
                      .scene = c.scene,
                      .settings = c.settings,
                      .beside = c.beside,
                      .own = own,
                      .allowed = c.factor};
  for (const Asked& asked : askedOf(technique.info->terms, c.change))
    result.answers.push_back(answer(technique, c, asked));
  std::ranges::stable_sort(result.answers, std::ranges::greater(), [](const StressAnswer& answer) {
    return std::tuple(answer.verdict, answer.factor);
  });
  return result;
}

}  // namespace limn::bench
