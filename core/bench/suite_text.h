// Writes the parts of a suite as TOML that parseSuite() reads again.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "core/base/export.h"
#include "core/question/scene_question.h"

namespace limn::bench {

/// Returns the text as a TOML basic string, quoted.
LIMN_API std::string tomlText(const std::string& text);

/// Returns the lines `sizes = ["WIDTHxHEIGHT"]` and `term = "TERM"` of the question.
LIMN_API std::string subjectToml(const SceneQuestion& question);

/// Returns a table [[scenes]] with every other field of the question that is not its default.
LIMN_API std::string sceneToml(const SceneQuestion& question);

/// Returns a table [[techniques]]: one name, or several joined by ",", with values of parameters
/// ("technique.parameter", value).
LIMN_API std::string techniqueToml(const std::string& technique,
                                   std::span<const std::pair<std::string, std::string>> parameters);

}  // namespace limn::bench
