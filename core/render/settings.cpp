// What a renderer is asked for: which techniques go together, and which terms they can show.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/render/renderer.h"

namespace limn::render {
namespace {

/// Returns ", or ..." that names the terms for which one of two techniques can stand beside the other;
/// nothing where they share all of theirs.
std::string orOtherTerms(const TechniqueUse& first, const TechniqueUse& second) {
  for (const auto& [one, other] : {std::pair(&second, &first), std::pair(&first, &second)}) {
    TechniqueUse rest = *one;
    rest.terms = termsOf(*one) & ~refusedBeside(termsOf(*other));
    if (rest.terms != 0) return fmt::format(", or {}", nameOf(rest));
  }
  return {};
}

/// Throws UsageError where two techniques answer any of the terms, which `what` sums up.
void refuseTwo(const std::vector<TechniqueUse>& techniques, TermSet terms, const char* what) {
  const auto claims = [&](const TechniqueUse& use) { return (termsOf(use) & terms) != 0; };
  const auto first = std::ranges::find_if(techniques, claims);
  if (first == techniques.end()) return;
  const auto second = std::find_if(first + 1, techniques.end(), claims);
  if (second != techniques.end())
    throw UsageError(fmt::format("techniques {} and {} both answer {}; name one of them{}",
                                 first->plugin->info->name, second->plugin->info->name, what,
                                 orOtherTerms(*first, *second)));
}

/// Throws UsageError where one technique answers relief and another direct light.
void refuseReliefBesideDirect(const std::vector<TechniqueUse>& techniques) {
  for (const TechniqueUse& bumps : techniques)
    for (const TechniqueUse& other : techniques)
      if (&bumps != &other && contains(termsOf(bumps), Term::relief) &&
          contains(termsOf(other), Term::direct))
        throw UsageError(fmt::format(
            "technique {} answers relief, for which the direct light of {} has no place; name one of them{}",
            bumps.plugin->info->name, other.plugin->info->name, orOtherTerms(bumps, other)));
}

/// Throws the UsageError of a picture of `term`, which no technique answers.
[[noreturn]] void refuseUnanswered(const std::vector<TechniqueUse>& techniques, Term term) {
  for (const TechniqueUse& use : techniques)
    if (contains(use.plugin->info->terms, term))
      throw UsageError(fmt::format("technique {} is not asked for {}, which it answers, too", nameOf(use),
                                   limn::name(term)));
  throw UsageError(
      fmt::format("no technique given answers the term {}; limn list says which do", limn::name(term)));
}

/// Returns the terms that techniques are asked for in a picture of `term`.
TermSet termsAsked(Term term) {
  if (term == Term::final || term == Term::specular) return kAnswerableTerms;
  TermSet terms = termSet(term);
  if (term == Term::subsurface) terms = terms | Term::direct | Term::indirect;
  if (contains(terms, Term::direct)) terms = terms | Term::visibility | Term::relief | Term::environment;
  return terms;
}

/// Returns the parameter of that name, or `otherwise` for techniques that have none.
int parameterOr(const TechniqueUse& use, std::string_view parameter, int otherwise) {
  return use.parameters.has(parameter) ? use.parameters.integer(parameter) : otherwise;
}

}  // namespace

TermSet termsOf(const TechniqueUse& use) {
  return use.plugin->info->terms & use.terms;
}

std::string nameOf(const TechniqueUse& use) {
  const TechniqueInfo& info = *use.plugin->info;
  if (termsOf(use) == info.terms) return info.name;
  return fmt::format("{}:{}", info.name, fmt::join(termNames(termsOf(use)), "+"));
}

std::string namesOf(const std::vector<TechniqueUse>& uses, std::string_view separator) {
  std::string names;
  for (const TechniqueUse& use : uses) names += (names.empty() ? "" : std::string(separator)) + nameOf(use);
  return names;
}

void checkTechniques(const std::vector<TechniqueUse>& techniques, Term term) {
  for (const TermInfo& info : kTerms)
    if (info.exclusive) refuseTwo(techniques, exclusiveWith(termSet(info.term)), info.exclusive);
  refuseReliefBesideDirect(techniques);
  const auto answers = [&](const TechniqueUse& use) { return contains(termsOf(use), term); };
  switch (termInfo(term).picture) {
    case TermPicture::none:
      throw UsageError(fmt::format("no picture shows the term {} alone", name(term)));
    case TermPicture::answered:
      if (std::ranges::none_of(techniques, answers)) refuseUnanswered(techniques, term);
      break;
    case TermPicture::always:
      break;
  }
}

int bouncesOf(Term term, const std::vector<TechniqueUse>& techniques) {
  const TermBounces taken = termInfo(term).bounces;
  if (taken == TermBounces::none) return 0;
  int bounces = taken == TermBounces::fromOne ? 1 : 0;
  for (const TechniqueUse& use : techniques)
    if (contains(termsOf(use), Term::indirect)) bounces = std::max(bounces, parameterOr(use, "bounces", 1));
  return bounces;
}

int historyOf(Term term, const std::vector<TechniqueUse>& techniques) {
  const TermSet asked = termsAsked(term);
  int frames = 1;
  for (const TechniqueUse& use : techniques)
    if ((termsOf(use) & asked) != 0) frames = std::max(frames, parameterOr(use, "history", 1));
  return frames;
}

int interfacesOf(Term term, const std::vector<TechniqueUse>& techniques) {
  const TermInterfaces taken = termInfo(term).interfaces;
  if (taken != TermInterfaces::fromZero && taken != TermInterfaces::fromOne) return 0;
  for (const TechniqueUse& use : techniques) {
    if (!contains(termsOf(use), Term::specular)) continue;
    return parameterOr(use, "interfaces", 2);
  }
  return 0;
}

}  // namespace limn::render
