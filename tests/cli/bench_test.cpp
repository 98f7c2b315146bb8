// The bench and the stress table from outside.
#include <fstream>
#include <regex>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

class BenchCommand : public testing::Test {
 protected:
  BenchCommand() {
    std::ofstream(folder_ / "suite.toml")
        << "name = \"tiny\"\nsizes = \"32x24\"\nframes = 5\nwarmup = 1\nterm = \"visibility\"\n"
           "reference = {spp = 4}\n[[scenes]]\nscene = \"cornell_box\"\nlights = [\"#0\"]\n"
           "max_masked_share = 0.2\n[[techniques]]\ntechnique = \"hard_shadow_map\"\n"
           "parameters = {shadow_map_size = 64}\n";
  }

  Outcome bench(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"bench", folder_ / "suite.toml", "--out", folder_ / out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return limn(arguments);
  }

  /// Replaces what `pattern` matches in the results.
  void rewrite(const std::string& out, const std::string& pattern, const std::string& by) {
    const fs::path file = folder_ / out / "results.jsonl";
    const std::string text = std::regex_replace(contents(file), std::regex(pattern), by);
    std::ofstream(file) << text;
  }

  const TemporaryFolder folder_;
};

TEST_F(BenchCommand, AgainstAnEarlierResultFindsWhatGotSlower) {
  ASSERT_EQ(bench("before").status, 0);
  ASSERT_EQ(bench("now").status, 0);
  // As if it had taken a thousandth, and then a thousand times as long: no machine is that noisy.
  rewrite("before", "\"frame_samples_ms\":\\[[^\\]]*\\]", "\"frame_samples_ms\":[0.001,0.001,0.001]");
  const Outcome slower = bench("now", {"--against", folder_ / "before"});
  EXPECT_EQ(slower.status, 1) << slower.err;
  EXPECT_THAT(slower.out, testing::HasSubstr("1 rows compared: 1 slower, 0 worse"));
  EXPECT_THAT(contents(folder_ / "now" / "against.md"), testing::HasSubstr("slower |"));
  rewrite("before", "\"frame_samples_ms\":\\[[^\\]]*\\]", "\"frame_samples_ms\":[9e6,9e6,9e6]");
  const Outcome faster = bench("now", {"--against", folder_ / "before"});
  EXPECT_EQ(faster.status, 0) << faster.out;
  EXPECT_THAT(faster.out, testing::HasSubstr("1 faster"));
}

/// The folder of the results has the name of the suite.
TEST_F(BenchCommand, ASuiteThatCameWithLimnIsMeasuredIntoAFolderOfItsName) {
  const std::string command = "cd '" + folder_.path().string() + "' && exec '" + kLimnBinary +
                              "' bench quick --filter cornell_box --filter hard_shadow_map --out quick";
  const Outcome first = run({"/bin/sh", "-c", command});
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.out, testing::HasSubstr("1 rows measured"));
  const Outcome again = run({"/bin/sh", "-c", command});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, testing::HasSubstr("0 rows measured, 1 were there already"));
}

TEST_F(BenchCommand, AgainstNothingIsRefusedBeforeAnythingIsMeasured) {
  expectRefused(bench("now", {"--against", folder_ / "missing"}), 1, {"--against", "results.jsonl"});
  EXPECT_FALSE(fs::exists(folder_ / "now" / "results.jsonl"));
}

TEST_F(BenchCommand, NothingToMeasureIsRefused) {
  expectRefused(bench("out", {"--filter", "no such case"}), 2, {"no case that fits the filter"});
  expectRefused(bench("out", {"--shard", "2/2"}), 2, {"--shard 2/2", "1 cases, and none for this part"});
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(BenchCommand, ACrashLosesItsOwnRowOnly) {
  std::ofstream(folder_ / "suite.toml", std::ios::app)
      << "[[techniques]]\ntechnique = \"misbehaver\"\nparameters = {way = ['crash', 'none']}\n"
         "[[techniques]]\ntechnique = \"hard_shadow_map\"\n";
  const std::map<std::string, std::string> environment = {
      {"LIMN_TECHNIQUE_PATH", std::string(kBinaryDir) + "/tests/misbehaver"}};
  const std::vector<std::string> command = {"bench", folder_ / "suite.toml", "--out", folder_ / "out"};
  const Outcome outcome = limn(command, environment);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              testing::HasSubstr("misbehaver.way=crash: crashed: Aborted, in technique misbehaver"));
  EXPECT_THAT(outcome.out, testing::HasSubstr("3 rows measured, 0 were there already, 1 failed"));
  EXPECT_THAT(contents(folder_ / "out" / "tables.md"), testing::HasSubstr("failed: crashed: Aborted"));
  // Only the crash is tried again.
  EXPECT_THAT(limn(command, environment).out,
              testing::HasSubstr("0 rows measured, 3 were there already, 1 failed"));
}

/// Of light that no technique shadows the floor has all, too: pictures of techniques have it.
TEST_F(BenchCommand, TheSeparationFloorHasTheEnvironment) {
  std::ofstream(folder_ / "suite.toml")
      << "name = \"floor\"\nsizes = \"32x24\"\nframes = 0\nterm = \"direct\"\nseparation_floor = true\n"
         "reference = {spp = 64}\n[[scenes]]\nscene = \"balls\"\nenvironment = \"studio\"\n"
         "max_masked_share = 0.2\n[[techniques]]\ntechnique = \"hard_shadow_map\"\n";
  ASSERT_EQ(bench("out", {"--filter", "separation_floor"}).status, 0);
  std::smatch bias;
  const std::string rows = contents(folder_ / "out" / "results.jsonl");
  ASSERT_TRUE(std::regex_search(rows, bias, std::regex("\"bias\":([-+0-9.e]+)")));
  EXPECT_GT(std::stod(bias[1]), 0) << "the environment is unshadowed, which makes it brighter than the truth";
}

TEST_F(BenchCommand, AFullDiskLosesOnlyWhatDidNotFit) {
  // References and one row first, while there is room.
  const auto suite = [&](const char* pictures) {
    std::ofstream(folder_ / "suite.toml")
        << "name = \"disk\"\nsizes = \"256x192\"\nframes = 1\nwarmup = 0\nterm = \"direct\"\npictures = "
        << pictures
        << "\nreference = {spp = 4}\n[[scenes]]\nscene = \"cornell_box\"\nmax_masked_share = 0.2\n"
           "[[techniques]]\ntechnique = \"hard_shadow_map\"\nparameters = {shadow_map_size = "
        << (pictures == std::string("true") ? "[64, 128]" : "64") << "}\n";
  };
  suite("false");
  ASSERT_EQ(bench("out").status, 0);
  const std::string before = contents(folder_ / "out" / "results.jsonl");
  // The disk is played by a limit on the size of files: no picture and no page fits, rows do.
  suite("true");
  constexpr rlim_t room = 24 * 1024;
  ASSERT_LT(before.size(), room / 2);
  const Outcome full = limn({"bench", folder_ / "suite.toml", "--out", folder_ / "out"}, {}, room);
  EXPECT_EQ(full.status, 1);
  EXPECT_THAT(full.err, testing::HasSubstr(".png"));
  EXPECT_THAT(full.err, testing::HasSubstr("index.html"));
  EXPECT_EQ(contents(folder_ / "out" / "results.jsonl").substr(0, before.size()), before);
  // With room again what is missing is measured: of the first row its picture.
  const Outcome after = bench("out");
  EXPECT_EQ(after.status, 0) << after.err;
  EXPECT_THAT(after.out, testing::HasSubstr("2 rows measured, 0 were there already, 0 failed"));
  EXPECT_THAT(bench("out").out, testing::HasSubstr("0 rows measured, 2 were there already, 0 failed"));
  EXPECT_THAT(contents(folder_ / "out" / "index.html"), testing::HasSubstr("</html>"));
  for (const auto& file : fs::recursive_directory_iterator(folder_ / "out"))
    EXPECT_THAT(file.path().string(), testing::Not(testing::EndsWith(".part")));
}

TEST_F(BenchCommand, AFailureInALaterFolderLeavesTheEarlierRowToTheReproduction) {
  std::ofstream(folder_ / "suite.toml", std::ios::app)
      << "[[techniques]]\ntechnique = \"hard_shadow_map\"\nparameters = {shadow_map_size = 128}\n";
  std::ofstream(folder_ / "claims.toml")
      << "[[claims]]\nwhere = \"7.6, table\"\nwhat = \"sizes\"\nmeasure = \"memory\"\nthesis = 2\n"
         "suite = \"tiny\"\nslow = [\"size=128$\"]\nfast = [\"size=64$\"]\n";
  ASSERT_EQ(bench("first").status, 0);
  fs::create_directory(folder_ / "later");
  fs::copy(folder_ / "first" / "results.jsonl", folder_ / "later");
  // The rows become failures.
  rewrite("later", "\"error\":", "\"failure\":\"lost\",\"renderer\":\"llvmpipe\",\"error\":");
  const auto reproduced = [&](const std::vector<std::string>& folders) {
    std::vector<std::string> arguments = {"reproduction", "--claims", folder_ / "claims.toml", "--out",
                                          folder_ / "page.md"};
    for (const std::string& folder : folders) arguments.push_back(folder_ / folder);
    const Outcome outcome = limn(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string page = contents(folder_ / "page.md");
    EXPECT_THAT(page,
                testing::StartsWith("# What was published, and what is measured here\n\nMade by `limn"));
    return page.substr(page.find("| 7.6, table |"));
  };
  EXPECT_THAT(reproduced({"later"}), testing::HasSubstr("| not measured |"));
  EXPECT_THAT(reproduced({"first", "later"}), testing::Not(testing::HasSubstr("| not measured |")));
}

TEST_F(BenchCommand, StressWritesATable) {
  const Outcome stress =
      limn({"stress", "--technique", "hard_shadow_map", "--filter", "scale", "--out", folder_ / "stress"});
  EXPECT_EQ(stress.status, 0) << stress.err;
  EXPECT_THAT(stress.out, testing::HasSubstr("| hard_shadow_map | scale 1e4 | balls | pass |"));
  EXPECT_EQ(contents(folder_ / "stress" / "stress.md"), stress.out);
  // A folder keeps what it holds, cases that failed as well, and takes more; the exit status says what was
  // asked.
  std::string verdicts = contents(folder_ / "stress" / "stress.json");
  const std::size_t verdict = verdicts.rfind("\"pass\"");
  ASSERT_NE(verdict, std::string::npos);
  std::ofstream(folder_ / "stress" / "stress.json") << verdicts.replace(verdict, 6, "\"failed\"");
  const Outcome more = limn(
      {"stress", "--technique", "hard_shadow_map", "--filter", "one triangle", "--out", folder_ / "stress"});
  EXPECT_EQ(more.status, 0) << more.err;
  EXPECT_THAT(more.out,
              testing::AllOf(testing::HasSubstr("one triangle"), testing::HasSubstr("scale 1e-4"),
                             testing::HasSubstr("| hard_shadow_map | scale 1e4 | balls | failed |")));
  // A result counts while it allows what the case does and is measured with what would measure it now.
  const fs::path file = folder_ / "stress" / "stress.json";
  const auto rerun = [&](const std::string& pattern, const std::string& by) {
    const std::string text = std::regex_replace(contents(file), std::regex(pattern), by);
    std::ofstream(file) << std::regex_replace(text, std::regex("\"benign\": [0-9.e-]+"), "\"benign\": 123");
    return limn({"stress", "--technique", "hard_shadow_map", "--filter", "one triangle", "--out",
                 folder_ / "stress"});
  };
  const auto lines = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("| one triangle |", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const std::string line = "one triangle \\| balls \\| [^\n]*\\| 123 \\|";
  const auto kept = [&](const std::string& text) { return std::regex_search(text, std::regex(line)); };
  EXPECT_TRUE(kept(rerun("no such text", "").out)) << "nothing has changed";
  for (const auto& [pattern, by] :
       {std::pair("\"allowed\": [0-9.]+", "\"allowed\": 77"), std::pair("\"hash\": \"", "\"hash\": \"0"),
        std::pair("\"program\": \"", "\"program\": \"0")}) {
    const Outcome again = rerun(pattern, by);
    EXPECT_FALSE(kept(again.out)) << again.out;
    EXPECT_EQ(lines(again.out), 1u) << again.out;
  }
  const std::string ours = contents(file);
  const std::string theirs =
      std::regex_replace(ours, std::regex("\"renderer\": \"[^\"]*\""), "\"renderer\": \"A GPU\"");
  std::ofstream(file) << theirs;
  expectRefused(limn({"stress", "--technique", "hard_shadow_map", "--filter", "one triangle", "--out",
                      folder_ / "stress"}),
                1, {"stress.json", "results of A GPU", "another folder"});
  EXPECT_EQ(contents(file), theirs);
  std::ofstream(file) << "{}";
  expectRefused(limn({"stress", "--technique", "hard_shadow_map", "--out", folder_ / "stress"}), 1,
                {"stress.json"});
  expectRefused(limn({"stress", "--filter", "no such case"}), 2, {"no such case"});
  expectRefused(limn({"stress", "--technique", "pcs"}), 2, {"pcs"});
}

}  // namespace
}  // namespace limn::test
