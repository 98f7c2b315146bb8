#include "techniques/implicit_visibility/light_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/gpu_scene/light_textures.h"
#include "core/radiosity/illumination.h"
#include "core/shading_maps/shading_maps.h"
#include "core/technique/light_batch.h"

namespace limn::implicit_visibility {

using frame::Access;
using frame::BufferHandle;

LightPasses::LightPasses(const ElementPasses& elements, std::string_view technique)
    : elements_(elements), technique_(technique) {}

SeenLights LightPasses::seenBy(const PassRequest& r, std::span<const uint32_t> lights) {
  return seen(r, lights).handles;
}

const Gathered& LightPasses::reflected(const PassRequest& r, std::span<const uint32_t> lights, bool sky,
                                       int bounces) {
  for (const Reflected& known : reflected_)
    if (known.sky == sky && known.bounces == bounces && std::ranges::equal(known.lights, lights))
      return known.gathered;
  auto [direct, outgoing] = directLight(r, lights, sky);
  Reflected& own = reflected_.emplace_back();
  own.lights.assign(lights.begin(), lights.end());
  own.sky = sky;
  own.bounces = bounces;
  for (int bounce = 1; bounce <= bounces; ++bounce) {
    const BufferHandle pulled = pullUp(r, outgoing);
    own.gathered = gather(r, pulled, direct, outgoing);
  }
  return own.gathered;
}

BufferHandle LightPasses::perSlot(const PassRequest& r, const char* name, uint32_t count) const {
  return r.graph.createBuffer(name, {std::max<size_t>(elements_.slots(), 1) * count * sizeof(glm::vec4)});
}

BufferHandle LightPasses::sent(const PassRequest& r, const char* name) const {
  return perSlot(r, name, elements_.sentCount());
}
void LightPasses::dispatchSent(const frame::PassContext& context, uint32_t slots) const {
  context.dispatchRows((int64_t{slots} * elements_.sentCount() + 63) / 64);
}

const LightPasses::Seen& LightPasses::seen(const PassRequest& r, std::span<const uint32_t> lights) {
  for (const Seen& known : seen_)
    if (std::ranges::equal(known.lights, lights)) return known;
  Seen& s = seen_.emplace_back();
  s.lights.assign(lights.begin(), lights.end());
  s.indexBuffer =
      gpu::Buffer::of(r.inputs.gpuScene.device(), "lights asked for", std::span<const uint32_t>(s.lights));
  s.handles.indices = r.graph.importBuffer(fmt::format("lights asked for {}", seen_.size()), s.indexBuffer);
  frame::PassBuilder pass = r.graph.addPass("light visibility", technique_);
  pass.read(elements_.leaves, Access::storageLoad, "Leaves", "normals and albedos");
  const frame::SlotHandle links = elements_.readLinks(pass);
  pass.read(r.inputs.handles.lights, Access::storageLoad, "Lights", "lights")
      .read(elements_.groups, Access::storageLoad, "Groups", "how far elements are")
      .read(s.handles.indices, Access::storageLoad, "Indices", "which lights")
      .cacheable();
  const size_t bytes = std::max<size_t>(lights.size() * elements_.leafSlots(), 4) * sizeof(float);
  s.handles.seen = pass.write(r.graph.createBuffer("visibility of lights", {bytes}), Access::storageStore,
                              "Seen", "V of each leaf");
  const auto kernelHandle = elements_.program(pass, "light_visibility.comp.glsl");
  pass.execute([this, kernelHandle, links, count = static_cast<int>(lights.size()),
                samples = r.inputs.parameters.integer("light_samples"),
                reach = r.inputs.parameters.real("reach")](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kernelHandle);
    elements_.setSpace(kernel);
    kernel.set("slots", elements_.leafSlots());
    kernel.set("samples", static_cast<unsigned>(samples));
    kernel.set("reach", reach);
    kernel.set("unit", elements_.elements().space().radius());
    for (const LinkChunk& chunk : elements_.chunks) {
      ElementPasses::bind(context, kernel, links, chunk);
      context.dispatch(static_cast<int>(chunk.count), count, 1, 64, 1);
    }
  });
  return s;
}

std::span<const uint32_t> LightPasses::firstBatch(std::span<const uint32_t> lights) const {
  for (const Seen& known : seen_) {
    const auto batch = lights.first(std::min(known.lights.size(), lights.size()));
    if (!batch.empty() && std::ranges::equal(known.lights, batch)) return batch;
  }
  return lights.first(std::min(kLightBatch, lights.size()));
}

LightPasses::Sent LightPasses::directLight(const PassRequest& r, std::span<const uint32_t> lights, bool sky) {
  const bool throughBins = sky && elements_.glossy();  // the sky comes last, and by itself
  Sent sent;
  size_t first = 0;
  do {
    const auto batch = firstBatch(lights.subspan(first));
    first += batch.size();
    const bool last = first == lights.size() && !throughBins;
    sent = addDirectLight(r, batch, sky && last, sent.first, last);
  } while (first < lights.size());
  return throughBins ? reflect(r, this->sky(r), sent.first) : sent;
}

LightPasses::Sent LightPasses::addDirectLight(const PassRequest& r, std::span<const uint32_t> lights,
                                              bool sky, BufferHandle before, bool last) {
  const Seen* seen = lights.empty() ? nullptr : &this->seen(r, lights);
  const BufferHandle skyIrradiance = sky ? this->sky(r).irradiance : BufferHandle{};
  const bool glossy = elements_.glossy(), first = !before;
  frame::PassBuilder pass = r.graph.addPass("direct light", technique_);
  pass.read(r.inputs.handles.lights, Access::storageLoad, "Lights", "lights")
      .read(elements_.leaves, Access::storageLoad, "Leaves", "normals and albedos")
      .cacheable();
  if (seen)
    pass.read(seen->handles.seen, Access::storageLoad, "Seen", "V of each light")
        .read(seen->handles.indices, Access::storageLoad, "Indices", "which lights")
        .read(elements_.groups, Access::storageLoad, "Groups", "a light does not see itself");
  if (sky) pass.read(skyIrradiance, Access::storageLoad, "Sky", "irradiance of the environment");
  if (glossy) pass.read(elements_.materials, Access::storageLoad, "Materials", "BRDFs");
  // Some compilers keep what only glossy surfaces would look up.
  if (glossy || seen)
    pass.read(r.inputs.service<shading_maps::ShadingMapService>().ltcTable(), Access::sampled, "ltc_table",
              "glossy light of rectangles");
  std::map<std::string, std::string> defines{
      {"LIGHTS", seen ? "1" : "0"},      {"LIGHTS_FIRST", first ? "1" : "0"},
      {"LIGHTS_LAST", last ? "1" : "0"}, {"ENVIRONMENT", sky ? "1" : "0"},
      {"LIGHT_TEXTURES", "0"},           {"MEDIUM", "0"}};
  if (seen) {
    const scene::LightTextureInput textures(r.inputs.handles);
    textures.define(defines);
    textures.declare(pass);
  }
  if (seen && r.inputs.scene.medium.present()) {
    const scene::MediumInput medium(r.inputs.handles);
    defines["MEDIUM"] = "1";
    medium.define(defines);
    medium.declare(pass);
    pass.read(r.inputs.handles.medium, Access::uniformBuffer, "FrameBlock", "the medium");
  }
  Sent result;
  result.first =
      pass.write(first ? sent(r, "direct light") : before,
                 first ? Access::storageStore : Access::storageLoadStore, "Direct", "reflected by leaves");
  if (last)
    result.second =
        pass.write(sent(r, "outgoing"), Access::storageStore, "Outgoing", "the same, before it is pulled up");
  const auto kernelHandle = elements_.program(pass, "direct.comp.glsl", std::move(defines));
  pass.execute([this, kernelHandle, glossy, count = lights.size()](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kernelHandle);
    if (glossy && count > 0) elements_.setSpace(kernel);  // no light, no direction
    kernel.set("slots", elements_.leafSlots());
    if (count > 0) kernel.set("light_count", static_cast<unsigned>(count));
    dispatchSent(context, elements_.leafSlots());
  });
  return result;
}

BufferHandle LightPasses::pullUp(const PassRequest& r, BufferHandle outgoing) {
  const auto levels = elements_.elements().forest().levels();
  for (size_t level = 1; level < levels.size(); ++level) {
    frame::PassBuilder pass = r.graph.addPass("pull up", technique_);
    pass.read(elements_.groups, Access::storageLoad, "Groups", "children and areas").cacheable();
    outgoing = pass.write(outgoing, Access::storageLoadStore, "Outgoing", "radiance of the next level");
    const auto kernelHandle = elements_.program(pass, "pull_up.comp.glsl");
    pass.execute([this, kernelHandle, range = levels[level]](frame::PassContext& context) {
      gpu::Program& kernel = context.use(kernelHandle);
      kernel.set("first_group", range.first);
      kernel.set("group_count", range.count);
      dispatchSent(context, 4 * range.count);
    });
  }
  return outgoing;
}

Gathered LightPasses::gather(const PassRequest& r, BufferHandle outgoing, BufferHandle direct,
                             BufferHandle& next) {
  if (elements_.gathersOnProcessor()) return gatherOnProcessor(r, outgoing, direct, next);
  const bool glossy = elements_.glossy();
  frame::PassBuilder pass = r.graph.addPass("gather", technique_);
  const frame::SlotHandle links = readBins(pass);
  pass.read(outgoing, Access::storageLoad, "Source", "radiance of elements").cacheable();
  if (!glossy) pass.read(direct, Access::storageLoad, "Direct", "direct light, reflected by leaves");
  const BufferHandle irradiance =
      pass.write(perSlot(r, "irradiance"), Access::storageStore, "Irradiance", "of leaves");
  const BufferHandle reflected =
      glossy ? BufferHandle{}
             : pass.write(perSlot(r, "outgoing"), Access::storageStore, "Next", "reflected by leaves");
  const auto kernelHandle = elements_.program(pass, "gather.comp.glsl", {{"SKY", "0"}});
  pass.execute([this, kernelHandle, links](frame::PassContext& context) {
    gatherChunks(context, kernelHandle, links);
  });
  const Gathered gathered{irradiance, outgoing, false};
  next = glossy ? reflect(r, gathered, direct).second : reflected;
  return gathered;
}

Gathered LightPasses::gatherOnProcessor(const PassRequest& r, BufferHandle outgoing, BufferHandle direct,
                                        BufferHandle& next) {
  ProcessorGather& own = processorGathers_.emplace_back(r.inputs.gpuScene.device(), elements_);
  frame::PassBuilder pass = r.graph.addPass("gather", technique_);
  elements_.readInMemory(pass);
  pass.read(outgoing, Access::copySource, "radiance of elements")
      .read(direct, Access::copySource, "direct light, reflected by leaves")
      .cacheable();
  const BufferHandle irradiance =
      pass.write(r.graph.importBuffer("irradiance", own.irradiance()), Access::copyTarget, "of leaves");
  next = pass.write(r.graph.importBuffer("outgoing", own.reflected()), Access::copyTarget,
                    "reflected by leaves");
  pass.execute([&own, outgoing, direct](frame::PassContext& context) {
    own.gather(context.buffer(outgoing), context.buffer(direct));
  });
  return {irradiance, outgoing, false};
}

LightPasses::Sent LightPasses::reflect(const PassRequest& r, const Gathered& gathered,
                                       BufferHandle direct) const {
  frame::PassBuilder pass = r.graph.addPass("reflect", technique_);
  const frame::SlotHandle links = readBins(pass);
  pass.read(gathered.source, Access::storageLoad, "Source", "radiance of elements or of the environment")
      .read(gathered.irradiance, Access::storageLoad, "Irradiance", "of leaves")
      .read(elements_.materials, Access::storageLoad, "Materials", "BRDFs")
      .cacheable();
  if (gathered.sky)
    direct = pass.write(direct, Access::storageLoadStore, "Direct", "direct light, reflected by leaves");
  else
    pass.read(direct, Access::storageLoad, "Direct", "direct light, reflected by leaves");
  const BufferHandle next =
      pass.write(sent(r, "outgoing"), Access::storageStore, "Next", "reflected by leaves, to be pulled up");
  std::map<std::string, std::string> defines;
  if (elements_.readSky(pass, r.inputs, gathered.sky, defines))
    pass.read(r.inputs.handles.medium, Access::uniformBuffer, "FrameBlock", "the medium");
  const auto kernelHandle = elements_.program(pass, "reflect.comp.glsl", std::move(defines));
  pass.execute([this, kernelHandle, links](frame::PassContext& context) {
    gpu::Program& kernel = context.use(kernelHandle);
    elements_.setSpace(kernel);
    for (const LinkChunk& chunk : elements_.chunks) {
      ElementPasses::bind(context, kernel, links, chunk);
      dispatchSent(context, chunk.count);
    }
  });
  return {direct, next};
}

frame::SlotHandle LightPasses::readBins(frame::PassBuilder& pass) const {
  elements_.readDirections(pass);
  pass.read(elements_.leaves, Access::storageLoad, "Leaves", "normals and albedos");
  return elements_.readLinks(pass);
}

void LightPasses::gatherChunks(frame::PassContext& context, frame::ProgramHandle program,
                               frame::SlotHandle links) const {
  gpu::Program& kernel = context.use(program);
  elements_.setSpace(kernel);
  for (const LinkChunk& chunk : elements_.chunks) {
    ElementPasses::bind(context, kernel, links, chunk);
    context.dispatchRows(chunk.count);
  }
}

const Gathered& LightPasses::sky(const PassRequest& r) {
  if (sky_) return *sky_;
  const std::vector<glm::vec4> radiance = radiosity::environmentBins(
      r.inputs.scene.environment, elements_.elements().space(), elements_.resolution());
  environment_ = gpu::Buffer::of<glm::vec4>(r.inputs.gpuScene.device(), "environment of bins", radiance);
  const BufferHandle bins = r.graph.importBuffer("environment of bins", environment_);
  const bool onProcessor = elements_.gathersOnProcessor() && !r.inputs.scene.medium.present();
  const BufferHandle irradiance =
      onProcessor ? skyIrradianceOnProcessor(r, radiance) : skyIrradiance(r, bins);
  sky_ = Gathered{irradiance, bins, true};
  return *sky_;
}

BufferHandle LightPasses::skyIrradiance(const PassRequest& r, BufferHandle bins) {
  frame::PassBuilder pass = r.graph.addPass("environment light", technique_);
  const frame::SlotHandle links = readBins(pass);
  pass.read(bins, Access::storageLoad, "Source", "radiance of bins").cacheable();
  const BufferHandle irradiance =
      pass.write(perSlot(r, "environment's irradiance"), Access::storageStore, "Irradiance", "of leaves");
  std::map<std::string, std::string> defines;
  if (elements_.readSky(pass, r.inputs, true, defines))
    pass.read(r.inputs.handles.medium, Access::uniformBuffer, "FrameBlock", "the medium");
  const auto kernelHandle = elements_.program(pass, "gather.comp.glsl", std::move(defines));
  pass.execute([this, kernelHandle, links](frame::PassContext& context) {
    gatherChunks(context, kernelHandle, links);
  });
  return irradiance;
}

BufferHandle LightPasses::skyIrradianceOnProcessor(const PassRequest& r,
                                                   std::span<const glm::vec4> radiance) {
  ProcessorGather& own = processorGathers_.emplace_back(r.inputs.gpuScene.device(), elements_);
  frame::PassBuilder pass = r.graph.addPass("environment light", technique_);
  elements_.readInMemory(pass);
  pass.cacheable();
  const BufferHandle irradiance = pass.write(
      r.graph.importBuffer("environment's irradiance", own.irradiance()), Access::copyTarget, "of leaves");
  pass.execute([&own, bins = std::vector<glm::vec3>(radiance.begin(), radiance.end())](frame::PassContext&) {
    own.gatherEnvironment(bins);
  });
  return irradiance;
}

}  // namespace limn::implicit_visibility
