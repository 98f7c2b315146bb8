// limn reproduction: what the thesis found, beside what bench results say.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/reproduction.h"
#include "core/bench/results_file.h"
#include "core/session/find.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

struct ReproductionArguments {
  std::vector<fs::path> results;
  fs::path claims, out;
};

int runReproduction(const ReproductionArguments& options) {
  fs::path claims = options.claims;
  if (claims.empty()) claims = session::findShared("benchmarks", "reproduction.claims");
  if (claims.empty())
    throw Error("reproduction.claims was not built or installed with limn; name a file with --claims");
  std::vector<fs::path> files;
  for (const fs::path& folder : options.results) files.push_back(folder / "results.jsonl");
  const std::vector<bench::Row> rows = bench::readRows(files);
  const std::string page =
      "# What the thesis found, and what is measured here\n\n"
      "The thesis measured on GPUs of 2006 and 2009: its frame rates beside those of another renderer would "
      "say nothing,\n"
      "its ratios may. Made by `limn reproduction` from rows of `limn bench`.\n\n" +
      bench::reproductionMarkdown(bench::readClaims(claims), rows);
  writeTextFile(options.out, page);
  sayWritten(options.out);
  return 0;
}

}  // namespace

Action addReproductionCommand(CLI::App& command) {
  auto options = std::make_shared<ReproductionArguments>();
  command
      .add_option("results", options->results,
                  "Result folders of limn bench (its --out); of good rows that several hold, those of the "
                  "last one count")
      ->required();
  command.add_option("-o,--out", options->out, "Markdown file")->required();
  command.add_option("--claims", options->claims, "TOML file; default: the thesis's");
  return [options] { return runReproduction(*options); };
}

}  // namespace limn::app
