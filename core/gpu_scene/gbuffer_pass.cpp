#include <fmt/format.h>

#include <algorithm>

#include "core/gpu_scene/gpu_scene.h"

namespace limn::scene {

GBuffer GBufferPass::add(frame::FrameGraph& graph, GpuScene& scene, const SceneHandles& handles,
                         glm::ivec2 size, Surfaces surfaces, bool places) {
  using frame::Access;
  const auto create = [&](const char* name, GLenum format) {
    return graph.createTexture(name, {.format = format, .width = size.x, .height = size.y});
  };
  frame::PassBuilder builder = graph.addPass(surfaces == Surfaces::matte ? "matte gbuffer" : "gbuffer");
  builder.read(handles.frame, Access::uniformBuffer, "FrameBlock", "camera");
  const bool tangents = places || std::ranges::any_of(scene.scene().materials, [](const Material& material) {
                          return material.model && glsl::model_anisotropic(*material.model);
                        });
  const SurfacePrograms programs = scene.declareSurfaces(
      builder, handles,
      {.files = {"glsl/geometry/gbuffer.vert.glsl", "glsl/geometry/gbuffer.frag.glsl"},
       .defines = {{"SURFACE_TANGENTS", tangents ? "1" : "0"}, {"SURFACE_PLACES", places ? "1" : "0"}}});
  const auto write = [&](const char* name, GLenum format, const char* why) {
    return builder.write(create(name, format), Access::colourAttachment, why);
  };
  GBuffer g{.depth = write("depth", GL_R32F, "linear view depth"),
            .normal = write("normal", GL_RG16_SNORM, "shading normal"),
            .geometricNormal = write("geometric normal", GL_RG16_SNORM, "normal of the triangle"),
            .albedo = write("albedo", GL_RGBA16, "base colour, metallic"),
            .material = write("material", GL_RGBA8, "roughness, specular, index of refraction"),
            .emission = write("emission", GL_RGBA16F, "emitted radiance"),
            .instance = write("instance", GL_R32UI, "draw instance")};
  if (places)
    g.tangent = write("tangent", GL_RGBA16, "along which anisotropy lies, places in height maps");
  else if (tangents)
    g.tangent = write("tangent", GL_R16, "along which anisotropy lies");
  g.places = places;
  const frame::TextureHandle zbuffer = builder.write(create("gbuffer z", GL_DEPTH_COMPONENT32F),
                                                     Access::depthAttachment, "hidden-surface removal");

  builder.execute([this, &scene, g, zbuffer, programs, surfaces](frame::PassContext& context) {
    if (g.tangent) {
      context.bindFramebuffer({{g.depth},
                               {g.normal},
                               {g.geometricNormal},
                               {g.albedo},
                               {g.material},
                               {g.emission},
                               {g.instance},
                               {g.tangent}},
                              {zbuffer});
    } else {
      context.bindFramebuffer(
          {{g.depth}, {g.normal}, {g.geometricNormal}, {g.albedo}, {g.material}, {g.emission}, {g.instance}},
          {zbuffer});
    }
    const gl::Functions& gl = context.gl();
    constexpr GLfloat zero[4] = {0, 0, 0, 0};
    constexpr GLuint nobody[4] = {glsl::no_instance, 0, 0, 0};
    for (GLint i = 0; i < 6; ++i) gl.ClearBufferfv(GL_COLOR, i, zero);
    gl.ClearBufferuiv(GL_COLOR, 6, nobody);
    if (g.tangent) gl.ClearBufferfv(GL_COLOR, 7, zero);
    gl.ClearBufferfv(GL_DEPTH, 0, zero);
    scene.drawGBuffer(context, programs, surfaces, list_);
  });
  return g;
}

}  // namespace limn::scene
