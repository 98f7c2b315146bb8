// Finds the settings in which the two sides of a ratio differ, so that none of them stays unnamed.
#pragma once

#include <string>

#include "core/base/export.h"
#include "core/bench/row.h"

namespace limn::bench {

/// Returns every setting that both rows have and in which they differ, as "name first / second" with commas
/// between; "none" if there is none. Settings are the question (scene, size, light ...), how and where it was
/// timed, the versions of the program, of the scene's files and of techniques of both rows, and the
/// parameters that both techniques declare under one name, such as shadow_map_size or block: with their
/// defaults where the rows know them, else those that the suite sets ("default" stands for the other side's
/// where both are settings of one technique).
LIMN_API std::string differingSettings(const Row& first, const Row& second);

}  // namespace limn::bench
