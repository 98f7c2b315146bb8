// Surface caustics: light that specular objects reflect or refract onto other surfaces, as photons splatted
// on the screen, or into a caustic map of the light.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <utility>

#include "core/base/error.h"
#include "core/caustics/ray_lines.h"
#include "core/caustics/ray_lists.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/surface_input.h"
#include "core/shading_maps/shading_maps.h"
#include "core/technique/technique.h"

namespace {

using namespace limn;
using frame::Access;

constexpr const char* kSplatNames[] = {"screen", "light"};
constexpr int kSplatLight = 1;
constexpr int64_t kMostMapBytes = int64_t{4} << 30;  ///< of caustic maps, as of the shadow maps of a request

constexpr auto kParameters = caustics::rayParameters(std::to_array<Parameter>({
    caustics::beamCosineParameter(),
    scene::mediumStepsParameter(),
    real("kernel", 1.5, {0.25, 16}, "photon distances", "Half-diameters of a photon's kernel"),
    choice("splat", 0, kSplatNames,
           "Where photons are gathered: on the screen, or in a map of the light, as large as the scene map, "
           "which surfaces look up (as published)"),
}));
/// In the balls of other cases the reference finds so few caustics that its noise is all there is.
constexpr const char* kScene = "glass_sphere";
constexpr StressCase kStress[] = {
    {.name = "buffer of 1 texel", .scene = kScene, .settings = "buffer_size=1", .factor = 0},
    {.name = "buffer of 16 texels", .scene = kScene, .settings = "buffer_size=16", .factor = 0},
    {.name = "buffer of 64 texels", .scene = kScene, .settings = "buffer_size=64", .factor = 6},
    {.name = "wide kernels", .scene = kScene, .settings = "kernel=8", .factor = 6},
    {.name = "photons of a pixel", .scene = kScene, .settings = "beam_cosine=1", .factor = 20},
    {.name = "kernels across edges", .scene = "gem", .settings = "beam_cosine=-1", .factor = 6},
    {.name = "one point of each search",
     .scene = kScene,
     .settings = "ray_steps=1 exit_steps=1",
     .factor = 0},
    {.name = "many points of each search",
     .scene = kScene,
     .settings = "ray_steps=4096 exit_steps=1024 buffer_size=64",
     .factor = 6},
    {.name = "caustic map", .scene = kScene, .settings = "splat=light", .factor = 2},
    {.name = "caustic map of 16 texels",
     .scene = kScene,
     .settings = "splat=light scene_map_size=16",
     .factor = 0},
    {.name = "caustic map of 64 texels",
     .scene = kScene,
     .settings = "splat=light scene_map_size=64",
     .factor = 20},
};

/// The photons of some rays as triangles, whatever they are splatted on.
struct Photons {
  caustics::CausticRays rays;
  caustics::RayLists lists;
  frame::BufferHandle frame, mediumAlone;
  scene::MediumInput medium;
  float kernel, beamCosine;
  bool translucent;  ///< some surfaces are
  frame::ProgramHandle program = {};

  Photons(frame::FrameGraph& graph, const TechniqueInputs& inputs, const caustics::CausticRays& made,
          std::string_view technique)
      : rays(made),
        lists(caustics::addRayLists(
            graph, made,
            {.technique = technique,
             .program = {.files = {"techniques/surface_caustics/photon_kinds.comp.glsl"}, .defines = {}},
             .kinds = {{{.vertices = 3}}},
             .kept = true})),
        frame(inputs.handles.frame),
        mediumAlone(inputs.handles.medium),
        medium(inputs.handles, inputs.parameters.integer("medium_steps")),
        kernel(inputs.parameters.real("kernel")),
        beamCosine(inputs.parameters.real("beam_cosine")),
        translucent(inputs.gpuScene.hasTranslucent()) {}

  /// Of a map nothing depends on the camera, nor on what its surfaces are.
  void declare(frame::PassBuilder& pass, bool map) {
    pass.read(map ? mediumAlone : frame, Access::uniformBuffer, "FrameBlock",
              map ? "medium" : "camera, medium")
        .read(rays.rays, Access::storageLoad, "Rays", "photons");
    caustics::declareRayLists(pass, lists);
    gpu::ProgramDesc desc{
        .files = {"techniques/surface_caustics/photon.vert.glsl",
                  "techniques/surface_caustics/photon.frag.glsl"},
        .defines = {{"CAUSTIC_MAP", map ? "1" : "0"}, {"TRANSLUCENT", translucent && !map ? "1" : "0"}}};
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
    gpu::Program& splats = context.use(program);
    splats.set("buffer_size", rays.size);
    splats.set("kernel", kernel);
    splats.set("beam_cosine", beamCosine);
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
    pass.read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "receivers")
        .read(inputs.gbuffer.normal, Access::sampled, kGBufferNames.normal, "cosines of receivers")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
              "sides of receivers");
    if (photons.translucent)
      pass.read(inputs.gbuffer.material, Access::sampled, kGBufferNames.material, "what enters receivers");
    const frame::TextureHandle irradiance =
        pass.write(createIrradiance(graph, inputs.size), Access::colourAttachment, "flux per area");
    pass.execute([=, this, &scene = inputs.gpuScene](frame::PassContext& context) {
      context.bindFramebuffer({{irradiance}});
      caustics::setSampleShift(photons.begin(context, empty_), scene);
      photons.draw(context);
    });
    return irradiance;
  }

  /// Returns how many runs of rays each layer of the caustic maps may have photons of.
  static int runsOf(const caustics::CausticRays& rays) { return rays.paths * rays.pointLayers; }

  /// What draws the photons of each layer of the caustic maps: those of its light alone.
  static frame::BufferHandle addMapDraws(frame::FrameGraph& graph, const Photons& photons) {
    const caustics::CausticRays& rays = photons.rays;
    frame::PassBuilder pass = graph.addPass("caustic map draws", info.name);
    pass.read(photons.lists.indices, Access::storageLoad, "RayIndices", "photons in order of their rays")
        .read(photons.lists.draws, Access::storageLoad, "RayDraws", "how many there are")
        .read(rays.layerLights, Access::storageLoad, "Layers", "light of each layer of rays")
        .read(rays.scene.lights, Access::storageLoad, "SceneLights", "layers of each light")
        .cacheable();
    const int64_t commands = int64_t{rays.scene.layers} * runsOf(rays);
    const frame::BufferHandle draws = pass.write(
        graph.createBuffer("caustic map draws", {static_cast<size_t>(commands) * sizeof(glsl::RayDraw)}),
        Access::storageStore, "MapDraws", "photons of each layer's light");
    const auto program =
        pass.program({.files = {"techniques/surface_caustics/map_draws.comp.glsl"}, .defines = {}});
    pass.execute([program, rays](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      kernel.set("layer_count", static_cast<unsigned>(rays.layers));
      kernel.set("path_count", static_cast<unsigned>(rays.paths));
      kernel.set("layer_rays", static_cast<unsigned>(rays.size * rays.size));
      kernel.set("point_layers", static_cast<unsigned>(rays.pointLayers));
      context.dispatchRows((int64_t{rays.layers} * rays.paths + 63) / 64);
    });
    return draws;
  }

  /// Throws UsageError where caustic maps would take too much memory: a texel takes more than one of a shadow
  /// map does.
  static void checkMaps(const shadow::ShadowMaps& scene) {
    constexpr int64_t bytesPerTexel = 16;
    const int64_t bytes = bytesPerTexel * scene.size * scene.size * scene.layers;
    if (bytes > kMostMapBytes)
      throw UsageError(
          fmt::format("surface_caustics: caustic maps of {} layers of {} x {} texels take {} MiB, more than "
                      "the {} MiB that they may; ask for a smaller scene_map_size, fewer light_samples or "
                      "fewer lights at once",
                      scene.layers, scene.size, scene.size, bytes >> 20, kMostMapBytes >> 20));
  }

  /// The same by way of caustic maps: irradiance on what the lights' scene maps show, texel by texel.
  frame::TextureHandle addMaps(frame::FrameGraph& graph, Photons photons) {
    const caustics::CausticRays& rays = photons.rays;
    checkMaps(rays.scene);
    const frame::BufferHandle draws = addMapDraws(graph, photons);
    frame::PassBuilder pass = graph.addPass("caustic map", info.name);
    photons.declare(pass, true);
    pass.read(draws, Access::indirectBuffer, "photons of each layer's light")
        .read(rays.scene.views, Access::storageLoad, "SceneViews", "projections of the maps")
        .read(rays.scene.lights, Access::storageLoad, "SceneLights", "layers of each light")
        .read(rays.scene.depth, Access::sampled, "scene_depth", "receivers")
        .cacheable();
    const frame::TextureHandle maps =
        pass.write(graph.createTexture("caustic maps", {.target = GL_TEXTURE_2D_ARRAY,
                                                        .format = GL_RGBA32F,
                                                        .width = rays.scene.size,
                                                        .height = rays.scene.size,
                                                        .layers = rays.scene.layers}),
                   Access::colourAttachment, "flux per area");
    pass.execute([=, this](frame::PassContext& context) {
      const gl::Functions& gl = context.gl();
      gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, context.buffer(draws).id());
      const int runs = runsOf(photons.rays);
      for (int layer = 0; layer < photons.rays.scene.layers; ++layer) {
        context.bindFramebuffer({{maps, 0, layer}});
        photons.begin(context, empty_).set("map_layer", layer);
        const size_t first = static_cast<size_t>(layer) * static_cast<size_t>(runs) * sizeof(glsl::RayDraw);
        gl.MultiDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(first), runs, 0);
      }
    });
    return maps;
  }

  frame::TextureHandle addLookup(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const caustics::CausticRays& rays, frame::TextureHandle maps) {
    frame::PassBuilder pass = graph.addPass("caustic map lookup", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(inputs.gbuffer.depth, Access::sampled, kGBufferNames.depth, "receivers")
        .read(inputs.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
              "sides of receivers")
        .read(rays.scene.views, Access::storageLoad, "SceneViews", "projections of the maps")
        .read(rays.scene.lights, Access::storageLoad, "SceneLights", "layers of each light")
        .read(rays.scene.depth, Access::sampled, "scene_depth", "what the maps show")
        .read(maps, Access::sampled, "caustic_map", "what arrives there");
    const frame::TextureHandle irradiance =
        pass.write(createIrradiance(graph, inputs.size), Access::imageStore, "irradiance", "flux per area");
    const auto program =
        pass.program({.files = {"techniques/surface_caustics/lookup.comp.glsl"}, .defines = {}});
    pass.execute([program, lights = rays.sceneLights, size = inputs.size](frame::PassContext& context) {
      context.use(program).set("light_count", lights);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return irradiance;
  }

  static frame::TextureHandle createIrradiance(frame::FrameGraph& graph, glm::ivec2 size) {
    return graph.createTexture("caustic irradiance",
                               {.format = GL_RGBA32F, .width = size.x, .height = size.y});
  }

  static frame::TextureHandle addReflection(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                            frame::TextureHandle irradiance, frame::TextureHandle target) {
    frame::PassBuilder pass = graph.addPass("reflect", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(irradiance, Access::sampled, "irradiance", "what arrives")
        .read(inputs.service<shading_maps::ShadingMapService>().ltcTable(), Access::sampled, "ltc_table",
              "what Fresnel's term leaves to the diffuse part");
    gpu::ProgramDesc desc{.files = {"techniques/surface_caustics/reflect.comp.glsl"},
                          .defines = {{"TRANSLUCENT", inputs.gpuScene.hasTranslucent() ? "1" : "0"}}};
    const scene::SurfaceInput surfaces(inputs.handles, inputs.gbuffer);
    surfaces.define(desc.defines);
    surfaces.declare(pass);
    const frame::TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "reflected caustics");
    const auto program = pass.program(std::move(desc));
    pass.execute([program, size = inputs.size](frame::PassContext& context) {
      context.use(program);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override {
    const bool map = inputs.parameters.choice("splat") == kSplatLight;
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
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(SurfaceCaustics::info, SurfaceCaustics)
