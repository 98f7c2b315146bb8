// What a renderer is asked for: outputs by name, and which techniques go together.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/render/renderer.h"

namespace limn::render {
namespace {

constexpr std::array<std::pair<Output, std::string_view>, 7> output_names{{{Output::final, "final"},
                                                                           {Output::visibility, "visibility"},
                                                                           {Output::direct, "direct"},
                                                                           {Output::indirect, "indirect"},
                                                                           {Output::caustic, "caustic"},
                                                                           {Output::media, "media"},
                                                                           {Output::specular, "specular"}}};

TermSet termsOf(const TechniqueUse& use) {
  return use.plugin->info->terms;
}

/// The techniques that answer the direct light of this output, whichever way.
bool claimsDirect(const TechniqueUse& use) {
  return contains(termsOf(use), Term::visibility) || contains(termsOf(use), Term::direct);
}

Term termOf(Output output) {
  switch (output) {
    case Output::visibility:
      return Term::visibility;
    case Output::indirect:
      return Term::indirect;
    case Output::caustic:
      return Term::caustic;
    case Output::media:
      return Term::media;
    case Output::specular:
      return Term::specular;
    default:
      return Term::direct;
  }
}

/// Throws UsageError where two techniques claim what only one can answer.
template <class Claims>
void refuseTwo(const std::vector<TechniqueUse>& techniques, std::string_view what, const Claims& claims) {
  const auto first = std::find_if(techniques.begin(), techniques.end(), claims);
  if (first == techniques.end()) return;
  const auto second = std::find_if(first + 1, techniques.end(), claims);
  if (second != techniques.end())
    throw UsageError(fmt::format("techniques {} and {} both answer {}; name one of them",
                                 first->plugin->info->name, second->plugin->info->name, what));
}

}  // namespace

std::string_view name(Output output) {
  for (const auto& [value, text] : output_names)
    if (value == output) return text;
  return {};
}

Output parseOutput(std::string_view text) {
  std::vector<std::string> names;
  for (const auto& [value, known] : output_names) {
    if (text == known) return value;
    names.emplace_back(known);
  }
  throw UsageError(fmt::format("output term '{}' is unknown{}; expected {}", text, didYouMean(text, names),
                               joined(names, "or")));
}

void checkTechniques(const std::vector<TechniqueUse>& techniques, Output output) {
  refuseTwo(techniques, "direct light", claimsDirect);
  for (const auto& [term, what] :
       {std::pair(Term::environment, "the environment's light"), {Term::specular, "specular surfaces"}})
    refuseTwo(techniques, what, [term](const TechniqueUse& use) { return contains(termsOf(use), term); });
  if (output == Output::final || output == Output::direct) return;
  const bool answered = std::any_of(techniques.begin(), techniques.end(), [&](const TechniqueUse& use) {
    return contains(termsOf(use), termOf(output));
  });
  if (!answered)
    throw UsageError(
        fmt::format("no technique given answers the output term {}; limn list says which do", name(output)));
}

int interfacesOf(Output output, const std::vector<TechniqueUse>& techniques) {
  if (output != Output::specular && output != Output::final) return 0;
  for (const TechniqueUse& use : techniques) {
    if (!contains(termsOf(use), Term::specular)) continue;
    const auto declared = use.parameters.declared();
    const bool says = std::ranges::any_of(
        declared, [](const Parameter& p) { return std::string_view(p.name) == "interfaces"; });
    return says ? use.parameters.integer("interfaces") : 2;
  }
  return 0;
}

}  // namespace limn::render
