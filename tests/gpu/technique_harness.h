// Runs one technique on a scene and reads what it answers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/scene/gpu_scene.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/registry.h"
#include "core/technique/technique.h"
#include "tests/gpu/gl_test.h"

namespace limn::test {

struct Visibility {
  int width = 0, height = 0;
  std::vector<float> depth;  ///< linear view depth, row 0 at the bottom
  std::vector<uint32_t> instance;
  std::vector<std::vector<float>> lights;  ///< V per light
  uint32_t uncovered = 0;
  float at(size_t light, int x, int y) const {
    return lights[light][static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
};

class TechniqueTest : public GlTest {
 protected:
  static constexpr int side = 128;

  static TechniqueRegistry& registry() {
    static const std::filesystem::path folder =
        std::filesystem::path(LIMN_BINARY_DIR) / "lib/limn/techniques";
    static TechniqueRegistry instance(std::span(&folder, 1));
    return instance;
  }

  Visibility visibility(const std::string& technique, const std::map<std::string, std::string>& settings,
                        const scene::Scene& scene, const scene::Pose& pose, const scene::CameraPose& camera,
                        std::vector<uint32_t> lights = {}) {
    const TechniquePlugin& plugin = registry().find(technique);
    ParameterValues parameters(technique, plugin.info->parameters);
    for (const auto& [name, value] : settings) parameters.set(name, value);
    shaders().mount("techniques/" + technique + "/", plugin.sources());
    if (lights.empty()) {
      for (uint32_t i = 0; i < pose.lights.size(); ++i) lights.push_back(i);
    }

    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, camera, {side, side}, 0);
    shadow::ShadowMapService shadowMaps(device(), gpuScene);
    frame::ResourcePool pool(device());
    scene::GBufferPass gbufferPass;
    frame::FrameGraph graph;
    const SceneHandles handles = gpuScene.import(graph);
    const GBuffer gbuffer = gbufferPass.add(graph, gpuScene, handles, {side, side});
    shadowMaps.begin(graph, handles, pose);
    const auto instance = plugin.create();
    const TechniqueInputs inputs{scene,      pose,    gpuScene, shadowMaps,
                                 parameters, handles, gbuffer,  {side, side}};
    const frame::TextureHandle target =
        graph.createTexture("visibility", {.target = GL_TEXTURE_2D_ARRAY,
                                           .format = GL_R16,
                                           .width = side,
                                           .height = side,
                                           .layers = static_cast<int>(lights.size())});
    const frame::TextureHandle answer =
        instance->addPasses(graph, inputs, {.term = Term::visibility, .lights = lights, .target = target});
    graph.output(answer);
    graph.output(gbuffer.depth);
    graph.output(gbuffer.instance);
    graph.prepare(device(), shaders(), pool);
    shadowMaps.update(pose);
    graph.execute();

    Visibility result{.width = side, .height = side};
    result.depth.resize(side * side);
    result.instance.resize(side * side);
    std::vector<float> layers(lights.size() * side * side);
    graph.texture(gbuffer.depth).read(0, GL_RED, GL_FLOAT, result.depth.data(), result.depth.size() * 4);
    graph.texture(gbuffer.instance)
        .read(0, GL_RED_INTEGER, GL_UNSIGNED_INT, result.instance.data(), result.instance.size() * 4);
    graph.texture(answer).read(0, GL_RED, GL_FLOAT, layers.data(), layers.size() * 4);
    for (size_t l = 0; l < lights.size(); ++l) {
      const auto first = layers.begin() + static_cast<std::ptrdiff_t>(l * side * side);
      result.lights.emplace_back(first, first + side * side);
    }
    result.uncovered = shadowMaps.uncoveredPixels();
    gpuScene.forget();
    return result;
  }
};

}  // namespace limn::test
