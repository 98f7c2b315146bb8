// The names of terms, and what there is to ask of them.
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/reference/reference.h"

namespace limn::reference {

bool hasBounces(Term term) {
  return term == Term::indirect || hasInterfaces(term);
}

bool hasInterfaces(Term term) {
  return term == Term::specular || term == Term::final;
}

const char* name(Term term) {
  switch (term) {
    case Term::direct:
      return "direct";
    case Term::visibility:
      return "visibility";
    case Term::final:
      return "final";
    case Term::indirect:
      return "indirect";
    case Term::caustic:
      return "caustic";
    case Term::media:
      return "media";
    case Term::specular:
      return "specular";
  }
  return "";
}

Term termFromName(const std::string& text) {
  for (const Term term : {Term::direct, Term::visibility, Term::final, Term::indirect, Term::caustic,
                          Term::media, Term::specular})
    if (text == name(term)) return term;
  throw UsageError(fmt::format(
      "reference: unknown term '{}'; there are direct, visibility, final, indirect, caustic, media, specular",
      text));
}

}  // namespace limn::reference
