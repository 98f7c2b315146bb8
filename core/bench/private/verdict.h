// Judges what is measured of a claim by rules on intervals, so that no wording of a person can flatter.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/export.h"
#include "core/bench/ratio.h"

namespace limn::bench {

enum class Verdict : std::uint8_t {
  holds,
  undecided,
  notAtEqualError,
  smaller,
  reversed,
  notMeasured,
  notReproduced
};

struct VerdictInfo {
  Verdict verdict;
  const char* name;
  const char* rule;  ///< continues "name: "
};

/// In the order of weight: where the rules of several apply, the later one counts.
inline constexpr VerdictInfo kVerdicts[] = {
    {Verdict::holds, "holds",
     "the interval reaches the thesis's ratio or lies above it, at the settings and at equal error, where "
     "there is one"},
    {Verdict::undecided, "undecided",
     "the interval holds both 1 and the thesis's ratio, at the settings or at equal error: the times scatter "
     "too much to tell"},
    {Verdict::notAtEqualError, "not at equal error",
     "the ratio holds or is undecided at the settings, but at equal error the whole interval lies below the "
     "thesis's ratio or on the side of 1 where that does not"},
    {Verdict::smaller, "smaller", "at the settings the whole interval lies below the thesis's ratio"},
    {Verdict::reversed, "reversed",
     "at the settings the whole interval lies on the side of 1 where the thesis's ratio does not, for better "
     "or worse"},
    {Verdict::notMeasured, "not measured",
     "a row is missing, failed or has no time, or a ratio without which there is no verdict is refused for n "
     "= "
     "1"},
    {Verdict::notReproduced, "not reproduced", "limn does not compare it, for the reason that is given"},
};

/// Returns the line of the table for a verdict.
LIMN_API const VerdictInfo& verdictInfo(Verdict verdict);

/// Returns what an interval says of the thesis's ratio: holds, smaller, reversed or undecided.
LIMN_API Verdict judged(double thesis, const Ratio& measured);

/// Returns the verdict on a claim from that at the settings and that at equal error, where there is one:
/// equal error can only weaken it.
LIMN_API Verdict judged(Verdict atSettings, std::optional<Verdict> atEqualError);

}  // namespace limn::bench
