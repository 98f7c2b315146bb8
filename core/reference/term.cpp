// What there is to ask of a term's reference, as the table of terms has it.
#include "core/reference/reference.h"

namespace limn::reference {

bool hasBounces(Term term) {
  return termInfo(term).bounces != TermBounces::none;
}

bool acceptsInterfaces(Term term, int interfaces) {
  const TermInterfaces taken = termInfo(term).interfaces;
  if (interfaces == kAllInterfaces) return taken != TermInterfaces::none;
  if (interfaces == 0) return taken != TermInterfaces::fromOne;
  const bool some = taken == TermInterfaces::fromZero || taken == TermInterfaces::fromOne;
  return some && interfaces > 0 && interfaces <= kMaxInterfaces;
}

int defaultBounces(Term term) {
  return termInfo(term).bounces == TermBounces::fromOne ? 1 : 0;
}

int defaultInterfaces(Term term) {
  return termInfo(term).interfaces == TermInterfaces::fromOne ? kImageSpaceInterfaces : 0;
}

}  // namespace limn::reference
