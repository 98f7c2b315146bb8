// Laws of the distributions of normals and of Smith's masking (glsl/materials/microfacet.glsl).
#include "glsl/materials/microfacet.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

/// The integral over normals of d(h) factor(h), by midpoints in the azimuth and in the radius of slopes over
/// alpha.
template <class Distribution, class Factor>
double overNormals(const vec2& alpha, const Distribution& d, const Factor& factor) {
  constexpr int rings = 600, sectors = 192;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double s = (i + 0.5) / rings, r = s / (1 - s);
    for (int j = 0; j < sectors; ++j) {
      const double azimuth = 2 * M_PI * (j + 0.5) / sectors;
      const double x = double(alpha.x) * r * std::cos(azimuth), y = double(alpha.y) * r * std::sin(azimuth);
      const double z = 1 / std::sqrt(1 + x * x + y * y);
      const vec3 h(float(x * z), float(y * z), float(z));
      const double area = double(alpha.x) * double(alpha.y) * z * z * z * r / ((1 - s) * (1 - s));
      sum += double(d(h)) * factor(h) * area * (2 * M_PI / sectors / rings);
    }
  }
  return sum;
}

const auto cosine = [](const vec3& h) { return double(h.z); };

TEST(Microfacet, GaussiansOfTheSlopeAreNormalised) {
  for (const vec2 alpha : {vec2(1e-3f), vec2(0.1f), vec2(1), vec2(0.05f, 0.5f), vec2(1e-3f, 1)})
    EXPECT_NEAR(overNormals(
                    alpha, [&](const vec3& h) { return gaussian_slope_distribution(h, alpha); }, cosine),
                1, 1e-4)
        << alpha.x << ' ' << alpha.y;
}

TEST(Microfacet, DawsonsIntegralIsTheQuadratures) {
  for (const float x : {1e-3f, 0.1f, 0.3f, 0.5f, 0.8f, 1.f}) {
    constexpr int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double t = double(x) * (i + 0.5) / n;
      sum += std::exp(t * t - double(x) * double(x)) * double(x) / n;
    }
    EXPECT_NEAR(double(dawson(x)) / sum, 1, 1e-6) << x;
  }
}

/// The norm by Dawson's integral is exact to 3e-6 up to m = 0.5, and off by 1.8 % at 1.
TEST(Microfacet, GaussianOfTheAngleHasItsKnownNorm) {
  const auto norm = [](float m) {
    constexpr int n = 20000;
    const double end = std::min(0.5 * M_PI, 9.0 * double(m));
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double angle = end * (i + 0.5) / n;
      const vec3 h(float(std::sin(angle)), 0, float(std::cos(angle)));
      sum += double(gaussian_angle_distribution(h, m)) * M_PI * std::sin(2 * angle) * end / n;
    }
    return sum;
  };
  for (const float m : {1e-3f, 0.01f, 0.1f, 0.3f, 0.5f}) EXPECT_NEAR(norm(m), 1, 4e-6) << m;
  EXPECT_NEAR(norm(1), 1.018, 0.001);
}

/// Half vectors of float directions carry D at m = 0.01 within 9e-4 of its value.
TEST(Microfacet, DistributionKeepsItsDigits) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit;
  const double m = double(0.01f);
  for (int i = 0; i < 20000; ++i) {
    const vec3 v = directionAt(0.05 + 0.95 * unit(random), 6.28 * unit(random));
    const vec3 facet = directionAt(std::cos(2.5 * m * unit(random)), 6.28 * unit(random));
    const vec3 l = normalize(2.f * dot(v, facet) * facet - v);
    const dvec3 sum = dvec3(v) + dvec3(l), h = normalize(sum);
    const double z2 = h.z * h.z;
    const double exact = std::exp((1 - 1 / z2) / (m * m)) / (M_PI * m * m * z2 * z2);
    EXPECT_NEAR(double(gaussian_slope_distribution(microfacet_half(v, l), vec2(0.01f))) / exact, 1, 9e-4);
  }
}

TEST(Microfacet, SmithsLambdaIsThatOfTheErrorFunction) {
  for (double a = 1e-4; a < 8; a *= 1.1) {
    const double exact = 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(M_PI));
    EXPECT_NEAR(double(smith_lambda(float(a) * 0.1f, 0.1f)), exact, 5e-7 * (1 + exact)) << a;
  }
  EXPECT_EQ(smith_lambda(1, 0), 0);
}

/// The facets that are visible from v cover the surface as it is seen from there: int D max(v.h, 0) = n.v (1
/// + Lambda), which ties masking to the distribution.
TEST(Microfacet, VisibleFacetsCoverTheSurface) {
  for (const vec2 alpha : {vec2(0.01f), vec2(0.1f), vec2(0.4f), vec2(1), vec2(0.05f, 0.5f), vec2(0.8f, 0.1f)})
    for (const double c : {0.01, 0.1, 0.3, 0.7, 1.0})
      for (const double azimuth : {0.0, 0.7, 1.5}) {
        const vec3 v = directionAt(c, azimuth);
        const double seen = overNormals(
            alpha, [&](const vec3& h) { return gaussian_slope_distribution(h, alpha); },
            [&](const vec3& h) { return std::max(double(dot(v, h)), 0.0); });
        const double lambda = double(smith_lambda(v.z, microfacet_spread(v, alpha)));
        EXPECT_NEAR(double(v.z) * (1 + lambda) / seen, 1, 1e-3) << alpha.x << ' ' << alpha.y << ' ' << c;
      }
}

TEST(Microfacet, MaskingOverTheViewHasItsLimit) {
  const vec3 n(0, 0, 1);
  for (const float m : {1e-3f, 0.01f, 0.1f, 0.5f, 1.f})
    for (const bool product : {false, true}) {
      const double limit = std::sqrt(M_PI) / (2 * double(m));
      for (const float z : {0.f, -0.3f, 1e-20f, 1e-7f, 1e-6f * m})
        EXPECT_NEAR(double(masking_over_view(vec3(1, 0, z), n, vec2(m), product)) / limit, 1, 1e-3)
            << m << ' ' << z;
      EXPECT_NEAR(double(masking_over_view(n, n, vec2(m), product)), 0.25, 0.25 * 0.052);
    }
}

/// What limits the weights of samples: GGX's tail lies above the Gaussians', and its masking is at most
/// sqrt(pi) times as strong.
TEST(Microfacet, SamplesOfVisibleNormalsHaveBoundedWeights) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit;
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const float width = std::pow(10.f, -3 * unit(random));
    const MaterialModel m = microfacets(model_ward, vec2(width, std::min(1.f, 3 * width)));
    const vec3 v = directionAt(std::pow(double(unit(random)), 3), 6.28 * double(unit(random)));
    const vec3 l = model_sample(m, v, vec3(unit(random), unit(random), unit(random)));
    const float pdf = model_pdf(m, v, l);
    if (pdf > 0) worst = std::max(worst, double(model_response(m, v, l).x / pdf));
  }
  EXPECT_LT(worst, 4 / M_E * std::sqrt(M_PI) * 1.01);
  EXPECT_GT(worst, 1.4);
}

}  // namespace
}  // namespace limn::glsl
