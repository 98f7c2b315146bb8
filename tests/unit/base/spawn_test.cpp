#include "core/base/spawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"

namespace limn {
namespace {

TEST(Spawn, ArgumentsReachTheProgramAsTheyAre) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t process = startProgram("printf", {"%s|", "a b", "$HOME", "'"}, {-1, ends[1], -1});
  close(ends[1]);
  std::string text(100, '\0');
  text.resize(static_cast<size_t>(std::max<ssize_t>(0, read(ends[0], text.data(), text.size()))));
  close(ends[0]);
  EXPECT_EQ(awaitProgram(process), "");
  EXPECT_EQ(text, "a b|$HOME|'|");
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
