// Declares the output of `limn compare`.
#pragma once

#include <string>

#include "core/base/export.h"
#include "core/image/metrics.h"

namespace limn {

/// Returns metricsToJson() as text.
LIMN_API std::string metricsJson(const Metrics& metrics);

/// Returns a table for people, one metric per line, which says where an error is below three times the
/// reference's noise.
LIMN_API std::string metricsTable(const Metrics& metrics);

/// Returns a list of every metric with its key in JSON and its meaning.
LIMN_API std::string metricsHelp();

}  // namespace limn
