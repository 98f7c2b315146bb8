#include "core/bench/private/markdown.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

namespace limn::bench {
namespace {

bool isAlphanumeric(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Bytes of the UTF-8 sequence at the beginning of `text`, 0 where there is none (RFC 3629).
std::size_t sequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xc2 && lead < 0xe0 ? 2
                             : lead >= 0xe0 && lead < 0xf0 ? 3
                             : lead >= 0xf0 && lead < 0xf5 ? 4
                                                           : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  if (length < 3) return length;
  const unsigned char second = byte(1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool beyond = (lead == 0xed && second >= 0xa0) || (lead == 0xf4 && second >= 0x90);
  return overlong || beyond ? 0 : length;
}

std::string utf8OfThree(unsigned code) {
  return {static_cast<char>(0xe0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3f)),
          static_cast<char>(0x80 | (code & 0x3f))};
}

/// Whether the character between two others (0: an end) would be more than itself. What is harmless between
/// letters, as the underscores of a parameter's name, or beside a number, stays readable.
bool isMarkup(char before, char c, char after) {
  const auto isSpace = [](char other) { return other == 0 || other == ' '; };
  switch (c) {
    case '\\':
    case '`':
    case '|':
    case '[':
    case ']':
    case '~':
    case '$':
      return true;
    case '*':
      return !isSpace(before) || !isSpace(after);
    case '_':
      return !isAlphanumeric(before) || !isAlphanumeric(after);
    case '#':  // the end of a heading
      return !isAlphanumeric(before);
    case ':':  // https://
      return after == '/';
    case '.':  // www.
      return before == 'w' || before == 'W';
    default:
      return false;
  }
}

/// What HTML would read: a tag or an entity. A number may be smaller than another.
const char* entity(char c, char after) {
  if (c == '<') return after >= '0' && after <= '9' ? nullptr : "&lt;";
  if (c == '>') return "&gt;";
  return c == '&' ? "&amp;" : nullptr;
}

/// A byte of ASCII that is no control character.
std::string printable(char before, char c, char after) {
  if (const char* name = entity(c, after)) return name;
  return isMarkup(before, c, after) ? std::string("\\") + c : std::string(1, c);
}

}  // namespace

std::string markdownText(std::string_view text) {
  constexpr unsigned kPictures = 0x2400, kPictureOfDelete = 0x2421, kReplacement = 0xfffd;
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const auto code = static_cast<unsigned char>(text[i]);
    const std::size_t length = sequenceLength(text.substr(i));
    if (length == 0) {
      result += utf8OfThree(kReplacement);
    } else if (length > 1) {
      result += text.substr(i, length);
    } else if (code == '\n' || code == '\r' || code == '\t') {
      result += ' ';
    } else if (code < 0x20 || code == 0x7f) {
      result += utf8OfThree(code == 0x7f ? kPictureOfDelete : kPictures + code);
    } else {
      result += printable(i > 0 ? text[i - 1] : '\0', text[i], i + 1 < text.size() ? text[i + 1] : '\0');
    }
    i += std::max<std::size_t>(length, 1);
  }
  return result;
}

std::string textOfMarkdown(std::string_view markdown) {
  constexpr std::pair<std::string_view, char> kEntities[] = {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}};
  std::string text;
  while (!markdown.empty()) {
    const auto* found = std::ranges::find_if(
        kEntities, [&](const auto& entity) { return markdown.starts_with(entity.first); });
    const bool isEntity = found != std::end(kEntities);
    if (!isEntity && markdown.front() == '\\' && markdown.size() > 1) markdown.remove_prefix(1);
    text += isEntity ? found->second : markdown.front();
    markdown.remove_prefix(isEntity ? found->first.size() : 1);
  }
  return text;
}

std::string markdownHead(const std::vector<MarkdownHead>& heads) {
  std::string names = "|", rule = "|";
  for (const MarkdownHead& head : heads) {
    names += head.text.empty() ? " |" : fmt::format(" {} |", head.text);
    rule += head.align == Align::left ? "---|" : head.align == Align::right ? "--:|" : ":-:|";
  }
  return names + "\n" + rule + "\n";
}

std::string markdownRow(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += fmt::format(" {} |", markdownText(cell));
  return line + "\n";
}

std::string markdownPicture(const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  if (path.empty() || path.is_absolute() || *path.begin() == "..") return "";
  std::string address;
  for (const char c : path.string())
    address += isAlphanumeric(c) || std::string_view("._-/").find(c) != std::string_view::npos
                   ? std::string(1, c)
                   : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return fmt::format("![]({})", address);
}

}  // namespace limn::bench
