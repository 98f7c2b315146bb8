// Samplers of the material models against the densities that they state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "glsl/numeric/sampling.glsl"
#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

const std::vector<vec3> kViews = {directionAt(1, 0), directionAt(0.6, 0.5), directionAt(0.05, 4)};

/// All models, and measured ones, whose densities ask for no table.
std::vector<NamedModel> sampledModels() {
  std::vector<NamedModel> all = allModels();
  for (const uint options : {0u, model_option_pairs})
    for (const float width : {1e-3f, 0.01f, 0.1f, 0.4f, 1.f}) {
      const std::string name = options == 0 ? "measured " : "measured pairs ";
      all.push_back({name + std::to_string(width), microfacets(model_measured, vec2(width), options)});
    }
  return all;
}

/// Counts of bins that are regular in the square of a direction map.
struct Bins {
  static constexpr int side = 16;
  DirectionMap map;
  std::vector<double> values = std::vector<double>(side * side, 0.0);

  void add(const vec3& l, double weight) {
    const dvec2 place = map.place(dvec3(l));
    const auto index = [](double x) { return std::clamp(int(x * side), 0, side - 1); };
    values[std::size_t(index(place.y) * side + index(place.x))] += weight;
  }
};

/// How many standard deviations chi-square lies above its mean for its degrees of freedom (Wilson and
/// Hilferty 1931). Bins with fewer than 10 samples to be expected are put together, and with them what went
/// below the horizon.
double deviationOf(const std::vector<double>& counts, const std::vector<double>& expected, double samples) {
  double chi2 = 0, restCount = samples, restExpected = samples;
  int bins = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] < 10) continue;
    chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    restCount -= counts[i];
    restExpected -= expected[i];
    ++bins;
  }
  if (restExpected > 10) {
    chi2 += (restCount - restExpected) * (restCount - restExpected) / restExpected;
    ++bins;
  } else {
    EXPECT_LT(restCount, 40);
  }
  const double freedom = std::max(bins - 1, 1), part = 2 / (9 * freedom);
  return (std::cbrt(chi2 / freedom) - (1 - part)) / std::sqrt(part);
}

/// 4.5 standard deviations are passed once in 3e5 tests.
TEST(MaterialSampling, SamplesPassTheChiSquareTest) {
  constexpr int samples = 40000;
  unsigned seed = 0;
  for (const NamedModel& named : sampledModels())
    for (const vec3& v : kViews) {
      const MaterialModel& m = named.model;
      Bins bins[] = {{lobeMap(m, v)}, {cosineMap()}}, expected[] = {{lobeMap(m, v)}, {cosineMap()}};
      overHemisphere(m, v, 50000, [&](const vec3& l, double weight) {
        const double share = weight * double(model_pdf(m, v, l)) * samples;
        for (Bins& b : expected) b.add(l, share);
      });
      std::mt19937 random(++seed);
      std::uniform_real_distribution<float> unit;
      for (int i = 0; i < samples; ++i) {
        const vec3 l = model_sample(m, v, {unit(random), unit(random), unit(random)});
        ASSERT_NEAR(length(l), 1, 1e-5f) << named.name;
        if (l.z > 0)
          for (Bins& b : bins) b.add(l, 1);
      }
      for (int i = 0; i < 2; ++i)
        EXPECT_LT(deviationOf(bins[i].values, expected[i].values, samples), 4.5)
            << named.name << ' ' << v.z << ' ' << i;
    }
}

/// The density integrates to 1 less the share of samples below the horizon, which stratified numbers count.
TEST(MaterialSampling, DensitiesIntegrateToOne) {
  for (const NamedModel& named : sampledModels())
    for (const vec3& v : kViews) {
      const MaterialModel& m = named.model;
      double integral = 0;
      overHemisphere(m, v, 50000,
                     [&](const vec3& l, double weight) { integral += weight * double(model_pdf(m, v, l)); });
      constexpr int samples = 1 << 18;
      int below = 0;
      for (uint i = 0; i < samples; ++i) below += model_sample(m, v, r3_sequence(i)).z <= 0;
      EXPECT_NEAR(integral + double(below) / samples, 1, 1e-3) << named.name << ' ' << v.z;
    }
}

/// The furnace by samples is the furnace by quadrature.
TEST(MaterialSampling, SampledFurnaceIsTheExactOne) {
  for (const NamedModel& named : allModels())
    for (const vec3& v : kViews) {
      const MaterialModel& m = named.model;
      constexpr int samples = 1 << 17;
      double sum = 0, squares = 0;
      for (uint i = 0; i < samples; ++i) {
        const vec3 l = model_sample(m, v, r3_sequence(i));
        const float pdf = model_pdf(m, v, l);
        if (!(pdf > 0)) continue;
        const double value = double(model_response(m, v, l).x / pdf);
        sum += value / samples;
        squares += value * value / samples;
      }
      const double noise = std::sqrt(std::max(squares - sum * sum, 0.0) / samples);
      EXPECT_NEAR(sum, furnace(m, v), 1e-3 + noise) << named.name << ' ' << v.z;
    }
}

}  // namespace
}  // namespace limn::glsl
