// What a person sees of a command on a terminal, where bars of progress come and go.
#include <pty.h>

#include <cerrno>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

/// Holds all that a command wrote to a terminal, results and messages alike.
struct Session {
  int status = -1;
  std::string written;
};

Session onTerminal(std::vector<std::string> arguments, unsigned short columns) {
  arguments.insert(arguments.begin(), kLimnBinary);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const winsize size{24, columns, 0, 0};
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child < 0) return {};
  if (child == 0) {
    execv(pointers[0], pointers.data());
    _exit(127);
  }
  Session session;
  char buffer[4096];
  ssize_t count = 0;
  // Reading fails once the program has ended.
  while ((count = read(terminal, buffer, sizeof buffer)) > 0 || (count < 0 && errno == EINTR))
    if (count > 0) session.written.append(buffer, static_cast<std::size_t>(count));
  int status = 0;
  waitpid(child, &status, 0);
  close(terminal);
  session.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return session;
}

/// The lines that stand there in the end. Of the control sequences there is the one that clears the rest of a
/// line.
std::vector<std::string> shownLines(const std::string& written) {
  constexpr std::string_view clear = "\033[K";
  std::vector<std::string> lines(1);
  std::size_t column = 0;
  for (std::size_t i = 0; i < written.size(); ++i) {
    std::string& line = lines.back();
    if (std::string_view(written).substr(i).starts_with(clear)) {
      line.resize(std::min(line.size(), column));
      i += clear.size() - 1;
    } else if (written[i] == '\r') {
      column = 0;
    } else if (written[i] == '\n') {
      lines.emplace_back();
      column = 0;
    } else {
      line.resize(std::max(line.size(), column + 1), ' ');
      line[column++] = written[i];
    }
  }
  return lines;
}

class Terminal : public testing::Test {
 protected:
  void SetUp() override {
    int terminal = -1, program = -1;
    if (openpty(&terminal, &program, nullptr, nullptr, nullptr) != 0)
      GTEST_SKIP() << "there are no pseudo terminals";
    close(program);
    close(terminal);
  }
  const TemporaryFolder folder_;
};

TEST_F(Terminal, ResultsAndNotesStandInLinesOfTheirOwn) {
  const std::string truth = folder_ / "r.exr", first = folder_ / "a.0000.png", last = folder_ / "a.0001.png";
  const Session reference =
      onTerminal({"reference", kCornellBox, "--size", "16x12", "--spp", "4", "--out", truth}, 200);
  EXPECT_EQ(reference.status, 0);
  EXPECT_THAT(reference.written, testing::HasSubstr("reference [")) << "there was a bar";
  EXPECT_THAT(shownLines(reference.written),
              testing::ElementsAre(testing::StartsWith(truth + ": 4 samples per pixel, "), ""));
  const Session frames = onTerminal({"render", kCornellBox, "--size", "16x12", "--frames", "2", "--exposure",
                                     "auto", "--out", folder_ / "a.png"},
                                    200);
  EXPECT_EQ(frames.status, 0);
  EXPECT_THAT(frames.written, testing::HasSubstr("rendering ["));
  EXPECT_THAT(shownLines(frames.written),
              testing::ElementsAre(testing::StartsWith("exposure "), "wrote " + first + " to " + last, ""));
}

/// What went on in the next line would stay there.
TEST_F(Terminal, BarsAreNoLongerThanALine) {
  constexpr std::size_t columns = 40;
  const Session reference = onTerminal(
      {"reference", kCornellBox, "--size", "16x12", "--spp", "4", "--out", folder_ / "r.exr"}, columns);
  EXPECT_EQ(reference.status, 0);
  int bars = 0;
  const std::string& text = reference.written;
  for (std::size_t at = text.find("\rreference ["); at != std::string::npos;
       at = text.find("\rreference [", at + 1), ++bars)
    EXPECT_LE(text.find('\033', at) - at - 1, columns - 1) << text.substr(at + 1, 100);
  EXPECT_GT(bars, 0);
}

}  // namespace
}  // namespace limn::test
