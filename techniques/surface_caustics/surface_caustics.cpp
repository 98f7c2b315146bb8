// Surface caustics: light that specular objects reflect or refract onto other surfaces, as photons splatted
// on the screen.
#include <array>

#include "core/caustics/ray_lines.h"
#include "core/scene/gpu_medium.h"
#include "core/technique/technique.h"
#include "glsl/gbuffer.glsl"

namespace {

using namespace limn;
using frame::Access;

constexpr Parameter parameters[] = {
    caustics::bufferSizeParameter(),
    caustics::sceneMapSizeParameter(),
    caustics::pathsParameter(),
    caustics::lightSamplesParameter(),
    scene::mediumStepsParameter(),
    real("kernel", 2, {0.25, 16}, "photon distances", "Radius of a photon's kernel"),
};
constexpr StressCase stress[] = {
    {.name = "buffer of 1 texel", .settings = "buffer_size=1", .factor = 0},
    {.name = "buffer of 16 texels", .settings = "buffer_size=16", .factor = 6},
    {.name = "wide kernels", .settings = "kernel=8", .factor = 6},
};

class SurfaceCaustics : public Technique {
  gpu::VertexArray empty_;

  /// Irradiance of the photons on what the camera sees, W/m^2.
  frame::TextureHandle addPhotons(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                  const caustics::CausticRays& rays) {
    if (!empty_) empty_ = gpu::VertexArray(inputs.gpuScene.device(), {});
    frame::PassBuilder pass = graph.addPass("photons", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "camera, medium")
        .read(rays.rays, Access::storageLoad, "photons")
        .read(inputs.gbuffer.depth, Access::sampled, "receivers")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, "sides of receivers");
    const frame::TextureHandle irradiance = pass.write(
        graph.createTexture("caustic irradiance",
                            {.format = GL_RGBA32F, .width = inputs.size.x, .height = inputs.size.y}),
        Access::colourAttachment, "flux per area");
    gpu::ProgramDesc desc{.files = {"techniques/surface_caustics/photon.vert.glsl",
                                    "techniques/surface_caustics/photon.frag.glsl"},
                          .defines = {}};
    const scene::MediumInput medium(inputs.handles, inputs.parameters.integer("medium_steps"));
    medium.define(desc.defines);
    medium.declare(pass);
    const auto program = pass.program(std::move(desc));
    pass.execute([=, this, frame = inputs.handles.frame, gbuffer = inputs.gbuffer,
                  kernel = inputs.parameters.real("kernel")](frame::PassContext& context) {
      const gl::Functions& gl = context.gl();
      context.bindFramebuffer({{irradiance}});
      constexpr GLfloat black[4] = {0, 0, 0, 0};
      gl.ClearBufferfv(GL_COLOR, 0, black);
      gl.Enable(GL_BLEND);
      gl.BlendFunc(GL_ONE, GL_ONE);
      gl.Enable(GL_PROGRAM_POINT_SIZE);
      gl.BindVertexArray(empty_.id());
      gpu::Program& photons = context.program(program);
      photons.use();
      photons.set("buffer_size", rays.size);
      photons.set("kernel", kernel);
      context.bindUniform(glsl::FrameBlock::binding, frame);
      context.bindStorage(0, rays.rays);
      medium.bind(context);
      context.bindSampled(glsl::gbuffer_unit_depth, gbuffer.depth);
      context.bindSampled(glsl::gbuffer_unit_geometric_normal, gbuffer.geometricNormal);
      gl.DrawArrays(GL_POINTS, 0, rays.count());
      gl.Disable(GL_PROGRAM_POINT_SIZE);
    });
    return irradiance;
  }

  static frame::TextureHandle addReflection(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                            frame::TextureHandle irradiance, frame::TextureHandle target) {
    frame::PassBuilder pass = graph.addPass("reflect", info.name);
    const GBuffer& g = inputs.gbuffer;
    const std::array<std::pair<unsigned, frame::TextureHandle>, 5> surface{
        {{glsl::gbuffer_unit_depth, g.depth},
         {glsl::gbuffer_unit_normal, g.normal},
         {glsl::gbuffer_unit_albedo, g.albedo},
         {glsl::gbuffer_unit_material, g.material},
         {glsl::gbuffer_unit_emission, g.emission}}};
    pass.read(inputs.handles.frame, Access::uniformBuffer, "camera")
        .read(irradiance, Access::sampled, "what arrives");
    for (const auto& [unit, texture] : surface) pass.read(texture, Access::sampled, "what is reflected");
    const frame::TextureHandle result = pass.write(target, Access::imageLoadStore, "reflected caustics");
    const auto program =
        pass.program({.files = {"techniques/surface_caustics/reflect.comp.glsl"}, .defines = {}});
    pass.execute([=, frame = inputs.handles.frame, size = inputs.size](frame::PassContext& context) {
      context.program(program).use();
      context.bindUniform(glsl::FrameBlock::binding, frame);
      for (const auto& [unit, texture] : surface) context.bindSampled(unit, texture);
      context.bindSampled(7, irradiance);
      context.bindImage(0, result, GL_READ_WRITE);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const caustics::CausticRays rays = caustics::requestRays(graph, inputs, request, "photons", info.name);
    if (!rays.rays) return request.target;
    return addReflection(graph, inputs, addPhotons(graph, inputs, rays), request.target);
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "surface_caustics",
      .title = "Surface caustics",
      .source = "Wyman and Davis 2006; Shah et al. 2007; thesis, section 8.3.4",
      .terms = termSet(Term::caustic),
      .parameters = parameters,
      .stress = stress};
};

}  // namespace

LIMN_TECHNIQUE(SurfaceCaustics::info, SurfaceCaustics)
