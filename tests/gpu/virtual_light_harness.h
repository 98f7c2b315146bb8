// Fixture for tests of virtual point lights, which samples those of a scene.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "core/indirect/virtual_lights.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {

class VirtualLightTest : public OncePerRenderer<SharedProgramsTest> {
 protected:
  static constexpr float kPi = glsl::pi;
  static constexpr glm::vec3 colour{0.2f, 0.5f, 0.8f};

  struct Sampled {
    std::vector<glsl::VirtualPointLight> lights;
    glm::vec3 flux{0};       ///< of the lights together
    glm::vec3 reflected{0};  ///< by the maps
  };

  static scene::Material lambert(const glm::vec3& albedo) {
    scene::Material m;
    m.baseColour = glm::vec4(albedo, 1);
    m.metallic = 0;
    m.specularFactor = 0;
    return m;
  }

  Sampled sample(const scene::Scene& scene, const scene::Pose& pose, const indirect::VirtualLightDesc& desc) {
    std::vector<uint32_t> all(pose.lights.size());
    std::iota(all.begin(), all.end(), 0u);
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
    FrameServices services;
    services.add<shadow::ShadowMapService>(device(), gpuScene);
    auto& service = services.add<indirect::VirtualLightService>(scene);
    frame::ResourcePool pool(device());
    frame::FrameGraph graph;
    const SceneHandles handles = gpuScene.import(graph);
    const auto building = services.begin(graph, handles, pose);
    const indirect::VirtualLights made = service.request(all, desc);
    EXPECT_EQ(service.request(all, desc).lights, made.lights) << "made once whoever asks";
    graph.output(made.lights);
    graph.output(made.reflected);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    Sampled out;
    out.lights.resize(static_cast<size_t>(desc.count));
    graph.buffer(made.lights).read(0, out.lights.data(), out.lights.size() * sizeof(out.lights[0]));
    std::vector<glm::vec4> layers(static_cast<size_t>(made.maps.layers));
    graph.buffer(made.reflected).read(0, layers.data(), layers.size() * sizeof(layers[0]));
    for (const glm::vec4& layer : layers) out.reflected += glm::vec3(layer);
    for (const glsl::VirtualPointLight& light : out.lights) {
      out.flux += glm::vec3(light.flux);
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(glm::vec3(light.flux), glm::vec3(0))));
      EXPECT_NEAR(glm::length(light.normal), 1, 1e-4f);
      EXPECT_FALSE(glm::any(glm::isnan(light.position)));
    }
    gpuScene.forget();
    return out;
  }

  static void expectFlux(const Sampled& s, glm::vec3 expected, float tolerance) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(s.reflected[c], expected[c], tolerance * expected[c]) << "maps, channel " << c;
      EXPECT_NEAR(s.flux[c], s.reflected[c], 1e-4f * s.reflected[c]) << "virtual lights, channel " << c;
    }
  }

  /// A box of side 2 that faces inwards.
  static void addBox(scene::Scene& scene, scene::Pose& pose, int material) {
    const int mesh = test::addMesh(scene, test::floorPrimitive(1, material));
    for (const auto& [angle, axis] :
         {std::pair(0.f, glm::vec3(1, 0, 0)), std::pair(kPi, glm::vec3(1, 0, 0)),
          std::pair(0.5f * kPi, glm::vec3(1, 0, 0)), std::pair(-0.5f * kPi, glm::vec3(1, 0, 0)),
          std::pair(0.5f * kPi, glm::vec3(0, 0, 1)), std::pair(-0.5f * kPi, glm::vec3(0, 0, 1))}) {
      const glm::mat4 turn = glm::rotate(glm::mat4(1), angle, axis);
      test::addInstance(scene, pose, mesh, turn * glm::translate(glm::mat4(1), {0, -1, 0}));
    }
  }
};

}  // namespace limn
