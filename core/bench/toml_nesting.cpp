#include "core/bench/private/toml_nesting.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn::bench {
namespace {

/// The position behind the string that begins at `at`; the end of the text if it has no end.
std::size_t afterString(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool lines = text.substr(at, 3) == std::string_view(quote == '"' ? "\"\"\"" : "'''");
  const std::size_t marks = lines ? 3 : 1;
  for (at += marks; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"')
      ++at;
    else if (text[at] == '\n' && !lines)
      return at;  // the parser will refuse it
    else if (text.substr(at, marks) == std::string(marks, quote))
      break;
  }
  at = std::min(at + marks, text.size());
  // A text of several lines may end in two quotes of its own, before its mark.
  for (int own = 0; lines && own < 2 && at < text.size() && text[at] == quote; ++own) ++at;
  return at;
}

/// The first line that is too deep, counted from 1; 0 if there is none.
int tooDeepLine(std::string_view toml) {
  int dots = 0, brackets = 0, line = 1;
  for (std::size_t at = 0; at < toml.size();) {
    const char c = toml[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = afterString(toml, at);
      line += static_cast<int>(std::count(toml.begin() + static_cast<std::ptrdiff_t>(at),
                                          toml.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      at = end;
      continue;
    }
    if (c == '#') {
      at = std::min(toml.find('\n', at), toml.size());
      continue;
    }
    if (c == '.') ++dots;
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    if (dots > kMaxTomlNesting || brackets > kMaxTomlNesting) return line;
    if (c == '=' || c == ',' || c == '\n' || c == '[' || c == '{') dots = 0;
    if (c == '\n') ++line;
    ++at;
  }
  return 0;
}

}  // namespace

void checkTomlNesting(std::string_view toml, const std::string& file) {
  if (const int line = tooDeepLine(toml))
    throw UsageError(
        oneLine(fmt::format("{}:{}: nested deeper than {} levels", file, line, kMaxTomlNesting)));
}

}  // namespace limn::bench
