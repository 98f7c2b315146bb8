// How often the window is drawn.
#include "apps/view/pace.h"

#include <gtest/gtest.h>

namespace limn::app {
namespace {

constexpr double kLate = 1e-4;  ///< seconds that waits are longer than asked

/// Frames drawn within `seconds` in which no event comes, each in no time.
int framesWithoutEvents(Pace& pace, double seconds, bool moving, bool minimised) {
  int frames = 0;
  for (double now = 0; now < seconds; ++frames) {
    const double wait = pace.patience(moving, minimised) + kLate;
    pace.waited(wait);
    now += wait;
  }
  return frames;
}

TEST(Pace, SettlesAndThenRests) {
  Pace pace;
  EXPECT_LE(framesWithoutEvents(pace, 10, false, false), Pace::kSettling + 40);
  pace.patience(false, false);
  pace.waited(0.1);  // an event
  for (int frame = 0; frame < Pace::kSettling; ++frame) {
    EXPECT_EQ(pace.patience(false, false), Pace::kFrameSeconds) << frame;
    pace.waited(Pace::kFrameSeconds);
  }
  EXPECT_EQ(pace.patience(false, false), Pace::kIdleSeconds);
}

TEST(Pace, FollowsWhatMovesAndSettlesAfterIt) {
  Pace pace;
  framesWithoutEvents(pace, 1, false, false);
  EXPECT_GE(framesWithoutEvents(pace, 10, true, false), 590);
  EXPECT_EQ(pace.patience(false, false), Pace::kFrameSeconds) << "it has just stopped";
  EXPECT_LE(framesWithoutEvents(pace, 10, false, false), Pace::kSettling + 40);
}

TEST(Pace, RestsWhileNobodySeesIt) {
  Pace pace;
  EXPECT_LE(framesWithoutEvents(pace, 10, true, true), 40);
  pace.patience(true, true);
  pace.waited(0.1);
  EXPECT_EQ(pace.patience(true, true), Pace::kIdleSeconds) << "an event";
  EXPECT_EQ(pace.patience(true, false), Pace::kFrameSeconds);
}

}  // namespace
}  // namespace limn::app
