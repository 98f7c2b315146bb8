// The chapters' demo programs without a display: pictures and tables as files.
#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

/// Without a display, whatever the machine has.
Outcome chapter(const std::string& name, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {std::string(kBinaryDir) + "/bin/" + name, "--headless"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run(command);
}

TEST(Chapters, FiguresAreWrittenAsFiles) {
  const TemporaryFolder folder;
  const Outcome outcome =
      chapter("ch7-variance-soft-shadows",
              {"--out", folder / "out", "--filter", "512x384", "--filter", "balls", "--filter", "savsm"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(listing(folder / "out"), std::vector<std::string>{"ch7_figures"})
      << "no other suite has that case";
  EXPECT_THAT(contents(folder / "out/ch7_figures/pictures.md"), testing::HasSubstr("![](pictures/"));
  EXPECT_THAT(contents(folder / "out/ch7_figures/tables.md"),
              testing::HasSubstr("| VSM from a summed-area table"));
}

TEST(Chapters, InterruptedTheySayWhatIsKept) {
  const TemporaryFolder folder;
  Process process({std::string(kBinaryDir) + "/bin/ch7-variance-soft-shadows", "--headless", "--out",
                   folder / "out", "--filter", "512x384", "--filter", "balls", "--filter", "savsm"});
  ASSERT_TRUE(process.waitUntil([&] { return !contents(folder / "out/ch7_figures/.lock").empty(); }))
      << process.err();
  process.signal(SIGTERM);
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.status, 128 + SIGTERM);
  EXPECT_THAT(outcome.err, testing::HasSubstr("interrupted; the rows so far are kept in " +
                                              (folder / "out/ch7_figures/results.jsonl").string() +
                                              ", the same command goes on\n"));
}

TEST(Chapters, ADisplayThatIsGoneIsNone) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run({std::string(kBinaryDir) + "/bin/ch7-variance-soft-shadows", "--out", folder / "out", "--filter",
           "512x384", "--filter", "balls", "--filter", "savsm"},
          {{"DISPLAY", ":4321"}, {"WAYLAND_DISPLAY", ""}});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::HasSubstr("as with --headless"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/ch7_figures/pictures.md"));
}

TEST(Chapters, FiltersThatNothingFitsAreRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"ch4-implicit-visibility", "ch5-convolution-soft-shadows",
                           "ch6-clustered-visibility", "ch7-variance-soft-shadows", "ch8-volume-caustics",
                           "materials", "bumps", "subsurface", "subtractive", "illumination-samples"}) {
    const Outcome outcome = chapter(name, {"--out", folder / "out", "--filter", "no such case"});
    expectRefused(outcome, 2, {name, "fits the filter"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

TEST(Chapters, OptionsOfTheWindowAreRefusedWithoutOne) {
  const TemporaryFolder folder;
  const std::vector<std::vector<std::string>> options{
      {"--scene", "balls"}, {"--size", "64x48"}, {"--frames", "3"}};
  for (const auto& option : options) {
    const Outcome outcome =
        chapter("ch7-variance-soft-shadows", {"--out", folder / "out", option[0], option[1]});
    expectRefused(outcome, 2, {option[0], "for the window"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

}  // namespace
}  // namespace limn::test
