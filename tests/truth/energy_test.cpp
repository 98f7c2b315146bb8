// White furnaces and the integrating sphere: what surfaces do with all light at once.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

/// Directional albedo of a GGX surface (Walter et al. 2007) with height-correlated Smith shadowing (Heitz
/// 2014) that reflects all that meets its facets: the mean of G2 (v.h) / ((n.v) (n.h)) over half vectors of
/// the density D (n.h), by the midpoint rule.
double ggxAlbedo(double cosine, double roughness) {
  constexpr int n = 64;
  const double a2 = std::pow(roughness, 4), sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1); };
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (i + 0.5) / n, phi = 2 * M_PI * (j + 0.5) / n;
      const double up = std::sqrt((1 - u) / (1 + (a2 - 1) * u)), across = std::sqrt(1 - up * up);
      const double meets = sine * across * std::cos(phi) + cosine * up;
      const double leaves = 2 * meets * up - cosine;
      if (meets <= 0 || leaves <= 0) continue;
      sum += meets / (cosine * up) / (1 + lambda(cosine) + lambda(leaves));
    }
  return sum / (n * n);
}

class EnergyTruth : public TruthTest {
 protected:
  /// A ball in light of radiance 1 from everywhere.
  static scene::Scene furnace(const scene::Material& material) {
    scene::Scene scene;
    test::show(scene, test::spherePrimitive(1, test::addMaterial(scene, material)));
    scene.environment.width = 16;
    scene.environment.height = 8;
    scene.environment.texels.assign(128, vec3(1));
    return scene;
  }
  static double largest(const Image& image) {
    double most = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (image.at(x, y, image.channel("coverage")) > 0) most = std::max(most, double(image.at(x, y, 0)));
    return most;
  }
  static Question question(int spp) {
    return {.camera = scene::lookAt({1, 1, 5}, {0, 0, 0}, 0.4f), .spp = spp, .size = {40, 40}};
  }
};

TEST_F(EnergyTruth, AWhiteMatteBallVanishesInAWhiteFurnace) {
  expectBoth(furnace(test::lambertian(1)), question(64), [](const dvec3&, const dvec3&) { return 1.0; },
             {.mean = 2e-3, .average = 0.02});
}

/// Never more than comes in, and less by what a single scattering loses.
TEST_F(EnergyTruth, AWhiteMetalReturnsWhatASingleScatteringLeaves) {
  for (const float roughness : {0.2f, 0.5f, 0.8f, 1.f}) {
    SCOPED_TRACE(roughness);
    scene::Material metal;
    metal.roughness = roughness;
    const scene::Scene scene = furnace(metal);
    const auto expected = [&](const dvec3& p, const dvec3& view) {
      const double cosine = -glm::dot(glm::normalize(p), view);
      const double value = cosine > 0.15 ? ggxAlbedo(cosine, double(roughness)) : nothing;
      EXPECT_FALSE(value > 1 + 1e-3);
      return value;
    };
    const Question q = question(64);
    const Image picture = pictureOf(scene, q);
    expectWithin(deviation(scene, q, picture, expected), {.average = 0.02});
    EXPECT_LT(largest(picture), 1.005);
    expectReference(scene, q, expected, {.average = 0.05});
  }
}

/// In a sphere that is lit from its centre every place is lit alike, by every bounce: direct light rho/pi
/// I/R^2, after k more reflections rho^k of it. Of 40 bounces 1e-6 is missing.
TEST_F(EnergyTruth, AnIntegratingSphereAddsTheGeometricSeries) {
  constexpr double albedo = 0.7, intensity = 4;
  scene::Scene scene;
  scene::Material wall = test::lambertian(float(albedo));
  wall.doubleSided = true;
  test::show(scene, test::spherePrimitive(2, test::addMaterial(scene, wall)));
  test::shine(scene, test::lamp(glsl::light_point, float(intensity)), vec3(0));
  const double direct = albedo / M_PI * intensity / 4;
  Question q{.camera = scene::lookAt({0.3f, 0.2f, 0.1f}, {1, 0.5f, 2}, 1.2f), .size = {24, 24}};
  const auto constant = [](double value) { return [value](const dvec3&, const dvec3&) { return value; }; };
  expectBoth(scene, q, constant(direct), {.mean = 3e-3, .average = 3e-3});
  q.term = Term::indirect;
  q.spp = 64;
  for (const int bounces : {1, 3, 40}) {
    SCOPED_TRACE(bounces);
    q.bounces = bounces;
    const double series = albedo * (1 - std::pow(albedo, bounces)) / (1 - albedo);
    expectReference(scene, q, constant(direct * series), {.average = 0.1});
  }
}

}  // namespace
}  // namespace limn
