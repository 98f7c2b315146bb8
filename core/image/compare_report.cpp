#include "core/image/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/image/metric_json.h"
#include "core/image/metric_table.h"

namespace limn {
namespace {

std::size_t labelWidth() {
  std::size_t width = 0;
  for (const MetricInfo& info : kQualityMetrics) width = std::max(width, labelWithUnit(info).size());
  return width;
}

}  // namespace

std::string metricsJson(const Metrics& metrics) {
  return metricsToJson(metrics).dump(2) + "\n";
}

std::string metricsTable(const Metrics& metrics) {
  std::string text;
  for (const MetricInfo& info : kQualityMetrics) {  // the others in sentences below
    const std::optional<double> value = metricValue(info, metrics);
    text += fmt::format("{:<{}} {:>12}  {}\n", labelWithUnit(info), labelWidth(),
                        value ? fmt::format("{:.6g}", *value) : "-", info.help);
  }
  text +=
      fmt::format("{} pixels compared; {:.3f} % of the covered ones differ in coverage, instance or depth\n",
                  metrics.pixels, 100 * metrics.masked_share);
  if (metrics.noise_floor) {
    text += fmt::format("noise floor of the reference {:.6g}: {}\n", *metrics.noise_floor,
                        metrics.rmse < *metrics.noise_floor ? "the difference is within it" : "exceeded");
  }
  return text;
}

std::string metricsHelp() {
  std::string text = "Metrics, by their keys in JSON (x is the image, r the reference):\n";
  for (const MetricInfo& info : kMetrics) text += fmt::format("  {:<13} {}\n", info.key, info.help);
  return text;
}

}  // namespace limn
