// Fixture for tests of the environment's light: small skies, a floor below them, and the reference.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/reference/reference.h"
#include "core/scene/material_model.h"
#include "core/shading/environment_decomposition.h"
#include "tests/gpu/render_test.h"
#include "tests/support/environment_maps.h"

namespace limn {

class EnvironmentTest : public RenderTest {
 protected:
  /// Techniques that sample the environment and leave the scene's own lights to others.
  static std::vector<std::string> environmentTechniques() {
    std::vector<std::string> names;
    for (const std::string& name : techniquesAnswering(Term::environment))
      if (registry().find(name).info->terms == termSet(Term::environment)) names.push_back(name);
    return names;
  }

  /// Returns one of them with that number of samples, at every pixel; it converges as they grow.
  static render::TechniqueUse sampled(const std::string& name, int samples) {
    const std::string count = std::to_string(samples);
    if (name == "subtractive_shadows")
      return technique(name, {{"lights", count}, {"block", "1"}, {"unshadowed", "lights"}});
    return technique(name, {{"samples", count}});
  }

  /// Those of them that shadow it: they render shadow maps.
  static std::vector<std::string> shadowingTechniques() {
    std::vector<std::string> names = environmentTechniques();
    std::erase_if(names, [](const std::string& name) {
      return std::ranges::none_of(registry().find(name).info->parameters, [](const Parameter& p) {
        return std::string_view(p.name) == "shadow_map_size";
      });
    });
    return names;
  }

  /// A bluish sky with a soft sun, a window's worth of light from one side, and a dark ground.
  static scene::Environment sky() {
    const glm::vec3 sun = glm::normalize(glm::vec3(0.5f, 0.8f, 0.4f));
    return test::environmentOf(128, [&](const glm::vec3& d) {
      glm::vec3 radiance = d.y > 0 ? glm::vec3(0.3f, 0.4f, 0.6f) : glm::vec3(0.1f);
      if (glm::dot(d, sun) > 0.98f) radiance += glm::vec3(20, 18, 15);
      if (d.x < -0.8f && std::abs(d.y) < 0.3f) radiance += glm::vec3(3);
      return radiance;
    });
  }

  static scene::Environment uniform(float radiance) {
    scene::Environment e;
    e.width = 32;
    e.height = 16;
    e.texels.assign(32 * 16, glm::vec3(radiance));
    return e;
  }

  /// Without lights of its own, and with an environment in up to about `threshold` lights (0: not
  /// decomposed).
  static scene::Scene lit(scene::Scene scene, scene::Environment environment, double threshold) {
    for (scene::Node& node : scene.nodes) node.light = scene::kNone;
    scene.environment = std::move(environment);
    if (threshold > 0)
      scene.environment.lights =
          shading::decomposeEnvironment(scene.environment, {.threshold = threshold, .resolution = 24}).lights;
    return scene;
  }

  /// A white Lambertian floor that fills the picture.
  static scene::Scene floor() {
    scene::Scene scene;
    scene::Material material;
    material.metallic = 0;
    material.specularFactor = 0;
    scene.materials.push_back(material);
    scene::Primitive p;
    p.positions = {{-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}};
    p.normals.assign(4, {0, 1, 0});
    p.indices = {0, 1, 2, 0, 2, 3};
    p.material = 0;
    for (const glm::vec3& v : p.positions) p.bounds.add(v);
    scene.meshes.push_back({"floor", {p}, {}});
    scene::Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene::Node camera;
    camera.camera = 0;
    camera.transform.translation = {0, 4, 0};
    camera.transform.rotation = glm::angleAxis(-0.5f * glsl::pi, glm::vec3(1, 0, 0));
    scene.cameras.emplace_back();
    scene.nodes.push_back(camera);
    return scene;
  }
  /// A floor of a body that light enters.
  static scene::Scene translucentFloor() {
    scene::Scene scene = floor();
    scene::Material& body = scene.materials.front();
    body.specularFactor = 1;
    body.subsurface = scene::Subsurface{.extinction = glm::vec3(1e6f), .absorption = glm::vec3(0.1f)};
    return scene;
  }
  /// Puts a roof over the floor that hides all of the sky.
  static scene::Scene roofed(scene::Scene scene) {
    scene::Node roof;
    roof.mesh = 0;
    roof.transform.translation = {0, 6, 0};
    scene.nodes.push_back(roof);
    return scene;
  }
  /// A floor that is a perfect mirror.
  static scene::Scene mirror() {
    scene::Scene scene = floor();
    glsl::MaterialModel model{};
    model.kind = glsl::model_coated;
    model.eta = glm::vec3(1e-3f);
    model.k = glm::vec3(1000);
    scene::setModel(scene.materials.front(), model);
    return scene;
  }

  static Image reference(const scene::Scene& scene, const render::Settings& s, int spp) {
    return referenceWithNoise(scene, s, spp).select({"R", "G", "B"});
  }
  /// With all of its channels, the variance of each pixel among them.
  static Image referenceWithNoise(const scene::Scene& scene, const render::Settings& s, int spp) {
    const scene::Pose pose = scene::evaluate(scene, 0);
    reference::Request asked = test::request(scene, pose, pose.cameras.at(0), s.size, s.term, spp);
    asked.light = s.light < 0 ? reference::kAllLights : s.light;
    return reference::render(asked).image;
  }
};

}  // namespace limn
