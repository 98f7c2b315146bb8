// Fixture for tests of scenes on the GPU: the G-buffer that they draw.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/gpu_scene/gpu_scene.h"
#include "glsl/surface/gbuffer.glsl"
#include "tests/gpu/gl_test.h"

namespace limn {

class GpuSceneTest : public GlTest {
 protected:
  static constexpr int kSide = 128;

  /// A G-buffer on the CPU, row 0 at the bottom.
  struct Picture {
    std::vector<float> depth;
    std::vector<uint32_t> instance;
    std::vector<glm::vec2> normal, geometricNormal;
    std::vector<glm::u8vec4> albedo;

    size_t at(int x, int y) const { return static_cast<size_t>(y) * kSide + static_cast<size_t>(x); }
    glm::vec3 shadingNormal(int x, int y) const { return glsl::octahedral_decode(normal[at(x, y)]); }
    glm::vec3 faceNormal(int x, int y) const { return glsl::octahedral_decode(geometricNormal[at(x, y)]); }
  };

  /// Renders the scene once and reads the G-buffer.
  Picture draw(const scene::Scene& scene, const scene::Pose& pose, const scene::CameraPose& camera) {
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, camera, {kSide, kSide}, 0);
    frame::ResourcePool pool(device());
    scene::GBufferPass pass;
    frame::FrameGraph graph;
    const SceneHandles handles = gpuScene.import(graph);
    const GBuffer g = pass.add(graph, gpuScene, handles, {kSide, kSide});
    for (const frame::TextureHandle h : {g.depth, g.normal, g.geometricNormal, g.albedo, g.instance})
      graph.output(h);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    Picture picture;
    const auto read = [&](frame::TextureHandle handle, auto& out, GLenum format, GLenum type) {
      out.resize(kSide * kSide);
      graph.texture(handle).read(0, format, type, out.data(), out.size() * sizeof(out[0]));
    };
    read(g.depth, picture.depth, GL_RED, GL_FLOAT);
    read(g.instance, picture.instance, GL_RED_INTEGER, GL_UNSIGNED_INT);
    read(g.normal, picture.normal, GL_RG, GL_FLOAT);
    read(g.geometricNormal, picture.geometricNormal, GL_RG, GL_FLOAT);
    read(g.albedo, picture.albedo, GL_RGBA, GL_UNSIGNED_BYTE);
    gpuScene.forget();
    return picture;
  }
};

}  // namespace limn
