// Reads published claims. Every complaint names file, line and column.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "core/base/file.h"
#include "core/bench/private/toml_nesting.h"
#include "core/bench/private/toml_section.h"
#include "core/bench/reproduction.h"

namespace limn::bench {
namespace {

std::string required(const TomlSection& claim, const char* key) {
  return claim.text(claim.require(key), key);
}

std::vector<std::string> requiredTexts(const TomlSection& claim, const char* key) {
  claim.require(key);
  return claim.texts(key, {});
}

/// 0 where nothing is said of it.
double thesisRatio(const TomlSection& claim) {
  return claim.real("thesis", 0, 1e-6, 1e6);
}

ClaimMeasure measureOf(const TomlSection& claim) {
  const std::string name = required(claim, "measure");
  for (const auto& [known, measure] :
       {std::pair("frame", ClaimMeasure::frame), {"memory", ClaimMeasure::memory}})
    if (name == known) return measure;
  claim.fail(claim.require("measure"), "'measure' must be frame or memory");
}

Claim parseClaim(const std::string& file, const toml::table& table) {
  Claim result;
  if (table.contains("because")) {
    const TomlSection claim(file, table, "a claim that is not reproduced",
                            {"where", "what", "thesis", "because"});
    result.where = required(claim, "where");
    result.what = required(claim, "what");
    result.thesis = thesisRatio(claim);
    result.because = required(claim, "because");
    return result;
  }
  const TomlSection claim(file, table, "a claim",
                          {"where", "what", "measure", "thesis", "suite", "slow", "fast"});
  claim.require("thesis");
  return {required(claim, "where"),    required(claim, "what"),  measureOf(claim),
          thesisRatio(claim),          required(claim, "suite"), requiredTexts(claim, "slow"),
          requiredTexts(claim, "fast")};
}

}  // namespace

Claims parseClaims(std::string_view toml, const std::string& fileName) {
  checkTomlNesting(toml, fileName);
  try {
    const toml::table root = toml::parse(toml);
    const TomlSection file(fileName, root, "the file", {"title", "preface", "claims"});
    Claims claims{file.text("title", "What was published, and what is measured here"),
                  fmt::format("{}", fmt::join(file.texts("preface", {}), "\n")),
                  {}};
    for (const toml::table* table : file.tables("claims")) claims.all.push_back(parseClaim(fileName, *table));
    return claims;
  } catch (const toml::parse_error& error) {
    failAt(fileName, error.source(), std::string(error.description()));
  }
}

Claims readClaims(const std::filesystem::path& path) {
  return parseClaims(readTextFile(path, 1 << 24), path.string());
}

}  // namespace limn::bench
