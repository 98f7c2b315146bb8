#include "core/bench/private/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "core/bench/private/comparison.h"
#include "core/bench/private/misjudged_table.h"
#include "core/image/metric_table.h"
#include "core/question/question_fields.h"
#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

using Columns = std::vector<Column>;

/// The cell of a function of the row alone.
template <class Function>
Cell cell(Function function) {
  return [function](const Row& row, const Table&) { return fmt::format("{}", function(row)); };
}

/// A column of CSV alone that says what was asked.
template <class Function>
Column question(const char* csv, const char* help, Function function) {
  return {csv, "", help, cell(function), {}, Align::left, true};
}

std::string parameterText(const Case& c) {
  std::string text;
  for (const auto& [name, value] : c.parameters)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  if (c.environmentLights > 0)
    text +=
        fmt::format("{}environment lights {} of {}^2 {} {}", text.empty() ? "" : ", ", c.environmentLights,
                    c.environmentResolution, c.environmentShape, c.environmentReflection);
  if (c.environmentLights > 0 && c.environmentCombine != "add") text += " by " + c.environmentCombine;
  return text;
}

Columns questionColumns() {
  return {
      question("scene", "the scene", [](const Row& r) { return r.what.scene; }),
      question("camera", "the camera; empty: the scene's first", [](const Row& r) { return r.what.camera; }),
      question("light", "the light; empty: all of them", [](const Row& r) { return r.what.light; }),
      question("light_size", "diameter or side of the light where the suite sets it",
               [](const Row& r) {
                 return r.what.lightSize > 0 ? fmt::format("{}", r.what.lightSize) : std::string();
               }),
      question("medium", "what the suite changes of the medium",
               [](const Row& r) { return describe(r.what, QuestionGroup::medium); }),
      question("changes", "what the suite changes of the scene",
               [](const Row& r) { return describe(r.what, QuestionGroup::changes); }),
      question("time_s", "time of the animation, seconds", [](const Row& r) { return r.what.time; }),
      question("term", "the term of the picture", [](const Row& r) { return r.what.term; }),
      question("width", "width of the picture, pixels", [](const Row& r) { return r.what.width; }),
      question("height", "height of the picture, pixels", [](const Row& r) { return r.what.height; }),
      question("mode", "`dynamic`: timed frames compute everything; `static`: they keep what they can",
               [](const Row& r) { return r.what.dynamic ? "dynamic" : "static"; }),
      question("renderer", "what OpenGL calls the renderer", [](const Row& r) { return r.cost.renderer; }),
      {"technique", "technique", "the technique; tables for people show its label where the suite gives one",
       cell([](const Row& r) { return r.what.technique; }),
       cell([](const Row& r) { return r.what.title.empty() ? r.what.technique : r.what.title; }), Align::left,
       true},
      {"parameters", "parameters", "the parameters that the suite sets",
       cell([](const Row& r) { return parameterText(r.what); }),
       cell([](const Row& r) { return parameterText(r.what); }), Align::left, true},
  };
}

void appendMetrics(Columns& columns) {
  for (const MetricInfo& info : kMetrics)
    columns.push_back({std::string(info.key), std::string(info.head), std::string(info.help),
                       cell([&info](const Row& r) { return exactText(info, r.error); }),
                       cell([&info](const Row& r) { return shownText(info, r.error); })});
}

std::string percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? "-"
                    : fmt::format("{:.2f}", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

Cell pixels(std::size_t Misjudged::*member) {
  return cell([member](const Row& r) {
    return r.misjudged ? fmt::format("{}", (*r.misjudged).*member) : std::string();
  });
}

bool knowsVisibility(const Row& row) {
  return row.penumbra || row.misjudged;
}

void appendVisibility(Columns& columns) {
  for (const MetricInfo* info : kCompared) {
    Column column{fmt::format("penumbra_{}", info->key), "",
                  fmt::format("`{}` over the pixels of the penumbra", info->key), cell([info](const Row& r) {
                    return r.penumbra ? exactText(*info, *r.penumbra) : std::string();
                  })};
    if (info == kCompared[0]) {  // one is enough for people
      column.markdown = fmt::format("penumbra {}", info->head);
      column.shown = cell(
          [info](const Row& r) { return r.penumbra ? shownText(*info, *r.penumbra) : std::string("-"); });
    }
    column.known = knowsVisibility;
    columns.push_back(column);
  }
  for (const MisjudgedInfo& info : kMisjudged) {
    columns.push_back({info.wholeKey, "", info.wholeHelp, pixels(info.whole)});
    Column column{info.key, info.head,
                  fmt::format("{}; tables for people show their share of `{}`", info.help, info.wholeKey),
                  pixels(info.part), cell([&info](const Row& r) {
                    const Misjudged m = r.misjudged.value_or(Misjudged{});
                    return percent(m.*info.part, m.*info.whole);
                  })};
    column.known = knowsVisibility;
    columns.push_back(column);
  }
}

/// A number that timed rows have. `format` is that of Markdown.
template <class Function>
Column timed(const char* csv, const char* markdown, const char* help, const char* format, Function value) {
  return {csv, markdown, help,
          cell([value](const Row& r) { return isTimed(r) ? fmt::format("{}", value(r)) : std::string(); }),
          cell([value, format](const Row& r) {
            return isTimed(r) ? fmt::format(fmt::runtime(format), value(r)) : std::string("-");
          })};
}

double tail(const FrameTime& time) {
  return render::quantile(time.samples, 0.99);
}

std::string referenceTimeText(const Row& row) {
  const std::optional<ReferenceTime> time = referenceTime(row);
  return time ? fmt::format("{}{:.4g}", time->atLeast ? ">" : "", time->ms) : "-";
}

/// Nobody is at least as good in both error and time, and better in one. Errors below the noise are alike.
bool onParetoFront(const Row& row, std::span<const Row> rows) {
  if (!isTimed(row)) return false;
  constexpr const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  return std::none_of(rows.begin(), rows.end(), [&](const Row& other) {
    if (!isTimed(other)) return false;
    const double de = *boundedError(rmse, other.error) - *boundedError(rmse, row.error),
                 dt = other.cost.frameMs.median - row.cost.frameMs.median;
    return de <= 0 && dt <= 0 && (de < 0 || dt < 0);
  });
}

Columns timeColumns() {
  return {
      {"time_width", "", "width of the timed frames, pixels",
       cell([](const Row& r) { return r.what.timeWidth > 0 ? r.what.timeWidth : r.what.width; })},
      {"time_height", "", "height of the timed frames, pixels",
       cell([](const Row& r) { return r.what.timeWidth > 0 ? r.what.timeHeight : r.what.height; })},
      timed("median_ms", kFrameTime.head, "median time of a frame, milliseconds", kFrameTime.format,
            [](const Row& r) { return r.cost.frameMs.median; }),
      timed("q1_ms", "q1", "lower quartile of the time of a frame, milliseconds", kFrameTime.format,
            [](const Row& r) { return r.cost.frameMs.q1; }),
      timed("q3_ms", "q3", "upper quartile of the time of a frame, milliseconds", kFrameTime.format,
            [](const Row& r) { return r.cost.frameMs.q3; }),
      {"p99_ms", "p99 / median",
       "99th percentile of the time of a frame, milliseconds or over the median: stalls show here, not in "
       "the "
       "quartiles",
       cell([](const Row& r) {
         const FrameTime& t = r.cost.frameMs;
         return t.samples.empty() ? std::string() : fmt::format("{}", tail(t));
       }),
       cell([](const Row& r) {
         const FrameTime& t = r.cost.frameMs;
         return !isTimed(r) || t.samples.empty() ? "-" : fmt::format("{:.2f}", tail(t) / t.median);
       })},
      {"n", "n", "number of timed frames", cell([](const Row& r) { return r.cost.frameMs.n; }),
       cell([](const Row& r) { return r.cost.frameMs.n; })},
      timed("", "fps", "frames per second, of the median", "{:.1f}",
            [](const Row& r) { return 1000 / r.cost.frameMs.median; }),
      {"reference_ms", "reference ms",
       "time that the reference's own method takes for the row's RMSE, on the same processor",
       cell([](const Row& r) {
         const std::optional<ReferenceTime> time = referenceTime(r);
         return time ? fmt::format("{}", time->ms) : std::string();
       }),
       cell(referenceTimeText)},
  };
}

bool knowsBound(const Row& row) {
  return row.cost.bound.has_value();
}

/// A column of CSV with the ratio or one end of its interval, of rows with `turns` turns or more.
Column boundColumn(const char* csv, const char* help, double Ratio::*part, int turns) {
  return {csv, "", help, cell([part, turns](const Row& r) {
            const Ratio ratio = knowsBound(r) ? xBound(*r.cost.bound) : Ratio{.turns = 0};
            return ratio.turns < turns ? std::string() : fmt::format("{}", ratio.*part);
          })};
}

Columns boundColumns() {
  Column column = boundColumn("x_bound",
                              "how many times as long the technique's own passes take as the least kernel "
                              "with the same fetches and decisions",
                              &Ratio::value, 1);
  column.markdown = "x bound";
  column.shown = cell(
      [](const Row& r) { return knowsBound(r) ? measuredText(xBound(*r.cost.bound)) : std::string("-"); });
  column.known = knowsBound;
  return {column,
          boundColumn("x_bound_low", "lower end of its interval of 95 %; empty with one turn", &Ratio::low,
                      kFewestTurns),
          boundColumn("x_bound_high", "upper end of the same", &Ratio::high, kFewestTurns)};
}

Columns costColumns() {
  return {
      timed("maps_ms", "maps ms", "part of the frame that draws the scene into maps, milliseconds", "{:.2f}",
            [](const Row& r) { return r.cost.split.maps; }),
      timed("filters_ms", "filters ms", "part of the frame that filters maps, milliseconds", "{:.2f}",
            [](const Row& r) { return r.cost.split.filters; }),
      timed("technique_ms", "technique ms", "part of the frame in the technique's own passes, milliseconds",
            "{:.2f}", [](const Row& r) { return r.cost.split.technique; }),
      {"memory_bytes", kMemory.head, "GPU memory of the frame, bytes or MiB",
       cell([](const Row& r) { return r.cost.memoryBytes; }), cell([](const Row& r) {
         return isTimed(r) ? shownText(kMemory, static_cast<double>(r.cost.memoryBytes)) : "-";
       })},
      {"",
       "front",
       "a star on the Pareto front of time and error: the RMSE, or the page's choice",
       {},
       [](const Row& row, const Table& table) { return onParetoFront(row, table.rows) ? "*" : ""; },
       Align::centre},
      {"failure",
       "",
       "why there is no picture; empty where there is one",
       cell([](const Row& r) { return r.failure; }),
       {},
       Align::left,
       true},
      {"outdated",
       "",
       "whether the row was measured with another version of the program, of a technique or of the scene "
       "than the table's newest; `true` or `false`",
       [](const Row& row, const Table& table) { return fmt::format("{}", isOutdated(row, table)); },
       {},
       Align::left,
       true},
  };
}

Columns makeColumns() {
  Columns all = questionColumns();
  appendMetrics(all);
  appendVisibility(all);
  for (Columns more : {timeColumns(), boundColumns(), costColumns()})
    std::ranges::move(more, std::back_inserter(all));
  return all;
}

}  // namespace

std::string shownText(const Quantity& quantity, double stored) {
  return fmt::format(fmt::runtime(quantity.format), stored / quantity.unit);
}

std::string headOf(std::string_view csv) {
  const auto found = std::ranges::find(columns(), csv, &Column::csv);
  if (found == columns().end()) throw std::logic_error(fmt::format("no table has the column {}", csv));
  return found->markdown.empty() ? found->csv : found->markdown;
}

std::span<const Column> columns() {
  static const Columns all = makeColumns();
  return all;
}

}  // namespace limn::bench
