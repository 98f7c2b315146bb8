#include "core/bench/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bench/private/comparison.h"

namespace limn::bench {
namespace {

std::string valueText(const Parameter& parameter, double value) {
  return parameter.type == ParameterType::integer ? fmt::format("{:.0f}", value)
                                                  : fmt::format("{:.6g}", value);
}

/// The values after the default in one direction, the nearest first.
std::vector<double> stepsFrom(const Parameter& parameter, int steps, double factor) {
  std::vector<double> values;
  double value = parameter.defaultValue, last = value;
  for (int i = 0; i < steps; ++i) {
    value = value == 0 && factor > 1 ? 1 : value * factor;
    double next = std::clamp(value, parameter.range.low, parameter.range.high);
    if (parameter.type == ParameterType::integer) next = std::round(next);
    if (next == last) continue;
    values.push_back(next);
    last = next;
  }
  return values;
}

}  // namespace

TuneAxis tuneAxis(const std::string& technique, const Parameter& parameter, int steps) {
  TuneAxis axis{fmt::format("{}.{}", technique, parameter.name), {}, 0};
  switch (parameter.type) {
    case ParameterType::boolean:
      axis.values = {"false", "true"};
      axis.start = parameter.defaultValue != 0 ? 1 : 0;
      break;
    case ParameterType::choice:
      for (int i = 0; i < parameter.choiceCount; ++i) axis.values.emplace_back(parameter.choices[i]);
      axis.start = static_cast<std::size_t>(parameter.defaultValue);
      break;
    case ParameterType::integer:
    case ParameterType::real: {
      const std::vector<double> below = stepsFrom(parameter, steps, 0.5);
      for (auto value = below.rbegin(); value != below.rend(); ++value)
        axis.values.push_back(valueText(parameter, *value));
      axis.start = below.size();
      axis.values.push_back(valueText(parameter, parameter.defaultValue));
      for (const double value : stepsFrom(parameter, steps, 2))
        axis.values.push_back(valueText(parameter, value));
      break;
    }
  }
  return axis;
}

std::size_t settingCount(const TuneSpace& space) {
  constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
  std::size_t count = 1;
  for (const TuneAxis& axis : space.axes)
    count = count > most / std::max<std::size_t>(axis.values.size(), 1) ? most : count * axis.values.size();
  return count;
}

std::vector<std::pair<std::string, std::string>> changedParameters(const TuneSpace& space,
                                                                   const TuneSetting& setting) {
  std::vector<std::pair<std::string, std::string>> changed;
  for (std::size_t i = 0; i < space.axes.size(); ++i)
    if (const TuneAxis& axis = space.axes[i]; setting.at[i] != axis.start)
      changed.emplace_back(axis.parameter, axis.values[setting.at[i]]);
  return changed;
}

TunePlan tunePlan(int width, int height, int frames, int turns) {
  // Pixels of the shorter side: pictures with fewer are mostly silhouettes and take as long as larger ones.
  constexpr int least = 96;
  int divisor = 4;
  while (divisor > 1 && std::min(width, height) / divisor < least) divisor /= 2;
  // Rows are known by size, frames and warm-up: those of different efforts must not be taken for each other.
  return {{divisor, std::min(3, (frames + 2) / 3), 1, 1},
          {1, (frames + 1) / 2, 2, (turns + 2) / 3},
          {1, frames, 3, turns}};
}

TuneEffort scaleOf(const TunePlan& plan) {
  TuneEffort effort = plan.look;
  effort.divisor = 1;
  return effort;
}

double badness(const MetricInfo& metric, double value) {
  switch (metric.kind) {
    case MetricKind::deviation:
      return std::abs(value);
    case MetricKind::likeness:
      return std::pow(10, -value / 20);
    case MetricKind::error:
    case MetricKind::basis:
      break;
  }
  return value;
}

std::optional<double> badness(const MetricInfo& metric, const Metrics& metrics) {
  const std::optional<double> value = boundedError(metric, metrics);
  return value ? std::optional(badness(metric, *value)) : std::nullopt;
}

double msAtPixels(const Row& row, double pixels, double rest) {
  if (pixels == 1) return row.cost.frameMs.median;
  const CostSplit& split = row.cost.split;
  const double now = split.maps + split.filters + split.technique + split.rest;
  const double then = split.maps + split.filters + split.technique * pixels + split.rest * rest;
  return row.cost.frameMs.median * (now > 0 ? then / now : pixels);
}

Ratio frameMsInterval(const Row& row) {
  const FrameTime& time = row.cost.frameMs;
  const std::vector<double> samples = samplesOf(time);
  return medianWithInterval({samples, time.turns});
}

}  // namespace limn::bench
