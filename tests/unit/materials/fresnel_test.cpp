// Laws of the reflectance of smooth interfaces (glsl/materials/fresnel.glsl).
#include "glsl/materials/fresnel.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "glsl/scene/media.glsl"

namespace limn::glsl {
namespace {

/// Fresnel's equations in complex double precision.
double exactFresnel(double cosine, double eta, double k) {
  const std::complex<double> n(eta, -k);
  const std::complex<double> inside = std::sqrt(n * n - (1 - cosine * cosine));
  const auto s = (cosine - inside) / (cosine + inside);
  const auto p = (n * n * cosine - inside) / (n * n * cosine + inside);
  return 0.5 * (std::norm(s) + std::norm(p));
}

struct Interface {
  float eta, k;
};
const std::vector<Interface> kInterfaces = {{1.0001f, 0},  {1.01f, 0},   {1.33f, 0},    {1.5f, 0},
                                            {5, 0},        {200, 0},     {1000, 0},     {0.7f, 0},
                                            {1.5f, 1e-3f}, {1, 0.1f},    {0.05f, 4.2f}, {0.2f, 3.1f},
                                            {1.1f, 6.8f},  {3.1f, 3.3f}, {200, 100},    {1e-3f, 1000}};
const std::vector<float> kCosines = {1e-4f, 1e-3f, 0.01f, 0.05f, 0.1f,   0.2f,
                                     0.35f, 0.5f,  0.7f,  0.9f,  0.999f, 1};

TEST(Fresnel, IsThatOfComplexIndices) {
  for (const Interface& i : kInterfaces)
    for (const float cosine : kCosines) {
      const double exact = exactFresnel(cosine, i.eta, i.k);
      EXPECT_NEAR(fresnel(cosine, i.eta, i.k), exact, 2e-6) << i.eta << ' ' << i.k << ' ' << cosine;
    }
}

/// Where the index is nearly 1 the reflectance is 2.5e-9 head-on, of which the textbook form has no digit
/// left.
TEST(Fresnel, KeepsItsDigitsNextToOne) {
  for (const float eta : {1.0001f, 1.001f, 1.01f})
    for (const float cosine : kCosines) {
      const double exact = exactFresnel(cosine, eta, 0);
      if (std::abs(cosine - std::cos(std::atan(eta))) < 0.02f) continue;  // Brewster's angle, where Rp is 0
      EXPECT_NEAR(double(fresnel(cosine, eta, 0)) / exact, 1, 2e-3) << eta << ' ' << cosine;
    }
}

TEST(Fresnel, NoInterfaceReflectsNothing) {
  for (float cosine = 0; cosine <= 1; cosine += 1.f / 1024) EXPECT_EQ(fresnel(cosine, 1, 0), 0) << cosine;
}

TEST(Fresnel, IsTheTextbooksHeadOnAndAllAtGrazingAngles) {
  for (const Interface& i : kInterfaces) {
    const double e = i.eta, k = i.k;
    EXPECT_NEAR(fresnel(1, i.eta, i.k), ((e - 1) * (e - 1) + k * k) / ((e + 1) * (e + 1) + k * k), 1e-6);
    EXPECT_NEAR(fresnel(0, i.eta, i.k), 1, 1e-6) << e << ' ' << k;
    EXPECT_EQ(fresnel(-0.5f, i.eta, i.k), fresnel(0, i.eta, i.k));
  }
}

TEST(Fresnel, AgreesWithTheOneOfGlass) {
  for (const float eta : {1.33f, 1.5f, 2.42f})
    for (const float cosine : kCosines)
      EXPECT_NEAR(fresnel(cosine, eta, 0), fresnel_reflectance(cosine, 1, eta), 2e-6) << eta << ' ' << cosine;
}

/// Schlick's approximation is off by 0.036 (n = 1.5), 0.26 (n = 5) and 0.12 (aluminium): too much to stand
/// for the models' reflectance.
TEST(Fresnel, SchlicksDeviationIsTheKnownOne) {
  const auto deviation = [](float eta, float k) {
    double worst = 0;
    for (int i = 0; i <= 4096; ++i) {
      const double c = i / 4096.0, f0 = fresnel(1, eta, k);
      worst =
          std::max(worst, std::abs(f0 + (1 - f0) * std::pow(1 - c, 5) - double(fresnel(float(c), eta, k))));
    }
    return worst;
  };
  EXPECT_NEAR(deviation(1.5f, 0), 0.036, 0.001);
  EXPECT_NEAR(deviation(5, 0), 0.26, 0.005);
  EXPECT_NEAR(deviation(1.37f, 7.62f), 0.12, 0.005);
}

/// Values and their mean, against double precision.
TEST(Fresnel, SchlicksIsExactHeadOnAndAllAtGrazingAngles) {
  for (const Interface& i : kInterfaces) {
    const double headOn = exactFresnel(1, i.eta, i.k);
    EXPECT_EQ(schlick_fresnel(0, i.eta, i.k), 1) << i.eta << ' ' << i.k;
    EXPECT_EQ(schlick_fresnel(-0.5f, i.eta, i.k), 1) << i.eta << ' ' << i.k;
    double sum = 0;
    constexpr int n = 20000;
    for (int j = 0; j < n; ++j) {
      const double c = (j + 0.5) / n, expected = headOn + (1 - headOn) * std::pow(1 - c, 5);
      sum += expected * 2 * c / n;
      if (j % 1000 == 0) {
        EXPECT_NEAR(schlick_fresnel(static_cast<float>(c), i.eta, i.k), expected, 2e-6)
            << i.eta << ' ' << i.k << ' ' << c;
      }
    }
    EXPECT_NEAR(schlick_mean_reflectance(i.eta, i.k), sum, 2e-6) << i.eta << ' ' << i.k;
  }
}

/// int F cos / pi by quadrature over cos = t^2, which resolves the rise at grazing angles.
double meanByQuadrature(double eta, double k) {
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n;
    sum += exactFresnel(t * t, eta, k) * 4 * t * t * t / n;
  }
  return sum;
}

TEST(Fresnel, MeanOfDielectricsIsTheQuadratures) {
  for (const float eta : {1.f, 1.0001f, 1.005f, 1.019f, 1.021f, 1.039f, 1.041f, 1.05f, 1.1f, 1.33f, 1.5f,
                          2.4f, 5.f, 200.f, 1000.f})
    EXPECT_NEAR(dielectric_mean_reflectance(eta), meanByQuadrature(eta, 0), 1e-5) << eta;
  EXPECT_NEAR(1 - (1 - dielectric_mean_reflectance(1.5f)) / 2.25f, 0.596, 0.0005);  // from inside
}

TEST(Fresnel, MeanOfAnyInterface) {
  for (const Interface& i : kInterfaces)
    EXPECT_NEAR(mean_reflectance(vec3(i.eta), vec3(i.k)).y, meanByQuadrature(i.eta, i.k), 0.012)
        << i.eta << ' ' << i.k;
}

/// Total reflection cuts F off there, which a rule with few nodes misses by up to 0.18.
TEST(Fresnel, MeanOfThinnerMediaIsTheQuadratures) {
  for (const float eta : {0.2f, 0.5f, 0.7f, 0.9f, 0.99f})
    EXPECT_NEAR(mean_reflectance(eta, 0), meanByQuadrature(eta, 0), 2e-5) << eta;
}

}  // namespace
}  // namespace limn::glsl
