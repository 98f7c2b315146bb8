// Tells how deep JSON of unknown origin nests, before what reads, copies or writes it calls itself for each
// level.
#pragma once

#include <cstddef>
#include <string_view>

namespace limn {

/// Limits how many objects and lists of a file may be open at once.
inline constexpr int kMaxJsonDepth = 64;

/// Returns whether more than kMaxJsonDepth objects and lists are open anywhere in `text`, which need not be
/// sound JSON. Brackets in strings do not count.
inline bool isTooDeepJson(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

}  // namespace limn
