// The best setting within a time, from rows of a bench.
#include "apps/view/budget.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "core/base/error.h"
#include "core/session/technique_choice.h"
#include "tests/cli/process.h"

namespace limn::app {
namespace {

bench::Row row(const std::string& technique, double rmse, double ms, const std::string& scene = "balls") {
  bench::Row row;
  row.what.scene = scene;
  row.what.technique = technique;
  row.error.rmse = rmse;
  row.cost.renderer = "a card";
  row.cost.machine = "a machine";
  row.cost.frameMs = {.median = ms, .q1 = ms, .q3 = ms, .n = 5, .samples = {}};
  return row;
}

const MetricInfo& kRmse = metricInfo(&Metrics::rmse);

TEST(Budget, TakesTheLeastErrorThatIsQuickEnough) {
  std::vector<bench::Row> rows{row("hard_shadow_map", 0.09, 1), row("pcss", 0.02, 8), row("pcss", 0.01, 20),
                               row("vssm", 0.03, 6), row("vssm", 0.001, 100)};
  rows[1].what.parameters = {{"pcss.views", "4"}};
  rows[4].what.parameters = {{"vssm.views", "8"}};
  const auto questions = measuredQuestions(rows, "/somewhere/balls.glb");
  ASSERT_EQ(questions.size(), 1u);
  EXPECT_EQ(questions.front().renderer, "a card");
  const BudgetAnswer answer = bestWithin(questions.front(), 10, kRmse);
  EXPECT_EQ(answer.best->text(), "pcss  views=4");
  EXPECT_THAT(session::choiceOf(answer.best->technique, answer.best->parameters).settings,
              testing::ElementsAre("pcss.views=4"));
  EXPECT_EQ(answer.runnerUp->technique, "vssm") << "another technique";
  EXPECT_EQ(answer.runnerUp->ms, 6);
  EXPECT_EQ(bestWithin(questions.front(), 1, kRmse).best->technique, "hard_shadow_map");
  EXPECT_FALSE(bestWithin(questions.front(), 1, kRmse).runnerUp);
  EXPECT_FALSE(bestWithin(questions.front(), 0.5, kRmse).best);
}

/// As in tables, on the report page and in limn tune.
TEST(Budget, NothingRanksBelowTheNoise) {
  std::vector<bench::Row> rows{row("pcss", 0.0015, 200), row("vssm", 0.00155, 20)};
  for (bench::Row& each : rows) each.error.noise_floor = 0.002;
  const BudgetAnswer answer = bestWithin(measuredQuestions(rows, "balls").front(), 250, kRmse);
  EXPECT_EQ(answer.best->technique, "vssm");
  EXPECT_EQ(answer.runnerUp->technique, "pcss");
}

/// As on the report page: they are taken where the newest version measured nothing that is quick enough.
TEST(Budget, OutdatedSettingsComeLast) {
  std::vector<bench::Row> rows{row("pcss", 0.01, 0.5), row("vssm", 0.02, 9), row("pcf", 0.03, 1)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].provenance.program = i == 0 ? "before" : "now";
    rows[i].line = i + 1;
  }
  const MeasuredQuestion question = measuredQuestions(rows, "balls").front();
  const BudgetAnswer answer = bestWithin(question, 10, kRmse);
  EXPECT_EQ(answer.best->text(), "vssm");
  EXPECT_EQ(answer.runnerUp->text(), "pcf");
  EXPECT_EQ(bestWithin(question, 0.9, kRmse).best->text(), "pcss  (by another version)");
}

/// A PSNR is the better the larger it is.
TEST(Budget, WhatIsBestDependsOnTheMetric) {
  std::vector<bench::Row> rows{row("pcss", 0.02, 8), row("vssm", 0.03, 8)};
  rows[0].error.psnr = 30, rows[1].error.psnr = 40;
  const MeasuredQuestion question = measuredQuestions(rows, "balls").front();
  EXPECT_EQ(bestWithin(question, 10, kRmse).best->technique, "pcss");
  EXPECT_EQ(bestWithin(question, 10, metricInfo(&Metrics::psnr)).best->technique, "vssm");
}

TEST(Budget, TheRunnerUpMayBeOfTheSameTechniqueWhereThereIsNoOther) {
  std::vector<bench::Row> rows{row("pcss", 0.02, 8), row("pcss", 0.01, 20)};
  rows[1].what.parameters = {{"pcss.views", "4"}};
  const BudgetAnswer answer = bestWithin(measuredQuestions(rows, "balls").front(), 50, kRmse);
  EXPECT_EQ(answer.best->ms, 20);
  EXPECT_EQ(answer.runnerUp->ms, 8);
}

/// Other scenes, failures, rows without a time and bounds that no technique reaches do not count; other
/// sizes, machines and sizes of timed frames are other questions.
TEST(Budget, ComparesWhatCanBeCompared) {
  std::vector<bench::Row> rows{row("pcss", 1, 1),
                               row("vssm", 1, 1),
                               row("pcf", 1, 1),
                               row("pcss", 1, 1),
                               row("pcss", 1, 1),
                               row("pcss", 1, 1, "robot"),
                               row("separation_floor", 1, 1)};
  rows[0].what.width = rows[0].what.height = 64;
  rows[2].failure = "no picture";
  rows[3].cost.frameMs.n = 0;
  rows[4].cost.machine = "another";
  auto timedElsewhere = row("pcss", 1, 1);
  timedElsewhere.what.timeWidth = timedElsewhere.what.timeHeight = 32;
  rows.push_back(timedElsewhere);
  const auto questions = measuredQuestions(rows, "balls");
  ASSERT_EQ(questions.size(), 4u);
  EXPECT_EQ(questions.back().pixels, 64 * 64) << "the smallest pictures come last";
  for (const MeasuredQuestion& question : questions) EXPECT_EQ(question.settings.size(), 1u);
}

/// What was measured of one model says nothing of another one in a file of the same name.
TEST(Budget, TellsFilesOfOneNameApart) {
  const test::TemporaryFolder folder;
  const auto file = [&](const char* name) {
    const std::filesystem::path path = folder / name;
    std::filesystem::create_directory(path);
    std::ofstream(path / "scene.gltf") << "{}";
    return path / "scene.gltf";
  };
  const std::filesystem::path measured = file("first"), another = file("second");
  const std::vector<bench::Row> rows{row("pcss", 1, 1, measured.string())};
  EXPECT_EQ(measuredQuestions(rows, (measured.parent_path() / "." / "scene.gltf").string()).size(), 1u);
  EXPECT_TRUE(measuredQuestions(rows, another.string()).empty());
  EXPECT_EQ(measuredQuestions(rows, "moved/scene.gltf").size(), 1u) << "by name, where it lies no longer";
}

/// As the bench's tables keep apart what the viewer shows: by mode, playback and reference.
TEST(Budget, KeepsApartWhatIsMeasuredInAnotherWay) {
  std::vector<bench::Row> rows(6, row("pcss", 1, 1));
  rows[1].what.dynamic = false;
  rows[2].what.fps = 30;
  rows[3].what.reference.spp = 16;
  rows[4].what.reference.noise = 0.07;  // 100 times this is not 7
  rows[5].what.environmentLights = 0.1;
  const auto questions = measuredQuestions(rows, "balls");
  std::set<std::string> texts;
  for (const MeasuredQuestion& question : questions) texts.insert(question.text);
  EXPECT_EQ(questions.size(), rows.size());
  EXPECT_EQ(texts.size(), rows.size());
  EXPECT_THAT(questions.front().text, testing::HasSubstr("/dynamic, against 256 spp"));
  EXPECT_THAT(texts, testing::Contains(testing::HasSubstr(", against 7 % noise or 256 spp")));
}

/// A search times what it checks for a shorter time than what it measures in full.
TEST(Budget, TheLongestMeasurementOfASettingCounts) {
  std::vector<bench::Row> rows{row("pcss", 0.02, 8), row("pcss", 0.02, 10), row("pcss", 0.02, 6)};
  rows[1].cost.frameMs.n = 50;
  const auto questions = measuredQuestions(rows, "balls");
  ASSERT_EQ(questions.front().settings.size(), 1u);
  EXPECT_EQ(questions.front().settings.front().ms, 10);
}

/// As in the rows of a version that has other terms.
TEST(Budget, RowsOfUnknownTermsAreAnError) {
  std::vector<bench::Row> rows{row("pcss", 1, 1)};
  rows[0].what.term = "glow";
  EXPECT_THROW(measuredQuestions(rows, "balls"), UsageError);
  EXPECT_TRUE(measuredQuestions(rows, "another").empty());
}

TEST(Budget, FindsTheQuestionThatWasAsked) {
  std::vector<bench::Row> rows{row("pcss", 1, 1), row("pcss", 1, 1), row("vssm", 1, 1)};
  rows[0].what.lightSettings = {"key.position=1,2,3"};
  const auto questions = measuredQuestions(rows, "balls");
  ASSERT_EQ(questions.size(), 2u);
  SceneQuestion asked = rows[0].what;
  asked.scene = "somewhere/balls.glb";
  EXPECT_EQ(questions[placeOf(asked, questions)].question.lightSettings, asked.lightSettings);
  asked.eye = "0,1,2";
  EXPECT_EQ(placeOf(asked, questions), 0u) << "nothing was measured of it";
}

TEST(Budget, SaysHowToMeasure) {
  SceneQuestion shown;
  shown.scene = "balls";
  shown.light = "key";
  shown.lightSettings = {"key.position=-1,2,3"};
  TuneOrder order{.question = TuneOrder::questionOf(shown), .ms = 16, .folder = "out/a b"};
  EXPECT_EQ(tuneCommand(order),
            "limn tune balls --light key --set-light key.position=-1,2,3 --term visibility --steps 1 "
            "--max-ms 16 --out 'out/a b'");
  EXPECT_THAT(tuneArguments(order), testing::Contains("out/a b"));
  shown.light.clear();
  shown.lightSettings.clear();
  order = {.question = TuneOrder::questionOf(shown),
           .ms = 2.5,
           .techniques = "pcss,vssm",
           .steps = 0,
           .folder = "out"};
  EXPECT_EQ(tuneCommand(order),
            "limn tune balls --term direct --techniques pcss,vssm --steps 0 --max-ms 2.5 --out out");
  order.metric = &metricInfo(&Metrics::flip);
  order.maskedShare = 0.02;
  EXPECT_EQ(tuneCommand(order),
            "limn tune balls --term direct --techniques pcss,vssm --metric flip --max-masked-share 0.02 "
            "--steps 0 --max-ms 2.5 --out out");
  order.device = 1;
  EXPECT_THAT(tuneCommand(order), testing::HasSubstr(" --device 1 "))
      << "where the window's pictures are made";
  shown.term = "indirect";
  EXPECT_EQ(TuneOrder::questionOf(shown), shown);
}

}  // namespace
}  // namespace limn::app
