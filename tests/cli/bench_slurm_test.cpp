// A suite handed to Slurm, and the merging of its parts, by a Slurm that runs parts at once and the last job
// when asked.
#include <nlohmann/json.hpp>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BenchSlurm : public testing::Test {
 protected:
  BenchSlurm() {
    fs::create_directory(folder_ / "bin");
    program("squeue", "");
    // Slurm runs a script as its first line says, and --wrap by sh.
    program("sbatch",
            "for word; do\n"
            "  case $word in\n"
            "    --array=*) parts=${word#--array=};;\n"
            "    --wrap=*) wrap=${word#--wrap=};;\n"
            "  esac\n"
            "  script=$word\n"
            "done\n"
            "if [ \"$wrap\" ]; then printf %s \"$wrap\" >\"$0.wrap\"; echo 2; exit; fi\n"
            "chmod +x \"$script\"\n"
            "for part in $(echo \"${parts%%%*}\" | tr , ' '); do\n"
            "  SLURM_ARRAY_TASK_ID=$part \"$script\" >&2\n"
            "done\n"
            "echo 1\n");
    fs::create_directory(folder_ / "modules");
    fs::copy_file(std::string(kBinaryDir) + "/tests/misbehaver/misbehaver.so", module_);
    suite(1);
  }

  void program(const std::string& name, const std::string& text) const {
    const fs::path file = folder_ / "bin/" / name;
    std::ofstream(file) << "#!/bin/sh\n" << text;
    fs::permissions(file, fs::perms::owner_exec, fs::perm_options::add);
  }

  /// `more` are further keys of the last technique.
  void suite(int turns, const std::string& more = "") const {
    std::ofstream(folder_ / "suite.toml")
        << "name = 'parts'\nsizes = '16x16'\nframes = 1\nwarmup = 0\nterm = 'visibility'\n"
           "reference = {spp = 2}\nturns = "
        << turns
        << "\n[[scenes]]\nscene = 'cornell_box'\nmax_masked_share = 0.5\nlights = ['#0']\n"
           "[[techniques]]\ntechnique = 'hard_shadow_map'\nparameters = {shadow_map_size = 16}\n"
           "[[techniques]]\ntechnique = 'misbehaver'\n"
        << more;
  }

  Outcome submitted() const {
    return limn({"bench", folder_ / "suite.toml", "--out", out_, "--slurm"}, environment_);
  }

  /// The last job, once the folder is free.
  Outcome merged() const {
    return run({"/bin/sh", "-c", contents(folder_ / "bin/sbatch.wrap")}, environment_);
  }

  /// Turns of each row, the last of each key.
  std::vector<int> turns() const {
    std::map<std::string, int> found;
    std::istringstream text(contents(out_ / "results.jsonl"));
    for (std::string line; std::getline(text, line);) {
      const auto row = nlohmann::json::parse(line);
      found[row["key"]] = row["stats"]["turns"];
    }
    std::vector<int> counts;
    for (const auto& [key, count] : found) counts.push_back(count);
    return counts;
  }

  const TemporaryFolder folder_;
  const fs::path out_ = folder_ / "Ergebnisse f\xc3\xbcr \"alle\"",
                 module_ = folder_ / "modules/misbehaver.so";
  const std::map<std::string, std::string> environment_ = {
      {"LIMN_TECHNIQUE_PATH", folder_ / "modules"},
      {"PATH", (folder_ / "bin").string() + ":" + std::getenv("PATH")}};
};

TEST_F(BenchSlurm, WhatIsMissingStaleOrShortOfTurnsIsMeasured) {
  const Outcome first = submitted();
  EXPECT_THAT(first.out, HasSubstr("2 of 2 rows are missing or to be measured again: job 1")) << first.err;
  const Outcome merge = merged();
  EXPECT_THAT(merge.out, HasSubstr("2 rows added")) << merge.err;
  EXPECT_EQ(turns(), (std::vector{1, 1}));
  EXPECT_THAT(submitted().out, HasSubstr("all 2 rows are there"));

  std::ofstream(module_, std::ios::app) << "later";  // as if it had been built anew
  fs::create_directories(out_ / "parts/2-of-2");     // of a task that died early
  const Outcome stale = submitted();
  EXPECT_THAT(stale.out, HasSubstr("1 of 2 rows are missing or to be measured again")) << stale.err;
  const Outcome again = merged();
  EXPECT_THAT(again.err, HasSubstr("parts/2-of-2/results.jsonl does not exist; its folder is left out\n"));
  EXPECT_THAT(again.out, HasSubstr("1 rows added"));
  EXPECT_THAT(submitted().out, HasSubstr("all 2 rows are there"));

  suite(2);
  EXPECT_THAT(submitted().out, HasSubstr("2 of 2 rows are missing or to be measured again"));
  EXPECT_THAT(merged().out, HasSubstr("2 rows added"));
  EXPECT_EQ(turns(), (std::vector{2, 2}));
  EXPECT_THAT(submitted().out, HasSubstr("all 2 rows are there"));
}

TEST_F(BenchSlurm, AChangedLabelReachesTheRowsThatAreThere) {
  submitted();
  ASSERT_THAT(merged().out, HasSubstr("2 rows added"));
  const auto tables = [&] { return contents(out_ / "tables.md"); };
  EXPECT_THAT(tables(), HasSubstr("| misbehaver |"));
  suite(1, "label = 'Well-behaved'\nbaseline = true\n");
  EXPECT_THAT(submitted().out, HasSubstr("all 2 rows are there"));
  EXPECT_THAT(tables(), HasSubstr("| Well-behaved |"));
  EXPECT_THAT(merged().out, HasSubstr("0 rows added"));
  EXPECT_THAT(tables(), HasSubstr("| Well-behaved |")) << "the parts hold the label of before";
  EXPECT_THAT(contents(out_ / "results.jsonl"), HasSubstr("\"title\":\"Well-behaved\",\"baseline\":true"));
}

TEST_F(BenchSlurm, MergingRefusesWhereNoFolderHasRows) {
  expectRefused(limn({"merge", folder_ / "none", folder_ / "bin", "--out", out_}), 1,
                {"none/results.jsonl does not exist; expected a folder that limn bench wrote"});
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace limn::test
