#include "apps/view/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>

#include "core/question/question_fields.h"
#include "core/question/render_command.h"
#include "core/question/technique_names.h"

namespace limn::app {
namespace {

std::string sceneName(const std::string& scene) {
  return std::filesystem::path(scene).stem().string();
}

}  // namespace

std::string MeasuredSetting::text() const {
  std::string line = technique.empty() ? "unshadowed" : technique;
  for (const auto& [name, value] : parameters)
    line += fmt::format("  {}={}", shortParameter(technique, name), value);
  return line;
}

std::vector<MeasuredQuestion> measuredQuestions(std::span<const bench::Row> rows, const std::string& scene) {
  std::vector<MeasuredQuestion> questions;
  std::map<std::string, std::size_t> places;
  for (const bench::Row& row : rows) {
    if (row.what.technique == bench::kSeparationFloor) continue;  // no technique can be as good
    if (!row.failure.empty() || row.cost.frameMs.n == 0 || sceneName(row.what.scene) != sceneName(scene))
      continue;
    const SceneQuestion& question = row.what;
    const glm::ivec2 timed(row.what.timeWidth, row.what.timeHeight);
    const std::string times = timed.x > 0 ? fmt::format(", times at {}x{}", timed.x, timed.y) : "";
    const std::string key =
        fmt::format("{}{}|{}|{}", questionText(question), times, row.cost.renderer, row.cost.machine);
    const auto [place, added] = places.emplace(key, questions.size());
    if (added)
      questions.push_back({.text = subjectText(question, QuestionWording::label) + times,
                           .renderer = row.cost.renderer,
                           .pixels = std::int64_t{question.width} * question.height,
                           .settings = {}});
    questions[place->second].settings.push_back(
        {row.what.technique, row.what.parameters, row.error.rmse, row.cost.frameMs.median});
  }
  std::ranges::stable_sort(questions, [](const MeasuredQuestion& a, const MeasuredQuestion& b) {
    return std::pair(a.pixels, a.settings.size()) > std::pair(b.pixels, b.settings.size());
  });
  return questions;
}

BudgetAnswer bestWithin(const MeasuredQuestion& question, double ms) {
  std::vector<const MeasuredSetting*> quick;
  for (const MeasuredSetting& setting : question.settings)
    if (setting.ms <= ms) quick.push_back(&setting);
  std::ranges::stable_sort(quick, [](const MeasuredSetting* a, const MeasuredSetting* b) {
    return std::pair(a->rmse, a->ms) < std::pair(b->rmse, b->ms);
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

std::string tuneCommand(const SceneQuestion& question, double ms, const std::string& folder) {
  SceneQuestion asked = question;
  asked.term = SceneQuestion().term;
  std::string command = renderCommand(asked, "", {});
  const std::string render = "limn render";
  command.replace(0, render.size(), "limn tune");
  if (question.term != asked.term) command += commandOption("--term", question.term);
  return command + fmt::format(" --max-ms {:.3g}", ms) + commandOption("--out", folder);
}

}  // namespace limn::app
