#include "core/base/spawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
