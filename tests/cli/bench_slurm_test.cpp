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

  /// `more` are further arguments.
  Outcome submitted(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {"bench", folder_ / "suite.toml", "--out", out_, "--slurm"};
    command.insert(command.end(), more.begin(), more.end());
    return limn(command, environment_);
  }

  /// Jobs 41, the parts, and 42, the merging, which wait; `merging` is what is done in place of printing 42.
  void slurmThatWaits(const std::string& merging = "echo 42") const {
    program("sbatch",
            "printf '%s\n' \"$@\" >>\"$0.words\"\n"
            "case \"$*\" in *--wrap=*) " +
                merging + ";; *) echo 41;; esac\n");
  }

  /// Slurm has nothing left but the array, whose tasks have numbers of their own.
  void onlyTheArrayIsQueued() const {
    program("squeue", "case \"$*\" in *--format=%F*) echo 41;; *) echo 43;; esac\n");
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

TEST_F(BenchSlurm, RefusesWhileThePartsRunThoughTheMergingWasCancelled) {
  slurmThatWaits();
  const Outcome first = submitted();
  ASSERT_EQ(first.status, 0) << first.err;
  onlyTheArrayIsQueued();
  expectRefused(submitted(), 1, {"is not finished", "squeue --jobs 41,42 ", "scancel 41 42 "});
  program("squeue", "echo 42\n");
  expectRefused(submitted(), 1, {"is not finished", "squeue --jobs 41,42 ", "scancel 41 42 "});
  program("squeue", "echo 412\n");  // somebody's other job
  EXPECT_EQ(submitted().status, 0);
}

TEST_F(BenchSlurm, RefusesWhileThePartsRunThoughTheMergingWasNotTaken) {
  slurmThatWaits("exit 1");
  EXPECT_EQ(submitted().status, 1);
  onlyTheArrayIsQueued();
  expectRefused(submitted(), 1, {"is not finished", "squeue --jobs 41 ", "scancel 41 "});
}

/// The job that merges locks the folder, too, and would fail beside a command that has it.
TEST_F(BenchSlurm, ARefusedCommandLeavesTheFolderToTheJobs) {
  slurmThatWaits();
  ASSERT_EQ(submitted().status, 0);
  program("squeue", "if [ -e '" + (out_ / ".lock").string() + "' ]; then touch \"$0.locked\"; fi\necho 42\n");
  expectRefused(submitted(), 1, {"is not finished"});
  EXPECT_FALSE(fs::exists(folder_ / "bin/squeue.locked"));
}

TEST_F(BenchSlurm, TasksHaveANodeForThemselvesAndAreQueuedAgainWhereItIsLost) {
  slurmThatWaits();
  const Outcome outcome = submitted({"--nodes", "3"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string words = "\n" + contents(folder_ / "bin/sbatch.words");
  const std::string array = words.substr(0, words.find("part.sh\n"));
  for (const char* word : {"--exclusive", "--requeue", "--nodes=1", "--array=1%3"})
    EXPECT_THAT(array, HasSubstr("\n" + std::string(word) + "\n"));
}

/// As Slurm is set up by default, it refuses an array with a task of number 1001.
TEST_F(BenchSlurm, ArraysAreNoLargerThanSlurmTakes) {
  slurmThatWaits();
  std::ofstream file(folder_ / "suite.toml");
  file << "name = 'parts'\nterm = 'visibility'\nsizes = [";
  for (int width = 1; width <= 1001; ++width) file << "'" << width << "x16', ";
  file << "]\n[[scenes]]\nscene = 'cornell_box'\nlights = '#0'\n"
          "[[techniques]]\ntechnique = 'hard_shadow_map'\n";
  file.close();
  const Outcome outcome = submitted({"--nodes", "300"});
  EXPECT_THAT(outcome.out, HasSubstr("measures them in 1000 parts on 300 nodes")) << outcome.err;
  EXPECT_THAT(contents(folder_ / "bin/sbatch.words"), HasSubstr(",1000%300\n"));
}

/// Names of output are patterns.
TEST_F(BenchSlurm, FoldersMayHaveAPercentSignInTheirNames) {
  slurmThatWaits();
  const fs::path out = folder_ / "50%accuracy";
  const Outcome outcome = limn({"bench", folder_ / "suite.toml", "--out", out, "--slurm"}, environment_);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string words = contents(folder_ / "bin/sbatch.words");
  for (const char* log : {"part-%a.log", "merge.log"})
    EXPECT_THAT(words,
                HasSubstr("\n--output=" + folder_.path().string() + "/50%%accuracy/slurm/" + log + "\n"));
  EXPECT_THAT(words, HasSubstr("\n" + (out / "slurm/part.sh").string() + "\n")) << "no pattern";
}

/// sbatch fills in no pattern where one is: all parts would write one log.
TEST_F(BenchSlurm, FoldersWithABackslashInTheirNamesAreRefused) {
  slurmThatWaits();
  const fs::path out = folder_ / "a\\b";
  expectRefused(limn({"bench", folder_ / "suite.toml", "--out", out, "--slurm"}, environment_), 2,
                {"--out", "a\\b", "--slurm"});
  EXPECT_FALSE(fs::exists(out));
}

/// A task whose program was killed is queued again three times, one whose program failed never.
TEST_F(BenchSlurm, TasksAreQueuedAgainThreeTimes) {
  slurmThatWaits();
  ASSERT_EQ(submitted().status, 0);
  program("scontrol", "echo \"$@\" >>\"$0.words\"\n");
  const std::string script = contents(out_ / "slurm/part.sh");
  const auto requeued = [&](const std::string& ending, int status, const std::string& restarts) {
    const std::size_t bench = script.find(" bench "), line = script.rfind('\n', bench) + 1;
    const fs::path task = folder_ / "task.sh";
    std::ofstream(task) << script.substr(0, line) << ending << script.substr(script.find('\n', bench));
    std::map<std::string, std::string> environment = environment_;
    environment["SLURM_ARRAY_TASK_ID"] = "7";
    environment["SLURM_ARRAY_JOB_ID"] = "41";
    if (!restarts.empty()) environment["SLURM_RESTART_COUNT"] = restarts;
    const fs::path words = folder_ / "bin/scontrol.words";
    fs::remove(words);
    EXPECT_EQ(run({"/bin/bash", task}, environment).status, status);
    return contents(words);
  };
  const std::string killed = "sh -c 'kill -KILL $$'";
  EXPECT_EQ(requeued(killed, 137, ""), "requeue 41_7\n") << script;
  EXPECT_EQ(requeued(killed, 137, "2"), "requeue 41_7\n");
  EXPECT_EQ(requeued(killed, 137, "3"), "");
  EXPECT_EQ(requeued("sh -c 'exit 1'", 1, ""), "");
}

/// Every task would end with it.
TEST_F(BenchSlurm, ABackEndThatDoesNotExistIsRefusedAtOnce) {
  slurmThatWaits();
  expectRefused(submitted({"--backend", "metal"}), 2, {"metal", "egl"});
  EXPECT_FALSE(fs::exists(folder_ / "bin/sbatch.words"));
}

TEST_F(BenchSlurm, MergingRefusesWhereNoFolderHasRows) {
  expectRefused(limn({"merge", folder_ / "none", folder_ / "bin", "--out", out_}), 1,
                {"none/results.jsonl does not exist; expected a folder that limn bench wrote"});
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace limn::test
