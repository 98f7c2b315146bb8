#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <set>
#include <string>

#include "core/base/file.h"
#include "core/bench/merge.h"
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
using BenchMerge = test::BenchFolder;

/// Rows of two folders in one: none twice, good ones instead of failures, with the files that they name.
TEST_F(BenchMerge, FoldersAreMerged) {
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
  EXPECT_EQ(mergeResults(std::array{a}, all, {}), 2);
  EXPECT_EQ(mergeResults(std::array{b}, all, {}), 2);
  EXPECT_EQ(mergeResults(std::array{a, b}, all, {}), 0) << "merging again adds nothing";
  const std::vector<Row> rows = readRows(all / "results.jsonl");
  ASSERT_EQ(rows.size(), 3u);
  for (const Row& row : rows) EXPECT_EQ(row.failure, "");
  EXPECT_EQ(readTextFile(all / "references/a.exr"), "a reference");
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(all), fs::recursive_directory_iterator()), 3)
      << "results.jsonl, references/ and the reference: nothing from outside of the folders";
}

/// Whatever a foreign row calls its picture, the folder keeps its own rows and pages.
TEST_F(BenchMerge, OnlyPicturesAndReferencesAreBrought) {
  const fs::path part = folder_ / "part", all = folder_ / "all";
  for (const fs::path& folder : {part, all}) fs::create_directories(folder);
  Row own = exampleRow(exampleCase("pcss", 4)), foreign = exampleRow(exampleCase("pcss", 16));
  foreign.picture = "results.jsonl";
  foreign.difference = "notes.txt";
  foreign.referenceFile = "part.sh";
  for (const char* file : {"notes.txt", "part.sh"}) writeTextFile(part / file, "foreign");
  ResultsFile(part / "results.jsonl").append(foreign);
  ResultsFile(all / "results.jsonl").append(own);
  writeTextFile(all / "notes.txt", "own");
  EXPECT_EQ(mergeResults(std::array{part}, all, {}), 1);
  EXPECT_EQ(readRows(all / "results.jsonl").size(), 2u);
  EXPECT_EQ(readTextFile(all / "notes.txt"), "own");
  EXPECT_FALSE(fs::exists(all / "part.sh"));
}

/// Parts measured at different times and by different programs: the order of merging does not count.
TEST_F(BenchMerge, MergingTakesWhatIsValidNowAndOfMoreTurns) {
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
    return mergeResults(std::array{part}, into, [&](const Case&) { return now; });
  };
  const fs::path up = folder_ / "up", down = folder_ / "down", together = folder_ / "together";
  for (const fs::path& folder : {up, down, together}) fs::create_directories(folder);
  for (const fs::path& part : parts) EXPECT_EQ(merge(part, up), 1) << part;
  EXPECT_EQ(merge(parts.back(), down), 1);
  EXPECT_EQ(mergeResults(parts, together, [&](const Case&) { return now; }), 5);
  for (const fs::path& folder : {up, down, together}) {
    for (const fs::path& part : parts) EXPECT_EQ(merge(part, folder), 0) << part;
    const std::vector<Row> rows = readRows(folder / "results.jsonl");
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].provenance.program, "program 2");
    EXPECT_EQ(rows[0].cost.frameMs.turns, 2);
    EXPECT_EQ(readTextFile(folder / rows[0].picture), "new, 2 turns");
    EXPECT_EQ(readTextFile(folder / rows[0].difference), "new, 2 turns");
  }
  // A part that was to keep its pictures brings them.
  const fs::path with = make("with a picture", now, 2), without = folder_ / "without";
  fs::create_directories(without);
  Row bare = readRows(with / "results.jsonl")[0];
  bare.picture = bare.difference = "";
  ResultsFile(without / "results.jsonl").append(bare);
  EXPECT_EQ(merge(without, with), 0);
  EXPECT_EQ(merge(with, without), 1);
  EXPECT_NE(readRows(without / "results.jsonl")[0].picture, "");
  // Of good rows of two other programs nothing says which is newer: the folder keeps its own.
  const fs::path older = make("older, 9 turns", {"program 0", "scene", {}}, 9);
  EXPECT_EQ(merge(older, parts[0]), 0);
  EXPECT_EQ(merge(parts[0], older), 0);
  const fs::path failed = make("old, failed", then, 1, "lost");
  EXPECT_EQ(merge(failed, older), 0);
  EXPECT_EQ(merge(older, failed), 1);
}

/// Tables take the last line for the newest row: what a suite has no more, or an older folder has, comes
/// before what was measured with the present program.
TEST_F(BenchMerge, RowsOfOtherProgramsAreNotTheNewest) {
  const fs::path part = folder_ / "part", other = folder_ / "other", all = folder_ / "all";
  for (const fs::path& folder : {part, other, all}) fs::create_directories(folder);
  const auto measured = [](const fs::path& folder, const std::string& technique, const std::string& program) {
    Row row = exampleRow(exampleCase(technique));
    row.provenance = {program, "scene", {}};
    ResultsFile(folder / "results.jsonl").append(row);
  };
  measured(part, "pcss", "program 1");
  measured(part, "vssm", "program 1");
  measured(part, "pcss", "program 2");
  measured(other, "pcf", "program 1");
  const auto outdated = [&] {
    const Table table = makeTables(readRows(all / "results.jsonl")).at(0);
    std::set<std::string> techniques;
    for (const Row& row : table.rows)
      if (isOutdated(row, table)) techniques.insert(row.what.technique);
    return techniques;
  };
  EXPECT_EQ(mergeResults(std::array{part}, all, {}), 2);
  EXPECT_EQ(outdated(), (std::set<std::string>{"vssm"})) << "the part says which is newer";
  const auto now = [](const Case&) { return Provenance{"program 2", "scene", {}}; };
  EXPECT_EQ(mergeResults(std::array{other}, all, now), 1);
  EXPECT_EQ(outdated(), (std::set<std::string>{"pcf", "vssm"}));
  const std::string text = readTextFile(all / "results.jsonl");
  EXPECT_EQ(mergeResults(std::array{part, other}, all, now), 0);
  EXPECT_EQ(readTextFile(all / "results.jsonl"), text) << "merging again changes nothing";
}

}  // namespace
}  // namespace limn::bench
