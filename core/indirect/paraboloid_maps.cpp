#include "core/indirect/paraboloid_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace limn::indirect {
namespace {

using frame::Access;

constexpr int64_t kBatchBytes = int64_t{1} << 30;
constexpr int64_t kBytesPerTexel = 8;  // depth and rasterised depth

}  // namespace

int64_t paraboloidBytes(int size) {
  return kBytesPerTexel * size * size;
}

int paraboloidBatch(const gpu::Device& device, int size) {
  const int64_t fitting = kBatchBytes / paraboloidBytes(size);
  return static_cast<int>(std::clamp<int64_t>(fitting, 1, device.limits().maxArrayLayers));
}

ParaboloidMaps ParaboloidMapPass::add(frame::FrameGraph& graph, scene::GpuScene& scene,
                                      const SceneHandles& handles, frame::BufferHandle views,
                                      const ParaboloidDesc& desc) {
  const int most = paraboloidBatch(scene.device(), desc.size);
  if (desc.count < 1 || desc.count > most)
    throw UsageError(fmt::format("{} paraboloid maps of {} x {} texels at once: accepted are 1 to {}",
                                 desc.count, desc.size, desc.size, most));
  views_.clear();
  for (int i = 0; i < desc.count; ++i)
    views_.push_back({.volume = {}, .view = static_cast<uint32_t>(desc.first + i), .layer = i});

  ParaboloidMaps maps{
      .depth = {}, .views = views, .count = desc.count, .first = desc.first, .size = desc.size};
  gpu::TextureDesc texture{.target = GL_TEXTURE_2D_ARRAY,
                           .format = GL_R32F,
                           .width = desc.size,
                           .height = desc.size,
                           .layers = desc.count};
  frame::PassBuilder pass = graph.addPass("paraboloid maps", desc.technique);
  pass.role(frame::PassRole::map);
  const scene::DrawPrograms programs =
      scene.declareDepth(pass, handles,
                         {.files = {"glsl/shadow/paraboloid.vert.glsl", "glsl/shadow/paraboloid.geom.glsl",
                                    "glsl/shadow/paraboloid.frag.glsl"},
                          .defines = {}});
  pass.read(views, Access::storageLoad, "Views", "where the hemispheres are");
  maps.depth =
      pass.write(graph.createTexture("paraboloid maps", texture), Access::colourAttachment, "radial depth");
  texture.format = GL_DEPTH_COMPONENT32F;
  const frame::TextureHandle zbuffer = pass.write(graph.createTexture("paraboloid z", texture),
                                                  Access::depthAttachment, "hidden-surface removal");
  if (desc.cacheable) pass.cacheable();
  pass.execute([this, &scene, programs, zbuffer, depth = maps.depth](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    constexpr GLfloat nothing[4] = {1, 1, 1, 1}, farthest = 0;
    context.bindFramebuffer({{depth}}, {zbuffer});
    gl.ClearBufferfv(GL_COLOR, 0, nothing);
    gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
    scene.drawDepth(context, programs, views_, list_, true, {});
  });
  return maps;
}

}  // namespace limn::indirect
