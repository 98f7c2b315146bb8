#include "apps/limn/run_suite.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/limn/interruption.h"
#include "apps/limn/results_folder.h"
#include "core/base/error.h"

namespace limn::app {
namespace fs = std::filesystem;

bench::Summary runSuite(const fs::path& suite, const fs::path& out, const BackendOptions& backend,
                        const SuiteRun& run) {
  const LastWords words(fmt::format("interrupted; the rows so far are kept in {}, the same command goes on",
                                    (out / "results.jsonl").string()));
  const bench::Suite asked = bench::readSuite(suite);
  const auto fitting = bench::selectCases(asked.cases, run.filters);
  if (fitting.empty())
    throw UsageError(fmt::format("suite {} has no case that fits the filter", suite.string()));
  const auto cases = bench::selectCases(asked.cases, run.filters, run.shard);
  if (cases.empty())
    throw UsageError(fmt::format("--shard {}/{}: suite {} has {} cases, and none for this part",
                                 run.shard.index, run.shard.count, suite.string(), fitting.size()));
  ResultsFolder folder(out, backend, run.stallTimeout.value_or(asked.stallTimeout));
  if (asked.minutes > 0)
    fmt::print(
        stderr,
        "limn: suite {} takes about {} minutes in all on 2 cores without a GPU; {} of its {} cases are asked "
        "for, the folder holds {} rows\n",
        asked.name, asked.minutes, cases.size(), asked.cases.size(),
        std::ranges::count(folder.rows(), "", &bench::Row::failure));
  folder.check(cases);
  const bench::Summary summary = folder.measure(cases, "bench");
  folder.writeReport();
  return summary;
}

}  // namespace limn::app
