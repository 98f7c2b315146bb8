#include "core/scene_io/private/document_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "core/base/text.h"

namespace limn::scene {
namespace {

using nlohmann::json;
using Type = PropertyRule::Type;

/// What is wrong with a value, and where: the place grows at its front on the way back to the root.
struct Problem {
  std::string place, complaint;
};
using Found = std::optional<Problem>;

std::string shown(const json& value) {
  if (value.is_array()) return "an array";
  if (value.is_object()) return "an object";
  return oneLine(value.dump(-1, ' ', false, json::error_handler_t::replace), 60);
}

Problem unaccepted(const json& value, const std::string& what) {
  return {"", fmt::format("is {}; {} is accepted", shown(value), what)};
}

bool chosen(const json& value, const std::vector<std::string>& choices) {
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  return choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end();
}

bool keeps(const json& value, const PropertyRule& rule) {
  switch (rule.type) {
    case Type::boolean:
      return value.is_boolean();
    case Type::text:
      return value.is_string() && chosen(value, rule.choices);
    case Type::number:
      return value.is_number();
    case Type::whole:
      return value.is_number_integer() && value.get<double>() >= rule.low &&
             value.get<double>() <= rule.high && chosen(value, rule.choices);
    case Type::object:
      return value.is_object();
  }
  return false;
}

/// `path` is what is left of the rule's, from `value` on.
Found follow(const json& value, std::string_view path, const PropertyRule& rule);

Found followElements(const json& value, std::string_view path, const PropertyRule& rule) {
  const std::size_t close = path.find(']');
  const std::optional<std::size_t> count = parseWhole<std::size_t>(path.substr(1, close - 1));
  if (!value.is_array())
    return unaccepted(value, count ? fmt::format("an array of {}", *count) : std::string("an array"));
  if (count && value.size() != *count)
    return Problem{"", fmt::format("has {} elements; {} are accepted", value.size(), *count)};
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (Found problem = follow(value[i], path.substr(close + 1), rule)) {
      problem->place.insert(0, fmt::format("[{}]", i));
      return problem;
    }
  }
  return {};
}

Found followMembers(const json& value, std::string_view path, const PropertyRule& rule) {
  if (!value.is_object()) return unaccepted(value, "an object");
  for (const auto& [name, member] : value.items()) {
    if (Found problem = follow(member, path.substr(2), rule)) {
      problem->place.insert(0, "." + oneLine(name, 60));
      return problem;
    }
  }
  return {};
}

Found followName(const json& value, std::string_view path, const PropertyRule& rule) {
  if (!value.is_object()) return unaccepted(value, "an object");
  if (path.starts_with('.')) path.remove_prefix(1);
  const std::size_t end = std::min(path.find_first_of(".[{!"), path.size());
  const std::string name(path.substr(0, end));
  path.remove_prefix(end);
  const bool needed = path.starts_with('!');
  if (needed) path.remove_prefix(1);
  const auto member = value.find(name);
  if (member == value.end()) {
    if (!needed) return {};
    const std::string what = path.empty()            ? accepted(rule)
                             : path.starts_with('[') ? std::string("an array")
                                                     : std::string("an object");
    return Problem{"." + name, fmt::format("is missing; {} is needed", what)};
  }
  Found problem = follow(*member, path, rule);
  if (problem) problem->place.insert(0, "." + name);
  return problem;
}

Found follow(const json& value, std::string_view path, const PropertyRule& rule) {
  if (path.empty()) return keeps(value, rule) ? Found() : unaccepted(value, accepted(rule));
  if (path.starts_with('[')) return followElements(value, path, rule);
  if (path.starts_with('{')) return followMembers(value, path, rule);
  return followName(value, path, rule);
}

}  // namespace

std::string accepted(const PropertyRule& rule) {
  if (!rule.choices.empty()) return joined(rule.choices, "or");
  switch (rule.type) {
    case Type::boolean:
      return "true or false";
    case Type::text:
      return "a text";
    case Type::number:
      return "a number";
    case Type::object:
      return "an object";
    case Type::whole:
      break;
  }
  const PropertyRule unlimited{"", Type::whole};
  if (rule.high < unlimited.high) return fmt::format("a whole number in {} .. {}", rule.low, rule.high);
  return rule.low > unlimited.low ? fmt::format("a whole number of at least {}", rule.low) : "a whole number";
}

std::string checkProperty(const json& root, const PropertyRule& rule) {
  const Found problem = follow(root, rule.path, rule);
  return problem ? fmt::format("{} {}", problem->place.substr(1), problem->complaint) : std::string();
}

std::string checkProperties(const json& root) {
  for (const PropertyRule& rule : propertyRules())
    if (std::string problem = checkProperty(root, rule); !problem.empty()) return problem;
  return {};
}

}  // namespace limn::scene
