// Light below surfaces along rows and columns: its kernels against closed forms and quadratures, and places
// of taps against projected points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
#include "techniques/separable_subsurface/line_footprint.glsl"
#include "techniques/separable_subsurface/line_kernel.h"

namespace limn::separable_subsurface {
namespace {

using glm::dvec3;
using glm::vec3;

// Of skin1 (Jensen, Marschner, Levoy and Hanrahan 2001, figure 5), per metre.
const vec3 kScattering{740, 880, 1010}, kAbsorption{32, 170, 480};
const vec3 kExtinction = kScattering + kAbsorption;
constexpr float kSkinIndex = 1.3f;

Profile skin(bool normalised) {
  return scene::diffusionProfile(kExtinction, kAbsorption / kExtinction, kSkinIndex, normalised);
}

dvec3 sumOf(const LineKernel& kernel) {
  dvec3 sum(kernel.taps[0].weight);
  for (size_t i = 1; i < kernel.taps.size(); ++i) sum += 2.0 * dvec3(kernel.taps[i].weight);
  return sum;
}

/// Half of the absolute difference between a profile over a plane and the product of its line integrals, both
/// with integral 1.
double misplaced(const ChannelProfile& profile) {
  constexpr int cells = 500;
  std::vector<double> edges{0}, shares{0};
  for (int i = 0; i < cells; ++i) {
    edges.push_back(1e-6 * std::pow(1e5, static_cast<double>(i) / (cells - 1)));
    shares.push_back(lineShare(profile, edges.back()));
  }
  double sum = 0;
  for (size_t i = 0; i < cells; ++i) {
    for (size_t k = 0; k < cells; ++k) {
      const double r = std::hypot(0.5 * (edges[i] + edges[i + 1]), 0.5 * (edges[k] + edges[k + 1]));
      const double density =
          (profile.share(1.002 * r) - profile.share(0.998 * r)) / (0.004 * r) / (2 * M_PI * r);
      const double area = (edges[i + 1] - edges[i]) * (edges[k + 1] - edges[k]);
      const double product = 0.25 * (shares[i + 1] - shares[i]) * (shares[k + 1] - shares[k]);
      sum += 4 * std::abs(density * area - product);
    }
  }
  return 0.5 * sum;
}

TEST(SeparableSubsurface, LinesTakeWhatProfilesHaveInClosedForm) {
  // Without absorption one source's light per area is z / (2 pi s^3), whose integral along a line is
  // z / (pi (x^2 + z^2)); half of the light is that of each source.
  for (const float ior : {1.f, 1.3f, 3.f}) {
    const Profile still = scene::diffusionProfile(vec3(1), vec3(0), ior, false);
    const double height =
        static_cast<double>(glsl::diffusion_dipole(0, glsl::diffusion_boundary(ior)).virtual_height);
    for (const double x : {0.01, 0.1, 0.5, 1., 3., 10., 100.})
      EXPECT_NEAR(lineShare(still[0], x), (std::atan(x) + std::atan(x / height)) / M_PI, 1e-4) << x;
  }
  // Normalised diffusion: integrals of e^(-r/d) / r along a line are 2 K0(x / d).
  const Profile profile = skin(true);
  const glsl::NormalisedDiffusion n = glsl::normalised_diffusion(
      kAbsorption.x / kExtinction.x, glsl::walk_reflectance(glsl::diffusion_boundary(kSkinIndex)));
  const double d = static_cast<double>(n.width / kExtinction.x);
  for (const double x : {0.2, 1., 3., 8.}) {
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = x * (i + 0.5) / steps;
      sum += (std::cyl_bessel_k(0, t) + std::cyl_bessel_k(0, t / 3)) * x / steps;
    }
    EXPECT_NEAR(lineShare(profile[0], x * d), sum / (2 * M_PI), 3e-4) << x;
  }
}

TEST(SeparableSubsurface, ProductsMisplaceAPartOfTheLight) {
  const Profile dipole = skin(false);
  EXPECT_NEAR(misplaced(dipole[0]), 0.142, 0.002);
  EXPECT_NEAR(misplaced(dipole[1]), 0.095, 0.002);
  EXPECT_NEAR(misplaced(dipole[2]), 0.073, 0.002);
  // Widths alone tell normalised profiles apart.
  const Profile normalised = skin(true);
  for (const ChannelProfile& channel : normalised) EXPECT_NEAR(misplaced(channel), 0.228, 0.002);
}

TEST(SeparableSubsurface, TapsHoldTheWholeReflectance) {
  for (const bool normalised : {false, true}) {
    for (const float ior : {1.f, 1.3f, 3.f}) {
      for (const float absorption : {0.f, 1e-6f, 0.05f, 0.5f, 1.f}) {
        const Profile profile =
            scene::diffusionProfile(vec3(10, 1e3, 1e5), vec3(absorption, 0.3f, absorption), ior, normalised);
        for (const int taps : {1, 2, 3, 25, 255}) {
          const LineKernel kernel = lineKernel(profile, taps);
          ASSERT_EQ(kernel.taps.size(), static_cast<size_t>(taps / 2 + 1));
          const dvec3 sum = sumOf(kernel);
          for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(sum[c], 1, 1e-5) << taps << " taps, absorption " << absorption;
            EXPECT_EQ(kernel.reflectance[c], static_cast<float>(profile[static_cast<size_t>(c)].reflectance));
            for (const glsl::LineTap& tap : kernel.taps) EXPECT_GE(tap.weight[c], 0);
          }
          EXPECT_EQ(kernel.taps[0].offset, 0);
          for (size_t i = 1; i < kernel.taps.size(); ++i)
            EXPECT_GT(kernel.taps[i].offset, kernel.taps[i - 1].offset);
        }
      }
    }
  }
}

TEST(SeparableSubsurface, TapsMeetAnEdgeInStepsThatMoreOfThemHalve) {
  for (const bool normalised : {false, true}) {
    const Profile profile = skin(normalised);
    dvec3 before(1);
    for (const int taps : {13, 25, 49, 97}) {
      const LineKernel kernel = lineKernel(profile, taps);
      for (int c = 0; c < 3; ++c) {
        constexpr int places = 500;
        double squares = 0;
        for (int k = 0; k < places; ++k) {  // distances from the edge of a half plane in the dark
          const double x = 0.01 * (k + 0.5) / places;
          const double wanted = 0.5 * (1 - lineShare(profile[static_cast<size_t>(c)], x));
          double lit = 0;
          for (size_t i = 1; i < kernel.taps.size(); ++i)
            if (static_cast<double>(kernel.taps[i].offset) > x)
              lit += static_cast<double>(kernel.taps[i].weight[c]);
          squares += (lit - wanted) * (lit - wanted) / places;
        }
        const double error = std::sqrt(squares);
        EXPECT_LT(error, 0.5 / taps) << taps << " taps, channel " << c;
        EXPECT_LT(error, 0.65 * before[c]) << taps << " taps, channel " << c;
        before[c] = error;
      }
    }
  }
}

TEST(SeparableSubsurface, TapsStayFiniteFarApart) {
  for (const bool normalised : {false, true}) {
    for (const vec3 extinction : {vec3(1e-6f), vec3(1e9f), vec3(1e-6f, 1, 1e9f)}) {
      for (const float absorption : {0.f, 1e-4f, 1.f}) {
        const LineKernel kernel =
            lineKernel(scene::diffusionProfile(extinction, vec3(absorption), 1.5f, normalised), 25);
        EXPECT_NEAR(glm::length(sumOf(kernel) - 1.0), 0, 1e-5);
        EXPECT_TRUE(std::isfinite(kernel.halfRadius));
        for (const glsl::LineTap& tap : kernel.taps) EXPECT_TRUE(std::isfinite(tap.offset));
        // Nothing leaves where nothing is scattered: no place is better than another.
        if (absorption == 1) {
          EXPECT_EQ(kernel.taps.back().offset, 0);
        }
      }
    }
  }
}

TEST(SeparableSubsurface, TapsOfASceneOfAnotherScaleAreScaled) {
  const LineKernel kernel = lineKernel(skin(false), 25);
  const LineKernel larger = lineKernel(
      scene::diffusionProfile(1e-4f * kExtinction, kAbsorption / kExtinction, kSkinIndex, false), 25);
  EXPECT_NEAR(larger.halfRadius / kernel.halfRadius, 1e4, 1);
  for (size_t i = 0; i < kernel.taps.size(); ++i) {
    EXPECT_NEAR(larger.taps[i].offset, 1e4f * kernel.taps[i].offset, 1e-3f * kernel.taps[i].offset * 1e4f);
    EXPECT_NEAR(glm::length(larger.taps[i].weight - kernel.taps[i].weight), 0, 1e-4);
  }
}

TEST(SeparableSubsurface, TapsFallWhereTheirPointsAreSeen) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 step(0.01, 0, 0);  // the camera looks down -Z
    const double column = 40 * uniform(random), depth = 2 + uniform(random);
    const dvec3 ray(step.x * column, 0.4 * uniform(random), -1);
    dvec3 normal(uniform(random), uniform(random), 1.1 + uniform(random));
    normal = glm::normalize(normal);
    if (glm::dot(normal, ray) > -0.05) continue;
    const glsl::LineFootprint f =
        glsl::tangent_footprint(vec3(normal), vec3(ray), vec3(step), static_cast<float>(depth));
    // The line through the point on the plane, in the plane of the row's viewing rays.
    const dvec3 row = glm::cross(ray, step);
    dvec3 along = glm::normalize(glm::cross(row, normal));
    if (along.x + ray.x * along.z < 0) along = -along;  // towards the next pixel
    for (const double offset : {-0.3, -0.01, 0.02, 0.2}) {
      const dvec3 point = depth * ray + offset * along;
      const float nearer = glsl::footprint_depth(f, static_cast<float>(offset));
      EXPECT_NEAR(static_cast<double>(nearer) * depth, -point.z, 1e-5);
      const double seen = point.x / -point.z / step.x;
      EXPECT_NEAR(static_cast<double>(glsl::footprint_shift(f, static_cast<float>(offset), nearer)),
                  seen - column, 2e-4 * (1 + std::abs(seen - column)));
    }
  }
  const glsl::LineFootprint facing = glsl::facing_footprint(vec3(0, 0.01f, 0), 2);
  EXPECT_FLOAT_EQ(glsl::footprint_shift(facing, 0.1f, glsl::footprint_depth(facing, 0.1f)), 5);
}

TEST(SeparableSubsurface, TapsOfSurfacesSeenFromTheirEdgeStayFinite) {
  const vec3 ray(0.3f, -0.2f, -1), step(0.01f, 0, 0);
  for (const vec3 normal : {vec3(1, 1.5f, 0), vec3(0, 1, -0.2f), vec3(1, 0, 0.3f), vec3(-1, 0, 0)}) {
    const glsl::LineFootprint f = glsl::tangent_footprint(glm::normalize(normal), ray, step, 1e-3f);
    EXPECT_TRUE(std::isfinite(f.pixels) && f.pixels >= 0);
    EXPECT_TRUE(std::isfinite(f.receding));
  }
}

}  // namespace
}  // namespace limn::separable_subsurface
