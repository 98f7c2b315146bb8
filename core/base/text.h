// Small helpers for messages and for numbers from untrusted text.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// The whole of `text` as a finite number, or nothing.
LIMN_API std::optional<double> parseNumber(std::string_view text);

/// `text` as messages show it: one line without white space at its end, other line ends as ' ', control
/// characters as '?', and no more than `limit` bytes of it.
LIMN_API std::string oneLine(std::string_view text, size_t limit = 600);

/// "a, b and c".
LIMN_API std::string joined(std::span<const std::string> names, std::string_view last = "and");

/// Up to three of `known` that are close to `name` in spelling, as " (did you mean a or b?)"; empty if none
/// is close.
LIMN_API std::string didYouMean(std::string_view name, std::span<const std::string> known);

}  // namespace limn
