// Declares the lobes and trees that tests of light by directions share.
#pragma once

#include <cmath>
#include <vector>

#include "core/radiosity/tree_builder.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {

inline glsl::SurfaceBrdf metal(float roughness) {
  return glsl::surface_brdf(glm::vec3(0.75f), 1, roughness, 1, glm::vec3(1), 1.5f);
}

inline glsl::IncidentLight lightFrom(float degrees, const glm::vec3& irradiance = glm::vec3(1),
                                     float spread = 0) {
  const float angle = degrees * glsl::pi / 180;
  return {{std::sin(angle) * std::cos(0.7f), std::sin(angle) * std::sin(0.7f), std::cos(angle)},
          spread,
          irradiance};
}

/// A square of 0.6 rad, `degrees` from the normal, that faces the surface, in side x side samples.
inline std::vector<glsl::IncidentLight> squareOfLights(float degrees, int side) {
  const glm::vec3 towards = lightFrom(degrees).direction;
  const glsl::Frame frame = glsl::frame_around(towards);
  const float piece = 0.6f / float(side);
  std::vector<glsl::IncidentLight> lights;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const glm::vec2 at =
          0.6f * ((glm::vec2(float(i), float(j)) + glm::vec2(0.5f)) / float(side) - glm::vec2(0.5f));
      const glsl::SampleSender sender{towards + at.x * frame.t + at.y * frame.b, piece * piece,
                                      piece * frame.t, glsl::vertex_pack_normal(-towards)};
      lights.push_back(glsl::incident_light(sender, glm::vec3(1), glm::vec3(0)));
    }
  return lights;
}

inline GlossyLobes lobesOf(float roughness, const std::vector<glsl::IncidentLight>& lights, float widen = 0) {
  GlossyLobes lobes;
  lobes.set(metal(roughness), lights, widen);
  return lobes;
}

inline TreeBuilder::Function radianceOf(const GlossyLobes& lobes) {
  return [&lobes](const glm::vec3& w) { return lobes.radiance(w); };
}

/// The relative L2 error over the hemisphere, weighted by the cosine.
inline double errorOf(const TreeBuilder::Function& tree, const TreeBuilder::Function& truth, int n) {
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
inline double errorOf(const DirectionalTree& tree, const GlossyLobes& lobes, int n = 256) {
  return errorOf([&](const glm::vec3& w) { return tree.value(w); }, radianceOf(lobes), n);
}

/// What is not refined.
inline TreeSettings uniformBasis(int level) {
  return {.basis = TreeSettings::Basis::uniform, .maxLevel = level};
}
inline TreeSettings levelOnly(int level) {
  return {.minLevel = level, .maxLevel = level, .frozen = false};
}

/// A tree with cells of many sizes.
inline DirectionalTree glossyTree(float roughness = 0.3f) {
  TreeBuilder builder;
  DirectionalTree tree;
  builder.build(lobesOf(roughness, {lightFrom(20), lightFrom(60, {2, 1, 0.5f})}), {}, tree);
  return tree;
}

}  // namespace limn::radiosity
