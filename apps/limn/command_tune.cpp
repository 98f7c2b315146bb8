// limn tune: the settings with the least error in a given time, or the least time at a given error.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "apps/limn/commands.h"
#include "apps/limn/interruption.h"
#include "apps/limn/results_folder.h"
#include "apps/limn/tune_question.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/shell.h"
#include "core/bench/suite_text.h"
#include "core/bench/tune.h"
#include "core/image/metric_table.h"
#include "core/question/render_command.h"
#include "core/reference/reference.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

/// Measures settings as rows of a bench, and says what became of them.
class Tuning {
 public:
  explicit Tuning(const TuneArguments& options)
      : options_(options),
        goal_(tuneGoal(options)),
        term_(parseTerm(options.scene.term)),
        bounces_(reference::hasBounces(term_) ? options.bounces.value_or(reference::defaultBounces(term_))
                                              : 0) {
    if (options.bounces && bounces_ == 0)
      throw UsageError(fmt::format("--bounces: the term {} has none", options.scene.term));
    if (isFactor(term_) && options.scene.light.empty())
      throw UsageError(
          fmt::format("the term {} is that of one light: name it with --light", options.scene.term));
    const TechniqueRegistry registry(TechniqueRegistry::defaultFolders(), warn);
    spaces_ = searchedTechniques(registry, options, term_, bounces_);
    for (const SearchedTechnique& space : spaces_) searched_.push_back(space.space);
    if (options.exhaustive) checkGrid();
  }

  void run() {
    folder_.emplace(options_.out, options_.backend, options_.stallTimeout);
    plan_ = bench::tunePlan(options_.scene.width, options_.scene.height, options_.frames, options_.turns);
    checkFirst();
    std::error_code ignored;
    fs::remove(suiteFile(), ignored);  // what an earlier search found answers another question
    const auto measure = [this](std::span<const bench::TuneSetting> settings,
                                const bench::TuneEffort& effort) { return measured(settings, effort); };
    const bench::TuneResult result =
        options_.exhaustive ? bench::tuneExhaustively(searched_, goal_.tuneLimit(), plan_.full, measure)
                            : bench::tune(searched_, goal_.tuneLimit(), plan_, measure);
    folder_->writeReport();
    say(result);
  }

 private:
  /// Throws UsageError for a grid of more settings than a suite may have cases.
  void checkGrid() const {
    constexpr double most = 100'000;
    double settings = 0;
    for (const bench::TuneSpace& space : searched_)
      settings += static_cast<double>(bench::settingCount(space));
    if (settings > most)
      throw UsageError(
          fmt::format("--exhaustive: the grid has {:.6g} settings, at most {} are measured; --techniques and "
                      "--steps choose fewer, --set fixes a parameter",
                      settings, most));
  }

  fs::path suiteFile() const { return options_.out / "tuned.toml"; }

  /// The suite that measures these settings in full.
  std::string suiteText(std::span<const bench::TuneSetting> settings) const {
    std::string text = fmt::format(
        "# Written by limn tune: `limn bench` on this file measures the answer and the runner-up.\n"
        "name = \"tuned\"\n{}reference = {{spp = {}{}}}\nframes = {}\nwarmup = {}\nturns = {}\n\n{}"
        "max_masked_share = {}\n",
        bench::subjectToml(options_.scene), options_.spp,
        bounces_ > 0 ? fmt::format(", bounces = {}", bounces_) : "", plan_.full.frames, plan_.full.warmup,
        plan_.full.turns, bench::sceneToml(options_.scene), options_.maskedShare);
    for (const bench::TuneSetting& setting : settings)
      text += "\n" + bench::techniqueToml(techniqueOf(setting), parametersOf(setting));
    return text;
  }

  /// Throws UsageError where the scene, or what the question names of it, does not exist.
  void checkFirst() {
    const bench::TuneSetting first{0, startOf(searched_.front())};
    base_ = bench::parseSuite(suiteText(std::span(&first, 1)), "the question").cases.front();
    folder_->check({base_});
  }

  static std::vector<std::size_t> startOf(const bench::TuneSpace& space) {
    std::vector<std::size_t> at;
    for (const bench::TuneAxis& axis : space.axes) at.push_back(axis.start);
    return at;
  }

  const std::string& techniqueOf(const bench::TuneSetting& setting) const {
    return searched_[setting.space].technique;
  }

  TuneParameters parametersOf(const bench::TuneSetting& setting) const {
    TuneParameters parameters = spaces_[setting.space].fixed;
    const TuneParameters changed = bench::changedParameters(searched_[setting.space], setting);
    parameters.insert(parameters.end(), changed.begin(), changed.end());
    return parameters;
  }

  bench::Case caseOf(const bench::TuneSetting& setting, const bench::TuneEffort& effort) const {
    bench::Case c = base_;
    c.technique = techniqueOf(setting);
    c.parameters = parametersOf(setting);
    c.width = std::max(1, c.width / effort.divisor);
    c.height = std::max(1, c.height / effort.divisor);
    c.frames = effort.frames;
    c.warmup = effort.warmup;
    c.turns = effort.turns;
    // Silhouettes, where pixels are masked, are a share of the picture that grows as its sides shrink.
    c.maxMaskedShare = std::min(1.0, c.maxMaskedShare * effort.divisor);
    return c;
  }

  /// Measures how many times as long a frame's G-buffer and shading take in full size as in a look.
  void measureRest(const bench::TuneSetting& setting) {
    const bench::Case large = caseOf(setting, bench::scaleOf(plan_)), small = caseOf(setting, plan_.look);
    measureCases({large, small}, "tune, comparing sizes");  // tables and page begin with what is asked for
    const bench::CostSplit &above = rowOf(large).cost.split, &below = rowOf(small).cost.split;
    rest_ = below.rest > 0 && above.rest > 0 ? std::max(1.0, above.rest / below.rest) : pixelsOver(small);
  }

  void measureCases(const std::vector<bench::Case>& cases, const std::string& progressName) {
    folder_->measure(cases, progressName, Measured::here);
    for (bench::Row& row : folder_->rows()) rows_[row.key] = std::move(row);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      bench::Row& row = rows_.at(bench::rowKey(cases[i], folder_->renderer()));
      // A row of elsewhere would answer with times of elsewhere.
      if (row.failure.empty() && folder_->failed(i)) row.failure = "it failed here, though not elsewhere";
    }
  }

  std::vector<bench::TuneFigures> measured(std::span<const bench::TuneSetting> settings,
                                           const bench::TuneEffort& effort) {
    if (effort.divisor > 1 && !rest_) measureRest(settings.front());
    std::vector<bench::Case> cases;
    for (const bench::TuneSetting& setting : settings) cases.push_back(caseOf(setting, effort));
    const char* what = effort.divisor > 1 || effort.turns < plan_.full.turns ? "tune, trying" : "tune";
    measureCases(cases, fmt::format("{} {} settings", what, cases.size()));
    std::vector<bench::TuneFigures> figures;
    for (const bench::Case& c : cases) figures.push_back(figuresOf(c));
    return figures;
  }

  bench::TuneFigures figuresOf(const bench::Case& c) {
    const bench::Row& row = rowOf(c);
    // What the reference cannot tell apart does not rank; a limit is kept by the value itself.
    const auto error = !row.failure.empty() ? std::nullopt
                       : goal_.ofTime       ? bench::badness(goal_.metric, row.error)
                                            : badnessAsMeasured(row);
    if (!error) {
      if (failure_.empty()) failure_ = fmt::format("{}: {}", bench::label(c), row.failure);
      return {0, 0, true};
    }
    if (!std::isfinite(*error))
      throw Error(fmt::format(
          "the {} of {} is infinite, as under a black reference, and tells no settings apart; use {}",
          goal_.metric.label, bench::label(c), metricInfo(&Metrics::rmse).key));
    return {*error, bench::msAtPixels(row, pixelsOver(c), rest_.value_or(1)), false};
  }

  std::optional<double> badnessAsMeasured(const bench::Row& row) const {
    const auto value = metricValue(goal_.metric, row.error);
    return value ? std::optional(bench::badness(goal_.metric, *value)) : std::nullopt;
  }

  /// How many times as many pixels the picture has that is asked for.
  double pixelsOver(const bench::Case& c) const {
    return double(base_.width) * base_.height / (double(c.width) * c.height);
  }

  const bench::Row& rowOf(const bench::Case& c) const {
    return rows_.at(bench::rowKey(c, folder_->renderer()));
  }

  /// Error and time of what was measured in full.
  std::string figuresText(const bench::TuneSetting& setting) const {
    const bench::Row& row = rowOf(caseOf(setting, plan_.full));
    const bench::Ratio ms = bench::frameMsInterval(row);
    return fmt::format("{} {}, {:.3f} ms a frame ({:.3f} to {:.3f})", goal_.metric.label,
                       shownText(goal_.metric, row.error), ms.value, ms.low, ms.high);
  }

  std::string commandOf(const bench::TuneSetting& setting) const {
    std::string command = renderCommand(options_.scene, techniqueOf(setting), parametersOf(setting));
    for (const std::string& argument : options_.backend.arguments()) command += " " + shellQuoted(argument);
    return command + " --out tuned.png";
  }

  /// Says that the reference cannot tell whether a setting that was measured in full keeps the limit; ""
  /// where it can.
  std::string doubt(const bench::TuneSetting& setting) const {
    const std::optional<double> floor = rowOf(caseOf(setting, plan_.full)).error.noise_floor;
    if (goal_.ofTime || !goal_.metric.floored || !floor || goal_.limit >= *floor) return {};
    return fmt::format("the limit lies below the noise of the reference ({}), which more --spp lessens",
                       shownText(goal_.metric, *floor));
  }

  /// The best setting of another technique; where there is none, the second best.
  static std::optional<bench::TuneSetting> runnerUp(const std::vector<bench::TuneSetting>& answers) {
    const auto other = std::ranges::find_if(
        answers, [&](const bench::TuneSetting& setting) { return setting.space != answers.front().space; });
    if (other != answers.end()) return *other;
    return answers.size() > 1 ? std::optional(answers[1]) : std::nullopt;
  }

  void say(const bench::TuneResult& result) const {
    if (!result.nearest) throw Error(fmt::format("no setting could be measured: {}", failure_));
    const std::string doubts = doubt(*result.nearest);
    if (result.answers.empty())
      throw Error(fmt::format("no setting {}; the nearest is {} with {}{}{}", goal_.text(),
                              bench::label(caseOf(*result.nearest, plan_.full)), figuresText(*result.nearest),
                              doubts.empty() ? "" : "; ", doubts));
    if (!doubts.empty()) warn(doubts);
    std::vector<bench::TuneSetting> chosen{result.answers.front()};
    if (const auto second = runnerUp(result.answers)) chosen.push_back(*second);
    writeTextFile(suiteFile(), suiteText(chosen));
    if (options_.json)
      fmt::print("{}\n", describe(result, chosen).dump(2));
    else
      sayChosen(chosen);
    const std::string tried = result.looked > 0 ? fmt::format("{} settings tried, {} of them checked, ",
                                                              result.looked, result.checked)
                                                : std::string();
    fmt::print(stderr, "limn: {} techniques: {}{} settings measured\n", spaces_.size(), tried,
               result.measured);
    sayWritten(suiteFile());
    sayWritten(options_.out / "index.html");
  }

  void sayChosen(const std::vector<bench::TuneSetting>& chosen) const {
    fmt::print("{}\n    {}\n", commandOf(chosen.front()), figuresText(chosen.front()));
    if (chosen.size() > 1)
      fmt::print("runner-up: {}\n    {}\n", commandOf(chosen.back()), figuresText(chosen.back()));
  }

  nlohmann::ordered_json describe(const bench::TuneSetting& setting) const {
    const bench::Row& row = rowOf(caseOf(setting, plan_.full));
    const bench::Ratio ms = bench::frameMsInterval(row);
    nlohmann::ordered_json json{{"technique", techniqueOf(setting)},
                                {"parameters", nlohmann::ordered_json::object()},
                                {"command", commandOf(setting)},
                                {"error", *metricValue(goal_.metric, row.error)},
                                {"ms", ms.value},
                                {"ms_interval", {ms.low, ms.high}}};
    for (const auto& [name, value] : parametersOf(setting)) json["parameters"][name] = value;
    return json;
  }

  /// What --json prints.
  nlohmann::ordered_json describe(const bench::TuneResult& result,
                                  const std::vector<bench::TuneSetting>& chosen) const {
    nlohmann::ordered_json json{{"metric", goal_.metric.key},
                                {goal_.ofTime ? "max_ms" : "max_error", goal_.limit},
                                {"renderer", folder_->renderer()},
                                {"answer", describe(chosen.front())}};
    if (chosen.size() > 1) json["runner_up"] = describe(chosen.back());
    json["settings_tried"] = result.looked;
    json["settings_measured"] = result.measured;
    return json;
  }

  const TuneArguments& options_;
  TuneGoal goal_;
  Term term_;
  int bounces_;  ///< of the reference; 0: the term has none
  std::vector<SearchedTechnique> spaces_;
  std::vector<bench::TuneSpace> searched_;
  bench::TunePlan plan_;
  bench::Case base_;
  std::optional<ResultsFolder> folder_;
  std::map<std::string, bench::Row> rows_;
  std::optional<double> rest_;  ///< factor of the time of what is not the technique's, nor maps, in full size
  std::string failure_;         ///< the first one
};

int runTune(TuneArguments options) {
  if (!options.termGiven)
    options.scene.term = name(options.scene.light.empty() ? Term::direct : Term::visibility);
  const LastWords words(fmt::format("interrupted; the rows so far are kept in {}, the same command goes on",
                                    (options.out / "results.jsonl").string()));
  Tuning(options).run();
  return 0;
}

}  // namespace

Action addTuneCommand(CLI::App& command) {
  auto options = std::make_shared<TuneArguments>();
  addSceneFlags(command, options->scene);
  CLI::Option* term = addSceneFlag(command, options->scene, "term", "--term");
  term->default_str("direct, or visibility with --light");
  CLI::Option* maxMs =
      command
          .add_option("--max-ms", options->maxMs,
                      "Milliseconds of a frame that the answer may take; it is the one with the least error")
          ->check(realRange(1e-6, 1e9));
  CLI::Option* maxError =
      command
          .add_option(
              "--max-error", options->maxError,
              "METRIC=X, such as rmse=0.01: the error that the answer may have (PSNR: must reach); it is "
              "the quickest one")
          ->excludes(maxMs);
  command.add_option("--metric", options->metric, "The error that --max-ms makes least, a field of results")
      ->excludes(maxError)
      ->capture_default_str();
  command.add_option("--techniques,--technique", options->techniques,
                     "Techniques to choose from, comma-separated; default: all that answer the term, for "
                     "direct and final those that answer direct or visibility");
  takeOneEach(command.add_option("--set", options->settings,
                                 "TECHNIQUE.PARAMETER=VALUE, repeatable: a parameter that is not searched"));
  command
      .add_option("--steps", options->steps,
                  "Most steps from a parameter's default in each direction, by factors of 2")
      ->capture_default_str()
      ->transform(wholeRange(0, 12));
  command.add_option("--spp", options->spp, "Samples per pixel of the references")
      ->capture_default_str()
      ->transform(wholeRange(1, 1 << 24));
  command.add_option("--bounces", options->bounces, "Bounces of indirect light; default: the term's")
      ->transform(wholeRange(1, reference::kMaxBounces));
  command.add_option("--frames", options->frames, "Timed frames of a turn of the last settings")
      ->capture_default_str()
      ->transform(wholeRange(1, 100000));
  command.add_option("--turns", options->turns, "Turns in which the last settings are timed one by one")
      ->capture_default_str()
      ->transform(wholeRange(1, 1000));
  command
      .add_option("--max-masked-share", options->maskedShare,
                  "Share of pixels that may differ in coverage, instance or depth and are left out")
      ->capture_default_str()
      ->check(realRange(0.0, 1.0));
  command.add_flag("--json", options->json, "Print the answer and the runner-up as JSON");
  command.add_flag("--exhaustive", options->exhaustive, "Measure every setting in full instead of searching");
  command
      .add_option("-o,--out", options->out,
                  "Folder for results.jsonl, index.html, references and the suite tuned.toml; a search that "
                  "is in it already goes on")
      ->required();
  command
      .add_option("--stall-timeout", options->stallTimeout,
                  "Seconds without a frame or a pass of a reference after which a setting is given up; 0: "
                  "never")
      ->capture_default_str()
      ->check(realRange(0.0, 1e6));
  options->backend.addTo(command);
  return [options, term] {
    options->termGiven = term->count() > 0;
    return runTune(*options);
  };
}

}  // namespace limn::app
