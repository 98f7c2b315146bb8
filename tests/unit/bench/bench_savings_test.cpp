// What explain-cost says of the two pictures of a saving.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/bench/savings.h"

namespace limn::bench {
namespace {

Image grey(float value) {
  Image image = Image::rgb(4, 2);
  std::ranges::fill(image.data(), value);
  return image;
}

SavingResult compared(const Image& forced, const Image& without, bool exact) {
  SavingResult result{.name = "culled instances", .how = "", .exact = exact, .applies = true};
  comparePictures(result, forced, without, nullptr);
  return result;
}

TEST(Savings, PicturesAreComparedPixelByPixel) {
  Image other = grey(0.5f);
  other.at(1, 1, 2) = 0.75f;
  EXPECT_TRUE(compared(grey(0.5f), grey(0.5f), true).holds());
  const SavingResult apart = compared(grey(0.5f), other, true);
  EXPECT_EQ(apart.largestDifference, 0.25);
  EXPECT_EQ(apart.shareApart, 1 / 8.0);
  EXPECT_FALSE(apart.holds());
}

TEST(Savings, PicturesWithNanAreNotEqual) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float broken : {std::numeric_limits<float>::quiet_NaN(), kInfinity})
    for (const bool exact : {true, false})
      for (const bool both : {true, false}) {
        Image forced = grey(0.5f), without = grey(0.5f);
        without.at(0, 0, 1) = broken;
        if (both) forced.at(0, 0, 1) = broken;
        const SavingResult result = compared(forced, without, exact);
        EXPECT_EQ(result.largestDifference, std::numeric_limits<double>::infinity());
        EXPECT_EQ(result.shareApart, 1 / 8.0);
        EXPECT_FALSE(result.holds());
        const nlohmann::json json = nlohmann::json::parse(toJson({{result}}));
        EXPECT_TRUE(json.at("savings").at(0).at("largest_difference").is_null());
      }
}

}  // namespace
}  // namespace limn::bench
