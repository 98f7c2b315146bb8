// Ratios to a table's baseline, and names of settings.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/bench/private/comparison.h"
#include "core/bench/tables.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn::bench {
namespace {

using test::exampleCase;
using test::exampleRow;

TEST(BenchComparison, ReferencesTakeLongerForLess) {
  Row row = exampleRow(exampleCase("a"));
  row.referenceSeconds = 50;
  row.error.noise_floor = 3 * 0.01;
  row.error.rmse = std::hypot(0.05, 0.01);  // 5 sigma beyond the reference's own noise
  ASSERT_TRUE(referenceTime(row));
  EXPECT_NEAR(referenceTime(row)->ms, 50e3 / 25, 1e-6);
  EXPECT_FALSE(referenceTime(row)->atLeast);
  row.error.rmse = 0.011;  // drowns in the noise
  EXPECT_NEAR(referenceTime(row)->ms, 50e3 * 4, 1e-6);
  EXPECT_TRUE(referenceTime(row)->atLeast);
  row.what.timeWidth = row.what.timeHeight = 1024;  // errors and times of different pictures
  EXPECT_FALSE(referenceTime(row));
  row.what.timeWidth = row.what.timeHeight = 0;
  row.what.aa = 2;  // the error of four frames, the time of one
  EXPECT_FALSE(referenceTime(row));
  row.what.aa = 1;
  row.cost.framesPerPicture = 16;  // of a history: likewise
  EXPECT_FALSE(referenceTime(row));
  row.cost.framesPerPicture = 1;
  row.error.noise_floor = 0;  // no noise, no Monte Carlo
  EXPECT_FALSE(referenceTime(row));
  row.error.noise_floor = 0.03;
  row.cost.software = false;  // the reference is the processor's, the frames are not
  EXPECT_FALSE(referenceTime(row));
  row.cost.software = true;
  row.referenceSeconds.reset();  // of an earlier version
  EXPECT_FALSE(referenceTime(row));
}

TEST(BenchComparison, RowsAreComparedWithTheBaseline) {
  std::vector<Row> rows = {
      exampleRow(exampleCase("pcss", 1024), 0.1, 8), exampleRow(exampleCase("pcss", 16), 0.2, 2),
      exampleRow(exampleCase("pcss", 64), 0.15, 4), exampleRow(exampleCase("vssm"), 0.16, 1)};
  EXPECT_EQ(comparisonMarkdown({"", "", rows}), "");
  rows[0].what.baseline = true;
  for (Row& row : rows) row.penumbra->structured = 0.5 * row.penumbra->rmse;
  rows[3].penumbra->structured = 0.01;
  rows[3].what.title = "VSSM";
  std::string text = comparisonMarkdown({"", "", rows});
  EXPECT_NE(
      text.find("| VSSM | 8.00 (n = 1) | 8.00 | pcss samples=64 | 4.00 (n = 1) | 4.00 | none | - | - |"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("n = 1: one turn, no interval | shadows, of one turn: maps,"), std::string::npos)
      << text;
  for (Row& row : rows) {  // five turns that do not scatter
    row.cost.frameMs.turns = 5;
    row.cost.frameMs.samples.assign(5, row.cost.frameMs.median);
  }
  rows[2].cost.frameMs = {4, 4, 4, 1, {4}};
  text = comparisonMarkdown({"", "", rows});
  EXPECT_NE(
      text.find("| VSSM | 8.00 (8.00 to 8.00) | 8.00 | pcss samples=64 | 4.00 (n = 1) | 4.00 | none | - "
                "| - |"),
      std::string::npos)
      << text;
}

/// Of a row without a pixel in the penumbra only the error of the whole picture is known, where lit pixels
/// hide it.
TEST(BenchComparison, ErrorsOfPenumbraeStandBesideNoneOfWholePictures) {
  std::vector<Row> rows = {exampleRow(exampleCase("pcss", 1024), 0.1, 8),
                           exampleRow(exampleCase("pcss", 16), 0.01, 2),
                           exampleRow(exampleCase("vssm"), 0.16, 1)};
  rows[0].what.baseline = true;
  rows[1].penumbra.reset();
  EXPECT_NE(comparisonMarkdown({"", "", rows})
                .find("| vssm samples=16 | 8.00 (n = 1) | 8.00 | pcss samples=1024 |"),
            std::string::npos)
      << comparisonMarkdown({"", "", rows});
  rows[2].penumbra.reset();
  EXPECT_NE(
      comparisonMarkdown({"", "", rows}).find("| vssm samples=16 | 8.00 (n = 1) | 8.00 | pcss samples=16 |"),
      std::string::npos)
      << comparisonMarkdown({"", "", rows});
}

/// The quickest row of an earlier version stands in for one that the newest measured only where there is
/// none.
TEST(BenchComparison, ComparisonsMarkRowsOfAnotherProgram) {
  std::vector<Row> rows = {
      exampleRow(exampleCase("pcss", 1024), 0.1, 8), exampleRow(exampleCase("pcss", 16), 0.15, 2),
      exampleRow(exampleCase("pcss", 64), 0.15, 4), exampleRow(exampleCase("vssm"), 0.16, 1)};
  rows[0].what.baseline = true;
  for (Row& row : rows) {
    row.provenance.program = "2";
    row.picture = "pictures/a.png";
    row.line = 2;
  }
  rows[1].provenance.program = "1";
  rows[1].line = 1;
  const auto table = [&] { return makeTables(rows).at(0); };
  EXPECT_NE(comparisonMarkdown(table()).find("| vssm samples=16 | 8.00 (n = 1) | 8.00 | pcss samples=64 |"),
            std::string::npos)
      << comparisonMarkdown(table());
  EXPECT_NE(picturesMarkdown(table()).find("| pcss samples=16 \u2020: RMSE 0.15"), std::string::npos)
      << picturesMarkdown(table());
  EXPECT_NE(picturesMarkdown(table()).find("\n\u2020 measured with another version"), std::string::npos);
  for (Row* row : {&rows[0], &rows[2]}) row->penumbra->rmse = 0.2;
  EXPECT_NE(
      comparisonMarkdown(table()).find("| vssm samples=16 | 8.00 (n = 1) | 8.00 | pcss samples=16 \u2020 |"),
      std::string::npos)
      << comparisonMarkdown(table());
  rows[1].what.baseline = true;
  rows[0].what.baseline = false;
  EXPECT_NE(comparisonMarkdown(table()).find("\nTimes of pcss samples=16 \u2020 as multiples"),
            std::string::npos)
      << comparisonMarkdown(table());
  for (Row& row : rows) row.provenance.program = "2";
  const std::string alike = comparisonMarkdown(table()) + picturesMarkdown(table());
  EXPECT_EQ(alike.find("\u2020"), std::string::npos) << alike;
}

/// As where the suite has named another baseline since the program changed.
TEST(BenchComparison, AnOutdatedBaselineStandsBack) {
  std::vector<Row> rows = {exampleRow(exampleCase("pcss", 1024), 0.1, 8),
                           exampleRow(exampleCase("pcss", 16), 0.2, 2),
                           exampleRow(exampleCase("vssm"), 0.16, 1)};
  rows[0].what.baseline = rows[1].what.baseline = true;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].provenance.program = i == 0 ? "1" : "2";
    rows[i].line = i + 1;
  }
  const auto compared = [&] { return comparisonMarkdown(makeTables(rows).at(0)); };
  EXPECT_NE(compared().find("\nTimes of pcss samples=16 as multiples"), std::string::npos) << compared();
  EXPECT_NE(compared().find("| vssm samples=16 | 2.00 (n = 1) |"), std::string::npos) << compared();
  rows[0].provenance.program = "2";
  EXPECT_NE(compared().find("\nTimes of pcss samples=1024 as multiples"), std::string::npos) << compared();
}

/// The map's own light as far as its lights are seen, beside the sum of them.
TEST(BenchComparison, SettingsNameTheLightsOfTheEnvironment) {
  Case c = exampleCase("pcss", 16);
  c.environment = "sky";
  c.environmentLights = 0.015;
  std::vector<Row> rows = {exampleRow(c, 0.1, 8), exampleRow(c, 0.2, 2), exampleRow(exampleCase("vssm"))};
  rows[1].what.environmentCombine = "ratio";
  EXPECT_EQ(settingsName(rows[0]), "pcss samples=16, environment lights 0.015 48 squares area");
  EXPECT_EQ(settingsName(rows[1]), "pcss samples=16, environment lights 0.015 48 squares area ratio");
  EXPECT_EQ(settingsName(rows[2]), "vssm samples=16");
}

TEST(BenchComparison, SettingsOfOneTechniqueAreComparedWithTheBaselineAmongThem) {
  std::vector<Row> rows = {exampleRow(exampleCase("pcss", 1024), 0.1, 8),
                           exampleRow(exampleCase("pcss", 16), 0.2, 2)};
  rows[0].what.baseline = true;
  const std::string text = comparisonMarkdown({"", "", rows});
  EXPECT_NE(text.find("| settings | frame | shadows |\n"), std::string::npos) << text;
  EXPECT_NE(text.find("| pcss samples=16 | 4.00 (n = 1) | 4.00 |\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("samples=1024 | "), std::string::npos) << text;
}

}  // namespace
}  // namespace limn::bench
