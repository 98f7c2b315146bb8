// The environment's light without shadows from maps that the GPU filters: irradiance, and radiance blurred by
// lobes of growing width.
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <numbers>
#include <string>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/surface_input.h"
#include "core/scene/draw_instance.h"
#include "core/scene/environment_light.h"
#include "core/shading_maps/shading_maps.h"
#include "core/technique/technique.h"
#include "glsl/light/prefiltered_models.glsl"

namespace {

using namespace limn;
using frame::Access;
using frame::ShaderName;
using frame::TextureHandle;

enum Map : int { paraboloid, equirectangular };
constexpr const char* kMaps[] = {"paraboloid", "equirectangular"};
constexpr const char* kLookups[] = {"mirror", "normal_drawn", "centroid", "uncut"};
static_assert(glsl::prefiltered_lookup_mirror == 0 && glsl::prefiltered_lookup_normal_drawn == 1 &&
              glsl::prefiltered_lookup_centroid == 2 && glsl::prefiltered_lookup_uncut == 3);

enum FresnelTerm : int { exact, schlick };
constexpr const char* kFresnelTerms[] = {"exact", "schlick"};

constexpr Parameter kParameters[] = {
    choice(
        "map", paraboloid, kMaps,
        "Layout of the maps: two paraboloids without a pole, or one equirectangular map of as many texels"),
    integer("size", 256, {128, 1024}, "texels",
            "Side of each paraboloid, and height of the equirectangular map, at the least roughness")
        .quality()
        .logScale(),
    integer("samples", 64, {8, 1024}, "samples",
            "Directions of the narrowest lobe that is filtered; each wider one takes twice as many")
        .quality()
        .logScale(),
    choice("lookup", glsl::prefiltered_lookup_centroid, kLookups,
           "Where a glossy surface looks into the maps: along the mirror direction, drawn from there towards "
           "the normal by alpha squared, or at the middle of its lobe. uncut: as mirror, with Phong's lobe "
           "whole, though part of it lies below the horizon"),
    choice("fresnel", exact, kFresnelTerms,
           "Reflectance of coats, of the microfacets of models and of what enters translucent bodies: by "
           "Fresnel's equations, or by Schlick's approximation, off by 0.036 at an index of 1.5, 0.26 at 5 "
           "and 0.12 for aluminium"),
};
constexpr StressCase kStress[] = {
    {.name = "smallest maps", .settings = "size=128", .factor = 4},
    {.name = "fewest samples", .settings = "samples=8", .factor = 4},
    {.name = "mirror direction", .settings = "lookup=mirror", .factor = 4},
    {.name = "drawn towards the normal", .settings = "lookup=normal_drawn", .factor = 4},
    {.name = "lobes that the horizon does not cut", .settings = "lookup=uncut", .factor = 4},
    {.name = "equirectangular maps", .settings = "map=equirectangular", .factor = 4},
    {.name = "Schlick's reflectance", .scene = "fresnel_spheres", .settings = "fresnel=schlick"},
};

constexpr int kGroupSize = 8;
constexpr int kFilteredLevels = glsl::environment_levels - 1;  ///< level 0 is the radiance itself
/// Of maps of irradiance; and the rows of the picture that it is summed over, at least.
constexpr int kIrradianceSize = 32;
/// Of that picture, at most, and on all renderers, so that they show the same: with its 63 rows at most the
/// sum takes 64,575 steps, and software renderers leave the loops of a thread after 65,535.
constexpr int kMostIrradianceColumns = 1024;
constexpr int kCoarsestSize = 8;  ///< of the chain, at least
/// Radiance that half floats hold, which end at 65504, after sums of thousands of samples have rounded it up.
constexpr float kMostInHalves = 65000;
static_assert(kFilteredLevels == glsl::power_levels);

constexpr uint32_t kMicrofacetKinds = 1u << glsl::model_torrance_sparrow | 1u << glsl::model_ward;
constexpr uint32_t kLobeKinds = kMicrofacetKinds | 1u << glsl::model_phong;
constexpr uint32_t kEnteredKinds = 1u << glsl::model_coated | 1u << glsl::model_entry;

enum class Irradiance { whole, grazing };  ///< grazing: weighted by Schlick's (1 - cosine)^5
enum class Lobes { ggx, power };

/// Says what the surfaces of a request look up beside the irradiance.
struct Needs {
  bool ggx = false;  ///< radiance filtered with GGX lobes, and the table of their reflectance
  bool power = false, microfacets = false, grazing = false;
  bool sharp = false;  ///< the radiance itself
};

Needs needsOf(const TechniqueInputs& inputs) {
  const uint32_t kinds = inputs.handles.modelKinds;
  Needs needs{.power = (kinds & kLobeKinds) != 0,
              .microfacets = (kinds & kMicrofacetKinds) != 0,
              .grazing = (kinds & kEnteredKinds) != 0};
  // What enters translucent surfaces is asked for without any other.
  if ((kinds & 1u << glsl::model_entry) == 0)
    needs.ggx = std::ranges::any_of(inputs.pose.instances, [&](const scene::DrawInstance& drawn) {
      const scene::Material& m = scene::materialOf(inputs.scene, drawn);
      return m.model ? m.model->kind == glsl::model_measured : !m.lambertian() && !m.specularSurface();
    });
  needs.sharp = needs.ggx || needs.power || (kinds & 1u << glsl::model_coated) != 0;
  return needs;
}

/// Returns the format of filtered radiance, means of the picture's: half floats where they hold its brightest
/// pixel.
GLenum filteredFormat(const scene::Environment& picture) {
  const bool bright = std::ranges::any_of(picture.texels, [](const glm::vec3& radiance) {
    return std::max({radiance.x, radiance.y, radiance.z}) > kMostInHalves;
  });
  return bright ? GL_RGBA32F : GL_RGBA16F;
}

/// Holds what surfaces look up; empty: none has needed it so far.
struct Maps {
  TextureHandle sharp, irradiance, filtered;
  TextureHandle power, microfacetLobes, grazing;
};

class PrefilteredEnvironment : public Technique {
  gpu::Sampler sampler_;  ///< bilinear within a level, repeated around the horizon
  Maps maps_;             ///< of all requests: what enters translucent surfaces is asked for apart

  TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                          const TermRequest& request) override {
    if (scene::isBlack(inputs.scene.environment)) {
      graph.leaveOut("environment light", info.name, "the environment is black");
      return request.target;
    }
    if (!sampler_)
      sampler_ = gpu::Sampler(inputs.gpuScene.device(), GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR, GL_REPEAT);
    const Needs needs = needsOf(inputs);
    addMaps(graph, inputs, needs);
    return addReflection(graph, inputs, request.target, needs);
  }

  /// Declares the passes of the maps that are needed and that no earlier request has had declared.
  void addMaps(frame::FrameGraph& graph, const TechniqueInputs& inputs, const Needs& needs) {
    const Filtering filtering(graph, inputs.parameters, sampler_);
    const scene::Environment& picture = inputs.scene.environment;
    const TextureHandle environment = inputs.service<shading_maps::ShadingMapService>().radianceLevels();
    const auto make = [](bool needed, TextureHandle& map, const auto& add) {
      if (needed && !map) map = add();
    };
    const glm::ivec2 size(picture.width, picture.height);
    make(needs.sharp, maps_.sharp, [&] { return filtering.addChain(environment, size); });
    make(true, maps_.irradiance,
         [&] { return filtering.addIrradiance(environment, size, Irradiance::whole); });
    make(needs.ggx, maps_.filtered,
         [&] { return filtering.addLobes(maps_.sharp, Lobes::ggx, filteredFormat(picture)); });
    make(needs.power, maps_.power,
         [&] { return filtering.addLobes(maps_.sharp, Lobes::power, filteredFormat(picture)); });
    make(needs.microfacets, maps_.microfacetLobes, [&] { return filtering.addMicrofacetLobes(); });
    make(needs.grazing, maps_.grazing,
         [&] { return filtering.addIrradiance(environment, size, Irradiance::grazing); });
  }

  /// Declares the passes that filter the environment; they run again when it changes.
  class Filtering {
   public:
    Filtering(frame::FrameGraph& graph, const ParameterValues& parameters, const gpu::Sampler& sampler)
        : graph_(graph),
          sampler_(sampler),
          paraboloid_(parameters.choice("map") == paraboloid),
          size_(parameters.integer("size")),
          samples_(parameters.integer("samples")) {}

    /// Returns the radiance in the technique's map, each level half as large as the one before.
    TextureHandle addChain(TextureHandle environment, const glm::ivec2& source) const {
      const int levels = levelOf(size_, kCoarsestSize) + 1;
      const gpu::TextureDesc map = desc(GL_RGBA32F, size_, levels);
      TextureHandle chain = graph_.createTexture("radiance of the environment", map);
      for (int level = 0; level < levels; ++level) {
        const bool base = level == 0;
        frame::PassBuilder pass = addPass("resample environment level " + std::to_string(level));
        if (base) pass.read(environment, Access::sampled, "environment_map", "its picture");
        chain = pass.write(chain, base ? Access::imageStore : Access::imageLoadStore,
                           ShaderName("coarser").level(level), "means over texels");
        if (!base) pass.also(ShaderName("finer").level(level - 1));
        const auto program = pass.program(shader("resample", {{"BASE", base ? "1" : "0"}}));
        pass.execute(
            [=, across = base ? samplesAcross(source) : kSamplesAcrossLevel](frame::PassContext& context) {
              context.use(program).set("samples_across", across);
              dispatch(context, map, level);
            });
      }
      return chain;
    }

    /// Returns the irradiance of surfaces that face each direction, W/m^2, from a picture with coarser
    /// levels.
    TextureHandle addIrradiance(TextureHandle environment, const glm::ivec2& source, Irradiance kind) const {
      const bool grazing = kind == Irradiance::grazing;
      const std::string name =
          grazing ? "grazing irradiance of the environment" : "irradiance of the environment";
      const gpu::TextureDesc extent = desc(GL_RGBA32F, kIrradianceSize, 1);
      frame::PassBuilder pass = addPass(name);
      pass.read(environment, Access::sampled, "environment_levels_map", "radiance");
      const TextureHandle irradiance =
          pass.write(graph_.createTexture(name, extent), Access::imageStore, "irradiance",
                     grazing ? "for what lies under a coat" : "for diffuse surfaces");
      const auto program = pass.program(shader("irradiance", {{"GRAZING", grazing ? "1" : "0"}}));
      int level = std::max(levelOf(source.y, kIrradianceSize), 0);
      while (source.x >> level > kMostIrradianceColumns) ++level;
      const glm::ivec2 summed = glm::max(source >> level, 1), least(2 * kIrradianceSize, kIrradianceSize);
      const glm::ivec2 parts = (least + summed - 1) / summed;
      pass.execute([=](frame::PassContext& context) {
        gpu::Program& sum = context.use(program);
        sum.set("source_level", level);
        sum.set("columns_of_texel", parts.x);
        sum.set("rows_of_texel", parts.y);
        dispatch(context, extent);
      });
      return irradiance;
    }

    /// Returns the radiance filtered by lobes, a level for each width: those of glsl::environment_alpha(1),
    /// (2) and so on, or of glsl::power_level_alpha(0), (1) and so on.
    TextureHandle addLobes(TextureHandle chain, Lobes lobes, GLenum format) const {
      const bool power = lobes == Lobes::power;
      const std::string name = power ? "environment filtered with power lobes" : "filtered environment";
      const gpu::TextureDesc map = desc(format, size_, kFilteredLevels);
      TextureHandle filtered = graph_.createTexture(name, map);
      for (int level = 0; level < kFilteredLevels; ++level) {
        frame::PassBuilder pass =
            addPass((power ? "filter environment with power lobes, level " : "filter environment level ") +
                    std::to_string(level + 1));
        pass.read(chain, Access::sampled, ShaderName("source").sampledWith(&sampler_), "radiance");
        filtered = pass.write(filtered, level == 0 ? Access::imageStore : Access::imageLoadStore,
                              ShaderName("filtered").level(level),
                              power ? "for lobes of models" : "for glossy surfaces");
        std::map<std::string, std::string> defines{
            {"POWER_LOBES", power ? "1" : "0"},
            {"FILTERED_FORMAT", format == GL_RGBA32F ? "rgba32f" : "rgba16f"}};
        if (power) defines["MATERIAL_MODELS"] = "0";
        const auto program = pass.program(shader("filter", std::move(defines)));
        pass.execute([=,
                      alpha = power ? glsl::power_level_alpha(level)
                                    : glsl::environment_alpha(static_cast<float>(level + 1)),
                      samples = samples_ << level](frame::PassContext& context) {
          gpu::Program& kernel = context.use(program);
          kernel.set("alpha", alpha);
          kernel.set("samples", samples);
          dispatch(context, map, level);
        });
      }
      return filtered;
    }

    /// Returns the table of glsl::microfacet_lobe().
    TextureHandle addMicrofacetLobes() const {
      constexpr int size = glsl::microfacet_lobe_table_size;
      frame::PassBuilder pass = addPass("lobes of microfacets");
      const TextureHandle lobes = pass.write(
          graph_.createTexture("lobes of microfacets", {.format = GL_RGBA32F, .width = size, .height = size}),
          Access::imageStore, "lobes", "where models look into the maps");
      const auto program =
          pass.program(shader("lobes", {{"MATERIAL_MODELS", std::to_string(kMicrofacetKinds)}}));
      pass.execute([=](frame::PassContext& context) {
        context.use(program);
        context.dispatch(size, size, 1, kGroupSize, kGroupSize);
      });
      return lobes;
    }

    /// Returns a shader of the technique with the chosen map.
    gpu::ProgramDesc shader(const std::string& name, std::map<std::string, std::string> defines) const {
      defines["PREFILTERED_PARABOLOID"] = paraboloid_ ? "1" : "0";
      return {.files = {"techniques/prefiltered_environment/" + name + ".comp.glsl"},
              .defines = std::move(defines)};
    }

   private:
    static constexpr int kSamplesAcrossLevel = 4;  ///< of about two texels
    static constexpr int kMostSamplesAcross = 32;

    gpu::TextureDesc desc(GLenum format, int size, int levels) const {
      return {.target = GL_TEXTURE_2D_ARRAY,
              .format = format,
              .width = paraboloid_ ? size : 2 * size,
              .height = size,
              .layers = paraboloid_ ? 2 : 1,
              .levels = levels};
    }

    /// Returns the last level of a chain that is at least `size` large; -1: none is.
    static int levelOf(int largest, int size) {
      return std::bit_width(static_cast<unsigned>(largest / size)) - 1;
    }

    /// Returns how many samples lie along a texel of level 0, two in each pixel of the picture where the
    /// texel is widest, along the side on which pixels are narrower.
    int samplesAcross(const glm::ivec2& source) const {
      const double radians = paraboloid_ ? 4.0 / (size_ - 2) : std::numbers::pi / (size_ - 1);
      const double pixels = radians * std::max(source.x, 2 * source.y) / (2 * std::numbers::pi);
      return std::clamp(static_cast<int>(std::ceil(2 * pixels)), 2, kMostSamplesAcross);
    }

    frame::PassBuilder addPass(const std::string& name) const {
      frame::PassBuilder pass = graph_.addPass(name, info.name);
      pass.role(frame::PassRole::filter).cacheable();
      return pass;
    }

    /// Runs the program in use on all texels of a level.
    static void dispatch(frame::PassContext& context, const gpu::TextureDesc& map, int level = 0) {
      context.dispatch(map.width >> level, map.height >> level, map.layers, kGroupSize, kGroupSize);
    }

    frame::FrameGraph& graph_;
    const gpu::Sampler& sampler_;
    bool paraboloid_;
    int size_, samples_;
  };

  TextureHandle addReflection(frame::FrameGraph& graph, const TechniqueInputs& inputs, TextureHandle target,
                              const Needs& needs) {
    frame::PassBuilder pass = graph.addPass("environment light", info.name);
    pass.read(inputs.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, rotation, scale");
    const scene::SurfaceInput surfaces(inputs.handles, inputs.gbuffer);
    surfaces.declare(pass);
    const auto look = [&](bool needed, TextureHandle map, const char* name, const char* why) {
      if (needed) pass.read(map, Access::sampled, ShaderName(name).sampledWith(&sampler_), why);
    };
    look(true, maps_.irradiance, "irradiance_map", "diffuse light");
    look(needs.sharp, maps_.sharp, "sharp_map", "light of smooth surfaces");
    look(needs.ggx, maps_.filtered, "filtered_map", "glossy light");
    look(needs.power, maps_.power, "power_map", "light of models' lobes");
    look(needs.microfacets, maps_.microfacetLobes, "microfacet_lobes", "where models look");
    look(needs.grazing, maps_.grazing, "grazing_map", "light that enters coats and bodies");
    if (needs.ggx)
      pass.read(inputs.service<shading_maps::ShadingMapService>().ltcTable(), Access::sampled, "ltc_table",
                "glossy reflectance");
    const TextureHandle radiance =
        pass.write(target, Access::imageLoadStore, "radiance", "light of the environment, V = 1");
    gpu::ProgramDesc desc =
        Filtering(graph, inputs.parameters, sampler_)
            .shader("environment", {{"MEDIUM", inputs.scene.medium.present() ? "1" : "0"},
                                    {"GGX_LOBES", needs.ggx ? "1" : "0"},
                                    {"LOOKUP", std::to_string(inputs.parameters.choice("lookup"))}});
    if (inputs.parameters.choice("fresnel") == schlick) desc.defines["FRESNEL_SCHLICK"] = "1";
    surfaces.define(desc.defines);
    const scene::MediumInput medium(inputs.handles);
    medium.define(desc.defines);
    medium.declare(pass);
    const auto program = pass.program(std::move(desc));
    pass.execute([=, size = inputs.size](frame::PassContext& context) {
      context.use(program);
      context.dispatch(size.x, size.y, 1, kGroupSize, kGroupSize);
    });
    return radiance;
  }

 public:
  static constexpr TechniqueInfo info{
      .name = "prefiltered_environment",
      .title = "Prefiltered environment",
      .source = "Kautz, Vazquez, Heidrich, Seidel 2000; Karis 2013 (split sum)",
      .terms = termSet(Term::environment),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(PrefilteredEnvironment::info, PrefilteredEnvironment)
