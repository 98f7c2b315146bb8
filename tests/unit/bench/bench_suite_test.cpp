#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/suite.h"
#include "tests/support/paths.h"

namespace limn::bench {
namespace {

constexpr const char* kSuite = R"(
name = "test"
sizes = ["64x32", "128x64"]
frames = 5
term = "visibility"
reference = {noise = 0.01}

[[scenes]]
scene = "cornell_box"
cameras = ["front", "top"]
lights = "ceiling"

[[scenes]]
scene = "balls"
term = "direct"
max_masked_share = 0.02

[[techniques]]
technique = "pcss"
[techniques.parameters]
samples = [16, 64]
filter = ["disc", "square"]
jitter = true

[[techniques]]
technique = "vssm,airlight"
parameters = {"airlight.step" = 0.5}
)";

void expectUsageError(const std::string& text, const std::string& message) {
  try {
    parseSuite(text, "s.toml");
    ADD_FAILURE() << "no error; expected " << message;
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST(BenchSuite, DeepNestingIsRefusedBeforeParsing) {
  std::string dotted = "name";
  for (int i = 0; i < 50'000; ++i) dotted += ".a";
  expectUsageError("sizes=[]\n" + dotted + "=1\n", "s.toml:2: nested deeper than 16 levels");
  expectUsageError("[" + dotted + "]\n", "s.toml:1: nested deeper than 16 levels");
  expectUsageError("name=" + std::string(50'000, '['), "s.toml:1: nested deeper than 16 levels");
  // Strings and comments may say what they like.
  const std::string dots(100, '.'), brackets(100, '[');
  expectUsageError(
      "#" + dots + "\nname=\"" + brackets + "\\\"" + dots + "\"\nsizes='''\n" + brackets + "\n'''\n",
      "s.toml:3:7: ");
}

TEST(BenchSuite, TextsAreOneLine) {
  expectUsageError("name = \"a\\nb\"\n", "s.toml:1:8: 'name' must be a text of one line");
  expectUsageError(
      "name='a'\nsizes='8x8'\n[[techniques]]\ntechnique='t'\nparameters={\"a\\nb\"=1}\n[[scenes]]\nscene='s'"
      "\n",
      "a parameter's name must be one line");
  expectUsageError("name = 'a'\n\"two\\nlines\" = 1\n", "unknown key 'two?lines'");
}

TEST(BenchSuite, IncludedSuitesGiveTheirCasesOnce) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("limn_include_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const std::string body =
      "sizes = \"8x8\"\n[[scenes]]\nscene = \"balls\"\n[[techniques]]\ntechnique = \"pcss\"\n";
  writeTextFile(folder / "a.toml", "name = \"a\"\n" + body);
  writeTextFile(folder / "b.toml", "name = \"b\"\n" + body + "[[techniques]]\ntechnique = \"vssm\"\n");
  writeTextFile(folder / "all.toml", "name = \"all\"\nminutes = 3\ninclude = [\"a.toml\", \"b.toml\"]\n");
  const Suite all = readSuite(folder / "all.toml");
  EXPECT_EQ(all.minutes, 3);
  ASSERT_EQ(all.cases.size(), 2u);
  EXPECT_EQ(all.cases[1].technique, "vssm");
  writeTextFile(folder / "self.toml", "name = \"s\"\ninclude = \"self.toml\"\n");
  EXPECT_THROW(readSuite(folder / "self.toml"), UsageError);
  writeTextFile(folder / "out.toml", "name = \"o\"\ninclude = \"../a.toml\"\n");
  EXPECT_THROW(readSuite(folder / "out.toml"), UsageError);
  writeTextFile(folder / "missing.toml", "name = \"m\"\ninclude = \"nothing.toml\"\n");
  EXPECT_THROW(readSuite(folder / "missing.toml"), Error);
  std::filesystem::remove_all(folder);
}

TEST(BenchSuite, LightSizesAreQuestionsOfTheirOwn) {
  const Suite suite = parseSuite(
      "name = \"l\"\nsizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n"
      "[[scenes]]\nscene = \"balls\"\nlight_sizes = [0.3, 1.2]\n",
      "s.toml");
  ASSERT_EQ(suite.cases.size(), 2u);
  EXPECT_EQ(suite.cases[0].lightSize, 0.3);
  EXPECT_NE(question(suite.cases[0]), question(suite.cases[1]));
  EXPECT_NE(label(suite.cases[0]), label(suite.cases[1]));
}

TEST(BenchSuite, TimeSizesAreTheSameQuestionUnderAnotherLabel) {
  const std::string rest =
      "sizes = \"8x8\"\n[[techniques]]\ntechnique = \"pcss\"\n[[scenes]]\nscene = \"balls\"\n";
  const Case small = parseSuite("name = \"s\"\n" + rest, "s.toml").cases[0];
  const Case large = parseSuite("name = \"l\"\ntime_size = \"16x12\"\n" + rest, "s.toml").cases[0];
  EXPECT_EQ(question(small), question(large));
  EXPECT_EQ(label(small), "balls/first camera/all lights/final/8x8/dynamic/pcss");
  EXPECT_EQ(label(large), "balls/first camera/all lights/final/8x8 times at 16x12/dynamic/pcss");
}

TEST(BenchSuite, BoundsAreAskedForBySuite) {
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

TEST(BenchSuite, EnvironmentsAreSweptByThreshold) {
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
  expectUsageError(start + "environment_lights = 0.015\n", "needs an 'environment'");
  expectUsageError(start + "environment = \"sky.exr\"\nenvironment_lights = [0.015, 2]\n",
                   "'environment_lights'");
  expectUsageError(start + "environment = \"sky.exr\"\nenvironment_shape = \"discs\"\n",
                   "squares, rectangles");
}

TEST(BenchSuite, MediaAreSweptByPhaseFunction) {
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

TEST(BenchSuite, ScenesMayBeChangedAsOnTheCommandLine) {
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

TEST(BenchSuite, ExpandsAllCombinations) {
  const Suite suite = parseSuite(kSuite, "s.toml");
  EXPECT_EQ(suite.name, "test");
  // (2 cameras + 1) x 2 sizes x (2 x 2 settings + 1).
  ASSERT_EQ(suite.cases.size(), 30u);
  const Case& first = suite.cases.front();
  EXPECT_EQ(first.scene, "cornell_box");
  EXPECT_EQ(first.camera, "front");
  EXPECT_EQ(first.light, "ceiling");
  EXPECT_EQ(first.term, "visibility");
  EXPECT_EQ(first.width, 64);
  EXPECT_EQ(first.height, 32);
  EXPECT_EQ(first.technique, "pcss");
  EXPECT_EQ(first.frames, 5);
  EXPECT_EQ(first.warmup, 3);
  EXPECT_TRUE(first.dynamic);
  EXPECT_EQ(first.reference.noise, 0.01);
  const std::set<std::pair<std::string, std::string>> parameters(first.parameters.begin(),
                                                                 first.parameters.end());
  EXPECT_TRUE(parameters.contains({"pcss.samples", "16"}));
  EXPECT_TRUE(parameters.contains({"pcss.filter", "disc"}));
  EXPECT_TRUE(parameters.contains({"pcss.jitter", "true"}));
  const Case& last = suite.cases.back();
  EXPECT_EQ(last.technique, "vssm,airlight");
  EXPECT_EQ(last.parameters.front(), (std::pair<std::string, std::string>("airlight.step", "0.5")));
  EXPECT_EQ(last.term, "direct");
  EXPECT_EQ(last.maxMaskedShare, 0.02);
  EXPECT_EQ(last.camera, "");
}

TEST(BenchSuite, KeysAreUniqueAndTellRenderersApart) {
  const Suite suite = parseSuite(kSuite, "s.toml");
  std::set<std::string> keys;
  for (const Case& c : suite.cases) {
    EXPECT_EQ(rowKey(c, "llvmpipe").size(), 16u);
    keys.insert(rowKey(c, "llvmpipe"));
    keys.insert(rowKey(c, "GPU"));
  }
  EXPECT_EQ(keys.size(), 60u);
  EXPECT_EQ(rowKey(suite.cases[3], "x"), rowKey(parseSuite(kSuite, "other.toml").cases[3], "x"));
}

TEST(BenchSuite, TimesMayHaveAnotherSizeAndRowsTitles) {
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

TEST(BenchSuite, TimedFramesMayPlayTheScene) {
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

TEST(BenchSuite, ModesAndSeparationFloorAddCases) {
  const Suite suite = parseSuite(
      "name='a'\nsizes='8x8'\nterm='direct'\nmodes=['dynamic','static']\nseparation_floor=true\n"
      "[[scenes]]\nscene='b'\n[[techniques]]\ntechnique='c'\n",
      "s.toml");
  ASSERT_EQ(suite.cases.size(), 4u);
  EXPECT_EQ(suite.cases[0].technique, kSeparationFloor);
  EXPECT_EQ(suite.cases[1].technique, kSeparationFloor);
  EXPECT_TRUE(suite.cases[2].dynamic);
  EXPECT_FALSE(suite.cases[3].dynamic);
}

TEST(BenchSuite, ErrorsNameFileLineAndColumn) {
  const std::string good = "name='a'\nsizes='8x8'\n[[scenes]]\nscene='b'\n[[techniques]]\ntechnique='c'\n";
  EXPECT_EQ(parseSuite(good, "s.toml").cases.size(), 1u);
  expectUsageError("name='a'\nsize='8x8'\n",
                   "s.toml:2:1: unknown key 'size' in the suite; known are name, minutes");
  expectUsageError("name = \n", "s.toml:1:");
  expectUsageError("name='a'\nsizes='8by8'\n", "s.toml:2:7: size '8by8'");
  expectUsageError("name='a'\nsizes='8x0'\n", "s.toml:2:7: size '8x0'");
  expectUsageError("name='a'\nsizes=[]\n", "s.toml:2:7: 'sizes' is an empty list");
  expectUsageError("name='a'\nsizes='8x8'\n", "lacks the key 'techniques'");
  expectUsageError("frames=-1\n" + good, "s.toml:1:8: 'frames' must be a whole number");
  expectUsageError("modes=['sometimes']\n" + good, "unknown mode 'sometimes'; known are dynamic, static");
  expectUsageError("term='shadow'\n" + good,
                   "s.toml:1:6: unknown term 'shadow'; known are final, visibility");
  expectUsageError("reference={sp=1}\n" + good, "s.toml:1:12: unknown key 'sp' in reference; known are spp");
  expectUsageError("reference={bounces=0}\n" + good, "'bounces' must be a whole number in 1..1024");
  expectUsageError(
      "term='direct'\nreference={bounces=2}\n" + good,
      "s.toml:2:20: no scene asks for a term that has 'bounces': final, indirect, subsurface, specular");
  expectUsageError("reference={noise='low'}\n" + good, "'noise' must be a number in 0..1");
  expectUsageError(good + "camera='x'\n", "s.toml:7:1: unknown key 'camera' in [[techniques]]");
  expectUsageError(good + "parameters={a=[]}\n", "'c.a' has an empty list");
  expectUsageError(good + "parameters={a={b=1}}\n", "parameter 'c.a' must be a number");
  expectUsageError(good + "parameters={a=1,\"c.a\"=2}\n", "parameter 'c.a' is set twice");
  expectUsageError(
      "name='a'\nsizes='8x8'\n[[scenes]]\nscene='b'\n[[techniques]]\ntechnique='c,d'\nparameters={x=1}\n",
      "s.toml:7:13: parameter 'x' of a combination");
  expectUsageError(good + "[[techniques]]\ntechnique='c'\n", "the same case twice");
}

TEST(BenchSuite, TermsOfATechniqueAreNoPartOfItsParametersNames) {
  const std::string head = "name='a'\nsizes='8x8'\n[[scenes]]\nscene='b'\n[[techniques]]\n";
  const Suite one = parseSuite(head + "technique='c:indirect+media'\nparameters={x=1}\n", "s.toml");
  ASSERT_EQ(one.cases.size(), 1u);
  EXPECT_EQ(one.cases[0].technique, "c:indirect+media");
  EXPECT_EQ(one.cases[0].parameters.at(0).first, "c.x");
  const Suite two = parseSuite(head + "technique='d,c:indirect'\nparameters={\"c.x\"=1}\n", "s.toml");
  EXPECT_EQ(two.cases.at(0).technique, "d,c:indirect");
  const Suite all = parseSuite(head + "technique='d,c'\nparameters={\"c.x\"=1}\n", "s.toml");
  EXPECT_NE(rowKey(two.cases[0], ""), rowKey(all.cases.at(0), ""));
}

TEST(BenchSuite, RefusesExplosions) {
  std::string text =
      "name='a'\nsizes='8x8'\n[[scenes]]\nscene='b'\n[[techniques]]\ntechnique='c'\n[techniques.parameters]"
      "\n";
  for (int i = 0; i < 20; ++i) text.append("p").append(std::to_string(i)).append("=[1,2,3]\n");
  expectUsageError(text, "combinations");
}

TEST(BenchSuite, FiltersByLabel) {
  const Suite suite = parseSuite(kSuite, "s.toml");
  const std::string filters[] = {"balls", "samples=16"};
  const std::vector<Case> selected = selectCases(suite.cases, filters);
  EXPECT_EQ(selected.size(), 4u);
  for (const Case& c : selected) EXPECT_EQ(c.scene, "balls");
}

TEST(BenchSuite, ShardsPartitionTheCases) {
  const Suite suite = parseSuite(kSuite, "s.toml");
  for (const int count : {1, 2, 4, 7, 40}) {
    std::set<std::string> keys;
    std::size_t total = 0;
    for (int i = 1; i <= count; ++i) {
      const std::vector<Case> part = selectCases(suite.cases, {}, {i, count});
      total += part.size();
      for (const Case& c : part) keys.insert(rowKey(c, ""));
    }
    EXPECT_EQ(total, suite.cases.size());
    EXPECT_EQ(keys.size(), suite.cases.size());
  }
  // A question is asked in one shard only.
  std::set<std::string> first, second;
  for (const Case& c : selectCases(suite.cases, {}, {1, 2})) first.insert(question(c));
  for (const Case& c : selectCases(suite.cases, {}, {2, 2})) second.insert(question(c));
  for (const std::string& q : first) EXPECT_FALSE(second.contains(q));
}

TEST(BenchSuite, ParsesShards) {
  EXPECT_EQ(parseShard("2/4").index, 2);
  EXPECT_EQ(parseShard("2/4").count, 4);
  for (const char* text : {"", "2", "0/4", "5/4", "1/0", "a/b", "1/2x", "-1/2", "1/"}) {
    EXPECT_THROW(parseShard(text), UsageError) << text;
  }
}

TEST(BenchSuite, BouncesAreOneForIndirectLightAndNoneForFinalPicturesUnlessGiven) {
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

TEST(BenchSuite, ChapterSixAsksEveryTechniqueWhereVisibilityMatters) {
  const std::filesystem::path folder = std::filesystem::path(limn::test::kSourceDir) / "benchmarks";
  using Parameters = std::vector<std::pair<std::string, std::string>>;
  const std::pair<std::string, Parameters> expected[] = {
      {"clustered_visibility", {{"clustered_visibility.vals", "30"}}},
      {"imperfect_shadow_maps", {}},
      {"instant_radiosity", {}},
      {"instant_radiosity", {{"instant_radiosity.block", "8"}}},
      {"reflective_shadow_map", {}}};
  for (const char* file : {"ch6.toml", "ch6_figures.toml"}) {
    const Suite suite = readSuite(folder / file);
    for (const auto& row : expected) {
      const auto found = std::ranges::find_if(suite.cases, [&](const Case& c) {
        return c.scene == "colonnade" && c.camera == "aisle" && c.technique == row.first &&
               c.parameters == row.second;
      });
      ASSERT_NE(found, suite.cases.end()) << file << ": " << row.first;
      EXPECT_EQ(found->term, "indirect");
      EXPECT_EQ(found->reference.bounces, 1);
    }
  }
}

/// The stills of the animation, each with what the shadowed light is made of.
TEST(BenchSuite, SubtractiveFiguresShowEachPartOfFourMaterials) {
  const Suite suite =
      readSuite(std::filesystem::path(limn::test::kSourceDir) / "benchmarks" / "subtractive_figures.toml");
  std::map<double, std::multiset<std::string>> shown;  // by time
  for (const Case& c : suite.cases) {
    EXPECT_EQ(c.scene, "robot_brdfs");
    if (c.technique != "subtractive_shadows" || c.parameters.size() == 1) continue;
    const auto show = std::ranges::find_if(
        c.parameters, [](const auto& p) { return p.first == "subtractive_shadows.show"; });
    shown[c.time].insert(show == c.parameters.end() ? "light" : show->second);
  }
  ASSERT_EQ(shown.size(), 4u);
  for (const auto& [time, parts] : shown)
    EXPECT_EQ(parts, (std::multiset<std::string>{"hidden", "light", "shadow_buffer", "unshadowed"})) << time;
}

TEST(BenchSuite, ReadsEverySuiteOfTheRepository) {
  const std::filesystem::path root(limn::test::kSourceDir);
  int chapters = 0, techniques = 0;
  for (const auto& entry : std::filesystem::directory_iterator(root / "benchmarks")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_FALSE(readSuite(entry.path()).cases.empty()) << entry.path();
    ++chapters;
  }
  for (const auto& entry : std::filesystem::directory_iterator(root / "techniques")) {
    const std::filesystem::path suite = entry.path() / "bench.toml";
    if (!std::filesystem::exists(suite)) continue;
    EXPECT_FALSE(readSuite(suite).cases.empty()) << suite;
    ++techniques;
  }
  EXPECT_GT(chapters, 0);
  EXPECT_GT(techniques, 0);
  EXPECT_THROW(readSuite(root / "benchmarks" / "none.toml"), Error);
}

}  // namespace
}  // namespace limn::bench
