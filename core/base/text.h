// Declares small helpers for messages and for numbers in untrusted text.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Returns the whole of `text` as a finite number, or nothing if it is not one.
LIMN_API std::optional<double> parseNumber(std::string_view text);

/// Returns the whole of `text` as a whole number in decimal, or nothing if it is not one or `Integer` does
/// not hold it. A sign other than the minus of a negative number, and white space, are not accepted.
template <class Integer>
LIMN_API std::optional<Integer> parseWhole(std::string_view text);
extern template std::optional<int> parseWhole(std::string_view text);
extern template std::optional<std::size_t> parseWhole(std::string_view text);

/// Returns `text` with the capitals of ASCII in lower case: names on other systems may be in capitals.
LIMN_API std::string lowerCase(std::string_view text);

/// Returns `text` as messages show it: one line without trailing white space, line ends and other control
/// characters as '?', and at most `limit` bytes of the text, no part of a character of UTF-8 among them.
LIMN_API std::string oneLine(std::string_view text, size_t limit = 600);

/// Returns the names as a list: "a, b and c".
LIMN_API std::string joined(std::span<const std::string> names, std::string_view last = "and");

/// Returns up to three of the `known` names that are close to `name` in spelling, as " (did you mean a or
/// b?)"; empty if none is close.
LIMN_API std::string didYouMean(std::string_view name, std::span<const std::string> known);

}  // namespace limn
