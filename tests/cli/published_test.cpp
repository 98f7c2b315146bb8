// Pages under docs/ that limn makes from published rows say what these rows say.
#include <map>
#include <regex>
#include <sstream>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

/// By the commands that docs/results/README.md gives for it: a line of names for folders
/// (`r=docs/results/…`), and `limn reproduction` over as many lines as it needs, with folders as `$r/…`.
TEST(Published, TheReproductionPageIsThatOfItsRows) {
  const fs::path docs = fs::path(kSourceDir) / "docs";
  const std::string readme = contents(docs / "results/README.md");
  const std::regex commands(
      R"(\n((?:[a-z]=docs/results/\S+ ?)+)\nbuild/bin/limn reproduction ((?:[^\n]|\\\n)+) --out docs/reproduction\.md\n)");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(readme, found, commands));
  std::map<std::string, fs::path> folders;
  std::istringstream names(found[1].str());
  for (std::string name; names >> name;)
    folders["$" + name.substr(0, 1)] = fs::path(kSourceDir) / name.substr(2);
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"reproduction", "--claims",
                                        fs::path(kSourceDir) / "benchmarks/reproduction.claims", "--out",
                                        folder / "page.md"};
  std::istringstream words(found[2].str());
  for (std::string word; words >> word;) {
    if (word == "\\") continue;
    const size_t slash = word.find('/');
    ASSERT_TRUE(slash != std::string::npos && folders.contains(word.substr(0, slash))) << word;
    arguments.push_back(folders.at(word.substr(0, slash)) / word.substr(slash + 1));
  }
  ASSERT_GT(arguments.size(), 5u);
  const Outcome made = limn(arguments);
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(contents(folder / "page.md"), contents(docs / "reproduction.md"))
      << "the command makes it again; say what has changed";
}

}  // namespace
}  // namespace limn::test
