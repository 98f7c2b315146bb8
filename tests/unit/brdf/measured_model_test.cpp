// What a measured material tells of its table: reflectance, width, and samples that find its lobe.
#include "core/brdf/measured_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "glsl/materials/model.glsl"
#include "tests/unit/brdf/materials.h"

namespace limn::brdf::test {
namespace {

TEST(MeasuredModel, OfALambertianTableIsItsAlbedo) {
  const auto grey = [](const glm::vec3&, const glm::vec3&) { return glm::vec3(0.2f, 0.4f, 0.6f) / glsl::pi; };
  const auto expectAlbedo = [](const MeasuredModel& m) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(m.model.k[c], 0.2f * static_cast<float>(c + 1), 2e-3f);
      EXPECT_NEAR(m.model.kd[c], m.model.k[c], 2e-3f);
    }
    EXPECT_NEAR(m.largestAlbedo, 0.6f, 0.01f);
    EXPECT_EQ(m.model.roughness.x, 1);
  };
  const MeasuredModel isotropic = measuredModel(tabulate({8, 8, 8}, grey));
  expectAlbedo(isotropic);
  EXPECT_EQ(glsl::measured_size(isotropic.model.nodes), glm::uvec3(8, 8, 8));
  EXPECT_FALSE(glsl::model_anisotropic(isotropic.model));
  const MeasuredModel pairs = measuredModel(tabulateAnisotropic(6, grey));
  expectAlbedo(pairs);
  EXPECT_EQ(glsl::measured_size(pairs.model.nodes), glm::uvec3(6, 0, 0));
  EXPECT_TRUE(glsl::model_anisotropic(pairs.model));
}

// A Gaussian of slopes falls to half at tan = 0.83 m, where a GGX lobe of alpha = 1.29 m does.
TEST(MeasuredModel, KnowsTheWidthOfALobe) {
  for (const double m : {0.1, 0.3}) {
    const MeasuredModel metal = measuredModel(tabulate({90, 45, 30}, Microfacets{.m = m}));
    EXPECT_NEAR(metal.model.roughness.x, 1.29 * m, 0.12 * m) << m;
    const MeasuredModel gloss = measuredModel(tabulate({90, 45, 30}, plastic(m)));
    EXPECT_NEAR(gloss.model.roughness.x, 1.29 * m, 0.15 * m) << m;
    EXPECT_NEAR(gloss.model.kd.x, 0.4, 0.05) << m;
  }
}

TEST(MeasuredModel, RefusesTablesThatItsNumbersCannotHold) {
  EXPECT_THROW(measuredModel(TabulatedBrdf{.size = {1024, 1, 1}, .values = {}}), Error);
  EXPECT_THROW(measuredModel(TabulatedBrdf{.size = {0, 0, 0}, .values = {}}), Error);
  EXPECT_THROW(measuredModel(AnisotropicTable{.size = 0, .values = {}}), Error);
}

/// Sums f cos / pdf over a grid of samples.
glm::dvec3 sampledAlbedo(const std::vector<glm::vec3>& values, const glsl::MaterialModel& model,
                         const glm::vec3& v) {
  constexpr int side = 64;
  glm::dvec3 sum(0);
  for (int i = 0; i < side * side * side; ++i) {
    const glm::ivec3 cell(i % side, i / side % side, i / side / side);
    const glm::vec3 u = (glm::vec3(cell) + 0.5f) / float(side);
    const glm::vec3 l = glsl::model_sample(model, v, u);
    const float pdf = glsl::model_pdf(model, v, l);
    if (pdf > 0) sum += glm::dvec3(glsl::model_response(values, model, v, l)) / static_cast<double>(pdf);
  }
  return sum / static_cast<double>(side * side * side);
}

TEST(MeasuredModel, SamplesReflectWhatTheTableDoes) {
  const TabulatedBrdf metal = tabulate({90, 45, 30}, Microfacets{.m = 0.2});
  const AnisotropicTable grooves = tabulateAnisotropic(8, [](const glm::vec3& l, const glm::vec3& v) {
    return glm::vec3(0.3f + 0.2f * l.x * v.x, 0.2f, 0.1f);
  });
  const glm::vec3 v(0.6f, 0, 0.8f);
  const auto expectSame = [&](const auto& table) {
    const glsl::MaterialModel model = measuredModel(table).model;
    const glm::dvec3 sampled = sampledAlbedo(table.values, model, v);
    const glm::dvec3 exact =
        albedoOfBrdf([&](const glm::vec3& l, const glm::vec3& to) { return table.evaluate(l, to); }, v, 256);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sampled[c], exact[c], 3e-4 * exact[c]);
  };
  expectSame(metal);
  expectSame(grooves);
}

}  // namespace
}  // namespace limn::brdf::test
