#include "core/bench/private/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/bench/private/markdown.h"
#include "core/question/question_fields.h"
#include "core/question/technique_names.h"

namespace limn::bench {
namespace {

using Cells = std::vector<std::string>;

/// The row that is shown, and how much slower than another it is: of the frame and of its shadows.
Cells ratioCells(const Table& table, const Row& shown, const Row& slow, const Row& fast) {
  return {markedName(shown, table), measuredText(frameRatio(slow, fast)), shadowRatio(slow, fast)};
}

void appendAtEqual(Cells& cells, const Table& table, const Row* row, const Row& against) {
  const Cells more = row == nullptr ? Cells{"none", "-", "-"} : ratioCells(table, *row, *row, against);
  cells.insert(cells.end(), more.begin(), more.end());
}

}  // namespace

double shadowMs(const Row& row) {
  return row.cost.split.maps + row.cost.split.filters + row.cost.split.technique;
}

const Metrics& errorOf(const Row& row) {
  return row.penumbra ? *row.penumbra : row.error;
}

const Row* baselineOf(const Table& table) {
  const Row* first = nullptr;
  for (const Row& row : table.rows) {
    if (!row.what.baseline || !isTimed(row)) continue;
    if (!isOutdated(row, table)) return &row;
    if (first == nullptr) first = &row;
  }
  return first;
}

std::vector<double> samplesOf(const FrameTime& time) {
  return time.samples.empty() ? std::vector<double>{time.median} : time.samples;
}

Ratio frameRatio(const Row& slow, const Row& fast) {
  const FrameTime &a = slow.cost.frameMs, &b = fast.cost.frameMs;
  const std::vector<double> above = samplesOf(a), below = samplesOf(b);
  return ratioOfMedians({above, a.turns}, {below, b.turns});
}

Ratio xBound(const BoundTime& time) {
  return ratioOfMedians({time.own, time.turns}, {time.bound, time.turns});
}

std::string shadowRatio(const Row& slow, const Row& fast) {
  const double shadow = shadowMs(fast);
  return shadow > 0 ? ratioText(shadowMs(slow) / shadow) : "-";
}

std::string ratioText(double ratio) {
  return fmt::format("{:.2f}", ratio);
}

std::string ratioText(const Ratio& ratio, int digits) {
  return fmt::format("{0:.{3}f} ({1:.{3}f} to {2:.{3}f})", ratio.value, ratio.low, ratio.high, digits);
}

std::string measuredText(const Ratio& ratio) {
  return ratio.turns < kFewestTurns ? fmt::format("{} (n = {})", ratioText(ratio.value), ratio.turns)
                                    : ratioText(ratio);
}

const Row* quickest(const Table& table, const std::string& technique, const MetricInfo& error,
                    const Row& against) {
  const std::optional<double> limit = boundedError(error, errorOf(against));
  // The error of a penumbra stands beside none of a whole picture, in which lit pixels hide it.
  const auto isAsGood = [&](const Row& row) {
    return row.penumbra.has_value() == against.penumbra.has_value() &&
           boundedError(error, errorOf(row)) <= limit;
  };
  const auto order = [&](const Row& row) {
    return std::pair(isOutdated(row, table), row.cost.frameMs.median);
  };
  const Row* best = nullptr;
  for (const Row& row : table.rows) {
    if (!isTimed(row) || row.what.technique != technique || !isAsGood(row)) continue;
    if (best == nullptr || order(row) < order(*best)) best = &row;
  }
  return best;
}

std::optional<ReferenceTime> referenceTime(const Row& row) {
  const Metrics& e = row.error;
  if (!isTimed(row) || !row.cost.software || row.what.timeWidth > 0 || row.what.aa > 1 ||
      row.cost.framesPerPicture > 1 || !row.referenceSeconds || !e.noise_floor || *e.noise_floor <= 0)
    return std::nullopt;
  const double sigma = *e.noise_floor / 3, ms = 1000 * *row.referenceSeconds;
  const double least = 0.25 * sigma * sigma, own = e.rmse * e.rmse - sigma * sigma;
  return ReferenceTime{ms * sigma * sigma / std::max(own, least), own < least};
}

std::string rowName(const Row& row) {
  return row.what.title.empty() ? settingsName(row) : row.what.title;
}

std::string markedName(const Row& row, const Table& table) {
  return isOutdated(row, table) ? rowName(row) + kOutdatedMark : rowName(row);
}

std::string settingsName(const Row& row) {
  std::string name = row.what.technique;
  for (const auto& [parameter, value] : row.what.parameters)
    name += fmt::format(" {}={}", shortParameter(row.what.technique, parameter), value);
  const std::string lights = describeEnvironmentLights(row.what);
  return lights.empty() ? name : fmt::format("{}, environment lights {}", name, lights);
}

std::string comparisonMarkdown(const Table& table) {
  const std::vector<Row>& rows = table.rows;
  const Row* baseline = baselineOf(table);
  if (baseline == nullptr) return "";
  const std::string& technique = baseline->what.technique;
  const auto other = [&](const Row& row) { return isTimed(row) && row.what.technique != technique; };
  std::string text = fmt::format(
      "\nTimes of {} as multiples of each row's (frame, with its 95 % interval; n = 1: one turn, no interval "
      "| shadows, of one turn: maps, filters and the technique's passes)",
      markdownText(markedName(*baseline, table)));
  if (std::ranges::none_of(rows, other)) {  // settings of one technique
    text += ":\n\n" + markdownHead({{"settings", Align::left}, {"frame"}, {"shadows"}});
    for (const Row& row : rows)
      if (isTimed(row) && &row != baseline) text += markdownRow(ratioCells(table, row, *baseline, row));
    return text;
  }
  std::vector<MarkdownHead> heads = {{"technique", Align::left}, {"frame"}, {"shadows"}};
  text += fmt::format(", and of the quickest {} whose", markdownText(technique));
  for (const MetricInfo* error : kCompared) {
    text += fmt::format("{} {},", error == kCompared[0] ? "" : " and whose", error->label);
    heads.push_back({fmt::format("{} at equal {}", markdownText(technique), error->label), Align::left});
    for (const char* ratio : {"frame", "shadows"}) heads.push_back({ratio});
  }
  text += fmt::format(" is not above the row's{}:\n\n{}", baseline->penumbra ? " in the penumbra" : "",
                      markdownHead(heads));
  for (const Row& row : rows) {
    if (!other(row)) continue;
    Cells cells = ratioCells(table, row, *baseline, row);
    for (const MetricInfo* error : kCompared)
      appendAtEqual(cells, table, quickest(table, technique, *error, row), row);
    text += markdownRow(cells);
  }
  return text;
}

}  // namespace limn::bench
