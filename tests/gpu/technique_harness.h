// Runs one technique on a scene and reads what it answers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "core/render/services.h"
#include "core/scene/camera.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/registry.h"
#include "core/technique/technique.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/paths.h"

namespace limn::test {

struct Answer {
  int width = 0, height = 0;
  std::vector<float> depth;  ///< linear view depth, row 0 at the bottom
  std::vector<uint32_t> instance;
  std::vector<std::vector<float>> lights;  ///< V per light, or one layer of radiance
  uint32_t uncovered = 0;
  std::vector<std::string> passes;  ///< of the technique that ran
  std::vector<shadow::ShadowMapStats> maps;
  float at(size_t light, int x, int y) const {
    return lights[light][static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
};

/// Where a pixel of an answer lies in the world, m, on the surface that `camera` sees there. `bounds`: the
/// scene's.
inline glm::vec3 positionOf(const Answer& v, const scene::CameraPose& camera, const scene::Bounds& bounds,
                            int x, int y) {
  glsl::FrameBlock frame{};
  scene::setCamera(frame, camera, bounds, v.width, v.height);
  return glm::vec3(frame.camera_position) +
         v.depth[static_cast<size_t>(y * v.width + x)] *
             (glm::vec3(frame.view_ray_origin) + static_cast<float>(x) * glm::vec3(frame.view_ray_dx) +
              static_cast<float>(y) * glm::vec3(frame.view_ray_dy));
}

class TechniqueTest : public OncePerRenderer<SharedProgramsTest> {
 protected:
  static constexpr int side = 128;
  bool bound = false;  ///< the technique's bound answers in its place, where it has one
  int drawn = side;    ///< width and height of pictures; floorErrors() looks at those of `side`

  static TechniqueRegistry& registry() {
    static const std::filesystem::path folder = std::filesystem::path(kBinaryDir) / "lib/limn/techniques";
    static TechniqueRegistry instance(std::span(&folder, 1));
    return instance;
  }

  /// V of the lights (all of the pose's if none are named), or the red channel of their reflected radiance.
  Answer visibility(const std::string& technique, const std::map<std::string, std::string>& settings,
                    const scene::Scene& scene, const scene::Pose& pose, const scene::CameraPose& camera,
                    std::vector<uint32_t> lights = {}, Term term = Term::visibility) {
    const TechniquePlugin& plugin = registry().find(technique);
    ParameterValues parameters(technique, plugin.info->parameters);
    for (const auto& [name, value] : settings) parameters.set(name, value);
    shaders().mount("techniques/" + technique + "/", plugin.sources());
    if (lights.empty()) {
      for (uint32_t i = 0; i < pose.lights.size(); ++i) lights.push_back(i);
    }

    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, camera, {drawn, drawn}, 0);
    FrameServices services = render::makeServices(device(), gpuScene);
    frame::ResourcePool pool(device());
    scene::GBufferPass gbufferPass;
    frame::FrameGraph graph;
    const SceneHandles handles = gpuScene.import(graph);
    const GBuffer gbuffer = gbufferPass.add(graph, gpuScene, handles, {drawn, drawn});
    const auto building = services.begin(graph, handles, pose);
    const auto instance = plugin.create();
    const TechniqueInputs inputs{.scene = scene,
                                 .pose = pose,
                                 .gpuScene = gpuScene,
                                 .services = services,
                                 .parameters = parameters,
                                 .handles = handles,
                                 .gbuffer = gbuffer,
                                 .size = {drawn, drawn},
                                 .bound = bound};
    const frame::TextureHandle target =
        term == Term::visibility ? visibilityTarget(graph, lights.size()) : black(graph);
    const frame::TextureHandle written =
        instance->addPasses(graph, inputs, {.term = term, .lights = lights, .target = target});
    graph.output(written);
    graph.output(gbuffer.depth);
    graph.output(gbuffer.instance);
    graph.prepare(device(), shaders(), pool);
    graph.execute();

    Answer result;
    result.width = result.height = drawn;
    const auto pixels = static_cast<size_t>(drawn * drawn);
    result.depth.resize(pixels);
    result.instance.resize(pixels);
    const size_t layerCount = term == Term::visibility ? lights.size() : 1;
    std::vector<float> layers(layerCount * pixels);
    graph.texture(gbuffer.depth).read(0, GL_RED, GL_FLOAT, result.depth.data(), result.depth.size() * 4);
    graph.texture(gbuffer.instance)
        .read(0, GL_RED_INTEGER, GL_UNSIGNED_INT, result.instance.data(), result.instance.size() * 4);
    graph.texture(written).read(0, GL_RED, GL_FLOAT, layers.data(), layers.size() * 4);
    for (size_t l = 0; l < layerCount; ++l) {
      const auto first = layers.begin() + static_cast<std::ptrdiff_t>(l * pixels);
      result.lights.emplace_back(first, first + static_cast<std::ptrdiff_t>(pixels));
    }
    for (const frame::PassReport& pass : graph.explain())
      if (pass.technique == technique && pass.state == frame::PassState::run)
        result.passes.push_back(pass.name);
    const auto& maps = services.get<shadow::ShadowMapService>();
    result.uncovered = maps.uncoveredPixels();
    result.maps = maps.stats();
    gpuScene.forget();
    return result;
  }

 private:
  frame::TextureHandle visibilityTarget(frame::FrameGraph& graph, size_t lights) const {
    return graph.createTexture("visibility", {.target = GL_TEXTURE_2D_ARRAY,
                                              .format = GL_R16,
                                              .width = drawn,
                                              .height = drawn,
                                              .layers = static_cast<int>(lights)});
  }

  /// A radiance to add to.
  frame::TextureHandle black(frame::FrameGraph& graph) const {
    frame::PassBuilder clear = graph.addPass("clear", "test");
    const frame::TextureHandle target =
        clear.write(graph.createTexture("radiance", {.format = GL_RGBA32F, .width = drawn, .height = drawn}),
                    frame::Access::copyTarget, "black");
    clear.execute([target](frame::PassContext& context) {
      context.gl().ClearTexImage(context.texture(target).id(), 0, GL_RGBA, GL_FLOAT, nullptr);
    });
    return target;
  }
};

}  // namespace limn::test
