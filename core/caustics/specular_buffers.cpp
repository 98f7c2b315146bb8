#include "core/caustics/specular_buffers.h"

#include <algorithm>

#include "core/shadow/light_fit.h"
#include "glsl/scene/blocks.glsl"

namespace limn::caustics {

using frame::Access;
using frame::TextureHandle;

void SpecularBuffers::setViews(std::span<const glsl::ShadowView> views) {
  depthViews_.clear();
  for (const glsl::ShadowView& view : views)
    depthViews_.push_back({.volume = shadow::cullVolume(view),
                           .skipInstance = glsl::no_instance,
                           .view = view.layer,
                           .layer = static_cast<int>(view.layer),
                           .surfaces = scene::Surfaces::specular});
}

void SpecularBuffers::add(frame::FrameGraph& graph, const SceneHandles& handles, frame::BufferHandle views,
                          int size, GeometricNormals normals, const char* owner) {
  front_ = addPass(graph, handles, views, size, normals != GeometricNormals::none, owner, nullptr);
  back_ = addPass(graph, handles, views, size, normals == GeometricNormals::both, owner, &front_);
}

float SpecularBuffers::widest() const {
  float diameter = 0;
  for (uint32_t i = 0; i < scene_.instanceCount(); ++i)
    if (scene_.specular(i)) diameter = std::max(diameter, 2 * scene_.bounds(i).radius());
  return diameter;
}

/// Nearest surfaces, or farthest ones of the instances in `front`.
SpecularBuffer SpecularBuffers::addPass(frame::FrameGraph& graph, const SceneHandles& handles,
                                        frame::BufferHandle views, int size, bool normals, const char* owner,
                                        const SpecularBuffer* front) {
  const bool back = front != nullptr;
  frame::PassBuilder pass = graph.addPass(back ? "specular back" : "specular front", owner);
  pass.role(frame::PassRole::map);
  const bool masked = std::ranges::any_of(scene_.scene().materials, [](const scene::Material& material) {
    return material.specularSurface() && material.alphaCutoff > 0;
  });
  const scene::SurfacePrograms programs = scene_.declareSurfaces(
      pass, handles,
      {.files = {"glsl/caustics/specular.vert.glsl", "glsl/caustics/specular.frag.glsl"},
       .defines = {{"BACK", back ? "1" : "0"}, {"GEOMETRIC_NORMALS", normals ? "1" : "0"}, {"MASKED", "0"}}},
      masked);
  pass.read(views, Access::storageLoad, "Views", "projections").cacheable();
  if (back) pass.read(front->surface, Access::sampled, "front", "instances whose back is wanted");
  gpu::TextureDesc desc{.target = GL_TEXTURE_2D_ARRAY,
                        .format = GL_RGBA32F,
                        .width = size,
                        .height = size,
                        .layers = static_cast<int>(depthViews_.size())};
  const auto create = [&](const char* name, GLenum format) {
    desc.format = format;
    return graph.createTexture(name, desc);
  };
  SpecularBuffer buffer;
  buffer.surface = pass.write(create("specular surface", GL_RGBA32F), Access::colourAttachment, "normals");
  buffer.depth = pass.write(create("specular depth", GL_R32F), Access::colourAttachment, "linear depth");
  if (normals)
    buffer.geometricNormal = pass.write(create("specular geometric normal", GL_RG16_SNORM),
                                        Access::colourAttachment, "normals of triangles");
  const TextureHandle zbuffer =
      pass.write(create("specular z", GL_DEPTH_COMPONENT32F), Access::depthAttachment, "nearest or farthest");
  pass.execute([this, programs, buffer, zbuffer, back](frame::PassContext& context) {
    const auto bind = [&](int layer) {
      const frame::PassContext::Target surface{buffer.surface, 0, layer}, depth{buffer.depth, 0, layer},
          z{zbuffer, 0, layer};
      if (buffer.geometricNormal)
        context.bindFramebuffer({surface, depth, {buffer.geometricNormal, 0, layer}}, z);
      else
        context.bindFramebuffer({surface, depth}, z);
    };
    bind(-1);
    constexpr GLfloat none[4] = {0, 0, 0, 0}, farthest[4] = {1, 1, 1, 1}, far = 0;
    context.gl().ClearBufferfv(GL_COLOR, 0, none);
    context.gl().ClearBufferfv(GL_COLOR, 1, farthest);
    context.gl().ClearBufferfv(GL_DEPTH, 0, &far);
    scene_.drawSurfaces(context, programs, depthViews_, back ? backList_ : frontList_, false,
                        [&](const scene::DepthView& view) { bind(view.layer); });
  });
  return buffer;
}

}  // namespace limn::caustics
