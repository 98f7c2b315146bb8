#include "core/bench/private/toml_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace limn::bench {

void failAt(const std::string& file, const toml::source_region& where, const std::string& message) {
  throw UsageError(
      oneLine(fmt::format("{}:{}:{}: {}", file, where.begin.line, where.begin.column, message), 4000));
}

TomlSection::TomlSection(const std::string& file, const toml::table& table, std::string name,
                         const std::vector<const char*>& keys)
    : file_(file), table_(table), name_(std::move(name)) {
  for (const auto& [key, node] : table) {
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
      failAt(file_, key.source(),
             fmt::format("unknown key '{}' in {}; known are {}", key.str(), name_, fmt::join(keys, ", ")));
    }
  }
}

const toml::node& TomlSection::require(const char* key) const {
  const toml::node* node = find(key);
  if (node == nullptr) failAt(file_, table_.source(), fmt::format("{} lacks the key '{}'", name_, key));
  return *node;
}

void TomlSection::fail(const toml::node& node, const std::string& message) const {
  failAt(file_, node.source(), message);
}

std::string TomlSection::text(const toml::node& node, const char* key) const {
  const auto value = node.value_exact<std::string>();
  if (!value || value->empty()) fail(node, fmt::format("'{}' must be a text that is not empty", key));
  if (oneLine(*value, value->size()) != *value)
    fail(node, fmt::format("'{}' must be a text of one line", key));
  return *value;
}

std::string TomlSection::text(const char* key, const std::string& otherwise) const {
  const toml::node* node = find(key);
  return node == nullptr ? otherwise : text(*node, key);
}

int TomlSection::integer(const char* key, int otherwise, int low, int high) const {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < low || *value > high) {
    fail(*node, fmt::format("'{}' must be a whole number in {}..{}", key, low, high));
  }
  return static_cast<int>(*value);
}

double TomlSection::real(const char* key, double otherwise, double low, double high) const {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value<double>();
  if (!value || !node->is_number() || !(*value >= low && *value <= high)) {
    fail(*node, fmt::format("'{}' must be a number in {}..{}", key, low, high));
  }
  return *value;
}

bool TomlSection::boolean(const char* key, bool otherwise) const {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value_exact<bool>();
  if (!value) fail(*node, fmt::format("'{}' must be true or false", key));
  return *value;
}

const toml::array* TomlSection::list(const toml::node& node, const char* key) const {
  const toml::array* array = node.as_array();
  if (array == nullptr) return nullptr;
  if (array->empty()) fail(node, fmt::format("'{}' is an empty list", key));
  if (array->size() > kMostListed)
    fail(node, fmt::format("'{}' lists more than {} values", key, kMostListed));
  return array;
}

std::vector<double> TomlSection::reals(const char* key, double otherwise, double low, double high) const {
  const toml::node* node = find(key);
  const toml::array* elements = node == nullptr ? nullptr : list(*node, key);
  if (elements == nullptr) return {real(key, otherwise, low, high)};
  std::vector<double> values;
  for (const toml::node& element : *elements) {
    const auto value = element.value<double>();
    if (!value || !element.is_number() || !(*value >= low && *value <= high))
      fail(element, fmt::format("'{}' must be numbers in {}..{}", key, low, high));
    values.push_back(*value);
  }
  return values;
}

std::vector<std::string> TomlSection::texts(const char* key, std::vector<std::string> otherwise) const {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const toml::array* elements = list(*node, key);
  if (elements == nullptr) return {text(*node, key)};
  std::vector<std::string> values;
  for (const toml::node& element : *elements) values.push_back(text(element, key));
  return values;
}

std::string TomlSection::choice(const QuestionField& field, const std::string& otherwise) const {
  const std::string value = text(field.key, otherwise);
  if (const toml::node* node = find(field.key);
      node != nullptr && std::ranges::find(field.choices, value) == field.choices.end())
    fail(*node, unknownChoice(field, value));
  return value;
}

std::vector<const toml::table*> TomlSection::tables(const char* key) const {
  const toml::node& node = require(key);
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty()) fail(node, fmt::format("'{}' must be tables: [[{}]]", key, key));
  std::vector<const toml::table*> result;
  for (const toml::node& element : *array) {
    if (!element.is_table()) fail(element, fmt::format("'{}' must be tables: [[{}]]", key, key));
    result.push_back(element.as_table());
  }
  return result;
}

}  // namespace limn::bench
