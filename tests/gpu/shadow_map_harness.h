// Shadow maps of small scenes, and what a renderer has of a scene while it asks for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/camera.h"
#include "core/shadow/shadow_map.h"
#include "tests/gpu/gl_test.h"

namespace limn {

class ShadowMapTest : public GlTest {
 protected:
  static constexpr int kTexels = 128;

  /// Shadow maps on the CPU.
  struct Maps {
    std::vector<glsl::ShadowView> views;
    std::vector<glsl::ShadowLight> lights;
    std::vector<shadow::ShadowMapStats> stats;
    std::vector<float> depth;
    int size = 0;

    float stored(int layer, int x, int y) const {
      return depth[(static_cast<size_t>(layer) * static_cast<size_t>(size) + static_cast<size_t>(y)) *
                       static_cast<size_t>(size) +
                   static_cast<size_t>(x)];
    }
    /// Offset of what a texel sees from its view's origin, in world axes.
    glm::vec3 seen(int layer, int x, int y) const {
      const glsl::ShadowView& view = views[static_cast<size_t>(layer)];
      return glsl::shadow_world_offset(view, glsl::shadow_texel_offset(view, {x, y}, stored(layer, x, y)));
    }
  };

  /// Holds what a renderer has of a scene while it asks for shadow maps and executes their graph.
  struct Asking {
    scene::GpuScene gpuScene;
    FrameServices services;
    shadow::ShadowMapService& service;
    frame::ResourcePool pool;
    frame::FrameGraph graph;
    FrameServices::Building building;

    Asking(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose,
           const scene::CameraPose& camera)
        : gpuScene(device, scene),
          service(services.add<shadow::ShadowMapService>(device, gpuScene)),
          pool(device),
          building(begin(pose, camera)) {}
    ~Asking() { gpuScene.forget(); }

   private:
    FrameServices::Building begin(const scene::Pose& pose, const scene::CameraPose& camera) {
      gpuScene.update(pose, camera, {64, 64}, 0);
      return services.begin(graph, gpuScene.import(graph), pose);
    }
  };

  Maps draw(const scene::Scene& scene, const scene::Pose& pose, std::vector<uint32_t> lights,
            const shadow::ShadowMapDesc& desc) {
    Asking asking(device(), scene, pose, scene::frameBounds(pose.bounds));
    const shadow::ShadowMaps maps = asking.service.request(lights, desc);
    asking.graph.output(maps.depth);
    asking.graph.prepare(device(), shaders(), asking.pool);
    asking.graph.execute();
    Maps out;
    out.size = desc.size;
    out.stats = asking.service.stats();
    out.views.resize(static_cast<size_t>(maps.layers));
    out.depth.resize(static_cast<size_t>(maps.layers * desc.size * desc.size));
    const gpu::Buffer& views = asking.graph.buffer(maps.views);
    views.read(0, out.views.data(), views.size());
    const gpu::Buffer& shadowLights = asking.graph.buffer(maps.lights);
    out.lights.resize(shadowLights.size() / sizeof(glsl::ShadowLight));
    shadowLights.read(0, out.lights.data(), shadowLights.size());
    asking.graph.texture(maps.depth)
        .read(0, GL_RED, GL_FLOAT, out.depth.data(), out.depth.size() * sizeof(float));
    return out;
  }
};

}  // namespace limn
