// A run of cases: references, failures, pictures, turns and bounds, and that an interrupted one goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/version.h"
#include "core/bench/results_file.h"
#include "core/bench/row.h"
#include "core/bench/runner.h"
#include "core/bench/tables.h"
#include "core/question/render_command.h"
#include "tests/unit/bench/bench_folder.h"
#include "tests/unit/bench/bench_rows.h"
#include "tests/unit/bench/fake_callbacks.h"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;
using test::exampleCase;
using test::Fakes;
using BenchRunner = test::BenchFolder;

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

/// As where a suite includes one without pictures and one with them.
TEST_F(BenchRunner, PicturesHaveThatOfTheirReferenceBesideThem) {
  std::vector<Case> cases = {exampleCase("pcss", 16), exampleCase("pcss", 32), exampleCase("pcss", 64)};
  cases[1].picture = cases[2].picture = true;
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  std::vector<bool> pictured;
  callbacks.reference = [&, render = callbacks.reference](const Case& c) {
    pictured.push_back(c.picture);
    return render(c);
  };
  ResultsFile results(path_);
  ASSERT_EQ(runCases(cases, "llvmpipe", results, callbacks).done, 3);
  EXPECT_EQ(pictured, (std::vector{false, true}));
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

/// So that a scene is opened once in a turn, though suites come back to it.
TEST_F(BenchRunner, FurtherTurnsGoByScene) {
  std::vector<Case> cases(4, exampleCase("pcss", 16));
  cases[0].scene = cases[2].scene = "balls";
  cases[1].scene = cases[3].scene = "statue";
  cases[2].lightSize = 0.3;
  cases[3].lightSize = 0.6;
  for (Case& c : cases) c.turns = 2;
  Fakes fakes;
  Callbacks callbacks = fakes.callbacks();
  std::vector<int> first, second, places;
  callbacks.progress = [&](const Progress& progress) {
    if (progress.state != Progress::State::started) return;
    (progress.turn == 1 ? first : second).push_back(progress.index);
    places.push_back(progress.place);
  };
  ResultsFile results(path_);
  ASSERT_EQ(runCases(cases, "llvmpipe", results, callbacks).done, 4);
  EXPECT_EQ(first, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(second, (std::vector{0, 2, 1, 3}));
  EXPECT_EQ(places, (std::vector{0, 1, 2, 3, 0, 1, 2, 3}));
  EXPECT_EQ(results.rows()[1].what.scene, "statue") << "the file keeps its order";
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
  const Summary summary = runCases(cases, "x", results, callbacks);
  EXPECT_EQ(summary.done, 5);
  EXPECT_EQ(summary.failed, 0);
  EXPECT_EQ(summary.shortened, 4) << "which the exit status tells";
  for (const Row& row : results.rows()) EXPECT_EQ(row.failure, "");
  const Summary again = runCases(cases, "x", results, fakes.callbacks());
  EXPECT_EQ(again.skipped, 5);
  EXPECT_EQ(again.shortened, 0) << "the turns are made up for";
}

}  // namespace
}  // namespace limn::bench
