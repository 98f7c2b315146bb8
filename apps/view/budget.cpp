#include "apps/view/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/shell.h"
#include "core/bench/tables.h"
#include "core/bench/tune.h"
#include "core/question/question_fields.h"
#include "core/question/render_command.h"
#include "core/question/technique_names.h"

namespace limn::app {
namespace {

std::string sceneName(const std::string& scene) {
  return std::filesystem::path(scene).stem().string();
}

/// What tells the tables of one scene apart, but for its renderer and machine.
std::string measuredText(bench::Case c) {
  c.technique.clear();
  c.parameters.clear();
  std::string text = bench::label(c);
  text.pop_back();  // what divides it from the technique
  return text + ", " + bench::referenceText(c);
}

}  // namespace

bool sameScene(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  if (sceneName(a) != sceneName(b)) return false;
  std::error_code unknown;
  const bool files = fs::is_regular_file(a, unknown) && fs::is_regular_file(b, unknown);
  return !files || fs::equivalent(a, b, unknown);
}

std::string MeasuredSetting::text() const {
  std::string line = technique.empty() ? "unshadowed" : technique;
  for (const auto& [name, value] : parameters)
    line += fmt::format("  {}={}", shortParameter(technique, name), value);
  return outdated ? line + "  (by another version)" : line;
}

std::vector<MeasuredQuestion> measuredQuestions(std::span<const bench::Row> rows, const std::string& scene) {
  std::map<std::string, std::vector<bench::Row>> own;  // lights of the environment are settings in tables
  for (const bench::Row& row : rows) {
    if (row.what.technique == bench::kSeparationFloor) continue;  // no technique can be as good
    if (row.failure.empty() && row.cost.frameMs.n > 0 && sameScene(row.what.scene, scene))
      own[describeEnvironmentLights(row.what)].push_back(row);
  }
  std::vector<MeasuredQuestion> questions;
  for (const auto& [lights, some] : own)
    for (const bench::Table& table : bench::makeTables(some)) {
      const bench::Row& first = table.rows.front();
      MeasuredQuestion& question = questions.emplace_back(
          MeasuredQuestion{.question = first.what,
                           .term = parseTerm(first.what.term),
                           .text = measuredText(first.what),
                           .renderer = first.cost.renderer,
                           .pixels = std::int64_t{first.what.width} * first.what.height,
                           .settings = {}});
      for (const bench::Row& row : table.rows)
        question.settings.push_back({row.what.technique, row.what.parameters, row.error,
                                     row.cost.frameMs.median, bench::isOutdated(row, table)});
    }
  std::ranges::stable_sort(questions, [](const MeasuredQuestion& a, const MeasuredQuestion& b) {
    return std::pair(a.pixels, a.settings.size()) > std::pair(b.pixels, b.settings.size());
  });
  return questions;
}

BudgetAnswer bestWithin(const MeasuredQuestion& question, double ms, const MetricInfo& metric) {
  const auto badness = [&](const MeasuredSetting& setting) {
    return bench::badness(metric, setting.error).value();
  };
  std::vector<const MeasuredSetting*> quick;
  for (const MeasuredSetting& setting : question.settings)
    if (setting.ms <= ms) quick.push_back(&setting);
  std::ranges::stable_sort(quick, [&](const MeasuredSetting* a, const MeasuredSetting* b) {
    return std::tuple(a->outdated, badness(*a), a->ms) < std::tuple(b->outdated, badness(*b), b->ms);
  });
  if (quick.empty()) return {};
  BudgetAnswer answer{*quick.front(), {}};
  const auto other = std::ranges::find_if(
      quick, [&](const MeasuredSetting* setting) { return setting->technique != quick.front()->technique; });
  if (other != quick.end())
    answer.runnerUp = **other;
  else if (quick.size() > 1)
    answer.runnerUp = *quick[1];
  return answer;
}

SceneQuestion TuneOrder::questionOf(const SceneQuestion& shown) {
  SceneQuestion question = shown;
  if (question.term == name(Term::final))
    question.term = name(question.light.empty() ? Term::direct : Term::visibility);
  return question;
}

std::vector<std::string> tuneArguments(const TuneOrder& order) {
  SceneQuestion rest = order.question;
  rest.term = SceneQuestion().term;  // tune has a flag of its own for it
  std::vector<std::string> words{"tune", rest.scene};
  const auto add = [&](const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  add(questionFlags(rest));
  add({"--term", order.question.term});
  if (!order.techniques.empty()) add({"--techniques", order.techniques});
  const TuneOrder usual;
  if (order.metric != usual.metric) add({"--metric", std::string(order.metric->key)});
  if (order.maskedShare != usual.maskedShare)
    add({"--max-masked-share", fmt::format("{:.4g}", order.maskedShare)});
  if (order.device >= 0) add({"--device", fmt::format("{}", order.device)});
  add({"--steps", fmt::format("{}", order.steps), "--max-ms", fmt::format("{:.4g}", order.ms), "--out",
       order.folder});
  return words;
}

std::string tuneCommand(const TuneOrder& order) {
  std::string command = "limn";
  for (const std::string& word : tuneArguments(order)) command += " " + shellQuoted(word);
  return command;
}

std::size_t placeOf(const SceneQuestion& question, std::span<const MeasuredQuestion> measured) {
  const auto same = [&](const MeasuredQuestion& other) {
    SceneQuestion of = other.question;
    of.scene = question.scene;  // sameScene() has been asked
    return of == question;
  };
  const auto found = std::ranges::find_if(measured, same);
  return found == measured.end() ? 0 : static_cast<std::size_t>(found - measured.begin());
}

}  // namespace limn::app
