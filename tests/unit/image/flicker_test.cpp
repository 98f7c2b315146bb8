// Change from frame to frame where surfaces stand still.
#include "core/image/flicker.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"

namespace limn {
namespace {

/// A wall seen at depth 2, all pixels alike.
Image frame(float value) {
  Image image(4, 2, {"R", "G", "B", "Z", "coverage", "id", "N.X", "N.Y", "N.Z"});
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) {
      const float channels[] = {value, value, value, 2, 1, 7, 0, 0, 1};
      std::copy(std::begin(channels), std::end(channels), image.pixel(x, y).begin());
    }
  return image;
}

TEST(Flicker, CountsSurfacesThatStandStill) {
  const Image before = frame(1);
  Image after = frame(1.5f);
  after.at(0, 0, after.channel("id")) = 8;
  after.at(1, 0, after.channel("Z")) = 2.1f;
  after.at(2, 0, after.channel("N.X")) = 0.1f;
  after.at(3, 0, after.channel("coverage")) = 0;
  for (int x = 0; x < 4; ++x) after.at(x, 0, 0) = 100;
  const std::vector<bool> still = stillPixels(before, after);
  EXPECT_EQ(still, (std::vector<bool>{false, false, false, false, true, true, true, true}));
  Change change;
  change.add(before, after, still);
  change.add(after, before, still);
  EXPECT_EQ(change.count, 8);
  EXPECT_NEAR(change.mean(), 0.5, 1e-6);
  EXPECT_EQ(Change{}.mean(), 0);
}

TEST(Flicker, NoiseSubtractsInSquares) {
  EXPECT_DOUBLE_EQ(withoutNoise(5, 4), 3);
  EXPECT_EQ(withoutNoise(3, 4), 0);
}

/// No number is above a bound that is asked for. What does not stand still does not count.
TEST(Flicker, FramesThatAreNotFiniteAreRefused) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image broken = frame(1);
    broken.at(2, 1, 1) = bad;
    std::vector<bool> still(8, true);
    Change change;
    EXPECT_THROW(change.add(frame(1), broken, still), Error);
    EXPECT_THROW(change.add(broken, broken, still), Error);
    still[6] = false;
    Change others;
    others.add(frame(1), broken, still);
    EXPECT_EQ(others.mean(), 0);
    EXPECT_EQ(others.count, 7);
  }
}

TEST(Flicker, FramesOfDifferentSizesAreRefused) {
  const Image other(5, 2, frame(0).channels());
  EXPECT_THROW(stillPixels(frame(0), other), Error);
  Change change;
  EXPECT_THROW(change.add(frame(0), other, std::vector<bool>(8)), Error);
  EXPECT_THROW(change.add(frame(0), frame(0), std::vector<bool>(7)), Error);
  EXPECT_THROW(stillPixels(Image::rgb(2, 2), Image::rgb(2, 2)), Error);
}

}  // namespace
}  // namespace limn
