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

/// A bound finds an umbra in which an estimator may leave some light: what an early-out changes by more than
/// a code of the display must come nearer to the reference, and the error as a whole must not grow.
TEST(Savings, EarlyOutsMustNotGoAwayFromTheReference) {
  const Image reference = grey(0);
  const auto holds = [&](float forced, float without, bool known, double growth = 1) {
    SavingResult result{.name = "bounds", .how = "", .exact = false, .applies = true};
    comparePictures(result, grey(forced), grey(without), known ? &reference : nullptr);
    if (known) {
      result.forced.rmse = forced;
      result.without.rmse = growth * without;
    }
    return result.holds();
  };
  constexpr float kLittle = 1 / 512.0f;
  EXPECT_TRUE(holds(0.5f, 0.25f, true));
  EXPECT_FALSE(holds(0.25f, 0.5f, true)) << "farther away";
  EXPECT_FALSE(holds(0.5f, 0.25f, false)) << "nothing says which is nearer";
  EXPECT_TRUE(holds(0.5f, 0.5f - kLittle, false));
  EXPECT_TRUE(holds(0.5f, 0.5f - kLittle, true));
  EXPECT_FALSE(holds(0.5f, 0.5f - kLittle, true, 1.01)) << "the error has grown";
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
