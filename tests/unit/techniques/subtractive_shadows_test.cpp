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

}  // namespace
}  // namespace limn::subtractive_shadows
