// Laws of the BRDF and of its samplers.
#include "glsl/surface/brdf.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "glsl/materials/microfacet.glsl"

namespace limn::glsl {
namespace {

const std::vector<float> kRoughness = {0.f, 0.05f, 0.1f, 0.2f, 0.4f, 0.7f, 1.f};
const std::vector<float> kCosines = {1e-3f, 0.01f, 0.05f, 0.2f, 0.5f, 0.8f, 1.f};

vec3 direction(float cosine, float azimuth) {
  const float sine = std::sqrt(std::max(0.f, 1 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

vec3 randomUpward(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  return direction(unit(random), 6.2831853f * unit(random));
}

SurfaceBrdf metal(float roughness, float reflectance = 1) {
  return surface_brdf(vec3(reflectance), 1, roughness, 1, vec3(1), 1.5f);
}
SurfaceBrdf plastic(float albedo, float roughness) {
  return surface_brdf(vec3(albedo), 0, roughness, 1, vec3(1), 1.5f);
}
SurfaceBrdf lambert(vec3 albedo) {
  return surface_brdf(albedo, 0, 1, 0, vec3(1), 1.5f);
}

/// Directional albedo by importance sampling on a stratified grid.
double albedo(const SurfaceBrdf& s, const vec3& v, int side = 256) {
  const vec3 n(0, 0, 1);
  const float probability = brdf_specular_probability(s, v.z);
  double sum = 0;
  for (int lobe = 0; lobe < 2; ++lobe) {
    const float share = lobe == 0 ? probability : 1 - probability;
    if (share == 0) continue;
    double part = 0;
    for (int i = 0; i < side * side; ++i) {
      const float x = (i % side + 0.5f) / side, y = (i / side + 0.5f) / side;
      const vec3 l = brdf_sample(s, n, v, vec3(x, y, lobe == 0 ? 0.f : 0.9999999f));
      const float pdf = brdf_pdf(s, n, v, l);
      if (pdf > 0) part += brdf(s, n, v, l).y * l.z / pdf;
    }
    sum += share * part / (side * side);
  }
  return sum;
}

TEST(Brdf, IsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  const vec3 n(0, 0, 1);
  for (int i = 0; i < 20000; ++i) {
    const SurfaceBrdf s = surface_brdf({unit(random), unit(random), unit(random)}, unit(random), unit(random),
                                       unit(random), vec3(1), 1 + unit(random));
    const vec3 v = normalize(randomUpward(random) + vec3(0, 0, 2e-4f));
    const vec3 l = normalize(randomUpward(random) + vec3(0, 0, 2e-4f));
    const vec3 there = brdf(s, n, v, l), back = brdf(s, n, l, v);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(there[c], back[c], 2e-5f * there[c]);
  }
}

TEST(Brdf, LambertIsAlbedoOverPiExactly) {
  std::mt19937 random(2);
  const SurfaceBrdf s = lambert({0.8f, 0.5f, 1.f});
  for (int i = 0; i < 1000; ++i) {
    const vec3 f = brdf(s, vec3(0, 0, 1), randomUpward(random), randomUpward(random) + vec3(0, 0, 1e-6f));
    ASSERT_EQ(f, vec3(0.8f, 0.5f, 1.f) * inverse_pi);
  }
  EXPECT_NEAR(albedo(s, direction(0.3f, 1)), 0.5, 1e-5);
}

TEST(Brdf, FurnaceOfTheSpecularPartStaysBelowOne) {
  for (float roughness : kRoughness) {
    for (float cosine : kCosines) {
      const double a = albedo(metal(roughness), direction(cosine, 0.4f));
      EXPECT_LE(a, 1.0001) << roughness << ' ' << cosine;
      if (roughness <= 0.2f && cosine >= 0.5f) {
        EXPECT_GE(a, 0.99) << roughness << ' ' << cosine;
      }
    }
  }
}

// Appendix B mixes diffuse and specular by the Fresnel term at the half vector, which does not balance at
// grazing angles: a white, smooth dielectric returns more than it gets there. The model is kept as it is
// specified; this test holds its excess to the figure stated in the documentation.
TEST(Brdf, FurnaceOfTheWholeModelHasItsKnownExcess) {
  double worst = 0;
  for (float roughness : kRoughness) {
    for (float cosine : kCosines) {
      const double a = albedo(plastic(1, roughness), direction(cosine, 0.4f));
      if (cosine >= 0.8f) {
        EXPECT_LE(a, 1.01) << roughness << ' ' << cosine;
      }
      worst = std::max(worst, a);
    }
  }
  RecordProperty("worst_albedo", std::to_string(worst));
  EXPECT_LT(worst, 1.95);
}

TEST(Brdf, DistributionOfNormalsIsNormalised) {
  for (float roughness : kRoughness) {
    const double alpha = std::max(roughness * roughness, brdf_min_alpha);
    const auto sine2 = [&](double s) {  // (tan / alpha)^2 = s / (1 - s)
      const double t = alpha * alpha * s / (1 - s);
      return t / (1 + t);
    };
    double sum = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double middle = sine2((i + 0.5) / steps);
      const double high = i + 1 == steps ? 1 : sine2((i + 1.0) / steps);
      sum += ggx_distribution(float(std::sqrt(1 - middle)), float(middle), float(alpha)) * M_PI *
             (high - sine2(double(i) / steps));
    }
    EXPECT_NEAR(sum, 1, 2e-3) << roughness;
  }
}

/// |d result / du1 x d result / du2| by central differences.
template <class Map>
float stretch(const Map& map, vec2 u, float step) {
  const vec3 du = map(u + vec2(step, 0)) - map(u - vec2(step, 0));
  const vec3 dv = map(u + vec2(0, step)) - map(u - vec2(0, step));
  return length(cross(du, dv)) / (4 * step * step);
}

/// Density of a visible normal (Heitz 2018, equation 3): of the direction that v is mirrored to by it, times
/// the Jacobian of mirroring.
float normalDensity(const vec3& v, const vec3& h, float alpha) {
  return 4 * std::max(dot(v, h), 0.f) * visible_normal_pdf(v, h, vec2(alpha));
}

// A sampler's density is the inverse of how much it stretches area.
TEST(Brdf, SamplersHaveTheDensitiesTheyState) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.02f, 0.98f);
  for (int i = 0; i < 4000; ++i) {
    const vec2 u(unit(random), unit(random));
    if (std::abs(std::abs(u.x - 0.5f) - std::abs(u.y - 0.5f)) > 0.02f) {  // not across the map's diagonals
      const auto cosine = [](vec2 x) { return sample_cosine(x); };
      EXPECT_NEAR(stretch(cosine, u, 2e-3f) * cosine_pdf(sample_cosine(u).z), 1, 0.02);
    }
    const float alpha = 0.05f + 0.95f * unit(random);
    const vec3 v = direction(unit(random), 6 * unit(random));
    const auto visible = [&](vec2 x) { return sample_visible_normal(v, vec2(alpha), x); };
    const vec3 h = visible(u);
    const float pdf = normalDensity(v, h, alpha);
    EXPECT_NEAR(stretch(visible, u, 1e-3f) * pdf, 1, 0.03) << alpha << ' ' << v.z << ' ' << u.x << ' ' << u.y;
  }
}

TEST(Brdf, VisibleNormalDensityIsNormalised) {
  for (float alpha : {0.05f, 0.2f, 0.5f, 1.f}) {
    for (float cosine : {0.02f, 0.3f, 0.9f, 1.f}) {
      const vec3 v = direction(cosine, 0);
      double sum = 0;
      const int rings = 1000, sectors = 400;
      double low = 0;
      for (int i = 0; i < rings; ++i) {
        const double s = (i + 0.5) / rings, t = alpha * alpha * s / (1 - s);
        const double e = (i + 1.0) / rings, te = alpha * alpha * e / (1 - e);
        const double high = i + 1 == rings ? 1 : 1 - 1 / std::sqrt(1 + te);  // 1 - cosine
        const float z = float(1 / std::sqrt(1 + t));
        for (int j = 0; j < sectors; ++j) {
          const vec3 h = direction(z, float(2 * M_PI * (j + 0.5) / sectors));
          sum += normalDensity(v, h, alpha) * (high - low) * 2 * M_PI / sectors;
        }
        low = high;
      }
      EXPECT_NEAR(sum, 1, 5e-3) << alpha << ' ' << cosine;
    }
  }
}

// The density of the combined sampler integrates to the share of samples above the horizon.
TEST(Brdf, CombinedSamplerMatchesItsDensity) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  const vec3 n = normalize(vec3(0.3f, -0.5f, 0.4f));
  const SurfaceBrdf s = surface_brdf({0.7f, 0.2f, 0.1f}, 0.3f, 0.5f, 1, vec3(1), 1.5f);
  const vec3 v = from_local(frame_around(n), direction(0.35f, 1));
  const int count = 400000;
  double above = 0, integral = 0, moment = 0, expected = 0;
  for (int i = 0; i < count; ++i) {
    const vec3 l = brdf_sample(s, n, v, {unit(random), unit(random), unit(random)});
    ASSERT_NEAR(length(l), 1, 1e-5);
    if (dot(n, l) > 0) {
      ++above;
      moment += dot(v, l);
    }
    const vec3 w = from_local(frame_around(n), randomUpward(random));
    integral += 2 * M_PI * brdf_pdf(s, n, v, w);
    expected += 2 * M_PI * brdf_pdf(s, n, v, w) * dot(v, w);
  }
  EXPECT_NEAR(above / count, integral / count, 0.01);
  EXPECT_NEAR(moment / count, expected / count, 0.01);
}

TEST(Brdf, IsFiniteInEveryCorner) {
  const vec3 n(0, 0, 1);
  std::vector<vec3> directions;
  for (float cosine : {-1.f, -0.5f, -1e-7f, 0.f, 1e-20f, 1e-7f, 1e-4f, 0.5f, 1.f}) {
    for (float azimuth : {0.f, 3.14159265f, 1.f}) directions.push_back(direction(cosine, azimuth));
  }
  for (float roughness : {0.f, 1e-4f, 0.03f, 1.f}) {
    for (float metallic : {0.f, 1.f}) {
      for (float specular : {0.f, 1.f}) {
        const SurfaceBrdf s = surface_brdf(vec3(1), metallic, roughness, specular, vec3(1), 1.5f);
        for (const vec3& v : directions) {
          for (const vec3& l : directions) {
            const vec3 f = brdf(s, n, v, l);
            const float pdf = brdf_pdf(s, n, v, l);
            ASSERT_TRUE(std::isfinite(f.x) && f.x >= 0) << roughness << ' ' << v.z << ' ' << l.z;
            ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0);
            if (l.z <= 0) {
              ASSERT_EQ(f, vec3(0));
            }
          }
          for (float x : {0.f, 0.5f, 0.99999994f}) {
            for (float y : {0.f, 0.5f, 0.99999994f}) {
              for (float z : {0.f, 0.99999994f}) {
                const vec3 l = brdf_sample(s, n, v, {x, y, z});
                ASSERT_TRUE(std::isfinite(l.x) && std::isfinite(l.y) && std::isfinite(l.z));
              }
            }
          }
        }
      }
    }
  }
}

// At alpha = 1 D is constant and the lobe is 1 / (2 pi (n.l + n.v)): single scattering in closed form.
TEST(Brdf, RoughestAlbedoIsTheClosedForm) {
  for (float cosine : kCosines) {
    EXPECT_NEAR(albedo(metal(1), direction(cosine, 0.4f)), 1 - cosine * std::log((1 + cosine) / cosine),
                1e-3);
  }
}

TEST(Brdf, SmoothSurfaceReflectsItsFresnelTerm) {
  EXPECT_NEAR(albedo(metal(0.1f, 0.6f), vec3(0, 0, 1)), 0.6, 2e-3);
  EXPECT_NEAR(albedo(plastic(0, 0.1f), vec3(0, 0, 1)), 0.04, 2e-4);
}

}  // namespace
}  // namespace limn::glsl
