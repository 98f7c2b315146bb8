// Declares how many settings a search may measure, from what the grid of all settings would cost.
#pragma once

#include <cstddef>
#include <span>

#include "core/bench/tune.h"

namespace limn::bench {

constexpr std::size_t kLeastChecked = 6, kLeastMeasured = 3;

/// Holds how many settings a search may measure with each effort, each as dear as the mean of all.
struct TuneAllowance {
  std::size_t looks = 0, checks = 0, measured = 0;
};

/// Returns what a search within a share of the grid's cost may measure; never less than what it needs to know
/// anything, and of a grid of more than 1000 settings as much as of 1000.
TuneAllowance allowanceOf(std::span<const TuneSpace> spaces, const TunePlan& plan);

}  // namespace limn::bench
