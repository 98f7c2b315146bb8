#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/regression.h"
#include "core/bench/results_file.h"
#include "core/bench/row.h"
#include "core/bench/tables.h"
#include "tests/unit/bench/bench_folder.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn::bench {
namespace {

namespace fs = std::filesystem;
using test::exampleCase;
using test::exampleRow;
using BenchResults = test::BenchFolder;

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
  row.cost.framesPerPicture = 16;
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
  EXPECT_EQ(back.cost.framesPerPicture, 16);
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
  Row bounded = exampleRow(exampleCase());
  bounded.cost.bound = BoundTime{{2, 3}, {1, 1}, 1};
  auto json = nlohmann::json::parse(toJson(bounded));
  for (const char* key : {"own_ms", "bound_ms"}) {
    auto without = json;
    without["stats"]["x_bound"][key] = nlohmann::json::array();
    EXPECT_THROW(rowFromJson(without.dump()), Error) << "a ratio of no " << key;
  }
}

/// What is not known of a row is written as it was read, by a function that calls itself for each level.
TEST_F(BenchResults, RowsThatNestTooDeepAreRefused) {
  constexpr std::size_t levels = 200'000;
  std::string line = toJson(exampleRow(exampleCase()));
  const std::string stats = "\"stats\":{";
  line.insert(line.find(stats) + stats.size(),
              "\"more\":" + std::string(levels, '[') + std::string(levels, ']') + ",");
  EXPECT_THROW(rowFromJson(line), Error);
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

/// Lines are of a file: without going on from one to the next a longer, older file would have the newer rows.
TEST_F(BenchResults, RowsOfLaterFilesAreNewer) {
  const fs::path older = folder_ / "older.jsonl", newer = folder_ / "newer.jsonl";
  Row other = exampleRow(exampleCase("vssm")), row = exampleRow(exampleCase()), again = row;
  row.provenance.program = "1";
  row.what.frames = 20;  // another key
  row.key = rowKey(row.what, "llvmpipe");
  again.provenance.program = "2";
  Row failed = other;
  failed.failure = "lost";
  for (const Row& written : {other, row}) ResultsFile(older).append(written);
  for (const Row& written : {again, failed}) ResultsFile(newer).append(written);
  const std::vector<fs::path> files = {older, newer};
  const std::vector<Row> rows = readRows(files);
  ASSERT_EQ(rows.size(), 4u);
  std::vector<std::size_t> lines;
  for (const Row& read : rows) lines.push_back(read.line);
  EXPECT_EQ(lines, (std::vector<std::size_t>{1, 2, 3, 4}));
  const std::vector<Table> tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 1u);
  const auto isNew = [&](const Row& shown) { return !isOutdated(shown, tables[0]); };
  EXPECT_EQ(std::ranges::count_if(tables[0].rows, isNew), 1) << "of program 2";
  const std::vector<fs::path> twice = {older, older};
  EXPECT_EQ(readRows(twice).size(), 2u) << "good rows take the place of those of their keys";
}

/// A comparison has both sides of one machine: what another one measured of a side leaves it that pair.
TEST_F(BenchResults, RowsOfAnotherMachineInALaterFileTakeNoPlace) {
  const fs::path first = folder_ / "first.jsonl", second = folder_ / "second.jsonl";
  Row row = exampleRow(exampleCase());
  row.cost.machine = "one";
  ResultsFile(first).append(row);
  row.cost.machine = "two";
  ResultsFile(second).append(row);
  const std::vector<fs::path> files = {first, second};
  EXPECT_EQ(readRows(files).size(), 2u);
  row.cost.machine = "one";
  ResultsFile(second).append(row);
  EXPECT_EQ(readRows(files).size(), 1u);
  row.cost.driver = "newer";
  ResultsFile(second).append(row);
  EXPECT_EQ(readRows(files).size(), 1u) << "the first row does not say its driver";
}

TEST_F(BenchResults, TablesAreWritten) {
  const std::vector<Row> rows = {exampleRow(exampleCase())};
  writeTables(rows, folder_);
  EXPECT_NE(readTextFile(folder_ / "tables.md").find("## cornell_box"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / makeTables(rows).front().fileName));
}

/// The name of a table grows where another one makes it ambiguous, and a table goes with its rows.
TEST_F(BenchResults, CsvsOfTablesThatAreNoMoreGo) {
  std::vector<Row> rows = {exampleRow(exampleCase())};
  writeTables(rows, folder_);
  const fs::path shortName = folder_ / makeTables(rows).front().fileName, copy = folder_ / "copy.csv";
  ASSERT_TRUE(fs::copy_file(shortName, copy));
  rows.push_back(rows[0]);
  rows[1].what.reference.spp = 64;
  writeTables(rows, folder_);
  const std::vector<Table> tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_FALSE(fs::exists(shortName));
  for (const Table& table : tables) EXPECT_TRUE(fs::exists(folder_ / table.fileName)) << table.fileName;
  writeTextFile(folder_ / tables[0].fileName, "another's\n");
  writeTables({}, folder_);
  EXPECT_FALSE(fs::exists(folder_ / tables[1].fileName));
  EXPECT_EQ(readTextFile(folder_ / tables[0].fileName), "another's\n");
  EXPECT_TRUE(fs::exists(copy));
}

/// Titles are escaped in tables.md, and names of files are made of them as they are.
TEST_F(BenchResults, CsvsOfTitlesThatAreEscapedGo) {
  for (const std::string scene : {"salt & pepper", "a<b>c", "&lt;", "[x](y)", "a\\b"}) {
    Case c = exampleCase();
    c.scene = scene;
    const std::vector<Row> rows = {exampleRow(c)};
    writeTables(rows, folder_);
    const fs::path file = folder_ / makeTables(rows).front().fileName;
    ASSERT_TRUE(fs::exists(file)) << scene;
    writeTables({}, folder_);
    EXPECT_FALSE(fs::exists(file)) << scene;
  }
}

TEST_F(BenchResults, ThePageOfPicturesGoesWithThem) {
  std::vector<Row> rows = {exampleRow(exampleCase())};
  rows[0].picture = "pictures/a.png";
  const fs::path page = folder_ / "pictures.md";
  writeTables(rows, folder_);
  EXPECT_NE(readTextFile(page).find("![](pictures/a.png)"), std::string::npos);
  rows[0].picture.clear();
  writeTables(rows, folder_);
  EXPECT_FALSE(fs::exists(page));
  writeTextFile(page, "# My pictures\n\nof a journey\n");
  writeTables(rows, folder_);
  EXPECT_TRUE(fs::exists(page)) << "another's";
}

}  // namespace
}  // namespace limn::bench
