// The environment's light as all that surfaces would reflect of it without shadows, less what is hidden of a
// few samples, which blocks of pixels may share.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/pixel_blocks.h"
#include "core/gpu_scene/surface_input.h"
#include "core/scene/environment_light.h"
#include "core/shading_maps/shading_maps.h"
#include "core/shadow/environment_samples.h"
#include "core/technique/frame_budget.h"
#include "core/technique/technique.h"
#include "glsl/materials/material_model.glsl"
#include "techniques/subtractive_shadows/levels.h"
#include "techniques/subtractive_shadows/radiance_cache.h"

namespace {

using namespace limn;
using frame::Access;
using frame::TextureHandle;
using subtractive_shadows::Fade;
using subtractive_shadows::Level;
using subtractive_shadows::RadianceCache;

enum Combine : int { subtract, ratio, ratioSplit, add };
constexpr const char* kCombines[] = {"subtract", "ratio", "ratio_split", "add"};
enum Unshadowed : int { prefiltered, brdfSamples, cache, lights };
constexpr const char* kUnshadowed[] = {"prefiltered", "brdf_samples", "cache", "lights"};
enum Sampling : int { importance, regions };
constexpr const char* kSamplings[] = {"importance", "regions"};
enum class Shown : int { light, unshadowed, shadowBuffer, hidden };
constexpr const char* kShows[] = {"light", "unshadowed", "shadow_buffer", "hidden"};
constexpr int kMostLights = 4096;

constexpr Parameter kParameters[] = {
    integer("lights", 25, {1, kMostLights}, "lights",
            "Samples of the environment whose shadows are found, and shadow maps rendered for them")
        .quality()
        .logScale(),
    integer("block", 4, {1, 32}, "pixels", "Side of the blocks of pixels that share shadows"),
    choice(
        "combine", ratioSplit, kCombines,
        "How light and shadows are combined: the hidden light is subtracted, as published; the light is "
        "reduced by the share of the samples' light that is hidden, of all light or of the diffuse part and "
        "of the lobe apart; or the visible samples are added up, without the unshadowed light"),
    boolean("demodulate", true,
            "Without the surface's colours in what is subtracted or added, which blocks of pixels share"),
    choice("unshadowed", brdfSamples, kUnshadowed,
           "Where the light without shadows comes from: filtered maps, samples of each pixel's lobe, a "
           "cache of what materials reflect by normal, as published, or more samples of the environment than "
           "have shadows"),
    integer("brdf_samples", 32, {1, 1024}, "samples",
            "Samples of a lobe for the light without shadows, of a pixel or a texel of the cache")
        .logScale(),
    real("full_reflectance", 0.125, {0, 1}, "",
         "Share of its light from which a pixel's lobe reflects on with all brdf_samples; lobes that reflect "
         "less have fewer, in proportion"),
    integer("unshadowed_factor", 16, {1, 64}, "times",
            "Samples of the light without shadows, over those that have shadows"),
    choice("sampling", importance, kSamplings,
           "What the samples are: points drawn by the environment's brightness, or the regions it is "
           "decomposed into, each with all of its light"),
    real("region_threshold", 0.015, {1e-4, 0.5}, "",
         "Least share of a region's light that a further row of texels must add for the region to grow; "
         "smaller: fewer regions")
        .logScale(),
    real("position_width", 2.2, {0.1, 100}, "blocks",
         "Standard deviation of the distance within which a pixel takes shadows from a block")
        .logScale(),
    real("normal_width", 0.3, {0.01, 10}, "",
         "Standard deviation of the difference of unit normals within which it does")
        .logScale(),
    real("frame_time", 0, {0, 1e4}, "ms",
         "Time that a frame may take: lights become fewer, and blocks larger where that is not enough, until "
         "it does; 0: always all lights, as of regions; benches accept nothing else")
        .byClock(),
    choice("show", 0, kShows,
           "The light, or in its place that without shadows, what each block of pixels knows to be hidden of "
           "it, or what is taken from it after pixels have looked at the blocks around them"),
    shadow::shadowMapSizeParameter(512),
    shadow::shadowMapFitParameter(),
    shadow::biasParameter(),
    shadow::memoryParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one light", .settings = "lights=1", .factor = 8},
    {.name = "4096 lights", .settings = "lights=4096 shadow_map_size=64", .factor = 2},
    {.name = "blocks of 32 pixels", .settings = "block=32", .factor = 4},
    {.name = "every pixel", .settings = "block=1"},
    {.name = "subtracted", .settings = "combine=subtract", .factor = 4},
    {.name = "one sample of each lobe", .settings = "brdf_samples=1", .factor = 4},
    {.name = "1024 samples of each lobe", .settings = "brdf_samples=1024"},
    {.name = "filtered maps", .settings = "unshadowed=prefiltered", .factor = 4},
    {.name = "radiance cache", .settings = "unshadowed=cache", .factor = 4},
    {.name = "added", .settings = "combine=add", .factor = 8},
    {.name = "the shadow buffer", .settings = "show=shadow_buffer", .factor = 0},
    {.name = "maps of 16 texels", .settings = "shadow_map_size=16", .factor = 8},
    {.name = "batches of one map", .settings = "shadow_map_size=2048 memory=32"},
};

/// What lobe_light.glsl takes its samples by, in passes with the unshadowed light.
struct LobeSampling {
  int samples = 0;  ///< 0: none
  float fullReflectance = 0;

  LobeSampling(const ParameterValues& p, Unshadowed unshadowed) {
    if (unshadowed != brdfSamples) return;
    samples = p.integer("brdf_samples");
    fullReflectance = static_cast<float>(p.real("full_reflectance"));
  }

  void set(gpu::Program& program) const {
    if (samples == 0) return;
    program.set("brdf_samples", samples);
    program.set("full_reflectance", fullReflectance);
  }
};

class SubtractiveShadows : public Technique {
  /// Of all requests: what enters translucent surfaces is asked for apart.
  shadow::EnvironmentSamples samples_, unshadowed_;
  frame::BufferHandle samplesHandle_, unshadowedHandle_;
  RadianceCache cache_;
  std::vector<Level> levels_;
  const FrameBudget* budget_ = nullptr;  ///< null: all lights, whatever it takes
  int lights_ = 0;                       ///< that the graph is built for
  Fade built_;                           ///< whose blocks the graph has
  Shown shown_ = Shown::light;

  TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                          const TermRequest& request) override {
    const scene::EnvironmentLight& environment =
        inputs.service<shading_maps::ShadingMapService>().environmentLight();
    if (!environment.present()) {
      graph.leaveOut("environment", info.name, "the environment is black");
      return request.target;
    }
    const ParameterValues& p = inputs.parameters;
    shown_ = static_cast<Shown>(p.choice("show"));
    if (shown_ != Shown::light && p.choice("combine") == add)
      throw UsageError(
          "subtractive_shadows: show goes with combine=subtract, ratio and ratio_split; what is added up is "
          "taken from no unshadowed light");
    chooseLevels(inputs);
    takeSamples(graph, environment, inputs);
    if (p.choice("combine") == add && built_.more.block == 1 && !budget_)
      return shadow::addSampledEnvironment(graph, inputs, info.name, samples_, samplesHandle_,
                                           request.target);
    const Unshadowed unshadowed = findUnshadowed(graph, inputs);
    const TextureHandle target =
        Passes(graph, inputs, *this, built_.more.block, unshadowed).add(request.target);
    if (built_.fewer.block == built_.more.block) return target;
    return Passes(graph, inputs, *this, built_.fewer.block, unshadowed).add(target);
  }

  void chooseLevels(const TechniqueInputs& inputs) {
    const ParameterValues& p = inputs.parameters;
    const Level best{p.integer("lights"), p.integer("block")};
    const double time = p.choice("sampling") == importance ? p.real("frame_time") : 0;
    levels_ = time > 0 ? subtractive_shadows::levelsBelow(best) : std::vector{best};
    lights_ = best.lights;
    built_ = {best, best};
    if (!(time > 0)) return;
    std::vector<double> work;
    for (const Level& level : levels_) work.push_back(level.work());
    budget_ = &inputs.service<FrameBudgetService>().request(info.name, time, work);
    lights_ = neededLights();
    built_ = fade();
  }

  int neededLights() const { return levels_[static_cast<size_t>(budget_->dearest())].lights; }
  Fade fade() const { return subtractive_shadows::fadeAt(levels_, budget_->position(), budget_->target()); }

  /// Maps are kept while lights fade out, and there before lights fade in; of blocks there are both sizes
  /// while one fades into the other.
  bool update(const scene::Pose&) override {
    if (!budget_) return false;
    const Fade now = fade();
    if (now.fewer.block != built_.fewer.block || now.more.block != built_.more.block) return true;
    const bool settled = budget_->position() == budget_->target();
    return neededLights() > lights_ || (settled && neededLights() < lights_);
  }

  /// Sets what glsl/shadow/environment_samples.glsl fades by; sums of one batch alone know nothing of shares.
  void setLights(gpu::Program& program, bool shares) const {
    if (!budget_) return;
    const Fade now = fade();
    program.set("fewer_samples", now.fewer.lights);
    program.set("more_samples", now.more.lights);
    if (shares) program.set("share_of_more", now.shareOfMore);
  }

  /// Sets what a picture with blocks of that side shows, and its share.
  void setPicture(gpu::Program& program, int block) const {
    if (shown_ != Shown::light) program.set("shown_part", static_cast<int>(shown_));
    if (!budget_) return;
    const Fade now = fade();
    const bool alone = now.fewer.block == now.more.block;
    program.set("picture_share", alone ? 1 : block == now.more.block ? now.shareOfMore : 1 - now.shareOfMore);
  }

  void takeSamples(frame::FrameGraph& graph, const scene::EnvironmentLight& environment,
                   const TechniqueInputs& inputs) {
    if (samplesHandle_) return;
    const ParameterValues& p = inputs.parameters;
    const bool asSamples = p.choice("unshadowed") == lights && p.choice("combine") != add;
    const int withoutShadows = p.integer("lights") * p.integer("unshadowed_factor");
    const int most = shadow::mostSamplesOfLoop(inputs);
    if (asSamples && withoutShadows > most)
      throw UsageError(
          fmt::format("subtractive_shadows: lights={} and unshadowed_factor={} make {} samples of the light "
                      "without shadows; on software renderers unshadowed=lights takes at most {}{}",
                      p.integer("lights"), p.integer("unshadowed_factor"), withoutShadows, most,
                      inputs.handles.density ? " where a medium has a grid" : ""));
    gpu::Device& device = inputs.gpuScene.device();
    samples_ = p.choice("sampling") == regions
                   ? shadow::EnvironmentSamples(device, inputs.scene.environment, p.real("region_threshold"))
                   : shadow::EnvironmentSamples(device, environment, lights_);
    samplesHandle_ = graph.importBuffer("samples of the environment", samples_.buffer());
    if (!asSamples) return;
    unshadowed_ = shadow::EnvironmentSamples(device, environment, withoutShadows);
    unshadowedHandle_ = graph.importBuffer("samples of the unshadowed light", unshadowed_.buffer());
  }

  /// Returns where the unshadowed light of a request comes from, and makes the cache where it comes from
  /// there. What has no lobes has it from filtered maps in place of samples of lobes or of the cache.
  Unshadowed findUnshadowed(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
    const ParameterValues& p = inputs.parameters;
    const auto asked = static_cast<Unshadowed>(p.choice("unshadowed"));
    if (p.choice("combine") == add) return prefiltered;
    if (asked == lights) return lights;
    if ((inputs.handles.modelKinds & 1u << glsl::model_entry) != 0) return prefiltered;
    if (asked == cache && !cache_.add(graph, inputs, info.name, p.integer("brdf_samples")))
      return prefiltered;
    return asked;
  }

  /// Declares the passes of one request.
  class Passes {
   public:
    Passes(frame::FrameGraph& graph, const TechniqueInputs& inputs, const SubtractiveShadows& technique,
           int block, Unshadowed unshadowed)
        : graph_(graph),
          inputs_(inputs),
          technique_(technique),
          unshadowed_(unshadowed),
          combine_(static_cast<Combine>(inputs.parameters.choice("combine"))),
          coats_((inputs.handles.modelKinds & 1u << glsl::model_coated) != 0),
          parts_(coats_ || combine_ == ratioSplit || (demodulated() && !byRatio())),
          blocks_(graph, inputs.gpuScene.device(), inputs.handles, inputs.gbuffer, inputs.size,
                  {.side = block,
                   .positionWidth = inputs.parameters.real("position_width"),
                   .normalWidth = inputs.parameters.real("normal_width")},
                  info.name) {}

    TextureHandle add(TextureHandle target) {
      const bool everyPixel = blocks_.side() == 1;
      TechniqueInputs items = inputs_;
      items.size = blocks_.grid();
      for (const shadow::SampleBatch& batch : shadow::sampleBatches(technique_.samples_, inputs_)) {
        shadow::VisibilityPass pass =
            shadow::environmentSamplePass(inputs_, info.name, technique_.samples_, technique_.samplesHandle_,
                                          batch, "techniques/subtractive_shadows/shadow_buffer.comp.glsl");
        pass.name = "shadow buffer";
        batch.defineOrder(pass.program.defines);
        define(pass.program.defines);
        pass.bind = [&technique = technique_, bind = std::move(pass.bind),
                     light = everyPixel && batch.isLast(), shares = coats_ || batch.isLast(),
                     lobes = LobeSampling(inputs_.parameters, unshadowed_)](frame::PassContext& context,
                                                                            gpu::Program& program) {
          bind(context, program);
          technique.setLights(program, shares);
          if (!light) return;
          technique.setPicture(program, 1);
          lobes.set(program);
        };
        pass.declare = [&, declare = std::move(pass.declare)](frame::PassBuilder& builder) {
          declare(builder);
          blocks_.readItems(builder);
          handOn(builder, batch);
          if (!batch.isLast()) return;
          if (everyPixel)
            readUnshadowed(builder);
          else if (parts_)
            lobeValues_ = builder.write(createItems("shadow buffer of lobes", valueFormat()),
                                        Access::imageStore, "lobe_values", "shadows of lobes");
        };
        if (!batch.isLast()) {
          addSums(items, std::move(pass), batch);
        } else if (everyPixel) {
          pass.image = "radiance";
          pass.accumulate = true;
          target = shadow::addVisibilityPass(graph_, items, target, std::move(pass));
        } else {
          pass.image = "values";
          values_ = shadow::addVisibilityPass(graph_, items, createItems("shadow buffer", valueFormat()),
                                              std::move(pass));
        }
      }
      return everyPixel ? target : addResampling(target);
    }

   private:
    bool demodulated() const { return inputs_.parameters.boolean("demodulate"); }
    bool byRatio() const { return combine_ == ratio || combine_ == ratioSplit; }
    /// Shares lie in [0, 1]; light knows no bound.
    GLenum valueFormat() const { return byRatio() ? GL_RGBA16 : GL_RGBA32F; }

    TextureHandle createItems(const char* name, GLenum format, int levels = 1) {
      return graph_.createTexture(
          name, {.format = format, .width = blocks_.grid().x, .height = levels * blocks_.grid().y});
    }
    /// Between two numbers of lights both have their sums.
    TextureHandle createSums(const char* name) {
      return createItems(name, GL_RGBA32F, technique_.budget_ ? 2 : 1);
    }

    void define(std::map<std::string, std::string>& defines) const {
      blocks_.define(defines);
      defines["COMBINE"] = std::to_string(combine_);
      defines["DEMODULATE"] = demodulated() ? "1" : "0";
      defines["SAMPLE_FADE"] = technique_.budget_ ? "1" : "0";
      defines["SHOW"] = technique_.shown_ != Shown::light ? "1" : "0";
      defines["UNSHADOWED"] = std::to_string(unshadowed_);
      defines["VALUE_FORMAT"] = byRatio() ? "rgba16" : "rgba32f";
    }

    /// Declares the sums that batches hand on, but for those that the pass's target holds.
    void handOn(frame::PassBuilder& builder, const shadow::SampleBatch& batch) {
      if (batch.isFirst() && batch.isLast()) return;
      constexpr const char* why = "sums over earlier samples";
      const auto sums = [&](TextureHandle& texture, const char* name) {
        if (batch.isFirst()) texture = createSums(name);
        if (batch.isLast())
          builder.read(texture, Access::imageLoad, name, why);
        else
          texture = builder.write(texture, batch.isFirst() ? Access::imageStore : Access::imageLoadStore,
                                  name, why);
      };
      if (batch.isLast()) builder.read(seenSums_, Access::imageLoad, "seen_sums", why);
      if (combine_ != Combine::add) sums(allSums_, "all_sums");
      if (!parts_) return;
      sums(seenLobeSums_, "seen_lobe_sums");
      if (combine_ != Combine::add) sums(allLobeSums_, "all_lobe_sums");
    }

    void addSums(const TechniqueInputs& items, shadow::VisibilityPass pass,
                 const shadow::SampleBatch& batch) {
      pass.image = "seen_sums";
      pass.accumulate = !batch.isFirst();
      if (batch.isFirst()) seenSums_ = createSums("seen_sums");
      seenSums_ = shadow::addVisibilityPass(graph_, items, seenSums_, std::move(pass));
    }

    /// Declares what unshadowed.glsl looks up.
    void readUnshadowed(frame::PassBuilder& builder) {
      auto& maps = inputs_.service<shading_maps::ShadingMapService>();
      if (coats_ && (unshadowed_ == lights || combine_ == Combine::add))
        builder.read(maps.radiance(), Access::sampled, "environment_map", "what coats mirror");
      if (combine_ == Combine::add) return;
      if (unshadowed_ == lights)
        builder.read(technique_.unshadowedHandle_, Access::storageLoad, "UnshadowedSamples",
                     "light without shadows");
      else
        maps.readReflected(builder, inputs_.handles.modelKinds);
      if (unshadowed_ == brdfSamples)
        builder.read(maps.radianceLevels(), Access::sampled, "environment_levels_map", "light of lobes");
      if (unshadowed_ == cache) technique_.cache_.read(builder, inputs_, blocks_.side() > 1);
    }

    TextureHandle addResampling(TextureHandle target) {
      frame::PassBuilder builder = graph_.addPass("resample and subtract", info.name);
      builder.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, rotation, scale");
      const scene::SurfaceInput surfaces(inputs_.handles, inputs_.gbuffer);
      surfaces.declare(builder);
      const scene::MediumInput medium(inputs_.handles);
      medium.declare(builder);
      blocks_.readUpsampling(builder);
      builder.read(values_, Access::sampled, "values", "shadows of blocks");
      if (parts_) builder.read(lobeValues_, Access::sampled, "lobe_values", "shadows of lobes");
      readUnshadowed(builder);
      const TextureHandle radiance = builder.write(target, Access::imageLoadStore, "radiance",
                                                   "light of the environment, shadows included");
      gpu::ProgramDesc desc{.files = {"techniques/subtractive_shadows/resample.comp.glsl"},
                            .defines = {{"MEDIUM", inputs_.scene.medium.present() ? "1" : "0"}}};
      define(desc.defines);
      surfaces.define(desc.defines);
      medium.define(desc.defines);
      const auto program = builder.program(std::move(desc));
      builder.execute([&technique = technique_, program, blocks = blocks_,
                       lobes = LobeSampling(inputs_.parameters, unshadowed_),
                       size = inputs_.size](frame::PassContext& context) {
        gpu::Program& used = context.use(program);
        blocks.bind(used);
        technique.setPicture(used, blocks.side());
        lobes.set(used);
        context.dispatch(size.x, size.y, 1, 8, 8);
      });
      return radiance;
    }

    frame::FrameGraph& graph_;
    const TechniqueInputs& inputs_;
    const SubtractiveShadows& technique_;
    Unshadowed unshadowed_;
    Combine combine_;
    bool coats_, parts_;
    scene::PixelBlocks blocks_;
    TextureHandle seenSums_, allSums_, seenLobeSums_, allLobeSums_;
    TextureHandle values_, lobeValues_;
  };

 public:
  static constexpr TechniqueInfo info{
      .name = "subtractive_shadows",
      .title = "Subtractive shadows",
      .source = "DeCoro and Rusinkiewicz 2008; Heitz, Hill, McGuire 2018 (ratio)",
      .terms = termSet(Term::environment),
      .parameters = kParameters,
      .stress = kStress};
};

}  // namespace

LIMN_TECHNIQUE(SubtractiveShadows::info, SubtractiveShadows)
