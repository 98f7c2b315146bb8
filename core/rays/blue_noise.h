// Declares thresholds whose neighbours differ as much as can be: what shifts the rays of a pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/export.h"

namespace limn::rays {

/// Returns side x side thresholds, each (rank + 1/2) / side^2 for one of the ranks 0 to side^2 - 1, that
/// repeat without a seam and whose every upper part is spread evenly: void and cluster (Ulichney 1993).
/// `side` is 4 to 128; the time grows with its fourth power (64: some 20 ms).
LIMN_API std::vector<float> blueNoise(int side, uint32_t seed);

}  // namespace limn::rays
