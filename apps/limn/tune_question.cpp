#include "apps/limn/tune_question.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/render/renderer.h"
#include "core/session/technique_choice.h"

namespace limn::app {
namespace {

/// The metric by its key in results. Throws UsageError for another text.
const MetricInfo& findMetric(const std::string& key) {
  std::vector<std::string> known;
  for (const MetricInfo& metric : kQualityMetrics) {
    if (metric.key == key) return metric;
    known.emplace_back(metric.key);
  }
  throw UsageError(
      fmt::format("unknown metric '{}'{}; known are {}", key, didYouMean(key, known), joined(known)));
}

/// The terms of which a technique must answer one to change a picture of `term`.
TermSet answering(Term term) {
  constexpr TermSet light = Term::direct | Term::visibility;
  return term == Term::direct || term == Term::final ? light : termSet(term);
}

/// The technique's name, with its other terms alone where the picture would show light over other surfaces
/// that the reference lacks, since it has no bounces: that light would count as an error.
std::string namedForReference(const TechniquePlugin& plugin, Term term, int bounces) {
  const TermSet terms = plugin.info->terms, others = terms & ~termSet(Term::indirect);
  const bool lacks =
      bounces == 0 && render::bouncesOf(term, {{&plugin, {}, terms}}) > 0 && (others & answering(term)) != 0;
  return render::nameOf({&plugin, {}, lacks ? others : terms});
}

std::vector<const TechniquePlugin*> chosenTechniques(const TechniqueRegistry& registry,
                                                     const TuneArguments& options, Term term) {
  std::vector<const TechniquePlugin*> chosen;
  if (options.techniques.empty()) {
    for (const TechniquePlugin* plugin : registry.all())
      if (plugin->info->terms & answering(term)) chosen.push_back(plugin);
    if (chosen.empty()) throw UsageError(fmt::format("no technique answers {}", name(term)));
    return chosen;
  }
  for (const std::string& name : CLI::detail::split(options.techniques, ',')) {
    const TechniquePlugin& plugin = registry.find(name);
    if (std::ranges::find(chosen, &plugin) != chosen.end())
      throw UsageError(fmt::format("technique {} is named twice; once is enough", plugin.info->name));
    render::checkTechniques({{&plugin, {}}}, term);
    chosen.push_back(&plugin);
  }
  return chosen;
}

/// What --set says of each technique, and the bounces of those that have them.
TuneParameters fixedParameters(const TechniqueInfo& technique, const TuneArguments& options, int bounces) {
  TuneParameters fixed;
  const std::string own = std::string(technique.name) + ".";
  for (const std::string& setting : options.settings)
    if (setting.starts_with(own)) {
      const std::size_t sign = setting.find('=');
      fixed.emplace_back(setting.substr(0, sign), setting.substr(sign + 1));
    }
  const std::string key = own + "bounces";
  if (bounces > 0 && std::ranges::none_of(fixed, [&](const auto& p) { return p.first == key; }))
    for (const Parameter& parameter : technique.parameters)
      if (key == own + parameter.name && parameter.defaultValue != bounces)
        fixed.emplace_back(key, fmt::format("{}", bounces));
  return fixed;
}

/// The last value of each parameter, which counts wherever --set is given.
TuneParameters lastValues(const TuneParameters& parameters) {
  TuneParameters last;
  for (const auto& parameter : parameters) {
    std::erase_if(last, [&](const auto& earlier) { return earlier.first == parameter.first; });
    last.push_back(parameter);
  }
  return last;
}

}  // namespace

bench::TuneLimit TuneGoal::tuneLimit() const {
  if (ofTime) return {.ms = limit};
  return {.error = bench::badness(metric, limit)};
}

std::string TuneGoal::text() const {
  return ofTime ? fmt::format("takes at most {} ms", limit)
                : fmt::format("has a {} of at {} {}", metric.label,
                              metric.kind == MetricKind::likeness ? "least" : "most", limit);
}

TuneGoal tuneGoal(const TuneArguments& options) {
  if (options.maxMs.has_value() == !options.maxError.empty())
    throw UsageError("tune needs a limit: either --max-ms or --max-error");
  if (options.maxMs) return {findMetric(options.metric), *options.maxMs, true};
  const std::size_t sign = options.maxError.find('=');
  const auto value =
      sign == std::string::npos ? std::nullopt : parseNumber(options.maxError.substr(sign + 1));
  if (!value || *value <= 0)
    throw UsageError(
        fmt::format("--max-error '{}' is not accepted; expected METRIC=X with X > 0, such as "
                    "rmse=0.01",
                    options.maxError));
  return {findMetric(options.maxError.substr(0, sign)), *value, false};
}

std::vector<SearchedTechnique> searchedTechniques(const TechniqueRegistry& registry,
                                                  const TuneArguments& options, Term term, int bounces) {
  const std::vector<const TechniquePlugin*> techniques = chosenTechniques(registry, options, term);
  for (const std::string& setting : options.settings) {
    if (setting.find('=') == std::string::npos)
      throw UsageError(
          fmt::format("--set '{}' is not accepted; expected TECHNIQUE.PARAMETER=VALUE", setting));
    if (std::ranges::none_of(techniques, [&](const TechniquePlugin* plugin) {
          return setting.starts_with(std::string(plugin->info->name) + ".");
        }))
      throw UsageError(fmt::format("--set '{}' names none of the techniques that are searched", setting));
  }
  std::vector<SearchedTechnique> spaces;
  for (const TechniquePlugin* plugin : techniques) {
    const TechniqueInfo& info = *plugin->info;
    SearchedTechnique searched{{namedForReference(*plugin, term, bounces), {}},
                               fixedParameters(info, options, bounces)};
    session::choiceOf(info.name, searched.fixed).resolve(registry);  // for its errors
    searched.fixed = lastValues(searched.fixed);
    for (const Parameter& parameter : info.parameters) {
      if (!parameter.tradesErrorForTime) continue;
      bench::TuneAxis axis = bench::tuneAxis(info.name, parameter, options.steps);
      if (std::ranges::none_of(searched.fixed, [&](const auto& p) { return p.first == axis.parameter; }))
        searched.space.axes.push_back(std::move(axis));
    }
    spaces.push_back(std::move(searched));
  }
  return spaces;
}

}  // namespace limn::app
