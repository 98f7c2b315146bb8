// limn bench: a suite of questions, answered with error and time.
#include <fmt/format.h>

#include "apps/limn/bench_session.h"
#include "apps/limn/commands.h"
#include "core/base/error.h"
#include "core/bench/tables.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct Options {
  fs::path suite, out;
  std::vector<std::string> filters;
  std::string shard;
  BackendOptions backend;
};

void createFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(fmt::format("folder '{}' cannot be created: {}", folder.string(), error.message()));
}

int run(const Options& options) {
  const bench::Suite suite = bench::readSuite(options.suite);
  const auto cases =
      bench::selectCases(suite.cases, options.filters,
                         options.shard.empty() ? bench::Shard{} : bench::parseShard(options.shard));
  if (cases.empty())
    throw UsageError(fmt::format("suite {} has no case that fits the filter", options.suite.string()));
  createFolder(options.out);
  bench::ResultsFile results(options.out / "results.jsonl");
  BenchSession session(options.backend, options.out);

  Progress bar("bench");
  bench::Callbacks callbacks;
  callbacks.reference = [&](const bench::Case& c) { return session.reference(c); };
  callbacks.measure = [&](const bench::Case& c) { return session.measure(c); };
  callbacks.progress = [&](const bench::Progress& progress) {
    bar.update(double(progress.index) / progress.count, bench::label(progress.what));
    if (progress.state == bench::Progress::State::failed)
      fmt::print(stderr, "limn: {}: {}\n", bench::label(progress.what), progress.failure);
  };
  const bench::Summary summary = bench::runCases(cases, session.rendererName(), results, callbacks);
  bench::writeTables(results.rows(), options.out);
  fmt::print("{} rows measured, {} were there already, {} failed; tables are in {}\n", summary.done,
             summary.skipped, summary.failed, (options.out / "tables.md").string());
  return summary.failed > 0 ? 1 : 0;
}

}  // namespace

Action addBenchCommand(CLI::App& command) {
  auto options = std::make_shared<Options>();
  command.add_option("suite", options->suite, "TOML file, see benchmarks/")->required();
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
