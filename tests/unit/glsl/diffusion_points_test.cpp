// What the estimator of light below surfaces in the image is made of (glsl/diffusion): planes seen from the
// eye, profiles of three channels, drawn points, and means.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "techniques/subsurface_scattering/entry_texel.glsl"
#include "tests/unit/glsl/diffusion_image.h"
#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

TEST(EyePlane, HoldsItsPointsAndTheirAreas) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const vec3 place = random(0.1f, 100) * random.direction();
    const vec3 normal = random.direction();
    const float cosine = -dot(normal, normalize(place));
    if (cosine < 0.05f) continue;
    const vec3 plane = eye_plane(place, normal);
    EXPECT_NEAR(dot(plane, place), 1, 1e-5);
    const vec3 towards = place + 0.02f * length(place) * random.direction();
    const float stretch = eye_plane_stretch(plane, towards);
    ASSERT_GT(stretch, 0);
    EXPECT_NEAR(dot(stretch * towards - place, normal) / length(place), 0, 1e-5);
    // Areas: cos th' d^2 / (cos th d'^2), here against a sphere around the eye through `towards`.
    const float d = stretch * length(towards), met = -dot(normal, normalize(towards));
    const vec3 facing = eye_plane(towards, -normalize(towards));
    const float ratio = d * d / (met * dot(towards, towards));
    EXPECT_NEAR(eye_plane_area(plane, stretch) / eye_plane_area(facing, 1) / ratio, 1, 2e-4);
    EXPECT_NEAR(eye_plane_distance(towards - place, towards, stretch), length(stretch * towards - place),
                1e-5f * length(place));
  }
}

TEST(EyePlane, EdgesAreFinite) {
  const vec3 place(0, 0, 2);
  for (const vec3 normal : {vec3(1, 0, 0), vec3(0, 0, 1), normalize(vec3(1, 0, 1e-5f))}) {
    const vec3 plane = eye_plane(place, normal);
    EXPECT_NEAR(dot(plane, place), 1, 1e-5);
    EXPECT_LT(length(plane), 0.5f / eye_plane_least_cosine * 1.01f);
  }
  EXPECT_EQ(eye_plane_stretch(vec3(0, 0, 1), vec3(1, 0, -1)), 0);
  EXPECT_EQ(eye_plane_stretch(vec3(0, 0, 1), vec3(1, 0, 0)), 0);
}

TEST(DiffusionColours, AreTheProfilesOfEachChannel) {
  for (const Matter* m : {&kSkin, &kKetchup, &kWhite}) {
    const DiffusionBoundary b = diffusion_boundary(1.3f);
    for (int c = 0; c < 3; ++c) {
      const float extinction = m->extinction[c];
      const DiffusionDipole dipole = diffusion_dipole(m->absorption[c], b);
      const NormalisedDiffusion normalised = normalised_diffusion(m->absorption[c], walk_reflectance(b));
      for (const float r : {1e-3f, 0.3f, 4.f, 20.f}) {
        const float scaled = r * extinction, area = extinction * extinction;
        EXPECT_NEAR(diffusion_density(m->dipole, r)[c] / (area * diffusion_dipole_density(dipole, scaled)), 1,
                    1e-5);
        EXPECT_NEAR(diffusion_density(m->normalised, r)[c] /
                        (area * normalised_diffusion_density(normalised, scaled)),
                    1, 1e-5);
      }
      EXPECT_NEAR(diffusion_radius(m->dipole, c, 0.7f) * extinction / diffusion_dipole_radius(dipole, 0.7f),
                  1, 1e-6);
      EXPECT_NEAR(diffusion_radius(m->normalised, c, 0.7f) * extinction /
                      normalised_diffusion_radius(normalised, 0.7f),
                  1, 1e-6);
      double mean = 0;
      for (int i = 0; i < 4000; ++i)
        mean += double(diffusion_radius(m->normalised, c, (float(i) + 0.5f) / 4000)) / 4000;
      EXPECT_NEAR(mean / double(m->reach()[c]), 1, 3e-3);
    }
  }
}

TEST(DiffusionColours, PointsAreDrawnFromTheFarthestUnlessItIsFarBeyondOthers) {
  EXPECT_EQ(diffusion_drawn_channels(vec3(1, 3, 2)), vec3(0, 1, 0));
  EXPECT_EQ(diffusion_drawn_channels(vec3(1, 1, 1)), vec3(1, 0, 0));
  EXPECT_EQ(diffusion_drawn_channels(vec3(1, 2, 3.9f)), vec3(0, 0, 1));
  EXPECT_EQ(diffusion_drawn_channels(vec3(1, 2, 4.1f)), vec3(1.f / 3));
  EXPECT_EQ(diffusion_drawn_channels(kKetchup.reach()), vec3(1.f / 3));
  for (int c = 0; c < 3; ++c) {
    vec3 one(0);
    one[c] = 1;
    for (const float choice : {0.f, 0.5f, 0.9999f}) EXPECT_EQ(drawn_channel(one, choice), c);
  }
}

TEST(DrawnPoints, HaveTheirDensity) {
  constexpr int kPoints = 1 << 14;
  for (const float disc : {0.f, 0.25f, 1.f}) {
    for (const vec3 channels : {vec3(0, 1, 0), vec3(1.f / 3)}) {
      const PointSource source{channels, disc, 4};
      for (const float within : {0.5f, 2.f, 3.f, 8.f}) {
        int hits = 0;
        for (int i = 0; i < kPoints; ++i) {
          const PointDraw draw = point_draw(uint(i), float(i % 4) < 4 * disc);
          if (drawn_radius(kSkin.dipole, source, draw) < within) ++hits;
        }
        double expected = double(disc) * std::min(1., double(within * within) / 16), integral = 0;
        for (int c = 0; c < 3; ++c)
          expected += double((1 - disc) * channels[c] * diffusion_share(kSkin.dipole, c, within));
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
          const float r = within * (float(i) + 0.5f) / kSteps;
          integral += double(2 * pi * r * drawn_density(diffusion_density(kSkin.dipole, r), source, r) *
                             within / kSteps);
        }
        EXPECT_NEAR(integral, expected, 2e-4);
        EXPECT_NEAR(double(hits) / kPoints, expected, 4e-3);
      }
    }
  }
}

/// Whatever the disc leaves of the last four points.
TEST(DrawnPoints, HaveTheirDensityWhereTwoProfilesShareWhatTheDiscLeaves) {
  constexpr int kPoints = 1 << 14;
  for (const ivec2 counts : {ivec2(16, 0), ivec2(16, 2), ivec2(4, 2), ivec2(7, 3), ivec2(4, 4)}) {
    const int samples = counts.x, disc = counts.y;
    const PointSource source{vec3(0, 1, 0), float(disc) / float(samples), 4};
    const float wider = drawn_wider_share(samples - disc);
    for (const float within : {0.5f, 2.f, 8.f}) {
      SCOPED_TRACE(testing::Message() << samples << " points, " << disc << " of a disc, within " << within);
      int hits = 0, points = 0;
      for (; points < kPoints || points % samples != 0; ++points) {
        const int point = points % samples;
        const PointDraw draw = point_draw(uint(points), point >= samples - disc);
        const float r = drawn_from_wider(point) ? drawn_radius(kWhite.dipole, source, draw)
                                                : drawn_radius(kSkin.dipole, source, draw);
        if (r < within) ++hits;
      }
      double integral = 0;
      constexpr int kSteps = 4000;
      for (int i = 0; i < kSteps; ++i) {
        const float r = within * (float(i) + 0.5f) / kSteps;
        const float density = mix(drawn_density(diffusion_density(kSkin.dipole, r), source, r),
                                  drawn_density(diffusion_density(kWhite.dipole, r), source, r), wider);
        integral += double(2 * pi * r * density * within / kSteps);
      }
      EXPECT_NEAR(double(hits) / points, integral, 5e-3);
    }
  }
}

TEST(EntryTexel, KeepsFourteenDigitsOverTheRangeOfFloats) {
  Random random(2);
  const auto packed = [](vec3 light) {
    const auto bits = [](float f) { return std::bit_cast<uint32_t>(f); };
    const uvec3 back = entry_unpack(entry_pack(uvec3(bits(light.x), bits(light.y), bits(light.z))));
    return vec3(std::bit_cast<float>(back.x), std::bit_cast<float>(back.y), std::bit_cast<float>(back.z));
  };
  for (int i = 0; i < 10000; ++i) {
    const vec3 light(std::exp(random(-80, 80)), std::exp(random(-3, 3)), std::exp(random(-80, 80)));
    const vec3 back = packed(light);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c] / light[c], 1, 1. / 16384);
  }
  EXPECT_EQ(packed(vec3(0)), vec3(0));
  EXPECT_EQ(packed(vec3(1, 2, 0.5f)), vec3(1, 2, 0.5f));
  const vec3 most = packed(vec3(std::numeric_limits<float>::max()));
  EXPECT_TRUE(std::isfinite(most.x) && std::isfinite(most.y) && std::isfinite(most.z));
}

TEST(EntryMean, NormalisesAsNamed) {
  const vec3 light(2, 3, 0), weights(4, 2, 0), here(7);
  EXPECT_EQ(entry_mean(light, weights, 5, 10, entry_normalise_none, here), vec3(0.2f, 0.3f, 0));
  EXPECT_EQ(entry_mean(light, weights, 5, 10, entry_normalise_count, here), vec3(0.4f, 0.6f, 0));
  EXPECT_EQ(entry_mean(light, weights, 5, 10, entry_normalise_weights, here), vec3(0.5f, 1.5f, 7));
  EXPECT_EQ(entry_mean(vec3(0), vec3(0), 0, 10, entry_normalise_none, here), vec3(0));
  for (int normalise = 1; normalise < 3; ++normalise)
    EXPECT_EQ(entry_mean(vec3(0), vec3(0), 0, 10, normalise, here), here);
}

/// Where hidden places are added, the mean stands for its share of the profile alone.
TEST(EntryMean, IsScaledByWhatIsSeen) {
  const vec3 weights(4, 2, 20);  // 2 is less than the hits, 20 more than all points
  EXPECT_EQ(entry_seen_share(weights, 3, 10, entry_normalise_none), vec3(1));
  EXPECT_EQ(entry_seen_share(weights, 3, 10, entry_normalise_count), vec3(0.3f));
  EXPECT_EQ(entry_seen_share(weights, 3, 10, entry_normalise_weights), vec3(0.4f, 0.3f, 1));
  for (int normalise = 0; normalise < 3; ++normalise)
    EXPECT_EQ(entry_seen_share(vec3(0), 0, 0, normalise), vec3(1)) << "all points beside the picture";
}

/// Where the points in the picture met nothing of the body, the hidden places alone give light: the pixel's
/// own, which the mean then is, would be added to what they already hold.
TEST(EntryMean, IsNotAddedToHiddenPlacesWhereNothingIsMet) {
  const vec3 nothing(0), here(7);
  for (const int normalise : {entry_normalise_none, entry_normalise_count, entry_normalise_weights})
    EXPECT_EQ(
        entry_mean(nothing, nothing, 0, 10, normalise, here) * entry_seen_share(nothing, 0, 10, normalise),
        nothing)
        << normalise;
}

}  // namespace
}  // namespace limn::glsl
