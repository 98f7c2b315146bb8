#include "core/base/spawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "core/base/error.h"

namespace limn {
namespace {

TEST(Spawn, ArgumentsReachTheProgramAsTheyAre) {
  const ProgramOutput output = programOutput("printf", {"%s|", "a b", "$HOME", "'"});
  EXPECT_EQ(output.failure, "");
  EXPECT_EQ(output.text, "a b|$HOME|'|");
}

TEST(Spawn, OutputIsWholeAndFailuresAreSaid) {
  const ProgramOutput output = programOutput("sh", {"-c", "yes | head -c 100000; echo; echo; exit 3"});
  EXPECT_EQ(output.text.size(), 99999u) << "without the ends of the last lines";
  EXPECT_EQ(output.failure, "it ended with status 3");
  EXPECT_THROW(programOutput("no-such-program-of-limn", {}), Error);
}

TEST(Spawn, SaysHowAProgramEnded) {
  EXPECT_EQ(awaitProgram(startProgram("true", {}, {})), "");
  EXPECT_EQ(awaitProgram(startProgram("false", {}, {})), "it ended with status 1");
  EXPECT_EQ(awaitProgram(startProgram("sh", {"-c", "kill -SEGV $$"}, {})), "it crashed: Segmentation fault");
  EXPECT_EQ(endProgram(startProgram("sleep", {"1000"}, {})), "it crashed: Killed");
}

TEST(Spawn, AProgramIsEndedOnceItIsToStop) {
  int asked = 0;
  const ProgramOutput output = programOutput("sleep", {"1000"}, false, [&] { return ++asked > 3; });
  EXPECT_EQ(output.failure, "it crashed: Killed");
}

/// SIGTERM ends a program that interrupts reach, and no other.
TEST(Spawn, InterruptsReachAProgramThatIsToTakeThem) {
  EXPECT_EQ(awaitProgram(startProgram("sh", {"-c", "kill -TERM $$; exit 3"}, {})), "it ended with status 3");
  EXPECT_EQ(awaitProgram(startProgram("sh", {"-c", "kill -TERM $$; exit 3"}, {}, Interrupts::reach)),
            "it crashed: Terminated");
}

TEST(Spawn, APipeGetsTheStandardFileThatIsNamed) {
  const PipedProgram started = startPiped("sh", {"-c", "echo out; echo err >&2"}, {}, &StandardFiles::err);
  char text[16] = {};
  EXPECT_EQ(awaitProgram(started.process), "");
  EXPECT_EQ(read(started.output, text, sizeof text), 4);
  EXPECT_STREQ(text, "err\n");
  EXPECT_EQ(read(started.output, text, sizeof text), 0) << "it ends with the program";
  close(started.output);
}

TEST(Spawn, AProgramThatDoesNotExistIsAnError) {
  EXPECT_TRUE(programExists("sh"));
  EXPECT_FALSE(programExists("no-such-program-of-limn"));
  try {
    startProgram("no-such-program-of-limn", {}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no-such-program-of-limn cannot be started"));
  }
}

}  // namespace
}  // namespace limn
