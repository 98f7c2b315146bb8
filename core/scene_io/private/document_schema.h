// Declares what a glTF document may hold: the type, range and count of every property that the loader reads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn::scene {

/// Holds the rule for one property. `path` names it from the document's root: "[]" stands for each element of
/// an array, "[3]" for each of exactly three, "{}" for each member of an object, and "!" follows the name of
/// a required property.
struct PropertyRule {
  enum class Type { boolean, text, number, whole, object };
  std::string path;
  Type type;
  double low = -9e15, high = 9e15;        ///< of whole numbers
  std::vector<std::string> choices = {};  ///< accepted texts or whole numbers; empty: not restricted
};

/// Returns the rules of all properties that the loader reads, in the order in which they are checked.
LIMN_API std::span<const PropertyRule> propertyRules();

/// Returns a phrase that says what a rule accepts, such as "a whole number of at least 0".
LIMN_API std::string accepted(const PropertyRule& rule);

/// Returns an empty string when the document keeps the rule, else one line such as "bufferViews[0].byteOffset
/// is -8; a whole number of at least 0 is accepted".
LIMN_API std::string checkProperty(const nlohmann::json& root, const PropertyRule& rule);

/// Returns the first complaint of all rules, or an empty string. Properties without a rule are allowed.
LIMN_API std::string checkProperties(const nlohmann::json& root);

}  // namespace limn::scene
