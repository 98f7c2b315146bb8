#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <new>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/version.h"
#include "core/bench/results_file.h"
#include "core/bench/row.h"
#include "core/bench/runner.h"
#include "core/bench/tables.h"
#include "core/question/render_command.h"
#include "tests/unit/bench/bench_folder.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;
using test::exampleCase;
using test::exampleRow;
using BenchRunner = test::BenchFolder;

/// Callbacks that count their calls; the picture of technique "bad" fails.
struct Fakes {
  int references = 0, measurements = 0, timings = 0;
  Callbacks callbacks() {
    Callbacks made;
    made.reference = [this](const Case& c) {
      ++references;
      Reference reference{Image::rgb(c.width, c.height), "reference.exr", 0.001, std::nullopt};
      std::ranges::fill(reference.image.data(), 0.5f);
      return reference;
    };
    made.keepPicture = [](const std::string& name, const Image&) { return "pictures/" + name + ".png"; };
    made.measure = [this](const Case& c) {
      ++measurements;
      if (c.technique == "bad") throw Error("shader does not compile");
      Measurement m{Image::rgb(c.width, c.height), {}};
      std::ranges::fill(m.image.data(), 0.6f);
      m.cost.frameMs = {1, 1, 1, c.frames, std::vector<double>(static_cast<std::size_t>(c.frames), 1)};
      return m;
    };
    made.time = [this](const Case& c) {
      if (c.technique == "lost") throw Error("out of memory");
      return std::vector<double>(static_cast<std::size_t>(c.frames), ++timings);
    };
    return made;
  }
};

TEST_F(BenchRunner, RunnerSharesReferencesRecordsFailuresAndResumes) {
  const std::vector<Case> cases = {exampleCase("pcss", 16), exampleCase("bad"), exampleCase("pcss", 64)};
  Fakes fakes;
  {
    ResultsFile results(path_);
    const Summary summary = runCases(cases, "llvmpipe", results, fakes.callbacks());
    EXPECT_EQ(summary.done, 2);
    EXPECT_EQ(summary.failed, 1);
  }
  EXPECT_EQ(fakes.references, 1);
  EXPECT_EQ(fakes.measurements, 3);

  ResultsFile results(path_);
  std::vector<Progress::State> states;
  Callbacks callbacks = fakes.callbacks();
  callbacks.progress = [&](const Progress& progress) { states.push_back(progress.state); };
  const Summary again = runCases(cases, "llvmpipe", results, callbacks);
  EXPECT_EQ(again.skipped, 2);
  EXPECT_EQ(again.failed, 1);
  EXPECT_EQ(fakes.measurements, 4);
  using State = Progress::State;
  EXPECT_EQ(states, (std::vector{State::skipped, State::started, State::failed, State::skipped}));

  EXPECT_EQ(runCases(cases, "another GPU", results, fakes.callbacks()).done, 2);
  const Row row = results.rows().front();
  EXPECT_NEAR(row.error.rmse, 0.1, 1e-6);
  ASSERT_TRUE(row.penumbra);
  EXPECT_EQ(row.cost.renderer, "llvmpipe");
  EXPECT_EQ(row.picture, "");
  ASSERT_FALSE(row.spectrum.empty());
  EXPECT_GT(row.spectrum[0], 10 * row.spectrum[5]) << "the error is the same everywhere";
}

TEST_F(BenchRunner, PicturesOfRowsHoldTheirCommand) {
  std::vector<Case> cases = {exampleCase("pcss", 16), exampleCase(kSeparationFloor)};
  for (Case& c : cases) c.picture = true;
  std::map<std::string, std::map<std::string, std::string>> kept;
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  callbacks.keepPicture = [&](const std::string& name, const Image& image) {
    kept[name] = image.metadata();
    return name;
  };
  ResultsFile results(path_);
  ASSERT_EQ(runCases(cases, "llvmpipe", results, callbacks).done, 2);
  const std::string key = rowKey(cases[0], "llvmpipe"), floor = rowKey(cases[1], "llvmpipe");
  const std::map<std::string, std::string> signature = {
      {"command", renderCommand(cases[0], "pcss", cases[0].parameters) + " --out " + key + ".png"},
      {"version", version()}};
  EXPECT_EQ(kept.at(key), signature);
  EXPECT_TRUE(kept.at(key + ".difference").empty());
  EXPECT_TRUE(kept.at(floor).empty()) << "no command renders it";
}

TEST_F(BenchRunner, FurtherTurnsLengthenTheRowsAndResume) {
  std::vector<Case> cases = {exampleCase("pcss", 16), exampleCase("bad"), exampleCase("lost"),
                             exampleCase("pcss", 64)};
  for (Case& c : cases) {
    c.frames = 2;
    c.turns = 3;
  }
  Fakes fakes;
  {
    // Interrupted in the second turn, after its first row.
    ResultsFile results(path_);
    Callbacks callbacks = fakes.callbacks();
    callbacks.progress = [&](const Progress& progress) {
      if (fakes.timings == 1 && progress.state == Progress::State::started)
        throw std::runtime_error("interrupted");
    };
    EXPECT_THROW(runCases(cases, "llvmpipe", results, callbacks), std::runtime_error);
  }
  EXPECT_EQ(fakes.timings, 1);
  ResultsFile results(path_);
  const Summary summary = runCases(cases, "llvmpipe", results, fakes.callbacks());
  EXPECT_EQ(summary.skipped, 3);
  EXPECT_EQ(fakes.timings, 4) << "two rows, two further turns each";
  const FrameTime& first = results.find(rowKey(cases[0], "llvmpipe"))->cost.frameMs;
  EXPECT_EQ(first.turns, 3);
  EXPECT_EQ(first.n, 6);
  EXPECT_EQ(first.samples.size(), 6u);
  EXPECT_EQ(first.median, 1);
  EXPECT_EQ(first.samples.back(), 3);
  const FrameTime& lost = results.find(rowKey(cases[2], "llvmpipe"))->cost.frameMs;
  EXPECT_EQ(lost.turns, 1) << "a turn that fails leaves the row as it was";
  EXPECT_EQ(rowFromJson(toJson(results.rows()[0])).cost.frameMs.turns, 3);
}

TEST_F(BenchRunner, ARowThatAnotherMachineBeganIsMeasuredAgain) {
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

TEST_F(BenchRunner, BoundsAreTimedInEveryTurnOfTheRowsThatAskForThem) {
  std::vector<Case> cases = {exampleCase("pcss", 16), exampleCase("pcss", 64), exampleCase("airlight")};
  for (Case& c : cases) c.turns = 3;
  cases[0].bound = cases[2].bound = true;
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  double turn = 0;
  callbacks.bound = [&](const Case& c) -> std::optional<BoundTime> {
    if (c.technique == "airlight") return std::nullopt;  // it has none
    turn += 1;
    return BoundTime{.own = {2 * turn, 2 * turn}, .bound = {turn, turn}, .turns = 1};
  };
  ResultsFile results(path_);
  runCases(cases, "llvmpipe", results, callbacks);
  const std::optional<BoundTime>& time = results.find(rowKey(cases[0], "llvmpipe"))->cost.bound;
  ASSERT_TRUE(time);
  EXPECT_EQ(time->turns, 3);
  EXPECT_EQ(time->own, (std::vector<double>{2, 2, 4, 4, 6, 6}));
  EXPECT_EQ(time->bound, (std::vector<double>{1, 1, 2, 2, 3, 3}));
  for (const std::size_t i : {1u, 2u}) {
    const Row* row = results.find(rowKey(cases[i], "llvmpipe"));
    EXPECT_FALSE(row->cost.bound) << cases[i].technique;
    EXPECT_EQ(row->cost.frameMs.turns, 3);
  }
}

TEST_F(BenchRunner, RunnerKeepsPicturesThatAreWanted) {
  Case wanted = exampleCase();
  wanted.picture = true;
  const std::vector<Case> cases = {wanted, exampleCase("pcss", 64)};
  Fakes fakes;
  ResultsFile results(path_);
  runCases(cases, "llvmpipe", results, fakes.callbacks());
  EXPECT_EQ(results.rows()[0].picture, "pictures/" + rowKey(wanted, "llvmpipe") + ".png");
  EXPECT_EQ(results.rows()[0].difference, "pictures/" + rowKey(wanted, "llvmpipe") + ".difference.png");
  EXPECT_EQ(results.rows()[1].picture, "");
  EXPECT_EQ(rowFromJson(toJson(results.rows()[0])).picture, results.rows()[0].picture);
  const std::string shown = picturesMarkdown(makeTables(results.rows()).front());
  EXPECT_NE(shown.find("| ![](pictures/reference.png) | ![](" + results.rows()[0].picture + ") | |"),
            std::string::npos)
      << shown;
}

TEST_F(BenchRunner, WhatTheSuiteSaysAnewIsNotLeftAsItWas) {
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

TEST_F(BenchRunner, ARowBeyondTheLimitOfMaskedPixelsIsMeasuredAgain) {
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

/// JSON has no infinity: a row with one could not be read again, and its file neither.
TEST_F(BenchRunner, ErrorsThatAreNotFiniteFailTheirRow) {
  const std::vector<Case> cases = {exampleCase("pcss"), exampleCase("overflow"), exampleCase("spectrum")};
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  callbacks.measure = [measure = callbacks.measure](const Case& c) {
    Measurement m = measure(c);
    if (c.technique == "overflow") std::ranges::fill(m.image.data(), 3e38f);
    if (c.technique == "spectrum") std::ranges::fill(m.image.data(), 1e37f);
    return m;
  };
  {
    ResultsFile results(path_);
    const Summary summary = runCases(cases, "x", results, callbacks);
    EXPECT_EQ(summary.done, 1);
    EXPECT_EQ(summary.failed, 2);
  }
  const std::vector<Row> rows = readRows(path_);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].failure, "");
  EXPECT_EQ(rows[1].failure,
            "the structured error is not finite; the picture has values too large to be compared");
  EXPECT_EQ(rows[2].failure,
            "the spectrum of the error is not finite; the picture has values too large to be compared");
}

TEST_F(BenchRunner, APenumbraThatIsMaskedIsNone) {
  const std::vector<Case> cases = {exampleCase("pcss")};
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  callbacks.reference = [](const Case& c) {
    Reference reference{Image::rgb(c.width, c.height), "reference.exr", 0.001, std::nullopt};
    std::ranges::fill(reference.image.data(), 1.0f);
    for (int channel = 0; channel < 3; ++channel) reference.image.at(3, 2, channel) = 0.5f;
    reference.image.addChannel("masked");
    reference.image.at(3, 2, reference.image.channel("masked")) = 1.0f;
    return reference;
  };
  ResultsFile results(path_);
  runCases(cases, "x", results, callbacks);
  const Row& row = results.rows().at(0);
  EXPECT_EQ(row.failure, "");
  EXPECT_FALSE(row.penumbra);
  EXPECT_NEAR(row.error.rmse, 0.4, 1e-6);
}

TEST_F(BenchRunner, WhateverACaseThrowsLosesItsOwnRowOnly) {
  struct Thrown {
    const char* technique;
    std::function<void()> raise;
    const char* message;
  };
  const std::vector<Thrown> all = {
      {"memory", [] { throw std::bad_alloc(); }, "out of memory"},
      {"foreign", [] { throw std::runtime_error("no such\nthing"); }, "no such thing"},
      {"number", [] { throw 42; }, "something was thrown that is no std::exception"},
      {"usage", [] { throw UsageError("not with this term"); }, "not with this term"}};
  std::vector<Case> cases;
  for (const Thrown& thrown : all) cases.push_back(exampleCase(thrown.technique));
  cases.push_back(exampleCase("pcss"));
  for (Case& c : cases) c.turns = 2;
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  const auto raise = [&](const Case& c) {
    for (const Thrown& thrown : all)
      if (c.technique == thrown.technique) thrown.raise();
  };
  callbacks.measure = [&, measure = callbacks.measure](const Case& c) {
    raise(c);
    return measure(c);
  };
  {
    ResultsFile results(path_);
    const Summary summary = runCases(cases, "x", results, callbacks);
    EXPECT_EQ(summary.failed, 4);
    EXPECT_EQ(summary.done, 1);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(results.rows()[i].failure, all[i].message);
  }
  // Thrown in a later turn they leave the row as it is.
  fs::remove(path_);
  callbacks = fakes.callbacks();
  callbacks.time = [&, time = callbacks.time](const Case& c) {
    raise(c);
    return time(c);
  };
  ResultsFile results(path_);
  EXPECT_EQ(runCases(cases, "x", results, callbacks).done, 5);
  for (const Row& row : results.rows()) EXPECT_EQ(row.failure, "");
}

TEST_F(BenchRunner, AFailureNeverReplacesAGoodRow) {
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

TEST_F(BenchRunner, UnfinishedIsWhatLacksAValidRowOfAllTurns) {
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
TEST_F(BenchRunner, WhatTheSuiteSaysOfRowsIsBroughtUpToDate) {
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

TEST_F(BenchRunner, WhatWasMeasuredWithSomethingElseIsMeasuredAgain) {
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
