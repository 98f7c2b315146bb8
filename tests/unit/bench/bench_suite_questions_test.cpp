// What suites ask of scenes and times: which cases are the same question, and what labels and keys tell
// apart.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "core/bench/suite.h"
#include "tests/unit/bench/suite_refusal.h"

namespace limn::bench {
namespace {

using test::expectUsageError;

TEST(BenchSuiteQuestions, LightSizesAreQuestionsOfTheirOwn) {
  const Suite suite = parseSuite(
      "name = \"l\"\nsizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n"
      "[[scenes]]\nscene = \"balls\"\nlight_sizes = [0.3, 1.2]\n",
      "s.toml");
  ASSERT_EQ(suite.cases.size(), 2u);
  EXPECT_EQ(suite.cases[0].lightSize, 0.3);
  EXPECT_NE(question(suite.cases[0]), question(suite.cases[1]));
  EXPECT_NE(label(suite.cases[0]), label(suite.cases[1]));
}

TEST(BenchSuiteQuestions, TimeSizesAreTheSameQuestionUnderAnotherLabel) {
  const std::string rest =
      "sizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n[[scenes]]\nscene = \"balls\"\n";
  const Case small = parseSuite("name = \"s\"\n" + rest, "s.toml").cases[0];
  const Case large = parseSuite("name = \"l\"\ntime_size = \"16x12\"\n" + rest, "s.toml").cases[0];
  EXPECT_EQ(question(small), question(large));
  EXPECT_EQ(label(small), "balls/first camera/all lights/final/8x8/dynamic/pcss");
  EXPECT_EQ(label(large), "balls/first camera/all lights/final/8x8 times at 16x12/dynamic/pcss");
}

TEST(BenchSuiteQuestions, BoundsAreAskedForBySuite) {
  const std::string rest =
      "sizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n[[scenes]]\nscene = \"balls\"\n";
  const Case without = parseSuite("name = \"a\"\n" + rest, "s.toml").cases[0];
  const Case with = parseSuite("name = \"b\"\nbound = true\n" + rest, "s.toml").cases[0];
  EXPECT_FALSE(without.bound);
  EXPECT_TRUE(with.bound);
  EXPECT_EQ(question(with), question(without)) << "they share a reference";
  EXPECT_EQ(label(with), label(without));
  EXPECT_NE(rowKey(with, ""), rowKey(without, "")) << "a row without the bound does not answer the case";
  expectUsageError("name = \"c\"\nbound = 1\n" + rest, "s.toml:2:9: 'bound' must be true or false");
  expectUsageError("name = \"d\"\nbounds = true\n" + rest, "unknown key 'bounds'");
}

TEST(BenchSuiteQuestions, EnvironmentsAreSweptByThreshold) {
  const std::string start =
      "name = \"e\"\nsizes = \"8x8\"\nterm = \"direct\"\n[[techniques]]\ntechnique = \"pcss\"\n"
      "[[scenes]]\nscene = \"balls\"\n";
  const Suite suite = parseSuite(start +
                                     "environment = \"sky.exr\"\nenvironment_lights = [0, 0.015, 0.025]\n"
                                     "environment_shape = \"rectangles\"\n",
                                 "s.toml");
  ASSERT_EQ(suite.cases.size(), 3u);
  EXPECT_EQ(suite.cases[1].environmentLights, 0.015);
  EXPECT_EQ(suite.cases[1].environmentShape, "rectangles");
  EXPECT_EQ(suite.cases[1].environmentResolution, 48);
  EXPECT_EQ(question(suite.cases[0]), question(suite.cases[2])) << "all of them approximate the map";
  EXPECT_NE(rowKey(suite.cases[0], ""), rowKey(suite.cases[1], ""));
  Case one = suite.cases[1], other = suite.cases[2];
  one.light = other.light = "env#0";
  EXPECT_NE(question(one), question(other)) << "env#0 is not the same light";
  EXPECT_EQ(parseSuite(start + "environment_lights = 0.015\n", "s.toml").cases.at(0).environmentLights, 0.015)
      << "the scene may have a map of its own";
  expectUsageError(start + "environment = \"sky.exr\"\nenvironment_lights = [0.015, 2]\n",
                   "'environment_lights'");
  expectUsageError(start + "environment = \"sky.exr\"\nenvironment_shape = \"discs\"\n",
                   "squares, rectangles");
}

TEST(BenchSuiteQuestions, MediaAreSweptByPhaseFunction) {
  const std::string start =
      "name = \"m\"\nsizes = \"8x8\"\nterm = \"media\"\n[[techniques]]\ntechnique = \"airlight\"\n"
      "[[scenes]]\nscene = \"gem\"\n";
  const Suite suite = parseSuite(start + "sigma_s = 0.5\ng = [-0.7, 0, 0.7]\n", "s.toml");
  ASSERT_EQ(suite.cases.size(), 3u);
  EXPECT_EQ(suite.cases[0].g, -0.7);
  EXPECT_EQ(suite.cases[2].sigmaS, "0.5");
  EXPECT_EQ(suite.cases[2].sigmaA, "") << "the scene's";
  EXPECT_EQ(parseSuite(start + "sigma_a = \"0.1,0.2,0.3\"\n", "s.toml").cases[0].sigmaA, "0.1,0.2,0.3");
  EXPECT_NE(question(suite.cases[0]), question(suite.cases[1]));
  EXPECT_NE(label(suite.cases[1]).find("sigma_s 0.5 g 0/"), std::string::npos);
  EXPECT_EQ(label(parseSuite(start, "s.toml").cases[0]).find("g "), std::string::npos);
  expectUsageError(start + "g = 1.5\n", "'g'");
}

TEST(BenchSuiteQuestions, ScenesMayBeChangedAsOnTheCommandLine) {
  const std::string start =
      "name = \"m\"\nsizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n[[scenes]]\nscene = \"lights\"\n";
  const Case plain = parseSuite(start, "s.toml").cases[0];
  const SceneQuestion asked{.scene = "lights", .width = 8, .height = 8};
  EXPECT_EQ(static_cast<const SceneQuestion&>(plain), asked);
  const Case changed =
      parseSuite(
          start +
              "set_light = [\"key.size=0.5\", \"key.intensity=3\"]\neye = \"0,1,3\"\ntarget = "
              "\"0,0,0\"\nfov = 30\ndefault_lights = \"on\"\nenvironment_rotation = 90\n"
              "environment_scale = 2\naa = 2\nunshadowed = \"on\"\nrelief_paths = \"others\"\nsubsurface = "
              "\"walk\"\nanimation = "
              "\"walk\"\ngrid = \"smoke\"\ndisplaced = \"on\"\n",
          "s.toml")
          .cases[0];
  const SceneQuestion wanted{.scene = "lights",
                             .eye = "0,1,3",
                             .target = "0,0,0",
                             .fov = 30,
                             .width = 8,
                             .height = 8,
                             .aa = 2,
                             .animation = "walk",
                             .lightSettings = {"key.size=0.5", "key.intensity=3"},
                             .defaultLights = "on",
                             .environmentRotation = 90,
                             .environmentScale = 2,
                             .unshadowed = "on",
                             .reliefPaths = "others",
                             .subsurface = "walk",
                             .displaced = "on",
                             .grid = "smoke"};
  EXPECT_EQ(static_cast<const SceneQuestion&>(changed), wanted);
  EXPECT_NE(question(changed), question(plain));
  EXPECT_NE(label(changed).find("key.size=0.5 key.intensity=3"), std::string::npos);
  expectUsageError(start + "eye = \"0,1,3\"\n", "'eye' and 'target' belong together");
  expectUsageError(start + "set_light = [3]\n", "'set_light'");
  expectUsageError(start + "fov = 0\n", "'fov'");
}

TEST(BenchSuiteQuestions, TimesMayHaveAnotherSizeAndRowsTitles) {
  const Suite suite = parseSuite(R"(
    name = "a"
    sizes = ["32x16"]
    time_size = "64x48"
    pictures = true
    [[scenes]]
    scene = "balls"
    [[techniques]]
    technique = "pcss"
    label = "PCSS"
    baseline = true
    [[techniques]]
    technique = "vssm")",
                                 "a.toml");
  ASSERT_EQ(suite.cases.size(), 2u);
  const Case& c = suite.cases[0];
  EXPECT_EQ(std::tie(c.timeWidth, c.timeHeight, c.picture), std::make_tuple(64, 48, true));
  EXPECT_EQ(std::tie(c.title, c.baseline), std::make_tuple(std::string("PCSS"), true));
  EXPECT_FALSE(suite.cases[1].baseline);
  Case other = c;
  other.timeWidth = 65;
  EXPECT_NE(rowKey(c, ""), rowKey(other, ""));
}

TEST(BenchSuiteQuestions, TimedFramesMayPlayTheScene) {
  const Suite suite = parseSuite(
      "name='a'\nsizes='8x8'\n[[scenes]]\nscene='b'\ntime=1\nfps=30\n[[scenes]]\nscene='b'\ntime=1\n"
      "[[techniques]]\ntechnique='c'\n",
      "s.toml");
  ASSERT_EQ(suite.cases.size(), 2u);
  EXPECT_EQ(suite.cases[0].fps, 30);
  EXPECT_EQ(suite.cases[1].fps, 0);
  EXPECT_EQ(question(suite.cases[0]), question(suite.cases[1]));
  EXPECT_NE(rowKey(suite.cases[0], ""), rowKey(suite.cases[1], ""));
  EXPECT_EQ(label(suite.cases[0]), "30 fps/" + label(suite.cases[1]));
}

TEST(BenchSuiteQuestions, BouncesAreOneForIndirectLightAndNoneForFinalPicturesUnlessGiven) {
  const auto bounces = [](const std::string& reference, const std::string& term) {
    return parseSuite("name='a'\nsizes='8x8'\n" + reference + "[[scenes]]\nscene='b'\nterm='" + term +
                          "'\n[[techniques]]\ntechnique='c'\n",
                      "s.toml")
        .cases.at(0)
        .reference.bounces;
  };
  EXPECT_EQ(bounces("", "indirect"), 1);
  EXPECT_EQ(bounces("", "final"), 0);
  EXPECT_EQ(bounces("reference={spp=4}\n", "indirect"), 1);
  EXPECT_EQ(bounces("reference={spp=4}\n", "final"), 0);
  EXPECT_EQ(bounces("reference={bounces=3}\n", "indirect"), 3);
  EXPECT_EQ(bounces("reference={bounces=3}\n", "final"), 3);
}

}  // namespace
}  // namespace limn::bench
