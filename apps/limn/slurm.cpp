#include "apps/limn/slurm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <sstream>

#include "apps/limn/results_folder.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/shell.h"
#include "core/base/spawn.h"
#include "core/bench/merge.h"
#include "core/session/case_origins.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr int kPartsPerNode = 4;  // so that nodes that are done early have more to do
constexpr int kMostTasks = 1000;  // of an array, where a cluster has not been set up for more (MaxArraySize)

/// What a program of Slurm prints.
std::string output(const std::string& program, const std::vector<std::string>& arguments) {
  ProgramOutput output = programOutput(program, arguments, true);
  if (!output.failure.empty())
    throw Error(fmt::format("{} {}: {}", program, fmt::join(arguments, " "), output.failure));
  return output.text;
}

/// The folders of parts that have rows.
std::vector<fs::path> finishedParts(const fs::path& out) {
  std::vector<fs::path> folders;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(out / "parts", ignored))
    if (fs::exists(entry.path() / "results.jsonl", ignored)) folders.push_back(entry.path());
  std::ranges::sort(folders);
  return folders;
}

/// The parts that some of the cases in `some` are in, which stand in the order of `all`.
std::set<int> partsWith(std::span<const bench::Case> some, std::span<const bench::Case> all, int count) {
  const std::vector<int> parts = bench::partsOf(all, count);
  std::set<int> with;
  for (std::size_t i = 0, next = 0; i < all.size() && next < some.size(); ++i)
    if (all[i] == some[next]) {
      with.insert(parts[i]);
      ++next;
    }
  return with;
}

/// This program, as a word for a shell.
std::string thisProgram() {
  return shellQuoted(fs::read_symlink("/proc/self/exe").string());
}

/// A script for one task of the array: the part of its number. What a signal ended is queued again. Words may
/// be quoted as $'...', which bash reads and not every sh.
std::string taskScript(const fs::path& suite, const fs::path& out, int parts, const SuiteRun& run,
                       const SlurmJob& job) {
  std::string filters;
  for (const std::string& filter : run.filters) filters += " --filter " + shellQuoted(filter);
  std::string more;
  for (const std::string& argument : job.arguments) more += " " + shellQuoted(argument);
  if (run.stallTimeout) more += fmt::format(" --stall-timeout {}", *run.stallTimeout);
  return fmt::format(
      "#!/usr/bin/env bash\n"
      "part=$SLURM_ARRAY_TASK_ID\n"
      "{} bench {} --out {}/parts/$part-of-{} --shard $part/{}{}{}\n"
      "status=$?\n"
      "if [ $status -ge 128 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt 3 ]; then\n"
      "  scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$part\"\n"
      "fi\n"
      "exit $status\n",
      thisProgram(), shellQuoted(suite.string()), shellQuoted(out.string()), parts, parts, filters, more);
}

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

/// The option that names where a job's output goes: a pattern, in which a % of the folder is written twice.
std::string outputOption(const fs::path& out, const std::string& pattern) {
  std::string folder;
  for (const char c : (out / "slurm").string()) folder.append(c == '%' ? 2u : 1u, c);
  return fmt::format("--output={}/{}", folder, pattern);
}

/// Where the numbers of the jobs that were submitted last are kept.
fs::path jobsFile(const fs::path& out) {
  return out / "slurm" / "job";
}

/// Refuses while Slurm knows the array that measures or the job that merges: either may be cancelled alone.
/// Jobs of other users are not asked for, which a cluster may hide.
void refuseWhileRunning(const fs::path& out) {
  if (!fs::exists(jobsFile(out))) return;
  const std::vector<std::string> jobs = wordsOf(readTextFile(jobsFile(out)));
  // Tasks of an array have numbers of their own (%A); %F is the array's.
  const std::vector<std::string> queued = wordsOf(output("squeue", {"--noheader", "--format=%F", "--me"}));
  if (std::ranges::find_first_of(queued, jobs) != queued.end())
    throw Error(fmt::format(
        "a job of folder {} is not finished; squeue --jobs {} shows what is left, scancel {} ends it",
        out.string(), fmt::join(jobs, ","), fmt::join(jobs, " ")));
}

}  // namespace

std::string submitSuite(const fs::path& suiteFile, const fs::path& folder, const SuiteRun& run,
                        const SlurmJob& job) {
  if (!programExists("sbatch"))
    throw Error(
        "--slurm: there is no sbatch; on a machine without Slurm, --shard i/n and limn merge do by hand "
        "what it would do");
  const fs::path suite = fs::absolute(suiteFile), out = fs::absolute(folder);
  // With one, sbatch fills in no pattern: all parts would write one log.
  if (out.string().find('\\') != std::string::npos)
    throw UsageError(fmt::format(
        "--out '{}' is not accepted with --slurm: sbatch takes no \\ in names of output", folder.string()));
  const bench::Suite asked = bench::readSuite(suite);
  const auto cases = bench::selectCases(asked.cases, run.filters);
  if (cases.empty())
    throw UsageError(fmt::format("suite {} has no case that fits the filter", suite.string()));
  refuseWhileRunning(out);  // before the folder is locked, which the job that merges does as well
  ResultsFolder results(out, {}, 0);
  refuseWhileRunning(out);  // another command may have submitted jobs in between
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
  session::CaseOrigins origins(registry);
  const auto provenance = [&](const bench::Case& c) { return origins.of(c); };
  if (const std::vector<fs::path> finished = finishedParts(out); !finished.empty())
    bench::mergeResults(finished, out, provenance);
  results.check(cases);
  if (fs::exists(out / "results.jsonl")) {  // merging keeps the folder's rows with the labels of before
    bench::ResultsFile merged(out / "results.jsonl");
    bench::restateRows(cases, merged, provenance);
  }

  std::set<std::string> questions;
  for (const bench::Case& c : cases) questions.insert(bench::question(c));
  const int parts = std::min(
      {static_cast<int>(questions.size()), kPartsPerNode * job.nodes, std::max(kMostTasks, job.nodes)});
  const std::vector<bench::Case> missing = bench::unfinishedCases(cases, results.rows(), provenance);
  if (missing.empty()) {
    results.writeReport();
    return fmt::format("all {} rows are there; the report is {}", cases.size(),
                       (out / "index.html").string());
  }

  const std::set<int> open = partsWith(missing, cases, parts);
  const fs::path script = out / "slurm" / "part.sh";
  createFolder(script.parent_path());
  writeTextFile(script, taskScript(suite, out, parts, run, job));
  std::vector<std::string> common = {"--parsable", "--nodes=1", "--requeue", "--open-mode=append",
                                     "--job-name=limn-" + asked.name};
  if (!job.partition.empty()) common.push_back("--partition=" + job.partition);
  const auto submit = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), common.begin(), common.end());
    const std::string printed = output("sbatch", arguments);
    return printed.substr(0, printed.find(';'));  // "JOB;CLUSTER"
  };
  const std::string array =
      submit({"--exclusive", fmt::format("--array={}%{}", fmt::join(open, ","), job.nodes),
              outputOption(out, "part-%a.log"), script.string()});
  writeTextFile(jobsFile(out), array);  // now, since it also runs where the other job is refused
  const std::string merge = thisProgram() + " merge " + shellQuoted((out / "parts").string()) + "/* --out " +
                            shellQuoted(out.string());
  const std::string last = submit({"--dependency=afterany:" + array, outputOption(out, "merge.log"),
                                   "--wrap=bash -c " + shellQuoted(merge)});
  writeTextFile(jobsFile(out), array + "\n" + last);
  return fmt::format(
      "{} of {} rows are missing or to be measured again: job {} measures them in {} parts on {} nodes, "
      "job {} merges them; the same command goes on with what is left then",
      missing.size(), cases.size(), array, open.size(), job.nodes, last);
}

}  // namespace limn::app
