// Light from bump to bump of height maps, along paths that are traced once.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/light_textures.h"
#include "core/relief_maps/relief_maps.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/light_batch.h"
#include "core/technique/technique.h"
#include "techniques/bump_interreflection/flat_bases.h"

namespace {

using namespace limn;
using bump_interreflection::FlatBases;
using frame::Access;
using relief_maps::ReliefMaps;

constexpr const char* kDirections[] = {"own_frame", "shared", "published"};
constexpr const char* kSpaces[] = {"pixel", "texture"};
enum Shape { horizonMap, moments };
constexpr const char* kShapes[] = {"horizon_map", "moments"};
constexpr const char* kLookups[] = {"between", "nearest"};

constexpr Parameter kParameters[] = {
    integer("paths", 64, {1, 1024}, "paths", "To each texel of a height map").quality().logScale(),
    choice("directions", 0, kDirections,
           "own_frame: a spiral about each texel's normal; shared: one for all texels, down to the steepest "
           "slope; published: random ones above the base, which lose the light from below it"),
    integer("bounces", 1, {1, 8}, "bounces", "From bump to bump"),
    choice("space", 0, kSpaces,
           "pixel: paths are followed for each pixel; texture: for each texel of flat surfaces under light "
           "from far away, and for each pixel elsewhere"),
    choice("lookup", 0, kLookups, "Between texels, or of the one nearest to a pixel's centre"),
    choice("shape", horizonMap, kShapes, "What says which lights the bumps see"),
    integer("azimuths", 16, {8, 128}, "azimuths", "Of the horizons of the bumps").quality().logScale(),
    boolean("shadows", true, "Other surfaces keep light from the bumps: one test of a shadow map per light"),
    shadow::shadowMapSizeParameter(),
    shadow::biasParameter(),
};
constexpr StressCase kStress[] = {
    {.name = "one path", .scene = "egg_crate", .settings = "paths=1", .factor = 8},
    {.name = "eight bounces", .scene = "egg_crate", .settings = "bounces=8"},
    {.name = "bounces of texels", .scene = "egg_crate", .settings = "space=texture bounces=8"},
    {.name = "published directions", .scene = "egg_crate", .settings = "directions=published", .factor = 2},
    {.name = "1024 paths of the nearest texel", .scene = "groove", .settings = "paths=1024 lookup=nearest"},
    {.name = "a curved surface", .scene = "bump_sphere", .settings = "paths=16 lookup=nearest", .factor = 2},
    {.name = "bumps of a scene of 1e-4",
     .change = StressChange::sceneScale,
     .amount = 1e-4,
     .scene = "bump_wall"},
    {.name = "bumps of a scene of 1e4",
     .change = StressChange::sceneScale,
     .amount = 1e4,
     .scene = "bump_wall"},
};

relief_maps::ReliefMapDesc lightsFor(const ParameterValues& parameters) {
  using relief_maps::Table;
  return {.table = parameters.choice("shape") == moments ? Table::moments : Table::horizons,
          .azimuths = parameters.integer("azimuths")};
}

relief_maps::ReliefMapDesc bouncesFor(const ParameterValues& parameters) {
  using relief::BounceDirections;
  constexpr std::array directions{BounceDirections::ownFrame, BounceDirections::shared,
                                  BounceDirections::published};
  return {.table = relief_maps::Table::bounces,
          .paths = parameters.integer("paths"),
          .bounceDirections = directions[static_cast<size_t>(parameters.choice("directions"))]};
}

/// Holds what the requests of a graph have in common: those for the light that translucent surfaces reflect
/// and for the light that enters them.
struct Shared {
  std::map<std::vector<uint32_t>, frame::TextureHandle> visibility;  ///< by the lights of a batch
  /// Holds for each light that is answered for texel by texel what the texels gather, bounce after bounce.
  std::map<uint32_t, std::vector<frame::BufferHandle>> gathered;
};

class BumpInterreflection : public Technique {
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request) override;

 public:
  static constexpr TechniqueInfo info{
      .name = "bump_interreflection",
      .title = "Light from bump to bump along traced paths",
      .source =
          "Heidrich, Daubert, Kautz, Seidel 2000, Illuminating Micro Geometry Based on Precomputed "
          "Visibility",
      .terms = termSet(Term::indirect),
      .parameters = kParameters,
      .stress = kStress,
      .places = true};

 private:
  /// Holds the flat bases on the GPU for as long as the graph that reads them.
  struct BaseBuffers {
    gpu::Buffer bases, ofInstances;
  };
  struct BaseHandles {
    frame::BufferHandle bases, ofInstances;
  };
  /// Imports the flat bases, once for all requests.
  void importBases(frame::FrameGraph& graph, const TechniqueInputs& inputs);

  FlatBases bases_;
  std::optional<BaseBuffers> baseBuffers_;
  BaseHandles baseHandles_;  ///< empty: no surface is flat, or paths are followed for each pixel
  Shared shared_;
};

/// Declares the passes of one request.
class Passes {
 public:
  Passes(frame::FrameGraph& graph, const TechniqueInputs& inputs, const FlatBases* bases,
         frame::BufferHandle baseBuffer, frame::BufferHandle basesOfInstances, Shared& shared)
      : graph_(graph),
        inputs_(inputs),
        bases_(bases),
        baseBuffer_(baseBuffer),
        basesOfInstances_(basesOfInstances),
        shared_(shared),
        lit_(inputs.service<relief_maps::ReliefMapService>().request(lightsFor(inputs.parameters))),
        bounces_(inputs.service<relief_maps::ReliefMapService>().request(bouncesFor(inputs.parameters))) {}

  /// Adds the light that a batch of lights sends from bump to bump to `target`, and returns it after that.
  /// `texels`: all of the batch are far away, and flat bases are answered for texel by texel.
  frame::TextureHandle add(std::span<const uint32_t> batch, bool texels, frame::TextureHandle target) {
    const frame::TextureHandle visibility = visibilityOf(batch);
    if (texels)
      for (size_t i = 0; i < batch.size(); ++i)
        target = addTexels(batch[i], static_cast<int>(i), visibility, target);
    if (texels && !bases_->curved) return target;
    return addPaths(batch, texels, visibility, target);
  }

 private:
  static constexpr const char* kName = BumpInterreflection::info.name;

  /// Returns V of a batch of lights; empty where other surfaces keep no light away.
  frame::TextureHandle visibilityOf(std::span<const uint32_t> batch) {
    if (!inputs_.parameters.boolean("shadows")) return {};
    const auto [known, isNew] =
        shared_.visibility.try_emplace(std::vector<uint32_t>(batch.begin(), batch.end()));
    if (isNew) known->second = addVisibility(batch);
    return known->second;
  }

  frame::TextureHandle addVisibility(std::span<const uint32_t> batch) {
    const frame::TextureHandle layers = graph_.createTexture(
        "visibility of bumps",
        {GL_TEXTURE_2D_ARRAY, GL_R16, inputs_.size.x, inputs_.size.y, static_cast<int>(batch.size()), 1});
    const TermRequest request{Term::visibility, batch, layers};
    return shadow::addVisibilityPass(graph_, inputs_, layers,
                                     shadow::visibilityPass(inputs_, request, kName));
  }

  /// Declares what techniques/bump_interreflection/bump_texels.glsl reads, and adds its defines.
  void readTexels(frame::PassBuilder& pass, std::map<std::string, std::string>& defines) const {
    pass.read(lit_.fields, Access::storageLoad, "ReliefFields", "sizes of height maps")
        .read(lit_.values, Access::storageLoad, "ReliefValues", "what their texels see of lights")
        .read(bounces_.fields, Access::storageLoad, "BounceFields", "where the paths of height maps begin")
        .read(bounces_.values, Access::storageLoad, "BounceWords", "what their texels see of each other");
    if (inputs_.parameters.choice("shape") == horizonMap)
      defines["RELIEF_AZIMUTHS"] = std::to_string(inputs_.parameters.integer("azimuths"));
  }

  /// Declares what techniques/bump_interreflection/bump_pixel.glsl reads, and returns the program's defines.
  std::map<std::string, std::string> readPixels(frame::PassBuilder& pass, bool flatBases,
                                                frame::TextureHandle visibility) const {
    const SceneHandles& scene = inputs_.handles;
    readSurfaces(pass, inputs_.gbuffer);
    pass.read(scene.frame, Access::uniformBuffer, "FrameBlock", "camera")
        .read(scene.lights, Access::storageLoad, "Lights", "what lights send")
        .read(inputs_.gbuffer.tangent, Access::sampled, kGBufferNames.tangent, "places in height maps")
        .read(inputs_.gbuffer.instance, Access::sampled, kGBufferNames.instance, "materials of surfaces")
        .read(scene.instances, Access::storageLoad, "Instances", "materials of surfaces")
        .read(scene.materials, Access::storageLoad, "Materials", "which height map they have");
    if (scene.models)
      pass.read(scene.models, Access::storageLoad, "MaterialModels", "albedo of material models");
    if (visibility) pass.read(visibility, Access::sampled, "visibility", "V of each light");
    if (inputs_.bodyAlbedo)
      pass.read(inputs_.bodyAlbedo, Access::sampled, "body_albedo", "what leaves bumps that light enters");
    if (flatBases) pass.read(basesOfInstances_, Access::storageLoad, "BasesOfInstances", "which are flat");
    std::map<std::string, std::string> defines{
        {"MATERIAL_MODELS", fmt::format("{}", scene.models ? scene.modelKinds : 0u)},
        {"VISIBILITY", visibility ? "1" : "0"},
        {"FLAT_BASES", flatBases ? "1" : "0"},
        {"ENTERING", inputs_.bodyAlbedo ? "1" : "0"},
        {"BETWEEN", inputs_.parameters.choice("lookup") == 0 ? "1" : "0"}};
    const scene::LightTextureInput textures(scene);
    textures.define(defines);
    textures.declare(pass);
    return defines;
  }

  frame::TextureHandle addPaths(std::span<const uint32_t> batch, bool flatBases,
                                frame::TextureHandle visibility, frame::TextureHandle target) {
    frame::PassBuilder pass = graph_.addPass("paths of pixels", kName);
    gpu::ProgramDesc program{.files = {"techniques/bump_interreflection/paths.comp.glsl"},
                             .defines = readPixels(pass, flatBases, visibility)};
    readTexels(pass, program.defines);
    const frame::TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "light from bump to bump");
    program.defines["LIGHT_COUNT"] = std::to_string(batch.size());
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, size = inputs_.size, paths = inputs_.parameters.integer("paths"),
                  bounces = inputs_.parameters.integer("bounces"),
                  indices = std::vector<uint32_t>(batch.begin(), batch.end())](frame::PassContext& context) {
      gpu::Program& bound = context.use(kernel);
      setLightIndices(bound, indices);
      bound.set("paths", paths);
      bound.set("bounces", bounces);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

  /// Adds the passes that answer for one light texel by texel.
  frame::TextureHandle addTexels(uint32_t light, int layer, frame::TextureHandle visibility,
                                 frame::TextureHandle target) {
    int bounce = 0;
    for (const frame::BufferHandle& texels : gatheredOf(light))
      target = addLookup(light, layer, ++bounce, texels, visibility, target);
    return target;
  }

  /// Returns what the texels of flat bases gather of one light, bounce after bounce.
  const std::vector<frame::BufferHandle>& gatheredOf(uint32_t light) {
    const auto [known, isNew] = shared_.gathered.try_emplace(light);
    std::vector<frame::BufferHandle>& gathered = known->second;
    if (!isNew) return gathered;
    frame::BufferHandle texels = addLitTexels(light);
    for (int bounce = 1; bounce <= inputs_.parameters.integer("bounces"); ++bounce)
      gathered.push_back(texels = addGatheredTexels(texels));
    return gathered;
  }

  frame::BufferHandle texelBuffer(std::string_view name) {
    return graph_.createBuffer(name, {bases_->texels * sizeof(float)});
  }

  /// Calls glDispatchCompute for the texels of each base.
  std::function<void(frame::PassContext&, gpu::Program&)> overBases() const {
    std::vector<glm::ivec2> sizes;
    for (const glsl::FlatBase& base : bases_->bases)
      sizes.push_back(inputs_.scene.heights[static_cast<size_t>(base.height)].size());
    return [sizes = std::move(sizes)](frame::PassContext& context, gpu::Program& program) {
      for (size_t i = 0; i < sizes.size(); ++i) {
        program.set("base_index", static_cast<int>(i));
        context.dispatch(sizes[i].x, sizes[i].y, 1, 8, 8);
      }
    };
  }

  frame::BufferHandle addLitTexels(uint32_t light) {
    frame::PassBuilder pass = graph_.addPass("lit texels", kName);
    gpu::ProgramDesc program{.files = {"techniques/bump_interreflection/lit_texels.comp.glsl"},
                             .defines = {}};
    readTexels(pass, program.defines);
    pass.read(inputs_.handles.lights, Access::storageLoad, "Lights", "where light comes from")
        .read(inputs_.handles.instances, Access::storageLoad, "Instances", "frames of flat surfaces")
        .read(baseBuffer_, Access::storageLoad, "FlatBases", "flat surfaces with height maps")
        .cacheable();
    const frame::BufferHandle lit =
        pass.write(texelBuffer("lit texels"), Access::storageStore, "Lit", "light on each texel");
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, light, dispatch = overBases()](frame::PassContext& context) {
      gpu::Program& bound = context.use(kernel);
      bound.set("light_index", light);
      dispatch(context, bound);
    });
    return lit;
  }

  frame::BufferHandle addGatheredTexels(frame::BufferHandle sent) {
    frame::PassBuilder pass = graph_.addPass("gathered texels", kName);
    gpu::ProgramDesc program{.files = {"techniques/bump_interreflection/gathered_texels.comp.glsl"},
                             .defines = {}};
    readTexels(pass, program.defines);
    pass.read(baseBuffer_, Access::storageLoad, "FlatBases", "flat surfaces with height maps")
        .read(sent, Access::storageLoad, "Sent", "light of the bounce before")
        .cacheable();
    const frame::BufferHandle gathered = pass.write(texelBuffer("gathered texels"), Access::storageStore,
                                                    "Gathered", "light from other texels");
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, paths = inputs_.parameters.integer("paths"),
                  dispatch = overBases()](frame::PassContext& context) {
      gpu::Program& bound = context.use(kernel);
      bound.set("paths", paths);
      dispatch(context, bound);
    });
    return gathered;
  }

  frame::TextureHandle addLookup(uint32_t light, int layer, int bounce, frame::BufferHandle gathered,
                                 frame::TextureHandle visibility, frame::TextureHandle target) {
    frame::PassBuilder pass = graph_.addPass("bumps of pixels", kName);
    gpu::ProgramDesc program{.files = {"techniques/bump_interreflection/lookup.comp.glsl"},
                             .defines = readPixels(pass, true, visibility)};
    pass.read(lit_.fields, Access::storageLoad, "ReliefFields", "sizes of height maps")
        .read(lit_.values, Access::storageLoad, "ReliefValues", "the table that the sizes belong to")
        .read(baseBuffer_, Access::storageLoad, "FlatBases", "flat surfaces with height maps")
        .read(gathered, Access::storageLoad, "Gathered", "light from other texels");
    const frame::TextureHandle result =
        pass.write(target, Access::imageLoadStore, "radiance", "light from bump to bump");
    const auto kernel = pass.program(std::move(program));
    pass.execute([kernel, light, layer, bounce, shadowed = static_cast<bool>(visibility),
                  size = inputs_.size](frame::PassContext& context) {
      gpu::Program& bound = context.use(kernel);
      bound.set("light_index", light);
      if (shadowed) bound.set("layer", layer);
      bound.set("bounce", bounce);
      context.dispatch(size.x, size.y, 1, 8, 8);
    });
    return result;
  }

  frame::FrameGraph& graph_;
  const TechniqueInputs& inputs_;
  const FlatBases* bases_;  ///< null: no light is answered for texel by texel
  frame::BufferHandle baseBuffer_, basesOfInstances_;
  Shared& shared_;
  ReliefMaps lit_, bounces_;
};

void BumpInterreflection::importBases(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
  if (baseBuffers_) return;
  bases_ = bump_interreflection::flatBases(inputs.scene, inputs.pose);
  if (bases_.bases.empty()) return;
  gpu::Device& device = inputs.gpuScene.device();
  const auto bytes = static_cast<int64_t>(bases_.texels * sizeof(float));
  if (bytes > device.limits().maxStorageBlockBytes)
    throw UsageError(
        fmt::format("the texels of flat surfaces with height maps take {} MiB, more than the {} MiB of a "
                    "storage buffer; ask for space=pixel, or smaller maps",
                    bytes >> 20, device.limits().maxStorageBlockBytes >> 20));
  baseBuffers_ = {gpu::Buffer::of<glsl::FlatBase>(device, "flat bases", bases_.bases),
                  gpu::Buffer::of<uint32_t>(device, "bases of instances", bases_.ofInstances)};
  baseHandles_ = {.bases = graph.importBuffer("flat bases", baseBuffers_->bases),
                  .ofInstances = graph.importBuffer("bases of instances", baseBuffers_->ofInstances)};
}

frame::TextureHandle BumpInterreflection::addPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                    const TermRequest& request) {
  const char* why = request.lights.empty()   ? "the scene has no light"
                    : !inputs.gbuffer.places ? "no material has a height map"
                                             : nullptr;
  if (why) {
    graph.leaveOut("light from bump to bump", info.name, why);
    return request.target;
  }
  if (inputs.parameters.choice("space") == 1) importBases(graph, inputs);
  const auto& [bases, ofInstances] = baseHandles_;
  Passes passes(graph, inputs, bases ? &bases_ : nullptr, bases, ofInstances, shared_);
  std::vector<uint32_t> lights(request.lights.begin(), request.lights.end());
  const auto near = std::stable_partition(lights.begin(), lights.end(), [&](uint32_t light) {
    return baseHandles_.bases && inputs.pose.lights[light].type == glsl::light_directional;
  });
  const auto far = static_cast<size_t>(near - lights.begin());
  frame::TextureHandle target = request.target;
  for (size_t first = 0, count = 0; first < lights.size(); first += count) {
    const bool texels = first < far;
    count = std::min((texels ? far : lights.size()) - first, kLightBatch);
    target = passes.add(std::span(lights).subspan(first, count), texels, target);
  }
  return target;
}

}  // namespace

LIMN_TECHNIQUE(BumpInterreflection::info, BumpInterreflection)
