// What CONTRIBUTING.md promises of the additions that worked_examples.py has made in a scratch copy, where it
// is more than the copy's own tests say of every row of a table.
#include <gmock/gmock.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/report.h"
#include "core/bench/suite.h"
#include "core/bench/tables.h"
#include "core/image/metric_json.h"
#include "core/image/metric_table.h"
#include "core/question/question_fields.h"
#include "core/reference/reference.h"
#include "core/render/renderer.h"
#include "core/scene_io/load.h"
#include "core/technique/technique.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class E, class Work>
std::string complaint(Work work) {
  try {
    work();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

TEST(WorkedSceneOption, IsAFlagWithHelpAndRange) {
  CLI::App command;
  SceneQuestion question;
  app::addSceneFlags(command, question);
  EXPECT_THAT(command.help(), AllOf(HasSubstr("--lamp-scale"), HasSubstr("Factor on the lamp's radiance")));
  command.parse("balls --lamp-scale 3");
  EXPECT_EQ(question.lampScale, 3);
  EXPECT_THAT(complaint<CLI::ValidationError>([&] { command.parse("balls --lamp-scale -1"); }),
              AllOf(HasSubstr("--lamp-scale"), HasSubstr("-1 not in range 0")));
}

bench::Case caseOf(const std::string& line) {
  return bench::parseSuite(
             "name = \"s\"\nsizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n[[scenes]]\n"
             "scene = \"balls\"\n" +
                 line,
             "s.toml")
      .cases.at(0);
}

TEST(WorkedSceneOption, IsAKeyOfSuitesAndOfRowsAndInLabels) {
  const bench::Case c = caseOf("lamp_scale = 3\n");
  EXPECT_EQ(c.lampScale, 3);
  EXPECT_THAT(bench::label(c), HasSubstr("lamp scale 3"));
  EXPECT_THAT(bench::question(c), HasSubstr("lamp scale 3"));
  const std::string row = bench::toJson(bench::test::exampleRow(c));
  EXPECT_EQ(nlohmann::json::parse(row).at("changes").at("lamp_scale"), 3);
  EXPECT_EQ(bench::rowFromJson(row).what.lampScale, 3);
  EXPECT_EQ(questionField("lamp_scale").effect, QuestionEffect::lights);
}

Image grey(float value, float one) {
  Image image(4, 4, {"R", "G", "B"});
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = x + y + c == 0 ? one : value;
  return image;
}

TEST(WorkedMetric, IsComputedAndInEveryTable) {
  const Metrics metrics = compareImages(grey(0.5f, 0.125f), grey(0.5f, 0.5f));
  EXPECT_EQ(metrics.worst, 0.375);
  bench::Row row = bench::test::exampleRow(bench::test::exampleCase());
  row.error.worst = metrics.worst;
  EXPECT_EQ(metricsToJson(row.error).at("worst"), 0.375);
  const std::vector<bench::Table> tables = bench::makeTables(std::vector{row});
  EXPECT_THAT(bench::toCsv(tables.at(0)), AllOf(HasSubstr(",worst,"), HasSubstr(",0.375,")));
  EXPECT_THAT(bench::toMarkdown(tables.at(0)), AllOf(HasSubstr("| worst |"), HasSubstr("| 0.375 |")));
  const std::string page = bench::reportData(std::vector{row}, ".").json;
  EXPECT_THAT(page, AllOf(HasSubstr("\"label\":\"worst error\""), HasSubstr("\"worst\":0.375")));
  writeTextFile("report.json", page);  // for worked_chart.py
}

TEST(WorkedMetric, LeavesRowsOfEarlierVersionsReadable) {
  const std::string earlier = bench::toJson(bench::test::exampleRow(bench::test::exampleCase()));
  EXPECT_THAT(earlier, testing::Not(HasSubstr("\"worst\"")));
  EXPECT_EQ(bench::rowFromJson(earlier).error.worst, std::nullopt);
}

TEST(WorkedTerm, IsAValueWithHelpAndARow) {
  EXPECT_EQ(parseTerm("glint"), Term::glint);
  EXPECT_EQ(caseOf("term = \"glint\"\n").term, "glint");
  CLI::App command;
  SceneQuestion question;
  app::addSceneFlag(command, question, "term");
  EXPECT_THAT(command.help(), HasSubstr("glint: light that crystals of snow throw back"));
  command.parse("--output-term glint");
  EXPECT_EQ(question.term, "glint");
  EXPECT_TRUE(contains(kAnswerableTerms, Term::glint));
  EXPECT_FALSE(reference::hasBounces(Term::glint));
  EXPECT_TRUE(reference::acceptsInterfaces(Term::glint, reference::kAllInterfaces));
}

TEST(WorkedTerm, IsRefusedWhereTwoClaimWhatTheRowGivesToOne) {
  const auto plugin = [](const TechniqueInfo& info) { return TechniquePlugin{{}, &info, nullptr, nullptr}; };
  const TechniqueInfo snow{.name = "snow",
                           .title = "",
                           .source = "",
                           .terms = termSet(Term::glint),
                           .parameters = {},
                           .stress = {}};
  const TechniqueInfo frost{.name = "frost",
                            .title = "",
                            .source = "",
                            .terms = termSet(Term::glint),
                            .parameters = {},
                            .stress = {}};
  const TechniquePlugin first = plugin(snow), second = plugin(frost);
  EXPECT_NO_THROW(render::checkTechniques({{&first, {}}}, Term::glint));
  EXPECT_THAT(complaint<UsageError>([&] {
                render::checkTechniques({{&first, {}}, {&second, {}}}, Term::final);
              }),
              HasSubstr("techniques snow and frost both answer glints"));
  EXPECT_THAT(complaint<UsageError>([&] { render::checkTechniques({}, Term::glint); }),
              HasSubstr("no technique given answers the term glint"));
}

scene::Scene coated(const std::string& factor) {
  const std::string document = R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_clearcoat"],
    "extensionsRequired":["KHR_materials_clearcoat"],"materials":[{"name":"lacquer",
    "extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":)" +
                               factor + "}}}]}";
  return scene::loadMemory(std::as_bytes(std::span(document)));
}

std::string hashOf(const scene::Scene& scene) {
  const scene::Pose pose;
  return reference::contentHash({.scene = scene, .pose = pose, .camera = {}, .width = 8, .height = 8});
}

TEST(WorkedMaterialField, IsReadAndRefusedAsTheTableSays) {
  const scene::Scene scene = coated("0.25");
  EXPECT_EQ(scene.materials.at(0).clearcoat, 0.25f);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(coated("7").warnings, ElementsAre(HasSubstr("'lacquer' clearcoatFactor: 7 is clamped to 1")));
  EXPECT_THAT(complaint<Error>([] { coated("\"much\""); }),
              HasSubstr("materials[0].extensions.KHR_materials_clearcoat.clearcoatFactor is \"much\"; a "
                        "number is accepted"));
}

TEST(WorkedMaterialField, ChangesTheReferencesHash) {
  EXPECT_EQ(hashOf(coated("0.25")), hashOf(coated("0.25")));
  EXPECT_NE(hashOf(coated("0.25")), hashOf(coated("0.75")));
}

}  // namespace
}  // namespace limn
