// Searches the quality parameters of techniques for the setting with the least error in a given time, or the
// least time at a given error. Measuring is passed in as a callback, so that the search is tested without it.
//
// The search walks from each technique's defaults to neighbouring settings that nothing clearly beats and
// that lie near the limit, all with little effort. The best third is measured with more effort, and the best
// third of those in full: successive halving (Jamieson and Talwalkar 2016) with thirds, of which there are as
// many as fit into a share of what measuring every setting in full would cost.
#pragma once

#include <compare>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/base/parameters.h"
#include "core/bench/ratio.h"
#include "core/bench/row.h"
#include "core/image/metric_table.h"

namespace limn::bench {

/// Holds the values of one parameter that are tried, in their order.
struct TuneAxis {
  std::string parameter;            ///< "technique.parameter"
  std::vector<std::string> values;  ///< as --set takes them
  std::size_t start = 0;            ///< index of the default
};

/// Returns what is tried of a parameter: every choice, or the default and up to `steps` values on each side
/// of it that differ by factors of 2. A default of 0 is followed by 1. Values beyond the parameter's range
/// are its ends.
LIMN_API TuneAxis tuneAxis(const std::string& technique, const Parameter& parameter, int steps);

/// Holds the settings of one technique: all combinations of its axes' values.
struct TuneSpace {
  std::string technique;
  std::vector<TuneAxis> axes;
};

/// Returns the number of settings, or the largest std::size_t where there are more.
LIMN_API std::size_t settingCount(const TuneSpace& space);

/// Names a setting of one of several spaces.
struct TuneSetting {
  std::size_t space = 0;
  std::vector<std::size_t> at;  ///< index of the value on each axis
  auto operator<=>(const TuneSetting&) const = default;
};

/// Returns the parameters whose value is not the default: "technique.parameter", value.
LIMN_API std::vector<std::pair<std::string, std::string>> changedParameters(const TuneSpace& space,
                                                                            const TuneSetting& setting);

/// Says how much a measurement may cost.
struct TuneEffort {
  int divisor = 1;  ///< of width and height
  int frames = 0, warmup = 0, turns = 1;
};

/// Holds the efforts from the least to the full one.
struct TunePlan {
  TuneEffort look, check, full;
};

/// Returns the plan for pictures of that size whose full effort has these frames and turns. Looks take a
/// quarter of width and height, as far as 96 pixels are left.
LIMN_API TunePlan tunePlan(int width, int height, int frames, int turns);

/// Returns the effort of a picture of full size that says what times of looks at small ones are worth.
LIMN_API TuneEffort scaleOf(const TunePlan& plan);

/// Holds what was measured of a setting.
struct TuneFigures {
  double error = 0;  ///< badness() of the metric
  double ms = 0;     ///< of a frame of full size
  bool failed = false;
};

/// Returns a figure of the metric that is smaller for better pictures: errors as they are, deviations without
/// their sign, and 10^(-d/20) of a likeness of d decibels.
LIMN_API double badness(const MetricInfo& metric, double value);
/// Returns the same of boundedError(): pictures that differ by less than the reference's noise are equally
/// good. Returns nullopt where it is not known.
LIMN_API std::optional<double> badness(const MetricInfo& metric, const Metrics& metrics);

/// Returns the median time of the row's frames at `pixels` times as many pixels: maps and filters take as
/// long as before, the technique's own passes grow with the pixels, and the rest, whose G-buffer is bound by
/// triangles in small pictures, takes `rest` times as long. At one times as many it is the time as measured.
LIMN_API double msAtPixels(const Row& row, double pixels, double rest);

/// Returns the median time of the row's frames with its interval of 95 %.
LIMN_API Ratio frameMsInterval(const Row& row);

/// Holds the limit that the answer keeps: exactly one of the two.
struct TuneLimit {
  std::optional<double> ms{};     ///< the error is then the least
  std::optional<double> error{};  ///< badness(); the time is then the least
};

/// Measures settings with an effort; returns as many figures in their order.
using TuneMeasure = std::function<std::vector<TuneFigures>(std::span<const TuneSetting>, const TuneEffort&)>;

struct TuneResult {
  /// Holds the settings that were measured in full and keep the limit, the best first; of equally good ones
  /// that with more of the limit left.
  std::vector<TuneSetting> answers;
  /// Holds the one measured in full that misses the limit least; unset where all failed.
  std::optional<TuneSetting> nearest;
  std::size_t looked = 0, checked = 0, measured = 0;  ///< settings by effort
};

/// Returns the best settings of all spaces.
LIMN_API TuneResult tune(std::span<const TuneSpace> spaces, const TuneLimit& limit, const TunePlan& plan,
                         const TuneMeasure& measure);

/// Returns the best settings after measuring every one in full.
LIMN_API TuneResult tuneExhaustively(std::span<const TuneSpace> spaces, const TuneLimit& limit,
                                     const TuneEffort& full, const TuneMeasure& measure);

}  // namespace limn::bench
