#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "core/bench/tables.h"
#include "tests/unit/bench/bench_rows.h"
#include "tests/unit/bench/csv.h"

namespace limn::bench {
namespace {

using test::csvRecords;
using test::exampleCase;
using test::exampleRow;
using test::withOtherFigures;

TEST(BenchTables, NeverMixModesRenderersOrQuestions) {
  std::vector<Row> rows = {exampleRow(exampleCase("pcss", 16)), exampleRow(exampleCase("pcss", 64))};
  EXPECT_EQ(makeTables(rows).size(), 1u);
  Row other = exampleRow(exampleCase());
  other.what.dynamic = false;
  rows.push_back(other);
  EXPECT_EQ(makeTables(rows).size(), 2u);
  other.cost.renderer = "GPU";
  rows.push_back(other);
  EXPECT_EQ(makeTables(rows).size(), 3u);
  other.what.width = 64;
  rows.push_back(other);
  other.what.term = "direct";
  rows.push_back(other);
  EXPECT_EQ(makeTables(rows).size(), 5u);
  std::set<std::string> names;
  for (const Table& table : makeTables(rows)) names.insert(table.fileName);
  EXPECT_EQ(names.size(), 5u);
}

TEST(BenchTables, NeverMixMachines) {
  std::vector<Row> rows;
  for (const int samples : {4, 8, 16, 32}) rows.push_back(exampleRow(exampleCase("pcss", samples)));
  rows[1].cost.machine = "a";
  rows[2].cost.machine = "b";
  rows[3].cost.machine = "a";
  rows[0].cost.machine = "";
  rows[0].failure = "it crashed";
  const std::vector<Table> tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].rows.size(), 3u) << "a row that does not say its machine stands with the first";
  EXPECT_EQ(tables[1].rows.size(), 1u);
  EXPECT_TRUE(tables[0].title.ends_with(", a")) << tables[0].title;
  EXPECT_TRUE(tables[1].title.ends_with(", b")) << tables[1].title;
}

TEST(BenchTables, NeverMixDrivers) {
  std::vector<Row> rows;
  for (const int samples : {4, 8, 16, 32}) rows.push_back(exampleRow(exampleCase("pcss", samples)));
  for (Row& row : rows) row.cost.machine = "a";
  rows[1].cost.driver = "GL 1";
  rows[2].cost.driver = "GL 2";
  rows[3].cost.driver = "GL 1";
  std::vector<Table> tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].rows.size(), 3u) << "a row that does not say its driver stands with the first";
  EXPECT_EQ(tables[1].rows.size(), 1u);
  EXPECT_TRUE(tables[0].title.ends_with(", a, GL 1")) << tables[0].title;
  EXPECT_TRUE(tables[1].title.ends_with(", a, GL 2")) << tables[1].title;
  rows[2].cost.machine = "b";
  tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_TRUE(tables[1].title.ends_with(", b")) << "each machine has one driver: " << tables[1].title;
}

/// As where a suite asks for fewer frames than before, and in every folder of limn tune.
TEST(BenchTables, ASettingStandsThereOnce) {
  const auto measured = [](int frames, const std::string& program = "", std::size_t line = 0) {
    Case c = exampleCase();
    c.frames = frames;
    Row row = exampleRow(c);
    row.cost.frameMs.n = frames;
    row.provenance.program = program;
    row.line = line;
    return row;
  };
  const auto shown = [](const std::vector<Row>& rows) {
    const std::vector<Table> tables = makeTables(rows);
    EXPECT_EQ(tables.at(0).rows.size(), 1u);
    return tables[0].rows[0];
  };
  EXPECT_EQ(shown({measured(20), measured(5)}).what.frames, 20);
  EXPECT_EQ(shown({measured(5), measured(20)}).what.frames, 20);
  Row turns = measured(5);
  turns.cost.frameMs.turns = 3;
  EXPECT_EQ(shown({measured(20), turns}).what.frames, 5) << "one turn does not say how far times scatter";
  EXPECT_EQ(shown({turns, measured(20)}).what.frames, 5);
  EXPECT_EQ(shown({measured(20, "1", 1), measured(5, "2", 2)}).what.frames, 5) << "the newer program's";
  EXPECT_EQ(shown({measured(20, "2", 3), measured(5, "1", 2)}).what.frames, 20) << "measured again";
  EXPECT_EQ(shown({measured(5, "1", 2), measured(20, "", 1)}).what.frames, 5)
      << "one of an earlier version, which does not say which, comes before the newest program's";
  Row failed = measured(0, "1", 2);
  failed.failure = "lost";
  EXPECT_EQ(shown({measured(5, "1", 1), failed}).failure, "");
  EXPECT_EQ(shown({measured(5, "0", 1), failed}).failure, "lost") << "an old answer would hide it";
  const std::vector<Row> others = {exampleRow(exampleCase("pcss", 16)), exampleRow(exampleCase("pcss", 64))};
  EXPECT_EQ(makeTables(others).at(0).rows.size(), 2u);
}

TEST(BenchTables, RowsOfAnotherProgramAreMarked) {
  std::vector<Row> rows = {exampleRow(exampleCase("old")), exampleRow(exampleCase("new")),
                           exampleRow(exampleCase("vssm"))};
  EXPECT_EQ(toMarkdown(makeTables(rows).front()).find("\u2020"), std::string::npos) << "none records it";
  for (Row& row : rows) row.provenance.program = "2";
  EXPECT_EQ(toMarkdown(makeTables(rows).front()).find("\u2020"), std::string::npos);
  rows[0].provenance.program = "1";
  rows[0].line = 1;
  rows[1].line = 3;
  rows[2].line = 2;
  const std::string text = toMarkdown(makeTables(rows).front());
  EXPECT_NE(text.find("| old \u2020 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| new |"), std::string::npos) << text;
  EXPECT_NE(
      text.find("\n\u2020 measured with another version of the program, of a technique or of the scene than "
                "the newest row\n"),
      std::string::npos)
      << text;
  rows[0].line = 4;  // the row was measured again, with the program of before
  EXPECT_NE(toMarkdown(makeTables(rows).front()).find("| vssm \u2020 |"), std::string::npos);
}

/// A technique that was built again, or a scene that was edited, leaves the program as it was.
TEST(BenchTables, RowsOfAnotherTechniqueOrSceneAreMarked) {
  std::vector<Row> rows = {exampleRow(exampleCase("pcss", 16)), exampleRow(exampleCase("vssm")),
                           exampleRow(exampleCase("pcss", 64))};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string& technique = rows[i].what.technique;
    rows[i].provenance = {"1", "scene", {{technique, technique + ".so", "hash of " + technique}}};
    rows[i].line = i + 1;
  }
  const auto marked = [&] {
    const Table table = makeTables(rows).front();
    std::vector<bool> result;
    for (const Row& row : table.rows) result.push_back(isOutdated(row, table));
    return result;
  };
  EXPECT_EQ(marked(), (std::vector<bool>{false, false, false}));
  rows[2].provenance.modules[0].hash = "new";
  EXPECT_EQ(marked(), (std::vector<bool>{true, false, false})) << "vssm is what it was";
  rows[2].provenance.scene = "edited";
  EXPECT_EQ(marked(), (std::vector<bool>{true, true, false}));
  rows[2].line = 0;
  EXPECT_EQ(marked(), (std::vector<bool>{false, false, true})) << "not the last row counts but the newest";
}

TEST(BenchTables, TitlesTellTablesApart) {
  std::vector<Row> rows(11, exampleRow(exampleCase()));
  rows[1].what.g = -0.7;
  rows[2].what.sigmaS = "0.5";
  rows[3].what.fov = 30;
  rows[4].what.reference.spp = 64;
  rows[5].what.reference.noise = 0.01;
  rows[6].what.reference.interfaces = -1;
  rows[7].what.environment = "a/sky.hdr";
  rows[8].what.environment = "b/sky.hdr";
  rows[9].what.light = rows[10].what.light = "#1";
  rows[9].what.environmentLights = 0.1;
  std::set<std::string> titles, files;
  for (const Table& table : makeTables(rows)) {
    titles.insert(table.title);
    files.insert(table.fileName);
  }
  EXPECT_EQ(titles.size(), rows.size());
  EXPECT_EQ(files.size(), rows.size());
}

/// Folders of files and references make titles long.
TEST(BenchTables, TitlesAreShortWhereThatTellsTablesApart) {
  std::vector<Row> rows(2, exampleRow(exampleCase()));
  rows[0].what.scene = "balls";
  rows[0].what.environment = "maps/sky.hdr";
  std::vector<Table> tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].title, "balls, camera main, environment sky.hdr: visibility, 32x16, dynamic, llvmpipe");
  EXPECT_EQ(tables[1].title, "cornell_box, camera main: visibility, 32x16, dynamic, llvmpipe");
  rows.push_back(rows[1]);
  rows[2].what.reference.spp = 64;
  tables = makeTables(rows);
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].title.find("spp"), std::string::npos) << tables[0].title;
  EXPECT_EQ(tables[1].title,
            "cornell_box, camera main: visibility, 32x16, dynamic, against 256 spp, llvmpipe");
  EXPECT_EQ(tables[2].title,
            "cornell_box, camera main: visibility, 32x16, dynamic, against 64 spp, llvmpipe");
}

TEST(BenchTables, SayWhatReferencesWereAskedFor) {
  Case c = exampleCase();
  c.reference = {.spp = 1024, .noise = 0.07, .bounces = 3};  // 100 * 0.07 is not 7
  EXPECT_EQ(referenceText(c), "against 7 % noise or 1024 spp") << "visibility has no bounces";
  c.term = "indirect";
  EXPECT_EQ(referenceText(c), "against 7 % noise or 1024 spp, bounces 3");
  c.term = "of an earlier version";
  c.reference = {.spp = 64, .bounces = 2, .interfaces = 4};
  EXPECT_EQ(referenceText(c), "against 64 spp, bounces 2, interfaces 4");
  c.term = "specular";
  c.reference = {.spp = 64, .bounces = 0, .interfaces = -1};
  EXPECT_EQ(referenceText(c), "against 64 spp, interfaces all");
}

TEST(BenchTables, MarkdownShowsErrorTimeNoiseFloorAndFront) {
  // The second is beaten in both; the third's error is below the noise floor.
  const std::vector<Row> rows = {exampleRow(exampleCase("fast"), 0.25, 1.0),
                                 exampleRow(exampleCase("beaten"), 0.3, 1.5),
                                 withOtherFigures(exampleRow(exampleCase("good"), 0.002, 9.0))};
  const std::string text = toMarkdown(makeTables(rows).front());
  EXPECT_NE(text.find("| fast | fast.samples=16 | 0.25 | 0.1 | -0.01 | 0.7 | -inf | 0.1250 | 0.03 | 0.25 | "
                      "5.00 | 1.00 | 1.000 | 0.750 | "
                      "1.250 | 1.49 | 5 | 1000.0 | 0.12 | 0.50 | 0.25 | 0.25 | 3.0 | * |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| beaten | beaten.samples=16 | 0.3 "), std::string::npos) << text;
  EXPECT_NE(text.find("| 1.500 | 1.250 | 1.750 | 1.33 | 5 | 666.7 | 0.08333 | 0.75 | 0.38 | 0.38 | 3.0 |  |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| good | good.samples=16 | <0.003 "), std::string::npos) << text;
  // Every line of the table has as many cells.
  std::size_t bars = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] != '|') continue;
    const std::size_t count = static_cast<std::size_t>(std::count(line.begin(), line.end(), '|'));
    if (bars == 0) bars = count;
    EXPECT_EQ(count, bars) << line;
  }
}

/// A column that says the same in every row is a line above the table; CSV has it.
TEST(BenchTables, MarkdownSaysOnceWhatAllRowsHave) {
  std::vector<Row> rows = {exampleRow(exampleCase("a"), 0.25, 1.0), exampleRow(exampleCase("b"), 0.3, 1.5)};
  for (Row& row : rows) {
    row.what.parameters.clear();
    row.referenceSeconds.reset();
    row.cost.split.filters = 0;
  }
  const auto text = [&] { return toMarkdown(makeTables(rows).front()); };
  const std::string head =
      "| technique | RMSE | penumbra RMSE | median ms | q1 | q3 | p99 / median | fps | maps ms "
      "| technique ms | front |\n";
  const std::string common =
      "\n\nIn all rows: parameters -, rel. MSE 0.1, bias -0.01, p99.9 0.7, PSNR -inf, FLIP 0.1250, "
      "structured 0.03, lit in umbra % 5.00, dark in light % 1.00, n 5, reference ms -, filters ms 0.00, MiB "
      "3.0\n\n";
  EXPECT_NE(text().find(common + head), std::string::npos) << text();
  EXPECT_NE(text().find("\n| b | 0.3 | 0.3 | 1.500 | 1.250 | 1.750 | 1.33 | 666.7 | 0.75 | 0.38 |  |\n"),
            std::string::npos)
      << text();
  const std::string csv = toCsv(makeTables(rows).front());
  for (const char* column : {",parameters,", ",rel_mse,", ",filters_ms,", ",reference_ms,"})
    EXPECT_NE(csv.find(column), std::string::npos) << csv;

  // A row that differs brings the column back. Failed rows have no say, and a column for their message.
  rows[1].error.flip = 0.25;
  EXPECT_NE(text().find("| FLIP |"), std::string::npos) << text();
  EXPECT_EQ(text().find("FLIP 0.1250"), std::string::npos) << text();
  rows[1] = rows[0];
  rows[1].what.technique = "b";
  rows.push_back(rows[0]);
  rows[2].what.technique = "c";
  rows[2].failure = "it crashed";
  EXPECT_NE(text().find("\n\n| technique | RMSE |\n|---|--:|\n| a | 0.25 |\n| b | 0.25 |\n"
                        "| c | failed: it crashed |\n"),
            std::string::npos)
      << text();
  rows.resize(1);
  EXPECT_EQ(text().find("In all rows"), std::string::npos) << "one row repeats nothing";
}

/// As the report page has it: what differs by less than the reference's noise is equally good.
TEST(BenchTables, NothingRanksBelowTheNoise) {
  std::vector<Row> rows = {exampleRow(exampleCase("pcss", 1024), 0.001, 8),
                           exampleRow(exampleCase("pcss", 16), 0.002, 2),
                           exampleRow(exampleCase("vssm"), 0.0015, 4)};
  rows[0].what.baseline = true;
  const std::string text = toMarkdown(makeTables(rows).front());
  const auto line = [&](const std::string& start) {
    const std::size_t at = text.find(start);
    return at == std::string::npos ? std::string() : text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_TRUE(line("| pcss | pcss.samples=16 |").ends_with("| * |")) << text;
  EXPECT_TRUE(line("| vssm | ").ends_with("|  |")) << text;
  EXPECT_TRUE(line("| pcss | pcss.samples=1024 |").ends_with("|  |")) << text;
  const std::string compared = line("| vssm samples=16 |");
  EXPECT_NE(compared.find("| pcss samples=16 |"), std::string::npos) << text;
  EXPECT_EQ(compared.find("samples=1024"), std::string::npos) << text;
}

TEST(BenchTables, CsvQuotesAndKeepsPrecision) {
  Row row = exampleRow(exampleCase("a,b"), 0.1 + 0.2);
  Row failed = row;
  failed.failure = "he said \"no\"";
  failed.what.parameters.front().second = "64";
  const std::vector<Row> rows = {row, failed};
  const std::string text = toCsv(makeTables(rows).front());
  EXPECT_NE(text.find("\"a,b\""), std::string::npos);
  EXPECT_NE(text.find("0.30000000000000004"), std::string::npos);
  EXPECT_NE(text.find("\"he said \"\"no\"\"\""), std::string::npos);
  std::vector<long> fields;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t quoted = line.find("\"a,b\"");
    if (quoted != std::string::npos) line.replace(quoted, 5, "a");
    std::size_t parameters = line.find("\"a,b.samples");
    EXPECT_EQ(parameters == std::string::npos, fields.empty());
    if (parameters != std::string::npos) line.replace(parameters, 4, "a");
    fields.push_back(std::count(line.begin(), line.end(), ','));
  }
  ASSERT_EQ(fields.size(), 3u);
  EXPECT_EQ(fields[0], fields[1]);
  EXPECT_EQ(fields[0], fields[2]);
}

TEST(BenchTables, CsvKeepsEveryTextAsItIs) {
  for (const std::string hostile : {"a,b\"c\r\nd\ne", "=1+1", "@x", "\"", "|<b>"}) {
    Row row = exampleRow(exampleCase(hostile));
    row.what.scene = row.what.camera = row.what.light = row.what.term = row.cost.renderer = hostile;
    row.what.animation = row.what.sigmaA = hostile;
    Row failed = row;
    failed.failure = hostile;
    failed.what.parameters.front().second = "64";
    const std::vector<Row> rows = {row, failed};
    const auto records = csvRecords(toCsv(makeTables(rows).front()));
    ASSERT_EQ(records.size(), 3u) << hostile;
    for (const auto& record : records) EXPECT_EQ(record.size(), records[0].size()) << hostile;
    EXPECT_EQ(records[1][0], hostile);
    EXPECT_EQ(records[1][2], hostile);
    EXPECT_EQ(records[1][12], hostile);
    const auto failure = std::ranges::find(records[0], "failure") - records[0].begin();
    EXPECT_EQ(records[2][static_cast<std::size_t>(failure)], hostile);
  }
}

}  // namespace
}  // namespace limn::bench
