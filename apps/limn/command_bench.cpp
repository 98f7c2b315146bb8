// limn bench: a suite of questions, answered with error and time.
#include <fmt/format.h>

#include "apps/limn/bench_session.h"
#include "apps/limn/commands.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct Options {
  fs::path suite, out;
  std::vector<std::string> filters;
  std::string shard;
  BackendOptions backend;
};

int run(const Options& options) {
  const bench::Summary summary =
      runSuite(findSuite(options.suite), options.out, options.backend, options.filters,
               options.shard.empty() ? bench::Shard{} : bench::parseShard(options.shard));
  fmt::print("{} rows measured, {} were there already, {} failed; tables are in {}\n", summary.done,
             summary.skipped, summary.failed, (options.out / "tables.md").string());
  return summary.failed > 0 ? 1 : 0;
}

}  // namespace

Action addBenchCommand(CLI::App& command) {
  auto options = std::make_shared<Options>();
  command.add_option("suite", options->suite, "TOML file, or the name of one of limn's suites")->required();
  command
      .add_option("--out", options->out,
                  "Folder for results.jsonl, tables and references; resumed if it exists")
      ->required();
  command.add_option("--filter", options->filters, "Only cases whose label contains this text; repeatable")
      ->take_all();
  command.add_option("--shard", options->shard, "i/n: the i-th of n parts");
  options->backend.addTo(command);
  return [options] { return run(*options); };
}

}  // namespace limn::app
