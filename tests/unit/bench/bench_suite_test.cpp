// What suites are read as: cases, refusals, parts of them, and the suites of the repository.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/suite.h"
#include "tests/support/paths.h"
#include "tests/unit/bench/suite_refusal.h"

namespace limn::bench {
namespace {

using test::expectUsageError;

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

TEST(BenchSuite, DeepNestingIsRefusedBeforeParsing) {
  std::string dotted = "name";
  for (int i = 0; i < 50'000; ++i) dotted += ".a";
  expectUsageError("sizes=[]\n" + dotted + "=1\n", "s.toml:2: nested deeper than 16 levels");
  expectUsageError("[" + dotted + "]\n", "s.toml:1: nested deeper than 16 levels");
  expectUsageError("name=" + std::string(50'000, '['), "s.toml:1: nested deeper than 16 levels");
  // A text of several lines may end in quotes of its own: they begin no other text, which would hide what
  // follows.
  for (const char* text : {R"("""a"""")", R"("""a""""")", "'''a''''", "'''a'''''"})
    expectUsageError("scene = {name = " + std::string(text) + ", " + dotted + " = 1}\n",
                     "s.toml:1: nested deeper than 16 levels");
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
                   "s.toml:2:1: unknown key 'size' in the suite; known are name, about, minutes");
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
  expectUsageError(
      good + "[[techniques]]\ntechnique='separation_floor'\n",
      "s.toml:8:11: separation_floor is no technique; the suite's key separation_floor adds its");
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

/// Whatever is too much is refused before the memory is filled with it.
TEST(BenchSuite, RefusesMoreThanMemoryHolds) {
  const std::string head = "name='a'\nsizes='8x8'\n[[scenes]]\nscene='b'\n",
                    technique = "[[techniques]]\ntechnique='c'\n";
  const auto listed = [](int count) {
    std::string list = "[1";
    for (int i = 2; i <= count; ++i) list.append(",").append(std::to_string(i));
    return list + "]";
  };
  const std::string many = listed(65), p = listed(300), q = listed(200);
  // The techniques' combinations together.
  const std::string sweep = "[techniques.parameters]\np=" + p + "\nq=" + q + "\n";
  expectUsageError(head + technique + sweep + technique + sweep + "r=1\n", "more than 100000 combinations");
  // Long texts in many combinations, of parameters and of scenes.
  const std::string megabytes(4u << 20, 'x');
  expectUsageError(head + technique + "parameters={p=" + many + ",q='" + megabytes + "'}\n",
                   "more than 256 MiB of text in all combinations");
  expectUsageError(
      "name='a'\nsizes='8x8'\n[[scenes]]\nscene='" + megabytes + "'\nlight_sizes=" + many + "\n" + technique,
      "more than 256 MiB of text in all combinations");
  // One list.
  std::string modes = "modes=['static'";
  for (int i = 0; i < 100'000; ++i) modes += ",''";
  expectUsageError(modes + "]\n" + head, "s.toml:1:7: 'modes' lists more than 100000 values");
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

/// Whoever hands out the parts of a suite knows what is in them without making each.
TEST(BenchSuite, PartsAreThoseOfTheShards) {
  const Suite suite = parseSuite(kSuite, "s.toml");
  for (const int count : {1, 2, 3, 40}) {
    const std::vector<int> parts = partsOf(suite.cases, count);
    for (int index = 1; index <= count; ++index) {
      std::vector<Case> inside;
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i] == index) inside.push_back(suite.cases[i]);
      EXPECT_EQ(inside, selectCases(suite.cases, {}, {index, count})) << index << " of " << count;
    }
  }
}

TEST(BenchSuite, ParsesShards) {
  EXPECT_EQ(parseShard("2/4").index, 2);
  EXPECT_EQ(parseShard("2/4").count, 4);
  for (const char* text : {"", "2", "0/4", "5/4", "1/0", "a/b", "1/2x", "-1/2", "1/"}) {
    EXPECT_THROW(parseShard(text), UsageError) << text;
  }
}

TEST(BenchSuite, ChapterSixAsksEveryTechniqueWhereVisibilityMatters) {
  const std::filesystem::path folder = std::filesystem::path(limn::test::kSourceDir) / "benchmarks";
  using Parameters = std::vector<std::pair<std::string, std::string>>;
  const std::pair<std::string, Parameters> expected[] = {
      {"clustered_visibility", {{"clustered_visibility.vals", "30"}}},
      {"clustered_visibility",  // as published
       {{"clustered_visibility.blur_plane", "1"},
        {"clustered_visibility.contact_texels", "0"},
        {"clustered_visibility.interleaving", "split"},
        {"clustered_visibility.kernel", "thesis"},
        {"clustered_visibility.vals", "30"}}},
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

/// A newcomer decides by them whether to start it.
TEST(BenchSuite, TheReadmeCountsTheCasesOfTheThesis) {
  const std::filesystem::path root(limn::test::kSourceDir);
  const std::string readme = readTextFile(root / "README.md", 1 << 24);
  for (const char* name : {"thesis", "thesis_quick"}) {
    const std::size_t cases = readSuite(root / "benchmarks" / fmt::format("{}.toml", name)).cases.size();
    EXPECT_NE(readme.find(fmt::format("{}` ({} cases)", name, cases)), std::string::npos)
        << name << ": " << cases;
  }
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
