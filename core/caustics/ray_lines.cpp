#include "core/caustics/ray_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "core/caustics/ray_lists.h"
#include "core/gpu_scene/gpu_medium.h"
#include "glsl/caustics/caustic_line.glsl"

namespace limn::caustics {
namespace {

using frame::Access;

constexpr int kRuleSide = 1024;  // pixels; in line_rule.vert.glsl

/// Why no light goes through specular objects in this scene, as far as the scene tells, or null.
const char* whyNoRays(const TechniqueInputs& inputs, const TermRequest& request) {
  if (request.term == Term::media && inputs.scene.medium.sigmaS == glm::vec3(0))
    return "no medium scatters light";
  if (std::ranges::none_of(inputs.scene.materials, &scene::Material::specularSurface))
    return "the scene has no specular surface";
  return request.lights.empty() ? "the scene has no light" : nullptr;
}

/// Whether light passes any specular surface.
bool refracts(const scene::Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const scene::Material& material) {
    return material.specularSurface() && material.transmission > 0;
  });
}

/// How far the camera's picture lies aside since its frame is a sample beside the middle of the pixels, which
/// shears its matrix by up to half a pixel (render::shifted). A thousandth of a pixel is rounding.
glm::vec2 sampleShift(const scene::GpuScene& scene) {
  const glm::dmat3 axes = glm::transpose(glm::dmat3(glm::dmat4(scene.camera().worldToView)));
  const glm::dvec2 shift(glm::dot(axes[0], axes[2]), glm::dot(axes[1], axes[2]));
  const double pixel = glm::length(glm::dvec3(glm::vec3(scene.frame().view_ray_dx)));
  const double pixels = std::max(std::abs(shift.x), std::abs(shift.y)) / pixel;
  return pixels > 1e-3 && pixels < 0.5 ? glm::vec2(shift) : glm::vec2(0);
}

/// Which rays are drawn as lines, points and quads.
struct Shapes {
  RayLists lists;
  frame::BufferHandle beams;  ///< of glsl::RayBeam, one per ray, of which those of quads are made
};

Shapes addShapes(frame::FrameGraph& graph, const TechniqueInputs& inputs, const CausticRays& rays,
                 const scene::MediumInput& medium, const LineDraw& draw) {
  Shapes shapes;
  gpu::ProgramDesc program{.files = {"glsl/caustics/line_kinds.comp.glsl"},
                           .defines = {{"BEAMS", draw.beams ? "1" : "0"}}};
  medium.define(program.defines);
  shapes.lists = addRayLists(
      graph, rays,
      {.technique = draw.technique,
       .program = std::move(program),
       .kinds = {{{.vertices = 2}, {.vertices = 1}, {.vertices = draw.beams ? 6u : 0u, .instances = true}}},
       .declare =
           [&](frame::PassBuilder& pass) {
             pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera");
             medium.declare(pass);
             if (draw.beams)
               shapes.beams = pass.write(graph.createBuffer("ray beams", {static_cast<size_t>(rays.count()) *
                                                                          sizeof(glsl::RayBeam)}),
                                         Access::storageStore, "RayBeams", "beams of quads");
           },
       .bind =
           [&scene = inputs.gpuScene, beams = draw.beams, cosine = draw.beamCosine,
            size = rays.size](gpu::Program& kernel) {
             kernel.set("near_plane", scene.camera().near);
             setSampleShift(kernel, scene);
             if (!beams) return;
             kernel.set("buffer_size", size);
             kernel.set("beam_cosine", cosine);
           }});
  return shapes;
}

}  // namespace

CausticRayDesc causticRayDesc(const ParameterValues& p) {
  return {.size = p.integer("buffer_size"),
          .sceneSize = p.integer("scene_map_size"),
          .paths = static_cast<uint32_t>(p.choice("paths") + 1),
          .lightSamples = p.integer("light_samples"),
          .steps = p.integer("ray_steps"),
          .exitSteps = p.integer("exit_steps"),
          .mediumSteps = std::max(p.integer("medium_steps"), scene::kCoreMediumSteps)};
}

CausticRays requestRays(frame::FrameGraph& graph, const TechniqueInputs& inputs, const TermRequest& request,
                        std::string_view pass, std::string_view technique) {
  const char* dark = whyNoRays(inputs, request);
  CausticRays rays;
  CausticRayDesc desc = causticRayDesc(inputs.parameters);
  if (!inputs.handles.density) desc.mediumSteps = scene::kCoreMediumSteps;  // so that rays are shared
  if (!dark && (desc.paths & glsl::caustic_refraction) != 0 && !refracts(inputs.scene)) {
    constexpr const char* opaque = "no specular surface lets light through";
    desc.paths &= ~glsl::caustic_refraction;
    if (desc.paths == 0)
      dark = opaque;
    else
      graph.leaveOut("refracted rays", technique, opaque);
  }
  if (!dark) rays = inputs.service<CausticRayService>().request(request.lights, desc);
  if (!dark && !rays.rays) dark = "no light meets a specular surface";
  if (dark) graph.leaveOut(pass, technique, dark);
  return rays;
}

void setSampleShift(gpu::Program& program, const scene::GpuScene& scene) {
  const glm::vec2 shift = sampleShift(scene);
  program.set("sample_shift_x", shift.x);
  program.set("sample_shift_y", shift.y);
}

frame::BufferHandle RayLines::addRule(frame::FrameGraph& graph, std::string_view technique) {
  frame::PassBuilder clear = graph.addPass("clear line rule", technique);
  clear.cacheable();
  const frame::BufferHandle none =
      clear.write(graph.createBuffer("line rule", {sizeof(uint32_t)}), Access::copyTarget, "none so far");
  clear.execute([none](frame::PassContext& context) {
    context.gl().ClearNamedBufferData(context.buffer(none).id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                                      nullptr);
  });
  frame::PassBuilder pass = graph.addPass("line rule", technique);
  pass.cacheable();
  const frame::TextureHandle canvas = pass.write(
      graph.createTexture("line rule canvas", {.format = GL_R8, .width = kRuleSide, .height = kRuleSide}),
      Access::colourAttachment, "where a line is drawn");
  const frame::BufferHandle rule =
      pass.write(none, Access::storageLoadStore, "LineRule", "how many fragments a diagonal line has");
  const auto program = pass.program(
      {.files = {"glsl/caustics/line_rule.vert.glsl", "glsl/caustics/line_rule.frag.glsl"}, .defines = {}});
  pass.execute([this, canvas, program](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{canvas}});
    context.use(program);
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
  const Shapes shapes = addShapes(graph, inputs, rays, medium, draw);
  frame::PassBuilder pass = graph.addPass("caustic lines", draw.technique);
  pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, medium")
      .read(rays.rays, Access::storageLoad, "Rays", "lines")
      .read(rule, Access::storageLoad, "LineRule", "what a fragment stands for")
      .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "what hides lines");
  declareRayLists(pass, shapes.lists);
  if (draw.beams) pass.read(shapes.beams, Access::storageLoad, "RayBeams", "beams of quads");
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
  pass.execute([=, this, &scene = inputs.gpuScene, beams = draw.beams, cosine = draw.beamCosine,
                size = rays.size, bind = draw.bind](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{result}});
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.Enable(GL_PROGRAM_POINT_SIZE);
    gl.BindVertexArray(empty_.id());
    constexpr GLenum primitives[] = {GL_LINES, GL_POINTS, GL_TRIANGLE_STRIP};
    for (unsigned kind = 0; kind < programs.size(); ++kind) {
      gpu::Program& program = context.use(programs[kind]);
      const GLenum primitive = primitives[kind];
      setSampleShift(program, scene);
      // Quads are drawn as "ray kinds" shaped them.
      if (primitive != GL_TRIANGLE_STRIP) program.set("near_plane", scene.camera().near);
      if (primitive == GL_LINES || (beams && primitive == GL_POINTS)) program.set("buffer_size", size);
      if (beams && primitive == GL_POINTS) program.set("beam_cosine", cosine);
      if (bind) bind(program);
      drawRays(context, shapes.lists, kind, primitive);
    }
    gl.Disable(GL_PROGRAM_POINT_SIZE);
  });
  return result;
}

}  // namespace limn::caustics
