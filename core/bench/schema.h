// Describes what limn writes as JSON, for programs that read it.
#pragma once

#include <string>

#include "core/base/export.h"

namespace limn::bench {

/// Returns the JSON Schema (draft 2020-12) of a line of results.jsonl. What stands in tables elsewhere
/// (questions, metrics) is described from them.
LIMN_API std::string rowSchema();

/// Returns the JSON Schema of what `limn render --stats` writes, which is also part of a row.
LIMN_API std::string statsSchema();

}  // namespace limn::bench
