// Scenes and pictures of subtractive shadows.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/material_model.h"
#include "glsl/materials/material_model.glsl"
#include "tests/gpu/environment_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {

class SubtractiveShadowsTest : public EnvironmentTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  /// With the unshadowed light that core has, unless the values say otherwise.
  static render::TechniqueUse shadows(const Values& values) {
    Values all{{"unshadowed", "prefiltered"}};
    all.insert(all.end(), values.begin(), values.end());
    return technique("subtractive_shadows", all);
  }
  /// With maps of 128 texels a side in place of 512, and 16 MiB of memory for them in place of 256, so that
  /// batches hold as many as by default: for laws that hold whatever maps show.
  static render::TechniqueUse smallShadows(const Values& values) {
    Values all{{"shadow_map_size", "128"}, {"memory", "16"}};
    all.insert(all.end(), values.begin(), values.end());
    return shadows(all);
  }
  Image direct(render::Renderer& renderer, int width, int height,
               std::vector<render::TechniqueUse> techniques = {}) {
    return picture(renderer, settings(width, height, Term::direct, std::move(techniques)));
  }

  /// The same floor in the middle of a closed room of 20 m, whose walls are seen as well.
  static scene::Scene room() {
    scene::Scene scene = floor();
    const auto wall = [&](const glm::quat& turn, const glm::vec3& middle) {
      scene::Node node;
      node.mesh = 0;
      node.transform.rotation = turn;
      node.transform.translation = middle;
      scene.nodes.push_back(node);
    };
    constexpr float right = 0.5f * glsl::pi;
    wall(glm::angleAxis(2 * right, glm::vec3(1, 0, 0)), {0, 20, 0});
    wall(glm::angleAxis(right, glm::vec3(1, 0, 0)), {0, 10, -10});
    wall(glm::angleAxis(-right, glm::vec3(1, 0, 0)), {0, 10, 10});
    wall(glm::angleAxis(right, glm::vec3(0, 0, 1)), {10, 10, 0});
    wall(glm::angleAxis(-right, glm::vec3(0, 0, 1)), {-10, 10, 0});
    return scene;
  }

  /// Gives the half of the floor on the side of -x another material.
  static scene::Scene halved(scene::Scene scene, const scene::Material& other) {
    scene::Primitive near = scene.meshes[0].primitives[0], far = near;
    near.positions[1].x = near.positions[2].x = far.positions[0].x = far.positions[3].x = 0;
    for (scene::Primitive* half : {&near, &far}) {
      half->bounds = {};
      for (const glm::vec3& v : half->positions) half->bounds.add(v);
    }
    near.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(other);
    scene.nodes[0].mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back({"halves of the floor", {near, far}, {}});
    return scene;
  }
  static scene::Material lambertian(const glm::vec4& colour) {
    scene::Material material;
    material.baseColour = colour;
    material.metallic = material.specularFactor = 0;
    return material;
  }
  /// A grey base under a perfect mirror, which adds all of the light to it.
  static scene::Material mirrored() {
    glsl::MaterialModel model{};
    model.kind = glsl::model_coated;
    model.eta = glm::vec3(1e-3f);
    model.k = glm::vec3(1000);
    model.kd = glm::vec3(0.5f);
    scene::Material material;
    scene::setModel(material, model);
    return material;
  }

  /// A metal ball of radius 1 around the origin instead of the floor, seen from above.
  static scene::Scene ball(const glm::vec4& colour, float roughness) {
    scene::Scene scene = floor();
    scene.materials[0] = metal(colour, roughness);
    scene.meshes[0].primitives[0] = test::spherePrimitive(1, 0);
    return scene;
  }
  static scene::Material metal(const glm::vec4& colour, float roughness) {
    scene::Material material;
    material.baseColour = colour;
    material.metallic = 1;
    material.roughness = roughness;
    return material;
  }

  static double largestDifference(const Image& a, const Image& b) {
    double largest = 0;
    for (size_t i = 0; i < a.data().size(); ++i) {
      const auto difference = static_cast<double>(std::abs(a.data()[i] - b.data()[i]));
      if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, difference);
    }
    return largest;
  }
  static double largest(const Image& image) {
    return static_cast<double>(*std::ranges::max_element(image.data()));
  }
};

}  // namespace limn
