// What `limn compare` prints.
#pragma once

#include <string>

#include "core/base/export.h"
#include "core/image/metrics.h"

namespace limn {

/// One JSON object: rmse, rel_mse, bias, p999, psnr, flip, structured, masked_share, pixels, and noise_floor
/// if known. Infinite values (the PSNR of equal images) are null.
LIMN_API std::string metricsJson(const Metrics& metrics);

/// A table for people, one metric per line, saying so where an error is below three times the reference's
/// noise.
LIMN_API std::string metricsTable(const Metrics& metrics);

}  // namespace limn
