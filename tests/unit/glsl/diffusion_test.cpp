// Profiles of light below a surface (glsl/diffusion) against closed forms, quadratures, published figures and
// the reflectance of a half space.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
#include "tests/support/closed_forms.h"
#include "tests/support/half_space_albedo.h"

namespace limn::glsl {
namespace {

constexpr float kAbsorptions[] = {0, 1e-6f, 1e-3f, 0.05f, 0.5f, 0.9f, 1};
constexpr float kIndices[] = {1, 1.3f, 1.5f, 3};

/// Integral of f from 0 to 1 by the midpoint rule.
double integral(const std::function<double(double)>& f, int steps = 20000) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f((i + 0.5) / steps);
  return sum / steps;
}

/// Integral of a radial profile over the disc of radius `reach`, in the logarithm of the radius.
double overDisc(const std::function<double(double)>& profile, double reach, double inner = 1e-6) {
  const double span = std::log(reach / inner);
  return span * integral([&](double x) {
           const double r = inner * std::exp(x * span);
           return 2 * M_PI * r * r * profile(r);
         });
}

/// The radius of glsl::diffusion_source_radius in double precision, by bisection.
double sourceRadius(double z, double decay, double xi) {
  const double a = decay * z, goal = -std::log1p(-xi);
  double low = 0, high = goal;
  for (int i = 0; i < 200; ++i) {
    const double y = 0.5 * (low + high);
    (a * std::expm1(y) + y < goal ? low : high) = y;
  }
  const double rise = std::expm1(0.5 * (low + high));
  return z * std::sqrt(rise * (rise + 2));
}

struct Substance {
  const char* name;
  dvec3 scattering, absorption;  // sigma_s' and sigma_a, 1/mm
  float ior;
  dvec3 reflectance;
};

// Jensen, Marschner, Levoy and Hanrahan 2001, figure 5.
const Substance kSubstances[] = {
    {"skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1.3f, {0.44, 0.22, 0.13}},
    {"skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}, 1.3f, {0.63, 0.44, 0.34}},
    {"marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}, 1.5f, {0.83, 0.79, 0.75}},
    {"whole milk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}, 1.3f, {0.91, 0.88, 0.76}},
    {"ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}, 1.3f, {0.16, 0.01, 0.00}}};

TEST(ExpLog, KeepTheirDigitsAroundZero) {
  for (double x = 1e-12; x < 60; x *= 1.01) {
    for (const float signedX : {float(x), float(-x)}) {
      EXPECT_NEAR(exp_minus_one(signedX) / std::expm1(double(signedX)), 1, 4e-7) << signedX;
      if (signedX > -1) {
        EXPECT_NEAR(log_one_plus(signedX) / std::log1p(double(signedX)), 1, 3e-7) << signedX;
      }
    }
  }
  EXPECT_EQ(exp_minus_one(0), 0);
  EXPECT_EQ(log_one_plus(0), 0);
}

TEST(DiffusionBoundary, MeetsQuadraturesFromBothSides) {
  for (const double eta : {1., 1.001, 1.1, 1.3, 1.5, 2., 3.}) {
    const DiffusionBoundary b = diffusion_boundary(float(eta));
    const double outside = integral([&](double c) { return 2 * c * test::fresnel(c, 1, eta); });
    const double inside = integral([&](double c) { return 2 * c * test::fresnel(c, eta, 1); }, 1000000);
    EXPECT_NEAR(b.entering, 1 - outside, 1e-5) << eta;
    EXPECT_NEAR(1 / b.trapping, 1 - inside, 1e-5) << eta;
    EXPECT_NEAR(diffusion_mismatch(b) / ((1 + inside) / (1 - inside)), 1, 3e-5) << eta;
  }
}

TEST(DiffusionBoundary, TheUsualPolynomialIsOffAsStated) {
  const auto mismatch = [](double eta) {
    const double fdr = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
    return (1 + fdr) / (1 - fdr);
  };
  EXPECT_NEAR(mismatch(1) / diffusion_mismatch(diffusion_boundary(1)), 1.0032, 1e-4);
  EXPECT_NEAR(mismatch(3) / diffusion_mismatch(diffusion_boundary(3)), 1.26, 0.01);
}

TEST(DiffusionBoundary, AFurnaceOfAWhiteBodyIsWhite) {
  for (const float eta : kIndices) {
    const DiffusionBoundary b = diffusion_boundary(eta);
    const DiffusionDipole dipole = diffusion_dipole(0, b);
    EXPECT_FLOAT_EQ(dipole.reflectance, 1);
    EXPECT_EQ(walk_albedo(walk_reflectance(b), 0), 1);
    // Radiance 1 from everywhere: E = pi (1 - F_de), and L = F_t C E / (pi (1 - F_de)) + F_r.
    for (const float cosine : {1.f, 0.5f, 0.01f}) {
      const float left = diffusion_exit(b, cosine) * dipole.reflectance * pi * b.entering;
      EXPECT_NEAR(left + fresnel(cosine, eta, 0), 1, 1e-6) << eta;
    }
    EXPECT_NEAR(integral([&](double c) { return 2 * M_PI * c * diffusion_exit(b, float(c)); }), 1, 2e-5)
        << eta;
  }
}

TEST(DiffusionDipole, IsThePublishedFormula) {
  for (const Substance& s : kSubstances) {
    const DiffusionBoundary b = diffusion_boundary(s.ior);
    for (int c = 0; c < 3; ++c) {
      const double whole = s.scattering[c] + s.absorption[c], albedo = s.scattering[c] / whole;
      const double sigma = std::sqrt(3 * s.absorption[c] * whole), zr = 1 / whole;
      const double zv = zr * (1 + 4. / 3 * diffusion_mismatch(b));
      const DiffusionDipole dipole = diffusion_dipole(float(s.absorption[c] / whole), b);
      for (const double r : {0., 0.01, 0.3, 2., 10.}) {
        double profile = 0;
        for (const double z : {zr, zv}) {
          const double away = std::sqrt(r * r + z * z);
          profile +=
              albedo / (4 * M_PI) * z * (1 + sigma * away) * std::exp(-sigma * away) / std::pow(away, 3);
        }
        EXPECT_NEAR(whole * whole * diffusion_dipole_profile(dipole, float(whole * r)) / profile, 1, 1e-5)
            << s.name << " " << r;
      }
    }
  }
}

TEST(DiffusionDipole, ReflectsWhatWasPublished) {
  for (const Substance& s : kSubstances) {
    for (int c = 0; c < 3; ++c) {
      const double absorption = s.absorption[c] / (s.scattering[c] + s.absorption[c]);
      EXPECT_NEAR(diffusion_dipole(float(absorption), diffusion_boundary(s.ior)).reflectance,
                  s.reflectance[c], 0.01)
          << s.name << " " << c;
    }
  }
}

TEST(DiffusionDipole, IntegratesToItsReflectance) {
  for (const float eta : kIndices) {
    for (const float absorption : kAbsorptions) {
      const DiffusionDipole d = diffusion_dipole(absorption, diffusion_boundary(eta));
      // Beyond the reach, at most z / reach of the light leaves, that of a = 0.
      const double reach = 1e7;
      const auto density = [&](double r) { return diffusion_dipole_density(d, float(r)); };
      EXPECT_NEAR(overDisc(density, reach), 1, 1e-5) << eta << " " << absorption;
      EXPECT_NEAR(overDisc([&](double r) { return diffusion_dipole_profile(d, float(r)); }, reach),
                  d.reflectance, 1e-5);
      for (const float r : {0.01f, 1.f, 30.f})
        EXPECT_NEAR(diffusion_dipole_share(d, r), overDisc(density, r), 1e-5) << eta << " " << absorption;
    }
  }
}

TEST(DiffusionDipole, RadiiAreTheRootWithin14e7) {
  double worst = 0;
  for (const float a : {0.f, 1e-6f, 1e-3f, 0.01f, 0.1f, 0.5f, 1.f, 3.f, 10.f, 20.f}) {
    for (double x = 1e-7; x < 1; x *= 1.02) {
      for (const float xi : {float(x), float(1 - x)})
        worst = std::max(worst, std::abs(diffusion_source_radius(1, a, xi) / sourceRadius(1, a, xi) - 1));
    }
  }
  EXPECT_LE(worst, 1.4e-6);
  EXPECT_EQ(diffusion_source_radius(1, 0, 0), 0);
  EXPECT_EQ(diffusion_source_radius(1, 20, 0), 0);
}

TEST(DiffusionDipole, RadiiHaveTheDensity) {
  for (const float eta : kIndices) {
    for (const float absorption : kAbsorptions) {
      const DiffusionDipole d = diffusion_dipole(absorption, diffusion_boundary(eta));
      constexpr int kCount = 4096;
      int within[3] = {};
      const float bounds[3] = {0.3f, 2, 20};
      for (int i = 0; i < kCount; ++i) {
        const float r = diffusion_dipole_radius(d, (float(i) + 0.5f) / kCount);
        ASSERT_TRUE(r >= 0 && std::isfinite(r));
        for (int k = 0; k < 3; ++k) within[k] += r <= bounds[k] ? 1 : 0;
      }
      // Two sources, each with one sample at an end of its interval that may fall to either side.
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(double(within[k]) / kCount, diffusion_dipole_share(d, bounds[k]), 2. / kCount)
            << eta << " " << absorption;
    }
  }
}

TEST(DiffusionDipole, ScalesWithoutLosingItself) {
  // Radii of metres in bodies of sigma_t' 1e-6 to 1e6 per metre, and all that may come between.
  for (const float eta : kIndices) {
    for (const float absorption : kAbsorptions) {
      const DiffusionDipole d = diffusion_dipole(absorption, diffusion_boundary(eta));
      float before = diffusion_dipole_density(d, 0);
      EXPECT_TRUE(std::isfinite(before) && before > 0);
      for (float r = 1e-12f; r < 1e18f; r *= 10) {
        const float now = diffusion_dipole_density(d, r);
        EXPECT_TRUE(now >= 0 && now <= before * 1.000001f) << r;
        before = now;
      }
    }
    EXPECT_EQ(diffusion_dipole_profile(diffusion_dipole(1, diffusion_boundary(eta)), 1), 0);
  }
}

TEST(NormalisedDiffusion, InvertsTheReflectance) {
  for (const float eta : kIndices) {
    const WalkReflectance w = walk_reflectance(diffusion_boundary(eta));
    for (const float absorption : kAbsorptions) {
      const float albedo = walk_albedo(w, absorption);
      // Near white, albedos of 24 bits have absorption / (1 - albedo) times their spacing.
      EXPECT_NEAR(walk_absorption(w, albedo), absorption, 2e-6 + 1e-4 * absorption) << eta;
    }
    EXPECT_EQ(walk_absorption(w, 1), 0);
    EXPECT_FLOAT_EQ(walk_absorption(w, 0), 1);
    for (float a = 0; a < 1; a += 0.01f) EXPECT_NEAR(walk_albedo(w, walk_absorption(w, a)), a, 1e-6) << eta;
  }
}

TEST(NormalisedDiffusion, ReflectsAsTheHalfSpace) {
  for (const float eta : {1.f, 1.01f, 1.05f, 1.15f, 1.3f, 1.33f, 1.4f, 1.5f, 1.7f, 2.f, 2.5f, 3.f}) {
    const WalkReflectance w = walk_reflectance(diffusion_boundary(eta));
    for (double s = 0; s <= 1; s += 0.05)
      EXPECT_NEAR(walk_albedo(w, float(s * s)), test::halfSpaceAlbedo(1 - s * s, eta), 6e-4)
          << eta << " " << s;
  }
}

TEST(NormalisedDiffusion, TheDipoleMissesTheHalfSpaceAsMeasured) {
  const auto ratio = [](double albedo, double eta) {
    const DiffusionDipole d = diffusion_dipole(float(1 - albedo), diffusion_boundary(float(eta)));
    return d.reflectance / test::halfSpaceAlbedo(albedo, eta);
  };
  EXPECT_NEAR(ratio(0.5, 1.3), 1.08, 0.005);
  EXPECT_NEAR(ratio(0.8, 1.3), 1.015, 0.002);
  EXPECT_NEAR(ratio(0.9, 1.3), 0.976, 0.002);
  EXPECT_NEAR(ratio(0.95, 1.3), 0.954, 0.002);
  EXPECT_NEAR(ratio(0.99, 1.3), 0.960, 0.002);
  EXPECT_NEAR(ratio(0.999, 1.3), 0.983, 0.002);
  EXPECT_NEAR(ratio(0.5, 1.5), 1.51, 0.005);
}

TEST(NormalisedDiffusion, RadiiAreTheClosedInverse) {
  const NormalisedDiffusion n{0.5f, 1};
  for (double x = 1e-7; x < 1; x *= 1.02) {
    for (const float xi : {float(x), float(1 - x)}) {
      // The closed form loses the digits of small radii in double precision, too: at 1e-7 it has nine left.
      const double t = 2 * std::sinh(std::asinh(2 * (1 - double(xi))) / 3);
      EXPECT_NEAR(normalised_diffusion_radius(n, xi) / (-3 * std::log(t)), 1, 2e-6) << xi;
    }
  }
  EXPECT_EQ(normalised_diffusion_radius(n, 0), 0);
  EXPECT_TRUE(std::isfinite(normalised_diffusion_radius(n, 1)));
}

TEST(NormalisedDiffusion, IntegratesToItsReflectance) {
  for (const float eta : kIndices) {
    const WalkReflectance w = walk_reflectance(diffusion_boundary(eta));
    for (const float absorption : kAbsorptions) {
      const NormalisedDiffusion n = normalised_diffusion(absorption, w);
      const auto profile = [&](double r) { return normalised_diffusion_profile(n, float(r)); };
      // Within the inner radius lies the share 2 r / 3 d.
      EXPECT_NEAR(overDisc(profile, 100 * n.width, 1e-6 * n.width), n.reflectance, 1e-5) << eta;
      for (const float xi : {0.1f, 0.5f, 0.9f}) {
        const float r = normalised_diffusion_radius(n, xi);
        EXPECT_NEAR(normalised_diffusion_share(n, r), xi, 1e-6);
        EXPECT_NEAR(overDisc(profile, r, 1e-6 * n.width), xi * n.reflectance, 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace limn::glsl
