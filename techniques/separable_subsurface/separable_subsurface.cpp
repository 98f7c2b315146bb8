// Light below surfaces, spread in the picture along rows and then along columns.
#include <optional>
#include <string>
#include <utility>

#include "core/frame/array_block.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/scene/diffusion_profile.h"
#include "core/technique/technique.h"
#include "techniques/separable_subsurface/line_materials.h"

namespace {

using namespace limn;
using frame::Access;
using separable_subsurface::LineMaterials;

enum Footprint { tangent, facing };
constexpr const char* kFootprints[] = {"tangent", "facing"};
enum Missing { centre, mean };
constexpr const char* kMissing[] = {"centre", "mean"};

constexpr Parameter kParameters[] = {
    scene::profileParameter(),
    integer("taps", 25, {1, 255}, "taps",
            "Along a row and along a column; even numbers count as the next odd one")
        .quality()
        .logScale(),
    choice("footprint", tangent, kFootprints,
           "tangent: taps lie on the plane that touches the surface; facing: on one that faces the camera"),
    boolean("follow_surface", true, "Taps that lie before or behind that plane are missing"),
    real("depth_limit", 4, {0.001, 1000}, "radii with half the light",
         "By which a followed tap may be off the plane, in view depth")
        .logScale(),
    choice("missing", mean, kMissing,
           "What stands for missing taps: the pixel's own light, or the mean of the others"),
};
constexpr StressCase kStress[] = {
    {.name = "one tap", .scene = "translucent_edge", .settings = "taps=1", .factor = 8},
    {.name = "255 taps", .scene = "translucent_spheres", .settings = "taps=255"},
    {.name = "planes that face the camera",
     .scene = "translucent_head",
     .settings = "footprint=facing follow_surface=false",
     .factor = 4},
    {.name = "the light of the pixel", .scene = "translucent_spheres", .settings = "missing=centre"},
    {.name = "skin of a scene of 1e-4",
     .change = StressChange::sceneScale,
     .amount = 1e-4,
     .scene = "translucent_spheres",
     .factor = 0},
    {.name = "skin of a scene of 1e4",
     .change = StressChange::sceneScale,
     .amount = 1e4,
     .scene = "translucent_spheres",
     .factor = 0},
};

class SeparableSubsurface : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override;

 public:
  static constexpr TechniqueInfo info{
      .name = "separable_subsurface",
      .title = "Separable subsurface scattering",
      .source =
          "Jimenez, Zsolnai, Jarabo, Freude, Auzinger, Wu, von der Pahlen, Wimmer, Gutierrez 2015, "
          "Separable Subsurface Scattering",
      .terms = termSet(Term::subsurface),
      .parameters = kParameters,
      .stress = kStress};

 private:
  /// Holds the kernels on the GPU for as long as the graph that reads them.
  struct Buffers {
    gpu::Buffer materials, taps, rows;
  };
  std::optional<Buffers> buffers_;
};

/// Declares the passes of one graph.
class Passes {
 public:
  struct Kernels {
    frame::BufferHandle materials, taps, rows;
    int count, tapCount;
    bool textured;
  };

  Passes(frame::FrameGraph& graph, const TechniqueInputs& inputs, const Kernels& kernels)
      : graph_(graph), inputs_(inputs), kernels_(kernels) {}

  /// Adds what leaves translucent surfaces to `target`, and returns it after that.
  frame::TextureHandle add(frame::TextureHandle target) {
    const frame::TextureHandle rows = addSpread(addIrradiance(), true, picture("light along rows"));
    return addSpread(rows, false, target);
  }

 private:
  static constexpr const char* kName = SeparableSubsurface::info.name;

  frame::TextureHandle picture(std::string_view name) {
    return graph_.createTexture(name,
                                {.format = GL_RGBA32F, .width = inputs_.size.x, .height = inputs_.size.y});
  }

  /// Declares what techniques/separable_subsurface/line_pixel.glsl reads, and returns the program's defines.
  std::map<std::string, std::string> readPixels(frame::PassBuilder& pass) const {
    const GBuffer& gbuffer = inputs_.gbuffer;
    std::map<std::string, std::string> defines{
        {"TEXTURED", kernels_.textured ? "1" : "0"},
        {"NORMALISED", scene::normalisedProfile(inputs_.parameters) ? "1" : "0"}};
    const Access materials = frame::arrayBlock<glsl::LineMaterial>(
        inputs_.gpuScene.device().limits(), kernels_.count, "LINE_MATERIAL_COUNT", defines);
    pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(gbuffer.instance, Access::sampled, kGBufferNames.instance, "bodies and their materials")
        .read(inputs_.handles.instances, Access::storageLoad, "Instances", "materials of bodies")
        .read(kernels_.rows, Access::storageLoad, "LineMaterialRows", "which materials are translucent")
        .read(kernels_.materials, materials, "LineMaterials", "what translucent materials reflect");
    if (kernels_.textured)
      pass.read(gbuffer.albedo, Access::sampled, kGBufferNames.albedo, "albedo of pixels");
    return defines;
  }

  /// Lets the pass dispatch one invocation for each pixel.
  void execute(frame::PassBuilder& pass, gpu::ProgramDesc program) const {
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, size = inputs_.size](frame::PassContext& context) {
      context.use(kernel);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
  }

  frame::TextureHandle addIrradiance() {
    frame::PassBuilder pass = graph_.addPass("irradiance", kName);
    gpu::ProgramDesc program{.files = {"techniques/separable_subsurface/irradiance.comp.glsl"},
                             .defines = readPixels(pass)};
    pass.read(inputs_.entering, Access::sampled, "entering", "light that enters")
        .read(inputs_.gbuffer.depth, Access::sampled, kGBufferNames.depth, "depth of pixels");
    const frame::TextureHandle result = pass.write(picture("light that enters"), Access::imageStore, "spread",
                                                   "light that enters, and the depth of its pixels");
    execute(pass, std::move(program));
    return result;
  }

  frame::TextureHandle addSpread(frame::TextureHandle entered, bool rows, frame::TextureHandle target) {
    const ParameterValues& p = inputs_.parameters;
    const bool tangents = p.choice("footprint") == tangent;
    frame::PassBuilder pass = graph_.addPass(rows ? "rows" : "columns and exit", kName);
    gpu::ProgramDesc program{.files = {"techniques/separable_subsurface/spread.comp.glsl"},
                             .defines = readPixels(pass)};
    const Access taps = frame::arrayBlock<glsl::LineTap>(
        inputs_.gpuScene.device().limits(), kernels_.tapCount, "LINE_TAP_COUNT", program.defines);
    program.defines.merge(
        std::map<std::string, std::string>{{"ROWS", rows ? "1" : "0"},
                                           {"TANGENT", tangents ? "1" : "0"},
                                           {"FOLLOW", p.boolean("follow_surface") ? "1" : "0"},
                                           {"CENTRE", p.choice("missing") == centre ? "1" : "0"},
                                           {"SIDE_TAPS", std::to_string(p.integer("taps") / 2)}});
    pass.read(entered, Access::sampled, "entered", "light to spread")
        .read(kernels_.taps, taps, "LineTaps", "how far it goes");
    if (tangents)
      pass.read(inputs_.gbuffer.geometricNormal, Access::sampled, kGBufferNames.geometricNormal,
                "planes that touch surfaces");
    if (!rows)
      pass.read(inputs_.gbuffer.normal, Access::sampled, kGBufferNames.normal, "what the boundary lets out");
    const frame::TextureHandle result =
        rows ? pass.write(target, Access::imageStore, "spread", "light spread along rows")
             : pass.write(target, Access::imageLoadStore, "radiance",
                          "light that leaves translucent surfaces");
    execute(pass, std::move(program));
    return result;
  }

  frame::FrameGraph& graph_;
  const TechniqueInputs& inputs_;
  Kernels kernels_;
};

frame::TextureHandle SeparableSubsurface::addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                    const TermRequest& request) {
  const ParameterValues& p = inputs.parameters;
  const LineMaterials kernels =
      separable_subsurface::lineMaterials(inputs.scene, inputs.pose,
                                          {.normalised = scene::normalisedProfile(p),
                                           .taps = p.integer("taps"),
                                           .depthLimit = p.real("depth_limit")});
  gpu::Device& device = inputs.gpuScene.device();
  buffers_ = {gpu::Buffer::of<glsl::LineMaterial>(device, "translucent materials", kernels.materials),
              gpu::Buffer::of<glsl::LineTap>(device, "taps of materials", kernels.taps),
              gpu::Buffer::of<uint32_t>(device, "rows of materials", kernels.rows)};
  return Passes(graph, inputs,
                {.materials = graph.importBuffer("translucent materials", buffers_->materials),
                 .taps = graph.importBuffer("taps of materials", buffers_->taps),
                 .rows = graph.importBuffer("rows of materials", buffers_->rows),
                 .count = static_cast<int>(kernels.materials.size()),
                 .tapCount = static_cast<int>(kernels.taps.size()),
                 .textured = kernels.textured})
      .add(request.target);
}

}  // namespace

LIMN_TECHNIQUE(SeparableSubsurface::info, SeparableSubsurface)
