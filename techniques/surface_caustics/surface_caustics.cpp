// Surface caustics: light that specular objects reflect or refract onto other surfaces, as photons splatted
// on the screen, or into a caustic map of the light.
#include <array>

#include "core/caustics/ray_lines.h"
#include "core/caustics/ray_lists.h"
#include "core/scene/gpu_medium.h"
#include "core/technique/technique.h"
#include "glsl/gbuffer.glsl"

namespace {

using namespace limn;
using frame::Access;

constexpr const char* splatNames[] = {"screen", "light"};
constexpr int splatLight = 1;

constexpr Parameter parameters[] = {
    caustics::bufferSizeParameter(),
    caustics::sceneMapSizeParameter(),
    caustics::pathsParameter(),
    caustics::lightSamplesParameter(),
    scene::mediumStepsParameter(),
    real("kernel", 1.5, {0.25, 16}, "photon distances", "Half-diameters of a photon's kernel"),
    choice("splat", 0, splatNames,
           "Where photons are gathered: on the screen, or in a map of the light, as large as the scene map, "
           "which surfaces look up (as published)"),
};
constexpr StressCase stress[] = {
    {.name = "buffer of 1 texel", .settings = "buffer_size=1", .factor = 0},
    {.name = "buffer of 16 texels", .settings = "buffer_size=16", .factor = 6},
    {.name = "wide kernels", .settings = "kernel=8", .factor = 6},
    {.name = "caustic map", .settings = "splat=light", .factor = 2},
    {.name = "caustic map of 16 texels", .settings = "splat=light scene_map_size=16", .factor = 20},
};

/// The photons of some rays as triangles, whatever they are splatted on.
struct Photons {
  caustics::CausticRays rays;
  caustics::RayLists lists;
  frame::BufferHandle frame;
  scene::MediumInput medium;
  float kernel;
  frame::ProgramHandle program = {};

  Photons(frame::FrameGraph& graph, const TechniqueInputs& inputs, const caustics::CausticRays& made,
          std::string_view technique)
      : rays(made),
        lists(caustics::addRayLists(
            graph, made,
            {.technique = technique,
             .program = {.files = {"techniques/surface_caustics/photon_kinds.comp.glsl"}, .defines = {}},
             .kinds = {{{.vertices = 3}}}})),
        frame(inputs.handles.frame),
        medium(inputs.handles, inputs.parameters.integer("medium_steps")),
        kernel(inputs.parameters.real("kernel")) {}

  void declare(frame::PassBuilder& pass, bool map) {
    pass.read(frame, Access::uniformBuffer, "camera, medium").read(rays.rays, Access::storageLoad, "photons");
    caustics::declareRayLists(pass, lists);
    gpu::ProgramDesc desc{.files = {"techniques/surface_caustics/photon.vert.glsl",
                                    "techniques/surface_caustics/photon.frag.glsl"},
                          .defines = {{"CAUSTIC_MAP", map ? "1" : "0"}}};
    medium.define(desc.defines);
    medium.declare(pass);
    program = pass.program(std::move(desc));
  }

  /// Ready to draw into the bound framebuffer, which is cleared.
  gpu::Program& begin(frame::PassContext& context, const gpu::VertexArray& empty) const {
    const gl::Functions& gl = context.gl();
    constexpr GLfloat black[4] = {0, 0, 0, 0};
    gl.ClearBufferfv(GL_COLOR, 0, black);
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.BindVertexArray(empty.id());
    gpu::Program& splats = context.program(program);
    splats.use();
    splats.set("buffer_size", rays.size);
    splats.set("kernel", kernel);
    context.bindUniform(glsl::FrameBlock::binding, frame);
    context.bindStorage(0, rays.rays);
    medium.bind(context);
    return splats;
  }
  void draw(frame::PassContext& context) const { caustics::drawRays(context, lists, 0, GL_TRIANGLES); }
};

class SurfaceCaustics : public Technique {
  gpu::VertexArray empty_;

  /// Irradiance of the photons on what the camera sees, W/m^2, splatted on the screen.
  frame::TextureHandle addScreen(frame::FrameGraph& graph, const TechniqueInputs& inputs, Photons photons) {
    frame::PassBuilder pass = graph.addPass("photons", info.name);
    photons.declare(pass, false);
    pass.read(inputs.gbuffer.depth, Access::sampled, "receivers")
        .read(inputs.gbuffer.normal, Access::sampled, "cosines of receivers")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, "sides of receivers");
    const frame::TextureHandle irradiance =
        pass.write(createIrradiance(graph, inputs.size), Access::colourAttachment, "flux per area");
    pass.execute([=, this, gbuffer = inputs.gbuffer](frame::PassContext& context) {
      context.bindFramebuffer({{irradiance}});
      photons.begin(context, empty_);
      context.bindSampled(glsl::gbuffer_unit_depth, gbuffer.depth);
      context.bindSampled(glsl::gbuffer_unit_normal, gbuffer.normal);
      context.bindSampled(glsl::gbuffer_unit_geometric_normal, gbuffer.geometricNormal);
      photons.draw(context);
    });
    return irradiance;
  }

  /// The same by way of caustic maps: irradiance on what the lights' scene maps show, texel by texel.
  frame::TextureHandle addMaps(frame::FrameGraph& graph, Photons photons) {
    const caustics::CausticRays& rays = photons.rays;
    frame::PassBuilder pass = graph.addPass("caustic map", info.name);
    photons.declare(pass, true);
    pass.read(rays.layerLights, Access::storageLoad, "light of each layer of rays")
        .read(rays.scene.views, Access::storageLoad, "projections of the maps")
        .read(rays.scene.lights, Access::storageLoad, "layers of each light")
        .read(rays.scene.depth, Access::sampled, "receivers");
    const frame::TextureHandle maps =
        pass.write(graph.createTexture("caustic maps", {.target = GL_TEXTURE_2D_ARRAY,
                                                        .format = GL_RGBA32F,
                                                        .width = rays.scene.size,
                                                        .height = rays.scene.size,
                                                        .layers = rays.scene.layers}),
                   Access::colourAttachment, "flux per area");
    pass.execute([=, this](frame::PassContext& context) {
      const caustics::CausticRays& splatted = photons.rays;
      for (int layer = 0; layer < splatted.scene.layers; ++layer) {
        context.bindFramebuffer({{maps, 0, layer}});
        gpu::Program& splats = photons.begin(context, empty_);
        splats.set("layer_count", splatted.layers);
        splats.set("map_layer", layer);
        bindMaps(context, splatted);
        context.bindStorage(3, splatted.layerLights);
        photons.draw(context);
      }
    });
    return maps;
  }

  frame::TextureHandle addLookup(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const caustics::CausticRays& rays, frame::TextureHandle maps) {
    frame::PassBuilder pass = graph.addPass("caustic map lookup", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "camera")
        .read(inputs.gbuffer.depth, Access::sampled, "receivers")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, "sides of receivers")
        .read(rays.scene.views, Access::storageLoad, "projections of the maps")
        .read(rays.scene.lights, Access::storageLoad, "layers of each light")
        .read(rays.scene.depth, Access::sampled, "what the maps show")
        .read(maps, Access::sampled, "what arrives there");
    const frame::TextureHandle irradiance =
        pass.write(createIrradiance(graph, inputs.size), Access::imageStore, "flux per area");
    const auto program =
        pass.program({.files = {"techniques/surface_caustics/lookup.comp.glsl"}, .defines = {}});
    pass.execute([=, frame = inputs.handles.frame, gbuffer = inputs.gbuffer,
                  size = inputs.size](frame::PassContext& context) {
      gpu::Program& kernel = context.program(program);
      kernel.use();
      kernel.set("light_count", rays.sceneLights);
      context.bindUniform(glsl::FrameBlock::binding, frame);
      context.bindSampled(glsl::gbuffer_unit_depth, gbuffer.depth);
      context.bindSampled(glsl::gbuffer_unit_geometric_normal, gbuffer.geometricNormal);
      context.bindSampled(7, maps);
      bindMaps(context, rays);
      context.bindImage(0, irradiance, GL_WRITE_ONLY);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return irradiance;
  }

  static frame::TextureHandle createIrradiance(frame::FrameGraph& graph, glm::ivec2 size) {
    return graph.createTexture("caustic irradiance",
                               {.format = GL_RGBA32F, .width = size.x, .height = size.y});
  }

  /// As caustic_map.glsl reads them.
  static void bindMaps(frame::PassContext& context, const caustics::CausticRays& rays) {
    context.bindStorage(1, rays.scene.views);
    context.bindStorage(2, rays.scene.lights);
    context.bindSampled(8, rays.scene.depth);
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
    const bool map = inputs.parameters.choice("splat") == splatLight;
    const caustics::CausticRays rays =
        caustics::requestRays(graph, inputs, request, map ? "caustic map" : "photons", info.name);
    if (!rays.rays) return request.target;
    if (!empty_) empty_ = gpu::VertexArray(inputs.gpuScene.device(), {});
    const Photons photons(graph, inputs, rays, info.name);
    const frame::TextureHandle irradiance =
        map ? addLookup(graph, inputs, rays, addMaps(graph, photons)) : addScreen(graph, inputs, photons);
    return addReflection(graph, inputs, irradiance, request.target);
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "surface_caustics",
      .title = "Surface caustics",
      .source = "Wyman and Davis 2006; Shah et al. 2007; Schjoeth et al. 2007; thesis, section 8.3.4",
      .terms = termSet(Term::caustic),
      .parameters = parameters,
      .stress = stress};
};

}  // namespace

LIMN_TECHNIQUE(SurfaceCaustics::info, SurfaceCaustics)
