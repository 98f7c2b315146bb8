// Light of prefiltered environments (glsl/light/prefiltered.glsl) against integration: what filtering once
// for all views costs, apart from the maps' resolution.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "glsl/light/prefiltered.glsl"
#include "tests/unit/glsl/prefiltered_skies.h"

namespace limn::glsl {
namespace {

/// Reflected radiance of a surface that reflects all light that meets a facet.
double exactGgx(const Sky& sky, const vec3& n, const vec3& v, float alpha) {
  const Frame frame = frame_around(n);
  const vec3 local = to_local(frame, v);
  double sum = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec3 h = sample_visible_normal(local, vec2(alpha), gridPoint(i));
    const vec3 l = 2 * dot(local, h) * h - local;
    // f cos / pdf = G2 / G1 with a Fresnel term of 1.
    if (l.z > 0)
      sum += static_cast<double>(4 * ggx_visibility(local.z, l.z, alpha) * local.z * l.z /
                                 ggx_masking(local.z, alpha)) *
             sky.radiance(from_local(frame, l));
  }
  return sum / (kSide * kSide);
}

double filteredGgx(const Sky& sky, const vec3& axis, float alpha) {
  const Frame frame = frame_around(axis);
  constexpr int count = 2048;
  double sum = 0, weights = 0;
  for (int i = 0; i < count; ++i) {
    const PrefilterSample s = prefilter_sample(alpha, i, count);
    if (s.weight == 0) continue;
    sum += static_cast<double>(s.weight) * sky.radiance(from_local(frame, s.direction));
    weights += static_cast<double>(s.weight);
  }
  return sum / weights;
}

/// The error of the split sum with each lookup.
std::array<double, 3> splitSumErrors(const Sky& sky, float alpha, Views views) {
  std::array<RelativeError, 3> errors;
  for (int i = 0; i < kViews; ++i) {
    const auto [n, v] = views.next();
    const LtcTerms terms = ltc_lookup(dot(n, v), alpha);
    const double exact = exactGgx(sky, n, v, alpha),
                 reflectance = static_cast<double>(terms.reflectance.x + terms.reflectance.y);
    for (int lookup = 0; lookup < 3; ++lookup)
      errors[static_cast<size_t>(lookup)].add(
          reflectance * filteredGgx(sky, prefiltered_direction(lookup, terms, n, v, alpha), alpha), exact);
  }
  return {errors[0].value(), errors[1].value(), errors[2].value()};
}

TEST(PrefilteredLight, SplitSumsByTheDirectionOfTheLookup) {
  for (const Sky& sky : kSkies)
    for (const float alpha : {0.15f, 0.3f, 0.6f, 1.f})
      for (const auto& [low, high] : {std::pair(0., 60.), std::pair(80., 90.)}) {
        const auto [mirror, drawn, centroid] = splitSumErrors(sky, alpha, Views{low, high});
        RecordProperty(sky.name + " alpha " + std::to_string(alpha) + " view " + std::to_string(int(low)),
                       std::to_string(mirror) + " " + std::to_string(drawn) + " " + std::to_string(centroid));
        // Rough lobes are drawn towards the normal, the more the nearer the view is to the horizon.
        EXPECT_LT(drawn, mirror) << sky.name << alpha << ' ' << low;
        EXPECT_LT(centroid, mirror) << sky.name << alpha << ' ' << low;
        if (low > 0 && alpha < 1) {
          EXPECT_LT(centroid, drawn) << alpha;
        }
        // The widest lobe is half the sphere: what a map says of it hardly depends on the view.
        if (low == 0 && alpha == 1) {
          EXPECT_LT(std::max(drawn, centroid), 0.1 * mirror);
        }
      }
}

/// The share of the lobe above the horizon by quadrature over its angle: the cut of each ring is an arc.
double horizonShare(double cosine, double p) {
  constexpr int count = 20000;
  const double sine = std::sqrt(1 - cosine * cosine);
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double mu = std::pow((i + 0.5) / count, 1 / (p + 1)), across = std::sqrt(1 - mu * mu);
    const double cut = -cosine * mu / std::max(sine * across, 1e-300);
    sum += std::acos(std::clamp(cut, -1., 1.)) / M_PI;
  }
  return sum / count;
}

TEST(PrefilteredLight, TheSharesOfPhongLobesAreThoseOfQuadrature) {
  for (const auto& [p, bound] : {std::pair(1., 0.025), std::pair(5., 5e-3), std::pair(10., 2.4e-3),
                                 std::pair(100., 3e-4), std::pair(1000., 1e-4), std::pair(1e5, 1e-4)})
    for (int i = -50; i <= 50; ++i) {
      const double cosine = i / 50.;
      EXPECT_NEAR(
          static_cast<double>(phong_above_horizon(static_cast<float>(cosine), static_cast<float>(p)).share),
          horizonShare(cosine, p), bound)
          << p << ' ' << cosine;
    }
}

}  // namespace
}  // namespace limn::glsl
