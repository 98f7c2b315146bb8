// Metallic-roughness surfaces that stand for material models (glsl/surface/nearest_brdf.glsl).
#include "glsl/surface/nearest_brdf.glsl"

#include <gtest/gtest.h>

#include "tests/support/material_models.h"
#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

TEST(NearestBrdf, ReflectsAsMuchDiffuseLightAsTheModel) {
  for (const test::NamedModel& named : test::materialModels()) {
    if (named.model.kind == model_coated) continue;  // what it mirrors is no lobe
    const vec3 albedo = hemispherical_reflectance(nearest_brdf(named.model, 0.3f)),
               expected = model_albedo(named.model);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], expected[c], 1e-5f) << named.name << ' ' << c;
  }
  for (const float ks : {1e-3f, 0.04f, 1 / 21.f, 0.06f, 1 / 15.f, 0.1f, 0.7f}) {
    const MaterialModel phong = phongModel(0.3f, ks, 100);
    EXPECT_NEAR(hemispherical_reflectance(nearest_brdf(phong, 0.07f)).x, model_albedo(phong).x, 1e-5f) << ks;
  }
}

/// The diffuse coefficient of Banks is no albedo: 8/3 of it is.
TEST(NearestBrdf, DiffusePartIsTheModels) {
  for (const float kd : {0.1f, 0.3f}) {
    const SurfaceBrdf s = nearest_brdf(banksModel(kd, 0, 20), 1);
    EXPECT_NEAR(double(s.diffuse.x), furnace(banksModel(kd, 0, 20), directionAt(0.5, 1)), 1e-3) << kd;
    EXPECT_TRUE(brdf_is_lambertian(s)) << kd;
    EXPECT_EQ(nearest_brdf(phongModel(kd, 0.2f, 20), 0.2f).diffuse.x, kd);
  }
  // The response that goes with it has that integral.
  double sum = 0;
  constexpr int n = 128;
  for (int i = 0; i < n * n; ++i) {
    const vec3 l = sample_cosine(vec2((i % n + 0.5f) / n, (i / n + 0.5f) / n));
    sum += double(model_diffuse_response(banksModel(0.3f, 0.1f, 20), l).x / cosine_pdf(l.z)) / (n * n);
  }
  EXPECT_NEAR(sum, 0.8, 1e-3);
}

/// Weak lobes rise from 0.3 of their albedo head-on to 15 times as much at grazing angles, without a step
/// where f90 reaches 1.
TEST(NearestBrdf, WeakLobesStay) {
  for (const float kd : {0.f, 0.3f})
    for (const float ks : {1e-3f, 0.03f, 0.04f}) {
      const MaterialModel phong = phongModel(kd, ks, 100);
      const float lobe = model_albedo(phong).x - kd;
      const SurfaceBrdf s = nearest_brdf(phong, 0.07f);
      EXPECT_FALSE(brdf_is_lambertian(s)) << kd << ' ' << ks;
      EXPECT_NEAR(s.f0.x, 0.3f * lobe, 1e-6f) << kd << ' ' << ks;
      EXPECT_NEAR(s.f90, 15 * lobe, 1e-5f) << kd << ' ' << ks;
    }
  EXPECT_NEAR(nearest_brdf(phongModel(0, 0.0669f, 1e4f), 0.1f).f0.x, 0.02f, 1e-3f);
}

}  // namespace
}  // namespace limn::glsl
