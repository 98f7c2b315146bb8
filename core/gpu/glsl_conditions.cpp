#include "core/gpu/private/glsl_conditions.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <optional>

#include "core/base/text.h"

namespace limn::gpu {
namespace {

using Operand = std::optional<int64_t>;  // nothing: unknown

Holds opposite(Holds holds) {
  return holds == Holds::unknown ? holds : holds == Holds::yes ? Holds::no : Holds::yes;
}

/// Operators of two operands, those of one row alike, from the weakest row to the strongest.
constexpr std::string_view kOperators[][4] = {
    {"||"}, {"&&"}, {"|"}, {"&"}, {"==", "!="}, {"<", ">", "<=", ">="}, {"+", "-"}, {"*"}};

/// Row of an operator; -1 for any other text.
int strengthOf(std::string_view text) {
  for (int row = 0; row < static_cast<int>(std::size(kOperators)); ++row)
    if (!text.empty() && std::ranges::find(kOperators[row], text) != std::end(kOperators[row])) return row;
  return -1;
}

/// Returns a number that every compiler holds. What others make of larger ones is their own choice.
Operand within32Bits(int64_t number) {
  constexpr int64_t least = std::numeric_limits<int32_t>::min(), most = std::numeric_limits<int32_t>::max();
  return number >= least && number <= most ? Operand(number) : std::nullopt;
}

Operand applied(std::string_view text, const Operand& a, const Operand& b) {
  if (text == "&&" && (a == 0 || b == 0)) return 0;
  if (text == "||" && ((a && a != 0) || (b && b != 0))) return 1;
  if (!a || !b) return std::nullopt;
  if (text == "&&") return 1;
  if (text == "||") return 0;
  if (text == "|") return *a | *b;
  if (text == "&") return *a & *b;
  if (text == "==") return *a == *b;
  if (text == "!=") return *a != *b;
  if (text == "<") return *a < *b;
  if (text == ">") return *a > *b;
  if (text == "<=") return *a <= *b;
  if (text == ">=") return *a >= *b;
  if (text == "+") return within32Bits(*a + *b);
  if (text == "-") return within32Bits(*a - *b);
  return within32Bits(*a * *b);
}

/// Reads a condition by recursive descent.
class ConditionReader {
 public:
  ConditionReader(std::string_view text, const std::map<std::string, std::string>& known)
      : rest_(text), known_(known) {
    next();
  }

  Operand value() {
    const Operand whole = operation(0);
    return token_.empty() && !broken_ ? whole : std::nullopt;
  }

 private:
  static bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

  /// Goes on to the next word or operator; to an empty one behind the last.
  void next() {
    rest_.remove_prefix(std::min(rest_.size(), rest_.find_first_not_of(" \t\r")));
    size_t size = 0;
    while (size < rest_.size() && isWord(rest_[size])) ++size;
    if (size == 0) size = strengthOf(rest_.substr(0, 2)) >= 0 && rest_.size() > 1 ? 2 : 1;
    token_ = rest_.substr(0, size);
    rest_.remove_prefix(token_.size());
  }

  std::string_view take() {
    const std::string_view taken = token_;
    next();
    return taken;
  }

  void expectClosing() {
    if (take() != ")") broken_ = true;
  }

  /// Of operators that are no weaker than `row`.
  Operand operation(int row) {
    Operand left = operand();
    for (int strength = strengthOf(token_); strength >= row; strength = strengthOf(token_)) {
      const std::string_view text = take();
      left = applied(text, left, operation(strength + 1));
    }
    return left;
  }

  Operand operand() {
    const std::string_view token = take();
    if (token == "!") {
      const Operand of = operand();
      return of ? Operand(of == 0) : of;
    }
    if (token == "(") {
      const Operand inside = operation(0);
      expectClosing();
      return inside;
    }
    if (token != "defined") return number(token);
    const bool parenthesised = token_ == "(";
    if (parenthesised) next();
    const std::string name(take());
    if (parenthesised) expectClosing();
    return known_.contains(name) ? Operand(1) : std::nullopt;
  }

  /// Of a literal, or of a macro whose value is one.
  Operand number(std::string_view token) const {
    const auto macro = known_.find(std::string(token));
    const std::string_view text = macro == known_.end() ? token : std::string_view(macro->second);
    if (text.size() > 1 && text.front() == '0') return std::nullopt;  // octal or hexadecimal
    const std::optional<int> whole = parseWhole<int>(text);
    return whole ? Operand(*whole) : std::nullopt;
  }

  std::string_view rest_, token_;
  const std::map<std::string, std::string>& known_;
  bool broken_ = false;
};

}  // namespace

Holds evaluate(std::string_view condition, const std::map<std::string, std::string>& known) {
  const Operand value = ConditionReader(condition, known).value();
  return !value ? Holds::unknown : *value != 0 ? Holds::yes : Holds::no;
}

bool OpenConditions::follow(const GlslLine& line, const std::map<std::string, std::string>& known) {
  const std::string& directive = line.directive;
  if (directive == "if" || directive == "ifdef" || directive == "ifndef") {
    Holds now = evaluate((directive == "if" ? "" : "defined ") + line.argument, known);
    if (directive == "ifndef") now = opposite(now);
    if (line.guard) now = Holds::yes;
    open_.push_back({.now = now, .before = now, .inserted = false});
    return false;
  }
  if (open_.empty()) return false;
  Open& open = open_.back();
  const bool inserted = open.inserted;
  if (directive == "elif" || directive == "else") {
    const Holds own = directive == "else" ? Holds::yes : evaluate(line.argument, known);
    open.now = std::min(own, opposite(open.before));
    open.before = std::max(own, open.before);
    return inserted;
  }
  if (directive != "endif") return false;
  open_.pop_back();
  return inserted;
}

void OpenConditions::inserted() {
  for (Open& open : open_) open.inserted = open.inserted || open.now != Holds::yes;
}

Holds OpenConditions::here() const {
  Holds least = Holds::yes;
  for (const Open& open : open_) least = std::min(least, open.now);
  return least;
}

}  // namespace limn::gpu
