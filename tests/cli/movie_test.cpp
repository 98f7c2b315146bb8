// Movies through ffmpeg; what needs it is skipped where it is not installed.
#include <map>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

class MovieTest : public testing::Test {
 protected:
  std::vector<std::string> command(const std::string& name, const std::string& frames) const {
    return {kLimnBinary, "render", "cornell_horse", "--technique", "hard_shadow_map", "--size",      "33x25",
            "--fps",     "10",     "--frames",      frames,        "--out",           folder_ / name};
  }

  const TemporaryFolder folder_;
};

class EncodedMovie : public MovieTest {
 protected:
  void SetUp() override {
    if (run({"/bin/sh", "-c", "command -v ffmpeg"}).status != 0) GTEST_SKIP() << "ffmpeg is not installed";
  }
};

TEST_F(EncodedMovie, EveryKindIsWrittenWhole) {
  // What files of the kind hold at a place.
  const std::map<std::string, std::pair<std::size_t, std::string>> signatures = {
      {"a.mp4", {4, "ftyp"}}, {"a.webm", {0, "\x1a\x45\xdf\xa3"}}, {"a.gif", {0, "GIF89a"}}};
  for (const auto& [name, signature] : signatures) {
    const Outcome outcome = run(command(name, "3"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string bytes = contents(folder_ / name);
    ASSERT_GT(bytes.size(), 100u);
    EXPECT_EQ(bytes.substr(signature.first, signature.second.size()), signature.second) << name;
    if (name == "a.gif") continue;  // ffmpeg gives it no texts
    const std::string version = limn({"--version"}).out;
    EXPECT_THAT(bytes, testing::HasSubstr("limn render cornell_horse --technique hard_shadow_map")) << name;
    EXPECT_THAT(bytes, testing::HasSubstr("limn " + version.substr(0, version.find('\n')))) << name;
  }
  EXPECT_EQ(listing(folder_.path()), (std::vector<std::string>{"a.gif", "a.mp4", "a.webm"}));
}

TEST_F(EncodedMovie, NothingIsLeftWhereTheDiskIsFull) {
  constexpr rlim_t room = 1024;  // enough for what is said, not for a movie
  const Outcome outcome = run(command("a.mp4", "3"), {}, room);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, testing::HasSubstr("a.mp4: ffmpeg failed"));
  EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{});
}

TEST_F(EncodedMovie, NothingIsLeftAfterAnInterruption) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Process process(command("a.mp4", "100000"));
    ASSERT_TRUE(process.waitUntil([&] { return !listing(folder_.path()).empty(); })) << process.err();
    process.signal(signal);
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.status, 128 + signal) << outcome.err;
    EXPECT_THAT(outcome.err, testing::EndsWith("limn: interrupted; no movie was written\n"));
    EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{});
  }
}

TEST_F(MovieTest, WithoutFfmpegThePackageIsNamed) {
  const Outcome outcome = run(command("a.mp4", "3"), {{"PATH", folder_.path()}});
  expectRefused(outcome, 1, {"ffmpeg", "apt-get install ffmpeg"});
  EXPECT_EQ(listing(folder_.path()), std::vector<std::string>{});
}

TEST_F(MovieTest, NeedsFrames) {
  expectRefused(limn({"render", "cornell_box", "--out", folder_ / "a.mp4"}), 2, {"a.mp4", "--frames"});
  expectRefused(run(command("a.mp4", "0")), 2, {"--frames", "'0'"});
}

}  // namespace
}  // namespace limn::test
