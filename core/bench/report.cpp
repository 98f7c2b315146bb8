#include "core/bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_depth.h"
#include "core/bench/private/columns.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/misjudged_table.h"
#include "core/bench/private/report_pictures.h"
#include "core/bench/private/table_texts.h"
#include "core/bench/tables.h"
#include "core/gpu/shader_source.h"
#include "core/question/question_fields.h"
#include "core/question/render_command.h"
#include "core/render/frame_stats.h"

namespace limn::bench {

/// page.html of benchmarks/report/ with its style and its script, compiled in; {{data}} is where the rows go,
/// {{pictures}} where the pictures go.
std::span<const gpu::EmbeddedSource> reportSources();

namespace {

using Json = nlohmann::ordered_json;

constexpr int kWindows = 2;

/// The part of a row's JSON that the page reads as it is.
Json known(const Json& json, const char* key) {
  return json.contains(key) ? json[key] : Json();
}

Json passes(const Json& stats) {
  Json list = Json::array();
  for (const Json& pass : stats.value("passes", Json::array())) {
    if (!pass.is_object()) continue;
    list.push_back(
        {{"name", known(pass, "name")},
         {"technique", known(pass, "technique")},
         {"state", known(pass, "state")},
         {"ms", pass.contains("ms") && pass["ms"].is_object() ? known(pass["ms"], "median") : Json()}});
  }
  return list;
}

/// How many times as long the baseline's frame takes as the row's, with its interval and turns.
Json timesAsFast(const Row* baseline, const Row& row) {
  if (baseline == nullptr || !isTimed(row)) return {};
  const Ratio ratio = frameRatio(*baseline, row);
  return {{"value", ratio.value}, {"low", ratio.low}, {"high", ratio.high}, {"turns", ratio.turns}};
}

Json pictureJson(const std::string& file, EmbeddedPictures& pictures) {
  return {{"thumbnail", pictures.thumbnail(file)}, {"whole", pictures.whole(file)}};
}

/// A row as the page gets it: its line of results.jsonl less what the table says, and its pictures.
Json rowJson(const Row& row, const std::vector<Window>& windows, EmbeddedPictures& pictures) {
  const Json line = Json::parse(toJson(row));
  Json json = {{"name", rowName(row)}};
  if (row.failure.empty() && row.what.technique != kSeparationFloor)
    json["command"] = renderCommand(row.what, row.what.technique, row.what.parameters) + " --out picture.png";
  for (const char* key : {"key", "technique", "title", "parameters", "baseline", "error", "penumbra",
                          "misjudged", "spectrum", "failure"})
    json[key] = known(line, key);
  if (const std::string lights = describeEnvironmentLights(row.what); !lights.empty()) {
    json["environment_lights"] = row.what.environmentLights;
    json["environment_settings"] = lights.substr(lights.find(' ') + 1);  // behind the threshold
  }
  if (line.contains("stats")) {
    const Json& stats = line["stats"];
    for (const char* key : {"frame_ms", "split_ms", "memory_bytes", "lights", "quality_parameters", "timer"})
      json[key] = known(stats, key);
    if (!row.cost.frameMs.samples.empty())
      json["frame_ms"]["p99"] = render::quantile(row.cost.frameMs.samples, 0.99);
    json["all_parameters"] = known(stats, "parameters");
    json["passes"] = passes(stats);
    if (stats.contains("x_bound"))
      for (const char* key : {"value", "low", "high", "turns"}) json["x_bound"][key] = stats["x_bound"][key];
  }
  if (const std::optional<ReferenceTime> time = referenceTime(row))
    json["reference_ms"] = {{"value", time->ms}, {"at_least", time->atLeast}};
  // One file after the other: what is asked of a picture in one go decodes it once.
  json["picture"] = pictureJson(row.picture, pictures);
  json["windows"] = Json::array();
  for (const Window& window : windows) json["windows"].push_back(pictures.window(row.picture, window));
  json["difference"] = pictureJson(row.difference, pictures);
  return json;
}

std::vector<Window> chooseWindows(const Table& table, const std::string& referenceFile,
                                  const EmbeddedPictures& pictures) {
  const Image reference = pictures.read(referenceFile);
  if (reference.empty()) return {};
  WindowChooser chooser(reference);
  for (const Row& row : table.rows) {
    if (const Image picture = pictures.read(row.picture); !picture.empty()) chooser.add(picture);
  }
  return chooser.choose(kWindows);
}

Json referenceJson(const Table& table, const std::string& file, const std::vector<Window>& windows,
                   EmbeddedPictures& pictures) {
  Json json = {{"picture", pictureJson(file, pictures)}, {"windows", Json::array()}};
  for (const Window& window : windows) json["windows"].push_back(pictures.window(file, window));
  for (const Row& row : table.rows) {
    if (row.referenceNoise) json["noise_rms"] = *row.referenceNoise;
    if (row.referenceSeconds) json["seconds"] = *row.referenceSeconds;
  }
  return json;
}

/// Where rows were measured. Failed ones do not say.
struct Site {
  std::set<std::string> machines, drivers;
  std::optional<bool> software;

  void add(const Table& table) {
    for (const Row& row : table.rows) {
      if (!row.cost.machine.empty()) machines.insert(row.cost.machine);
      if (!row.cost.driver.empty()) drivers.insert(row.cost.driver);
      if (row.failure.empty()) software = row.cost.software;
    }
  }
};

/// What tells a table from the others of its subject and term. Names of machines and drivers are long: they
/// stand only where a renderer has several. Where every row failed, the renderer's other tables say whether
/// it is software.
std::string howMeasured(const Row& row, const Site& site, const Site& ofRenderer) {
  std::string text =
      fmt::format("{}, {}, {}, {}", sizesText(row.what), row.what.dynamic ? "dynamic" : "static",
                  referenceText(row.what), row.cost.renderer);
  if (const std::optional<bool> software = site.software ? site.software : ofRenderer.software)
    text += *software ? " (software)" : " (hardware)";
  for (const auto names : {&Site::machines, &Site::drivers})
    if ((ofRenderer.*names).size() > 1)
      for (const std::string& name : site.*names) text += ", " + name;
  return text;
}

Json tableJson(const Table& table, const Site& ofRenderer, EmbeddedPictures& pictures) {
  const Case& c = table.rows.front().what;
  const bool own = c.timeWidth > 0;
  Site site;
  site.add(table);
  Json json = {{"title", table.title},
               {"subject", tableSubject(c, QuestionWording::key)},
               {"measured", howMeasured(table.rows.front(), site, ofRenderer)},
               {"term", c.term},
               {"size", {c.width, c.height}},
               {"time_size", {own ? c.timeWidth : c.width, own ? c.timeHeight : c.height}},
               {"dynamic", c.dynamic},
               {"renderer", table.rows.front().cost.renderer}};
  std::set<int> frames, warmup, turns;  // rows of one table may have been timed with several efforts
  std::string reference;
  for (const Row& row : table.rows) {
    frames.insert(row.what.frames);
    warmup.insert(row.what.warmup);
    if (isTimed(row)) turns.insert(row.cost.frameMs.turns);
    if (reference.empty()) reference = referencePicture(row);
  }
  json["software"] = site.software ? Json(*site.software) : Json();
  json["machines"] = site.machines;
  json["drivers"] = site.drivers;
  json["frames"] = frames;
  json["warmup"] = warmup;
  json["turns"] = turns;
  const std::vector<Window> windows = chooseWindows(table, reference, pictures);
  json["windows"] = Json::array();
  for (const Window& w : windows) json["windows"].push_back({w.x, w.y, w.width, w.height});
  json["reference"] = referenceJson(table, reference, windows, pictures);
  const Row* baseline = baselineOf(table);
  if (baseline != nullptr) json["baseline"] = markedName(*baseline, table);
  json["rows"] = Json::array();
  for (const Row& row : table.rows) {
    json["rows"].push_back(rowJson(row, windows, pictures));
    json["rows"].back()["times_as_fast"] = timesAsFast(baseline, row);
    if (isOutdated(row, table)) json["rows"].back()["outdated"] = true;
  }
  return json;
}

/// What the page calls a metric of a row's `part`, and where it finds it. Axes of errors are logarithmic:
/// what has a sign is shown without it.
Json pageMetric(const std::string& part, const MetricInfo& info) {
  std::string key(info.key), label = labelWithUnit(info), help(info.help);
  const bool magnitude = info.kind == MetricKind::deviation;
  if (magnitude) {
    label = fmt::format("|{}|", label);
    help += "; without its sign";
  }
  if (part != "error") {
    key = fmt::format("{}_{}", part, key);
    label += fmt::format(" in the {}", part);
  }
  if (part == "penumbra")
    help += fmt::format("; over pixels whose reference visibility lies between {} and {}", Misjudged::kUmbra,
                        Misjudged::kLit);
  return {{"key", key},
          {"label", label},
          {"help", help},
          {"path", {part, info.key}},
          {"floored", info.floored},
          {"magnitude", magnitude}};
}

/// What may stand on the page's axis of errors, in the order of its drop-down; the first that rows have is
/// shown.
Json pageMetrics() {
  Json list = Json::array();
  for (const MetricInfo* info : kCompared) list.push_back(pageMetric("penumbra", *info));
  for (const MetricInfo& info : kMetrics)
    if (info.kind == MetricKind::error || info.kind == MetricKind::deviation)
      list.push_back(pageMetric("error", info));
  for (const MisjudgedInfo& info : kMisjudged)
    list.push_back({{"key", info.key},
                    {"label", info.label},
                    {"help", fmt::format("{}, as a share of all that could be", info.help)},
                    {"path", {"misjudged", info.key}},
                    {"whole", {"misjudged", info.wholeKey}}});
  return list;
}

/// Heads and help of the tables' columns by their names in CSV, or in Markdown where CSV has none.
Json pageColumns() {
  Json json = Json::object();
  for (const Column& column : columns())
    if (!column.markdown.empty())
      json[column.csv.empty() ? column.markdown : column.csv] = {{"label", column.markdown},
                                                                 {"help", column.help}};
  return json;
}

/// Leaves only objects in a list: the page reads their fields.
void keepObjects(Json& list) {
  if (list.is_array())
    std::erase_if(list.get_ref<Json::array_t&>(), [](const Json& element) { return !element.is_object(); });
}

/// A text of an object; "" where it has none of that key.
std::string textOf(const Json& json, const char* key) {
  const bool has = json.is_object() && json.contains(key) && json[key].is_string();
  return has ? json[key].get<std::string>() : std::string();
}

/// What a result of `limn stress` records of where it comes from, as far as it does.
Provenance recordedIn(const Json& result) {
  const Json json = known(result, "provenance");
  Provenance provenance{textOf(json, "program"), textOf(json, "scene"), {}};
  if (json.is_object())
    for (const Json& m : known(json, "techniques"))
      provenance.modules.push_back({textOf(m, "technique"), textOf(m, "file"), textOf(m, "hash")});
  return provenance;
}

/// What `limn stress` left in the folder, less where it comes from; null if it was not run there.
Json stability(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "stress.json";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return {};
  const std::string text = readTextFile(file);
  Json json = Json::parse(isTooDeepJson(text) ? "" : text, nullptr, false);
  if (json.is_discarded()) throw Error(fmt::format("{}: not what limn stress writes", file.string()));
  if (!json.contains("results") || !json["results"].is_array()) return json;
  keepObjects(json["results"]);
  NewestProvenance newest;  // results stand in the order in which they were measured
  for (const Json& result : json["results"]) newest.add(textOf(result, "scene"), recordedIn(result));
  for (Json& result : json["results"]) {
    if (newest.differs(textOf(result, "scene"), recordedIn(result))) result["outdated"] = true;
    result.erase("provenance");
    if (result.contains("answers")) keepObjects(result["answers"]);
  }
  return json;
}

}  // namespace

ReportData reportData(std::span<const Row> rows, const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const Row& row : rows)
    for (const std::string& file : {row.picture, row.difference, referencePicture(row)})
      if (!file.empty()) files.push_back(file);
  EmbeddedPictures pictures(folder, files);
  Json json = {{"metrics", pageMetrics()}, {"columns", pageColumns()}, {"tables", Json::array()}};
  const std::vector<Table> tables = makeTables(rows);
  std::map<std::string, Site> sites;  // by renderer
  for (const Table& table : tables) sites[table.rows.front().cost.renderer].add(table);
  for (const Table& table : tables)
    json["tables"].push_back(tableJson(table, sites[table.rows.front().cost.renderer], pictures));
  json["compressed"] = pictures.compressed();
  json["reduction"] = pictures.reduction();
  json["stability"] = stability(folder);
  // ASCII alone: no line separator (U+2028) or mark of direction stands in the page as itself.
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      escaped += "\\u003c";  // "</script>" and "<!--" would end or change the element
    else
      escaped += c;
  }
  return {.json = std::move(escaped), .pictures = pictures.elements()};
}

void writeReport(std::span<const Row> rows, const std::filesystem::path& folder) {
  std::string page(reportSources().front().text);
  const auto put = [&](std::string_view mark, const std::string& text) {
    page.replace(page.find(mark), mark.size(), text);
  };
  const ReportData data = reportData(rows, folder);
  put("{{pictures}}", data.pictures);  // first: they hold no mark, and rows may
  put("{{data}}", data.json);
  writeTextFile(folder / "index.html", page);
}

}  // namespace limn::bench
