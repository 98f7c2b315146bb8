// limn report: what `limn bench` writes about its rows, without measuring any.
#include <fmt/format.h>

#include "apps/limn/commands.h"
#include "core/base/error.h"
#include "core/bench/report.h"
#include "core/bench/results_file.h"
#include "core/bench/tables.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

int run(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    const fs::path file = folder / "results.jsonl";
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored))
      throw Error(fmt::format("{} does not exist; expected a folder that limn bench wrote", file.string()));
    const std::vector<bench::Row> rows = bench::readRows(file);
    bench::writeTables(rows, folder);
    bench::writeReport(rows, folder);
    fmt::print("{}\n", (folder / "index.html").string());
  }
  return 0;
}

}  // namespace

Action addReportCommand(CLI::App& command) {
  auto folders = std::make_shared<std::vector<fs::path>>();
  command.add_option("folders", *folders, "Result folders of limn bench (its --out)")->required();
  return [folders] { return run(*folders); };
}

}  // namespace limn::app
