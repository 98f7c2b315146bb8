// How illumination samples are reflected: lobes that are widened keep their energy.
#include "glsl/indirect/sample_reflection.glsl"

#include <gtest/gtest.h>

namespace limn::glsl {
namespace {

SurfaceBrdf satin(float roughness) {
  return surface_brdf(vec3(0.75f), 1, roughness, 1, vec3(1), 1.5f);
}

/// What leaves towards all directions, times the cosine.
float sent(const SurfaceBrdf& s, const IncidentLight& light, float widen) {
  constexpr int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // Uniform in the projected solid angle.
      const vec2 u((float(i) + 0.5f) / n, (float(j) + 0.5f) / n);
      const vec3 v = sample_cosine(u);
      sum += reflected_specular(s, vec3(0, 0, 1), v, light, widen).x;
    }
  return pi * static_cast<float>(sum / (n * n));
}

TEST(SampleReflectionTest, WidenedLobesKeepTheirEnergy) {
  for (const float roughness : {0.2f, 0.3f, 0.5f})
    for (const float cosine : {0.95f, 0.7f, 0.4f}) {
      const SurfaceBrdf s = satin(roughness);
      IncidentLight light;
      light.direction = vec3(sqrt(1 - cosine * cosine), 0, cosine);
      light.irradiance = vec3(1);
      light.spread = 0.6f;
      const float expected = cosine * ltc_specular_reflectance(s, ltc_lookup(cosine, s.alpha)).x;
      EXPECT_NEAR(sent(s, light, 0) / expected, 1, 0.03) << roughness << " " << cosine;
      EXPECT_NEAR(sent(s, light, 0.22f) / expected, 1, 0.03) << roughness << " " << cosine;
    }
}

TEST(SampleReflectionTest, PointsAreReflectedByTheBrdf) {
  const SurfaceBrdf s = satin(0.3f);
  const IncidentLight light{normalize(vec3(0.3f, -0.2f, 1)), 0, vec3(2)};
  const vec3 n(0, 0, 1), v = normalize(vec3(-0.2f, 0.3f, 1));
  const vec3 expected = brdf(s, n, v, light.direction) * light.irradiance * light.direction.z;
  EXPECT_NEAR(reflected_specular(s, n, v, light, 0.22f).x / expected.x, 1, 1e-5f);
  IncidentLight below = light;
  below.direction.z = -0.1f;
  EXPECT_EQ(reflected_specular(s, n, v, below, 0.22f), vec3(0));
}

/// A sender in its whole extent against many points of it, beside its foot and above its middle.
TEST(SampleReflectionTest, SendersAreReflectedInTheirWholeExtent) {
  const SurfaceBrdf s = satin(0.3f);
  const vec3 n(0, 0, 1), v = normalize(vec3(-0.8f, 0, 0.6f));
  const SampleSender wall{vec3(0.5f, 0, 0.5f), 2, vec3(0, 2, 0), vertex_pack_normal(vec3(-1, 0, 0))};
  for (const float away : {0.1f, 0.5f, 2.f}) {
    const vec3 x(0.5f - away, 0, 0);
    constexpr int side = 200;
    float expected = 0;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        SampleSender piece = wall;
        piece.position = vec3(0.5f, 2 * (float(i) + 0.5f) / side - 1, (float(j) + 0.5f) / side);
        piece.area = wall.area / (side * side);
        expected += reflected_specular(s, n, v, incident_light(piece, vec3(1), x), 0).x;
      }
    EXPECT_NEAR(reflected_extent(s, x, n, n, v, wall, vec3(1)).x / expected, 1, 0.1f) << away;
  }
  const vec3 behind(0.6f, 0, 0), touching(0.5f, 0, 0);
  EXPECT_EQ(reflected_extent(s, behind, n, n, v, wall, vec3(1)), vec3(0));
  EXPECT_GT(reflected_extent(s, touching, n, n, v, wall, vec3(1)).x, 0.3f);
}

TEST(SampleReflectionTest, DiffusePartsAreWhatDielectricsLeave) {
  EXPECT_EQ(diffuse_albedo(satin(0.3f)), vec3(0));
  const SurfaceBrdf plastic = surface_brdf(vec3(0.5f), 0, 0.3f, 1, vec3(1), 1.5f);
  EXPECT_LT(diffuse_albedo(plastic).x, 0.5f * 0.96f);
  EXPECT_GT(diffuse_albedo(plastic).x, 0.5f * 0.9f);
  const SurfaceBrdf lambert = surface_brdf(vec3(0.5f), 0, 1, 0, vec3(1), 1.5f);
  EXPECT_EQ(diffuse_albedo(lambert), vec3(0.5f));
}

}  // namespace
}  // namespace limn::glsl
