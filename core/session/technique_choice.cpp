#include "core/session/technique_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/question/technique_names.h"

namespace limn::session {
namespace {

/// Throws UsageError where the last of the uses is of a technique that is there already.
void refuseTwice(const std::vector<render::TechniqueUse>& uses) {
  const render::TechniqueUse& last = uses.back();
  const auto first = std::ranges::find(uses, last.plugin, &render::TechniqueUse::plugin);
  if (&*first == &last) return;
  render::TechniqueUse both = last;
  both.terms |= first->terms;
  const bool parts = nameOf(*first) != nameOf(last);
  throw UsageError(fmt::format("technique {} is named twice; once is enough{}", last.plugin->info->name,
                               parts ? ": " + nameOf(both) : ""));
}

}  // namespace

TermSet askedFor(const TechniqueInfo& info, std::span<const std::string_view> terms) {
  const std::vector<std::string> answers = termNames(info.terms);
  TermSet asked = 0;
  for (const std::string_view term : terms) {
    if (term.empty())
      throw UsageError(fmt::format("technique '{}:{}' lacks a term; {} answers {}", info.name,
                                   fmt::join(terms, "+"), info.name, joined(answers)));
    const auto known =
        std::ranges::find_if(kTerms, [&](const TermInfo& candidate) { return term == candidate.name; });
    if (known == std::end(kTerms))
      throw UsageError(fmt::format("unknown term '{}' of technique {}{}; it answers {}", term, info.name,
                                   didYouMean(term, answers), joined(answers)));
    if (!contains(info.terms, known->term))
      throw UsageError(
          fmt::format("technique {} does not answer {}; it answers {}", info.name, term, joined(answers)));
    if (contains(asked, known->term))
      throw UsageError(
          fmt::format("term {} of technique {} is named twice; once is enough", term, info.name));
    asked = asked | known->term;
  }
  return asked;
}

std::vector<render::TechniqueUse> TechniqueChoice::resolve(const TechniqueRegistry& registry) const {
  std::vector<render::TechniqueUse> uses;
  for (const NamedTechnique& named : namedTechniques(techniques)) {
    const TechniquePlugin& plugin = registry.find(named.name);
    uses.push_back({&plugin, ParameterValues(std::string(named.name), plugin.info->parameters)});
    if (named.terms) uses.back().terms = askedFor(*plugin.info, *named.terms);
    refuseTwice(uses);
  }
  for (const std::string& setting : settings) {
    const size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || equals < dot)
      throw UsageError(
          fmt::format("--set '{}' is not accepted; expected TECHNIQUE.PARAMETER=VALUE", setting));
    const std::string technique = setting.substr(0, dot);
    bool found = false;
    for (auto& use : uses) {
      if (technique != use.plugin->info->name) continue;
      use.parameters.set(setting.substr(dot + 1, equals - dot - 1), setting.substr(equals + 1));
      found = true;
    }
    if (!found)
      throw UsageError(
          fmt::format("--set '{}' names technique {}, which --technique does not", setting, technique));
  }
  return uses;
}

TechniqueChoice choiceOf(const std::string& techniques,
                         std::span<const std::pair<std::string, std::string>> parameters) {
  TechniqueChoice choice{techniques, {}};
  for (const auto& [name, value] : parameters) choice.settings.push_back(fmt::format("{}={}", name, value));
  return choice;
}

void checkMeasurable(std::span<const render::TechniqueUse> uses) {
  for (const render::TechniqueUse& use : uses) {
    const char* name = use.plugin->info->name;
    const auto values = use.parameters.printed();
    const auto defaults = ParameterValues(name, use.parameters.declared()).printed();
    for (size_t i = 0; i < values.size(); ++i) {
      if (!use.parameters.declared()[i].followsClock || values[i] == defaults[i]) continue;
      throw UsageError(
          fmt::format("{}.{}={}: pictures would follow how long frames take, so that a row's error and its "
                      "time are of different ones; benches accept {} alone",
                      name, values[i].first, values[i].second, defaults[i].second));
    }
  }
}

}  // namespace limn::session
