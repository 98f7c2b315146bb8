// Declares metrics as JSON, for the results of a bench and for `limn compare --json`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/base/export.h"
#include "core/image/metrics.h"

namespace limn {

/// Returns an object with the keys of kMetrics in their order; the keys of optional members come last, and
/// only where the values are known. Infinite values (the PSNR of equal pictures) are written as null, since
/// JSON has no infinity.
LIMN_API nlohmann::ordered_json metricsToJson(const Metrics& metrics);

/// Returns the metrics that metricsToJson() wrote. Throws nlohmann::json::exception where a key is missing or
/// its value is no number.
LIMN_API Metrics metricsFromJson(const nlohmann::ordered_json& json);

}  // namespace limn
