// The tables read by the names of their columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "core/bench/private/columns.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/misjudged_table.h"
#include "core/bench/report.h"
#include "core/image/metric_table.h"
#include "core/question/question_fields.h"
#include "core/render/frame_stats.h"
#include "tests/support/paths.h"
#include "tests/unit/bench/bench_rows.h"
#include "tests/unit/bench/csv.h"

namespace limn::bench {
namespace {

using test::csvRecords;
using test::exampleCase;
using test::exampleRow;
using test::withOtherFigures;

using NamedCells = std::map<std::string, std::string>;

/// The lines of a CSV, each by the names of its header.
std::vector<NamedCells> readCsv(const std::string& text) {
  const auto records = csvRecords(text);
  std::vector<NamedCells> rows;
  for (std::size_t i = 1; i < records.size(); ++i) {
    EXPECT_EQ(records[i].size(), records[0].size()) << "line " << i;
    NamedCells& row = rows.emplace_back();
    for (std::size_t k = 0; k < std::min(records[i].size(), records[0].size()); ++k)
      EXPECT_TRUE(row.emplace(records[0][k], records[i][k]).second) << records[0][k] << " stands twice";
  }
  return rows;
}

/// The first table of a Markdown text by the names of its header.
std::vector<NamedCells> readMarkdown(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("|")) continue;
    std::vector<std::string>& cells = lines.emplace_back();
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const std::size_t first = cell.find_first_not_of(' ');
      cells.push_back(
          first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
    }
  }
  std::vector<NamedCells> rows;
  for (std::size_t i = 2; i < lines.size(); ++i) {
    EXPECT_LE(lines[i].size(), lines[0].size());
    NamedCells& row = rows.emplace_back();
    for (std::size_t k = 0; k < lines[i].size(); ++k) row[lines[0][k]] = lines[i][k];
  }
  return rows;
}

Row distinctRow() {
  Row row = exampleRow(exampleCase());
  row.what.scene = "a \"scene\", quoted";
  row.what.light = "key";
  row.what.lightSize = 0.75;
  row.what.time = 1.5;
  row.what.title = "PCSS";
  row.what.timeWidth = 64;
  row.what.timeHeight = 48;
  row.penumbra->rmse = 0.5;
  row.penumbra->structured = 0.0625;
  row.cost.bound = BoundTime{.own = {3, 3, 3}, .bound = {2, 2, 2}, .turns = 3};
  return row;
}

Table tableOf(const std::vector<Row>& rows) {
  return makeTables(rows).front();
}

double number(const NamedCells& cells, const std::string& name) {
  return std::stod(cells.at(name));
}

TEST(BenchColumns, CsvSaysWhatWasAsked) {
  Row row = distinctRow();
  row.what.sigmaA = "1,2,3";
  const NamedCells cells = readCsv(toCsv(tableOf({row}))).at(0);
  const NamedCells expected = {{"scene", "a \"scene\", quoted"},
                               {"camera", "main"},
                               {"light", "key"},
                               {"light_size", "0.75"},
                               {"medium", describe(row.what, QuestionGroup::medium)},
                               {"changes", ""},
                               {"time_s", "1.5"},
                               {"term", "visibility"},
                               {"width", "32"},
                               {"height", "16"},
                               {"mode", "dynamic"},
                               {"renderer", "llvmpipe"},
                               {"technique", "pcss"},
                               {"parameters", "pcss.samples=16"},
                               {"time_width", "64"},
                               {"time_height", "48"},
                               {"failure", ""},
                               {"outdated", "false"}};
  for (const auto& [name, value] : expected) EXPECT_EQ(cells.at(name), value) << name;
}

TEST(BenchColumns, CsvHasErrorsAndCostInFullPrecision) {
  Row row = distinctRow();
  row.error.rmse = 0.1 + 0.2;
  row.cost.frameMs.q1 = 1 / 3.0;
  const NamedCells cells = readCsv(toCsv(tableOf({row}))).at(0);
  for (const MetricInfo& info : kMetrics) {
    const std::string& text = cells.at(std::string(info.key));
    const std::optional<double> value = metricValue(info, row.error);
    EXPECT_EQ(text.empty() ? std::nullopt : std::optional(std::stod(text)), value) << info.key;
  }
  EXPECT_EQ(cells.at("rmse"), "0.30000000000000004");
  EXPECT_EQ(cells.at("psnr"), "-inf");
  EXPECT_EQ(number(cells, "penumbra_rmse"), row.penumbra->rmse);
  EXPECT_EQ(number(cells, "penumbra_structured"), row.penumbra->structured);
  EXPECT_EQ(cells.at("umbra"), "200");
  EXPECT_EQ(cells.at("lit_in_umbra"), "10");
  EXPECT_EQ(cells.at("lit"), "100");
  EXPECT_EQ(cells.at("dark_in_light"), "1");
  const FrameTime& time = row.cost.frameMs;
  EXPECT_EQ(number(cells, "median_ms"), time.median);
  EXPECT_EQ(number(cells, "q1_ms"), time.q1);
  EXPECT_EQ(number(cells, "q3_ms"), time.q3);
  EXPECT_EQ(number(cells, "p99_ms"), render::quantile(time.samples, 0.99));
  EXPECT_EQ(cells.at("n"), "5");
  EXPECT_EQ(number(cells, "maps_ms"), row.cost.split.maps);
  EXPECT_EQ(number(cells, "filters_ms"), row.cost.split.filters);
  EXPECT_EQ(number(cells, "technique_ms"), row.cost.split.technique);
  for (const char* name : {"x_bound", "x_bound_low", "x_bound_high"})
    EXPECT_EQ(cells.at(name), "1.5") << name << ", of times that do not scatter";
  EXPECT_EQ(cells.at("memory_bytes"), "3145728");
  EXPECT_EQ(cells.at("reference_ms"), "") << "times of another size";
  row.what.timeWidth = row.what.timeHeight = 0;
  EXPECT_EQ(number(readCsv(toCsv(tableOf({row}))).at(0), "reference_ms"), referenceTime(row)->ms);
}

TEST(BenchColumns, CsvLeavesEmptyWhatIsNotKnown) {
  Row row = exampleRow(exampleCase());
  row.error.noise_floor.reset();
  row.penumbra.reset();
  row.misjudged.reset();
  row.cost.frameMs = {};
  const NamedCells cells = readCsv(toCsv(tableOf({row}))).at(0);
  for (const char* name :
       {"light_size", "noise_floor", "penumbra_rmse", "penumbra_structured", "umbra", "lit_in_umbra", "lit",
        "dark_in_light", "median_ms", "q1_ms", "q3_ms", "p99_ms", "reference_ms", "maps_ms", "filters_ms",
        "technique_ms", "x_bound", "x_bound_low", "x_bound_high"})
    EXPECT_EQ(cells.at(name), "") << name;
  EXPECT_EQ(cells.at("n"), "0");
  EXPECT_EQ(cells.at("time_width"), "32") << "that of the picture";
}

TEST(BenchColumns, FailedRowsSayWhatWasAskedAndWhy) {
  Row failed = distinctRow();
  failed.failure = "he said \"no\", twice";
  const Table table{.title = "", .fileName = "", .rows = {distinctRow(), failed}};
  const NamedCells cells = readCsv(toCsv(table)).at(1), answered = readCsv(toCsv(table)).at(0);
  for (const Column& column : columns()) {
    if (column.csv.empty() || column.csv == "failure") continue;
    EXPECT_EQ(cells.at(column.csv), column.failed ? answered.at(column.csv) : "") << column.csv;
  }
  EXPECT_EQ(cells.at("failure"), failed.failure);
  const NamedCells shown = readMarkdown(toMarkdown(table)).at(1);
  EXPECT_EQ(shown.at("technique"), "PCSS");
  EXPECT_TRUE(shown.at("RMSE").starts_with("failed: ")) << shown.at("RMSE");
}

TEST(BenchColumns, CsvMarksRowsOfAnotherProgram) {
  std::vector<Row> rows = {distinctRow(), distinctRow(), distinctRow()};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].what.parameters = {{"pcss.samples", std::to_string(i)}};
    rows[i].provenance.program = i == 1 ? "2" : "1";
    rows[i].line = i == 1 ? 3 : 1;
  }
  rows[2].failure = "lost";
  const std::vector<NamedCells> cells = readCsv(toCsv(tableOf(rows)));
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0].at("outdated"), "true");
  EXPECT_EQ(cells[1].at("outdated"), "false") << "the newest";
  EXPECT_EQ(cells[2].at("outdated"), "true") << "failed rows as well";
  EXPECT_EQ(csvRecords(toCsv(tableOf(rows)))[0].back(), "outdated") << "the columns before keep their places";
}

TEST(BenchColumns, MarkdownHasEveryColumnUnderItsHead) {
  const Row row = distinctRow();
  const Table table = tableOf({row});
  const NamedCells cells = readMarkdown(toMarkdown(table)).at(0);
  for (const Column& column : columns()) {
    if (column.markdown.empty()) continue;
    ASSERT_TRUE(cells.contains(column.markdown)) << column.markdown;
    EXPECT_EQ(cells.at(column.markdown), markdownText(column.shown(row, table))) << column.markdown;
  }
  EXPECT_EQ(cells.at("technique"), "PCSS");
  EXPECT_EQ(cells.at("penumbra RMSE"), "0.5");
  EXPECT_EQ(cells.at("lit in umbra %"), "5.00");
  EXPECT_EQ(cells.at("MiB"), "3.0");
}

TEST(BenchColumns, VisibilityAndBoundsHaveColumnsOfTheirOwn) {
  Row row = withOtherFigures(exampleRow(exampleCase("pcss", 64), 0.5, 5));  // no column says the same twice
  row.penumbra.reset();
  row.misjudged.reset();
  const NamedCells without = readMarkdown(toMarkdown(tableOf({row}))).at(0);
  const std::string text = toMarkdown(Table{.title = "", .fileName = "", .rows = {row, distinctRow()}});
  const std::vector<NamedCells> with = readMarkdown(text);
  ASSERT_EQ(with.size(), 2u);
  const size_t alike = text.find("In all rows:");  // a metric that neither row has is said there
  const std::string said =
      alike == std::string::npos ? "" : text.substr(alike, text.find('\n', alike) - alike);
  for (const Column& column : columns()) {
    if (column.markdown.empty()) continue;
    EXPECT_EQ(without.contains(column.markdown), column.known == nullptr) << column.markdown;
    if (column.known == nullptr) {
      EXPECT_TRUE(with[0].contains(column.markdown) ||
                  said.find(' ' + column.markdown + ' ') != std::string::npos)
          << column.markdown;
      continue;
    }
    ASSERT_TRUE(with[0].contains(column.markdown)) << column.markdown;
    const auto unknown = [&](const NamedCells& cells) { return cells.at(column.markdown) == "-"; };
    EXPECT_EQ(std::ranges::count_if(with, unknown), 1) << column.markdown;
  }
  EXPECT_FALSE(without.contains("x bound"));
  const NamedCells visible = readMarkdown(toMarkdown(tableOf({exampleRow(exampleCase())}))).at(0);
  EXPECT_TRUE(visible.contains("penumbra RMSE"));
  EXPECT_FALSE(visible.contains("x bound"));
}

TEST(BenchColumns, XBoundIsTheRatioOfMediansWithItsInterval) {
  const BoundTime time{.own = {9, 3, 4, 3, 3, 5}, .bound = {2, 1, 2, 3, 2, 2}, .turns = 2};
  const Ratio ratio = xBound(time);
  EXPECT_DOUBLE_EQ(ratio.value, 3.5 / 2);
  EXPECT_LE(ratio.low, ratio.value);
  EXPECT_GE(ratio.high, ratio.value);
  EXPECT_LT(ratio.low, ratio.high);
  // Twice the time of the technique is twice the ratio, at the same scatter.
  BoundTime twice = time;
  for (double& ms : twice.own) ms *= 2;
  EXPECT_DOUBLE_EQ(xBound(twice).value, 2 * ratio.value);
  EXPECT_DOUBLE_EQ(xBound(twice).low, 2 * ratio.low);
  EXPECT_DOUBLE_EQ(xBound(twice).high, 2 * ratio.high);
  // A technique that is its bound is at 1.
  EXPECT_DOUBLE_EQ(xBound({.own = time.bound, .bound = time.bound, .turns = 2}).value, 1);
}

TEST(BenchColumns, XBoundOfOneTurnHasNoInterval) {
  Row row = distinctRow();
  row.cost.bound->turns = 1;
  const Table table = tableOf({row});
  EXPECT_EQ(readMarkdown(toMarkdown(table)).at(0).at("x bound"), "1.50 (n = 1)");
  const NamedCells cells = readCsv(toCsv(table)).at(0);
  EXPECT_EQ(cells.at("x_bound"), "1.5");
  EXPECT_EQ(cells.at("x_bound_low"), "");
  EXPECT_EQ(cells.at("x_bound_high"), "");
}

TEST(BenchColumns, XBoundIsOnThePageWhereARowHasIt) {
  const Row rows[] = {exampleRow(exampleCase()), distinctRow()};
  const nlohmann::json page = nlohmann::json::parse(reportData(rows, ".").json);
  EXPECT_EQ(page["columns"]["x_bound"]["label"], "x bound");
  int with = 0;
  for (const auto& table : page["tables"])
    for (const auto& row : table["rows"]) {
      if (!row.contains("x_bound")) continue;
      ++with;
      EXPECT_EQ(row["x_bound"], (nlohmann::json{{"value", 1.5}, {"low", 1.5}, {"high", 1.5}, {"turns", 3}}));
    }
  EXPECT_EQ(with, 1);
}

TEST(BenchColumns, EveryColumnIsDescribedAndHasItsCells) {
  std::set<std::string> csv, markdown;
  for (const Column& column : columns()) {
    EXPECT_FALSE(column.csv.empty() && column.markdown.empty()) << column.help;
    EXPECT_TRUE(column.csv.empty() || column.exact) << column.csv;
    EXPECT_TRUE(column.markdown.empty() || column.shown) << column.markdown;
    EXPECT_FALSE(column.help.empty()) << column.csv << column.markdown;
    if (!column.csv.empty()) {
      EXPECT_TRUE(csv.insert(column.csv).second) << column.csv;
    }
    if (!column.markdown.empty()) {
      EXPECT_TRUE(markdown.insert(column.markdown).second) << column.markdown;
    }
  }
}

TEST(BenchColumns, EveryMetricIsInTheTablesAndOnThePage) {
  const nlohmann::json page = nlohmann::json::parse(reportData({}, ".").json);
  std::set<std::string> onPage;
  for (const auto& metric : page["metrics"]) {
    onPage.insert(metric["key"].get<std::string>());
    EXPECT_FALSE(metric["label"].get<std::string>().empty()) << metric;
    EXPECT_FALSE(metric["help"].get<std::string>().empty()) << metric;
  }
  for (const MetricInfo& info : kMetrics) {
    const auto column = std::ranges::find(columns(), std::string(info.key), &Column::csv);
    ASSERT_NE(column, columns().end()) << info.key;
    EXPECT_EQ(column->markdown, info.head);
    const bool error = info.kind == MetricKind::error || info.kind == MetricKind::deviation;
    EXPECT_EQ(onPage.contains(std::string(info.key)), error) << info.key;
  }
  for (const MetricInfo* info : kCompared)
    EXPECT_TRUE(onPage.contains("penumbra_" + std::string(info->key))) << info->key;
  for (const MisjudgedInfo& info : kMisjudged) EXPECT_TRUE(onPage.contains(info.key)) << info.key;
  for (const Column& column : columns())
    if (!column.markdown.empty()) {
      EXPECT_EQ(page["columns"][column.csv.empty() ? column.markdown : column.csv]["label"], column.markdown);
    }
}

TEST(BenchColumns, DocumentationHasTheirLines) {
  std::ifstream file(std::string(limn::test::kSourceDir) + "/docs/bench.md");
  const std::string documentation(std::istreambuf_iterator<char>(file), {});
  std::string lines;
  for (const Column& column : columns())
    lines += (column.csv.empty() ? "| " : "| `" + column.csv + "` ") + "| " +
             (column.markdown.empty() ? "" : column.markdown + " ") + "| " + column.help + " |\n";
  EXPECT_NE(documentation.find(lines), std::string::npos) << "docs/bench.md should have\n" << lines;
}

}  // namespace
}  // namespace limn::bench
