// The translucent scenes as written to disk: coefficients as published, sizes in mean distances, closed
// bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/scene_io/load.h"
#include "glsl/diffusion/dipole.glsl"
#include "tests/support/glb.h"

namespace limn::test {
namespace {

constexpr const char* kTranslucent[] = {"marble_statue",       "milk",
                                        "translucent_checker", "translucent_ear",
                                        "translucent_edge",    "translucent_head",
                                        "translucent_spheres"};

scene::Scene sceneOf(const std::string& name) {
  return scene::load(kAssets / name / (name + ".glb"));
}

const scene::Material& materialOf(const scene::Scene& scene, const std::string& name) {
  for (const scene::Material& material : scene.materials)
    if (material.name == name) return material;
  ADD_FAILURE() << "no material " << name;
  return scene.materials.at(0);
}

const scene::Primitive& bodyOf(const scene::Scene& scene) {
  for (const scene::Mesh& mesh : scene.meshes)
    for (const scene::Primitive& primitive : mesh.primitives)
      if (scene.materials[static_cast<std::size_t>(primitive.material)].subsurface) return primitive;
  ADD_FAILURE() << "nothing is translucent";
  return scene.meshes.at(0).primitives.at(0);
}

/// Mean distance between where light enters a half space and where it leaves, metres: the integral of
/// 2 pi r^2 Rd / C over ln r, from 1e-4 to 1e4 mean free paths.
double meanDistance(const scene::Material& material, int channel) {
  const scene::Subsurface& s = *material.subsurface;
  const glsl::DiffusionDipole dipole =
      glsl::diffusion_dipole(s.absorption[channel], glsl::diffusion_boundary(material.ior));
  constexpr int steps = 4000;
  const double step = std::log(1e8) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double r = 1e-4 * std::exp((i + 0.5) * step);
    sum += 2 * glm::pi<double>() * r * r * r * step *
           double(glsl::diffusion_dipole_density(dipole, static_cast<float>(r)));
  }
  return sum / double(s.extinction[channel]);
}

/// Per millimetre, as the table of Jensen et al. 2001 has them.
void expectCoefficients(const scene::Material& material, glm::vec3 scattering, glm::vec3 absorption,
                        float ior) {
  ASSERT_TRUE(material.subsurface) << material.name;
  EXPECT_EQ(material.ior, ior) << material.name;
  for (int c = 0; c < 3; ++c) {
    const float extinction = 1000 * (scattering[c] + absorption[c]);
    EXPECT_NEAR(material.subsurface->extinction[c] / extinction, 1, 1e-6) << material.name << c;
    EXPECT_NEAR(material.subsurface->absorption[c] * extinction / (1000 * absorption[c]), 1, 1e-6)
        << material.name << c;
  }
}

TEST(TranslucentScenes, HaveThePublishedCoefficients) {
  for (const char* name : {"translucent_edge", "translucent_ear", "translucent_head"})
    expectCoefficients(materialOf(sceneOf(name), "skin"), {0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f},
                       1.3f);
  expectCoefficients(materialOf(sceneOf("marble_statue"), "marble"), {2.19f, 2.62f, 3},
                     {0.0021f, 0.0041f, 0.0071f}, 1.5f);
  expectCoefficients(materialOf(sceneOf("milk"), "milk"), {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f},
                     1.3f);
  const scene::Scene checker = sceneOf("translucent_checker");
  const scene::Material& board = materialOf(checker, "board");
  EXPECT_TRUE(board.subsurface->albedoFromBaseColour);
  EXPECT_NEAR(board.subsurface->extinction.x, 2192.1, 0.01);
}

/// Each is one draw: bodies that touch would be one for a walk, and two for a profile over a body.
TEST(TranslucentScenes, DrawEachMaterialOnce) {
  for (const char* name : kTranslucent) {
    const scene::Scene scene = sceneOf(name);
    std::vector<int> draws(scene.materials.size(), 0);
    for (const scene::DrawInstance& instance : scene::evaluate(scene, 0).instances) {
      const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
      const int material = mesh.primitives[static_cast<std::size_t>(instance.primitive)].material;
      ++draws[static_cast<std::size_t>(material)];
    }
    int translucent = 0;
    for (std::size_t i = 0; i < draws.size(); ++i) {
      if (!scene.materials[i].subsurface) continue;
      EXPECT_EQ(draws[i], 1) << name << " " << scene.materials[i].name;
      ++translucent;
    }
    EXPECT_EQ(translucent, name == std::string("translucent_spheres") ? 5 : 1) << name;
  }
}

/// With vertices at one place taken as one, every edge is run through as often in one direction as in the
/// other.
TEST(TranslucentScenes, BodiesAreClosed) {
  using Place = std::array<float, 3>;
  for (const char* name : kTranslucent) {
    const scene::Scene scene = sceneOf(name);
    for (const scene::Mesh& mesh : scene.meshes) {
      const scene::Primitive& body = mesh.primitives.at(0);
      if (!scene.materials[static_cast<std::size_t>(body.material)].subsurface) continue;
      std::map<std::pair<Place, Place>, int> edges;
      for (std::size_t i = 0; i < body.indices.size(); ++i) {
        const auto place = [&](std::size_t k) {
          const glm::vec3 p = body.positions[body.indices[k]] + 0.f;  // -0 is 0
          return Place{p.x, p.y, p.z};
        };
        const Place from = place(i), to = place(i % 3 == 2 ? i - 2 : i + 1);
        ++edges[{from, to}];
        --edges[{to, from}];
      }
      const auto open = std::ranges::count_if(edges, [](const auto& edge) { return edge.second != 0; });
      EXPECT_EQ(open, 0) << name << ", of " << edges.size();
    }
  }
}

TEST(TranslucentScenes, SpheresHaveTheRadiiTheyAreNamedFor) {
  const scene::Scene scene = sceneOf("translucent_spheres");
  const scene::Primitive& ball = bodyOf(scene);
  float radius = 0;
  for (const glm::vec3& p : ball.positions) radius = std::max(radius, glm::length(p));
  for (const int reaches : {1, 3, 10, 30, 100}) {
    const scene::Material& material = materialOf(scene, "radius " + std::to_string(reaches));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(double(radius) / meanDistance(material, c) / reaches, 1, 2e-3)
          << reaches << " channel " << c;
  }
}

/// At 192 rows, the mean distance of the channel with the least is at least 3 pixels.
TEST(TranslucentScenes, TheEdgeIsSeenFromNearEnough) {
  const scene::Scene scene = sceneOf("translucent_edge");
  const scene::CameraPose camera = scene::evaluate(scene, 0).cameras.at(0);
  const float height = glm::inverse(camera.worldToView)[3].y;
  const double pixel = 2.0 * height * std::tan(0.5 * double(camera.yfov)) / 192;
  const scene::Material& skin = materialOf(scene, "skin");
  EXPECT_NEAR(meanDistance(skin, 0), 3.0e-3, 0.05e-3);
  EXPECT_NEAR(meanDistance(skin, 1), 1.4e-3, 0.05e-3);
  EXPECT_GE(meanDistance(skin, 2), 3 * pixel);
}

/// From the front to the nearest place of the back, along the middle. Vertices lie up to half a cell of 0.8
/// mm aside of the nearest place, and the ear is bent.
TEST(TranslucentScenes, TheEarIsTwoToTenMillimetresThick) {
  const scene::Scene scene = sceneOf("translucent_ear");
  const scene::Primitive& ear = bodyOf(scene);
  for (const float height : {-0.024f, -0.012f, 0.f, 0.012f, 0.024f}) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < ear.positions.size(); ++i) {
      const glm::vec3& front = ear.positions[i];
      if (ear.normals[i].z < 0.5f || std::abs(front.y - height) > 0.001f || std::abs(front.x) > 0.002f)
        continue;
      float nearest = std::numeric_limits<float>::max();
      for (std::size_t j = 0; j < ear.positions.size(); ++j)
        if (ear.normals[j].z < -0.5f) nearest = std::min(nearest, glm::distance(front, ear.positions[j]));
      sum += double(nearest);
      ++count;
    }
    ASSERT_GT(count, 0) << height;
    EXPECT_NEAR(sum / count, 0.006 - 0.004 * double(height) / 0.032, 0.0005) << height;
  }
}

}  // namespace
}  // namespace limn::test
