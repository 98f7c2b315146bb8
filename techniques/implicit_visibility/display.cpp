#include "techniques/implicit_visibility/display.h"

#include <array>

#include "core/scene/gpu_scene.h"
#include "glsl/gbuffer.glsl"

namespace limn::implicit_visibility {

using frame::Access;

frame::TextureHandle Display::lookup(const PassRequest& r) {
  if (lookup_) return lookup_;
  frame::PassBuilder pass = r.graph.addPass("surface lookup", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "camera")
      .read(r.inputs.gbuffer.depth, Access::sampled, "which surface is seen")
      .read(elements_.leaves, Access::storageLoad, "vertices")
      .read(elements_.corners, Access::storageLoad, "triangles");
  const auto create = [&](const char* name, GLenum format) {
    return r.graph.createTexture(name,
                                 {.format = format, .width = r.inputs.size.x, .height = r.inputs.size.y});
  };
  lookup_ = pass.write(create("surface lookup", GL_RGBA32UI), Access::colourAttachment, "leaves and weights");
  const frame::TextureHandle depth = pass.write(create("surface lookup z", GL_DEPTH_COMPONENT32F),
                                                Access::depthAttachment, "hidden-surface removal");
  const auto kernelHandle = pass.program({.files = {"techniques/implicit_visibility/lookup.vert.glsl",
                                                    "techniques/implicit_visibility/lookup.frag.glsl"},
                                          .defines = {}});
  vertexArray_ = gpu::VertexArray(r.inputs.gpuScene.device(), {});
  pass.execute([this, kernelHandle, depth, inputs = &r.inputs.gpuScene, frame = r.inputs.handles.frame,
                gbufferDepth = r.inputs.gbuffer.depth](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{lookup_}}, {depth});
    constexpr GLuint nobody[4] = {glsl::no_link, 0, 0, 0};
    constexpr GLfloat far = 0;
    gl.ClearBufferuiv(GL_COLOR, 0, nobody);
    gl.ClearBufferfv(GL_DEPTH, 0, &far);
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    kernel.set("near_plane", inputs->camera().near);
    context.bindUniform(glsl::FrameBlock::binding, frame);
    context.bindSampled(0, gbufferDepth);
    context.bindStorage(0, elements_.leaves);
    context.bindStorage(1, elements_.corners);
    gl.BindVertexArray(vertexArray_.id());
    gl.Enable(GL_CULL_FACE);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    const size_t count = elements_.elements().triangles().size();
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(count));
    context.countTriangles(count / 3);
  });
  return lookup_;
}

frame::TextureHandle Display::visibility(const PassRequest& r, frame::BufferHandle seen) {
  const frame::TextureHandle around = lookup(r);
  frame::PassBuilder pass = r.graph.addPass("visibility", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "camera")
      .read(r.inputs.gbuffer.depth, Access::sampled, "where surfaces are")
      .read(around, Access::sampled, "leaves around pixels")
      .read(seen, Access::storageLoad, "V of leaves");
  const frame::TextureHandle result =
      pass.write(r.target, Access::imageStore, "visibility, one layer per light");
  const auto kernelHandle = elements_.program(pass, "show_visibility.comp.glsl");
  pass.execute([this, kernelHandle, around, result, seen, size = r.inputs.size,
                layers = r.graph.desc(r.target).layers, depth = r.inputs.gbuffer.depth,
                frame = r.inputs.handles.frame](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    kernel.set("slots", elements_.leafSlots());
    context.bindSampled(glsl::gbuffer_unit_depth, depth);
    context.bindSampled(8, around);
    context.bindStorage(0, seen);
    context.bindImage(0, result, GL_WRITE_ONLY);
    context.dispatch(size.x, size.y, layers, 8, 8);
  });
  return result;
}

frame::TextureHandle Display::light(const PassRequest& r, const Gathered& light) {
  if (r.inputs.parameters.choice("display") == 0) return show(r, light, nullptr);
  frame::TextureHandle target = r.target;
  for (const LinkChunk& chunk : elements_.chunks) target = show({r.graph, r.inputs, target}, light, &chunk);
  return target;
}

frame::TextureHandle Display::show(const PassRequest& r, const Gathered& light, const LinkChunk* chunk) {
  const GBuffer& g = r.inputs.gbuffer;
  const frame::TextureHandle around = lookup(r);
  frame::PassBuilder pass = r.graph.addPass(chunk ? "gather per pixel" : "interpolate", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "camera")
      .read(around, Access::sampled, "leaves around pixels");
  const std::pair<int, frame::TextureHandle> textures[] = {
      {glsl::gbuffer_unit_depth, g.depth},
      {glsl::gbuffer_unit_normal, g.normal},
      {glsl::gbuffer_unit_geometric_normal, g.geometricNormal},
      {glsl::gbuffer_unit_albedo, g.albedo},
      {glsl::gbuffer_unit_material, g.material},
      {glsl::gbuffer_unit_emission, g.emission}};
  for (const auto& [unit, texture] : textures) pass.read(texture, Access::sampled, "surfaces");
  pass.read(chunk ? light.source : light.irradiance, Access::storageLoad, "light");
  if (chunk) elements_.readLinks(pass);
  const frame::TextureHandle result = pass.write(r.target, Access::imageLoadStore, "reflected light");
  const auto kernelHandle =
      chunk ? elements_.program(pass, "show_bins.comp.glsl", {{"SKY", light.sky ? "1" : "0"}})
            : elements_.program(pass, "show_light.comp.glsl");
  pass.execute([this, kernelHandle, around, result, light, textures = std::to_array(textures),
                own = chunk ? *chunk : LinkChunk{}, perPixel = chunk != nullptr, size = r.inputs.size,
                frame = r.inputs.handles.frame](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    context.bindUniform(glsl::FrameBlock::binding, frame);
    for (const auto& [unit, texture] : textures) context.bindSampled(static_cast<unsigned>(unit), texture);
    context.bindSampled(8, around);
    context.bindImage(0, result, GL_READ_WRITE);
    if (perPixel) {
      elements_.setSpace(kernel);
      ElementPasses::bind(context, kernel, own);
      context.bindStorage(0, elements_.directions);
      context.bindStorage(3, light.source);
    } else {
      context.bindStorage(0, light.irradiance);
    }
    context.dispatch(size.x, size.y, 1, 8, 8);
  });
  return result;
}

}  // namespace limn::implicit_visibility
