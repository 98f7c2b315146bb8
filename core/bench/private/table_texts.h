// Says in words what tells tables apart.
#pragma once

#include <string>

#include "core/bench/suite.h"
#include "core/question/question_fields.h"

namespace limn::bench {

/// Returns what a table's pictures show, but for their term and size: scene, camera, light, environment,
/// time, medium and changes. Keys differ wherever these do.
std::string tableSubject(const Case& c, QuestionWording wording);

/// Returns the size of the pictures, and that of the timed frames where it is another.
std::string sizesText(const Case& c);

}  // namespace limn::bench
