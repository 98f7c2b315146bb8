// Long work that is stopped halfway is not lost.
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

/// Finished lines of a file.
std::vector<std::string> lines(const fs::path& file) {
  std::vector<std::string> result;
  std::istringstream text(contents(file));
  for (std::string line; std::getline(text, line) && !text.eof();) result.push_back(line);
  return result;
}

TEST(Interruption, ReferenceLeavesACheckpointAndResumes) {
  const TemporaryFolder folder;
  const auto command = [&](const std::string& name) {
    return std::vector<std::string>{kLimnBinary, "reference", kCornellBox,   "--size",    "48x48", "--spp",
                                    "4096",      "--out",     folder / name, "--threads", "1"};
  };
  ASSERT_EQ(run(command("whole.exr")).status, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path checkpoint = folder / "a.exr.checkpoint";
    Process process(command("a.exr"));
    ASSERT_TRUE(process.waitUntil([&] { return process.err().find('%') != std::string::npos; }))
        << process.err();
    process.signal(signal);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_THAT(outcome.err,
                testing::AllOf(testing::HasSubstr("stopped after"), testing::HasSubstr(checkpoint.string()),
                               testing::HasSubstr("the same command goes on")));
    EXPECT_EQ(listing(folder.path()), (std::vector<std::string>{"a.exr.checkpoint", "whole.exr"}));

    const Outcome resumed = run(command("a.exr"));
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_THAT(resumed.err, testing::Not(testing::HasSubstr("noise 0.0000"))) << "known from what was kept";
    EXPECT_EQ(listing(folder.path()), (std::vector<std::string>{"a.exr", "whole.exr"}));
    const Outcome compared = limn({"compare", folder / "a.exr", folder / "whole.exr", "--json"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(nlohmann::json::parse(compared.out)["rmse"], 0.0)
        << "the same bits as without the interruption";
    fs::remove(folder / "a.exr");
  }
}

TEST(Interruption, AnimationSaysWhichFramesAreThere) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    Process process({kLimnBinary, "render", kCornellBox, "--size", "16x12", "--frames", "5:100000", "-o",
                     folder / "a.png"});
    ASSERT_TRUE(process.waitUntil([&] { return fs::exists(folder / "a.0007.png"); })) << process.err();
    process.signal(signal);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 128 + signal) << outcome.err;
    std::vector<std::string> pictures = listing(folder.path());
    std::erase_if(pictures, [](const std::string& name) { return name.ends_with(".part"); });
    const std::size_t next = 5 + pictures.size();
    for (std::size_t frame = 5; frame < next; ++frame)
      EXPECT_THAT(pictures, testing::Contains("a." + std::string(4 - std::to_string(frame).size(), '0') +
                                              std::to_string(frame) + ".png"));
    // The frame in which it ended may have been written already.
    const auto says = [](std::size_t frame) {
      return testing::HasSubstr("interrupted; the frames 5:" + std::to_string(frame - 1) +
                                " are written, --frames " + std::to_string(frame) + ":100000 goes on");
    };
    EXPECT_THAT(outcome.err, testing::AnyOf(says(next), says(next - 1)));
    EXPECT_THAT(outcome.err, testing::EndsWith("goes on\n"));
  }
}

/// Otherwise the frames of the second command would have an exposure of their own.
TEST(Interruption, AnimationGoesOnWithTheExposureThatItFound) {
  const TemporaryFolder folder;
  Process process({kLimnBinary, "render", kCornellBox, "--size", "16x12", "--frames", "0:100000",
                   "--exposure", "auto", "-o", folder / "a.png"});
  ASSERT_TRUE(process.waitUntil([&] { return fs::exists(folder / "a.0001.png"); })) << process.err();
  process.signal(SIGINT);
  const Outcome outcome = process.wait();
  std::smatch match;
  ASSERT_TRUE(std::regex_search(
      outcome.err, match, std::regex(" are written, --exposure ([^ ]+) --frames [0-9]+:100000 goes on\n")))
      << outcome.err;
  ASSERT_EQ(limn({"render", kCornellBox, "--size", "16x12", "--frames", "1:1", "--exposure", match[1].str(),
                  "-o", folder / "b.png"})
                .status,
            0);
  const Outcome compared = limn({"compare", folder / "a.0001.png", folder / "b.0001.png", "--json"});
  ASSERT_EQ(compared.status, 0) << compared.err;
  EXPECT_EQ(nlohmann::json::parse(compared.out)["rmse"], 0.0);
}

TEST(Interruption, BenchSaysWhatIsKept) {
  const TemporaryFolder folder;
  std::ofstream(folder / "suite.toml")
      << "name = 'stopped'\nsizes = ['32x20']\nframes = 2\nwarmup = 0\nreference = {spp = 2}\n"
         "modes = ['dynamic', 'static']\n[[scenes]]\nscene = '"
      << kCornellBox
      << "'\nmax_masked_share = 0.05\n[[techniques]]\ntechnique = 'hard_shadow_map'\n"
         "parameters = {shadow_map_size = [16, 32], filter = ['nearest', '2x2']}\n";
  const std::vector<std::string> command{kLimnBinary, "bench", folder / "suite.toml", "-o", folder / "out"};
  const fs::path results = folder / "out/results.jsonl";
  for (const auto& [signal, rows] : {std::pair(SIGINT, 1u), std::pair(SIGTERM, 3u)}) {
    Process process(command);
    ASSERT_TRUE(process.waitUntil([&, wanted = rows] { return lines(results).size() >= wanted; }))
        << process.err();
    process.signal(signal);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 128 + signal) << outcome.err;
    EXPECT_THAT(outcome.err, testing::HasSubstr("limn: interrupted; the rows so far are kept in " +
                                                results.string() + ", the same command goes on\n"));
    EXPECT_GE(lines(results).size(), rows);
  }
  const Outcome resumed = run(command);
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(lines(results).size(), 8u);
}

/// The program that ends at once, and the one that waits for another that measures.
TEST(Interruption, QuietCommandsHaveLastWordsToo) {
  const TemporaryFolder folder;
  std::ofstream(folder / "suite.toml")
      << "name = 'quiet'\nsizes = ['32x20']\nframes = 100000\nwarmup = 0\nreference = {spp = 2}\n"
         "[[scenes]]\nscene = '"
      << kCornellBox << "'\nmax_masked_share = 0.05\n[[techniques]]\ntechnique = 'hard_shadow_map'\n";
  const std::pair<std::vector<std::string>, fs::path> commands[] = {
      {{"render", kCornellBox, "--size", "16x12", "--frames", "0:100000", "-o", folder / "a.png"},
       folder / "a.0002.png"},
      {{"bench", folder / "suite.toml", "-o", folder / "out"}, folder / "out/references"}};
  for (const auto& [arguments, sign] : commands) {
    std::vector<std::string> command = arguments;
    command.insert(command.begin(), kLimnBinary);
    command.emplace_back("-q");
    Process process(command);
    ASSERT_TRUE(process.waitUntil([&, file = sign] { return fs::exists(file); })) << process.err();
    process.signal(SIGINT);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 128 + SIGINT) << outcome.err;
    EXPECT_THAT(outcome.err, testing::StartsWith("limn: interrupted; "));
    EXPECT_THAT(outcome.err, testing::EndsWith("goes on\n"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST(Interruption, KilledBenchLosesNoRow) {
  const TemporaryFolder folder;
  constexpr size_t cases = 16;
  // Edges of the box pass through pixel centres, where the renderers may name either wall: many of so few
  // pixels.
  std::ofstream(folder / "suite.toml")
      << "name = 'killed'\nsizes = ['32x20', '48x30']\nframes = 2\nwarmup = 0\nreference = {spp = 2}\n"
         "modes = ['dynamic', 'static']\n[[scenes]]\nscene = '"
      << kCornellBox
      << "'\n"
         "max_masked_share = 0.05\n[[techniques]]\ntechnique = 'hard_shadow_map'\n"
         "parameters = {shadow_map_size = [16, 32], filter = ['nearest', '2x2']}\n";
  const std::vector<std::string> command{kLimnBinary, "bench", folder / "suite.toml", "--out",
                                         folder / "out"};
  const fs::path results = folder / "out/results.jsonl";

  Process process(command);
  ASSERT_TRUE(process.waitUntil([&] { return lines(results).size() >= 3; })) << process.err();
  process.signal(SIGKILL);
  process.wait();
  const std::vector<std::string> before = lines(results);
  std::ofstream(results, std::ios::app) << R"({"key": "torn)";  // as a power failure leaves it

  const Outcome resumed = run(command);
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  const std::vector<std::string> after = lines(results);
  ASSERT_EQ(after.size(), cases);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()))
      << "rows measured before the kill stay";
  std::set<std::string> keys;
  for (const std::string& row : after) keys.insert(nlohmann::json::parse(row)["key"]);
  EXPECT_EQ(keys.size(), cases);
  EXPECT_THAT(resumed.out, testing::HasSubstr(std::to_string(before.size()) + " were there already"));

  const std::string report = contents(folder / "out/index.html");
  for (const std::string& key : keys) EXPECT_THAT(report, testing::HasSubstr(key));
  fs::remove(folder / "out/index.html");
  ASSERT_EQ(limn({"report", folder / "out"}).status, 0);
  EXPECT_EQ(contents(folder / "out/index.html"), report) << "written anew from the rows alone";
}

}  // namespace
}  // namespace limn::test
