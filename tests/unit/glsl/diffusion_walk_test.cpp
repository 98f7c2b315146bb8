// Both profiles of light below a surface against random walks in a half space, across a shadow's edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>
#include <string>
#include <vector>

#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
#include "glsl/materials/fresnel.glsl"

namespace limn::glsl {
namespace {

using glm::dvec3;

/// Light that leaves: how far from where it entered, along one axis and in mean free paths, and its share.
struct Leaving {
  double x, share;
};

double reflected(double cosine, double eta) {
  return static_cast<double>(fresnel(static_cast<float>(cosine), static_cast<float>(eta), 0.f));
}

/// Walks of light that enters evenly from all sides, sorted by x, the largest first; shares are of what
/// enters.
std::vector<Leaving> walks(double scattered, double eta) {
  constexpr int kWalks = 60000;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Leaving> found;
  double entered = 0;
  for (int i = 0; i < kWalks; ++i) {
    const double outside = std::sqrt(unit(random)), turn = 2 * M_PI * unit(random);
    double weight = 1 - reflected(outside, eta);
    entered += weight;
    const double z = -std::sqrt(1 - (1 - outside * outside) / (eta * eta)), ring = std::sqrt(1 - z * z);
    dvec3 at(0), direction(ring * std::cos(turn), ring * std::sin(turn), z);
    while (weight > 0) {
      const dvec3 flight = -std::log1p(-unit(random)) * direction;
      if (at.z + flight.z > 0) {
        at += flight * (-at.z / flight.z);
        at.z = 0;
        const double sine2 = eta * eta * (1 - direction.z * direction.z);
        if (sine2 < 1 && unit(random) >= reflected(std::sqrt(1 - sine2), eta)) {
          found.push_back({at.x, weight});
          break;
        }
        direction.z = -direction.z;
        continue;
      }
      at += flight;
      weight *= scattered;
      if (weight < 0.125) weight = unit(random) < 0.5 ? 2 * weight : 0;
      const double up = 1 - 2 * unit(random), around = 2 * M_PI * unit(random), side = std::sqrt(1 - up * up);
      direction = {side * std::cos(around), side * std::sin(around), up};
    }
  }
  for (Leaving& light : found) light.share /= entered;
  std::ranges::sort(found, std::greater(), &Leaving::x);
  return found;
}

/// The share of a profile's light that leaves farther than x along one axis; `radius`: of its quantiles.
template <class Radius>
double beyond(double x, const Radius& radius) {
  constexpr int kQuantiles = 2000;
  double sum = 0;
  for (int i = 0; i < kQuantiles; ++i) {
    const auto r = static_cast<double>(radius((static_cast<float>(i) + 0.5f) / kQuantiles));
    sum += r > std::abs(x) ? std::acos(x / r) / M_PI : x < 0 ? 1 : 0;
  }
  return sum / kQuantiles;
}

/// skin1 and marble of Jensen et al. 2001. Largest errors are over what the walk reflects of even light.
TEST(DiffusionWalk, ProfilesCrossAShadowsEdgeNearlyAsWalksDo) {
  struct Matter {
    const char* name;
    double scattering, absorption, eta;  // per millimetre
  };
  for (const Matter& matter : {Matter{"skin, red", 0.74, 0.032, 1.3},
                               {"skin, green", 0.88, 0.17, 1.3},
                               {"skin, blue", 1.01, 0.48, 1.3},
                               {"marble, red", 2.19, 0.0021, 1.5},
                               {"marble, blue", 3, 0.0071, 1.5}}) {
    const double scattered = matter.scattering / (matter.scattering + matter.absorption);
    const std::vector<Leaving> light = walks(scattered, matter.eta);
    const DiffusionBoundary boundary = diffusion_boundary(static_cast<float>(matter.eta));
    const auto absorption = static_cast<float>(1 - scattered);
    const NormalisedDiffusion normalised = normalised_diffusion(absorption, walk_reflectance(boundary));
    const DiffusionDipole dipole = diffusion_dipole(absorption, boundary);
    double all = 0, ofNormalised = 0, ofDipole = 0;
    for (const Leaving& leaving : light) all += leaving.share;
    for (double x = -20; x <= 20; x += 0.25) {
      double walked = 0;
      for (auto i = light.begin(); i != light.end() && i->x > x; ++i) walked += i->share;
      const auto error = [&](float reflectance, double share) {
        return std::abs(static_cast<double>(reflectance) * share - walked) / all;
      };
      ofNormalised = std::max(ofNormalised, error(normalised.reflectance, beyond(x, [&](float xi) {
                                                    return normalised_diffusion_radius(normalised, xi);
                                                  })));
      ofDipole =
          std::max(ofDipole, error(dipole.reflectance,
                                   beyond(x, [&](float xi) { return diffusion_dipole_radius(dipole, xi); })));
    }
    RecordProperty(matter.name, std::to_string(ofNormalised) + " " + std::to_string(ofDipole));
    EXPECT_LE(ofNormalised, 0.05) << matter.name;
    EXPECT_LE(ofDipole, 0.15) << matter.name;
  }
}

}  // namespace
}  // namespace limn::glsl
