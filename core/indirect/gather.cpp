#include "core/indirect/gather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/scene/scene.h"
#include "glsl/blocks.glsl"
#include "glsl/gbuffer.glsl"

namespace limn::indirect {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int group = 8;
constexpr unsigned gatheredUnit = 7, spreadUnit = 8;
constexpr int spreadWidth = 8;  // taps to either side of each tent that spreads the residual
constexpr int spreadShare = 8;  // it reaches at least this part of the picture's height

struct Input {
  unsigned unit;
  TextureHandle texture;
  const char* why;
};

/// What glsl/gbuffer_input.glsl's pixel_surface() and pixel_position() sample.
std::array<Input, 6> surfaceInputs(const GBuffer& g) {
  return {{{glsl::gbuffer_unit_depth, g.depth, "receivers"},
           {glsl::gbuffer_unit_normal, g.normal, "shading normals"},
           {glsl::gbuffer_unit_geometric_normal, g.geometricNormal, "horizons"},
           {glsl::gbuffer_unit_albedo, g.albedo, "base colour, metallic"},
           {glsl::gbuffer_unit_material, g.material, "roughness, specular"},
           {glsl::gbuffer_unit_emission, g.emission, "specular colour"}}};
}

void readSurfaces(frame::PassBuilder& pass, const GBuffer& g) {
  for (const Input& input : surfaceInputs(g)) pass.read(input.texture, Access::sampled, input.why);
}
void bindSurfaces(const frame::PassContext& context, const GBuffer& g) {
  for (const Input& input : surfaceInputs(g)) context.bindSampled(input.unit, input.texture);
}

}  // namespace

int usableBlock(int block, int lights) {
  return std::clamp(block, 1, std::max(1, static_cast<int>(std::sqrt(static_cast<float>(lights)))));
}

GatherSettings gatherSettings(const ParameterValues& p) {
  return {.block = p.integer("block"),
          .interleaving = static_cast<Interleaving>(p.choice("interleaving")),
          .clamp = p.real("clamp"),
          .compensation = p.boolean("compensation"),
          .blur = p.boolean("blur"),
          .blurPosition = p.real("blur_position"),
          .blurPlane = p.real("blur_plane"),
          .blurNormal = p.real("blur_normal")};
}

VirtualLightDesc virtualLightDesc(const ParameterValues& p) {
  return {.count = p.integer("vpls"),
          .mapSize = p.integer("rsm_size"),
          .lightSamples = p.integer("light_samples")};
}

Gather::Gather(frame::FrameGraph& graph, const TechniqueInputs& inputs, std::string_view technique,
               const VirtualLights& lights, const GatherSettings& settings)
    : graph_(graph),
      inputs_(inputs),
      technique_(technique),
      lights_(lights),
      settings_(settings),
      specular_(!std::ranges::all_of(inputs.scene.materials, &scene::Material::lambertian)),
      residual_(settings.compensation && settings.clamp > 0),
      gbuffer_(inputs.gbuffer),
      size_(inputs.size) {
  settings_.block = usableBlock(settings.block, lights.count);
  if (settings_.interleaving == Interleaving::split && settings_.block > 1) {
    size_ = (inputs.size + settings_.block - 1) / settings_.block * settings_.block;
    gbuffer_ = split();
  }
  shaded_ = screen("shaded", size_);
}

TextureHandle Gather::screen(std::string_view name, glm::ivec2 size) const {
  return graph_.createTexture(name, {.target = GL_TEXTURE_2D_ARRAY,
                                     .format = GL_RGBA32F,
                                     .width = size.x,
                                     .height = size.y,
                                     .layers = parts()});
}

void Gather::defineParts(gpu::ProgramDesc& program) const {
  program.defines["GATHER_SPECULAR"] = specular_ ? "1" : "0";
  program.defines["GATHER_RESIDUAL"] = residual_ ? "1" : "0";
}

GBuffer Gather::split() {
  frame::PassBuilder pass = graph_.addPass("split", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "size of the screen");
  readSurfaces(pass, inputs_.gbuffer);
  GBuffer to = inputs_.gbuffer;
  const auto sorted = [&](TextureHandle& texture, const char* name) {
    gpu::TextureDesc desc = graph_.desc(texture);
    desc.width = size_.x;
    desc.height = size_.y;
    texture = pass.write(graph_.createTexture(name, desc), Access::imageStore, "sorted by sub-buffer");
  };
  sorted(to.depth, "split depth");
  sorted(to.normal, "split normal");
  sorted(to.geometricNormal, "split geometric normal");
  sorted(to.albedo, "split albedo");
  sorted(to.material, "split material");
  sorted(to.emission, "split emission");
  gpu::ProgramDesc description{.files = {"glsl/indirect/split.comp.glsl"}, .defines = {}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute([=, from = inputs_.gbuffer, frame = inputs_.handles.frame, block = settings_.block,
                size = inputs_.size](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    kernel.set("block", block);
    context.bindUniform(glsl::FrameBlock::binding, frame);
    bindSurfaces(context, from);
    for (const Input& output : surfaceInputs(to))
      context.bindImage(output.unit, output.texture, GL_WRITE_ONLY);
    context.dispatch(size.x, size.y, 1, group, group);
  });
  return to;
}

void Gather::shade(ShadePass shade) {
  if (shade.count == 0) shade.count = lights_.count;
  const bool accumulate = shade.first > 0;
  frame::PassBuilder pass = graph_.addPass("shade", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "camera")
      .read(lights_.lights, Access::storageLoad, "virtual lights");
  readSurfaces(pass, gbuffer_);
  for (const shadow::SampledTexture& s : shade.sampled) pass.read(s.texture, Access::sampled, s.why);
  if (shade.declare) shade.declare(pass);
  shaded_ = pass.write(shaded_, accumulate ? Access::imageLoadStore : Access::imageStore,
                       "light from every block^2-th part of the virtual lights");
  defineParts(shade.program);
  const bool splitting = gbuffer_.depth != inputs_.gbuffer.depth;
  shade.program.defines["SPLIT"] = splitting ? "1" : "0";
  shade.program.defines["ACCUMULATE"] = accumulate ? "1" : "0";
  shade.program.defines["LAMBERTIAN"] = specular_ ? "0" : "1";
  const auto program = pass.program(shade.program);
  pass.execute([=, shade = std::move(shade), frame = inputs_.handles.frame, gbuffer = gbuffer_, to = shaded_,
                lights = lights_, settings = settings_, size = inputs_.size](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    const auto block = static_cast<unsigned>(settings.block);
    kernel.set("vpl_count", static_cast<unsigned>(lights.count));
    kernel.set("batch_first", static_cast<unsigned>(shade.first));
    kernel.set("batch_count", static_cast<unsigned>(shade.count));
    kernel.set("block", block);
    kernel.set("nearest", settings.clamp);
    context.bindUniform(glsl::FrameBlock::binding, frame);
    bindSurfaces(context, gbuffer);
    context.bindStorage(0, lights.lights);
    context.bindImage(0, to, shade.first > 0 ? GL_READ_WRITE : GL_WRITE_ONLY);
    for (const shadow::SampledTexture& s : shade.sampled) context.bindSampled(s.unit, s.texture);
    if (shade.bind) shade.bind(context, kernel);
    const glm::ivec2 part = (size + settings.block - 1) / settings.block;
    context.dispatch(part.x, part.y, settings.block * settings.block, group, group);
  });
}

TextureHandle Gather::merge(TextureHandle shaded) {
  frame::PassBuilder pass = graph_.addPass("merge", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "size of the screen")
      .read(shaded, Access::sampled, "sub-buffers");
  const TextureHandle merged =
      pass.write(screen("merged", inputs_.size), Access::imageStore, "pixels in their places");
  gpu::ProgramDesc description{.files = {"glsl/indirect/merge.comp.glsl"}, .defines = {}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute([=, frame = inputs_.handles.frame, block = settings_.block, size = inputs_.size,
                layers = parts()](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    kernel.set("block", block);
    context.bindUniform(glsl::FrameBlock::binding, frame);
    context.bindSampled(0, shaded);
    context.bindImage(0, merged, GL_WRITE_ONLY);
    context.dispatch(size.x, size.y, layers, group, group);
  });
  return merged;
}

TextureHandle Gather::blurOnce(std::string_view name, TextureHandle from, int width, int stride,
                               int firstPart, int endPart, bool vertical) {
  frame::PassBuilder pass = graph_.addPass(name, technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "camera, scene extent")
      .read(inputs_.gbuffer.depth, Access::sampled, "positions")
      .read(inputs_.gbuffer.normal, Access::sampled, "normals")
      .read(from, Access::sampled, "what is averaged");
  const TextureHandle to =
      pass.write(screen(name, inputs_.size), Access::imageStore, "sums over like neighbours");
  gpu::ProgramDesc description{.files = {"glsl/indirect/blur.comp.glsl"},
                               .defines = {{"VERTICAL", vertical ? "1" : "0"},
                                           {"PARTS_FIRST", std::to_string(firstPart)},
                                           {"PARTS_END", std::to_string(endPart)}}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute([=, frame = inputs_.handles.frame, g = inputs_.gbuffer, settings = settings_,
                size = inputs_.size](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    kernel.set("width", width);
    kernel.set("stride", stride);
    kernel.set("position_threshold", settings.blurPosition);
    kernel.set("plane_threshold", settings.blurPlane);
    kernel.set("normal_threshold", settings.blurNormal);
    context.bindUniform(glsl::FrameBlock::binding, frame);
    context.bindSampled(glsl::gbuffer_unit_depth, g.depth);
    context.bindSampled(glsl::gbuffer_unit_normal, g.normal);
    context.bindSampled(gatheredUnit, from);
    context.bindImage(0, to, GL_WRITE_ONLY);
    context.dispatch(size.x, size.y, 1, group, group);
  });
  return to;
}

TextureHandle Gather::blur(std::string_view name, TextureHandle from, int width, int stride, int firstPart,
                           int endPart) {
  const TextureHandle rows = blurOnce(name, from, width, stride, firstPart, endPart, false);
  return blurOnce(name, rows, width, stride, firstPart, endPart, true);
}

TextureHandle Gather::finish(TextureHandle target) {
  TextureHandle gathered = shaded_;
  if (gbuffer_.depth != inputs_.gbuffer.depth) gathered = merge(gathered);
  const bool blurred = settings_.blur && settings_.block > 1;
  if (blurred) {
    gathered = blur("blur", gathered, settings_.block, 1, 0, parts());
  } else {
    graph_.leaveOut("blur", technique_,
                    settings_.blur ? "every pixel has all virtual lights" : "blur is off");
  }
  TextureHandle spread = gathered;
  int reach = blurred ? settings_.block : 1;  // pixels; taps lie closer than what they see is smooth
  for (bool more = residual_; more; more = reach < inputs_.size.y / spreadShare) {
    const int stride = std::max(1, reach / 2);
    spread = blur("spread residual", spread, spreadWidth, stride, parts() - 1, parts());
    reach += spreadWidth * stride;
  }

  frame::PassBuilder pass = graph_.addPass("reflect", technique_);
  pass.read(inputs_.handles.frame, Access::uniformBuffer, "size of the screen")
      .read(gathered, Access::sampled, "light that arrives");
  if (residual_) pass.read(spread, Access::sampled, "what the clamp took away");
  readSurfaces(pass, inputs_.gbuffer);
  const TextureHandle result = pass.write(target, Access::imageLoadStore, "indirect light");
  gpu::ProgramDesc description{.files = {"glsl/indirect/reflect.comp.glsl"}, .defines = {}};
  defineParts(description);
  const auto program = pass.program(description);
  pass.execute([=, frame = inputs_.handles.frame, g = inputs_.gbuffer, residual = residual_,
                size = inputs_.size](frame::PassContext& context) {
    context.program(program).use();
    context.bindUniform(glsl::FrameBlock::binding, frame);
    bindSurfaces(context, g);
    context.bindSampled(gatheredUnit, gathered);
    if (residual) context.bindSampled(spreadUnit, spread);
    context.bindImage(0, result, GL_READ_WRITE);
    context.dispatch(size.x, size.y, 1, group, group);
  });
  return result;
}

}  // namespace limn::indirect
