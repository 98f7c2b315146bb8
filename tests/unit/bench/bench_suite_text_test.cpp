// What is written of a suite reads as the same cases.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/bench/suite.h"
#include "core/bench/suite_text.h"

namespace limn::bench {
namespace {

TEST(BenchSuiteText, ReadsAsWhatWasWritten) {
  SceneQuestion question;
  question.scene = "a \"quoted\\ name.glb";
  question.light = "key";
  question.width = 320;
  question.height = 200;
  question.term = "visibility";
  question.lightSize = 0.3;
  question.lightSettings = {"key.intensity=5", "key.size=1,2"};
  question.defaultLights = "off";
  using Parameters = std::vector<std::pair<std::string, std::string>>;
  const Parameters one = {{"pcss.filter_samples", "16"}, {"pcss.search", "narrowed"}};
  const Parameters both = {{"pcss.bias", "2"}, {"airlight.steps", "8"}};
  const Suite suite =
      parseSuite("name = " + tomlText("written") + "\n" + subjectToml(question) + sceneToml(question) +
                     techniqueToml("pcss", one) + techniqueToml("pcss,airlight", both) +
                     techniqueToml("pcf", {}) + techniqueToml("pcss:visibility", one),
                 "written.toml");
  ASSERT_EQ(suite.cases.size(), 4u);
  for (const Case& c : suite.cases) EXPECT_EQ(static_cast<const SceneQuestion&>(c), question);
  EXPECT_EQ(suite.cases[0].technique, "pcss");
  EXPECT_THAT(suite.cases[0].parameters, testing::UnorderedElementsAreArray(one));
  EXPECT_EQ(suite.cases[1].technique, "pcss,airlight");
  EXPECT_THAT(suite.cases[1].parameters, testing::UnorderedElementsAreArray(both));
  EXPECT_EQ(suite.cases[2].technique, "pcf");
  EXPECT_THAT(suite.cases[2].parameters, testing::IsEmpty());
  EXPECT_EQ(suite.cases[3].technique, "pcss:visibility");
  EXPECT_THAT(suite.cases[3].parameters, testing::UnorderedElementsAreArray(one));
}

}  // namespace
}  // namespace limn::bench
