#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/bench/reproduction.h"
#include "tests/support/paths.h"

namespace limn::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kClaim =
    "[[claims]]\nwhere = \"7.6, table\"\nwhat = \"fast | slow\"\nmeasure = \"frame\"\nthesis = 14.8\n"
    "suite = \"ch7\"\nslow = [\"balls\", \"/pcss?\"]\nfast = [\"balls\", \"vssm$\"]\n";

Row row(const std::string& technique, double ms, const std::string& parameter = {}) {
  Row row;
  row.what.scene = "balls";
  row.what.term = "visibility";
  row.what.technique = technique;
  if (!parameter.empty()) row.what.parameters = {{parameter, "1"}};
  row.cost.renderer = "llvmpipe";
  row.cost.frameMs.median = ms;
  row.cost.frameMs.samples = {ms, ms};
  row.cost.memoryBytes = 1 << 20;
  return row;
}

TEST(Reproduction, RatiosAreMeasuredBetweenTheRowsThatFit) {
  const auto claims = parseClaims(kClaim, "c");
  ASSERT_EQ(claims.size(), 1u);
  const Row rows[] = {row("pcss", 30, "samples"), row("vssm", 2), row("vssm", 1, "cells")};
  const std::string page = reproductionMarkdown(claims, rows);
  EXPECT_THAT(page, HasSubstr("## Chapter 7\n"));
  EXPECT_THAT(page, HasSubstr("| fast \\| slow | frame | 14.80 | 15.00 (15.00 to 15.00) |"));
  EXPECT_THAT(page, HasSubstr("limn bench ch7 --out out/ch7"));
}

TEST(Reproduction, MissingAndFailedRowsAreNotMeasured) {
  Row failed = row("vssm", 2);
  failed.failure = "lost";
  const Row rows[] = {row("pcss", 30, "samples"), failed};
  EXPECT_THAT(reproductionMarkdown(parseClaims(kClaim, "c"), rows), HasSubstr("| 14.80 | not measured |"));
}

TEST(Reproduction, AmbiguousClaimsAreAnError) {
  const Row rows[] = {row("pcss", 30, "samples"), row("pcss", 30, "other"), row("vssm", 1)};
  EXPECT_THROW(reproductionMarkdown(parseClaims(kClaim, "c"), rows), Error);
}

TEST(Reproduction, BrokenClaimsNameTheirPlace) {
  for (const std::string& text : {std::string("x = 1"), std::string("[[claims]]\n"), kClaim + "typo = 1\n",
                                  kClaim + "[[claims]]\nwhere = 1\n", std::string("[[claims]")})
    EXPECT_THROW(parseClaims(text, "c"), UsageError) << text;
}

/// Of everything that `limn bench thesis` measures, in one folder.
TEST(Reproduction, TheThesissSuiteMeasuresEveryClaimOnce) {
  const std::filesystem::path folder = std::filesystem::path(test::sourceDir) / "benchmarks";
  const auto claims = readClaims(folder / "reproduction.claims");
  EXPECT_GE(claims.size(), 25u);
  std::vector<Row> rows;
  for (const Case& what : readSuite(folder / "thesis.toml").cases) {
    rows.push_back(row(what.technique, 1));
    rows.back().what = what;
  }
  EXPECT_THAT(reproductionMarkdown(claims, rows), Not(HasSubstr("not measured")));
}

}  // namespace
}  // namespace limn::bench
