// What a run does with rows that are there: which it measures again, which it leaves, and what it restates.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/results_file.h"
#include "core/bench/row.h"
#include "core/bench/runner.h"
#include "tests/unit/bench/bench_folder.h"
#include "tests/unit/bench/bench_rows.h"
#include "tests/unit/bench/fake_callbacks.h"

namespace limn::bench {
namespace {

using test::exampleCase;
using test::exampleRow;
using test::Fakes;
using BenchResume = test::BenchFolder;

TEST_F(BenchResume, ARowThatAnotherMachineBeganIsMeasuredAgain) {
  std::vector<Case> cases = {exampleCase("pcss", 16), exampleCase("pcss", 64)};
  cases[0].frames = cases[1].frames = 2;
  cases[0].turns = 3;
  Fakes fakes;
  const auto run = [&](const std::string& machine, const std::string& driver, bool interrupted = false) {
    ResultsFile results(path_);
    Callbacks callbacks = fakes.callbacks();
    callbacks.machine = machine;
    callbacks.driver = driver;
    callbacks.measure = [&, measure = callbacks.measure](const Case& c) {
      Measurement m = measure(c);
      m.cost.machine = machine;
      m.cost.driver = driver;
      return m;
    };
    if (interrupted) callbacks.time = [](const Case&) -> std::vector<double> { throw Error("interrupted"); };
    runCases(cases, "llvmpipe", results, callbacks);
    return results.rows();
  };
  run("a", "1", true);
  EXPECT_EQ(fakes.measurements, 2);
  const std::vector<Row> rows = run("b", "1");
  EXPECT_EQ(fakes.measurements, 3) << "the row of one turn lacks none";
  EXPECT_EQ(rows[0].cost.machine, "b");
  EXPECT_EQ(rows[0].cost.frameMs.n, 6);
  EXPECT_EQ(rows[1].cost.machine, "a");
  for (Case& c : cases) c.turns = 4;
  EXPECT_EQ(run("b", "2")[0].cost.frameMs.n, 8);
  EXPECT_EQ(fakes.measurements, 5) << "a driver is as good as a machine";
  for (Case& c : cases) c.turns = 5;
  const std::vector<Row> more = run("b", "2");
  EXPECT_EQ(more[0].cost.frameMs.n, 10);
  EXPECT_EQ(more[0].what.turns, 5) << "as the suite has it now";
  EXPECT_EQ(fakes.measurements, 5);
}

/// As limn tune asks for it: one answer compares all rows of a folder.
TEST_F(BenchResume, ARowOfAnotherMachineIsMeasuredAgainWhereThisOneAloneCounts) {
  const std::vector<Case> cases = {exampleCase("pcss", 16)};
  Row known = exampleRow(cases[0], 0.5);
  known.cost.machine = "a";
  known.cost.driver = "1";
  const auto measured = [&](const std::string& machine, const std::string& driver, bool hereAlone) {
    writeTextFile(path_, toJson(known) + "\n");
    Fakes fakes;
    ResultsFile results(path_);
    Callbacks callbacks = fakes.callbacks();
    callbacks.machine = machine;
    callbacks.driver = driver;
    callbacks.hereAlone = hereAlone;
    runCases(cases, "llvmpipe", results, callbacks);
    return fakes.measurements;
  };
  EXPECT_EQ(measured("b", "1", false), 0) << "tables keep it apart";
  EXPECT_EQ(measured("a", "1", true), 0);
  EXPECT_EQ(measured("b", "1", true), 1);
  EXPECT_EQ(measured("a", "2", true), 1);
  known.cost.machine.clear();
  EXPECT_EQ(measured("b", "1", true), 0) << "an earlier version does not say its machine";
}

TEST_F(BenchResume, WhatTheSuiteSaysAnewIsNotLeftAsItWas) {
  Case asked = exampleCase();
  Fakes fakes;
  const auto run = [&] {
    ResultsFile results(path_);
    const std::vector<Case> cases = {asked};
    const int unfinished = static_cast<int>(unfinishedCases(cases, results.rows(), {}).size());
    const Summary summary = runCases(cases, "llvmpipe", results, fakes.callbacks());
    EXPECT_EQ(unfinished, summary.done + summary.failed);
    return readRows(path_).at(0);
  };
  EXPECT_EQ(run().picture, "");
  asked.picture = true;
  EXPECT_NE(run().picture, "");
  EXPECT_EQ(fakes.measurements, 2);
  asked.title = "PCSS";
  asked.baseline = true;
  EXPECT_EQ(run().what.title, "PCSS");
  EXPECT_TRUE(run().what.baseline);
  EXPECT_NE(run().picture, "");
  asked.picture = false;
  EXPECT_NE(run().picture, "") << "what was kept is there";
  EXPECT_EQ(fakes.measurements, 2) << "nothing of this is measured";
}

TEST_F(BenchResume, ARowBeyondTheLimitOfMaskedPixelsIsMeasuredAgain) {
  Row row = exampleRow(exampleCase());
  row.error.masked_share = 0.004;
  writeTextFile(path_, toJson(row) + "\n");
  Case strict = exampleCase();
  strict.maxMaskedShare = 0.003;
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  callbacks.measure = [](const Case&) -> Measurement { throw Error("masked: 0.4 % of the pixels"); };
  ResultsFile results(path_);
  EXPECT_EQ(runCases(std::vector{exampleCase()}, "llvmpipe", results, callbacks).skipped, 1);
  EXPECT_EQ(unfinishedCases(std::vector{strict}, results.rows(), {}).size(), 1u);
  EXPECT_EQ(runCases(std::vector{strict}, "llvmpipe", results, callbacks).failed, 1);
  EXPECT_EQ(readRows(path_).at(0).failure, "masked: 0.4 % of the pixels")
      << "the good row does not keep the limit";
}

TEST_F(BenchResume, AFailureNeverReplacesAGoodRow) {
  const Row good = exampleRow(exampleCase());
  Row failed = good;
  failed.failure = "crashed: Segmentation fault";
  const std::string before = toJson(failed) + "\n" + toJson(good) + "\n" + toJson(failed) + "\n";
  writeTextFile(path_, before);  // as versions wrote it in which a crash in a later turn won
  ASSERT_EQ(readRows(path_).size(), 1u);
  EXPECT_EQ(readRows(path_)[0].failure, "");
  ResultsFile results(path_);
  EXPECT_TRUE(results.contains(good.key));
  results.append(failed);
  EXPECT_TRUE(results.contains(good.key));
  EXPECT_EQ(results.find(good.key)->error.rmse, good.error.rmse);
  results.append(exampleRow(exampleCase(), 0.5));
  EXPECT_EQ(results.find(good.key)->error.rmse, 0.5) << "the last good one";
  // The row is complete where all of its turns are there: neither measured nor timed again.
  Fakes fakes;
  const std::vector<Case> cases = {exampleCase()};
  EXPECT_EQ(runCases(cases, "llvmpipe", results, fakes.callbacks()).skipped, 1);
  EXPECT_EQ(fakes.measurements, 0);
}

TEST_F(BenchResume, UnfinishedIsWhatLacksAValidRowOfAllTurns) {
  const Provenance now{"program 2", "scene", {}};
  Case twice = exampleCase("pcss", 16);
  twice.turns = 2;
  const auto left = [&](const Case& c, const Row& row) {
    const std::vector<Row> rows = {exampleRow(exampleCase("vssm")), row};
    return unfinishedCases(std::vector{c}, rows, [&](const Case&) { return now; }).size();
  };
  Row row = exampleRow(twice);
  row.provenance = now;
  EXPECT_EQ(left(twice, row), 1u) << "a turn is missing";
  EXPECT_EQ(left(exampleCase("pcss", 16), row), 0u);
  EXPECT_EQ(left(exampleCase("pcss", 64), row), 1u) << "another case";
  row.cost.frameMs.turns = 2;
  EXPECT_EQ(left(twice, row), 0u);
  row.cost.renderer = "another GPU";
  row.key = rowKey(twice, "another GPU");
  EXPECT_EQ(left(twice, row), 0u) << "any renderer";
  row.provenance.program = "program 1";
  EXPECT_EQ(left(twice, row), 1u) << "stale";
  row.provenance = now;
  row.failure = "lost";
  EXPECT_EQ(left(twice, row), 1u);
  Row untimed = exampleRow(twice);
  untimed.provenance = now;
  untimed.cost.frameMs = {};
  EXPECT_EQ(left(twice, untimed), 0u) << "there are no turns of what is not timed";
}

/// As in a folder of merged parts, whose rows no run of this process measured.
TEST_F(BenchResume, WhatTheSuiteSaysOfRowsIsBroughtUpToDate) {
  const Provenance now{"program 2", "scene", {}}, then{"program 1", "scene", {}};
  Case twice = exampleCase("pcss", 16);
  twice.turns = 2;
  Row holds = exampleRow(twice), elsewhere = exampleRow(exampleCase("pcss", 64)),
      stale = exampleRow(exampleCase("vssm")), other = exampleRow(exampleCase("savsm"));
  elsewhere.cost.renderer = "another GPU";
  elsewhere.key = rowKey(elsewhere.what, "another GPU");
  for (Row* row : {&holds, &elsewhere, &other}) row->provenance = now;
  stale.provenance = then;
  std::vector<Case> cases = {twice, elsewhere.what, stale.what};
  for (Case& c : cases) {
    c.title = "new label";
    c.baseline = true;
  }
  ResultsFile results(path_);
  for (const Row& row : {holds, elsewhere, stale, other}) results.append(row);
  restateRows(cases, results, [&](const Case&) { return now; });
  const std::vector<Row> rows = readRows(path_);
  ASSERT_EQ(rows.size(), 4u);
  for (const Row& row : rows) {
    const bool changed = row.key == holds.key || row.key == elsewhere.key;
    EXPECT_EQ(row.what.title, changed ? "new label" : "") << row.what.technique;
    EXPECT_EQ(row.what.baseline, changed) << row.what.technique;
  }
  const std::string text = readTextFile(path_);
  restateRows(cases, results, [&](const Case&) { return now; });
  EXPECT_EQ(readTextFile(path_), text) << "nothing changed since";
}

TEST_F(BenchResume, WhatWasMeasuredWithSomethingElseIsMeasuredAgain) {
  const std::vector<Case> cases = {exampleCase("pcss"), exampleCase("vssm")};
  Fakes fakes;
  Provenance now{"program 1", "scene 1", {}};
  const auto provenance = [&](const Case& c) {
    Provenance p = now;
    p.modules = {{c.technique, "/lib/" + c.technique + ".so", c.technique == "pcss" ? "old" : "same"}};
    return p;
  };
  const auto run = [&](const auto& what) {
    ResultsFile results(path_);
    Callbacks callbacks = fakes.callbacks();
    callbacks.provenance = what;
    const auto stale = staleRows(cases, "x", results, what);
    const Summary summary = runCases(cases, "x", results, callbacks);
    EXPECT_EQ(summary.done + summary.skipped, 2);
    int count = 0;
    for (const auto& [reason, rows] : stale) count += rows;
    return std::pair(summary.done, count > 0 ? stale.begin()->first : std::string());
  };
  EXPECT_EQ(run(provenance), std::pair(2, std::string()));
  EXPECT_EQ(run(provenance), std::pair(0, std::string()));
  EXPECT_EQ(readRows(path_)[0].provenance.modules[0].file, "/lib/pcss.so");
  now.scene = "scene 2";
  EXPECT_EQ(run(provenance), std::pair(2, std::string("the scene has changed")));
  now.program = "program 2";
  EXPECT_EQ(run(provenance), std::pair(2, std::string("the program has changed")));
  const auto newer = [&](const Case& c) {
    Provenance p = provenance(c);
    p.modules[0].file = "/elsewhere.so";
    if (c.technique == "pcss") p.modules[0].hash = "new";
    return p;
  };
  EXPECT_EQ(run(newer), std::pair(1, std::string("technique pcss has changed")));
  EXPECT_EQ(run(newer), std::pair(0, std::string())) << "where a file lies does not count";
  EXPECT_EQ(readRows(path_).size(), 2u) << "the key is that of what was asked";

  // Rows of earlier versions do not say what they were measured with.
  std::string old;
  for (Row row : readRows(path_)) {
    row.provenance = {};
    old += toJson(row) + "\n";
  }
  EXPECT_EQ(old.find("provenance"), std::string::npos);
  writeTextFile(path_, old);
  EXPECT_EQ(run(newer), std::pair(2, std::string("an earlier version did not record what it used")));
}

}  // namespace
}  // namespace limn::bench
