#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/merge.h"
#include "core/bench/regression.h"
#include "core/bench/results_file.h"
#include "core/bench/row.h"
#include "core/bench/runner.h"
#include "core/bench/tables.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;
using test::exampleCase;
using test::exampleRow;

class BenchResults : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("limn_bench_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = folder_ / "results.jsonl";
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_, path_;
};

TEST_F(BenchResults, RowsSurviveJson) {
  Case played = exampleCase();
  played.fps = 24;
  played.sigmaA = "0.1,0.2,0.3";
  played.sigmaS = "0.5";
  played.g = 0.25;
  played.eye = "0,1,3";
  played.target = "0,0,0";
  played.fov = 30;
  played.animation = "walk";
  played.lightSettings = {"key.size=0.5"};
  played.defaultLights = "on";
  played.environmentRotation = 90;
  played.environmentScale = 2;
  played.grid = "smoke";
  played.bound = true;
  Row row = exampleRow(played);
  row.cost.bound = BoundTime{.own = {3, 4}, .bound = {2, 2.5}, .turns = 2};
  const std::string line = toJson(row);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const Row back = rowFromJson(line);
  EXPECT_EQ(back.what, row.what);
  EXPECT_EQ(back.key, row.key);
  EXPECT_EQ(back.referenceFile, row.referenceFile);
  EXPECT_EQ(back.referenceNoise, row.referenceNoise);
  EXPECT_EQ(back.referenceSeconds, row.referenceSeconds);
  EXPECT_EQ(back.error.rmse, row.error.rmse);
  EXPECT_EQ(back.error.psnr, row.error.psnr);
  EXPECT_EQ(back.error.noise_floor, row.error.noise_floor);
  EXPECT_EQ(back.error.pixels, row.error.pixels);
  ASSERT_TRUE(back.penumbra);
  ASSERT_TRUE(back.misjudged);
  EXPECT_EQ(back.misjudged->litInUmbra, row.misjudged->litInUmbra);
  EXPECT_EQ(back.cost.frameMs.q3, row.cost.frameMs.q3);
  EXPECT_EQ(back.cost.frameMs.samples, row.cost.frameMs.samples);
  ASSERT_TRUE(back.cost.bound);
  EXPECT_EQ(back.cost.bound->own, row.cost.bound->own);
  EXPECT_EQ(back.cost.bound->bound, row.cost.bound->bound);
  EXPECT_EQ(back.cost.bound->turns, 2);
  EXPECT_EQ(back.cost.memoryBytes, row.cost.memoryBytes);
  EXPECT_NE(back.cost.details.find("shadow map"), std::string::npos);
  EXPECT_EQ(toJson(back), line);
}

TEST_F(BenchResults, WhatEarlierVersionsLackedIsOptional) {
  Row row = exampleRow(exampleCase());
  row.what.picture = true;
  row.picture = "pictures/a.png";
  row.difference = "pictures/a.difference.png";
  row.spectrum = {0.5, 0.25};
  row.cost.driver = "Mesa 22.3.6";
  row.cost.machine = "a processor";
  row.cost.lights = 2;
  row.cost.qualityParameters = {"pcss.samples"};
  auto json = nlohmann::json::parse(toJson(row));
  EXPECT_EQ(nlohmann::json::parse(toJson(rowFromJson(json.dump()))), json);
  for (const char* key : {"spectrum", "difference", "penumbra", "changes"}) json.erase(key);
  json["medium"] = {{"sigma_s", 0.5}};  // a number, not a text
  for (const char* key : {"driver", "machine", "lights", "quality_parameters"}) json["stats"].erase(key);
  const Row old = rowFromJson(json.dump());
  EXPECT_TRUE(old.spectrum.empty() && old.difference.empty() && !old.penumbra);
  EXPECT_TRUE(old.cost.driver.empty() && old.cost.machine.empty() && old.cost.qualityParameters.empty());
  EXPECT_EQ(old.what.sigmaA, "");
  EXPECT_EQ(old.what.sigmaS, "0.5");
  EXPECT_FALSE(old.what.g);
  EXPECT_EQ(old.cost.lights, 0);
  EXPECT_EQ(referencePicture(old), "pictures/a.png");
}

TEST_F(BenchResults, BrokenRowsAreRefused) {
  for (const char* text : {"", "{", "[]", "{}", R"({"key":1})", "null"})
    EXPECT_THROW(rowFromJson(text), Error) << text;
}

TEST_F(BenchResults, ReadingLeavesATornFileAsItIs) {
  const Row first = exampleRow(exampleCase()), again = exampleRow(exampleCase(), 0.5);
  const std::string text = toJson(first) + "\n" + toJson(again) + "\n{";
  writeTextFile(path_, text);
  const std::vector<Row> rows = readRows(path_);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].error.rmse, 0.5);
  EXPECT_EQ(readTextFile(path_), text);
}

TEST_F(BenchResults, AppendedRowsAreThereAfterReopening) {
  const Row a = exampleRow(exampleCase("pcss", 16)), b = exampleRow(exampleCase("pcss", 64));
  {
    ResultsFile file(path_);
    EXPECT_TRUE(file.rows().empty());
    file.append(a);
    file.append(b);
    EXPECT_TRUE(file.contains(a.key));
  }
  ResultsFile file(path_);
  EXPECT_EQ(file.rows().size(), 2u);
  EXPECT_TRUE(file.contains(a.key) && file.contains(b.key));
}

TEST_F(BenchResults, TornLastLineIsCutOffAtEveryLength) {
  const Row a = exampleRow(exampleCase("pcss", 16)), b = exampleRow(exampleCase("pcss", 64));
  const std::string first = toJson(a) + "\n", second = toJson(b);
  for (std::size_t length = 1; length <= second.size(); length += 37) {
    writeTextFile(path_, first + second.substr(0, length));
    {
      ResultsFile file(path_);
      EXPECT_EQ(file.rows().size(), 1u);
      EXPECT_FALSE(file.contains(b.key));
      file.append(b);
    }
    EXPECT_EQ(readTextFile(path_), first + second + "\n");
  }
}

TEST_F(BenchResults, BrokenLineInTheMiddleIsAnError) {
  writeTextFile(path_, toJson(exampleRow(exampleCase())) + "\nnonsense\n");
  try {
    ResultsFile file(path_);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("results.jsonl:2: not a row"), std::string::npos)
        << error.what();
  }
}

TEST_F(BenchResults, FailedRowsAreTriedAgain) {
  Row failed = exampleRow(exampleCase());
  failed.failure = "no driver";
  ResultsFile file(path_);
  file.append(failed);
  EXPECT_FALSE(file.contains(failed.key));
  file.append(exampleRow(exampleCase()));
  EXPECT_TRUE(file.contains(failed.key));
  ASSERT_EQ(file.rows().size(), 1u);
  EXPECT_TRUE(file.rows()[0].failure.empty());
}

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

TEST_F(BenchResults, RunnerSharesReferencesRecordsFailuresAndResumes) {
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

TEST_F(BenchResults, FurtherTurnsLengthenTheRowsAndResume) {
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

TEST_F(BenchResults, BoundsAreTimedInEveryTurnOfTheRowsThatAskForThem) {
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

TEST_F(BenchResults, RunnerKeepsPicturesThatAreWanted) {
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
TEST_F(BenchResults, ErrorsThatAreNotFiniteFailTheirRow) {
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

TEST_F(BenchResults, APenumbraThatIsMaskedIsNone) {
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

TEST_F(BenchResults, WhateverACaseThrowsLosesItsOwnRowOnly) {
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

TEST_F(BenchResults, AFailureNeverReplacesAGoodRow) {
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

TEST_F(BenchResults, AFailureOfAnotherProgramReplacesAGoodRow) {
  Row good = exampleRow(exampleCase()), failed = good;
  good.provenance = failed.provenance = {"program 1", "scene", {}};
  failed.failure = "crashed: Segmentation fault";
  ResultsFile(path_).append(good);
  ResultsFile(path_).append(failed);
  EXPECT_EQ(readRows(path_)[0].failure, "") << "the same program";
  failed.provenance = {};
  ResultsFile(path_).append(failed);
  EXPECT_EQ(readRows(path_)[0].failure, "") << "nothing says that it was another";
  failed.provenance = {"program 2", "scene", {}};
  ResultsFile(path_).append(failed);
  const std::vector<Row> now = readRows(path_);
  ASSERT_EQ(now.size(), 1u);
  EXPECT_EQ(now[0].failure, failed.failure);
  EXPECT_FALSE(ResultsFile(path_).contains(good.key));
  writeTables(now, folder_);
  EXPECT_NE(readTextFile(folder_ / "tables.md").find("failed: crashed"), std::string::npos);
  EXPECT_TRUE(compareResults(std::vector{good}, now).found());
  good.provenance = failed.provenance;
  ResultsFile(path_).append(good);
  EXPECT_EQ(readRows(path_)[0].failure, "");
}

TEST_F(BenchResults, UnfinishedIsWhatLacksAValidRowOfAllTurns) {
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

TEST_F(BenchResults, WhatWasMeasuredWithSomethingElseIsMeasuredAgain) {
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

TEST_F(BenchResults, TablesAreWritten) {
  const std::vector<Row> rows = {exampleRow(exampleCase())};
  writeTables(rows, folder_);
  EXPECT_NE(readTextFile(folder_ / "tables.md").find("## cornell_box"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / makeTables(rows).front().fileName));
}

/// Rows of two folders in one: none twice, good ones instead of failures, with the files that they name.
TEST_F(BenchResults, FoldersAreMerged) {
  const fs::path a = folder_ / "a", b = folder_ / "b", all = folder_ / "all";
  for (const fs::path& folder : {a, b, all}) fs::create_directories(folder / "references");
  Row both = exampleRow(exampleCase("pcss", 4)), failed = exampleRow(exampleCase("pcss", 16)),
      good = exampleRow(exampleCase("pcss", 16)), stray = exampleRow(exampleCase("pcss", 64));
  failed.failure = "it crashed";
  stray.picture = "../secret.png";
  writeTextFile(folder_ / "secret.png", "secret");
  writeTextFile(b / "references/a.exr", "a reference");
  ResultsFile(a / "results.jsonl").append(both);
  ResultsFile(a / "results.jsonl").append(failed);
  for (const Row& row : {both, good, stray}) ResultsFile(b / "results.jsonl").append(row);
  EXPECT_EQ(mergeResults(a, all, {}), 2);
  EXPECT_EQ(mergeResults(b, all, {}), 2);
  EXPECT_EQ(mergeResults(a, all, {}) + mergeResults(b, all, {}), 0) << "merging again adds nothing";
  const std::vector<Row> rows = readRows(all / "results.jsonl");
  ASSERT_EQ(rows.size(), 3u);
  for (const Row& row : rows) EXPECT_EQ(row.failure, "");
  EXPECT_EQ(readTextFile(all / "references/a.exr"), "a reference");
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(all), fs::recursive_directory_iterator()), 3)
      << "results.jsonl, references/ and the reference: nothing from outside of the folders";
}

/// Parts measured at different times and by different programs: the order of merging does not count.
TEST_F(BenchResults, MergingTakesWhatIsValidNowAndOfMoreTurns) {
  const Provenance then{"program 1", "scene", {}}, now{"program 2", "scene", {}};
  const auto make = [&](const std::string& name, const Provenance& provenance, int turns,
                        const std::string& failure = {}) {
    const fs::path folder = folder_ / name;
    fs::create_directories(folder / "pictures");
    Row row = exampleRow(exampleCase());
    row.provenance = provenance;
    row.cost.frameMs.turns = turns;
    row.failure = failure;
    if (failure.empty()) {
      row.picture = "pictures/" + row.key + ".png";
      row.difference = "pictures/" + row.key + ".difference.png";
      writeTextFile(folder / row.picture, name);
      writeTextFile(folder / row.difference, name);
    }
    ResultsFile(folder / "results.jsonl").append(row);
    return folder;
  };
  const std::vector<fs::path> parts = {make("old, one turn", then, 1), make("old, 3 turns", then, 3),
                                       make("new, failed", now, 1, "lost"), make("new, one turn", now, 1),
                                       make("new, 2 turns", now, 2)};
  const auto merge = [&](const fs::path& part, const fs::path& into) {
    return mergeResults(part, into, [&](const Case&) { return now; });
  };
  const fs::path up = folder_ / "up", down = folder_ / "down";
  for (const fs::path& folder : {up, down}) fs::create_directories(folder);
  for (const fs::path& part : parts) EXPECT_EQ(merge(part, up), 1) << part;
  EXPECT_EQ(merge(parts.back(), down), 1);
  for (const fs::path& folder : {up, down}) {
    for (const fs::path& part : parts) EXPECT_EQ(merge(part, folder), 0) << part;
    const std::vector<Row> rows = readRows(folder / "results.jsonl");
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].provenance.program, "program 2");
    EXPECT_EQ(rows[0].cost.frameMs.turns, 2);
    EXPECT_EQ(readTextFile(folder / rows[0].picture), "new, 2 turns");
    EXPECT_EQ(readTextFile(folder / rows[0].difference), "new, 2 turns");
  }
  // Of good rows of two other programs nothing says which is newer: the folder keeps its own.
  const fs::path older = make("older, 9 turns", {"program 0", "scene", {}}, 9);
  EXPECT_EQ(merge(older, parts[0]), 0);
  EXPECT_EQ(merge(parts[0], older), 0);
  const fs::path failed = make("old, failed", then, 1, "lost");
  EXPECT_EQ(merge(failed, older), 0);
  EXPECT_EQ(merge(older, failed), 1);
}

}  // namespace
}  // namespace limn::bench
