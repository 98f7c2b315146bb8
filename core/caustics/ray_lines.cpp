#include "core/caustics/ray_lines.h"

#include <algorithm>
#include <array>

#include "core/caustics/ray_lists.h"
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

/// Which rays are drawn as lines, points and quads.
RayLists addLists(frame::FrameGraph& graph, const TechniqueInputs& inputs, const CausticRays& rays,
                  const scene::MediumInput& medium, const LineDraw& draw) {
  gpu::ProgramDesc program{.files = {"glsl/caustics/line_kinds.comp.glsl"},
                           .defines = {{"BEAMS", draw.beams ? "1" : "0"}}};
  medium.define(program.defines);
  return addRayLists(
      graph, rays,
      {.technique = draw.technique,
       .program = std::move(program),
       .kinds = {{{.vertices = 2}, {.vertices = 1}, {.vertices = draw.beams ? 6u : 0u, .instances = true}}},
       .declare =
           [&](frame::PassBuilder& pass) {
             pass.read(inputs.handles.frame, Access::uniformBuffer, "camera");
             medium.declare(pass);
           },
       .bind =
           [=, &scene = inputs.gpuScene, frame = inputs.handles.frame, beams = draw.beams](
               frame::PassContext& context, gpu::Program& kernel) {
             context.bindUniform(glsl::FrameBlock::binding, frame);
             medium.bind(context);
             kernel.set("near_plane", scene.camera().near);
             if (beams) kernel.set("buffer_size", rays.size);
           }});
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
  const scene::MediumInput medium(inputs.handles, draw.mediumSteps);
  const RayLists lists = addLists(graph, inputs, rays, medium, draw);
  frame::PassBuilder pass = graph.addPass("caustic lines", draw.technique);
  pass.read(inputs.handles.frame, Access::uniformBuffer, "camera, medium")
      .read(rays.rays, Access::storageLoad, "lines")
      .read(rule, Access::storageLoad, "what a fragment stands for")
      .read(inputs.gbuffer.depth, Access::sampled, "what hides lines");
  declareRayLists(pass, lists);
  medium.declare(pass);
  const frame::TextureHandle result = pass.write(target, Access::colourBlend, "light of the lines");
  std::vector<frame::ProgramHandle> programs;
  for (unsigned kind = 0; kind < (draw.beams ? 3u : 2u); ++kind) {
    std::map<std::string, std::string> defines = draw.defines;
    defines["KIND"] = std::to_string(kind);
    defines["BEAMS"] = draw.beams ? "1" : "0";
    medium.define(defines);
    programs.push_back(pass.program(
        {.files = {"glsl/caustics/lines.vert.glsl", draw.fragmentShader}, .defines = std::move(defines)}));
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
    constexpr GLenum primitives[] = {GL_LINES, GL_POINTS, GL_TRIANGLE_STRIP};
    for (unsigned kind = 0; kind < programs.size(); ++kind) {
      gpu::Program& program = context.program(programs[kind]);
      program.use();
      program.set("near_plane", scene.camera().near);
      if (beams || primitives[kind] == GL_LINES) program.set("buffer_size", rays.size);
      if (bind) bind(program);
      drawRays(context, lists, kind, primitives[kind]);
    }
    gl.Disable(GL_PROGRAM_POINT_SIZE);
  });
  return result;
}

}  // namespace limn::caustics
