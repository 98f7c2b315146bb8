#include "techniques/implicit_visibility/display.h"

#include <utility>

#include "core/gpu_scene/gpu_scene.h"

namespace limn::implicit_visibility {

using frame::Access;

frame::TextureHandle Display::lookup(const PassRequest& r) {
  if (lookup_) return lookup_;
  frame::PassBuilder pass = r.graph.addPass("surface lookup", technique_);
  pass.role(frame::PassRole::map)
      .read(r.inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(r.inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "which surface is seen")
      .read(elements_.leaves, Access::storageLoad, "Leaves", "vertices")
      .read(elements_.corners, Access::storageLoad, "Corners", "triangles");
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
  pass.execute([this, kernelHandle, depth, &scene = r.inputs.gpuScene](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{lookup_}}, {depth});
    constexpr GLuint nobody[4] = {glsl::no_link, 0, 0, 0};
    constexpr GLfloat far = 0;
    gl.ClearBufferuiv(GL_COLOR, 0, nobody);
    gl.ClearBufferfv(GL_DEPTH, 0, &far);
    context.use(kernelHandle).set("near_plane", scene.camera().near);
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
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(r.inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "where surfaces are")
      .read(around, Access::sampled, "surface_lookup", "leaves around pixels")
      .read(seen, Access::storageLoad, "Seen", "V of leaves");
  const frame::TextureHandle result =
      pass.write(r.target, Access::imageStore, "visibility", "visibility, one layer per light");
  const auto kernelHandle = elements_.program(pass, "show_visibility.comp.glsl");
  pass.execute([this, kernelHandle, size = r.inputs.size,
                layers = r.graph.desc(r.target).layers](frame::PassContext& context) {
    context.use(kernelHandle).set("slots", elements_.leafSlots());
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
  const frame::TextureHandle around = lookup(r);
  frame::PassBuilder pass = r.graph.addPass(chunk ? "gather per pixel" : "interpolate", technique_);
  pass.read(r.inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(around, Access::sampled, "surface_lookup", "leaves around pixels");
  readSurfaces(pass, r.inputs.gbuffer);
  frame::SlotHandle links;
  if (chunk) {
    pass.read(light.source, Access::storageLoad, "Source", "light");
    elements_.readDirections(pass);
    links = elements_.readLinks(pass);
  } else {
    pass.read(light.irradiance, Access::storageLoad, "Irradiance", "light");
  }
  const frame::TextureHandle result =
      pass.write(r.target, Access::imageLoadStore, "radiance", "reflected light");
  const auto kernelHandle =
      chunk ? elements_.program(pass, "show_bins.comp.glsl", {{"SKY", light.sky ? "1" : "0"}})
            : elements_.program(pass, "show_light.comp.glsl");
  pass.execute([this, kernelHandle, links, own = chunk ? *chunk : LinkChunk{}, perPixel = chunk != nullptr,
                size = r.inputs.size](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kernelHandle);
    if (perPixel) {
      elements_.setSpace(kernel);
      ElementPasses::bind(context, kernel, links, own);
    }
    context.dispatch(size.x, size.y, 1, 8, 8);
  });
  return result;
}

}  // namespace limn::implicit_visibility
