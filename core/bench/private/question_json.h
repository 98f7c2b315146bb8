// Writes and reads a SceneQuestion in the JSON of a row.
#pragma once

#include <nlohmann/json.hpp>

#include "core/question/scene_question.h"

namespace limn::bench {

/// Adds the question's fields to the case's object.
void addQuestion(nlohmann::ordered_json& json, const SceneQuestion& question);

/// Reads a question from the case's object. Throws nlohmann::json::exception where a field that every version
/// wrote is missing, or where a field is of another type.
SceneQuestion questionFromJson(const nlohmann::ordered_json& json);

}  // namespace limn::bench
