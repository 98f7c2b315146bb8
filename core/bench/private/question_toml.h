// Reads a SceneQuestion from the [[scenes]] of a suite.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/bench/private/toml_section.h"
#include "core/question/scene_question.h"

namespace limn::bench {

/// Returns the keys of a [[scenes]] table that belong to its questions.
std::vector<const char*> questionKeys();

/// Returns the sizes in the key's texts "WIDTHxHEIGHT", at least one. Throws UsageError, as do the functions
/// below.
std::pair<int, int> parseSize(const TomlSection& section, const toml::node& node, const char* key);
std::vector<std::pair<int, int>> parseSizes(const TomlSection& suite);

/// Returns the suite's or the scene's term.
std::string readTerm(const TomlSection& section, const std::string& otherwise);

/// Calls `ask` with every question of the scene: all combinations of what it lists and of the sizes.
void forEachQuestion(const TomlSection& scene, const std::vector<std::pair<int, int>>& sizes,
                     const std::string& term, const std::function<void(const SceneQuestion&)>& ask);

}  // namespace limn::bench
