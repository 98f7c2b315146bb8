#include "core/brdf/lobe_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/brdf/exact_models.h"

namespace limn::brdf {
namespace {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;

Brdf lambert(const dvec3& albedo) {
  return [albedo](const dvec3&, const dvec3&) { return albedo / kPi; };
}

TEST(LobePicture, DirectionsByAngles) {
  EXPECT_NEAR(glm::distance(directionAt(90, kPi / 2), dvec3(0, 1, 0)), 0, 1e-15);
  EXPECT_NEAR(glm::distance(directionAt(60, 0), dvec3(std::sqrt(0.75), 0, 0.5)), 0, 1e-15);
}

TEST(LobePicture, ReciprocalModelsHaveNoDefect) {
  EXPECT_EQ(reciprocityDefect(lambert(dvec3(0.5))), 0);
  EXPECT_EQ(reciprocityDefect(lambert(dvec3(0))), 0);
  EXPECT_LT(reciprocityDefect(metal(0.3f)), 1e-5);
}

// f = l.z: the integral of (z - c)^2 z over z is 1/4 - 2/3 c + c^2 / 2, that of z^3 is 1/4.
TEST(LobePicture, DefectOfAClosedForm) {
  double differences = 0, squares = 0;
  for (int degrees = 5; degrees <= 80; degrees += 15) {
    const double c = std::cos(degrees * kPi / 180), weight = c * std::sqrt(1 - c * c);
    differences += weight * (0.25 - 2 * c / 3 + c * c / 2);
    squares += weight * 0.25;
  }
  const double defect = reciprocityDefect([](const dvec3& l, const dvec3&) { return dvec3(l.z, 0, 0); });
  EXPECT_NEAR(defect, std::sqrt(differences / squares), 2e-3);
}

// Every direction of a disc is alike, and the discs fall by the cosine of the light.
TEST(LobePicture, LambertianDiscsAndFurnace) {
  constexpr int kSide = 40, kMargin = 2;
  const Image picture = lobePicture(lambert({0.8, 0.4, 0}), true, kSide);
  ASSERT_EQ(picture.width(), 5 * (kSide + kMargin) + kMargin);
  ASSERT_EQ(picture.height(), 2 * kSide + 2 * kMargin);
  for (int i = 0; i < 5; ++i) {
    const int corner = kMargin + i * (kSide + kMargin);
    const double cosine = std::cos(kLobeAngles[i] * kPi / 180);
    for (const int x : {3, kSide - 6})  // beside the ring
      for (const int y : {kSide / 2 - 9, kSide / 2 + 8}) {
        const auto pixel = picture.pixel(corner + x, kMargin + y);
        EXPECT_NEAR(pixel[0], std::sqrt(cosine), 1e-5) << i;
        EXPECT_NEAR(pixel[1], std::sqrt(cosine) / 2, 1e-5) << i;
        EXPECT_EQ(pixel[2], 0) << i;
      }
    // Corners are no directions.
    EXPECT_EQ(picture.at(corner, kMargin, 0), picture.at(corner, kMargin, 2));
    EXPECT_LT(picture.at(corner, kMargin, 0), 0.1f);
  }
  // From 0 in the last row but one to 1.1 at the top of the strip, lines of three pixels.
  const int top = kSide + 2 * kMargin;
  for (int x = 0; x < picture.width(); ++x)
    for (int channel = 0; channel < 3; ++channel) {
      const double albedo = channel == 0 ? 0.8 : channel == 1 ? 0.4 : 0.0;
      const int row = top + kSide - 2 - static_cast<int>(std::round(albedo / 1.1 * (kSide - 3)));
      EXPECT_EQ(picture.at(x, row, channel), 1) << x << " " << channel;
    }
}

TEST(LobePicture, GrainHasASecondRowAndBlackNoLobe) {
  const Image black = lobePicture(lambert(dvec3(0)), false, 20);
  EXPECT_EQ(black.height(), 3 * 20 + 3);
  for (const float value : black.data()) EXPECT_TRUE(value >= 0 && value <= 1);
}

// Tables may hold values whose albedo is 1e10 quarters and more: less than two rows apart they would fill the
// strip, and drawing them would not end.
TEST(LobePicture, LevelsCloserThanTwoRowsAreNotDrawn) {
  constexpr int kSide = 40, kMiddle = kSide + 4 + kSide / 2;
  for (const double albedo : {100.0, 3e10}) {
    const Image picture = lobePicture(lambert(dvec3(albedo)), true, kSide);
    for (int x = 1; x < picture.width() / 4; ++x)
      ASSERT_EQ(picture.at(x, kMiddle, 0), 0) << albedo << " " << x;
  }
  const Image few = lobePicture(lambert(dvec3(2)), true, kSide);
  int levels = 0;
  for (int y = kSide + 4; y < few.height(); ++y) levels += few.at(1, y, 0) > 0.05f && few.at(1, y, 0) < 0.5f;
  EXPECT_GE(levels, 7) << "a quarter apart up to 2, of which the uppermost is the line itself";
}

// The mirror lobe of a metal lies opposite the light, which comes from the left, and from below in the second
// row.
TEST(LobePicture, LobesLieOppositeTheLight) {
  constexpr int kSide = 80, kMargin = 4, kCell = kSide + kMargin;
  const Image picture = lobePicture(metal(0.1f), false, kSide);
  const double radius = std::sin(60 * kPi / 180) / std::sqrt(1.5) * kSide / 2;  // of 60 degrees in the disc
  const int middle = kMargin + 3 * kCell + kSide / 2, offset = static_cast<int>(radius);
  const auto red = [&](int x, int y) { return picture.at(x, y, 0); };
  EXPECT_GT(red(middle + offset, kMargin + kSide / 2), 5 * red(middle - offset + 8, kMargin + kSide / 2));
  const int second = kMargin + kCell + kSide / 2;
  EXPECT_GT(red(middle, second - offset), 5 * red(middle, second + offset - 8));
}

}  // namespace
}  // namespace limn::brdf
