// Energy balance: what the lamp of a closed room emits is what its surfaces absorb.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/scene_io/load.h"
#include "tests/support/paths.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

constexpr float kAlbedoOfBlack = 0.02f;  ///< what absorbs has to reflect a little, to be measured

/// The Cornell box behind a dark window, its lamp right under the ceiling, so that no light ends on its back.
World closedCornellBox() {
  World world;
  const auto assets = std::filesystem::path(limn::test::kBinaryDir) / "assets";
  world.scene = scene::load(assets / "cornell_box" / "cornell_box.glb");
  for (auto& material : world.scene.materials)
    material.baseColour = glm::max(material.baseColour, glm::vec4(kAlbedoOfBlack));
  for (auto& mesh : world.scene.meshes) {
    scene::Primitive& lamp = mesh.primitives[0];
    if (lamp.emissiveParts.empty()) continue;
    scene::Quad& quad = lamp.emissiveParts[0].quad;
    const float up = 2 - 1e-3f - quad.centre.y;
    quad.centre.y += up;
    for (auto& p : lamp.positions) p.y += up;
  }
  const int mesh = world.addMesh(
      World::quad({0, 1, 1}, {0, 2, 0}, {2, 0, 0}, world.addMaterial(glm::vec3(kAlbedoOfBlack))));
  scene::Node& window = world.scene.nodes.emplace_back();
  window.mesh = mesh;
  world.pose = scene::evaluate(world.scene, 0);
  return world;
}

/// Radiance that leaves a triangle's place `p` along its normal, without emission.
glm::dvec3 reflected(World& world, const glm::vec3& p, const glm::vec3& n, const scene::Material& material,
                     int number) {
  world.camera = scene::lookAt(p + 1e-4f * n, p, 0.5f);
  Request request = world.request(1, Term::final, 128);
  request.bounces = 40;
  request.seed = static_cast<uint64_t>(number);  // each place has random numbers of its own
  const Image image = render(request).image;
  return glm::dvec3(image.at(0, 0, 0), image.at(0, 0, 1), image.at(0, 0, 2)) - glm::dvec3(material.emission);
}

TEST(ReferenceEnergy, CornellBoxAbsorbsWhatItsLampEmits) {
  World world = closedCornellBox();
  glm::dvec3 absorbed(0), emitted(0);
  int at = 0;
  for (const scene::DrawInstance& instance : world.pose.instances) {
    const auto& primitive = world.scene.meshes[static_cast<size_t>(instance.mesh)].primitives[0];
    const auto& material = world.scene.materials[static_cast<size_t>(primitive.material)];
    const glm::dvec3 albedo{glm::vec3(material.baseColour)};
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
      glm::vec3 p[3];
      for (size_t k = 0; k < 3; ++k)
        p[k] =
            glm::vec3(instance.objectToWorld * glm::vec4(primitive.positions[primitive.indices[i + k]], 1));
      const glm::vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
      const double area = 0.5 * static_cast<double>(glm::length(across));
      emitted += M_PI * area * glm::dvec3(material.emission);
      const int points = std::max(8, static_cast<int>(200 * area));
      for (int k = 0; k < points; ++k) {
        // Two irrational steps (Roberts 2018, R2), folded into the triangle.
        ++at;
        double u = std::fmod(0.5 + 0.7548776662466927 * at, 1.0),
               v = std::fmod(0.5 + 0.5698402909980532 * at, 1.0);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::vec3 x =
            p[0] + static_cast<float>(u) * (p[1] - p[0]) + static_cast<float>(v) * (p[2] - p[0]);
        // Lambert: the irradiance is pi L / albedo.
        absorbed += (1.0 - albedo) / albedo * M_PI *
                    reflected(world, x, glm::normalize(across), material, at) * area /
                    static_cast<double>(points);
      }
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(absorbed[c] / emitted[c], 1, 0.01) << c;
}

}  // namespace
}  // namespace limn::reference
