// limn passes: what it writes, and where it refuses to.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

using nlohmann::json;

class Passes : public testing::Test {
 protected:
  Outcome passes(std::vector<std::string> more = {}, const std::string& technique = "pcss") {
    std::vector<std::string> all{"passes", kCornellBox, "--technique", technique,
                                 "--size", "32x24",     "--out",       out_.string()};
    all.insert(all.end(), more.begin(), more.end());
    return limn(all);
  }
  json written() const { return json::parse(std::ifstream(out_ / "passes.json"))["passes"]; }

  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_ / "passes";
};

TEST_F(Passes, SayWhatAShaderIsGiven) {
  ASSERT_EQ(passes({"--set", "pcss.filter_samples=7"}).status, 0);
  json found;
  for (const json& pass : written())
    if (pass["technique"] == "pcss") found = pass;
  ASSERT_EQ(found["pass"], "visibility");
  const json program = found["programs"][0];
  EXPECT_EQ(program["groups"], json({4, 3, 1}));
  EXPECT_EQ(program["files"][0], "techniques/pcss/visibility.comp.glsl");
  EXPECT_TRUE(std::filesystem::is_regular_file(out_ / "shaders" / std::string(program["shaders"][0])));
  const auto has = [](const json& list, const json& wanted) {
    return std::ranges::any_of(list, [&](const json& entry) {
      return std::ranges::all_of(wanted.items(),
                                 [&](const auto& item) { return entry[item.key()] == item.value(); });
    });
  };
  EXPECT_TRUE(has(program["uniforms"], {{"name", "filter_samples"}, {"type", "int"}, {"value", "7"}}));
  EXPECT_TRUE(has(program["names"], {{"name", "shadow_depth"}, {"kind", "sampler"}, {"written", false}}));
  EXPECT_TRUE(has(program["names"], {{"name", "visibility"}, {"kind", "image"}, {"written", true}}));
}

TEST_F(Passes, SayWhichProgramIsCompiledUnlessQuiet) {
  const Outcome spoken = passes();
  ASSERT_EQ(spoken.status, 0) << spoken.err;
  EXPECT_THAT(spoken.err, testing::StartsWith("passes: 0% program 1 of "));
  EXPECT_EQ(passes({"--quiet"}).err, "");
}

/// The name of a scene's file is no markup.
TEST_F(Passes, TitlesOfPagesAreText) {
  const std::filesystem::path scene = folder_ / "a <b> & c.glb", cost = folder_ / "cost.md";
  std::filesystem::copy_file(kCornellBox, scene);
  const std::string name = "a &lt;b&gt; &amp; c.glb";
  ASSERT_EQ(limn({"passes", scene, "--technique", "pcf", "--size", "32x24", "--out", out_}).status, 0);
  EXPECT_THAT(contents(out_ / "README.md"),
              testing::StartsWith("# Passes of " + name + ": pcf, 32 x 24, final\n"));
  ASSERT_EQ(limn({"explain-cost", scene, "--size", "16x12", "--repeat", "1", "--out", cost}).status, 0);
  EXPECT_THAT(contents(cost), testing::StartsWith(name + ", no technique, final, 16x12, "));
}

TEST_F(Passes, AnEarlierFolderIsWrittenAgain) {
  ASSERT_EQ(passes({"--contents", "pcss/visibility"}).status, 0);
  EXPECT_EQ(listing(out_), (std::vector<std::string>{"README.md", "contents", "passes.json", "shaders"}));
  ASSERT_EQ(passes({}, "hard_shadow_map").status, 0);
  EXPECT_EQ(listing(out_), (std::vector<std::string>{"README.md", "passes.json", "shaders"}));
  for (const std::string& shader : listing(out_ / "shaders"))
    EXPECT_EQ(shader.find("pcss"), std::string::npos);
}

TEST_F(Passes, OnlyWhatAnEarlierRunWroteIsRemoved) {
  std::filesystem::create_directories(out_ / "shaders");
  std::ofstream(out_ / "shaders" / "mine.glsl") << "mine";
  std::ofstream(out_ / "passes.json") << R"({"passes": []})";
  expectRefused(passes(), 2, {"--out", "holds other files"});
  std::ofstream(folder_ / "precious") << "mine";
  std::ofstream(out_ / "passes.json")
      << R"({"generator": "limn passes", "files": ["../precious", "README.md", 3]})";
  ASSERT_EQ(passes().status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "precious"));
  EXPECT_TRUE(std::filesystem::exists(out_ / "shaders" / "mine.glsl"));
  EXPECT_EQ(json::parse(std::ifstream(out_ / "passes.json"))["complete"], true);
}

TEST_F(Passes, OtherFoldersAndUnknownPassesAreRefused) {
  std::filesystem::create_directories(out_);
  std::ofstream(out_ / "mine.txt") << "mine";
  expectRefused(passes(), 2, {"--out", "holds other files"});
  EXPECT_EQ(listing(out_), std::vector<std::string>{"mine.txt"});
  out_ = out_ / "mine.txt";
  expectRefused(passes(), 2, {"is a file"});
  out_ = folder_ / "new";
  // Frames are compiled before their passes are known, and that is said.
  expectRefused(passes({"-q", "--contents", "pcss/visibilty"}), 2,
                {"'pcss/visibilty'", "did you mean pcss/visibility"});
  EXPECT_FALSE(std::filesystem::exists(out_));
  expectRefused(passes({"-q", "--contents", "core/clear uncovered pixels"}), 2, {"binds nothing to a name"});
  expectRefused(passes({}, "pcs"), 2, {"'pcs'"});
}

TEST_F(Passes, AFolderThatCannotBeMadeIsRefusedBeforeAnythingIsCompiled) {
  std::ofstream(folder_ / "mine.txt") << "mine";
  out_ = folder_ / "mine.txt/new/passes";
  expectRefused(passes(), 1, {"mine.txt/new/passes: cannot be written", "mine.txt is a file"});
}

}  // namespace
}  // namespace limn::test
