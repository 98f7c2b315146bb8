#include "core/base/parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn {
namespace {

std::string accepted(const Parameter& p) {
  const std::string unit = *p.unit ? fmt::format(" {}", p.unit) : "";
  switch (p.type) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::integer:
      return fmt::format("a whole number from {:.0f} to {:.0f}{}", p.range.low, p.range.high, unit);
    case ParameterType::real:
      return fmt::format("a number from {} to {}{}", p.range.low, p.range.high, unit);
    case ParameterType::choice: {
      std::vector<std::string> names(p.choices, p.choices + p.choiceCount);
      return joined(names, "or");
    }
  }
  return {};
}

bool parseValue(const Parameter& p, std::string_view text, double& value) {
  if (p.type == ParameterType::boolean) {
    if (text == "true" || text == "1" || text == "on") return value = 1, true;
    if (text == "false" || text == "0" || text == "off") return value = 0, true;
    return false;
  }
  if (p.type == ParameterType::choice) {
    for (int i = 0; i < p.choiceCount; ++i)
      if (text == p.choices[i]) return value = i, true;
    return false;
  }
  const auto number = parseNumber(text);
  if (!number || *number < p.range.low || *number > p.range.high) return false;
  if (p.type == ParameterType::integer && *number != std::floor(*number)) return false;
  value = *number + 0.0;  // of -0, which would be printed as another value than 0
  return true;
}

std::string print(const Parameter& p, double value) {
  switch (p.type) {
    case ParameterType::boolean:
      return value != 0 ? "true" : "false";
    case ParameterType::choice:
      return p.choices[static_cast<int>(value)];
    case ParameterType::integer:
      return fmt::format("{:.0f}", value);
    case ParameterType::real:
      return fmt::format("{}", value);
  }
  return {};
}

}  // namespace

ParameterValues::ParameterValues(std::string technique, std::span<const Parameter> declared)
    : technique_(std::move(technique)), declared_(declared) {
  for (const Parameter& p : declared) values_.push_back(p.defaultValue);
}

size_t ParameterValues::find(std::string_view name) const {
  for (size_t i = 0; i < declared_.size(); ++i)
    if (name == declared_[i].name) return i;
  return declared_.size();
}

double ParameterValues::value(std::string_view name, ParameterType type) const {
  const size_t i = find(name);
  if (i == declared_.size() || declared_[i].type != type)
    throw std::logic_error(
        fmt::format("technique {} asks for parameter {} as it was not declared", technique_, name));
  return values_[i];
}

bool ParameterValues::boolean(std::string_view name) const {
  return value(name, ParameterType::boolean) != 0;
}
int ParameterValues::integer(std::string_view name) const {
  return static_cast<int>(value(name, ParameterType::integer));
}
float ParameterValues::real(std::string_view name) const {
  return static_cast<float>(value(name, ParameterType::real));
}
int ParameterValues::choice(std::string_view name) const {
  return static_cast<int>(value(name, ParameterType::choice));
}

void ParameterValues::set(std::string_view name, std::string_view text) {
  const size_t i = find(name);
  if (i == declared_.size()) {
    std::vector<std::string> known;
    for (const Parameter& p : declared_) known.emplace_back(p.name);
    throw UsageError(fmt::format("technique {} has no parameter '{}'{}; it has {}", technique_, name,
                                 didYouMean(name, known), known.empty() ? "none" : joined(known)));
  }
  double parsed = 0;
  if (!parseValue(declared_[i], text, parsed))
    throw UsageError(fmt::format("{}.{}: '{}' is not accepted; expected {}", technique_, name, text,
                                 accepted(declared_[i])));
  values_[i] = parsed;
}

std::vector<std::pair<std::string, std::string>> ParameterValues::printed() const {
  std::vector<std::pair<std::string, std::string>> result;
  for (size_t i = 0; i < declared_.size(); ++i)
    result.emplace_back(declared_[i].name, print(declared_[i], values_[i]));
  return result;
}

}  // namespace limn
