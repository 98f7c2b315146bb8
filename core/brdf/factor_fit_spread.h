// Declares how texels that nothing is known of get a value.
#pragma once

#include <vector>

#include "core/brdf/factor_tables.h"

namespace limn::brdf {

/// Gives each texel that is not `known` the mean of its neighbours along the first `axes` axes (2: within
/// its layer) that have a value, and so on outwards from the known ones. `known` has an entry for each texel,
/// and becomes 1 where this gives a value; texels that no known one leads to stay as they are.
void spread(FactorTable& table, std::vector<char>& known, int axes);

}  // namespace limn::brdf
