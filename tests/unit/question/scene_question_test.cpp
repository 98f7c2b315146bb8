// Every field of the table of questions goes through suites, rows and labels.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/row.h"
#include "core/bench/suite.h"
#include "core/question/question_fields.h"
#include "tests/support/paths.h"
#include "tests/support/question_samples.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const SceneQuestion& asked(const bench::Case& c) {
  return c;
}

/// A suite's line of the field: numbers as they are, texts quoted.
std::string suiteLine(const QuestionField& field, const SceneQuestion& question) {
  const bool number = field.kind == QuestionKind::real || field.kind == QuestionKind::optionalReal ||
                      field.kind == QuestionKind::integer;
  std::string values;
  for (const std::string& value : printed(field, question))
    values += (values.empty() ? "" : ", ") + (number ? value : nlohmann::json(value).dump());
  if (field.kind == QuestionKind::texts) values = "[" + values + "]";
  return std::string(keyInSuite(field)) + " = " + values + "\n";
}

/// A suite of that one question, said by its fields that are not the default.
std::string suiteOf(const SceneQuestion& question, const std::string& line = "") {
  std::string suite = "name = \"s\"\n", scene = "[[scenes]]\n";
  for (const QuestionField& field : questionFields())
    if (field.kind == QuestionKind::size)
      suite += suiteLine(field, question);
    else if (!isDefault(field, question))
      scene += suiteLine(field, question);
  return suite + "[[techniques]]\ntechnique = \"pcss\"\n" + scene + line;
}

bench::Case caseOf(const SceneQuestion& question) {
  bench::Case c = bench::test::exampleCase();
  static_cast<SceneQuestion&>(c) = question;
  return c;
}

TEST(SceneQuestion, KeysAndFlagsAreDifferent) {
  std::set<std::string> keys, suiteKeys, flags;
  for (const QuestionField& field : questionFields()) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_TRUE(suiteKeys.insert(keyInSuite(field)).second) << field.key;
    EXPECT_TRUE(flags.insert(field.flag).second) << field.key;
    EXPECT_EQ(&questionField(field.key), &field);
    EXPECT_STRNE(field.doc, "") << field.key;
  }
  EXPECT_THROW(questionField("nothing"), std::logic_error);
}

TEST(SceneQuestion, FieldsAreReadFromSuites) {
  for (const QuestionField& field : questionFields()) {
    const SceneQuestion question = test::sampleQuestion(field);
    const bench::Suite suite = bench::parseSuite(suiteOf(question), "s.toml");
    ASSERT_EQ(suite.cases.size(), 1u) << field.key;
    EXPECT_EQ(asked(suite.cases[0]), question) << field.key;
  }
}

TEST(SceneQuestion, SuitesListSeveralValuesOfSweptFields) {
  for (const QuestionField& field : questionFields()) {
    if (!field.swept || field.kind == QuestionKind::size) continue;
    const SceneQuestion question = test::sampleQuestion(field);
    SceneQuestion rest = question;
    copyField(field, rest, SceneQuestion());
    const bool text = field.kind == QuestionKind::text;
    const std::string other = text ? "\"other\"" : fmt::format("{}", field.range.high);
    const std::string value =
        text ? nlohmann::json(printed(field, question)[0]).dump() : printed(field, question)[0];
    const std::string line = fmt::format("{} = [{}, {}]\n", keyInSuite(field), value, other);
    const bench::Suite suite = bench::parseSuite(suiteOf(rest, line), "s.toml");
    ASSERT_EQ(suite.cases.size(), 2u) << field.key;
    EXPECT_EQ(asked(suite.cases[0]), question) << field.key;
    EXPECT_FALSE(asked(suite.cases[1]) == question) << field.key;
  }
}

TEST(SceneQuestion, SuitesRefuseWhatIsOutOfRange) {
  for (const QuestionField& field : questionFields()) {
    SceneQuestion question = test::sampleQuestion(field);
    copyField(field, question, SceneQuestion());
    std::string line, expected;
    switch (field.kind) {
      case QuestionKind::real:
      case QuestionKind::optionalReal:
      case QuestionKind::integer:
      case QuestionKind::coefficient:
        line = fmt::format("{} = {:.0f}\n", keyInSuite(field), std::ceil(2 * field.range.high));
        expected = fmt::format("..{}", field.range.high);
        break;
      case QuestionKind::choice:
        line = fmt::format("{} = \"neither\"\n", keyInSuite(field));
        expected = fmt::format("'neither'; known are {}", field.choices.front());
        break;
      default:
        continue;
    }
    try {
      bench::parseSuite(suiteOf(question, line), "s.toml");
      ADD_FAILURE() << field.key << " is accepted";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr("s.toml:"), HasSubstr(keyInSuite(field)), HasSubstr(expected)));
    }
  }
}

TEST(SceneQuestion, FieldsAreReadFromRows) {
  for (const QuestionField& field : questionFields()) {
    const SceneQuestion question = test::sampleQuestion(field);
    const std::string line = toJson(bench::test::exampleRow(caseOf(question)));
    EXPECT_EQ(asked(bench::rowFromJson(line).what), question) << field.key;
  }
}

TEST(SceneQuestion, RowsOfEarlierVersionsLackLaterFields) {
  SceneQuestion question;
  question.scene = "balls";
  int later = 0;
  for (const QuestionField& field : questionFields()) {
    if (!field.addedLater) continue;
    ++later;
    auto row = nlohmann::json::parse(toJson(bench::test::exampleRow(caseOf(question))));
    const bool beside = field.group == QuestionGroup::subject;
    auto& values = beside ? row : row.at(name(field.group));
    EXPECT_EQ(values.erase(keyInRow(field)), 1u) << field.key;
    EXPECT_EQ(asked(bench::rowFromJson(row.dump()).what), question) << field.key;
  }
  EXPECT_GE(later, 2);
}

TEST(SceneQuestion, RowsLeaveOutWhatIsNotChanged) {
  SceneQuestion question;
  question.scene = "balls";
  const auto plain = nlohmann::json::parse(toJson(bench::test::exampleRow(caseOf(question))));
  EXPECT_TRUE(plain.at("medium").empty());
  EXPECT_TRUE(plain.at("changes").empty());
  EXPECT_EQ(plain.at("environment").size(), 6u);
  for (const QuestionField& field : questionFields()) {
    if (field.group != QuestionGroup::medium && field.group != QuestionGroup::changes) continue;
    test::setSample(field, question);
    const auto row = nlohmann::json::parse(toJson(bench::test::exampleRow(caseOf(question))));
    EXPECT_EQ(row.at(name(field.group)).size(), 1u) << field.key;
    EXPECT_TRUE(row.at(name(field.group)).contains(keyInRow(field))) << field.key;
    copyField(field, question, SceneQuestion());
  }
}

/// What changes the reference's picture is another question; what changes a row has another key and label.
TEST(SceneQuestion, FieldsAreInQuestionsKeysAndLabels) {
  for (const QuestionField& field : questionFields()) {
    SceneQuestion with = test::sampleQuestion(field), without = with;
    if (field.approximates) with.environmentLights = without.environmentLights = 0.02;
    test::setSample(field, with);
    copyField(field, without, SceneQuestion());
    const bench::Case one = caseOf(with), other = caseOf(without);
    EXPECT_EQ(question(one) == question(other), field.approximates) << field.key;
    EXPECT_NE(rowKey(one, ""), rowKey(other, "")) << field.key;
    // Cases of one label differ in time alone.
    EXPECT_EQ(label(one) == label(other), field.key == std::string("time")) << field.key;
    EXPECT_NE(questionText(one), questionText(other)) << field.key;
  }
}

/// Rows are found again by these texts: another wording would measure everything again.
TEST(SceneQuestion, WordsStayAsStoredRowsHaveThem) {
  const bench::Case c = caseOf({.scene = "balls",
                                .camera = "main",
                                .eye = "0,1,3",
                                .target = "0,0,0",
                                .fov = 30,
                                .light = "key",
                                .width = 33,
                                .height = 25,
                                .term = "direct",
                                .time = 1.5,
                                .animation = "walk",
                                .lightSize = 0.3,
                                .lightSettings = {"key.size=1", "key.intensity=3"},
                                .defaultLights = "on",
                                .environment = "maps/sky.exr",
                                .environmentRotation = 90,
                                .environmentScale = 2,
                                .environmentLights = 0.02,
                                .environmentResolution = 24,
                                .environmentShape = "rectangles",
                                .environmentReflection = "centre",
                                .sigmaA = "0.1,0.2,0.3",
                                .sigmaS = "0.5",
                                .g = 0.25,
                                .grid = "smoke"});
  const std::string changes =
      "eye 0,1,3 target 0,0,0 fov 30 animation walk key.size=1 key.intensity=3 default lights on environment "
      "rotation 90 environment scale 2 grid smoke";
  const std::string medium = "sigma_a 0.1,0.2,0.3 sigma_s 0.5 g 0.25";
  EXPECT_EQ(question(c),
            "balls/main/key/t1.5/direct/33x25/spp256/noise0/bounces1/maps/sky.exr/light size 0.3/" + medium +
                "/" + changes + "0.02 24 rectangles centre");
  EXPECT_EQ(label(c),
            changes + "/" + medium +
                "/environment lights 0.02 24 rectangles centre/light size 0.3/sky.exr/balls/main/key/"
                "direct/33x25/dynamic/pcss?pcss.samples=16");
}

/// Returns the first cells of the table below the heading of docs/bench.md.
std::string documentedKeys(const std::string& heading) {
  const std::string text = readTextFile(std::string(test::kSourceDir) + "/docs/bench.md", 1 << 24);
  const std::size_t start = text.find("\n" + heading + "\n");
  const std::string section = text.substr(start, text.find("\n#", start + 1) - start);
  std::string keys;
  for (std::size_t line = section.find("\n| "); line != std::string::npos;
       line = section.find("\n| ", line + 1))
    keys += section.substr(line, section.find(" | ", line) - line);
  return keys;
}

TEST(SceneQuestion, DocumentationHasTheirLines) {
  const std::string keys = documentedKeys("### Keys of a scene") + documentedKeys("### Keys of the suite");
  const std::string document = readTextFile(std::string(test::kSourceDir) + "/docs/bench.md", 1 << 24);
  const std::size_t changes = document.find("\n| `changes` | ");
  const std::string changed = document.substr(changes, document.find("; only", changes) - changes);
  for (const QuestionField& field : questionFields()) {
    EXPECT_THAT(keys, HasSubstr(fmt::format("`{}`", keyInSuite(field))));
    if (field.group == QuestionGroup::changes) {
      EXPECT_THAT(changed, HasSubstr(fmt::format("`{}`", keyInRow(field))));
    }
  }
}

TEST(SceneQuestion, MinusNoughtIsNought) {
  EXPECT_EQ(rowKey(caseOf({.time = -0.0}), ""), rowKey(caseOf({.time = 0.0}), ""));
  EXPECT_EQ(printed(questionField("time"), {.time = -0.0}), std::vector<std::string>{"0"});
}

TEST(SceneQuestion, FieldsAreCopiedByTheirEffect) {
  for (const QuestionField& field : questionFields()) {
    const SceneQuestion standard;
    SceneQuestion question;
    test::setSample(field, question);
    EXPECT_FALSE(isDefault(field, question)) << field.key;
    for (const QuestionEffect effect :
         {QuestionEffect::view, QuestionEffect::time, QuestionEffect::lights, QuestionEffect::scene})
      EXPECT_EQ(sameFields(effect, question, standard), effect != field.effect) << field.key;
    copyFields(field.effect, question, standard);
    EXPECT_EQ(question, standard) << field.key;
  }
}

TEST(SceneQuestion, PictureSizesAreWidthAndHeight) {
  EXPECT_EQ(parsePictureSize("32x24"), std::pair(32, 24));
  for (const char* text :
       {"", "x", "32", "0x5", "5x0", "32x24x1", "-1x5", "16385x1", "1.5x2", " 1x1", "1 x1"})
    EXPECT_FALSE(parsePictureSize(text)) << text;
}

}  // namespace
}  // namespace limn
