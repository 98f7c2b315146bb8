#include "core/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace limn {
namespace {

size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// Returns how many of the first `limit` bytes of `text` are whole characters of UTF-8. Bytes that are not
/// UTF-8 count as characters.
size_t wholeCharacters(std::string_view text, size_t limit) {
  constexpr size_t longest = 4;  // bytes of a character
  const auto continues = [&](size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; };
  size_t end = limit;
  while (limit < text.size() && end > 0 && limit - end < longest && continues(end)) --end;
  return limit - end < longest ? end : limit;
}

}  // namespace

std::optional<double> parseNumber(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <class Integer>
std::optional<Integer> parseWhole(std::string_view text) {
  Integer value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}
template std::optional<int> parseWhole(std::string_view text);
template std::optional<std::size_t> parseWhole(std::string_view text);

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string oneLine(std::string_view text, size_t limit) {
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);  // npos + 1 is 0
  const std::string_view shown = text.substr(0, wholeCharacters(text, limit));
  std::string line;
  for (size_t i = 0; i < shown.size(); ++i) {
    const auto byte = [&](size_t at) { return static_cast<unsigned char>(shown[at]); };
    // U+0080 to U+009F, which terminals obey as well.
    const bool pair = byte(i) == 0xc2 && i + 1 < shown.size() && byte(i + 1) >= 0x80 && byte(i + 1) < 0xa0;
    line += byte(i) < 32 || byte(i) == 127 || pair ? '?' : shown[i];
    i += pair ? 1 : 0;
  }
  return text.size() > limit ? line + "..." : line;
}

std::string joined(std::span<const std::string> names, std::string_view last) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " " + std::string(last) + " " : ", ";
    text += names[i];
  }
  return text;
}

std::string didYouMean(std::string_view name, std::span<const std::string> known) {
  constexpr size_t longest_name = 200;  // beyond this nobody mistyped
  if (name.size() > longest_name) return {};
  std::vector<std::pair<size_t, std::string>> close;
  for (const std::string& candidate : known) {
    const size_t distance = editDistance(name, candidate);
    const bool contained = name.size() >= 3 && candidate.find(name) != std::string::npos;
    if (distance <= 2 + candidate.size() / 5 || contained) close.emplace_back(distance, candidate);
  }
  std::stable_sort(close.begin(), close.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (close.size() > 3) close.resize(3);
  std::vector<std::string> names;
  for (auto& [distance, candidate] : close) names.push_back(std::move(candidate));
  return names.empty() ? std::string() : " (did you mean " + joined(names, "or") + "?)";
}

}  // namespace limn
