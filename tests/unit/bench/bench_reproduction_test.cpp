#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/bench/private/differing_settings.h"
#include "core/bench/private/verdict.h"
#include "core/bench/reproduction.h"
#include "tests/support/paths.h"

namespace limn::bench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

const std::string kClaim =
    "[[claims]]\nwhere = \"7.6, table\"\nwhat = \"fast | slow\"\nmeasure = \"frame\"\nthesis = 14.8\n"
    "suite = \"ch7\"\nslow = [\"balls\", \"/pcss?\"]\nfast = [\"^balls/\", \"vssm$\"]\n";

/// The claim with `to` in place of its text `from`.
std::string changed(const std::string& from, const std::string& to) {
  std::string claim = kClaim;
  return claim.replace(claim.find(from), from.size(), to);
}

/// Three turns of one frame that all take the same.
Row row(const std::string& technique, double ms, const std::string& parameter = {}, double rmse = 0.1) {
  Row row;
  row.what.scene = "balls";
  row.what.term = "visibility";
  row.what.technique = technique;
  if (!parameter.empty()) row.what.parameters = {{technique + "." + parameter, "1"}};
  row.error.rmse = rmse;
  row.cost.renderer = "llvmpipe";
  row.cost.frameMs = {ms, ms, ms, 3, {ms, ms, ms}, 3};
  row.cost.memoryBytes = 1 << 20;
  return row;
}

/// The line of the only claim's table.
std::string line(const std::vector<Row>& rows, const std::string& claim = kClaim) {
  const std::string page = reproductionMarkdown(parseClaims(claim, "c").all, rows);
  const std::size_t begin = page.find("| 7.6, table |");
  return page.substr(begin, page.find('\n', begin) - begin);
}

TEST(Reproduction, RatiosAreMeasuredBetweenTheRowsThatFit) {
  const auto claims = parseClaims(kClaim, "c").all;
  ASSERT_EQ(claims.size(), 1u);
  const std::vector<Row> rows = {row("pcss", 30, "samples"), row("vssm", 2), row("vssm", 1, "cells")};
  const std::string page = reproductionMarkdown(claims, rows);
  EXPECT_THAT(page, HasSubstr("## Chapter 7\n"));
  EXPECT_THAT(page, HasSubstr("| fast \\| slow | frame | 14.80 | 15.00 (15.00 to 15.00) | 3 | 0.1 / 0.1 |"));
  EXPECT_THAT(line(rows), HasSubstr("| holds |"));
  EXPECT_THAT(page, HasSubstr("limn bench ch7 --out out/ch7"));
  for (const VerdictInfo& info : kVerdicts)
    EXPECT_THAT(page, HasSubstr(std::string("| ") + info.name + " | " + info.rule + " |"));
}

TEST(Reproduction, MeasuredWithNamesOnlySuitesThatAnswerAClaim) {
  const std::string other =
      "[[claims]]\nwhere = \"7.6\"\nwhat = \"other\"\nmeasure = \"frame\"\nthesis = 2\nsuite = \"ch5\"\n"
      "slow = [\"/cssm?\"]\nfast = [\"vssm$\"]\n";
  const auto page = [&](const std::vector<Row>& rows) {
    return reproductionMarkdown(parseClaims(kClaim + other, "c").all, rows);
  };
  const std::string bench5 = "build/bin/limn bench ch5 --out out/ch5\n",
                    bench7 = "build/bin/limn bench ch7 --out out/ch7\n",
                    missing = "\nTo measure what is missing\n\n```sh\n";
  EXPECT_THAT(page({row("pcss", 30, "samples"), row("vssm", 2)}),
              EndsWith("\nMeasured with\n\n```sh\n" + bench7 +
                       "build/bin/limn reproduction out/ch7 --out out/reproduction.md\n```\n" + missing +
                       bench5 + "```\n"));
  EXPECT_THAT(page({row("pcss", 30, "samples"), row("cssm", 20, "order"), row("vssm", 2)}),
              EndsWith("```sh\n" + bench5 + bench7 +
                       "build/bin/limn reproduction out/ch5 out/ch7 --out out/reproduction.md\n```\n"));
  const std::string none = page({});
  EXPECT_THAT(none, EndsWith(missing + bench5 + bench7 + "```\n"));
  EXPECT_THAT(none, Not(HasSubstr("Measured with")));
}

TEST(Reproduction, EachLineSaysItsMachine) {
  Row slow = row("pcss", 30, "samples"), fast = row("vssm", 2);
  EXPECT_THAT(line({slow, fast}), EndsWith("| balls, 1280x720, llvmpipe |")) << "earlier versions' rows";
  slow.cost.machine = fast.cost.machine = "Any Processor, 2 threads";
  EXPECT_THAT(line({slow, fast}), EndsWith("| balls, 1280x720, llvmpipe, Any Processor, 2 threads |"));
}

TEST(Reproduction, TimesOfTwoDriversAreNotCompared) {
  Row slow = row("pcss", 30, "samples"), fast = row("vssm", 2);
  fast.cost.driver = "GL 2";
  EXPECT_THAT(line({slow, fast}), HasSubstr("| 15.00 (")) << "an earlier version did not record its driver";
  slow.cost.driver = "GL 1";
  EXPECT_THAT(line({slow, fast}), HasSubstr("| not measured |"));
}

TEST(Reproduction, MissingAndFailedRowsAreNotMeasured) {
  Row failed = row("vssm", 2);
  failed.failure = "lost";
  EXPECT_THAT(line({row("pcss", 30, "samples"), failed}), HasSubstr("| 14.80 | - | - |"));
  EXPECT_THAT(line({row("pcss", 30, "samples"), failed}), HasSubstr("| not measured |"));
}

TEST(Reproduction, OneTurnIsRefusedHoweverManyFramesItHas) {
  Row once = row("vssm", 2);
  once.cost.frameMs.turns = 1;
  const std::string refused = line({row("pcss", 30, "samples"), once});
  EXPECT_THAT(refused, HasSubstr("| refused: n = 1 | 1 |"));
  EXPECT_THAT(refused, HasSubstr("| not measured |"));
  EXPECT_THAT(refused, Not(HasSubstr("15.00")));
}

TEST(Reproduction, TimesThatTheRowsLackAreNotMeasured) {
  Row untimed = row("vssm", 0);
  untimed.cost.frameMs = {};
  EXPECT_THAT(line({row("pcss", 30, "samples"), untimed}), HasSubstr("| not timed | - |"));
}

/// A suite with `frames = 0` may have rows of the same labels, measured later.
TEST(Reproduction, UntimedRowsStandBackBehindTimedOnes) {
  const auto at = [](Row row, std::size_t line, bool timed) {
    row.line = line;
    if (timed) return row;
    row.cost.frameMs = {};
    row.what.reference.spp = 64;  // a table of its own
    return row;
  };
  const Row slow = row("pcss", 30, "samples"), fast = row("vssm", 2);
  const std::vector<Row> rows = {at(slow, 1, true), at(fast, 2, true), at(slow, 3, false),
                                 at(fast, 4, false)};
  EXPECT_THAT(line(rows), HasSubstr("| 15.00 (15.00 to 15.00) |"));
  std::vector<Row> bytes = rows;
  bytes[2].cost.memoryBytes *= 20;
  EXPECT_THAT(line(bytes, changed("\"frame\"", "\"memory\"")), HasSubstr("| memory | 14.80 | 20.00 | - |"))
      << "untimed rows have memory";
}

TEST(Reproduction, AmbiguousClaimsAreAnError) {
  const Row rows[] = {row("pcss", 30, "samples"), row("pcss", 30, "other"), row("vssm", 1)};
  EXPECT_THROW(reproductionMarkdown(parseClaims(kClaim, "c").all, rows), Error);
}

TEST(Reproduction, BothSidesAreOfOneRendererAndMachine) {
  const auto on = [](Row row, const std::string& renderer, const std::string& machine) {
    row.cost.renderer = renderer;
    row.cost.machine = machine;
    return row;
  };
  const Row slow = row("pcss", 30, "samples"), fast = row("vssm", 2);
  const Row slowHere = on(slow, "llvmpipe", "here"), fastHere = on(fast, "llvmpipe", "here");
  EXPECT_THAT(line({slowHere, on(fast, "a GPU", "here")}), HasSubstr("| not measured |"));
  EXPECT_THAT(line({slowHere, on(fast, "llvmpipe", "there")}), HasSubstr("| not measured |"));
  EXPECT_THAT(line({slow, fastHere}), HasSubstr("| 15.00 (15.00 to 15.00) |")) << "an earlier version's row";
  const Row slowGpu = on(row("pcss", 8, "samples"), "a GPU", "here"),
            fastGpu = on(row("vssm", 1), "a GPU", "here");
  for (const auto& rows : {std::vector{slowHere, slowGpu, fastHere}, {slowHere, fastHere, fastGpu}})
    EXPECT_THAT(line(rows), HasSubstr("| 15.00 (15.00 to 15.00) |")) << "one side of another renderer";
  EXPECT_THAT(line({slowHere, fastHere, slowGpu, fastGpu}), HasSubstr("| 8.00 (8.00 to 8.00) |"))
      << "the last";
}

/// A suite whose reference was changed and changed back: its first rows were measured again after the others.
TEST(Reproduction, OfSeveralReferencesTheNewestRowsCount) {
  const auto at = [](Row row, int spp, std::size_t line) {
    row.what.reference.spp = spp;
    row.line = line;
    return row;
  };
  const Row slow = row("pcss", 30, "samples"), fast = row("vssm", 2), faster = row("vssm", 1);
  EXPECT_THAT(line({at(slow, 64, 5), at(fast, 64, 6), at(slow, 256, 3), at(faster, 256, 4)}),
              HasSubstr("| 15.00 (15.00 to 15.00) |"));
  EXPECT_THAT(line({at(slow, 64, 1), at(fast, 64, 2), at(slow, 256, 3), at(faster, 256, 4)}),
              HasSubstr("| 30.00 (30.00 to 30.00) |"));
}

TEST(Reproduction, BeginningAndEndOfALabelCanBeMeant) {
  Row sky = row("vssm", 1);
  sky.what.environment = "sky";  // its label does not begin with the scene
  const std::vector<Row> rows = {row("pcss", 30, "samples"), row("vssm", 2), row("vssm", 1, "cells"), sky};
  EXPECT_THAT(line(rows), HasSubstr("| 15.00 (15.00 to 15.00) |"));
}

TEST(Reproduction, VerdictsFollowTheIntervalAlone) {
  const auto verdict = [](double thesis, double low, double high) {
    return judged(thesis, Ratio{(low + high) / 2, low, high});
  };
  EXPECT_EQ(verdict(3, 2.5, 3.0), Verdict::holds);
  EXPECT_EQ(verdict(3, 4, 5), Verdict::holds);
  EXPECT_EQ(verdict(3, 1.5, 2.9), Verdict::smaller);
  EXPECT_EQ(verdict(3, 0.9, 2.9), Verdict::smaller);
  EXPECT_EQ(verdict(3, 0.5, 0.9), Verdict::reversed);
  EXPECT_EQ(verdict(3, 0.9, 3.1), Verdict::undecided);
  EXPECT_EQ(verdict(0.5, 0.4, 0.6), Verdict::holds);
  EXPECT_EQ(verdict(0.5, 0.7, 1.1), Verdict::holds);
  EXPECT_EQ(verdict(0.5, 0.2, 0.4), Verdict::smaller);
  EXPECT_EQ(verdict(0.5, 1.1, 1.3), Verdict::reversed);
  EXPECT_EQ(verdict(0.5, 0.4, 1.1), Verdict::undecided);
  EXPECT_EQ(verdict(1, 0.8, 1.2), Verdict::holds);
  EXPECT_EQ(verdict(1, 0.5, 0.8), Verdict::smaller);
}

TEST(Reproduction, EqualErrorCanOnlyWeakenAVerdict) {
  EXPECT_EQ(judged(Verdict::holds, std::nullopt), Verdict::holds);
  EXPECT_EQ(judged(Verdict::holds, Verdict::holds), Verdict::holds);
  EXPECT_EQ(judged(Verdict::holds, Verdict::smaller), Verdict::notAtEqualError);
  EXPECT_EQ(judged(Verdict::holds, Verdict::reversed), Verdict::notAtEqualError);
  EXPECT_EQ(judged(Verdict::undecided, Verdict::smaller), Verdict::notAtEqualError);
  EXPECT_EQ(judged(Verdict::holds, Verdict::undecided), Verdict::undecided);
  EXPECT_EQ(judged(Verdict::undecided, Verdict::holds), Verdict::undecided);
  EXPECT_EQ(judged(Verdict::holds, Verdict::notMeasured), Verdict::notMeasured);
  for (const Verdict below : {Verdict::smaller, Verdict::reversed, Verdict::notMeasured})
    EXPECT_EQ(judged(below, Verdict::holds), below);
}

/// Rows of pcss with other parameters are no side of this claim.
const std::string kSamples = changed("/pcss?", "samples=1$");

TEST(Reproduction, EqualErrorTakesTheQuickestRowThatErrsNoMore) {
  const Row slow = row("pcss", 30, "samples", 0.1), fast = row("vssm", 2, {}, 0.15);
  const auto with = [&](const Row& other) { return line({slow, fast, other}, kSamples); };
  const std::string found = with(row("pcss", 3, "taps", 0.15));
  EXPECT_THAT(found, HasSubstr("| 1.50 (1.50 to 1.50), n = 3: pcss taps=1; differ in none |"));
  EXPECT_THAT(found, HasSubstr("| not at equal error |"));
  EXPECT_THAT(with(row("pcss", 3, "taps", 0.16)),
              HasSubstr("| 15.00 (15.00 to 15.00), n = 3: pcss samples=1"));
  Row elsewhere = row("pcss", 3, "taps", 0.15);
  elsewhere.what.scene = "statue";
  EXPECT_THAT(with(elsewhere), HasSubstr("| holds |"));
  Row once = row("pcss", 3, "taps", 0.15);
  once.cost.frameMs.turns = 1;
  EXPECT_THAT(with(once), HasSubstr("| refused: n = 1: pcss taps=1"));
  EXPECT_THAT(with(once), HasSubstr("| not measured |"));
}

TEST(Reproduction, EqualErrorTakesRowsOfTheNewestVersionFirst) {
  const auto by = [](Row row, const std::string& program, std::size_t line) {
    row.provenance.program = program;
    row.line = line;
    return row;
  };
  const Row slow = by(row("pcss", 30, "samples", 0.1), "new", 3),
            fast = by(row("vssm", 2, {}, 0.15), "new", 4), old = by(row("pcss", 3, "taps", 0.15), "old", 1);
  EXPECT_THAT(line({old, by(row("pcss", 4, "cells", 0.15), "new", 2), slow, fast}, kSamples),
              HasSubstr("| 2.00 (2.00 to 2.00), n = 3: pcss cells=1"));
  const Row worse = by(row("pcss", 30, "samples", 0.2), "new", 3);
  EXPECT_THAT(line({old, worse, fast}, kSamples), HasSubstr("| 1.50 (1.50 to 1.50), n = 3: pcss taps=1"))
      << "the newest version has none";
}

TEST(Reproduction, EqualErrorIsThatOfThePenumbraWhereItIsKnown) {
  Row slow = row("pcss", 30, "samples"), fast = row("vssm", 2, {}, 0.01), few = row("pcss", 3, "taps", 0.5);
  for (Row* each : {&slow, &fast, &few}) each->penumbra = each->error;
  slow.penumbra->rmse = fast.penumbra->rmse = few.penumbra->rmse = 0.2;
  EXPECT_THAT(line({slow, fast, few}, kSamples), HasSubstr("| 1.50 (1.50 to 1.50), n = 3: pcss taps=1"));
}

TEST(Reproduction, EqualErrorSaysWhyThereIsNone) {
  const Row slow = row("pcss", 30, "samples", 0.1);
  const std::string better = line({slow, row("vssm", 2, {}, 0.05)});
  EXPECT_THAT(better, HasSubstr("| -: no row of pcss reaches 0.05 |"));
  EXPECT_THAT(better, HasSubstr("| holds |"));
  Row noisy = row("vssm", 2, {}, 0.05);
  noisy.error.noise_floor = 0.06;
  EXPECT_THAT(line({slow, noisy}), HasSubstr("| -: the reference's noise hides the errors |"));
  EXPECT_THAT(line({row("vssm", 30, "cells"), row("vssm", 2)}, changed("/pcss?", "cells=1$")),
              HasSubstr("| -: two settings of one technique |"));
  Row large = slow;
  large.cost.memoryBytes *= 20;
  const std::string bytes = line({large, row("vssm", 2)}, changed("\"frame\"", "\"memory\""));
  EXPECT_THAT(bytes, HasSubstr("| memory | 14.80 | 20.00 | - |"));
  EXPECT_THAT(bytes, HasSubstr("| -: a claim of memory | holds |"));
}

TEST(Reproduction, EverySharedSettingThatDiffersIsNamed) {
  Row first = row("pcss", 30), second = row("vssm", 2);
  EXPECT_EQ(differingSettings(first, second), "none");
  first.what.parameters = {{"pcss.shadow_map_size", "512"}, {"pcss.samples", "64"}};
  second.what.parameters = {{"vssm.cells", "3"}};
  EXPECT_EQ(differingSettings(first, second), "none");  // nothing says what vssm's default is
  second.cost.details = R"({"parameters": {"vssm.shadow_map_size": "1024", "vssm.cells": "3"}})";
  EXPECT_EQ(differingSettings(first, second), "shadow_map_size 512 / 1024");
  second.what.lightSize = 2;
  second.what.width = 64;
  second.what.height = 48;
  second.what.environment = "/somewhere/sky.hdr";
  second.cost.renderer = "other";
  second.what.reference = {1024, 0.01, 2, 3};
  const std::string all = differingSettings(first, second);
  for (const char* part : {"light_size 0 / 2", "size 1280x720 / 64x48", "environment - / sky.hdr",
                           "renderer llvmpipe / other", "shadow_map_size 512 / 1024", "spp 256 / 1024",
                           "noise 0 / 0.01", "bounces 1 / 2", "interfaces 0 / 3"})
    EXPECT_THAT(all, HasSubstr(part));
  EXPECT_THAT(all, Not(HasSubstr("somewhere")));
}

TEST(Reproduction, VersionsThatDifferAreNamed) {
  Row first = row("vssm", 30), second = row("vssm", 2);
  first.provenance = {"1", "files", {{"vssm", "vssm.so", "a"}, {"airlight", "airlight.so", "b"}}};
  second.provenance = first.provenance;
  EXPECT_EQ(differingSettings(first, second), "none");
  second.provenance = {"1", "edited", {{"vssm", "vssm.so", "c"}}};
  EXPECT_EQ(differingSettings(first, second), "scene files files / edited, module vssm a / c");
  second.what.scene = "another";
  EXPECT_THAT(differingSettings(first, second), Not(HasSubstr("scene files"))) << "other scenes have others";
}

TEST(Reproduction, SettingsOfOneTechniqueDifferFromItsDefaults) {
  Row first = row("vssm", 30, "cells"), second = row("vssm", 2);
  EXPECT_EQ(differingSettings(first, second), "cells 1 / default");
  EXPECT_EQ(differingSettings(second, first), "cells default / 1");
  second.cost.details = R"({"parameters": {"vssm.cells": "3"}})";
  EXPECT_EQ(differingSettings(first, second), "cells 1 / 3");
}

TEST(Reproduction, SharedSettingsOfCombinationsKeepTheirTechnique) {
  Row first = row("airlight,volume_caustics", 30), second = row("airlight,volume_caustics", 2);
  first.what.parameters = {{"airlight.steps", "2"}, {"volume_caustics.steps", "2"}};
  second.what.parameters = {{"airlight.steps", "5"}, {"volume_caustics.steps", "2"}};
  EXPECT_EQ(differingSettings(first, second), "airlight.steps 2 / 5");
}

TEST(Reproduction, SettingsAreOfATechniqueWhateverTermsItIsAskedFor) {
  Row first = row("vssm:visibility", 30, "cells"), second = row("vssm", 2);
  first.what.parameters = {{"vssm.cells", "1"}};
  second.what.parameters = {{"vssm.cells", "3"}};
  EXPECT_EQ(differingSettings(first, second), "cells 1 / 3");
}

TEST(Reproduction, WhatIsNotReproducedSaysWhy) {
  const std::string missing = "[[claims]]\nwhere = \"7.6, table\"\nwhat = \"curves\"\n";
  const std::string shown = line({}, missing + "because = \"limn draws none\"\n");
  EXPECT_THAT(
      shown,
      HasSubstr("| curves | - | - | - | - | - | - | - | not reproduced, because limn draws none | - |"));
  EXPECT_THAT(line({}, missing + "thesis = 2\nbecause = \"x\"\n"), HasSubstr("| curves | - | 2.00 |"));
  for (const char* more :
       {"", "because = \"\"\n", "because = \"x\"\nsuite = \"ch7\"\n", "because = \"x\"\nthesis = -1\n"})
    EXPECT_THROW(parseClaims(missing + more, "c"), UsageError) << more;
}

TEST(Reproduction, ClaimsHaveTheTitleOfTheirPage) {
  const Claims other = parseClaims(
      "title = \"Radiance caching\"\npreface = [\"On a GPU of 2019.\", \"Ratios alone.\"]\n" + kClaim, "c");
  EXPECT_EQ(other.title, "Radiance caching");
  EXPECT_EQ(other.preface, "On a GPU of 2019.\nRatios alone.");
  EXPECT_EQ(other.all.size(), 1u);
  const Claims untitled = parseClaims(kClaim, "c");
  EXPECT_THAT(untitled.title, Not(HasSubstr("thesis")));
  EXPECT_EQ(untitled.preface, "");
}

TEST(Reproduction, BrokenClaimsNameTheirPlace) {
  for (const std::string& text : {std::string("x = 1"), std::string("[[claims]]\n"), kClaim + "typo = 1\n",
                                  kClaim + "[[claims]]\nwhere = 1\n", std::string("[[claims]")})
    EXPECT_THROW(parseClaims(text, "c"), UsageError) << text;
}

TEST(Reproduction, DeeplyNestedClaimsAreRefusedBeforeParsing) {
  std::string dotted = "[[claims]]\nwhere";
  for (int i = 0; i < 50'000; ++i) dotted += ".a";
  try {
    parseClaims(dotted + " = 1\n", "c");
    FAIL() << "accepted";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("c:2: nested deeper than 16 levels"));
  }
}

/// Of everything that `limn bench thesis` measures, in one folder, in the turns that its suites ask for.
TEST(Reproduction, TheThesissSuiteMeasuresEveryClaimOnce) {
  const std::filesystem::path folder = std::filesystem::path(limn::test::kSourceDir) / "benchmarks";
  const auto claims = readClaims(folder / "reproduction.claims").all;
  EXPECT_GE(std::ranges::count_if(claims, [](const Claim& claim) { return claim.because.empty(); }), 25);
  std::vector<Row> rows;
  for (const Case& what : readSuite(folder / "thesis.toml").cases) {
    rows.push_back(row(what.technique, 1));
    rows.back().what = what;
    rows.back().cost.frameMs.turns = what.turns;
  }
  const std::string page = reproductionMarkdown(claims, rows);
  const std::string tables = page.substr(page.find("## Chapter"));
  EXPECT_THAT(tables, Not(HasSubstr("not measured")));
  EXPECT_THAT(tables, Not(HasSubstr("refused")));
}

}  // namespace
}  // namespace limn::bench
