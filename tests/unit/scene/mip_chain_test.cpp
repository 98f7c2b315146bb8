// Smaller levels of textures: means in linear light, of odd sizes, too.
#include "core/scene/mip_chain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace limn::scene {
namespace {

using testing::ElementsAre;

TEST(MipChain, AveragesInLinearLight) {
  TextureImage image;
  image.srgb = true;
  image.levels.push_back({2, 1, {255, 255, 0, 255, 0, 255, 0, 0}});
  buildMipChain(image);
  ASSERT_EQ(image.levels.size(), 2u);
  EXPECT_THAT(image.levels[1].rgba, ElementsAre(188, 255, 0, 128));  // 0.5 linear is 188 in sRGB
  image.srgb = false;
  image.levels.resize(1);
  buildMipChain(image);
  EXPECT_THAT(image.levels[1].rgba, ElementsAre(128, 255, 0, 128));
}

/// Of two texels of each grey value: the nearest byte to their mean, for all pairs of values.
TEST(MipChain, HasTheNearestBytes) {
  constexpr int values = 256;
  TextureImage image;
  image.srgb = true;
  TextureImage::Level& level = image.levels.emplace_back();
  level.width = level.height = 2 * values;
  for (int y = 0; y < level.height; ++y)
    for (int x = 0; x < level.width; ++x)
      level.rgba.insert(level.rgba.end(), 4, static_cast<std::uint8_t>(x % 2 == 0 ? x / 2 : y / 2));
  buildMipChain(image);
  const auto decoded = [](int byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  double worst = 0;
  for (int y = 0; y < values; ++y)
    for (int x = 0; x < values; ++x) {
      const double mean = 0.5 * (decoded(x) + decoded(y));
      const double exact = mean <= 0.0031308 ? 12.92 * mean : 1.055 * std::pow(mean, 1 / 2.4) - 0.055;
      const int byte = image.levels[1].rgba[4 * static_cast<std::size_t>(values * y + x)];
      worst = std::max(worst, std::abs(byte - 255 * exact));
    }
  EXPECT_LE(worst, 0.501) << "half a step, and single precision";
}

TEST(MipChain, OfOddSizes) {
  TextureImage image;
  image.levels.push_back({5, 3, std::vector<std::uint8_t>(5 * 3 * 4, 77)});
  image.levels[0].rgba[0] = 255;
  buildMipChain(image);
  ASSERT_EQ(image.levels.size(), 3u);  // 5x3, 2x1, 1x1
  EXPECT_EQ(image.levels[1].width, 2);
  EXPECT_EQ(image.levels[1].height, 1);
  // Texel (0, 0) covers 2.5 x 3 texels; the bright one is 1 / 7.5 of that.
  EXPECT_EQ(image.levels[1].rgba[0], std::lround(77 + (255 - 77) / 7.5));
  EXPECT_EQ(image.levels[1].rgba[4], 77);
  EXPECT_NEAR(image.levels[2].rgba[0], 77 + (255 - 77) / 15.0, 1);  // the mean survives
}

}  // namespace
}  // namespace limn::scene
