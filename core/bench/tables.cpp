#include "core/bench/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core/base/file.h"

namespace limn::bench {
namespace {

std::string parameterText(const Case& c) {
  std::string text;
  for (const auto& [name, value] : c.parameters)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  return text;
}

std::string tableTitle(const Row& row) {
  const Case& c = row.what;
  std::string title = c.scene;
  if (!c.camera.empty()) title += ", camera " + c.camera;
  if (!c.light.empty()) title += ", light " + c.light;
  if (c.time != 0) title += fmt::format(", {} s", c.time);
  return title + fmt::format(": {}, {}x{}, {}, {}", c.term, c.width, c.height,
                             c.dynamic ? "dynamic" : "static", row.cost.renderer);
}

/// What all rows of one table share. The renderer says whether it is software.
std::string tableKey(const Row& row) {
  return fmt::format("{}\x1f{}\x1f{}", question(row.what), row.what.dynamic, row.cost.renderer);
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
  name = name.substr(0, 100);
  std::string unique = name;
  for (int i = 2; !used.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
  return unique + ".csv";
}

bool isTimed(const Row& row) {
  return row.failure.empty() && row.cost.frameMs.n > 0;
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

/// Bars would end a cell.
std::string cell(std::string text) {
  for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, 1, '\\');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
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

std::string markdownRow(const Row& row, const Table& table, bool penumbra) {
  std::string line = fmt::format("| {} | {} |", cell(row.what.technique), cell(parameterText(row.what)));
  if (!row.failure.empty()) return line + fmt::format(" failed: {} |\n", cell(row.failure));
  const Metrics& e = row.error;
  line += fmt::format(" {} | {:.4g} | {:+.3g} | {:.4g} | {:.1f} | {:.4f} | {:.4g} |", rmseText(e), e.rel_mse,
                      e.bias, e.p999, e.psnr, e.flip, e.structured);
  if (penumbra) line += row.penumbra ? fmt::format(" {} |", rmseText(*row.penumbra)) : " - |";
  const FrameTime& t = row.cost.frameMs;
  if (!isTimed(row)) return line + " - | - | - | 0 | - |  |\n";
  return line + fmt::format(" {:.3f} | {:.3f} | {:.3f} | {} | {:.1f} | {} |\n", t.median, t.q1, t.q3, t.n,
                            static_cast<double>(row.cost.memoryBytes) / (1 << 20),
                            onParetoFront(row, table.rows) ? "*" : "");
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
  const bool penumbra = std::any_of(table.rows.begin(), table.rows.end(),
                                    [](const Row& row) { return row.penumbra.has_value(); });
  std::string text = fmt::format("### {}\n\n", table.title);
  text += fmt::format(
      "| technique | parameters | RMSE | rel. MSE | bias | p99.9 | PSNR | FLIP | structured |{} median ms | "
      "q1 | q3 | n | "
      "MiB | front |\n",
      penumbra ? " penumbra RMSE |" : "");
  text += fmt::format("|---|---|--:|--:|--:|--:|--:|--:|--:|{}--:|--:|--:|--:|--:|:-:|\n",
                      penumbra ? "--:|" : "");
  for (const Row& row : table.rows) text += markdownRow(row, table, penumbra);
  return text;
}

std::string toCsv(const Table& table) {
  std::string text =
      "scene,camera,light,time_s,term,width,height,mode,renderer,technique,parameters,rmse,rel_mse,bias,p999,"
      "psnr,"
      "flip,structured,noise_floor,masked_share,pixels,penumbra_rmse,median_ms,q1_ms,q3_ms,n,memory_bytes,"
      "failure\r\n";
  for (const Row& row : table.rows) {
    const Case& c = row.what;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},", csvField(c.scene), csvField(c.camera),
                        csvField(c.light), c.time, csvField(c.term), c.width, c.height,
                        c.dynamic ? "dynamic" : "static", csvField(row.cost.renderer), csvField(c.technique),
                        csvField(parameterText(c)));
    if (!row.failure.empty()) {
      text += fmt::format("{}{}\r\n", std::string(16, ','), csvField(row.failure));
      continue;
    }
    const Metrics& e = row.error;
    const auto optional = [](bool known, double value) {
      return known ? fmt::format("{}", value) : std::string();
    };
    const FrameTime& t = row.cost.frameMs;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},", e.rmse, e.rel_mse, e.bias, e.p999, e.psnr,
                        e.flip, e.structured, optional(e.noise_floor.has_value(), e.noise_floor.value_or(0)),
                        e.masked_share, e.pixels,
                        optional(row.penumbra.has_value(), row.penumbra ? row.penumbra->rmse : 0));
    text += fmt::format("{},{},{},{},{},\r\n", optional(t.n > 0, t.median), optional(t.n > 0, t.q1),
                        optional(t.n > 0, t.q3), t.n, row.cost.memoryBytes);
  }
  return text;
}

void writeTables(std::span<const Row> rows, const std::filesystem::path& folder) {
  std::string markdown;
  std::string scene;
  for (const Table& table : makeTables(rows)) {
    const std::string& current = table.rows.front().what.scene;
    if (markdown.empty() || current != scene) markdown += fmt::format("## {}\n\n", current);
    scene = current;
    markdown += toMarkdown(table) + "\n";
    writeTextFile(folder / table.fileName, toCsv(table));
  }
  writeTextFile(folder / "tables.md", markdown);
}

}  // namespace limn::bench
