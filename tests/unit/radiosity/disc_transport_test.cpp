// Transport from discs against closed forms.
#include "core/radiosity/disc_transport.h"

#include <gtest/gtest.h>

#include <cmath>

#include "glsl/indirect/illumination_sample.glsl"

namespace limn::radiosity {
namespace {

constexpr glm::vec3 kUp{0, 0, 1};

/// A disc that faces down at `offset`.
float facing(const glm::vec3& offset, float radius) {
  return discIrradiance(offset, {0, 0, -1}, glsl::pi * radius * radius, kUp);
}

TEST(DiscTransportTest, ParallelDiscsMatchTheClosedForm) {
  for (const float radius : {0.05f, 0.5f, 1.f, 3.f})
    for (const float aside : {0.f, 0.3f, 1.f, 4.f})
      for (const float height : {0.2f, 1.f, 5.f}) {
        // Form factor of a parallel disc, off its axis (Howell, configuration B-13).
        const double h = height / double(aside > 0 ? aside : 1), r = radius / double(aside > 0 ? aside : 1);
        const double z = 1 + h * h + r * r;
        const double exact = aside > 0 ? 0.5 * (1 - (1 + h * h - r * r) / std::sqrt(z * z - 4 * r * r))
                                       : r * r / (r * r + h * h);
        EXPECT_NEAR(facing({aside, 0, height}, radius) / (glsl::pi * exact), 1, 0.025)
            << radius << " " << aside << " " << height;
      }
}

TEST(DiscTransportTest, TheHorizonTakesHalfOfADiscThatStandsOnIt) {
  const float area = 0.5f;
  const float whole = discIrradiance({1, 0, 10}, {-1, 0, 0}, area, {1, 0, 0});
  EXPECT_GT(whole, 0);
  // Half of a disc that is cut in the middle, seen against its normal.
  const float cut = discIrradiance({1, 0, 0}, {-1, 0, 0}, area, kUp);
  const float above = discIrradiance({1, 0, 1}, {-1, 0, 0}, area, kUp);
  EXPECT_GT(cut, 0);
  EXPECT_LT(cut, above);
  EXPECT_EQ(discIrradiance({1, 0, -2}, {-1, 0, 0}, area, kUp), 0);
}

TEST(DiscTransportTest, BacksSendNothing) {
  EXPECT_EQ(discIrradiance({0, 0, 1}, kUp, 1, kUp), 0);
}

TEST(DiscTransportTest, OnePointIsExactOnTheAxisAndNeverTooBright) {
  for (const float area : {1e-4f, 0.1f, 1.f, 100.f, 1e6f}) {
    const float sampled = glsl::axis_transport(area, 1, 1);
    EXPECT_NEAR(sampled / discIrradiance({0, 0, 1}, {0, 0, -1}, area, kUp), 1, 0.01) << area;
    EXPECT_LE(sampled, glsl::pi);
  }
  EXPECT_EQ(glsl::axis_transport(1, -0.5f, 1), 0);
  EXPECT_EQ(glsl::axis_transport(0, 1, 0), 0);
  EXPECT_EQ(glsl::sender_spread(1e10f, 1e-10f), glsl::incident_max_spread);
  EXPECT_FLOAT_EQ(glsl::sender_spread(0.01f, 1), 0.1f);
}

/// What A cos / d^2 alone, without the disc's own extent in it, makes of a disc at some of its radii.
TEST(DiscTransportTest, PointsForDiscsAreTooBrightNearBy) {
  struct Row {
    float radii;
    double tooBright;
  };
  for (const Row& row : {Row{2, 0.25}, Row{5, 0.04}, Row{10, 0.01}}) {
    const float disc = facing({0, 0, row.radii}, 1);
    const double point = double(glsl::pi) / double(row.radii * row.radii);
    EXPECT_NEAR(point / double(disc) - 1, row.tooBright, 0.006) << row.radii;
    EXPECT_NEAR(double(glsl::axis_transport(glsl::pi, 1, row.radii * row.radii) / disc), 1, 0.005)
        << row.radii;
  }
}

}  // namespace
}  // namespace limn::radiosity
