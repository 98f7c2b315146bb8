#include "core/caustics/ray_lines.h"

#include <algorithm>
#include <array>

#include "core/scene/gpu_medium.h"
#include "glsl/gbuffer.glsl"

namespace limn::caustics {
namespace {

using frame::Access;

constexpr int ruleSide = 1024;  // pixels; in line_rule.vert.glsl

/// Why no light goes through specular objects in this scene, as far as the scene tells, or null.
const char* whyNoRays(const TechniqueInputs& inputs, const TermRequest& request) {
  if (request.term == Term::media && inputs.scene.medium.sigmaS == glm::vec3(0))
    return "no medium scatters light";
  if (std::ranges::none_of(inputs.scene.materials, &scene::Material::specularSurface))
    return "the scene has no specular surface";
  return request.lights.empty() ? "the scene has no light" : nullptr;
}

}  // namespace

CausticRayDesc causticRayDesc(const ParameterValues& p) {
  return {.size = p.integer("buffer_size"),
          .sceneSize = p.integer("scene_map_size"),
          .paths = static_cast<uint32_t>(p.choice("paths") + 1),
          .lightSamples = p.integer("light_samples")};
}

CausticRays requestRays(frame::FrameGraph& graph, const TechniqueInputs& inputs, const TermRequest& request,
                        std::string_view pass, std::string_view technique) {
  const char* dark = whyNoRays(inputs, request);
  CausticRays rays;
  if (!dark) rays = inputs.causticRays.request(request.lights, causticRayDesc(inputs.parameters));
  if (!dark && !rays.rays) dark = "no light meets a specular surface";
  if (dark) graph.leaveOut(pass, technique, dark);
  return rays;
}

frame::BufferHandle RayLines::addRule(frame::FrameGraph& graph, std::string_view technique) {
  frame::PassBuilder pass = graph.addPass("line rule", technique);
  pass.cacheable();
  const frame::TextureHandle canvas = pass.write(
      graph.createTexture("line rule canvas", {.format = GL_R8, .width = ruleSide, .height = ruleSide}),
      Access::colourAttachment, "where a line is drawn");
  const frame::BufferHandle rule = pass.write(graph.createBuffer("line rule", {sizeof(uint32_t)}),
                                              Access::storageStore, "how many fragments a diagonal line has");
  const auto program = pass.program(
      {.files = {"glsl/caustics/line_rule.vert.glsl", "glsl/caustics/line_rule.frag.glsl"}, .defines = {}});
  pass.execute([this, canvas, rule, program](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{canvas}});
    gl.ClearNamedBufferData(context.buffer(rule).id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    context.bindStorage(1, rule);
    context.program(program).use();
    gl.BindVertexArray(empty_.id());
    gl.DrawArrays(GL_LINES, 0, 2);
  });
  return rule;
}

frame::TextureHandle RayLines::add(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                   const CausticRays& rays, frame::TextureHandle target,
                                   const LineDraw& draw) {
  if (!empty_) empty_ = gpu::VertexArray(inputs.gpuScene.device(), {});
  const frame::BufferHandle rule = addRule(graph, draw.technique);
  frame::PassBuilder pass = graph.addPass("caustic lines", draw.technique);
  pass.read(inputs.handles.frame, Access::uniformBuffer, "camera, medium")
      .read(rays.rays, Access::storageLoad, "lines")
      .read(rule, Access::storageLoad, "what a fragment stands for")
      .read(inputs.gbuffer.depth, Access::sampled, "what hides lines");
  const scene::MediumInput medium(inputs.handles, draw.mediumSteps);
  medium.declare(pass);
  const frame::TextureHandle result = pass.write(target, Access::colourBlend, "light of the lines");
  struct Kind {
    frame::ProgramHandle program;
    GLenum primitive;
    int vertices;  ///< of each ray
  };
  std::vector<Kind> kinds{{{}, GL_LINES, 2}, {{}, GL_POINTS, 1}, {{}, GL_TRIANGLE_STRIP, 6}};
  if (!draw.beams) kinds.pop_back();
  for (size_t k = 0; k < kinds.size(); ++k) {
    std::map<std::string, std::string> defines = draw.defines;
    defines["KIND"] = std::to_string(k);
    defines["BEAMS"] = draw.beams ? "1" : "0";
    medium.define(defines);
    kinds[k].program = pass.program(
        {.files = {"glsl/caustics/lines.vert.glsl", draw.fragmentShader}, .defines = std::move(defines)});
  }
  pass.execute([=, this, &scene = inputs.gpuScene, frame = inputs.handles.frame, depth = inputs.gbuffer.depth,
                beams = draw.beams, bind = draw.bind](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{result}});
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.Enable(GL_PROGRAM_POINT_SIZE);
    gl.BindVertexArray(empty_.id());
    context.bindUniform(glsl::FrameBlock::binding, frame);
    context.bindStorage(0, rays.rays);
    context.bindStorage(1, rule);
    context.bindSampled(glsl::gbuffer_unit_depth, depth);
    medium.bind(context);
    for (const Kind& kind : kinds) {
      gpu::Program& program = context.program(kind.program);
      program.use();
      program.set("near_plane", scene.camera().near);
      if (beams || kind.primitive == GL_LINES) program.set("buffer_size", rays.size);
      if (bind) bind(program);
      if (kind.primitive == GL_TRIANGLE_STRIP)
        gl.DrawArraysInstanced(kind.primitive, 0, kind.vertices, rays.count());
      else
        gl.DrawArrays(kind.primitive, 0, kind.vertices * rays.count());
    }
    gl.Disable(GL_PROGRAM_POINT_SIZE);
  });
  return result;
}

}  // namespace limn::caustics
