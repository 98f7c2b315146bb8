// The table of metrics, and what is made of it.
#include "core/image/metric_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/image/compare_report.h"
#include "core/image/metric_json.h"
#include "tests/support/paths.h"

namespace limn {
namespace {

/// Every member known, and no two alike.
Metrics distinctMetrics() {
  Metrics metrics;
  int number = 0;
  for (const MetricInfo& info : kMetrics)
    std::visit([&](auto member) { metrics.*member = ++number; }, info.member);
  return metrics;
}

TEST(MetricTable, NamesAreTheirOwnAndComplete) {
  std::set<std::string_view> keys, labels, helps;
  for (const MetricInfo& info : kMetrics) {
    EXPECT_TRUE(keys.insert(info.key).second) << info.key;
    EXPECT_TRUE(labels.insert(info.label).second) << info.label;
    EXPECT_TRUE(helps.insert(info.help).second) << info.help;
    EXPECT_FALSE(info.label.empty() || info.help.empty()) << info.key;
    EXPECT_EQ(info.head.empty(), info.kind == MetricKind::basis)
        << info.key << ": tables show errors, no bases";
  }
}

TEST(MetricTable, EveryMetricSurvivesJson) {
  const Metrics metrics = distinctMetrics();
  const auto json = metricsToJson(metrics);
  EXPECT_EQ(json.size(), std::size(kMetrics));
  const Metrics back = metricsFromJson(json);
  for (const MetricInfo& info : kMetrics) {
    ASSERT_TRUE(json.contains(std::string(info.key))) << info.key;
    EXPECT_EQ(json[std::string(info.key)].get<double>(), metricValue(info, metrics)) << info.key;
    EXPECT_EQ(metricValue(info, back), metricValue(info, metrics)) << info.key;
  }
}

TEST(MetricTable, JsonIsWrittenAsEver) {
  Metrics metrics = distinctMetrics();
  metrics.rmse = 0;
  metrics.psnr = std::numeric_limits<double>::infinity();
  EXPECT_EQ(metricsToJson(metrics).dump(),
            R"({"rmse":0.0,"rel_mse":2.0,"bias":3.0,"p999":4.0,"psnr":null,"flip":6.0,"structured":7.0,)"
            R"("masked_share":9.0,"pixels":10,"noise_floor":8.0})");
  EXPECT_EQ(metricsFromJson(metricsToJson(metrics)).psnr, metrics.psnr);
  metrics.noise_floor.reset();
  EXPECT_FALSE(metricsToJson(metrics).contains("noise_floor"));
  EXPECT_FALSE(metricsFromJson(metricsToJson(metrics)).noise_floor);
}

/// JSON has one null for both infinities.
TEST(MetricTable, ThePsnrOfABlackReferenceStaysTheWorst) {
  Metrics metrics = distinctMetrics();
  metrics.psnr = -std::numeric_limits<double>::infinity();
  const auto json = nlohmann::ordered_json::parse(metricsToJson(metrics).dump());
  EXPECT_TRUE(json["psnr"].is_null());
  EXPECT_EQ(metricsFromJson(json).psnr, metrics.psnr);
  EXPECT_EQ(shownText(metricInfo(&Metrics::psnr), metrics), "-inf");
}

TEST(MetricTable, ErrorsBelowTheNoiseAreAlike) {
  const MetricInfo &rmse = metricInfo(&Metrics::rmse), &flip = metricInfo(&Metrics::flip);
  Metrics metrics;
  metrics.rmse = metrics.flip = 0.25;
  EXPECT_EQ(boundedError(rmse, metrics), 0.25) << "the noise is not known";
  metrics.noise_floor = 0.5;
  EXPECT_EQ(boundedError(rmse, metrics), 0.5);
  EXPECT_EQ(boundedError(flip, metrics), 0.25) << "the floor is that of the RMSE";
  metrics.rmse = 0.75;
  EXPECT_EQ(boundedError(rmse, metrics), 0.75);
}

TEST(MetricTable, JsonThatLacksSomethingIsRefused) {
  for (const MetricInfo& info : kMetrics) {
    const std::string key(info.key);
    auto json = metricsToJson(distinctMetrics());
    json[key] = "text";
    EXPECT_THROW(metricsFromJson(json), nlohmann::json::exception) << key;
    json[key] = nullptr;
    if (info.unbounded) {
      EXPECT_NO_THROW(metricsFromJson(json)) << key;
    } else {
      EXPECT_THROW(metricsFromJson(json), nlohmann::json::exception) << key;
    }
    json.erase(key);
    if (std::holds_alternative<std::optional<double> Metrics::*>(info.member)) {
      EXPECT_NO_THROW(metricsFromJson(json)) << key;
    } else {
      EXPECT_THROW(metricsFromJson(json), nlohmann::json::exception) << key;
    }
  }
}

TEST(MetricTable, TextsAreExactOrShort) {
  Metrics metrics;
  metrics.rmse = 0.1 + 0.2;
  metrics.bias = 0.5;
  metrics.pixels = 12345678;
  const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  EXPECT_EQ(exactText(rmse, metrics), "0.30000000000000004");
  EXPECT_EQ(shownText(rmse, metrics), "0.3");
  EXPECT_EQ(shownText(metricInfo(&Metrics::bias), metrics), "+0.5");
  metrics.noise_floor = 0.4;
  EXPECT_EQ(shownText(rmse, metrics), "<0.4");
  EXPECT_EQ(exactText(rmse, metrics), "0.30000000000000004");
  EXPECT_EQ(shownText(metricInfo(&Metrics::flip), metrics), "0.0000") << "the floor is that of the RMSE";
  for (const MetricInfo& info : kMetrics) {
    if (info.key == "pixels") {
      EXPECT_EQ(exactText(info, metrics), "12345678");
    } else if (info.key == "noise_floor") {
      EXPECT_EQ(exactText(info, Metrics{}), "");
      EXPECT_EQ(shownText(info, Metrics{}), "-");
    }
  }
}

TEST(MetricTable, CommandLineSaysWhatEveryMetricMeans) {
  const std::string table = metricsTable(distinctMetrics()), help = metricsHelp();
  for (const MetricInfo& info : kMetrics) {
    EXPECT_NE(help.find(info.help), std::string::npos) << info.key;
    EXPECT_NE(help.find(info.key), std::string::npos) << info.key;
    if (info.kind != MetricKind::basis) {
      EXPECT_NE(table.find(labelWithUnit(info)), std::string::npos) << info.key;
      EXPECT_NE(table.find(info.help), std::string::npos) << info.key;
    }
  }
}

TEST(MetricTable, DocumentationHasItsLines) {
  std::ifstream file(std::string(test::kSourceDir) + "/docs/bench.md");
  const std::string documentation(std::istreambuf_iterator<char>(file), {});
  std::string lines;
  for (const MetricInfo& info : kMetrics)
    lines += "| `" + std::string(info.key) + "` | " + std::string(info.label) + " | " +
             std::string(info.help) + " |\n";
  EXPECT_NE(documentation.find(lines), std::string::npos) << "docs/bench.md should have\n" << lines;
}

}  // namespace
}  // namespace limn
