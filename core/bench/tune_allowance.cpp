#include "core/bench/private/tune_allowance.h"

#include <algorithm>

namespace limn::bench {
namespace {

// Tuned like the constants of tune_search.cpp.
constexpr double kShare = 0.15;          // of the exhaustive grid's cost that a search may take
constexpr double kMostCounted = 1000;    // settings of the grid: beyond, more looks find no better answers
constexpr double kMeasuredShare = 0.06;  // of the settings that are measured in full
constexpr double kCheckedShare = 0.55;   // of what is left for checks and looks
constexpr double kCheapCheck = 1.0 / 3;  // of a full measurement's cost: dearer checks save nothing
constexpr double kOnceFrames = 2;    // frames that take as long as what each setting costs once: its shaders
constexpr double kFixedShare = 0.5;  // of a frame that does not grow with the pixels: its maps

/// What a measurement costs, in frames of the full size: one is compared, then come the turns, of which the
/// first has its frames twice, as a whole and by passes.
double costOf(const TuneEffort& effort) {
  const double frames =
      1.0 + effort.warmup + 2 * effort.frames + (effort.turns - 1) * (effort.warmup + effort.frames);
  return kOnceFrames + frames * (kFixedShare + (1 - kFixedShare) / (effort.divisor * effort.divisor));
}

/// Settings that differ from the defaults on one axis at most: with less than that, nothing is known of a
/// space.
std::size_t starCount(const TuneSpace& space) {
  std::size_t count = 1;
  for (const TuneAxis& axis : space.axes) count += axis.values.size() - 1;
  return count;
}

}  // namespace

TuneAllowance allowanceOf(std::span<const TuneSpace> spaces, const TunePlan& plan) {
  double settings = 0;
  std::size_t star = 0;
  for (const TuneSpace& space : spaces) {
    settings += static_cast<double>(settingCount(space));
    star += starCount(space);
  }
  // Grids grow with the power of their parameters, what a search has to know of them with their number.
  settings = std::min(settings, kMostCounted);
  const double look = costOf(plan.look), check = costOf(plan.check), full = costOf(plan.full);
  const auto whole = [](double count) { return static_cast<std::size_t>(std::clamp(count, 0.0, 1e9)); };
  TuneAllowance allowance;
  allowance.measured = std::max(kLeastMeasured, whole(kMeasuredShare * settings));
  double left = kShare * settings * full - static_cast<double>(allowance.measured) * full;
  if (plan.look.divisor > 1) left -= costOf(scaleOf(plan));
  if (check < kCheapCheck * full) {
    allowance.checks = std::max(kLeastChecked, whole(kCheckedShare * left / check));
    left *= 1 - kCheckedShare;
  }
  allowance.looks = std::max(star, whole(left / look));
  return allowance;
}

}  // namespace limn::bench
