// Light below surfaces from points that are drawn in the plane that touches a surface and looked up in the
// image.
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/frame/array_block.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/light_textures.h"
#include "core/scene/diffusion_profile.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/technique.h"
#include "glsl/diffusion/entry_sums.glsl"
#include "techniques/subsurface_scattering/bodies.h"

namespace {

using namespace limn;
using frame::Access;
using frame::BufferHandle;
using frame::TextureHandle;
using subsurface_scattering::Bodies;

constexpr const char* kNormalise[] = {"none", "count", "weights"};
static_assert(glsl::entry_normalise_none == 0 && glsl::entry_normalise_count == 1 &&
              glsl::entry_normalise_weights == 2);
constexpr const char* kPlanes[] = {"tangent", "both"};
constexpr const char* kMixing[] = {"root", "own"};

constexpr Parameter kParameters[] = {
    scene::profileParameter(),
    integer("samples", 16, {1, 1024}, "points", "Drawn around each pixel").quality().logScale(),
    integer("block", 4, {1, 16}, "pixels",
            "Side of the pattern of pixels that draw different points, over which the light is averaged"),
    choice("normalise", glsl::entry_normalise_weights, kNormalise,
           "none: the sum over the points is the integral over what is seen; count: its mean over the points "
           "that see the body, without the change of area, as published; weights: its mean by the weights"),
    choice("planes", 0, kPlanes,
           "Points lie in the plane that touches the surface, or in the one that faces the camera, too"),
    real("uniform_share", 0, {0, 1}, "",
         "Part of the points that are drawn from a disc instead of the profile"),
    real("uniform_radius", 3, {0.1, 100}, "mean distances",
         "Of that disc, over how far the farthest channel's light gets in the mean")
        .logScale(),
    choice("mixing", 0, kMixing,
           "Where textures vary what scatters: the root of both places' profiles, or the pixel's own, as "
           "published"),
    integer(
        "light_views", 0, {0, 16}, "points",
        "Points on each light with extent from which maps show where its light enters that the camera does "
        "not see; 0: light enters only where the camera looks")
        .quality(),
    integer("light_view_size", 512, {16, 4096}, "texels", "Width and height of those maps")
        .quality()
        .logScale(),
    real("scale", 1, {1e-6, 1e6}, "", "Factor on all mean free paths").logScale(),
};
constexpr StressCase kStress[] = {
    {.name = "one point", .scene = "translucent_spheres", .settings = "samples=1", .factor = 4},
    {.name = "points from a disc alone",
     .scene = "translucent_spheres",
     .settings = "uniform_share=1",
     .factor = 4},
    {.name = "both planes", .scene = "translucent_spheres", .settings = "planes=both"},
    {.name = "not normalised", .scene = "translucent_spheres", .settings = "normalise=none", .factor = 0},
    {.name = "normalised by hits",
     .scene = "translucent_spheres",
     .settings = "normalise=count",
     .factor = 0},
    {.name = "light that stays within a texel",
     .scene = "translucent_spheres",
     .settings = "scale=1e-6",
     .factor = 0},
    {.name = "light that reaches beyond the body",
     .scene = "translucent_spheres",
     .settings = "scale=1e6",
     .factor = 0},
    {.name = "exponentials within a texel",
     .scene = "translucent_spheres",
     .settings = "profile=normalised_diffusion scale=1e-6",
     .factor = 0},
    {.name = "exponentials beyond the body",
     .scene = "translucent_spheres",
     .settings = "profile=normalised_diffusion scale=1e6",
     .factor = 0},
    {.name = "light that the camera does not see enter",
     .scene = "translucent_spheres",
     .settings = "light_views=1"},
    {.name = "fewer points than maps of few texels",
     .scene = "translucent_spheres",
     .settings = "light_views=16 light_view_size=16 samples=4",
     .factor = 4},
    {.name = "colours that vary", .scene = "translucent_checker", .settings = "mixing=own", .factor = 4},
    {.name = "bodies that absorb nothing",
     .change = StressChange::albedo,
     .amount = 1,
     .scene = "translucent_spheres",
     .factor = 4},
    {.name = "bodies that scatter nothing",
     .change = StressChange::albedo,
     .amount = 0,
     .scene = "translucent_spheres"},
    {.name = "index of refraction 1",
     .change = StressChange::refraction,
     .amount = 1,
     .scene = "translucent_spheres"},
    {.name = "index of refraction 3",
     .change = StressChange::refraction,
     .amount = 3,
     .scene = "translucent_spheres",
     .factor = 4},
    {.name = "bodies of a scene of 1e-4",
     .change = StressChange::sceneScale,
     .amount = 1e-4,
     .scene = "translucent_spheres"},
    {.name = "bodies of a scene of 1e4",
     .change = StressChange::sceneScale,
     .amount = 1e4,
     .scene = "translucent_spheres"},
};

constexpr int kGroup = 8;

class SubsurfaceScattering : public Technique {
  TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                          const TermRequest& request) override;

 public:
  static constexpr TechniqueInfo info{.name = "subsurface_scattering",
                                      .title = "Subsurface scattering by points in the image",
                                      .source =
                                          "Mertens, Kautz, Bekaert, Van Reeth, Seidel 2003, Efficient "
                                          "Rendering of Local Subsurface Scattering",
                                      .terms = termSet(Term::subsurface),
                                      .parameters = kParameters,
                                      .stress = kStress};

 private:
  /// Holds the bodies on the GPU for as long as the graph that reads them.
  struct BodyBuffers {
    gpu::Buffer bodies, ofInstances, points, draws;
  };
  Bodies bodies_;
  std::optional<BodyBuffers> buffers_;
};

subsurface_scattering::Drawing drawingFor(const ParameterValues& p) {
  return {.normalised = scene::normalisedProfile(p),
          .samples = p.integer("samples"),
          .block = p.integer("block"),
          .uniformShare = p.real("uniform_share"),
          .uniformRadius = p.real("uniform_radius"),
          .scale = p.real("scale")};
}

/// Declares the passes of one graph.
class Passes {
 public:
  struct Buffers {
    BufferHandle bodies, ofInstances, points, draws;
  };

  /// `lights`: of the request.
  Passes(frame::FrameGraph& graph, const TechniqueInputs& inputs, const Bodies& bodies,
         const Buffers& buffers, std::span<const uint32_t> lights)
      : graph_(graph), inputs_(inputs), bodies_(bodies), buffers_(buffers) {
    addIrradiance();
    addLightViews(lights);
  }

  /// Returns the mean of the light that enters around each pixel: one pass for all bodies without textures,
  /// and one for all others.
  TextureHandle addGather() {
    TextureHandle gathered = screen("entering light around pixels", GL_RGBA32F);
    const bool plain = !bodies_.points.empty();
    if (plain) gathered = addGather(false, gathered, true);
    if (anyTextured()) gathered = addGather(true, gathered, !plain);
    return gathered;
  }

  /// Returns the mean over the pattern of interleaved pixels along rows.
  TextureHandle addBlur(TextureHandle gathered) {
    frame::PassBuilder pass = graph_.addPass("blur along rows", SubsurfaceScattering::info.name);
    pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(planes_, Access::sampled, "planes", "which surfaces are alike")
        .read(gathered, Access::sampled, "gathered", "what is averaged");
    const TextureHandle blurred = pass.write(screen("means along rows", GL_RGBA32F), Access::imageStore,
                                             "blurred", "means over like neighbours");
    run(pass, {.files = {shader("blur")}, .defines = {}});
    return blurred;
  }

  /// Adds the light that leaves to `target`. `gathered`: the means along rows if `blurred`.
  TextureHandle addExit(TextureHandle gathered, bool blurred, TextureHandle target) {
    frame::PassBuilder pass =
        graph_.addPass(blurred ? "blur along columns, exit" : "exit", SubsurfaceScattering::info.name);
    gpu::ProgramDesc program{.files = {shader("exit")}, .defines = readBodies(pass, anyTextured())};
    program.defines["BLUR"] = blurred ? "1" : "0";
    pass.read(inputs_.gbuffer.normal, Access::sampled, kGBufferNames.normal, "cosines towards the camera")
        .read(gathered, Access::sampled, "gathered", "light that enters around pixels");
    const TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "light that left bodies");
    run(pass, std::move(program));
    return result;
  }

 private:
  bool anyTextured() const { return !bodies_.draws.empty(); }
  static std::string shader(const char* name) {
    return std::string("techniques/subsurface_scattering/") + name + ".comp.glsl";
  }

  TextureHandle screen(const char* name, GLenum format) {
    return graph_.createTexture(name, {.format = format, .width = inputs_.size.x, .height = inputs_.size.y});
  }

  /// Lets the pass dispatch one invocation for each pixel.
  void run(frame::PassBuilder& pass, gpu::ProgramDesc description) {
    const auto program = pass.program(std::move(description));
    pass.execute([program, size = inputs_.size](frame::PassContext& context) {
      context.use(program);
      context.dispatch(size.x, size.y, 1, kGroup, kGroup);
    });
  }

  void addIrradiance() {
    frame::PassBuilder pass = graph_.addPass("irradiance", SubsurfaceScattering::info.name);
    const GBuffer& g = inputs_.gbuffer;
    pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(g.depth, Access::sampled, kGBufferNames.depth, "places")
        .read(g.geometricNormal, Access::sampled, kGBufferNames.geometricNormal, "planes of surfaces")
        .read(g.material, Access::sampled, kGBufferNames.material, "which surfaces are translucent")
        .read(g.instance, Access::sampled, kGBufferNames.instance, "bodies")
        .read(inputs_.entering, Access::sampled, "entering", "light that enters");
    planes_ =
        pass.write(screen("planes of bodies", GL_RGBA32UI), Access::imageStore, "planes", "what points meet");
    entries_ = pass.write(screen("light that enters", GL_RG32UI), Access::imageStore, "entries",
                          "what points find there");
    run(pass, {.files = {shader("irradiance")}, .defines = {}});
  }

  /// Requests maps of the lights if light is to enter where the camera does not look.
  void addLightViews(std::span<const uint32_t> lights) {
    const int points = inputs_.parameters.integer("light_views");
    if (points == 0) return;
    constexpr const char* name = "light views";
    if (inputs_.scene.environment && inputs_.scene.environment.lights.empty())
      graph_.leaveOut(name, SubsurfaceScattering::info.name, "of the environment, which has no maps");
    if (lights.empty()) {
      graph_.leaveOut(name, SubsurfaceScattering::info.name, "the scene has no light");
      return;
    }
    const shadow::ShadowMapDesc desc{.size = inputs_.parameters.integer("light_view_size"),
                                     .samples = shadow::pointsOnLights(points),
                                     .reflective = true,
                                     .instances = true};
    lightViews_ = inputs_.service<shadow::ShadowMapService>().request(lights, desc);
    lightCount_ = static_cast<int>(lights.size());
  }

  /// Declares what light_views.glsl reads, and adds to the program's defines.
  void readLightViews(frame::PassBuilder& pass, std::map<std::string, std::string>& defines) {
    const shadow::ShadowMaps& maps = *lightViews_;
    pass.read(maps.depth, Access::sampled, "reflective_depth", "where light arrives")
        .read(maps.normal, Access::sampled, "reflective_normal", "which way surfaces face")
        .read(maps.instance, Access::sampled, "reflective_instance", "which bodies they are of")
        .read(maps.views, Access::storageLoad, "Views", "projections")
        .read(maps.lights, Access::storageLoad, "MapLights", "which maps belong together")
        .read(inputs_.handles.lights, Access::storageLoad, "Lights", "what lights send");
    const scene::LightTextureInput textures(inputs_.handles);
    textures.define(defines);
    textures.declare(pass);
    defines["MEDIUM"] = inputs_.scene.medium.present() ? "1" : "0";
    const scene::MediumInput medium(inputs_.handles);
    medium.define(defines);
    medium.declare(pass);
    defines["MAP_POINTS"] = std::to_string(maps.stride);
  }

  /// Declares what pixel_body.glsl reads besides the G-buffer's depth, and returns the program's defines.
  std::map<std::string, std::string> readBodies(frame::PassBuilder& pass, bool textured) {
    pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(buffers_.bodies, Access::storageLoad, "Bodies", "what scatters")
        .read(buffers_.ofInstances, Access::storageLoad, "BodiesOfInstances", "in which instances")
        .read(planes_, Access::sampled, "planes", "surfaces and their instances");
    if (textured) pass.read(inputs_.gbuffer.albedo, Access::sampled, kGBufferNames.albedo, "what absorbs");
    return {{"NORMALISED", scene::normalisedProfile(inputs_.parameters) ? "1" : "0"},
            {"TEXTURED", textured ? "1" : "0"},
            {"ROOT", inputs_.parameters.choice("mixing") == 0 ? "1" : "0"}};
  }

  TextureHandle addGather(bool textured, TextureHandle gathered, bool first) {
    const subsurface_scattering::Drawing drawing = drawingFor(inputs_.parameters);
    frame::PassBuilder pass = graph_.addPass("gather", SubsurfaceScattering::info.name);
    gpu::ProgramDesc description{.files = {shader("gather")}, .defines = readBodies(pass, textured)};
    static_assert(sizeof(glsl::DrawnPoint) == sizeof(glsl::PointDraw));
    const auto count = static_cast<int>(textured ? bodies_.draws.size() : bodies_.points.size());
    const Access points = frame::arrayBlock<glsl::DrawnPoint>(inputs_.gpuScene.device().limits(), count,
                                                              "POINT_COUNT", description.defines);
    pass.read(textured ? buffers_.draws : buffers_.points, points, "Points", "points around pixels")
        .read(entries_, Access::sampled, "entries", "light that enters");
    gathered = pass.write(gathered, first ? Access::imageStore : Access::imageLoadStore, "gathered",
                          "light that enters around pixels");
    description.defines["SAMPLES"] = std::to_string(drawing.samples);
    description.defines["DISC_POINTS"] = std::to_string(drawing.discPoints());
    description.defines["NORMALISE"] = std::to_string(inputs_.parameters.choice("normalise"));
    description.defines["LIGHT_VIEWS"] = lightViews_ ? "1" : "0";
    if (lightViews_) readLightViews(pass, description.defines);
    description.defines["PLANES"] = std::to_string(inputs_.parameters.choice("planes") + 1);
    const auto program = pass.program(std::move(description));
    pass.execute([program, block = drawing.block, size = inputs_.size,
                  lights = lightCount_](frame::PassContext& context) {
      gpu::Program& kernel = context.use(program);
      if (lights > 0) {
        kernel.set("map_light_count", lights);
        kernel.set("light_samples", 1);
      }
      kernel.set("block", block);
      const glm::ivec2 part = (size + block - 1) / block;
      context.dispatch(part.x, part.y, block * block, kGroup, kGroup);
    });
    return gathered;
  }

  frame::FrameGraph& graph_;
  const TechniqueInputs& inputs_;
  const Bodies& bodies_;
  Buffers buffers_;
  TextureHandle planes_, entries_;
  std::optional<shadow::ShadowMaps> lightViews_;  ///< empty: light enters only where the camera looks
  int lightCount_ = 0;                            ///< in those maps
};

TextureHandle SubsurfaceScattering::addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                              const TermRequest& request) {
  gpu::Device& device = inputs.gpuScene.device();
  bodies_ = subsurface_scattering::findBodies(inputs.scene, inputs.pose, drawingFor(inputs.parameters),
                                              device.limits().maxStorageBlockBytes);
  buffers_ = {gpu::Buffer::of<glsl::DiffusionBody>(device, "bodies", bodies_.bodies),
              gpu::Buffer::of<uint32_t>(device, "bodies of instances", bodies_.ofInstances),
              gpu::Buffer::of<glsl::DrawnPoint>(device, "points of bodies", bodies_.points),
              gpu::Buffer::of<glsl::PointDraw>(device, "draws of points", bodies_.draws)};
  Passes passes(graph, inputs, bodies_,
                {.bodies = graph.importBuffer("bodies", buffers_->bodies),
                 .ofInstances = graph.importBuffer("bodies of instances", buffers_->ofInstances),
                 .points = graph.importBuffer("points of bodies", buffers_->points),
                 .draws = graph.importBuffer("draws of points", buffers_->draws)},
                request.lights);
  TextureHandle gathered = passes.addGather();
  const bool blurred = inputs.parameters.integer("block") > 1;
  if (blurred)
    gathered = passes.addBlur(gathered);
  else
    graph.leaveOut("blur along rows", info.name, "all pixels draw the same points");
  return passes.addExit(gathered, blurred, request.target);
}

}  // namespace

LIMN_TECHNIQUE(SubsurfaceScattering::info, SubsurfaceScattering)
