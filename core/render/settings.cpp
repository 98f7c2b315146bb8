// What a renderer is asked for: outputs by name, and which techniques go together.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/render/renderer.h"

namespace limn::render {
namespace {

constexpr std::array<std::pair<Output, std::string_view>, 6> output_names{{{Output::final, "final"},
                                                                           {Output::visibility, "visibility"},
                                                                           {Output::direct, "direct"},
                                                                           {Output::indirect, "indirect"},
                                                                           {Output::caustic, "caustic"},
                                                                           {Output::media, "media"}}};

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
    default:
      return Term::direct;
  }
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
  const TechniqueUse* first = nullptr;
  for (const TechniqueUse& use : techniques) {
    if (!claimsDirect(use)) continue;
    if (first)
      throw UsageError(fmt::format("techniques {} and {} both answer direct light; name one of them",
                                   first->plugin->info->name, use.plugin->info->name));
    first = &use;
  }
  first = nullptr;
  for (const TechniqueUse& use : techniques) {
    if (!contains(termsOf(use), Term::environment)) continue;
    if (first)
      throw UsageError(
          fmt::format("techniques {} and {} both answer the environment's light; name one of them",
                      first->plugin->info->name, use.plugin->info->name));
    first = &use;
  }
  if (output == Output::final || output == Output::direct) return;
  const bool answered = std::any_of(techniques.begin(), techniques.end(), [&](const TechniqueUse& use) {
    return contains(termsOf(use), termOf(output));
  });
  if (!answered)
    throw UsageError(
        fmt::format("no technique given answers the output term {}; limn list says which do", name(output)));
}

}  // namespace limn::render
