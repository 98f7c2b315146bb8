// How deep a TOML text nests, before a parser that recurses sees it.
#pragma once

#include <string_view>

#include "core/base/export.h"

namespace limn::bench {

/// How many tables a suite may nest by the dots of one key, and how many brackets may be open at once. What
/// suites need is 3; together they bound the depth of the parsed tree.
inline constexpr int kMaxTomlNesting = 16;

/// The first line, from 1, where a key has more dots or more brackets are open than that; 0 if there is none.
/// Strings and comments do not count.
LIMN_API int tooDeepLine(std::string_view toml);

}  // namespace limn::bench
