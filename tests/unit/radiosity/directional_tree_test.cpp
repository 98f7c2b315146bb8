// Light over directions as trees: what they keep of lobes and functions, and what they cost.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/radiosity/tree_builder.h"
#include "glsl/numeric/srgb.glsl"
#include "tests/unit/glsl/random.h"

namespace limn::radiosity {
namespace {

using Criterion = TreeSettings::Criterion;
using Function = TreeBuilder::Function;

glsl::SurfaceBrdf metal(float roughness) {
  return glsl::surface_brdf(glm::vec3(0.75f), 1, roughness, 1, glm::vec3(1), 1.5f);
}

glsl::IncidentLight lightFrom(float degrees, const glm::vec3& irradiance = glm::vec3(1), float spread = 0) {
  const float angle = degrees * glsl::pi / 180;
  return {{std::sin(angle) * std::cos(0.7f), std::sin(angle) * std::sin(0.7f), std::cos(angle)},
          spread,
          irradiance};
}

GlossyLobes lobesOf(float roughness, const std::vector<glsl::IncidentLight>& lights, float widen = 0) {
  GlossyLobes lobes;
  lobes.set(metal(roughness), lights, widen);
  return lobes;
}

Function radianceOf(const GlossyLobes& lobes) {
  return [&lobes](const glm::vec3& w) { return lobes.radiance(w); };
}

/// The relative L2 error over the hemisphere, weighted by the cosine.
double errorOf(const Function& tree, const Function& truth, int n) {
  double error = 0, power = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const glm::vec3 w = glsl::sample_cosine((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(n));
      const double exact = double(glsl::luminance(truth(w))), found = double(glsl::luminance(tree(w)));
      error += (found - exact) * (found - exact);
      power += exact * exact;
    }
  return std::sqrt(error / power);
}
double errorOf(const DirectionalTree& tree, const GlossyLobes& lobes, int n = 256) {
  return errorOf([&](const glm::vec3& w) { return tree.value(w); }, radianceOf(lobes), n);
}

TEST(GlossyLobes, AreTheBrdf) {
  glsl::Random random(5);
  for (const float roughness : {0.05f, 0.3f, 1.f}) {
    const glsl::SurfaceBrdf surface = glsl::surface_brdf(glm::vec3(0.9f, 0.5f, 0.2f), 0.4f, roughness, 0.8f,
                                                         glm::vec3(1, 0.7f, 0.6f), 1.6f);
    for (int i = 0; i < 200; ++i) {
      glsl::IncidentLight light{random.direction(), 0, {1, 2, 3}};
      glm::vec3 w = random.direction();
      light.direction.z = std::abs(light.direction.z) + 1e-3f;
      light.direction = glm::normalize(light.direction);
      w.z = std::abs(w.z) + 1e-3f;
      w = glm::normalize(w);
      GlossyLobes lobes;
      lobes.set(surface, {&light, 1}, 0);
      const glm::vec3 exact = glsl::brdf_parts(surface, glm::vec3(0, 0, 1), w, light.direction).specular *
                              light.irradiance * light.direction.z;
      const glm::vec3 found = lobes.radiance(w);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], exact[c], 2e-4f * exact[c] + 1e-6f) << roughness;
    }
  }
}

TEST(DirectionalTree, KeepsTheFluxOfLobes) {
  TreeBuilder builder;
  DirectionalTree tree;
  for (const float roughness : {0.1f, 0.3f, 1.f}) {
    const GlossyLobes lobes = lobesOf(roughness, {lightFrom(30), lightFrom(70, {0.1f, 2, 1})});
    builder.build(lobes, {}, tree);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(tree.flux()[c], lobes.flux()[c], 1e-5f * lobes.flux()[c]) << roughness;
  }
}

}  // namespace
}  // namespace limn::radiosity
