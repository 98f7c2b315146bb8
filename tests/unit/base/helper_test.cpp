// Programs run in processes of their own: what they answer, and every way in which they fail.
#include "core/base/helper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "core/base/error.h"

namespace limn {
namespace {

using testing::HasSubstr;

HelperAnswer shell(const std::string& script, HelperLimits limits = {.answerBytes = 1000}) {
  return runHelper("/bin/sh", {"-c", script}, limits);
}

std::string textOf(const HelperAnswer& answer) {
  return {reinterpret_cast<const char*>(answer.bytes.data()), answer.bytes.size()};
}

TEST(Helper, AnswersOnItsStandardOutput) {
  const HelperAnswer answer = shell("printf hello; echo noise >&2; printf ' there'");
  EXPECT_EQ(textOf(answer), "hello there");
  EXPECT_EQ(answer.failure, "");
}

TEST(Helper, EveryFailureIsTold) {
  EXPECT_EQ(shell("kill -SEGV $$").failure, "it crashed: Segmentation fault");
  EXPECT_EQ(shell("kill -ABRT $$").failure, "it crashed: Aborted");
  EXPECT_EQ(shell("kill -XCPU $$").failure, "it takes too long");
  EXPECT_EQ(shell("exit 3").failure, "it ended with status 3");
  EXPECT_EQ(shell("sleep 60", {.time = std::chrono::milliseconds(20), .answerBytes = 9}).failure,
            "it takes longer than 0.02 s");
  EXPECT_EQ(shell("while :; do echo 0123456789; done").failure, "it answers more than was asked for");
  try {
    runHelper("no-such-program", {}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/limn/no-such-program cannot be started: No such file"));
  }
}

TEST(Helper, AnswersUpToItsLimit) {
  EXPECT_EQ(shell("printf 12345", {.answerBytes = 5}).failure, "");
  EXPECT_NE(shell("printf 123456", {.answerBytes = 5}).failure, "");
  const HelperAnswer much = shell("head -c 5000000 /dev/zero", {.answerBytes = 5'000'000});
  EXPECT_EQ(much.failure, "");
  EXPECT_EQ(much.bytes.size(), 5'000'000u);
}

TEST(Helper, InheritsNoFile) {
  const std::ifstream open("/proc/self/status");
  // The listing has one file of its own; a shell would have the ends of its pipes too, until it closes them.
  EXPECT_EQ(textOf(shell("exec ls /proc/self/fd")), "0\n1\n2\n3\n");
}

TEST(Helper, LeavesNoChildBehind) {
  shell("exit 0");
  shell("sleep 60", {.time = std::chrono::milliseconds(1), .answerBytes = 9});
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Helper, AnswersWhereChildrenAreNotWaitedFor) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(textOf(shell("printf hello")), "hello");
  std::signal(SIGCHLD, before);
}

}  // namespace
}  // namespace limn
