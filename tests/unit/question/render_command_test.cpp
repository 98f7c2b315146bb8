// The command for a question, as people copy it.
#include "core/question/render_command.h"

#include <gtest/gtest.h>

#include <vector>

namespace limn {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

TEST(RenderCommand, SaysOnlyWhatIsNotTheDefault) {
  SceneQuestion question;
  question.scene = "balls";
  EXPECT_EQ(renderCommand(question, "", {}), "limn render balls");
  question.term = "visibility";
  question.light = "key";
  question.width = 64;
  question.height = 48;
  EXPECT_EQ(renderCommand(question, "pcss", Settings{{"pcss.filter_samples", "16"}}),
            "limn render balls --technique pcss --set pcss.filter_samples=16 --light key --size 64x48 "
            "--output-term visibility");
}

TEST(RenderCommand, QuotesForTheShell) {
  SceneQuestion question;
  question.scene = "$(rm -rf .).glb";
  EXPECT_EQ(renderCommand(question, "a;b", Settings{{"a.x", "1 2"}}),
            "limn render '$(rm -rf .).glb' --technique 'a;b' --set 'a.x=1 2'");
}

TEST(RenderCommand, FlagsForAProgramAreNotQuoted) {
  SceneQuestion question;
  question.scene = "balls";
  EXPECT_TRUE(questionFlags(question).empty());
  question.light = "a b";
  question.lightSettings = {"key.position=-1,2,3", "key.intensity=2"};
  EXPECT_EQ(questionFlags(question),
            (std::vector<std::string>{"--light", "a b", "--set-light", "key.position=-1,2,3", "--set-light",
                                      "key.intensity=2"}));
}

}  // namespace
}  // namespace limn
