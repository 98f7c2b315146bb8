// Checks how deep a TOML text nests before a recursive parser reads it.
#pragma once

#include <string_view>

#include "core/base/export.h"

namespace limn::bench {

/// Limits how many tables a suite may nest by the dots of one key, and how many brackets may be open at once.
/// Suites need 3; both limits together bound the depth of the parsed tree.
inline constexpr int kMaxTomlNesting = 16;

/// Returns the first line, counted from 1, where a key has more dots or more brackets are open than that; 0
/// if there is none. Strings and comments do not count.
LIMN_API int tooDeepLine(std::string_view toml);

}  // namespace limn::bench
