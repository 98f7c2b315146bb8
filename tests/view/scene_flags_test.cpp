// Every field of the table of questions is a flag.
#include <gmock/gmock.h>

#include <algorithm>

#include "apps/limn/options.h"
#include "core/question/question_fields.h"
#include "tests/support/question_samples.h"

namespace limn::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

SceneQuestion parsed(std::vector<std::string> arguments) {
  CLI::App program;
  SceneQuestion question;
  addSceneFlags(program, question);
  addSceneFlag(program, question, "term");
  std::reverse(arguments.begin(), arguments.end());
  program.parse(arguments);
  return question;
}

TEST(SceneFlags, FieldsAreReadFromTheCommandLine) {
  for (const QuestionField& field : questionFields()) {
    const SceneQuestion question = test::sampleQuestion(field);
    std::vector<std::string> arguments{question.scene};
    for (const QuestionField& other : questionFields().subspan(1))
      if (!isDefault(other, question))
        for (const std::string& value : printed(other, question))
          arguments.insert(arguments.end(), {other.flag, value});
    EXPECT_EQ(parsed(arguments), question) << field.key;
  }
}

/// Commands name the term and the techniques in two ways each; all take both.
TEST(SceneFlags, BothNamesOfTermAndTechniquesAreTaken) {
  EXPECT_EQ(parsed({"balls", "--term", "direct"}).term, "direct");
  CLI::App program;
  SceneQuestion question;
  session::TechniqueChoice choice;
  addSceneFlag(program, question, "term", "--term");
  addTechniqueFlags(program, choice);
  program.parse("--output-term indirect --techniques pcss,ssao");
  EXPECT_EQ(question.term, "indirect");
  EXPECT_EQ(choice.techniques, "pcss,ssao");
}

TEST(SceneFlags, WhatIsOutOfRangeIsRefusedWithFlagValueAndRange) {
  for (const QuestionField& field : questionFields()) {
    std::string value, accepted;
    switch (field.kind) {
      case QuestionKind::real:
      case QuestionKind::optionalReal:
      case QuestionKind::integer:
        value = std::to_string(static_cast<long>(2 * field.range.high) + 1);
        accepted = " to " + std::to_string(static_cast<long>(field.range.high));
        break;
      case QuestionKind::choice:
        value = "other";
        accepted = field.choices.front();
        break;
      case QuestionKind::size:
        value = "20000x5";
        accepted = "16384";
        break;
      default:
        continue;
    }
    try {
      parsed({"balls", field.flag, value});
      ADD_FAILURE() << field.key << " is accepted";
    } catch (const std::exception& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(field.flag), HasSubstr(value), HasSubstr(accepted)));
    }
  }
}

TEST(SceneFlags, HelpSaysWhatIsAcceptedAndTheDefault) {
  CLI::App program;
  SceneQuestion question;
  addSceneFlags(program, question);
  const std::string help = program.help();
  for (const char* text :
       {"scene TEXT REQUIRED", "--fov FLOAT:FLOAT in [0.1 - 179]", "Vertical field of view, degrees",
        "--time FLOAT:FLOAT in [-1e+06 - 1e+06]=0", "--environment-scale FLOAT:FLOAT in [0 - 1e+09]=1",
        "--size TEXT=1280x720", "--environment-resolution INT:INT in [1 - 512]=48",
        "--default-lights TEXT:{auto,on,off}=auto", "--set-light TEXT ..."})
    EXPECT_THAT(help, HasSubstr(text));
  EXPECT_THAT(help, Not(HasSubstr("--fov FLOAT:FLOAT in [0.1 - 179]="))) << "0 stands for the camera's own";
}

}  // namespace
}  // namespace limn::app
