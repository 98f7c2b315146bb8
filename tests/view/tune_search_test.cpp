// A search in a process of its own, with shells in place of limn.
#include "apps/view/tune_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <thread>

#include "core/base/error.h"
#include "tests/cli/process.h"

namespace limn::app {
namespace {

/// Polls until the search has ended, or says that; at most a minute.
bool awaited(TuneSearch& search, const std::string& progress = {}) {
  for (int i = 0; i < 6000; ++i) {
    if (!search.poll()) return progress.empty();
    if (!progress.empty() && search.progress() == progress) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

bool hasChildren() {
  siginfo_t child{};
  return waitid(P_ALL, 0, &child, WEXITED | WNOHANG | WNOWAIT) == 0 || errno != ECHILD;
}

TEST(TuneSearch, SaysHowFarItIsAndEnds) {
  test::TemporaryFolder folder;
  const std::string go = folder / "go";
  TuneSearch search("sh", {"-c", "echo out; echo 'tune: 10%' >&2; until [ -e $0 ]; do sleep .01; done", go});
  ASSERT_TRUE(awaited(search, "tune: 10%"));
  EXPECT_TRUE(search.poll());
  std::ofstream(go).close();
  ASSERT_TRUE(awaited(search));
  EXPECT_EQ(search.problem(), "");
  EXPECT_FALSE(hasChildren());
}

TEST(TuneSearch, FailuresAreOneLine) {
  TuneSearch says("sh", {"-c", "echo 'tune: 10%' >&2; echo 'limn: no such light' >&2; exit 2"});
  ASSERT_TRUE(awaited(says));
  EXPECT_EQ(says.problem(), "no such light");
  TuneSearch silent("sh", {"-c", "echo 'tune: 10%' >&2; kill -KILL $$"});
  ASSERT_TRUE(awaited(silent));
  EXPECT_EQ(silent.problem(), "limn tune: it crashed: Killed");
  EXPECT_THROW(TuneSearch("no-such-program-of-limn", {}), Error);
  EXPECT_FALSE(hasChildren());
}

/// What is cancelled may say its last words, and has not failed.
TEST(TuneSearch, IsCancelled) {
  TuneSearch search("sh", {"-c",
                           "trap 'echo last words >&2; exit 143' TERM; echo begun >&2; while :; do "
                           "sleep .01; done"});
  ASSERT_TRUE(awaited(search, "begun"));
  search.cancel();
  ASSERT_TRUE(awaited(search));
  EXPECT_EQ(search.progress(), "last words");
  EXPECT_TRUE(search.cancelled());
  EXPECT_EQ(search.problem(), "");
  EXPECT_FALSE(hasChildren());
  search.cancel();  // has nothing to end
}

/// Nor one that does not heed it and goes on talking.
TEST(TuneSearch, LeavesNoProcess) {
  { const TuneSearch search("sleep", {"1000"}); }
  EXPECT_FALSE(hasChildren());
  {
    TuneSearch stubborn("sh",
                        {"-c", "trap '' TERM; while :; do echo begun >&2; sleep .01 2> /dev/null; done"});
    ASSERT_TRUE(awaited(stubborn, "begun"));
  }
  EXPECT_FALSE(hasChildren());
}

}  // namespace
}  // namespace limn::app
