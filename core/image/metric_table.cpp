#include "core/image/metric_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

template <class T>
constexpr std::size_t memberSize(T Metrics::*) {
  return sizeof(T);
}

constexpr std::size_t sizeOfAll() {
  std::size_t size = 0;
  for (const MetricInfo& info : kMetrics)
    size += std::visit([](auto member) { return memberSize(member); }, info.member);
  return size;
}
static_assert(sizeOfAll() == sizeof(Metrics), "every member of Metrics has one line in kMetrics");
static_assert(std::all_of(std::begin(kMetrics) + kQualityMetrics.size(), std::end(kMetrics),
                          [](const MetricInfo& info) { return info.kind == MetricKind::basis; }),
              "kMetrics ends with the bases");

template <class T>
std::string textOf(const std::optional<T>& value, const char* format, const char* unknown) {
  return value ? fmt::format(fmt::runtime(format), *value) : unknown;
}

template <class T>
std::string textOf(const T& value, const char* format, const char*) {
  return fmt::format(fmt::runtime(format), value);
}

std::string metricText(const MetricInfo& info, const Metrics& metrics, const char* format,
                       const char* unknown) {
  return std::visit([&](auto member) { return textOf(metrics.*member, format, unknown); }, info.member);
}

template <class T>
std::optional<double> asDouble(const T& value) {
  return static_cast<double>(value);
}

std::optional<double> asDouble(const std::optional<double>& value) {
  return value;
}

}  // namespace

std::string labelWithUnit(const MetricInfo& info) {
  return info.unit.empty() ? std::string(info.label) : fmt::format("{}, {}", info.label, info.unit);
}

std::optional<double> metricValue(const MetricInfo& info, const Metrics& metrics) {
  return std::visit([&](auto member) { return asDouble(metrics.*member); }, info.member);
}

std::optional<double> boundedError(const MetricInfo& info, const Metrics& metrics) {
  const std::optional<double> value = metricValue(info, metrics);
  return info.floored && value ? std::max(*value, metrics.noise_floor.value_or(*value)) : value;
}

std::string exactText(const MetricInfo& info, const Metrics& metrics) {
  return metricText(info, metrics, "{}", "");
}

std::string shownText(const MetricInfo& info, const Metrics& metrics) {
  if (info.floored && metrics.noise_floor && metricValue(info, metrics) < metrics.noise_floor)
    return fmt::format("<{:.3g}", *metrics.noise_floor);
  return metricText(info, metrics, info.format, "-");
}

std::string shownText(const MetricInfo& info, double value) {
  return fmt::format(fmt::runtime(info.format), value);
}

}  // namespace limn
