// limn render from outside: what it writes and says, what it refuses, and that both back ends draw the same.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

using testing::HasSubstr;

class Render : public testing::Test {
 protected:
  std::vector<std::string> command(std::vector<std::string> more) {
    std::vector<std::string> all{"render", kCornellBox, "--size", "32x24", "--out", out_.string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_ / "picture.exr";
};

/// JSON is UTF-8, names of files need not be.
TEST_F(Render, NamesThatAreNotUtf8AreNoReasonToFail) {
  const std::string scene = folder_ / "\xff.glb", stats = folder_ / "stats.json";
  std::filesystem::copy_file(kCornellBox, scene);
  const Outcome info = limn({"info", scene, "--json"});
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_THAT(nlohmann::json::parse(info.out)["file"].get<std::string>(), testing::EndsWith("\uFFFD.glb"));
  const Outcome rendered =
      limn({"render", scene, "--size", "32x24", "--stats", stats, "--out", out_.string()});
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_THAT(nlohmann::json::parse(contents(stats))["scene"].get<std::string>(),
              testing::EndsWith("\uFFFD.glb"));
}

TEST_F(Render, WritesAPictureWithChannelsAndStatistics) {
  const auto stats = folder_ / "stats.json";
  const Outcome outcome = limn(command({"--stats", stats.string(), "--repeat", "2", "--explain"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(out_));
  const auto parsed = nlohmann::json::parse(contents(stats));
  EXPECT_EQ(parsed["size"], nlohmann::json::array({32, 24}));
  EXPECT_EQ(parsed["frame_ms"]["n"], 2);
  EXPECT_FALSE(parsed["passes"].empty());
  EXPECT_THAT(outcome.out, testing::ContainsRegex("\nrun +core +gbuffer +[0-9.]+ +[0-9.]+ +\n"))
      << "memory and time, as README.md says";
}

TEST_F(Render, SaysWhatItWroteUnlessQuiet) {
  const Outcome spoken = limn({"render", kCornellBox, "--size", "32x24", "-o", out_.string()});
  ASSERT_EQ(spoken.status, 0) << spoken.err;
  EXPECT_EQ(spoken.out, "") << "results alone";
  EXPECT_THAT(spoken.err, testing::EndsWith("wrote " + out_.string() + "\n"));
  const Outcome quiet = limn(command({"--quiet"}));
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  expectRefused(limn(command({"-q", "--technique", "hard_shadow_mop"})), 2, {"hard_shadow_mop"});
  const Outcome cost = limn({"explain-cost", kCornellBox, "-q", "--technique", "hard_shadow_map", "--size",
                             "32x24", "--repeat", "3", "--output-term", "direct", "-o", folder_ / "cost.md"});
  EXPECT_EQ(cost.status, 0) << cost.err;
  EXPECT_EQ(cost.err, "");
  EXPECT_THAT(cost.out, HasSubstr("| left out |"));
}

TEST_F(Render, SaysWhichFrameItTimes) {
  std::vector<std::string> timed = command({"--repeat", "100000"});
  timed.insert(timed.begin(), kLimnBinary);
  Process process(timed);
  EXPECT_TRUE(process.waitUntil([&] { return process.err().find("\ntiming: ") != std::string::npos; }))
      << process.err();
}

TEST_F(Render, RefusesWhatItDoesNotUnderstand) {
  expectRefused(limn(command({"--technique", "hard_shadow_mop"})), 2, {"hard_shadow_mop", "hard_shadow_map"});
  expectRefused(limn(command({"--technique", "pcss", "--set", "pcss.blocker_sample=4"})), 2,
                {"blocker_samples"});
  expectRefused(limn(command({"--technique", "pcss", "--set", "pcss.shadow_map_size=1"})), 2,
                {"shadow_map_size", "'1'"});
  expectRefused(limn(command({"--technique", "pcss,hard_shadow_map"})), 2, {"pcss", "hard_shadow_map"});
  expectRefused(limn(command({"--camera", "nowhere"})), 2, {"nowhere"});
  expectRefused(limn(command({"--light", "nowhere"})), 2, {"nowhere"});
  expectRefused(limn(command({"--output-term", "colour"})), 2,
                {"unknown term 'colour'", "known are final, visibility"});
  expectRefused(limn({"render", kCornellBox, "--out", out_, "--size", "0x5"}), 2, {"0x5", "WxH"});
  expectRefused(limn(command({"--backend", "metal"})), 2, {"metal", "egl"});
  expectRefused(limn(command({"--environment", "missing.hdr"})), 1, {"missing.hdr"});
  EXPECT_TRUE(listing(folder_.path()).empty());
}

TEST_F(Render, ShadersThatAreNotWhereTheyShouldBeAreNoticed) {
  const std::string none = folder_ / "none", empty = folder_ / "empty";
  std::filesystem::create_directory(empty);
  expectRefused(limn(command({"--shaders", none})), 2, {"--shaders", "none", "no such folder"});
  expectRefused(limn({"passes", kCornellBox, "--shaders", none, "--out", folder_ / "passes"}), 2,
                {"--shaders", "none", "no such folder"});
  expectRefused(limn({"view", kCornellBox, "--shaders", none}), 2, {"--shaders", "none", "no such folder"});
  EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{"empty"});
  const Outcome warned = limn(command({"--shaders", empty}));
  EXPECT_EQ(warned.status, 0);
  EXPECT_THAT(warned.err, HasSubstr("warning: --shaders " + empty + ": the folder holds neither glsl/"));
  const Outcome good = limn(command({"--shaders", kSourceDir}));
  EXPECT_EQ(good.status, 0);
  EXPECT_THAT(good.err, testing::Not(HasSubstr("--shaders")));
}

TEST_F(Render, AsksTechniquesForSomeOfTheirTerms) {
  const auto by = [&](const char* techniques) { return limn(command({"--technique", techniques})); };
  expectRefused(by("vssm,implicit_visibility"), 2,
                {"both answer direct light", "or implicit_visibility:environment+indirect"});
  expectRefused(by("vssm,implicit_visibility:indrect"), 2,
                {"unknown term 'indrect'", "did you mean indirect?", "visibility, environment and indirect"});
  expectRefused(by("vssm:indirect"), 2, {"vssm does not answer indirect", "it answers visibility"});
  expectRefused(by("vssm,implicit_visibility:"), 2, {"'implicit_visibility:' lacks a term"});
  expectRefused(by("vssm,vssm"), 2, {"vssm is named twice"});
  expectRefused(by("implicit_visibility:visibility,implicit_visibility:indirect"), 2,
                {"implicit_visibility is named twice", "implicit_visibility:visibility+indirect"});
  const auto stats = folder_ / "stats.json";
  const Outcome both =
      limn(command({"--technique", "vssm,implicit_visibility:indirect", "--set", "vssm.shadow_map_size=128",
                    "--set", "implicit_visibility.bins=8", "--stats", stats.string()}));
  ASSERT_EQ(both.status, 0) << both.err;
  EXPECT_EQ(nlohmann::json::parse(contents(stats))["technique"], "vssm,implicit_visibility:indirect");
}

TEST_F(Render, SaysSoWhenThereIsNoDriver) {
  expectRefused(limn(command({}), {{"__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent"}}), 1, {"EGL"});
}

TEST_F(Render, BackEndsAgreeBitForBit) {
  const auto other = folder_ / "osmesa.exr";
  ASSERT_EQ(limn(command({})).status, 0);
  ASSERT_EQ(
      limn({"render", kCornellBox, "--size", "32x24", "--backend", "osmesa", "--out", other.string()}).status,
      0);
  const Outcome outcome = limn({"compare", out_.string(), other.string(), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["rmse"], 0.0);
}

}  // namespace
}  // namespace limn::test
