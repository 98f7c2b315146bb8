#include "core/bench/reproduction.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/shell.h"
#include "core/bench/comparison.h"
#include "core/bench/markdown.h"

namespace limn::bench {
namespace {

[[noreturn]] void fail(const std::string& file, const toml::source_region& where,
                       const std::string& message) {
  throw UsageError(fmt::format("{}:{}:{}: {}", file, where.begin.line, where.begin.column, message));
}

std::string text(const std::string& file, const toml::table& table, const char* key) {
  const auto value = table[key].value<std::string>();
  if (!value || value->empty()) fail(file, table.source(), fmt::format("a claim needs the text '{}'", key));
  return *value;
}

std::vector<std::string> texts(const std::string& file, const toml::table& table, const char* key) {
  std::vector<std::string> values;
  if (const toml::array* list = table[key].as_array())
    for (const toml::node& node : *list)
      if (const auto value = node.value<std::string>()) values.push_back(*value);
  if (values.empty()) fail(file, table.source(), fmt::format("a claim needs the list of texts '{}'", key));
  return values;
}

Claim parseClaim(const std::string& file, const toml::table& table) {
  static const std::map<std::string, ClaimMeasure> measures = {
      {"frame", ClaimMeasure::frame}, {"shadows", ClaimMeasure::shadows}, {"memory", ClaimMeasure::memory}};
  static const std::set<std::string_view> keys = {"where", "what", "measure", "thesis",
                                                  "suite", "slow", "fast"};
  for (const auto& [key, node] : table)
    if (!keys.contains(key.str()))
      fail(file, key.source(), fmt::format("unknown key '{}' in a claim", key.str()));
  Claim claim;
  claim.where = text(file, table, "where");
  claim.what = text(file, table, "what");
  const auto measure = measures.find(text(file, table, "measure"));
  if (measure == measures.end()) fail(file, table.source(), "'measure' must be frame, shadows or memory");
  claim.measure = measure->second;
  claim.thesis = table["thesis"].value_or(0.0);
  if (!(claim.thesis > 0)) fail(file, table.source(), "a claim needs 'thesis', a ratio above 0");
  claim.suite = text(file, table, "suite");
  claim.slow = texts(file, table, "slow");
  claim.fast = texts(file, table, "fast");
  return claim;
}

/// Whether the label contains the part; one that ends in $ is its end.
bool contains(const std::string& name, std::string_view part) {
  if (part.ends_with('$')) return name.ends_with(part.substr(0, part.size() - 1));
  return name.find(part) != std::string::npos;
}

const Row* find(std::span<const Row> rows, const std::vector<std::string>& parts) {
  const Row* found = nullptr;
  for (const Row& row : rows) {
    const std::string name = label(row.what);
    const bool fits = row.failure.empty() && std::ranges::all_of(parts, [&](const std::string& part) {
                        return contains(name, part);
                      });
    if (!fits) continue;
    if (found != nullptr && label(found->what) != name)
      throw Error(fmt::format("two rows fit one claim: {} and {}", label(found->what), name));
    found = &row;
  }
  return found;
}

std::string ratioText(const Claim& claim, const Row& slow, const Row& fast) {
  switch (claim.measure) {
    case ClaimMeasure::memory:
      return fmt::format("{:.2f}", static_cast<double>(slow.cost.memoryBytes) /
                                       static_cast<double>(std::max<std::int64_t>(1, fast.cost.memoryBytes)));
    case ClaimMeasure::shadows:
      return shadowMs(fast) > 0 ? fmt::format("{:.2f}", shadowMs(slow) / shadowMs(fast)) : "-";
    case ClaimMeasure::frame:
      break;
  }
  return fast.cost.frameMs.median > 0 ? frameRatio(slow, fast) : "-";
}

const char* name(ClaimMeasure measure) {
  return measure == ClaimMeasure::frame ? "frame" : measure == ClaimMeasure::shadows ? "shadows" : "memory";
}

std::string settings(const Row& row) {
  const Case& c = row.what;
  const int width = c.timeWidth > 0 ? c.timeWidth : c.width,
            height = c.timeWidth > 0 ? c.timeHeight : c.height;
  std::string size = c.lightSize > 0 ? fmt::format(", light {}", c.lightSize) : "";
  return fmt::format("{}{}, {}x{}, {}", c.scene, size, width, height, row.cost.renderer);
}

}  // namespace

std::vector<Claim> parseClaims(std::string_view toml, const std::string& fileName) {
  try {
    const toml::table root = toml::parse(toml);
    const toml::array* list = root["claims"].as_array();
    if (list == nullptr || list->empty()) fail(fileName, root.source(), "there are no [[claims]]");
    std::vector<Claim> claims;
    for (const toml::node& node : *list) {
      if (!node.is_table()) fail(fileName, node.source(), "'claims' must be tables: [[claims]]");
      claims.push_back(parseClaim(fileName, *node.as_table()));
    }
    return claims;
  } catch (const toml::parse_error& error) {
    fail(fileName, error.source(), std::string(error.description()));
  }
}

std::vector<Claim> readClaims(const std::filesystem::path& path) {
  return parseClaims(readTextFile(path, 1 << 24), path.string());
}

std::string reproductionMarkdown(std::span<const Claim> claims, std::span<const Row> rows) {
  std::string markdown, chapter;
  std::set<std::string> suites;
  for (const Claim& claim : claims) {
    const std::string current = claim.where.substr(0, claim.where.find('.'));
    if (current != chapter)
      markdown += fmt::format(
          "{}## Chapter {}\n\n| thesis | comparison | of | thesis | measured | at "
          "|\n|---|---|---|--:|--:|---|\n",
          markdown.empty() ? "" : "\n", markdownText(current));
    chapter = current;
    const Row *slow = find(rows, claim.slow), *fast = find(rows, claim.fast);
    const bool measured = slow != nullptr && fast != nullptr;
    markdown += markdownRow(
        {claim.where, claim.what, name(claim.measure), fmt::format("{:.2f}", claim.thesis),
         measured ? ratioText(claim, *slow, *fast) : "not measured", measured ? settings(*fast) : ""});
    suites.insert(claim.suite);
  }
  markdown += "\nMeasured with\n\n```sh\n";
  std::string folders;
  for (const std::string& suite : suites) {
    const std::string folder = shellQuoted("out/" + suite);
    markdown += fmt::format("build/bin/limn bench {} --out {}\n", shellQuoted(suite), folder);
    folders += " " + folder;
  }
  return markdown + fmt::format("build/bin/limn reproduction{} --out docs/reproduction.md\n```\n", folders);
}

}  // namespace limn::bench
