// Levels of detail of subtractive shadows.
#include <gtest/gtest.h>

#include "techniques/subtractive_shadows/levels.h"

namespace limn::subtractive_shadows {
namespace {

TEST(SubtractiveLevels, GoFromFewLightsAndLargeBlocksToAll) {
  EXPECT_EQ(levelsBelow({25, 4}), (std::vector<Level>{{8, 16}, {8, 8}, {8, 4}, {12, 4}, {17, 4}, {25, 4}}));
  for (const Level best : {Level{1, 1}, Level{8, 4}, Level{25, 4}, Level{4096, 32}}) {
    const auto levels = levelsBelow(best);
    EXPECT_EQ(levels.back(), best);
    for (size_t i = 1; i < levels.size(); ++i) EXPECT_GT(levels[i].work(), levels[i - 1].work());
  }
}

TEST(SubtractiveLevels, FadeOnTheWayFromOneToTheNext) {
  const auto levels = levelsBelow({25, 4});
  const int last = static_cast<int>(levels.size()) - 1;
  for (int target : {0, last}) {
    const Fade settled = fadeAt(levels, target, target);
    EXPECT_EQ(settled.fewer, levels[static_cast<size_t>(target)]);
    EXPECT_EQ(settled.more, settled.fewer);
    EXPECT_EQ(settled.shareOfMore, 0);
  }
  const Fade lights = fadeAt(levels, 4.25, 0);
  EXPECT_EQ(lights.fewer, (Level{17, 4}));
  EXPECT_EQ(lights.more, (Level{25, 4}));
  EXPECT_EQ(lights.shareOfMore, 0.25f);
  // What is gone to next has its blocks from the first frame on, and nothing dearer than what is shown has
  // them on the way down.
  EXPECT_EQ(fadeAt(levels, 1, 2).fewer, levels[1]);
  EXPECT_EQ(fadeAt(levels, 1, 2).more, levels[2]);
  for (const int level : {1, last}) {
    const Fade down = fadeAt(levels, level, 0);
    EXPECT_EQ(down.fewer, levels[static_cast<size_t>(level - 1)]);
    EXPECT_EQ(down.more, levels[static_cast<size_t>(level)]);
    EXPECT_EQ(down.shareOfMore, 1);
  }
}

}  // namespace
}  // namespace limn::subtractive_shadows
