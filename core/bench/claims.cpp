// Reads the thesis's claims. Every complaint names file, line and column.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/reproduction.h"

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

void checkKeys(const std::string& file, const toml::table& table, const std::set<std::string_view>& known,
               const char* of) {
  for (const auto& [key, node] : table)
    if (!known.contains(key.str()))
      fail(file, key.source(), fmt::format("unknown key '{}' in {}", key.str(), of));
}

Claim parseClaim(const std::string& file, const toml::table& table) {
  static const std::map<std::string, ClaimMeasure> measures = {{"frame", ClaimMeasure::frame},
                                                               {"memory", ClaimMeasure::memory}};
  Claim claim;
  claim.where = text(file, table, "where");
  claim.what = text(file, table, "what");
  claim.thesis = table["thesis"].value_or(0.0);
  if (table.contains("because")) {
    checkKeys(file, table, {"where", "what", "thesis", "because"}, "a claim that is not reproduced");
    claim.because = text(file, table, "because");
    if (table.contains("thesis") && !(claim.thesis > 0))
      fail(file, table.source(), "'thesis' must be a ratio above 0");
    return claim;
  }
  checkKeys(file, table, {"where", "what", "measure", "thesis", "suite", "slow", "fast"}, "a claim");
  const auto measure = measures.find(text(file, table, "measure"));
  if (measure == measures.end()) fail(file, table.source(), "'measure' must be frame or memory");
  claim.measure = measure->second;
  if (!(claim.thesis > 0)) fail(file, table.source(), "a claim needs 'thesis', a ratio above 0");
  claim.suite = text(file, table, "suite");
  claim.slow = texts(file, table, "slow");
  claim.fast = texts(file, table, "fast");
  return claim;
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

}  // namespace limn::bench
