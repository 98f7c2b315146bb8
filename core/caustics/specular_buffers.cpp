#include "core/caustics/specular_buffers.h"

#include "core/shadow/light_fit.h"
#include "glsl/blocks.glsl"

namespace limn::caustics {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr unsigned viewBinding = 4;  // in specular.vert.glsl
constexpr unsigned frontUnit = 8;    // in specular.frag.glsl

}  // namespace

void SpecularBuffers::setViews(std::span<const glsl::ShadowView> views) {
  depthViews_.clear();
  for (const glsl::ShadowView& view : views)
    depthViews_.push_back({.volume = shadow::cullVolume(view),
                           .skipInstance = glsl::no_instance,
                           .view = view.info.y,
                           .layer = static_cast<int>(view.info.y),
                           .surfaces = scene::Surfaces::specular});
}

void SpecularBuffers::add(frame::FrameGraph& graph, const SceneHandles& handles, frame::BufferHandle views,
                          int size, const char* owner) {
  front_ = addPass(graph, handles, views, size, owner, nullptr);
  back_ = addPass(graph, handles, views, size, owner, &front_);
}

/// Nearest surfaces, or farthest ones of the instances in `front`.
SpecularBuffer SpecularBuffers::addPass(frame::FrameGraph& graph, const SceneHandles& handles,
                                        frame::BufferHandle views, int size, const char* owner,
                                        const SpecularBuffer* front) {
  const bool back = front != nullptr;
  frame::PassBuilder pass = graph.addPass(back ? "specular back" : "specular front", owner);
  scene::GpuScene::declareReads(pass, handles);
  pass.read(handles.geometry, Access::storageLoad, "corners of triangles, for their normals")
      .read(views, Access::storageLoad, "projections")
      .cacheable();
  if (back) pass.read(front->surface, Access::sampled, "instances whose back is wanted");
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
  buffer.geometricNormal = pass.write(create("specular geometric normal", GL_RG16_SNORM),
                                      Access::colourAttachment, "normals of triangles");
  const TextureHandle zbuffer =
      pass.write(create("specular z", GL_DEPTH_COMPONENT32F), Access::depthAttachment, "nearest or farthest");
  const auto program =
      pass.program({.files = {"glsl/caustics/specular.vert.glsl", "glsl/caustics/specular.frag.glsl"},
                    .defines = {{"BACK", back ? "1" : "0"}}});
  scene::SurfacePrograms programs;
  for (const scene::SurfaceVariant& variant : scene_.surfaceVariants()) programs[variant] = program;
  pass.execute([this, handles, views, programs, buffer, zbuffer, back,
                nearest = back ? front->surface : TextureHandle{}](frame::PassContext& context) {
    const auto bind = [&](int layer) {
      context.bindFramebuffer(
          {{buffer.surface, 0, layer}, {buffer.depth, 0, layer}, {buffer.geometricNormal, 0, layer}},
          {zbuffer, 0, layer});
    };
    bind(-1);
    constexpr GLfloat none[4] = {0, 0, 0, 0}, farthest[4] = {1, 1, 1, 1}, far = 0;
    context.gl().ClearBufferfv(GL_COLOR, 0, none);
    context.gl().ClearBufferfv(GL_COLOR, 1, farthest);
    context.gl().ClearBufferfv(GL_DEPTH, 0, &far);
    context.bindStorage(viewBinding, views);
    if (back) context.bindSampled(frontUnit, nearest);
    scene_.drawSurfaces(context, handles, programs, depthViews_, back ? backList_ : frontList_, false,
                        [&](const scene::DepthView& view) { bind(view.layer); });
  });
  return buffer;
}

}  // namespace limn::caustics
