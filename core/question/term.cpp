#include "core/question/term.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/question/question_fields.h"

namespace limn {

const TermInfo& termInfo(Term term) {
  const auto* found = std::ranges::find(kTerms, term, &TermInfo::term);
  if (found == std::end(kTerms)) throw std::logic_error(fmt::format("{} is no term", termSet(term)));
  return *found;
}

const char* name(Term term) {
  return termInfo(term).name;
}

std::vector<std::string> termNames(TermSet terms) {
  std::vector<std::string> names;
  for (const TermInfo& info : kTerms)
    if (contains(terms, info.term)) names.emplace_back(info.name);
  return names;
}

bool hasBackground(std::string_view text) {
  return std::ranges::any_of(kTerms,
                             [&](const TermInfo& info) { return info.background && text == info.name; });
}

Term parseTerm(std::string_view text) {
  for (const TermInfo& info : kTerms)
    if (text == info.name && contains(kPicturedTerms, info.term)) return info.term;
  throw UsageError(unknownChoice(questionField("term"), text));
}

}  // namespace limn
