// Splits the time of a frame by what its passes are for.
#pragma once

#include "core/bench/row.h"
#include "core/render/frame_stats.h"

namespace limn::bench {

/// Sums the medians of the passes by their roles.
LIMN_API CostSplit costSplit(const render::FrameStats& stats);

}  // namespace limn::bench
