#include "core/base/shell.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-./,:=@%+").find(c) != std::string_view::npos;
}

bool isPrintable(char c) {
  return c >= ' ' && c <= '~';
}

}  // namespace

std::string shellQuoted(std::string_view text) {
  if (!text.empty() && std::ranges::all_of(text, isPlain)) return std::string(text);
  std::string word;
  if (std::ranges::all_of(text, isPrintable)) {
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return "'" + word + "'";
  }
  for (const char c : text) {
    if (!isPrintable(c))
      word += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    else
      word += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  }
  return "$'" + word + "'";
}

}  // namespace limn
