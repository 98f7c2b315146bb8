// Writes and reads a Provenance in the JSON of a row or of a stability result.
#pragma once

#include <nlohmann/json.hpp>

#include "core/bench/provenance.h"

namespace limn::bench {

nlohmann::ordered_json provenanceToJson(const Provenance& provenance);

/// Throws nlohmann::json::exception where a field is missing or of another type.
Provenance provenanceFromJson(const nlohmann::ordered_json& json);

}  // namespace limn::bench
