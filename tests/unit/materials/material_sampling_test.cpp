// Samplers of the material models against the densities that they state.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "glsl/numeric/sampling.glsl"
#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

const std::vector<vec3> kViews = {directionAt(1, 0), directionAt(0.6, 0.5), directionAt(0.05, 4)};

/// The density integrates to 1 less the share of samples below the horizon, which stratified numbers count.
/// What is left is the quadrature's: 192 x 192 cells, some of which the horizon or a narrow lobe cuts.
TEST(MaterialSampling, DensitiesIntegrateToOne) {
  for (const NamedModel& named : allModels())
    for (const vec3& v : kViews) {
      const MaterialModel& m = named.model;
      double integral = 0;
      overHemisphere(m, v, 192,
                     [&](const vec3& l, double weight) { integral += weight * double(model_pdf(m, v, l)); });
      constexpr int samples = 1 << 16;
      int below = 0;
      for (uint i = 0; i < samples; ++i) below += model_sample(m, v, r3_sequence(i)).z <= 0;
      EXPECT_NEAR(integral + double(below) / samples, 1, 0.01) << named.name << ' ' << v.z;
    }
}

/// The furnace by samples is the furnace by quadrature.
TEST(MaterialSampling, SampledFurnaceIsTheExactOne) {
  for (const NamedModel& named : allModels())
    for (const vec3& v : kViews) {
      const MaterialModel& m = named.model;
      constexpr int samples = 1 << 16;
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
      EXPECT_NEAR(sum, furnace(m, v), 0.01 + noise) << named.name << ' ' << v.z;
    }
}

}  // namespace
}  // namespace limn::glsl
