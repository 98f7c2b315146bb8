#include "core/gpu/private/glsl_lines.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace limn::gpu {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> splitLines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return lines;
}

/// The line with its comments replaced by a blank each; `inComment` carries a block comment from line to
/// line.
std::string withoutComments(std::string_view line, bool& inComment) {
  std::string code;
  for (size_t i = 0; i < line.size(); ++i) {
    const std::string_view two = line.substr(i, 2);
    if (inComment) {
      if (two == "*/") {
        inComment = false;
        ++i;
      }
    } else if (two == "//") {
      break;
    } else if (two == "/*") {
      inComment = true;
      code += ' ';
      ++i;
    } else {
      code += line[i];
    }
  }
  return code;
}

/// The words of an expression: identifiers and numbers.
std::vector<std::string> wordsOf(std::string_view expression) {
  std::vector<std::string> words;
  bool inWord = false;
  for (const char c : expression) {
    const bool part = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (part && !inWord) words.emplace_back();
    if (part) words.back() += c;
    inWord = part;
  }
  return words;
}

/// One #if ... #endif: which LIMN_ macros its conditions read, and about which they ask whether they exist.
struct Chain {
  size_t opening = 0;
  bool hasElse = false;
  std::vector<std::string> tested, asked;

  void add(const GlslLine& line) {
    const std::vector<std::string> words = wordsOf(line.argument);
    const bool asksOnly = line.directive == "ifdef" || line.directive == "ifndef";
    for (size_t i = 0; i < words.size(); ++i) {
      if (!words[i].starts_with("LIMN_")) continue;
      const bool asks = asksOnly || (i > 0 && words[i - 1] == "defined");
      (asks ? asked : tested).push_back(words[i]);
    }
  }

  std::vector<std::string> required() const {
    std::vector<std::string> names;
    for (const std::string& name : tested) {
      const bool known =
          std::count(asked.begin(), asked.end(), name) + std::count(names.begin(), names.end(), name) > 0;
      if (!known) names.push_back(name);
    }
    return names;
  }
};

std::vector<GlslLine> parseLines(std::string_view text) {
  std::vector<GlslLine> lines;
  bool inComment = false;
  std::optional<size_t> continued;  // the directive that a trailing backslash carries on
  for (const std::string_view physical : splitLines(text)) {
    GlslLine line{physical, {}, {}, false, {}};
    const std::string code = withoutComments(physical, inComment);
    std::string_view rest = trimmed(code);
    const bool goesOn = rest.ends_with('\\');
    if (goesOn) rest.remove_suffix(1);
    if (continued) {
      lines[*continued].argument += ' ' + std::string(rest);
    } else if (rest.starts_with('#')) {
      rest = trimmed(rest.substr(1));
      const size_t end = std::min(rest.size(), rest.find_first_of(" \t(<\"!"));
      line.directive = rest.substr(0, end);
      line.argument = trimmed(rest.substr(end));
    }
    const bool directive = continued || !line.directive.empty();
    if (goesOn && directive && !continued) continued = lines.size();
    if (!goesOn) continued.reset();
    lines.push_back(std::move(line));
  }
  return lines;
}

/// True when `opening` and `closing` are the include guard around the whole file.
bool isGuard(const std::vector<GlslLine>& lines, const Chain& chain, size_t closing) {
  const auto isBlank = [](const GlslLine& line) {
    const std::string_view text = trimmed(line.text);
    return text.empty() || text.starts_with("//");
  };
  if (chain.hasElse || lines[chain.opening].directive != "ifndef") return false;
  for (size_t i = 0; i < chain.opening; ++i) {
    if (!isBlank(lines[i])) return false;
  }
  for (size_t i = closing + 1; i < lines.size(); ++i) {
    if (!isBlank(lines[i])) return false;
  }
  const auto next =
      std::find_if_not(lines.begin() + static_cast<std::ptrdiff_t>(chain.opening) + 1, lines.end(), isBlank);
  return next != lines.end() && next->directive == "define" &&
         next->argument == lines[chain.opening].argument;
}

}  // namespace

GlslFile::GlslFile(std::string_view text) : lines(parseLines(text)) {
  std::vector<Chain> open;
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::string& directive = lines[i].directive;
    if (directive == "if" || directive == "ifdef" || directive == "ifndef") {
      open.push_back({.opening = i, .hasElse = false, .tested = {}, .asked = {}});
      open.back().add(lines[i]);
    } else if (open.empty()) {
      continue;
    } else if (directive == "elif" || directive == "else") {
      open.back().hasElse = true;
      if (directive == "elif") open.back().add(lines[i]);
    } else if (directive == "endif") {
      GlslLine& opening = lines[open.back().opening];
      opening.requiredMacros = open.back().required();
      opening.guard = open.size() == 1 && isGuard(lines, open.back(), i);
      open.pop_back();
    }
  }
}

}  // namespace limn::gpu
