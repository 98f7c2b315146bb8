#include "core/bench/comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/bench/markdown.h"
#include "core/bench/ratio.h"

namespace limn::bench {
namespace {

/// The quickest of the technique's rows that is not above `limit`.
template <class Error>
const Row* quickest(std::span<const Row> rows, const std::string& technique, double limit, Error error) {
  const Row* best = nullptr;
  for (const Row& row : rows) {
    if (!isTimed(row) || row.what.technique != technique || error(row) > limit) continue;
    if (best == nullptr || row.cost.frameMs.median < best->cost.frameMs.median) best = &row;
  }
  return best;
}

using Cells = std::vector<std::string>;

/// The row that is shown, and how much slower than another it is: of the frame and of its shadows.
Cells ratioCells(const Row& shown, const Row& slow, const Row& fast) {
  const double shadow = shadowMs(fast);
  return {rowName(shown), frameRatio(slow, fast),
          shadow > 0 ? fmt::format("{:.2f}", shadowMs(slow) / shadow) : "-"};
}

void appendAtEqual(Cells& cells, const Row* row, const Row& against) {
  const Cells more = row == nullptr ? Cells{"none", "-", "-"} : ratioCells(*row, *row, against);
  cells.insert(cells.end(), more.begin(), more.end());
}

}  // namespace

double shadowMs(const Row& row) {
  return row.cost.split.maps + row.cost.split.filters + row.cost.split.technique;
}

const Metrics& errorOf(const Row& row) {
  return row.penumbra ? *row.penumbra : row.error;
}

std::string frameRatio(const Row& slow, const Row& fast) {
  const FrameTime &a = slow.cost.frameMs, &b = fast.cost.frameMs;
  if (a.samples.empty() || b.samples.empty()) return fmt::format("{:.2f}", a.median / b.median);
  const Ratio ratio = ratioOfMedians({a.samples, a.turns}, {b.samples, b.turns});
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", ratio.value, ratio.low, ratio.high);
}

std::optional<ReferenceTime> referenceTime(const Row& row) {
  const Metrics& e = row.error;
  if (!isTimed(row) || row.what.timeWidth > 0 || !row.referenceSeconds || !e.noise_floor ||
      *e.noise_floor <= 0)
    return std::nullopt;
  const double sigma = *e.noise_floor / 3, ms = 1000 * *row.referenceSeconds;
  const double least = 0.25 * sigma * sigma, own = e.rmse * e.rmse - sigma * sigma;
  return ReferenceTime{ms * sigma * sigma / std::max(own, least), own < least};
}

std::string rowName(const Row& row) {
  std::string name = row.what.title.empty() ? row.what.technique : row.what.title;
  if (!row.what.title.empty()) return name;
  for (const auto& [parameter, value] : row.what.parameters) {
    const std::string prefix = row.what.technique + ".";
    const bool own = parameter.compare(0, prefix.size(), prefix) == 0;
    name += fmt::format(" {}={}", own ? parameter.substr(prefix.size()) : parameter, value);
  }
  return name;
}

std::string comparisonMarkdown(std::span<const Row> rows) {
  const auto baseline =
      std::ranges::find_if(rows, [](const Row& row) { return row.what.baseline && isTimed(row); });
  if (baseline == rows.end()) return "";
  const std::string& technique = baseline->what.technique;
  const auto other = [&](const Row& row) { return isTimed(row) && row.what.technique != technique; };
  std::string text = fmt::format(
      "\nTimes of {} as multiples of each row's (frame, with the 95 % interval of the samples | shadows: "
      "maps, "
      "filters and the technique's passes)",
      markdownText(rowName(*baseline)));
  if (std::ranges::none_of(rows, other)) {  // settings of one technique
    text += ":\n\n| settings | frame | shadows |\n|---|--:|--:|\n";
    for (const Row& row : rows)
      if (isTimed(row) && &row != &*baseline) text += markdownRow(ratioCells(row, *baseline, row));
    return text;
  }
  text += fmt::format(
      ", and of the quickest {0} whose RMSE, and whose structured error, is not above the row's{1}:\n\n"
      "| technique | frame | shadows | {0} at equal RMSE | frame | shadows | {0} at equal structured error | "
      "frame | shadows |\n|---|--:|--:|---|--:|--:|---|--:|--:|\n",
      markdownText(technique), baseline->penumbra ? " in the penumbra" : "");
  for (const Row& row : rows) {
    if (!other(row)) continue;
    const Row* equalRmse =
        quickest(rows, technique, errorOf(row).rmse, [](const Row& r) { return errorOf(r).rmse; });
    const Row* equalStructured = quickest(rows, technique, errorOf(row).structured,
                                          [](const Row& r) { return errorOf(r).structured; });
    Cells cells = ratioCells(row, *baseline, row);
    appendAtEqual(cells, equalRmse, row);
    appendAtEqual(cells, equalStructured, row);
    text += markdownRow(cells);
  }
  return text;
}

}  // namespace limn::bench
