// Light of prefiltered environments (glsl/light/prefiltered.glsl) against integration: what filtering once
// for all views costs, apart from the maps' resolution.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "glsl/light/prefiltered.glsl"

namespace limn::glsl {
namespace {

/// A sky over a dark ground with four lamps.
struct Sky {
  std::string name;
  std::array<double, 4> strengths, sharpness;  ///< of the lamps: Gaussians on the sphere

  double radiance(const vec3& d) const {
    static const std::array lamps{normalize(vec3(1, 2, 0.5f)), normalize(vec3(-2, 1, 1)),
                                  normalize(vec3(0.2f, 0.4f, -1)), normalize(vec3(-0.5f, -0.3f, 1))};
    double sum = 0.15 + 0.35 / (1 + std::exp(-20 * static_cast<double>(d.y)));
    for (size_t i = 0; i < lamps.size(); ++i)
      sum += strengths[i] * std::exp(sharpness[i] * (static_cast<double>(dot(d, lamps[i])) - 1));
    return sum;
  }
};

/// Standard deviations of 13 to 26 degrees, and of 4 to 15.
const std::array kSkies{Sky{"wide lamps", {4, 3, 2, 2}, {20, 12, 8, 5}},
                        Sky{"narrow lamps", {20, 8, 5, 3}, {180, 60, 30, 15}}};

constexpr int kSide = 64;  ///< of the grid of samples

vec2 gridPoint(int i) {
  return {(static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide};
}

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

/// Surfaces seen at angles from the normal within a range, degrees.
struct Views {
  double low, high;
  std::mt19937 random{9};

  std::pair<vec3, vec3> next() {
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<double> between(std::cos(high * M_PI / 180), std::cos(low * M_PI / 180)),
        turn(0, 2 * M_PI);
    const vec3 n = normalize(vec3(normal(random), normal(random), normal(random)));
    const double cosine = between(random), sine = std::sqrt(1 - cosine * cosine), azimuth = turn(random);
    return {n, from_local(frame_around(n), vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine))};
  }
};

/// RMS of differences over the RMS of exact values.
struct RelativeError {
  double squares = 0, signal = 0;

  void add(double value, double exact) {
    squares += (value - exact) * (value - exact);
    signal += exact * exact;
  }
  double value() const { return std::sqrt(squares / signal); }
};

constexpr int kViews = 100;

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

/// Reflected radiance of the lobe (r.l)^p, normalised over the hemisphere around r; cut at the horizon of n
/// or whole.
double phong(const Sky& sky, const vec3& n, const vec3& r, double p, bool cut) {
  const Frame frame = frame_around(r);
  double sum = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec2 u = gridPoint(i);
    const double cosine = std::pow(1 - static_cast<double>(u.y), 1 / (p + 1)),
                 sine = std::sqrt(1 - cosine * cosine), azimuth = 2 * M_PI * static_cast<double>(u.x);
    const vec3 l = from_local(frame, vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine));
    if (!cut || dot(n, l) > 0) sum += sky.radiance(l);
  }
  return sum / (kSide * kSide);
}

TEST(PrefilteredLight, PhongLobesAreCutAtTheHorizonByTheirShare) {
  for (const Sky& sky : kSkies)
    for (const double p : {10., 100., 1000.})
      for (const auto& [low, high] : {std::pair(0., 60.), std::pair(60., 80.), std::pair(80., 90.)}) {
        Views views{low, high};
        RelativeError whole, shared;
        for (int i = 0; i < kViews; ++i) {
          const auto [n, v] = views.next();
          const vec3 r = 2 * dot(n, v) * n - v;
          const double exact = phong(sky, n, r, p, true), map = phong(sky, n, r, p, false);
          whole.add(map, exact);
          shared.add(map * static_cast<double>(phong_horizon_share(dot(n, v), static_cast<float>(p))), exact);
        }
        RecordProperty(sky.name + " p " + std::to_string(int(p)) + " view " + std::to_string(int(low)),
                       std::to_string(whole.value()) + " " + std::to_string(shared.value()));
        if (whole.value() > 1e-3) {
          EXPECT_LT(shared.value(), whole.value()) << sky.name << p << ' ' << low;
        }
        if (low == 80) {
          EXPECT_LT(shared.value(), 0.5 * whole.value()) << p;
        }
        if (high == 60) {
          EXPECT_LT(shared.value(), 0.02) << p;
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
      EXPECT_NEAR(static_cast<double>(phong_horizon_share(static_cast<float>(cosine), static_cast<float>(p))),
                  horizonShare(cosine, p), bound)
          << p << ' ' << cosine;
    }
}

}  // namespace
}  // namespace limn::glsl
