// limn bench: a suite of questions, answered with error and time.
#include <fmt/format.h>

#include <optional>

#include "apps/limn/commands.h"
#include "apps/limn/run_suite.h"
#include "apps/limn/slurm.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/regression.h"
#include "core/session/find.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct BenchArguments {
  fs::path suite, out, against;
  std::vector<std::string> filters;
  std::string shard;
  std::optional<double> stallTimeout;
  bool slurm = false;
  SlurmJob job;
  BackendOptions backend;
};

/// Rows of an earlier result, read before anything is measured.
std::vector<bench::Row> earlierRows(const fs::path& folder) {
  const fs::path file = folder / "results.jsonl";
  if (!fs::exists(file)) throw Error(fmt::format("--against: '{}' does not exist", file.string()));
  return bench::readRows(file);
}

/// Whether something got slower or worse.
bool reportRegressions(const std::vector<bench::Row>& before, const fs::path& out) {
  const bench::Regression regression = bench::compareResults(before, bench::readRows(out / "results.jsonl"));
  const std::string text = toMarkdown(regression);
  writeTextFile(out / "against.md", text);
  fmt::print("{}", text);
  return regression.found();
}

int runBench(const BenchArguments& options) {
  const SuiteRun asked{.filters = options.filters,
                       .shard = options.shard.empty() ? bench::Shard{} : bench::parseShard(options.shard),
                       .stallTimeout = options.stallTimeout};
  if (options.slurm) {
    SlurmJob job = options.job;
    job.arguments = options.backend.arguments();
    fmt::print("{}\n", submitSuite(session::findSuite(options.suite), options.out, asked, job));
    return 0;
  }
  std::optional<std::vector<bench::Row>> before;
  if (!options.against.empty()) before = earlierRows(options.against);
  const bench::Summary summary =
      runSuite(session::findSuite(options.suite), options.out, options.backend, asked);
  fmt::print("{} rows measured, {} were there already, {} failed; the report is {}, tables are in {}\n",
             summary.done, summary.skipped, summary.failed, (options.out / "index.html").string(),
             (options.out / "tables.md").string());
  if (summary.shortened > 0)
    fmt::print("{} rows lack turns, since a further turn of theirs failed; the same command adds them\n",
               summary.shortened);
  const bool regressed = before && reportRegressions(*before, options.out);
  return !summary.complete() || regressed ? 1 : 0;
}

}  // namespace

Action addBenchCommand(CLI::App& command) {
  auto options = std::make_shared<BenchArguments>();
  command.add_option("suite", options->suite, "TOML file, or the name of one of limn's suites")->required();
  command
      .add_option("-o,--out", options->out,
                  "Folder for results.jsonl, index.html, tables and references; a run that is in it already "
                  "is resumed")
      ->required();
  takeOneEach(command.add_option("--filter", options->filters,
                                 "Only cases whose label contains this text; of several, all of them"));
  CLI::Option* against = command.add_option(
      "--against", options->against,
      "Folder of an earlier result: says what got slower or worse beyond noise, exit status 1 if "
      "anything did");
  CLI::Option* shard = command.add_option(
      "--shard", options->shard, "i/n: the i-th of n parts; each into a folder of its own, see limn merge");
  CLI::Option* slurm = command.add_flag("--slurm", options->slurm,
                                        "Submit the rows that are missing to Slurm, in parts on nodes of "
                                        "their own, and their merging; the same\n"
                                        "command goes on (docs/cluster.md)");
  slurm->excludes(shard)->excludes(against);
  command
      .add_option("--partition", options->job.partition, "Slurm's partition; default: that of Slurm itself")
      ->needs(slurm);
  command.add_option("--nodes", options->job.nodes, "Nodes that work at once")
      ->needs(slurm)
      ->transform(wholeRange(1, 100000))
      ->capture_default_str();
  command
      .add_option("--stall-timeout", options->stallTimeout,
                  "Seconds without a frame or a pass of a reference after which a case is ended and fails;\n"
                  "0: never; default: the suite's, which is 1800 unless it says otherwise")
      ->check(realRange(0.0, 1e6));
  options->backend.addTo(command);
  return [options] { return runBench(*options); };
}

}  // namespace limn::app
