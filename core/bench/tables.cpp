#include "core/bench/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core/base/file.h"
#include "core/bench/comparison.h"
#include "core/bench/markdown.h"
#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

std::string parameterText(const Case& c) {
  std::string text;
  for (const auto& [name, value] : c.parameters)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  const EnvironmentSettings& e = c.environment;
  if (e.lights > 0)
    text += fmt::format("{}environment lights {} of {}^2 {} {}", text.empty() ? "" : ", ", e.lights,
                        e.resolution, e.shape, e.reflection);
  return text;
}

std::string timeSizeText(const Case& c) {
  return c.timeWidth > 0 ? fmt::format(", times at {}x{}", c.timeWidth, c.timeHeight) : "";
}

std::string tableTitle(const Row& row) {
  const Case& c = row.what;
  std::string title = c.scene;
  if (!c.camera.empty()) title += ", camera " + c.camera;
  if (!c.light.empty()) title += ", light " + c.light;
  if (c.lightSize > 0) title += fmt::format(", light size {}", c.lightSize);
  if (!c.environment.map.empty())
    title += ", environment " + std::filesystem::path(c.environment.map).filename().string();
  if (c.time != 0) title += fmt::format(", {} s", c.time);
  if (c.fps > 0) title += fmt::format(", played at {} fps", c.fps);
  if (const std::string medium = describe(c.medium); !medium.empty()) title += ", " + medium;
  if (const std::string changes = describe(c.changes); !changes.empty()) title += ", " + changes;
  return title + fmt::format(": {}, {}x{}{}, {}, {}", c.term, c.width, c.height, timeSizeText(c),
                             c.dynamic ? "dynamic" : "static", row.cost.renderer);
}

/// What all rows of one table share. The renderer says whether it is software.
std::string tableKey(const Row& row) {
  return fmt::format("{}\x1f{}\x1f{}\x1f{}\x1f{}", question(row.what), row.what.dynamic,
                     timeSizeText(row.what), row.what.fps, row.cost.renderer);
}

std::string slug(const std::string& title, std::set<std::string>& used) {
  std::string name;
  for (const char c : title) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (plain) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  name.resize(std::min<std::size_t>(name.size(), 100));
  std::string unique = name;
  for (int i = 2; !used.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
  return unique + ".csv";
}

/// Nobody is at least as good in both error and time, and better in one.
bool onParetoFront(const Row& row, std::span<const Row> rows) {
  if (!isTimed(row)) return false;
  return std::none_of(rows.begin(), rows.end(), [&](const Row& other) {
    if (!isTimed(other)) return false;
    const double de = other.error.rmse - row.error.rmse,
                 dt = other.cost.frameMs.median - row.cost.frameMs.median;
    return de <= 0 && dt <= 0 && (de < 0 || dt < 0);
  });
}

std::string rmseText(const Metrics& m) {
  if (m.noise_floor && m.rmse < *m.noise_floor) return fmt::format("<{:.3g}", *m.noise_floor);
  return fmt::format("{:.4g}", m.rmse);
}

std::string referenceTimeText(const Row& row) {
  const std::optional<ReferenceTime> time = referenceTime(row);
  return time ? fmt::format("{}{:.4g}", time->atLeast ? ">" : "", time->ms) : "-";
}

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string share(std::size_t part, std::size_t whole) {
  return whole == 0 ? "-"
                    : fmt::format("{:.2f}", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

using Cells = std::vector<std::string>;

void append(Cells& cells, const Cells& more) {
  cells.insert(cells.end(), more.begin(), more.end());
}

/// Columns of visibility alone.
Cells visibilityCells(const Row& row) {
  const Misjudged m = row.misjudged.value_or(Misjudged{});
  return {row.penumbra ? rmseText(*row.penumbra) : "-", share(m.litInUmbra, m.umbra),
          share(m.darkInLight, m.lit)};
}

/// How far the slowest frames lie above the others: stalls show here, not in the quartiles.
std::string tailText(const FrameTime& t) {
  return t.samples.empty() ? "-" : fmt::format("{:.2f}", render::quantile(t.samples, 0.99) / t.median);
}

Cells timeCells(const Row& row, const Table& table) {
  const FrameTime& t = row.cost.frameMs;
  if (!isTimed(row)) return {"-", "-", "-", "-", "0", "-", "-", "-", "-", "-", "-", ""};
  const CostSplit& split = row.cost.split;
  return {fmt::format("{:.3f}", t.median),
          fmt::format("{:.3f}", t.q1),
          fmt::format("{:.3f}", t.q3),
          tailText(t),
          fmt::format("{}", t.n),
          fmt::format("{:.1f}", 1000 / t.median),
          referenceTimeText(row),
          fmt::format("{:.2f}", split.maps),
          fmt::format("{:.2f}", split.filters),
          fmt::format("{:.2f}", split.technique),
          fmt::format("{:.1f}", static_cast<double>(row.cost.memoryBytes) / (1 << 20)),
          onParetoFront(row, table.rows) ? "*" : ""};
}

Cells cellsOf(const Row& row, const Table& table, bool visibility) {
  Cells cells = {row.what.title.empty() ? row.what.technique : row.what.title, parameterText(row.what)};
  if (!row.failure.empty()) {
    append(cells, {"failed: " + row.failure});
    return cells;
  }
  const Metrics& e = row.error;
  append(cells, {rmseText(e), fmt::format("{:.4g}", e.rel_mse), fmt::format("{:+.3g}", e.bias),
                 fmt::format("{:.4g}", e.p999), fmt::format("{:.1f}", e.psnr), fmt::format("{:.4f}", e.flip),
                 fmt::format("{:.4g}", e.structured)});
  if (visibility) append(cells, visibilityCells(row));
  append(cells, timeCells(row, table));
  return cells;
}

}  // namespace

std::vector<Table> makeTables(std::span<const Row> rows) {
  std::vector<Table> tables;
  std::map<std::string, std::size_t> byKey;
  std::set<std::string> names;
  for (const Row& row : rows) {
    const auto [place, isNew] = byKey.emplace(tableKey(row), tables.size());
    if (isNew) tables.push_back({tableTitle(row), "", {}});
    tables[place->second].rows.push_back(row);
  }
  std::stable_sort(tables.begin(), tables.end(), [](const Table& a, const Table& b) {
    return a.rows.front().what.scene < b.rows.front().what.scene;
  });
  for (Table& table : tables) table.fileName = slug(table.title, names);
  return tables;
}

std::string toMarkdown(const Table& table) {
  const bool visibility = std::any_of(table.rows.begin(), table.rows.end(),
                                      [](const Row& row) { return row.penumbra || row.misjudged; });
  std::string text = fmt::format("### {}\n\n", markdownText(table.title));
  text += fmt::format(
      "| technique | parameters | RMSE | rel. MSE | bias | p99.9 | PSNR | FLIP | structured |{} median ms | "
      "q1 | q3 | p99 / median | n | fps | reference ms | maps ms | filters ms | technique ms | MiB | front "
      "|\n",
      visibility ? " penumbra RMSE | lit in umbra % | dark in light % |" : "");
  text +=
      fmt::format("|---|---|--:|--:|--:|--:|--:|--:|--:|{}--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|:-:|\n",
                  visibility ? "--:|--:|--:|" : "");
  for (const Row& row : table.rows) text += markdownRow(cellsOf(row, table, visibility));
  return text + comparisonMarkdown(table.rows);
}

std::string toCsv(const Table& table) {
  std::string text =
      "scene,camera,light,light_size,medium,changes,time_s,term,width,height,mode,renderer,technique,"
      "parameters,rmse,rel_"
      "mse,bias,p999,"
      "psnr,"
      "flip,structured,noise_floor,masked_share,pixels,penumbra_rmse,penumbra_structured,umbra,lit_in_umbra,"
      "lit,dark_in_light,time_width,time_"
      "height,"
      "median_ms,q1_ms,q3_ms,p99_ms,n,reference_ms,maps_ms,filters_ms,technique_ms,memory_bytes,failure\r\n";
  const auto optional = [](bool known, auto value) {
    return known ? fmt::format("{}", value) : std::string();
  };
  for (const Row& row : table.rows) {
    const Case& c = row.what;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},", csvField(c.scene), csvField(c.camera),
                        csvField(c.light), optional(c.lightSize > 0, c.lightSize),
                        csvField(describe(c.medium)), csvField(describe(c.changes)), c.time, csvField(c.term),
                        c.width, c.height, c.dynamic ? "dynamic" : "static", csvField(row.cost.renderer),
                        csvField(c.technique), csvField(parameterText(c)));
    if (!row.failure.empty()) {
      text += fmt::format("{}{}\r\n", std::string(28, ','), csvField(row.failure));
      continue;
    }
    const Metrics& e = row.error;
    const FrameTime& t = row.cost.frameMs;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},", e.rmse, e.rel_mse, e.bias, e.p999, e.psnr,
                        e.flip, e.structured, optional(e.noise_floor.has_value(), e.noise_floor.value_or(0)),
                        e.masked_share, e.pixels,
                        optional(row.penumbra.has_value(), row.penumbra ? row.penumbra->rmse : 0),
                        optional(row.penumbra.has_value(), row.penumbra ? row.penumbra->structured : 0));
    const Misjudged m = row.misjudged.value_or(Misjudged{});
    const bool judged = row.misjudged.has_value();
    text += fmt::format("{},{},{},{},", optional(judged, m.umbra), optional(judged, m.litInUmbra),
                        optional(judged, m.lit), optional(judged, m.darkInLight));
    const CostSplit& split = row.cost.split;
    const std::optional<ReferenceTime> reference = referenceTime(row);
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},\r\n", c.timeWidth > 0 ? c.timeWidth : c.width,
        c.timeWidth > 0 ? c.timeHeight : c.height, optional(t.n > 0, t.median), optional(t.n > 0, t.q1),
        optional(t.n > 0, t.q3), optional(!t.samples.empty(), render::quantile(t.samples, 0.99)), t.n,
        optional(reference.has_value(), reference ? reference->ms : 0), optional(t.n > 0, split.maps),
        optional(t.n > 0, split.filters), optional(t.n > 0, split.technique), row.cost.memoryBytes);
  }
  return text;
}

std::string picturesMarkdown(const Table& table) {
  std::vector<std::string> pictures, captions;
  for (const Row& row : table.rows) {
    const std::string picture = markdownPicture(row.picture);
    if (picture.empty()) continue;
    if (pictures.empty()) {
      pictures.push_back(markdownPicture(referencePicture(row)));
      captions.push_back("reference");
    }
    std::string caption = rowName(row) + ": RMSE " + rmseText(row.error);
    if (row.penumbra) caption += fmt::format(" ({} in the penumbra)", rmseText(*row.penumbra));
    if (isTimed(row)) caption += fmt::format(", {:.1f} ms", row.cost.frameMs.median);
    pictures.push_back(picture);
    captions.push_back(caption);
  }
  if (pictures.empty()) return "";
  constexpr std::size_t columns = 3;
  std::string text = fmt::format("### {}\n\n| | | |\n|---|---|---|\n", markdownText(table.title));
  for (std::size_t first = 0; first < pictures.size(); first += columns) {
    text += "|";
    std::vector<std::string> below;
    for (std::size_t i = first; i < first + columns; ++i) {
      text += i < pictures.size() ? fmt::format(" {} |", pictures[i]) : " |";
      below.push_back(i < captions.size() ? captions[i] : "");
    }
    text += "\n" + markdownRow(below);
  }
  return text;
}

void writeTables(std::span<const Row> rows, const std::filesystem::path& folder) {
  std::string markdown, pictures;
  std::string scene;
  for (const Table& table : makeTables(rows)) {
    const std::string& current = table.rows.front().what.scene;
    if (markdown.empty() || current != scene) markdown += fmt::format("## {}\n\n", markdownText(current));
    scene = current;
    markdown += toMarkdown(table) + "\n";
    if (const std::string shown = picturesMarkdown(table); !shown.empty()) pictures += shown + "\n";
    writeTextFile(folder / table.fileName, toCsv(table));
  }
  writeTextFile(folder / "tables.md", markdown);
  if (!pictures.empty()) writeTextFile(folder / "pictures.md", pictures);
}

}  // namespace limn::bench
