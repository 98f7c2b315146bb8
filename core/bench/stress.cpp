#include "core/bench/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "core/base/error.h"
#include "core/bench/private/columns.h"
#include "core/bench/private/markdown.h"
#include "core/bench/private/stress_scene.h"
#include "core/image/metric_table.h"
#include "core/image/metrics.h"
#include "core/question/term.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"

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

/// V where the technique has one and light has no part in the case; else the radiance it answers for.
Term termOf(const TechniquePlugin& technique, StressChange change) {
  const TermSet terms = technique.info->terms;
  for (const Term alone : {Term::media, Term::caustic, Term::specular})
    if (terms == termSet(alone)) return alone;
  const bool indirect = terms == termSet(Term::indirect);
  switch (change) {
    case StressChange::radiance:
    case StressChange::albedo:
      return indirect ? Term::indirect : Term::direct;
    case StressChange::noLight:
      return Term::final;
    default:
      if (indirect) return Term::indirect;
      return contains(terms, Term::visibility) ? Term::visibility : Term::direct;
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
      outOfRange += v < 0 || (term == Term::visibility && v > 1);
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

bool isMeasured(const StressResult& r) {
  return r.verdict == Verdict::pass || r.verdict == Verdict::degraded;
}

bool isBounded(const StressResult& r) {
  return isMeasured(r) && r.allowed > 0;
}

std::vector<MarkdownColumn<StressResult>> stressColumns() {
  static constexpr const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  return {
      {{headOf("technique"), Align::left}, [](const StressResult& r) { return r.technique; }},
      {{"case", Align::left},
       [](const StressResult& r) {
         return r.settings.empty() ? r.name : fmt::format("{} ({})", r.name, r.settings);
       }},
      {{headOf("scene"), Align::left}, [](const StressResult& r) { return r.scene; }},
      {{"verdict", Align::left},
       [](const StressResult& r) {
         return r.message.empty() ? name(r.verdict) : fmt::format("{}: {}", name(r.verdict), r.message);
       }},
      {{std::string(rmse.head)},
       [](const StressResult& r) { return isMeasured(r) ? shownText(rmse, r.error) : "-"; }},
      {{fmt::format("{} unchanged", rmse.head)},
       [](const StressResult& r) { return shownText(rmse, r.benign); }},
      {{"factor"},
       [](const StressResult& r) { return isBounded(r) ? fmt::format("{:.2f}", r.factor) : "-"; }},
      {{"allowed"},
       [](const StressResult& r) { return isBounded(r) ? fmt::format("{:.1f}", r.allowed) : "-"; }},
  };
}

}  // namespace

/// What is asked: a scene, changed, and a term of it.
struct StressRun::Question {
  std::string key;
  scene::Scene scene;
  render::Renderer renderer;
  Term term;
  int light = scene::kNone;
  scene::CameraPose camera;
  glm::ivec2 size;

  Question(gpu::Device& device, std::string text, scene::Scene changed, Term wanted)
      : key(std::move(text)), scene(std::move(changed)), renderer(device, scene), term(wanted) {}
};

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::degraded:
      return "degraded";
    case Verdict::refused:
      return "refused";
    case Verdict::failed:
      break;
  }
  return "failed";
}

namespace {

Verdict verdictFrom(const std::string& text) {
  for (const Verdict verdict : {Verdict::pass, Verdict::degraded, Verdict::refused, Verdict::failed})
    if (text == name(verdict)) return verdict;
  throw Error(fmt::format("verdict '{}' is unknown; expected pass, degraded, refused or failed", text));
}

}  // namespace

std::span<const StressCase> commonStressCases() {
  return kCommon;
}

StressRun::StressRun(gpu::Device& device, std::function<scene::Scene(const std::string&)> scene,
                     StressOptions options)
    : device_(device), scene_(std::move(scene)), options_(options) {}
StressRun::~StressRun() = default;

StressRun::Question& StressRun::question(const TechniquePlugin& technique, const StressCase& c, Term term) {
  // Of a technique that has shadows of lights, too, those are asked for.
  const bool sky = contains(technique.info->terms, Term::environment) &&
                   !contains(technique.info->terms, Term::visibility);
  const bool fog =
      contains(technique.info->terms, Term::media) || contains(technique.info->terms, Term::caustic);
  const bool glass = contains(technique.info->terms, Term::specular);
  const std::string key =
      fmt::format("{} {} {} {}{}{}{}", c.scene, static_cast<int>(c.change), c.amount, name(term),
                  sky ? " sky" : "", fog ? " fog" : "", glass ? " glass" : "");
  if (question_ && question_->key == key) return *question_;
  question_.reset();
  scene::Scene scene = scene_(c.scene);
  if (sky) scene = litBySkyAlone(std::move(scene));
  if (fog) scene = inFog(std::move(scene));
  if (glass) scene = withGlass(std::move(scene));
  auto question =
      std::make_unique<Question>(device_, key, stressed(std::move(scene), c.change, c.amount), term);
  const scene::Pose& pose = question->renderer.pose();
  if (term == Term::visibility && !pose.lights.empty()) question->light = 0;
  question->camera = pose.cameras.at(0);
  if (c.change == StressChange::cameraInside || c.change == StressChange::cameraNear)
    question->camera =
        cameraAtSmallest(question->scene, pose, question->camera, static_cast<float>(c.amount));
  question->size = {options_.width, options_.height};
  if (c.change == StressChange::imageWidth) question->size = {static_cast<int>(c.amount), 1};
  question_ = std::move(question);
  return *question_;
}

/// The RMSE against the reference, relative to its mean unless it is a visibility. Throws std::range_error
/// for values that no picture may have, Error where something refuses.
double StressRun::error(const TechniquePlugin& technique, const StressCase& c, Term term) {
  Question& q = question(technique, c, term);
  render::Settings settings;
  settings.size = q.size;
  settings.term = q.term;
  settings.light = q.light;
  settings.channels = true;
  settings.techniques = {{&technique, parametersOf(technique, c.settings)}};
  const int interfaces = render::interfacesOf(q.term, settings.techniques);
  q.renderer.configure(std::move(settings));
  q.renderer.setCamera(q.camera);
  q.renderer.render();
  const Image image = q.renderer.read();
  checkValues(image, q.term);

  const auto [known, isNew] = references_.try_emplace(fmt::format("{} {}", q.key, interfaces));
  if (isNew) {
    reference::Request request{
        .scene = q.scene, .pose = q.renderer.pose(), .camera = q.camera, .progress = {}, .checkpoint = {}};
    request.width = q.size.x;
    request.height = q.size.y;
    request.term = q.term;
    request.light = q.light == scene::kNone ? reference::kAllLights : q.light;
    request.spp = options_.spp;
    request.bounces = reference::defaultBounces(q.term);
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
          {.maxMaskedShare = kMaxMasked, .background = termInfo(q.term).background, .maskTermRange = {}})
          .rmse;
  if (q.term == Term::visibility) return rmse;
  const double mean = meanOf(reference);
  return mean > 0 ? rmse / mean : rmse;
}

double StressRun::benign(const TechniquePlugin& technique, const char* scene, Term term) {
  const std::string key = fmt::format("{} {} {}", technique.info->name, scene, name(term));
  if (const auto known = benign_.find(key); known != benign_.end()) return known->second;
  return benign_[key] = error(technique, {.name = "unchanged", .scene = scene}, term);
}

StressResult StressRun::run(const TechniquePlugin& technique, const StressCase& c, bool own) {
  StressResult result{.technique = technique.info->name,
                      .name = c.name,
                      .scene = c.scene,
                      .settings = c.settings,
                      .own = own,
                      .allowed = c.factor,
                      .message = {}};
  try {
    const Term term = termOf(technique, c.change);
    result.benign = benign(technique, c.scene, term);
    const bool unchanged = c.change == StressChange::none && *c.settings == '\0';
    result.error = unchanged ? result.benign : error(technique, c, term);
    result.factor = result.error / std::max(result.benign, kBenignFloor);
    result.verdict = c.factor > 0 && result.factor > c.factor ? Verdict::degraded : Verdict::pass;
  } catch (const std::range_error& bad) {
    result.verdict = Verdict::failed;
    result.message = bad.what();
  } catch (const Error& refusal) {
    result.verdict = Verdict::refused;
    result.message = refusal.what();
  }
  return result;
}

std::string toMarkdown(std::span<const StressResult> results) {
  static const std::vector<MarkdownColumn<StressResult>> columns = stressColumns();
  std::string text = markdownHead(columns);
  for (const StressResult& r : results) text += markdownRow(columns, r);
  return text;
}

std::string toJson(std::span<const StressResult> results, const std::string& renderer) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const StressResult& r : results)
    list.push_back({{"technique", r.technique},
                    {"case", r.name},
                    {"scene", r.scene},
                    {"settings", r.settings},
                    {"own", r.own},
                    {"verdict", name(r.verdict)},
                    {"error", r.error},
                    {"benign", r.benign},
                    {"factor", r.factor},
                    {"allowed", r.allowed},
                    {"message", r.message}});
  return Json{{"renderer", renderer}, {"results", list}}.dump(1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

std::vector<StressResult> stressFromJson(const std::string& text, const std::string& renderer) {
  try {
    const auto json = nlohmann::json::parse(text);
    std::vector<StressResult> results;
    if (json.at("renderer") != renderer) return results;
    for (const auto& r : json.at("results"))
      results.push_back({.technique = r.at("technique"),
                         .name = r.at("case"),
                         .scene = r.at("scene"),
                         .settings = r.at("settings"),
                         .own = r.at("own"),
                         .verdict = verdictFrom(r.at("verdict")),
                         .error = r.at("error"),
                         .benign = r.at("benign"),
                         .factor = r.at("factor"),
                         .allowed = r.at("allowed"),
                         .message = r.at("message")});
    return results;
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("not what limn stress writes: {}", error.what()));
  }
}

}  // namespace limn::bench
