#include "core/bench/regression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/bench/private/comparison.h"
#include "core/bench/private/markdown.h"

namespace limn::bench {
namespace {

/// By how much the mean squared errors may differ by chance.
double noiseOfDifference(const Metrics& a, const Metrics& b) {
  const double sigma = std::max(a.noise_floor.value_or(0), b.noise_floor.value_or(0)) / 3;
  const auto pixels = static_cast<double>(std::max<std::size_t>(1, std::min(a.pixels, b.pixels)));
  const double rounding = 1e-6 * (a.rmse * a.rmse + b.rmse * b.rmse);
  return 3 * 2 * sigma * (a.rmse + b.rmse + sigma) / std::sqrt(pixels) + rounding;
}

void compareErrors(const Row& before, const Row& now, Change& change) {
  // The error of a penumbra stands beside none of a whole picture.
  const bool penumbra = before.penumbra && now.penumbra;
  const Metrics &a = penumbra ? *before.penumbra : before.error, &b = penumbra ? *now.penumbra : now.error;
  change.errorBefore = a.rmse;
  change.error = b.rmse;
  change.otherReference = !mayBeEqual(before.referenceFile, now.referenceFile);
  // Another reference has other noise, of which an error below its floor may consist.
  const double floors = std::max(a.noise_floor.value_or(0), b.noise_floor.value_or(0)),
               least = change.otherReference ? floors : 0;
  const double growth = b.rmse * b.rmse - a.rmse * a.rmse, noise = noiseOfDifference(a, b);
  change.worse = growth > noise && b.rmse > least;
  change.better = -growth > noise && a.rmse > least;
}

Change compareRows(const Row& before, const Row& now, const RegressionOptions& options) {
  Change change;
  change.label = label(now.what);
  change.failure = now.failure;
  const std::string &then = before.provenance.scene, &files = now.provenance.scene;
  change.otherFiles = !mayBeEqual(then, files);
  if (!now.failure.empty()) return change;
  compareErrors(before, now, change);
  const std::string &there = before.cost.machine, &here = now.cost.machine;
  change.elsewhere = !there.empty() && !here.empty() && there != here;
  if (change.elsewhere) return change;
  const FrameTime &earlier = before.cost.frameMs, &later = now.cost.frameMs;
  if (earlier.samples.empty() || later.samples.empty()) return change;
  change.oneFrame = earlier.samples.size() == 1 || later.samples.size() == 1;
  if (change.oneFrame) return change;
  change.time = ratioOfMedians({later.samples, later.turns}, {earlier.samples, earlier.turns});
  change.slower = change.time.low > 1 + options.drift;
  change.faster = change.time.high < 1 / (1 + options.drift);
  return change;
}

std::string verdict(const Change& change) {
  if (!change.failure.empty()) return "failed: " + change.failure;
  std::string text;
  const auto add = [&](bool holds, const char* word) {
    if (holds) text += fmt::format("{}{}", text.empty() ? "" : ", ", word);
  };
  add(change.slower, "slower");
  add(change.worse, "worse");
  add(change.faster, "faster");
  add(change.better, "better");
  add(change.otherFiles && !text.empty(), "the scene has changed");
  add(change.otherReference && !text.empty(), "the reference has changed");
  return text;
}

std::vector<MarkdownColumn<Change>> changeColumns() {
  return {{{"case", Align::left}, [](const Change& c) { return c.label; }},
          {{"time, now / before (95 %)"},
           [](const Change& c) { return c.time.value > 0 ? ratioText(c.time, 3) : "-"; }},
          {{fmt::format("{} before", metricInfo(&Metrics::rmse).label)},
           [](const Change& c) { return fmt::format("{:.4g}", c.errorBefore); }},
          {{"now"}, [](const Change& c) { return fmt::format("{:.4g}", c.error); }},
          {{"", Align::left}, verdict}};
}

bool regressed(const Change& change) {
  return change.slower || change.worse || !change.failure.empty();
}

}  // namespace

bool Regression::found() const {
  return std::ranges::any_of(changes, regressed);
}

Regression compareResults(std::span<const Row> before, std::span<const Row> now,
                          const RegressionOptions& options) {
  std::map<std::string, const Row*> known;
  for (const Row& row : before)
    if (row.failure.empty()) known.emplace(row.key, &row);
  Regression result;
  for (const Row& row : now) {
    const auto partner = known.find(row.key);
    if (partner == known.end()) {
      ++result.onlyNow;
    } else {
      result.changes.push_back(compareRows(*partner->second, row, options));
    }
  }
  result.onlyBefore = known.size() - result.changes.size();
  return result;
}

std::string toMarkdown(const Regression& regression) {
  const auto count = [&](bool Change::*flag) { return std::ranges::count(regression.changes, true, flag); };
  const auto failed =
      std::ranges::count_if(regression.changes, [](const Change& c) { return !c.failure.empty(); });
  std::string text = fmt::format(
      "{} rows compared: {} slower, {} worse, {} failed, {} faster, {} better; {} only before, {} only now",
      regression.changes.size(), count(&Change::slower), count(&Change::worse), failed,
      count(&Change::faster), count(&Change::better), regression.onlyBefore, regression.onlyNow);
  if (const auto elsewhere = count(&Change::elsewhere); elsewhere > 0)
    text += fmt::format("; times of {} not compared, which two machines measured", elsewhere);
  if (const auto single = count(&Change::oneFrame); single > 0)
    text += fmt::format("; times of {} not compared, of which one frame was timed", single);
  if (const auto others = count(&Change::otherFiles); others > 0)
    text += fmt::format("; the scenes of {} have changed in between", others);
  if (const auto others = count(&Change::otherReference); others > 0)
    text += fmt::format("; the references of {} have changed in between", others);
  text += "\n";
  std::vector<Change> shown;
  std::ranges::copy_if(regression.changes, std::back_inserter(shown),
                       [](const Change& change) { return !verdict(change).empty(); });
  if (shown.empty()) return text;
  return text + "\n" + markdownTable(changeColumns(), shown);
}

}  // namespace limn::bench
