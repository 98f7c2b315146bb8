#include "core/indirect/surface_lookup.h"

#include "core/gpu_scene/gpu_scene.h"

namespace limn::indirect {

using frame::Access;

frame::TextureHandle SurfaceLookup::texture(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                            const SurfaceMesh& mesh, std::string_view technique) {
  if (lookup_) return lookup_;
  frame::PassBuilder pass = graph.addPass("surface lookup", technique);
  pass.role(frame::PassRole::map)
      .read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "which surface is seen")
      .read(mesh.leaves, Access::storageLoad, "Leaves", "vertices")
      .read(mesh.corners, Access::storageLoad, "Corners", "triangles");
  const auto create = [&](const char* name, GLenum format) {
    return graph.createTexture(name, {.format = format, .width = inputs.size.x, .height = inputs.size.y});
  };
  lookup_ = pass.write(create("surface lookup", GL_RGBA32UI), Access::colourAttachment, "leaves and weights");
  const frame::TextureHandle depth = pass.write(create("surface lookup z", GL_DEPTH_COMPONENT32F),
                                                Access::depthAttachment, "hidden-surface removal");
  const auto kernelHandle = pass.program(
      {.files = {"glsl/indirect/surface_lookup.vert.glsl", "glsl/indirect/surface_lookup.frag.glsl"},
       .defines = {}});
  vertexArray_ = gpu::VertexArray(inputs.gpuScene.device(), {});
  pass.execute([this, kernelHandle, depth, count = mesh.cornerCount,
                &scene = inputs.gpuScene](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{lookup_}}, {depth});
    constexpr GLuint nobody[4] = {~0u, 0, 0, 0};
    constexpr GLfloat far = 0;
    gl.ClearBufferuiv(GL_COLOR, 0, nobody);
    gl.ClearBufferfv(GL_DEPTH, 0, &far);
    context.use(kernelHandle).set("near_plane", scene.camera().near);
    gl.BindVertexArray(vertexArray_.id());
    gl.Enable(GL_CULL_FACE);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(count));
    context.countTriangles(count / 3);
  });
  return lookup_;
}

}  // namespace limn::indirect
