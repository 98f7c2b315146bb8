// What a glTF document may say: the type, range and count of every property that the loader reads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"

namespace limn::scene {

/// One property. `path` names it from the document's root: "[]" stands for each element of an array, "[3]"
/// for each of exactly three, "{}" for each member of an object, and "!" follows the name of what must be
/// there.
struct PropertyRule {
  enum class Type { boolean, text, number, whole, object };
  std::string path;
  Type type;
  double low = -9e15, high = 9e15;        ///< of whole numbers
  std::vector<std::string> choices = {};  ///< texts, or whole numbers; none: not only these
};

/// Every property the loader reads, in the order in which they are checked.
LIMN_API std::span<const PropertyRule> propertyRules();

/// What a rule accepts: "a whole number of at least 0".
LIMN_API std::string accepted(const PropertyRule& rule);

/// Empty if the document keeps the rule, else one line: "bufferViews[0].byteOffset is -8; a whole number of
/// at least 0 is accepted".
LIMN_API std::string checkProperty(const nlohmann::json& root, const PropertyRule& rule);

/// The same for all rules: the first complaint, or empty. What no rule names is allowed.
LIMN_API std::string checkProperties(const nlohmann::json& root);

}  // namespace limn::scene
