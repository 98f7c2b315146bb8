#include "core/image/metric_json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/image/metric_table.h"

namespace limn {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
T valueOf(const Json& json, const MetricInfo& info) {
  if constexpr (std::numeric_limits<T>::has_infinity) {
    if (info.unbounded && json.is_null()) return std::numeric_limits<T>::infinity();
  }
  return json.get<T>();
}

template <class T>
void read(T& value, const Json& json, const MetricInfo& info) {
  value = valueOf<T>(json.at(std::string(info.key)), info);
}

template <class T>
void read(std::optional<T>& value, const Json& json, const MetricInfo& info) {
  const auto found = json.find(std::string(info.key));
  if (found != json.end()) value = valueOf<T>(*found, info);
}

template <class T>
void write(Json& known, Json&, const MetricInfo& info, const T& value) {
  known[std::string(info.key)] = value;
}

template <class T>
void write(Json&, Json& optional, const MetricInfo& info, const std::optional<T>& value) {
  if (value) optional[std::string(info.key)] = *value;
}

}  // namespace

Json metricsToJson(const Metrics& metrics) {
  Json json = Json::object(), optional = Json::object();
  for (const MetricInfo& info : kMetrics)
    std::visit([&](auto member) { write(json, optional, info, metrics.*member); }, info.member);
  json.update(optional);
  return json;
}

Metrics metricsFromJson(const Json& json) {
  Metrics metrics;
  for (const MetricInfo& info : kMetrics)
    std::visit([&](auto member) { read(metrics.*member, json, info); }, info.member);
  // null is both infinities: +inf of equal pictures, -inf of others, whose reference is black.
  if (std::isinf(metrics.psnr) && metrics.rmse != 0) metrics.psnr = -std::numeric_limits<double>::infinity();
  return metrics;
}

}  // namespace limn
