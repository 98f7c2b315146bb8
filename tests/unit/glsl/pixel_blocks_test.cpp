// Blocks of pixels: where they are shaded, and what a pixel takes from those around it.
#include "glsl/surface/pixel_blocks.glsl"

#include <gtest/gtest.h>

namespace limn::glsl {
namespace {

float sum(const vec4& v) {
  return v.x + v.y + v.z + v.w;
}

TEST(PixelBlocks, CoverThePicture) {
  for (const int side : {1, 2, 3, 4, 32})
    for (const ivec2& size : {ivec2(1, 1), ivec2(37, 23), ivec2(64, 64)}) {
      const ivec2 count = block_count(size, side);
      EXPECT_GE(count.x * side, size.x);
      EXPECT_LT((count.x - 1) * side, size.x);
      const ivec2 last = block_middle(count - ivec2(1), side, size);
      EXPECT_TRUE(last.x < size.x && last.y < size.y);
      EXPECT_EQ(last / side, count - ivec2(1)) << "the middle lies in its block";
    }
}

TEST(PixelBlocks, TentsAddUpAndMeetAtTheMiddle) {
  for (const int side : {2, 3, 4, 32})
    for (int x = 0; x < 3 * side; ++x) {
      const BlockTents t = block_tents(ivec2(x, 0), side);
      EXPECT_NEAR(sum(t.across), 2, 1e-6);
      for (int i = 0; i < 4; ++i) {
        // A tent two blocks wide to each side around the block's middle.
        const int middle = (t.first.x + i) * side + side / 2;
        const float distance = std::abs(static_cast<float>(x - middle)) / static_cast<float>(side);
        EXPECT_NEAR(t.across[i], std::max(0.f, 1 - 0.5f * distance), 1e-6f) << side << ' ' << x;
      }
    }
}

TEST(PixelBlocks, LikenessFallsWithDistanceAndTurn) {
  const vec3 up(0, 1, 0), side(1, 0, 0);
  EXPECT_EQ(block_likeness(0, up, up, 2.2f, 0.3f), 1);
  EXPECT_NEAR(block_likeness(2.2f, up, up, 2.2f, 0.3f), std::exp(-0.5f), 1e-6f);
  EXPECT_NEAR(block_likeness(0, up, normalize(up + 0.3f * side), 2.2f, 0.3f), std::exp(-0.5f), 0.03f);
  EXPECT_LT(block_likeness(0, up, side, 2.2f, 0.3f), block_least_weight);
}

}  // namespace
}  // namespace limn::glsl
