// limn merge: results of several folders as those of one.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "apps/limn/results_folder.h"
#include "core/base/error.h"
#include "core/bench/merge.h"
#include "core/session/case_origins.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

int run(const std::vector<fs::path>& folders, const fs::path& out) {
  std::vector<fs::path> measured, without;
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    (fs::is_regular_file(folder / "results.jsonl", ignored) ? measured : without).push_back(folder);
  }
  if (measured.empty())
    throw Error(fmt::format("{} does not exist; expected a folder that limn bench wrote",
                            (folders.front() / "results.jsonl").string()));
  for (const fs::path& folder : without)  // a part that died early leaves none, and must not cost the others
    warn(fmt::format("{} does not exist; its folder is left out", (folder / "results.jsonl").string()));
  const ResultsFolder results(out, {}, 0);
  const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
  session::CaseOrigins origins(registry);
  const int added = bench::mergeResults(measured, out, [&](const bench::Case& c) { return origins.of(c); });
  results.writeReport();
  const std::vector<bench::Row> rows = results.rows();
  fmt::print("{} rows added; {} has {} of {} that did not fail\n", added, (out / "results.jsonl").string(),
             std::ranges::count(rows, "", &bench::Row::failure), rows.size());
  return 0;
}

}  // namespace

Action addMergeCommand(CLI::App& command) {
  auto folders = std::make_shared<std::vector<fs::path>>();
  auto out = std::make_shared<fs::path>();
  command.add_option("folders", *folders, "Result folders of limn bench, such as those of its --shard")
      ->required();
  command
      .add_option("-o,--out", *out,
                  "Folder for the rows of all of them, beside its own, with tables and report")
      ->required();
  return [folders, out] { return run(*folders, *out); };
}

}  // namespace limn::app
