// limn reproduction: what the thesis found, or another text, beside what bench results say.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/markdown_text.h"
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
  fs::path file = options.claims;
  if (file.empty()) file = session::findShared("benchmarks", "reproduction.claims");
  if (file.empty())
    throw Error("reproduction.claims was not built or installed with limn; name a file with --claims");
  std::vector<fs::path> files;
  for (const fs::path& folder : options.results) files.push_back(folder / "results.jsonl");
  std::vector<fs::path> inputs = files;
  inputs.push_back(file);
  checkApart({options.out}, inputs);
  const std::vector<bench::Row> rows = bench::readRows(files);
  const bench::Claims claims = bench::readClaims(file);
  const std::string page =
      fmt::format("# {}\n\n{}{}Made by `limn reproduction` from rows of `limn bench`.\n\n{}",
                  bench::markdownText(claims.title), claims.preface, claims.preface.empty() ? "" : " ",
                  bench::reproductionMarkdown(claims.all, rows));
  writeTextFile(options.out, page);
  sayWritten(options.out);
  return 0;
}

}  // namespace

Action addReproductionCommand(CLI::App& command) {
  auto options = std::make_shared<ReproductionArguments>();
  command
      .add_option("results", options->results,
                  "Result folders of limn bench (its --out); of good rows of one machine that several hold, "
                  "those of the last one count")
      ->required();
  command.add_option("-o,--out", options->out, "Markdown file")->required();
  command.add_option("--claims", options->claims,
                     "TOML file of claims and their page's title; default: the thesis's");
  return [options] { return runReproduction(*options); };
}

}  // namespace limn::app
