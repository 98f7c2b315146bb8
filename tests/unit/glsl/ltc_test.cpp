// The fitted table against numeric integration of the BRDF it stands for.
#include "glsl/light/ltc.glsl"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limn::glsl {
namespace {

vec3 atCosine(float cosine, float azimuth) {
  const float sine = std::sqrt(std::max(0.f, 1 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

struct Reflectance {
  double a = 0, b = 0;
};

Reflectance reflectance(float alpha, const vec3& v, int side = 150) {
  Reflectance sum;
  for (int i = 0; i < side * side; ++i) {
    const vec3 h =
        sample_visible_normal(v, vec2(alpha), {(i % side + 0.5f) / side, (i / side + 0.5f) / side});
    const vec3 l = 2 * dot(v, h) * h - v;
    if (l.z <= 0) continue;
    const double g = 4.0 * v.z * l.z * ggx_visibility(v.z, l.z, alpha) / ggx_masking(v.z, alpha);
    const double s = schlick_weight(dot(v, h));
    sum.a += g * (1 - s);
    sum.b += g * s;
  }
  return {sum.a / (side * side), sum.b / (side * side)};
}

TEST(Ltc, ReflectancesMatchIntegrationBetweenTexels) {
  double worst = 0;
  for (float roughness : {0.05f, 0.11f, 0.23f, 0.37f, 0.52f, 0.76f, 0.97f}) {
    for (float cosine : {0.01f, 0.03f, 0.07f, 0.15f, 0.33f, 0.61f, 0.87f, 0.99f}) {
      const float alpha = roughness * roughness;
      const LtcTerms terms = ltc_lookup(cosine, alpha);
      const Reflectance expected = reflectance(alpha, atCosine(cosine, 0));
      const double error =
          std::max(std::abs(terms.reflectance.x - expected.a), std::abs(terms.reflectance.y - expected.b));
      worst = std::max(worst, error);
      EXPECT_LT(error, cosine < 0.05f ? 0.012 : 0.004) << roughness << ' ' << cosine;
    }
  }
  RecordProperty("worst_1e6", static_cast<int>(1e6 * worst));
}

TEST(Ltc, DiffuseFresnelMeanMatchesIntegration) {
  for (float cosine : {0.01f, 0.1f, 0.3f, 0.6f, 0.95f}) {
    const vec3 v = atCosine(cosine, 0);
    double sum = 0;
    const int side = 200;
    for (int i = 0; i < side * side; ++i) {
      const vec3 l = sample_cosine({(i % side + 0.5f) / side, (i / side + 0.5f) / side});
      sum += schlick_weight(half_vector(vec3(0, 0, 1), v, l).v_dot_h);
    }
    EXPECT_NEAR(ltc_lookup(cosine, 0.5f).reflectance.z, sum / (side * side), 2e-4);
  }
}

TEST(Ltc, WholeSkyHoldsTheWholeLobe) {
  const vec3 n(0, 0, 1);
  const Rectangle sky = {{0, 0, 1e-3f}, {1e4f, 0, 0}, {0, 1e4f, 0}};
  for (float roughness : {0.1f, 0.4f, 0.8f, 1.f}) {
    for (float cosine : {0.1f, 0.4f, 0.7f, 0.99f}) {
      const float alpha = roughness * roughness;
      const vec3 v = atCosine(cosine, 0.7f);
      const LtcTerms terms = ltc_lookup(cosine, alpha);
      const float share =
          ltc_rectangle(ltc_transform(terms, n, v, alpha), terms, sky, rectangle_above(sky, n)).share;
      EXPECT_NEAR(share, 1, 0.01) << roughness << ' ' << cosine;
    }
  }
}

/// Integral of the lobe (Fresnel term 1) over a rectangle, by sampling visible normals and intersecting.
double lobeOverRectangle(const Rectangle& r, float alpha, const vec3& v, int side) {
  const dvec3 u(r.u), w(r.v), c(r.centre), normal = cross(u, w);
  double sum = 0;
  for (int i = 0; i < side * side; ++i) {
    const vec3 h =
        sample_visible_normal(v, vec2(alpha), {(i % side + 0.5f) / side, (i / side + 0.5f) / side});
    const vec3 l = 2 * dot(v, h) * h - v;
    if (l.z <= 0) continue;
    const double t = dot(c, normal) / dot(dvec3(l), normal);
    const dvec3 p = t * dvec3(l) - c;
    if (t > 0 && std::abs(dot(p, u)) <= 0.5 * dot(u, u) && std::abs(dot(p, w)) <= 0.5 * dot(w, w)) {
      sum += 4.0 * v.z * l.z * ggx_visibility(v.z, l.z, alpha) / ggx_masking(v.z, alpha);
    }
  }
  return sum / (double(side) * side);
}

// Rectangles of 0.2 to 4 distances around the mirror direction, so that each holds part of the lobe's core or
// edge. Errors are of the reflected share of the light's radiance, which is at most 1. Measured root mean
// squares: 0.0016 at roughness 0.06, 0.019 at 0.25, 0.018 at 0.4, 0.0066 at 0.6, 0.0018 at 1; the worst
// 0.088. The table's resolution has no part in it: the total variation between lobe and fit is the same at
// and between texels.
TEST(Ltc, RectanglesMatchIntegrationWithinTheStatedError) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  const vec3 n(0, 0, 1);
  for (float roughness : {0.06f, 0.15f, 0.25f, 0.4f, 0.6f, 0.8f, 1.f}) {
    const float alpha = roughness * roughness;
    std::vector<double> errors;
    double squares = 0;
    for (int i = 0; i < 150; ++i) {
      const vec3 v = atCosine(0.05f + 0.95f * unit(random), 6.28f * unit(random));
      const vec3 mirror(-v.x, -v.y, v.z);
      const vec3 spread(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f);
      Rectangle r;
      r.centre = normalize(mirror + (0.2f + 2 * alpha) * spread);
      const Frame frame =
          frame_around(normalize(r.centre + 0.6f * vec3(unit(random), unit(random), unit(random))));
      r.u = frame.t * (0.2f * std::pow(20.f, unit(random)));
      r.v = frame.b * (0.2f * std::pow(20.f, unit(random)));
      const LtcTerms terms = ltc_lookup(v.z, alpha);
      const float share =
          ltc_rectangle(ltc_transform(terms, n, v, alpha), terms, r, rectangle_above(r, n)).share;
      const double expected = lobeOverRectangle(r, alpha, v, 150);
      const double error = share * (terms.reflectance.x + terms.reflectance.y) - expected;
      errors.push_back(std::abs(error));
      squares += error * error;
    }
    std::sort(errors.begin(), errors.end());
    const double rms = std::sqrt(squares / errors.size()), worst = errors.back();
    RecordProperty(fmt::format("rms_1e6_roughness_{}", roughness), static_cast<int>(1e6 * rms));
    RecordProperty(fmt::format("worst_1e6_roughness_{}", roughness), static_cast<int>(1e6 * worst));
    EXPECT_LT(rms, 0.022) << roughness;
    EXPECT_LT(worst, 0.1) << roughness;
  }
}

/// Shares of the lobe above planes that are turned from the surface by up to 1.2 radians. Measured root mean
/// squares: 1e-4 for the smoothest, 0.006 at roughness 0.15, 0.015 at 0.4, 0.007 at 1; the worst 0.09.
TEST(Ltc, SharesAbovePlanesMatchIntegration) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  const vec3 n(0, 0, 1);
  for (float roughness : {0.f, 0.15f, 0.4f, 0.6f, 1.f}) {
    const float alpha = std::max(roughness * roughness, brdf_min_alpha);
    constexpr int kPlanes = 150, kSide = 100;
    double squares = 0;
    for (int i = 0; i < kPlanes; ++i) {
      const vec3 v = atCosine(0.05f + 0.95f * unit(random), 0);
      vec3 plane;
      do plane = atCosine(std::cos(1.2f * unit(random)), 2 * pi * unit(random));
      while (!(dot(plane, v) > 0));
      double above = 0, all = 0;
      for (int k = 0; k < kSide * kSide; ++k) {
        const vec3 h =
            sample_visible_normal(v, vec2(alpha), {(k % kSide + 0.5f) / kSide, (k / kSide + 0.5f) / kSide});
        const vec3 l = 2 * dot(v, h) * h - v;
        if (l.z <= 0) continue;
        const double weight = l.z * ggx_visibility(v.z, l.z, alpha);
        all += weight;
        if (dot(l, plane) > 0) above += weight;
      }
      const LtcTransform lobe = ltc_transform(ltc_lookup(v.z, alpha), n, v, alpha);
      const float share = std::min(ltc_share_above(lobe, plane) / ltc_share_above(lobe, n), 1.f);
      const double error = static_cast<double>(share) - above / all;
      squares += error * error;
      EXPECT_LT(std::abs(error), 0.1) << roughness << ' ' << v.z;
    }
    EXPECT_LT(std::sqrt(squares / kPlanes), 0.022) << roughness;
  }
}

}  // namespace
}  // namespace limn::glsl
