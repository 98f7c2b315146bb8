// Declares the metrics as data: what each is called, what it means and how it is written. JSON, CSV,
// Markdown, the report page, `limn compare` and the viewer all read this table; a new metric needs a member
// of Metrics, its computation and one line here.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/export.h"
#include "core/image/metrics.h"

namespace limn {

enum class MetricKind {
  error,      ///< 0 for equal pictures; smaller is better
  deviation,  ///< an error with a sign: nearer to 0 is better
  likeness,   ///< larger is better
  basis,      ///< says what the others were computed from; neither good nor bad
};

/// Points to a member of Metrics. Optional members whose value is not known are left out of JSON and are
/// empty in CSV.
using MetricMember =
    std::variant<double Metrics::*, std::size_t Metrics::*, std::optional<double> Metrics::*>;

struct MetricInfo {
  std::string_view key;    ///< in JSON and CSV
  std::string_view label;  ///< for people
  std::string_view head;   ///< heading of a narrow column; "": not shown in such tables
  std::string_view unit;   ///< "": none
  const char* format;      ///< of fmt, for the few digits that people read
  MetricKind kind;
  bool unbounded;  ///< may be infinite, which JSON writes as null
  bool floored;    ///< values below Metrics::noise_floor are no difference
  MetricMember member;
  std::string_view help;  ///< a phrase that continues "label: "; x is the picture, r the reference
};

// clang-format off
inline constexpr MetricInfo kMetrics[] = {
    {"rmse", "RMSE", "RMSE", "", "{:.4g}", MetricKind::error, false, true, &Metrics::rmse,
     "root mean square error over R, G and B, linear"},
    {"rel_mse", "relative MSE", "rel. MSE", "", "{:.4g}", MetricKind::error, true, false, &Metrics::rel_mse,
     "mean of (x - r)^2 / (r^2 + 0.01 mean(r)^2)"},
    {"bias", "bias", "bias", "", "{:+.3g}", MetricKind::deviation, false, false, &Metrics::bias,
     "mean of x - r: positive where the picture is too bright"},
    {"p999", "p99.9", "p99.9", "", "{:.4g}", MetricKind::error, false, false, &Metrics::p999,
     "99.9th percentile of the absolute error in luminance"},
    {"psnr", "PSNR", "PSNR", "dB", "{:.1f}", MetricKind::likeness, true, false, &Metrics::psnr,
     "20 log10(peak / RMSE); the peak is the 99.9th percentile of r"},
    {"flip", "FLIP", "FLIP", "", "{:.4f}", MetricKind::error, false, false, &Metrics::flip,
     "mean perceived difference of the tone-mapped pictures, 0 to 1"},
    {"structured", "structured error", "structured", "", "{:.4g}", MetricKind::error, false, false,
     &Metrics::structured,
     "RMS of the error after a 9 x 9 Gaussian (sigma 2 pixels): banding survives it, noise does not"},
    {"noise_floor", "noise floor", "", "", "{:.3g}", MetricKind::basis, false, false, &Metrics::noise_floor,
     "three times the RMS noise of the reference over the compared pixels, in the unit of the pictures; a "
     "smaller RMSE cannot be told from noise"},
    {"masked_share", "masked share", "", "", "{:.3g}", MetricKind::basis, false, false,
     &Metrics::masked_share,
     "share of the covered pixels that differ in coverage, instance or depth, and are left out"},
    {"pixels", "pixels", "", "", "{}", MetricKind::basis, false, false, &Metrics::pixels,
     "number of pixels compared"},
};
// clang-format on

/// Holds the metrics that say how good a picture is: those before the bases, with which the table ends.
inline constexpr std::span<const MetricInfo> kQualityMetrics(std::begin(kMetrics),
                                                             std::ranges::find(kMetrics, MetricKind::basis,
                                                                               &MetricInfo::kind));

/// Returns the line of the table for a member. Throws std::logic_error if there is none.
constexpr const MetricInfo& metricInfo(double Metrics::*member) {
  for (const MetricInfo& info : kMetrics)
    if (info.member == MetricMember(member)) return info;
  throw std::logic_error("a metric without a line in kMetrics");
}

/// Returns the label with its unit: "PSNR, dB".
LIMN_API std::string labelWithUnit(const MetricInfo& info);

/// Returns the value, whatever the member's type; nullopt if it is not known.
LIMN_API std::optional<double> metricValue(const MetricInfo& info, const Metrics& metrics);

/// Returns the value, but no less than the noise floor where the metric is floored: smaller errors are no
/// difference, and none ranks before another. Returns nullopt if it is not known.
LIMN_API std::optional<double> boundedError(const MetricInfo& info, const Metrics& metrics);

/// Returns the value in full precision; "" if it is not known.
LIMN_API std::string exactText(const MetricInfo& info, const Metrics& metrics);

/// Returns the value as people read it: "-" if it is not known, and the noise floor as a bound ("<0.001")
/// where the metric is floored and its value is below it.
LIMN_API std::string shownText(const MetricInfo& info, const Metrics& metrics);
/// Returns a value of the metric to the digits that people read, where nothing else is known of the pictures.
LIMN_API std::string shownText(const MetricInfo& info, double value);

}  // namespace limn
