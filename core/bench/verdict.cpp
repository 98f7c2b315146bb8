#include "core/bench/private/verdict.h"

#include <algorithm>
#include <stdexcept>

namespace limn::bench {

const VerdictInfo& verdictInfo(Verdict verdict) {
  for (const VerdictInfo& info : kVerdicts)
    if (info.verdict == verdict) return info;
  throw std::logic_error("a verdict without a line in kVerdicts");
}

Verdict judged(double thesis, const Ratio& measured) {
  if (thesis > 1 ? measured.high < 1 : thesis < 1 && measured.low > 1) return Verdict::reversed;
  if (measured.high < thesis) return Verdict::smaller;
  // A claim of equal times names no direction that the interval could leave open.
  const bool open = measured.low <= std::min(thesis, 1.0) && measured.high >= std::max(thesis, 1.0);
  return open && thesis != 1 ? Verdict::undecided : Verdict::holds;
}

Verdict judged(Verdict atSettings, std::optional<Verdict> atEqualError) {
  const bool below = atSettings == Verdict::smaller || atSettings == Verdict::reversed;
  if (below || atSettings == Verdict::notMeasured || !atEqualError) return atSettings;
  if (*atEqualError == Verdict::smaller || *atEqualError == Verdict::reversed)
    return Verdict::notAtEqualError;
  return *atEqualError == Verdict::holds ? atSettings : *atEqualError;
}

}  // namespace limn::bench
