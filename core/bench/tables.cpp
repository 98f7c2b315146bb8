#include "core/bench/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/file.h"
#include "core/bench/private/columns.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/markdown.h"
#include "core/bench/private/table_texts.h"
#include "core/question/question_fields.h"
#include "core/question/term.h"

namespace limn::bench {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kHeading = "### ";                  ///< of a table in tables.md and pictures.md
constexpr std::string_view kCsvBegin = "scene,camera,light,";  ///< of the CSVs of every version
constexpr std::string_view kPictureHead = "| | | |";           ///< of a table in pictures.md
constexpr int kPictureHeadLine = 3;                            ///< of the first one, behind its heading
constexpr const char* kOutdatedLine =                          ///< explains kOutdatedMark
    "\n\u2020 measured with another version of the program, of a technique or of the scene than the newest "
    "row\n";

std::string timeSizeText(const Case& c) {
  return c.timeWidth > 0 ? fmt::format(", times at {}x{}", c.timeWidth, c.timeHeight) : "";
}

/// Keys say what labels leave out: the folders of files and the reference.
std::string tableTitle(const Row& row, QuestionWording wording) {
  const Case& c = row.what;
  return fmt::format("{}: {}, {}, {}, {}{}", tableSubject(c, wording), c.term, sizesText(c),
                     c.dynamic ? "dynamic" : "static",
                     wording == QuestionWording::key ? referenceText(c) + ", " : "", row.cost.renderer);
}

/// Rows may have a term that there is no more.
bool mayHaveBounces(std::string_view term) {
  const auto* info =
      std::ranges::find(kTerms, term, [](const TermInfo& t) { return std::string_view(t.name); });
  return info == std::end(kTerms) || info->bounces != TermBounces::none;
}

/// What all rows of one table share. The renderer says whether it is software.
std::string tableKey(const Row& row) {
  return fmt::format("{}\x1f{}\x1f{}\x1f{}\x1f{}", question(row.what), row.what.dynamic,
                     timeSizeText(row.what), row.what.fps, row.cost.renderer);
}

/// What makes rows of one table the same setting: their keys, without the effort that times it.
std::string settingKey(const Case& c) {
  std::string text = c.technique;
  for (const auto& [name, value] : c.parameters) text += fmt::format("\x1e{}\x1f{}", name, value);
  return c.environmentLights > 0 ? text + "\x1c" + describeEnvironmentLights(c) : text;
}

/// Whether it is known which version measured the row: one that does not say is of an earlier version, a
/// failure of any.
bool knowsVersion(const Row& row) {
  return row.failure.empty() || !row.provenance.program.empty();
}

/// Whether `row` stands in the place of one of the same setting that comes before it.
bool supersedes(const Row& row, const Row& before) {
  if (knowsVersion(row) && knowsVersion(before) && !staleness(before.provenance, row.provenance).empty())
    return row.line >= before.line;
  if (row.failure.empty() != before.failure.empty()) return row.failure.empty();
  const auto effort = [](const FrameTime& time) { return std::pair(time.turns >= kFewestTurns, time.n); };
  return effort(row.cost.frameMs) >= effort(before.cost.frameMs);
}

NewestProvenance newestOf(std::span<const Row> rows) {
  std::vector<const Row*> byAge;
  for (const Row& row : rows) byAge.push_back(&row);
  std::ranges::stable_sort(byAge, {}, &Row::line);
  NewestProvenance newest;
  for (const Row* row : byAge) newest.add(row->what.scene, row->provenance);
  return newest;
}

/// Where rows were measured; "" is not known.
struct Place {
  std::string machine, driver;
};

Place placeOf(const Row& row) {
  return {row.cost.machine, row.cost.driver};
}

bool fits(const Place& a, const Place& b) {
  return mayBeEqual(a.machine, b.machine) && mayBeEqual(a.driver, b.driver);
}

/// The places of one question in the order of their rows.
class Places {
 public:
  void add(const Place& place) {
    const auto known = std::ranges::find_if(places_, [&](const Place& other) { return fits(place, other); });
    if (known == places_.end()) return places_.push_back(place);
    if (known->machine.empty()) known->machine = place.machine;
    if (known->driver.empty()) known->driver = place.driver;
  }
  /// The first that fits one that was added.
  std::size_t find(const Place& place) const {
    const auto known = std::ranges::find_if(places_, [&](const Place& other) { return fits(place, other); });
    return static_cast<std::size_t>(known - places_.begin());
  }
  /// What tells the place from the others.
  std::string text(std::size_t index) const {
    const Place& place = places_[index];
    const auto alike = std::ranges::count(places_, place.machine, &Place::machine);
    std::string text = places_.size() > 1 && !place.machine.empty() ? ", " + place.machine : "";
    return alike > 1 ? text + ", " + place.driver : text;
  }

 private:
  std::vector<Place> places_;
};

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

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

using Chosen = std::vector<const Column*>;

bool hasCell(const Row& row, const Column& column) {
  return row.failure.empty() || column.failed;
}

/// The text that at least two rows have in the column, and no row another; nullopt if there is none. The
/// technique and the RMSE always have a column: one names the row, in the other failed rows say why.
std::optional<std::string> commonText(const Column& column, const Table& table) {
  if (column.csv == "technique" || column.csv == metricInfo(&Metrics::rmse).key) return std::nullopt;
  std::size_t rows = 0;
  std::string common;
  for (const Row& row : table.rows) {
    if (!hasCell(row, column)) continue;
    const std::string text = column.shown(row, table);
    if (rows++ == 0) common = text;
    if (text != common) return std::nullopt;
  }
  return rows > 1 ? std::optional(common) : std::nullopt;
}

/// The columns of a Markdown table, and what it says once in a line above instead of in a column.
struct MarkdownParts {
  Chosen columns;
  std::string common;
};

/// Columns that no row knows are left out.
MarkdownParts markdownParts(const Table& table) {
  MarkdownParts parts;
  for (const Column& column : columns()) {
    if (column.markdown.empty() || (column.known && std::ranges::none_of(table.rows, column.known))) continue;
    const std::optional<std::string> text = commonText(column, table);
    if (!text)
      parts.columns.push_back(&column);
    else
      parts.common += fmt::format("{}{} {}", parts.common.empty() ? "In all rows: " : ", ", column.markdown,
                                  text->empty() ? "-" : *text);
  }
  return parts;
}

std::vector<std::string> markdownCells(const Chosen& chosen, const Row& row, const Table& table) {
  std::vector<std::string> cells;
  for (const Column* column : chosen)
    if (hasCell(row, *column)) cells.push_back(column->shown(row, table));
  if (!row.failure.empty())
    cells.push_back("failed: " + row.failure);  // a reader fills the line with empty cells
  if (isOutdated(row, table)) cells.front() += kOutdatedMark;
  return cells;
}

/// The names of the CSVs that an earlier run wrote to the folder, by the titles in its tables.md.
std::set<std::string> earlierCsvs(const fs::path& folder) {
  std::set<std::string> names, used;
  std::ifstream markdown(folder / "tables.md");
  for (std::string line; std::getline(markdown, line);)
    if (line.starts_with(kHeading))
      names.insert(slug(textOfMarkdown(std::string_view(line).substr(kHeading.size())), used));
  return names;
}

/// Whether the file is one that limn wrote, which has `begin` at the start of its line `number`, and not one
/// that somebody put in its place.
bool isOwnFile(const fs::path& file, int number, std::string_view begin) {
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(file, ignored))) return false;
  std::ifstream lines(file, std::ios::binary);
  std::string line;
  for (int i = 0; i < number; ++i)
    if (!std::getline(lines, line)) return false;
  return line.starts_with(begin);
}

/// A line of RFC 4180.
std::string csvLine(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += (&field == fields.data() ? "" : ",") + csvField(field);
  return line + "\r\n";
}

}  // namespace

std::string tableSubject(const Case& c, QuestionWording wording) {
  std::string text = c.scene;
  const auto add = [&text](const char* before, const std::string& words) {
    if (!words.empty()) text += before + words;
  };
  add(", camera ", c.camera);
  add(", light ", c.light);
  add(", ", describe(c, QuestionGroup::subject, wording));
  add(", environment ", describe(c, QuestionGroup::environment, wording));
  // Lights that stand for the environment are a setting of all light together, but decide what one light is.
  if (wording == QuestionWording::key && !c.light.empty())
    add(", environment lights ", describeEnvironmentLights(c));
  if (c.time != 0) add(", ", fmt::format("{} s", c.time));
  if (c.fps > 0) add(", ", fmt::format("played at {} fps", c.fps));
  add(", ", describe(c, QuestionGroup::medium, wording));
  add(", ", describe(c, QuestionGroup::changes, wording));
  return text;
}

std::string sizesText(const Case& c) {
  return fmt::format("{}x{}{}", c.width, c.height, timeSizeText(c));
}

std::string referenceText(const Case& c) {
  const ReferenceSettings& settings = c.reference;
  std::string text = settings.noise > 0
                         ? fmt::format("against {:.4g} % noise or {} spp", 100 * settings.noise, settings.spp)
                         : fmt::format("against {} spp", settings.spp);
  if (settings.bounces > 0 && mayHaveBounces(c.term)) text += fmt::format(", bounces {}", settings.bounces);
  if (settings.interfaces != 0)
    text +=
        settings.interfaces < 0 ? ", interfaces all" : fmt::format(", interfaces {}", settings.interfaces);
  return text;
}

bool isOutdated(const Row& row, const Table& table) {
  return table.newest.differs(row.what.scene, row.provenance);
}

std::vector<Table> makeTables(std::span<const Row> rows) {
  // Failures and rows of earlier versions do not say their place.
  std::map<std::string, Places> places;
  for (const Row& row : rows) places[tableKey(row)].add(placeOf(row));
  std::vector<Table> tables;
  std::vector<std::string> longTitles;
  std::map<std::pair<std::string, std::size_t>, std::size_t> byKey;
  std::map<std::pair<std::size_t, std::string>, std::size_t> settings;  // places in the rows of a table
  std::set<std::string> names;
  for (const Row& row : rows) {
    const std::string key = tableKey(row);
    const Places& known = places[key];
    const std::size_t place = known.find(placeOf(row));
    const auto [table, isNew] = byKey.emplace(std::pair(key, place), tables.size());
    if (isNew) {
      tables.push_back({tableTitle(row, QuestionWording::label) + known.text(place), "", {}});
      longTitles.push_back(tableTitle(row, QuestionWording::key) + known.text(place));
    }
    std::vector<Row>& kept = tables[table->second].rows;
    const auto [same, isFirst] =
        settings.emplace(std::pair(table->second, settingKey(row.what)), kept.size());
    if (isFirst)
      kept.push_back(row);
    else if (supersedes(row, kept[same->second]))
      kept[same->second] = row;
  }
  std::map<std::string, int> uses;
  for (const Table& table : tables) ++uses[table.title];
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (uses[tables[i].title] > 1) tables[i].title = longTitles[i];
  std::stable_sort(tables.begin(), tables.end(), [](const Table& a, const Table& b) {
    return a.rows.front().what.scene < b.rows.front().what.scene;
  });
  for (Table& table : tables) {
    table.fileName = slug(table.title, names);
    table.newest = newestOf(table.rows);
  }
  return tables;
}

std::string toMarkdown(const Table& table) {
  const MarkdownParts parts = markdownParts(table);
  std::vector<MarkdownHead> heads;
  for (const Column* column : parts.columns) heads.push_back({column->markdown, column->align});
  std::string text = fmt::format("{}{}\n\n", kHeading, markdownText(table.title));
  if (!parts.common.empty()) text += markdownText(parts.common) + "\n\n";
  text += markdownHead(heads);
  for (const Row& row : table.rows) text += markdownRow(markdownCells(parts.columns, row, table));
  if (std::ranges::any_of(table.rows, [&](const Row& row) { return isOutdated(row, table); }))
    text += kOutdatedLine;
  return text + comparisonMarkdown(table);
}

std::string toCsv(const Table& table) {
  std::vector<std::string> fields;
  const auto line = [&fields](const auto& field) {
    fields.clear();
    for (const Column& column : columns())
      if (!column.csv.empty()) fields.push_back(field(column));
    return csvLine(fields);
  };
  std::string text = line([](const Column& column) { return column.csv; });
  for (const Row& row : table.rows)
    text += line([&](const Column& column) {
      return hasCell(row, column) ? column.exact(row, table) : std::string();
    });
  return text;
}

std::string picturesMarkdown(const Table& table) {
  std::vector<std::string> pictures, captions;
  bool marked = false;
  for (const Row& row : table.rows) {
    const std::string picture = markdownPicture(row.picture);
    if (picture.empty()) continue;
    if (pictures.empty()) {
      pictures.push_back(markdownPicture(referencePicture(row)));
      captions.push_back("reference");
    }
    std::string caption = fmt::format("{}: {} {}", markedName(row, table), kCompared[0]->label,
                                      shownText(*kCompared[0], row.error));
    if (row.penumbra)
      caption += fmt::format(" ({} in the penumbra)", shownText(*kCompared[0], *row.penumbra));
    if (isTimed(row)) caption += fmt::format(", {:.1f} ms", row.cost.frameMs.median);
    pictures.push_back(picture);
    captions.push_back(caption);
    marked |= isOutdated(row, table);
  }
  if (pictures.empty()) return "";
  constexpr std::size_t inLine = 3;
  std::string text =
      fmt::format("{}{}\n\n{}\n|---|---|---|\n", kHeading, markdownText(table.title), kPictureHead);
  for (std::size_t first = 0; first < pictures.size(); first += inLine) {
    text += "|";
    std::vector<std::string> below;
    for (std::size_t i = first; i < first + inLine; ++i) {
      text += i < pictures.size() ? fmt::format(" {} |", pictures[i]) : " |";
      below.push_back(i < captions.size() ? captions[i] : "");
    }
    text += "\n" + markdownRow(below);
  }
  return marked ? text + kOutdatedLine : text;
}

void writeTables(std::span<const Row> rows, const fs::path& folder) {
  std::set<std::string> old = earlierCsvs(folder);
  std::string markdown, pictures;
  std::string scene;
  for (const Table& table : makeTables(rows)) {
    const std::string& current = table.rows.front().what.scene;
    if (markdown.empty() || current != scene) markdown += fmt::format("## {}\n\n", markdownText(current));
    scene = current;
    markdown += toMarkdown(table) + "\n";
    if (const std::string shown = picturesMarkdown(table); !shown.empty()) pictures += shown + "\n";
    writeTextFile(folder / table.fileName, toCsv(table));
    old.erase(table.fileName);
  }
  // Before tables.md is written: a run that is cut short here leaves them to the next.
  std::error_code ignored;
  for (const std::string& name : old)
    if (isOwnFile(folder / name, 1, kCsvBegin)) fs::remove(folder / name, ignored);
  writeTextFile(folder / "tables.md", markdown);
  const fs::path pictureFile = folder / "pictures.md";
  if (!pictures.empty())
    writeTextFile(pictureFile, pictures);
  else if (isOwnFile(pictureFile, kPictureHeadLine, kPictureHead))
    fs::remove(pictureFile, ignored);
}

}  // namespace limn::bench
