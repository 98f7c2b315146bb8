// Checks how deep a TOML text nests before a recursive parser reads it.
#pragma once

#include <string>
#include <string_view>

#include "core/base/export.h"

namespace limn::bench {

/// Limits how many tables a file may nest by the dots of one key, and how many brackets may be open at once.
/// Suites need 3; both limits together bound the depth of the parsed tree.
inline constexpr int kMaxTomlNesting = 16;

/// Throws UsageError that names file and line where a key has more dots or more brackets are open than that.
/// Strings and comments do not count.
LIMN_API void checkTomlNesting(std::string_view toml, const std::string& file);

}  // namespace limn::bench
