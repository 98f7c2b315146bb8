// Pages under docs/ that limn makes from published rows say what these rows say.
#include <regex>
#include <sstream>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

/// By the command that docs/results/README.md gives for it.
TEST(Published, TheReproductionPageIsThatOfItsRows) {
  const fs::path docs = fs::path(kSourceDir) / "docs";
  const std::string readme = contents(docs / "results/README.md");
  const std::regex command(
      "\nr=docs/results/([^\n]+)\nbuild/bin/limn reproduction ([^\n]+) --out docs/reproduction\\.md\n");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(readme, found, command));
  const fs::path results = docs / "results" / found[1].str();
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"reproduction", "--claims",
                                        fs::path(kSourceDir) / "benchmarks/reproduction.claims", "--out",
                                        folder / "page.md"};
  std::istringstream words(found[2].str());
  for (std::string word; words >> word;) {
    ASSERT_TRUE(word.starts_with("$r/")) << word;
    arguments.push_back(results / word.substr(3));
  }
  const Outcome made = limn(arguments);
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(contents(folder / "page.md"), contents(docs / "reproduction.md"))
      << "the command makes it again; say what has changed";
}

}  // namespace
}  // namespace limn::test
