#include "core/indirect/gather.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/frame/array_block.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/surface_input.h"
#include "core/scene/draw_instance.h"
#include "core/shadow/sample_batches.h"
#include "glsl/indirect/gather.glsl"
#include "glsl/materials/material_model.glsl"

namespace limn::indirect {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int kGroup = 8;
constexpr int kSpreadWidth = 8;  // taps to either side of each tent that spreads the residual
constexpr int kSpreadShare = 8;  // it reaches at least this part of the picture's height

/// Of what enters translucent surfaces there is no specular part, though it is not Lambertian either.
constexpr uint32_t kEntryAlone = 1u << glsl::model_entry;

bool bounded(const GatherSettings& settings) {
  return settings.clamp > 0 || settings.bound == Bound::patch;
}

/// Whether no surface that takes light has a specular part.
bool litAreLambertian(const TechniqueInputs& inputs) {
  const auto isLambertian = [&](const scene::DrawInstance& drawn) {
    const scene::Material& material = scene::materialOf(inputs.scene, drawn);
    return material.lambertian() || material.specularSurface();
  };
  return inputs.handles.modelKinds == 0 && std::ranges::all_of(inputs.pose.instances, isLambertian);
}

/// Returns the steps that the loops of a thread take for a light: one, and those in which each of its pixels
/// reflects it.
int stepsOfLight(const TechniqueInputs& inputs, int pixels) {
  return 1 + (inputs.handles.surface ? pixels * inputs.handles.surface->steps : 0);
}

}  // namespace

int usableBlock(int block, int lights) {
  return std::clamp(block, 1, std::max(1, static_cast<int>(std::sqrt(static_cast<float>(lights)))));
}

GatherSettings gatherSettings(const ParameterValues& p) {
  return {.block = p.integer("block"),
          .interleaving = static_cast<Interleaving>(p.choice("interleaving")),
          .clamp = p.real("clamp"),
          .bound = static_cast<Bound>(p.choice("bound")),
          .compensation = p.boolean("compensation"),
          .history = p.integer("history"),
          .blur = p.boolean("blur"),
          .blurPosition = p.real("blur_position"),
          .blurPlane = p.real("blur_plane"),
          .blurNormal = p.real("blur_normal"),
          .edges = p.real("edges")};
}

std::optional<VirtualLights> virtualLightsOf(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                             const TermRequest& request, std::string_view technique) {
  if (request.lights.empty()) {
    graph.leaveOut("indirect light", technique, "the scene has no light");
    return std::nullopt;
  }
  const ParameterValues& p = inputs.parameters;
  const int history = p.integer("history");
  return inputs.service<VirtualLightService>().request(
      request.lights, {.count = p.integer("vpls"),
                       .mapSize = p.integer("rsm_size"),
                       .lightSamples = p.integer("light_samples"),
                       .sets = history,
                       .block = history > 1 ? usableBlock(p.integer("block"), p.integer("vpls")) : 1});
}

Gather::Gather(frame::FrameGraph& graph, const TechniqueInputs& inputs, std::string_view technique,
               const VirtualLights& lights, const GatherSettings& settings)
    : graph_(graph),
      inputs_(inputs),
      technique_(technique),
      lights_(lights),
      settings_(settings),
      lambertian_(litAreLambertian(inputs)),
      specular_(!lambertian_ && inputs.handles.modelKinds != kEntryAlone),
      residual_(settings.compensation && bounded(settings)),
      gbuffer_(inputs.gbuffer),
      size_(inputs.size) {
  settings_.block = usableBlock(settings.block, lights.count);
  blurred_ = settings_.blur && settings_.block > 1;
  const bool byHistory = settings_.history > 1 && bounded(settings_);
  falling_ = blurred_ && !residual_ && byHistory;
  glossyBound_ = specular_ && byHistory;
  if (settings_.interleaving == Interleaving::split && settings_.block > 1) {
    size_ = (inputs.size + settings_.block - 1) / settings_.block * settings_.block;
    gbuffer_ = split();
  }
  shaded_ = screen("shaded", size_, parts());
}

TextureHandle Gather::screen(std::string_view name, glm::ivec2 size, int layers) const {
  return graph_.createTexture(name, {.target = GL_TEXTURE_2D_ARRAY,
                                     .format = GL_RGBA32F,
                                     .width = size.x,
                                     .height = size.y,
                                     .layers = layers});
}

void Gather::defineParts(gpu::ProgramDesc& program) const {
  program.defines["GATHER_SPECULAR"] = specular_ ? "1" : "0";
  program.defines["GATHER_RESIDUAL"] = residual_ || falling_ ? "1" : "0";
}

GBuffer Gather::split() {
  frame::PassBuilder pass = graph_.addPass("split", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "size of the screen");
  readSurfaces(pass, inputs_.gbuffer);
  GBuffer to = inputs_.gbuffer;
  const auto sorted = [&](TextureHandle& texture, const char* title, const char* name) {
    gpu::TextureDesc desc = graph_.desc(texture);
    desc.width = size_.x;
    desc.height = size_.y;
    texture = pass.write(graph_.createTexture(title, desc), Access::imageStore, name, "sorted by sub-buffer");
  };
  sorted(to.depth, "split depth", "split_depth");
  sorted(to.normal, "split normal", "split_normal");
  sorted(to.geometricNormal, "split geometric normal", "split_geometric_normal");
  sorted(to.albedo, "split albedo", "split_albedo");
  sorted(to.material, "split material", "split_material");
  sorted(to.emission, "split emission", "split_emission");
  gpu::ProgramDesc description{.files = {"glsl/indirect/split.comp.glsl"}, .defines = {}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute([=, block = settings_.block, size = inputs_.size](frame::PassContext& context) {
    context.use(program).set("block", block);
    context.dispatch(size.x, size.y, 1, kGroup, kGroup);
  });
  return to;
}

/// Declares what a program that shades reads of lights and of the surfaces in `from`, and completes it.
void Gather::declareShading(frame::PassBuilder& pass, ShadePass& shade, const GBuffer& from) const {
  const Access lights = frame::arrayBlock<glsl::VirtualPointLight>(
      inputs_.gpuScene.device().limits(), lights_.count, "VIRTUAL_LIGHT_COUNT", shade.program.defines);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera")
      .read(lights_.lights, lights, "VirtualLights", "virtual lights");
  const scene::SurfaceInput surfaces(inputs_.handles, from);
  surfaces.define(shade.program.defines);
  surfaces.declare(pass);
  for (const shadow::SampledTexture& s : shade.sampled) pass.read(s.texture, Access::sampled, s.name, s.why);
  if (shade.declare) shade.declare(pass);
  defineParts(shade.program);
  shade.program.defines["GATHER_FALLING"] = falling_ ? "1" : "0";
  shade.program.defines["GATHER_GLOSSY"] = glossyBound_ ? "1" : "0";
  shade.program.defines["GATHER_PATCH"] = settings_.bound == Bound::patch ? "1" : "0";
  shade.program.defines["LAMBERTIAN"] = lambertian_ ? "1" : "0";
}

/// Returns the passes that shade, whose threads take the lights of a number of sub-buffers: one pass, but for
/// software renderers. A pass ends where a sub-buffer does, where it can, since areas begin again there.
std::vector<ShadePass> Gather::passesOf(const ShadePass& shade, int subBuffers) const {
  const int block = settings_.block, most = (lights_.count + block * block - 1) / (block * block);
  const int lights = std::min(shade.count, most);  // of a sub-buffer
  // Threads of areas and of edges shade one pixel, others four.
  const int ofLight = stepsOfLight(inputs_, shade.areas > 0 || subBuffers > 1 ? 1 : 4);
  const int ofAreas = std::min(lights, shade.areas) * shade.areaSteps;
  const int ofSubBuffer = lights * ofLight + ofAreas;
  const int mostSteps = shadow::mostStepsOfLoops(inputs_);
  if (ofSubBuffer * subBuffers <= mostSteps) return {shade};
  const int together = std::max(mostSteps / ofSubBuffer, 1);  // sub-buffers
  std::vector<ShadePass> passes;
  for (int first = shade.first; first < shade.first + shade.count;) {
    const auto count = static_cast<uint32_t>(lights_.count), side = static_cast<uint32_t>(block);
    const uint32_t subBuffer = glsl::gather_sub_buffer(static_cast<uint32_t>(first), count, side);
    const uint32_t next = glsl::gather_begin(subBuffer + static_cast<uint32_t>(together), count, side);
    ShadePass& pass = passes.emplace_back(shade);
    pass.first = first;
    pass.count = std::min(
        {(mostSteps - ofAreas) / ofLight, static_cast<int>(next) - first, shade.first + shade.count - first});
    first += pass.count;
  }
  return passes;
}

/// Returns what sets the uniforms of a program that shades.
std::function<void(gpu::Program&)> Gather::shadingUniforms(const ShadePass& shade) const {
  return [bind = shade.bind, first = shade.first, count = shade.count, lightCount = lights_.count,
          settings = settings_, falling = falling_, glossy = glossyBound_](gpu::Program& kernel) {
    kernel.set("vpl_count", static_cast<unsigned>(lightCount));
    kernel.set("batch_first", static_cast<unsigned>(first));
    kernel.set("batch_count", static_cast<unsigned>(count));
    const float widest = settings.bound == Bound::patch ? std::sqrt(glsl::inverse_pi) : settings.clamp;
    const float least = widest / std::sqrt(static_cast<float>(settings.history));
    kernel.set("nearest", falling ? least * static_cast<float>(settings.block) : least);
    if (falling) kernel.set("least_nearest", least);
    if (glossy) kernel.set("glossy_nearest", widest);
    if (bind) bind(kernel);
  };
}

void Gather::shade(ShadePass shade) {
  if (shade.count == 0) shade.count = lights_.count;
  if (shade.count == lights_.count && blurred_ && settings_.edges > 0) edges_ = shade;
  for (ShadePass& pass : passesOf(shade, 1)) addShadePass(std::move(pass));
}

void Gather::addShadePass(ShadePass shade) {
  const bool accumulate = shade.first > 0;
  frame::PassBuilder pass = graph_.addPass("shade", technique_);
  declareShading(pass, shade, gbuffer_);
  shaded_ = pass.write(shaded_, accumulate ? Access::imageLoadStore : Access::imageStore, "gathered",
                       "light from every block^2-th part of the virtual lights");
  const bool splitting = gbuffer_.depth != inputs_.gbuffer.depth;
  shade.program.defines["SPLIT"] = splitting ? "1" : "0";
  shade.program.defines["GATHER_EDGES"] = "0";
  shade.program.defines["GATHER_COLOURLESS"] = blurred_ && specular_ ? "1" : "0";
  shade.program.defines["ACCUMULATE"] = accumulate ? "1" : "0";
  const auto program = pass.program(shade.program);
  // Without a blur a pixel keeps its part of the lights, and gets another wherever the camera moves.
  const bool apart = settings_.history > 1 && !blurred_;
  pass.execute([program, uniforms = shadingUniforms(shade), block = settings_.block, apart,
                size = inputs_.size](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    uniforms(kernel);
    kernel.set("block", static_cast<unsigned>(block));
    kernel.set("part_of_all", apart ? 1 / static_cast<float>(block * block) : 1.f);
    const glm::ivec2 part = (size + block - 1) / block;
    context.dispatch(part.x, part.y, block * block, 2 * kGroup, 2 * kGroup);
  });
}

/// Declares the pass that gives all virtual lights to the pixels that the blur serves badly.
TextureHandle Gather::shadeEdges(TextureHandle rows, TextureHandle columns, TextureHandle blurred) {
  TextureHandle shaded = screen("edges shaded", inputs_.size, graph_.desc(blurred).layers);
  for (ShadePass& shade : passesOf(*edges_, settings_.block * settings_.block))
    shaded = addEdgePass(std::move(shade), rows, columns, blurred, shaded);
  return shaded;
}

TextureHandle Gather::addEdgePass(ShadePass shade, TextureHandle rows, TextureHandle columns,
                                  TextureHandle blurred, TextureHandle target) {
  const bool accumulate = shade.first > 0;
  frame::PassBuilder pass = graph_.addPass("shade edges", technique_);
  declareShading(pass, shade, inputs_.gbuffer);
  pass.read(blurred, Access::sampled, "blurred", "light of the other pixels")
      .read(rows, Access::sampled, "rows", "where it is of other lines")
      .read(columns, Access::sampled, "columns", "the same across");
  const TextureHandle shaded = pass.write(target, accumulate ? Access::imageLoadStore : Access::imageStore,
                                          "gathered", "edges by all virtual lights");
  shade.program.defines["SPLIT"] = "0";
  shade.program.defines["GATHER_EDGES"] = "1";
  shade.program.defines["GATHER_COLOURLESS"] = "0";
  shade.program.defines["ACCUMULATE"] = accumulate ? "1" : "0";
  const auto program = pass.program(shade.program);
  pass.execute([program, uniforms = shadingUniforms(shade), edges = settings_.edges,
                size = inputs_.size](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    uniforms(kernel);
    kernel.set("edges", edges);
    context.dispatch(size.x, size.y, 1, 2 * kGroup, 2 * kGroup);
  });
  return shaded;
}

TextureHandle Gather::merge(TextureHandle shaded) {
  frame::PassBuilder pass = graph_.addPass("merge", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "size of the screen")
      .read(shaded, Access::sampled, "split", "sub-buffers");
  const TextureHandle merged = pass.write(screen("merged", inputs_.size, parts()), Access::imageStore,
                                          "merged", "pixels in their places");
  gpu::ProgramDesc description{.files = {"glsl/indirect/merge.comp.glsl"}, .defines = {}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute(
      [=, block = settings_.block, size = inputs_.size, layers = parts()](frame::PassContext& context) {
        context.use(program).set("block", block);
        context.dispatch(size.x, size.y, layers, kGroup, kGroup);
      });
  return merged;
}

/// Declares one direction of a blur of the last `blurredParts` parts of `from`; the result has no others.
/// `last`: the one that completes the blur of interleaved pixels, after which the residual is folded in where
/// the bound falls, and the specular part has its colour again.
TextureHandle Gather::blur(std::string_view name, TextureHandle from, int width, int stride, int blurredParts,
                           bool vertical, bool last) {
  const bool fold = last && falling_, colours = last && specular_;
  frame::PassBuilder pass = graph_.addPass(name, technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "camera, scene extent")
      .read(from, Access::sampled, "gathered", "what is averaged");
  if (colours) {
    readSurfaces(pass, inputs_.gbuffer);
  } else {
    pass.read(inputs_.gbuffer.depth, Access::sampled, kGBufferNames.depth, "positions")
        .read(inputs_.gbuffer.normal, Access::sampled, kGBufferNames.normal, "normals");
  }
  const TextureHandle to = pass.write(screen(name, inputs_.size, blurredParts - (fold ? 1 : 0)),
                                      Access::imageStore, "blurred", "sums over like neighbours");
  gpu::ProgramDesc description{
      .files = {"glsl/indirect/blur.comp.glsl"},
      .defines = {{"VERTICAL", vertical ? "1" : "0"},
                  {"FOLD", fold ? "1" : "0"},
                  {"COLOURS", colours ? "1" : "0"},
                  {"PARTS", std::to_string(blurredParts)},
                  {"FIRST_LAYER", std::to_string(graph_.desc(from).layers - blurredParts)}}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute([=, settings = settings_, size = inputs_.size](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    kernel.set("width", width);
    kernel.set("stride", stride);
    kernel.set("position_threshold", settings.blurPosition);
    kernel.set("plane_threshold", settings.blurPlane);
    kernel.set("normal_threshold", settings.blurNormal);
    context.dispatch(size.x, size.y, 1, kGroup, kGroup);
  });
  return to;
}

TextureHandle Gather::finish(TextureHandle target) {
  TextureHandle gathered = shaded_;
  if (gbuffer_.depth != inputs_.gbuffer.depth) gathered = merge(gathered);
  if (blurred_) {
    const TextureHandle interleaved = gathered;
    const int width = settings_.block;
    const TextureHandle rows = blur("blur", interleaved, width, 1, parts(), false, false);
    gathered = blur("blur", rows, width, 1, parts(), true, true);
    if (edges_) {
      const TextureHandle columns = blur("blur", interleaved, width, 1, parts(), true, false);
      gathered = shadeEdges(rows, columns, gathered);
    }
  } else {
    graph_.leaveOut("blur", technique_,
                    settings_.blur ? "every pixel has all virtual lights" : "blur is off");
  }
  if (!edges_) {
    graph_.leaveOut("shade edges", technique_,
                    !blurred_             ? "nothing is blurred"
                    : settings_.edges > 0 ? "virtual lights come in batches"
                                          : "edges is 0");
  }
  if (settings_.history > 1) {
    gathered = inputs_.service<history::FrameHistoryService>().average(inputs_.gbuffer, gathered,
                                                                       settings_.history, technique_);
  } else {
    graph_.leaveOut("average frames", technique_, "history is 1");
  }
  TextureHandle spread = gathered;
  int reach = blurred_ ? settings_.block : 1;  // pixels; taps lie closer than what they see is smooth
  for (bool more = residual_; more; more = reach < inputs_.size.y / kSpreadShare) {
    const int stride = std::max(1, reach / 2);
    for (const bool vertical : {false, true})
      spread = blur("spread residual", spread, kSpreadWidth, stride, 1, vertical, false);
    reach += kSpreadWidth * stride;
  }

  frame::PassBuilder pass = graph_.addPass("reflect", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "FrameBlock", "size of the screen")
      .read(gathered, Access::sampled, "gathered", "light that arrives");
  if (residual_) pass.read(spread, Access::sampled, "spread", "what the clamp took away");
  readSurfaces(pass, inputs_.gbuffer);
  const TextureHandle result = pass.write(target, Access::imageLoadStore, "radiance", "indirect light");
  gpu::ProgramDesc description{
      .files = {"glsl/indirect/reflect.comp.glsl"},
      .defines = {{"GATHER_SPECULAR", specular_ ? "1" : "0"}, {"GATHER_RESIDUAL", residual_ ? "1" : "0"}}};
  const auto program = pass.program(description);
  pass.execute([program, size = inputs_.size](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, 1, kGroup, kGroup);
  });
  return result;
}

}  // namespace limn::indirect
