#include "techniques/implicit_visibility/light_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/reference/environment.h"
#include "core/scene/gpu_scene.h"
#include "core/shading/ltc_table.h"

namespace limn::implicit_visibility {

using frame::Access;
using frame::BufferHandle;

LightPasses::LightPasses(const ElementPasses& elements, std::string_view technique)
    : elements_(elements), technique_(technique) {}

frame::BufferHandle LightPasses::seenBy(const PassRequest& r, std::span<const uint32_t> lights) {
  return seen(r, lights).seen;
}

Gathered LightPasses::reflected(const PassRequest& r, std::span<const uint32_t> lights, bool sky,
                                int bounces) {
  auto [direct, outgoing] = directLight(r, lights, sky);
  Gathered gathered;
  for (int bounce = 1; bounce <= bounces; ++bounce) {
    const BufferHandle pulled = pullUp(r, outgoing);
    gathered = gather(r, pulled, direct, outgoing);
  }
  return gathered;
}

BufferHandle LightPasses::perSlot(const PassRequest& r, const char* name, uint32_t count) const {
  return r.graph.createBuffer(name, {std::max<size_t>(elements_.slots(), 1) * count * sizeof(glm::vec4)});
}

BufferHandle LightPasses::sent(const PassRequest& r, const char* name) const {
  return perSlot(r, name, elements_.sentCount());
}
void LightPasses::dispatchSent(const frame::PassContext& context, uint32_t slots) const {
  const glm::ivec2 groups = ElementPasses::workGroups((int64_t{slots} * elements_.sentCount() + 63) / 64);
  context.dispatch(groups.x, groups.y, 1, 1, 1);
}

const LightPasses::Seen& LightPasses::seen(const PassRequest& r, std::span<const uint32_t> lights) {
  for (const Seen& known : seen_)
    if (std::ranges::equal(known.lights, lights)) return known;
  Seen& s = seen_.emplace_back();
  s.lights.assign(lights.begin(), lights.end());
  s.indexBuffer =
      gpu::Buffer::of(r.inputs.gpuScene.device(), "lights asked for", std::span<const uint32_t>(s.lights));
  s.indices = r.graph.importBuffer(fmt::format("lights asked for {}", seen_.size()), s.indexBuffer);
  frame::PassBuilder pass = r.graph.addPass("light visibility", technique_);
  elements_.readLinks(pass);
  pass.read(r.inputs.handles.lights, Access::storageLoad, "lights")
      .read(elements_.groups, Access::storageLoad, "how far elements are")
      .read(s.indices, Access::storageLoad, "which lights")
      .cacheable();
  const size_t bytes = std::max<size_t>(lights.size() * elements_.leafSlots(), 4) * sizeof(float);
  s.seen = pass.write(r.graph.createBuffer("visibility of lights", {bytes}), Access::storageStore,
                      "V of each leaf");
  const auto kernelHandle = elements_.program(pass, "light_visibility.comp.glsl");
  pass.execute([this, kernelHandle, lightBuffer = r.inputs.handles.lights, indices = s.indices, seen = s.seen,
                count = static_cast<int>(lights.size()),
                samples = r.inputs.parameters.integer("light_samples")](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    elements_.setSpace(kernel);
    kernel.set("slots", elements_.leafSlots());
    kernel.set("samples", static_cast<unsigned>(samples));
    kernel.set("unit", elements_.elements().space().radius());
    context.bindStorage(0, lightBuffer);
    context.bindStorage(1, elements_.leaves);
    context.bindStorage(3, elements_.groups);
    context.bindStorage(4, indices);
    context.bindStorage(5, seen);
    for (const LinkChunk& chunk : elements_.chunks) {
      ElementPasses::bind(context, kernel, chunk);
      context.dispatch(static_cast<int>(chunk.count), count, 1, 64, 1);
    }
  });
  return s;
}

LightPasses::Sent LightPasses::directLight(const PassRequest& r, std::span<const uint32_t> lights, bool sky) {
  const Seen* seen = lights.empty() ? nullptr : &this->seen(r, lights);
  const BufferHandle skyIrradiance = sky ? this->sky(r).irradiance : BufferHandle{};
  const bool glossy = elements_.glossy();
  frame::PassBuilder pass = r.graph.addPass("direct light", technique_);
  pass.read(r.inputs.handles.lights, Access::storageLoad, "lights")
      .read(elements_.leaves, Access::storageLoad, "normals and albedos")
      .cacheable();
  if (seen)
    pass.read(seen->seen, Access::storageLoad, "V of each light")
        .read(seen->indices, Access::storageLoad, "which lights");
  if (sky && !glossy) pass.read(skyIrradiance, Access::storageLoad, "irradiance of the environment");
  frame::TextureHandle ltc;
  if (glossy) {
    if (!ltcTable_) ltcTable_ = shading::makeLtcTexture(r.inputs.gpuScene.device());
    ltc = r.graph.importTexture("lobes as linearly transformed cosines", ltcTable_);
    pass.read(elements_.materials, Access::storageLoad, "BRDFs")
        .read(ltc, Access::sampled, "glossy light of rectangles");
  }
  const BufferHandle direct =
      pass.write(sent(r, "direct light"), Access::storageStore, "reflected by leaves");
  const BufferHandle outgoing =
      pass.write(sent(r, "outgoing"), Access::storageStore, "the same, before it is pulled up");
  const auto kernelHandle = elements_.program(
      pass, "direct.comp.glsl", {{"LIGHTS", seen ? "1" : "0"}, {"ENVIRONMENT", sky ? "1" : "0"}});
  pass.execute([this, kernelHandle, seen, skyIrradiance, direct, outgoing, glossy, ltc,
                lightBuffer = r.inputs.handles.lights, count = lights.size()](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    if (glossy && seen) elements_.setSpace(kernel);  // no light, no direction
    kernel.set("slots", elements_.leafSlots());
    context.bindStorage(0, lightBuffer);
    context.bindStorage(1, elements_.leaves);
    context.bindStorage(2, direct);
    context.bindStorage(3, outgoing);
    if (seen) {
      kernel.set("light_count", static_cast<unsigned>(count));
      context.bindStorage(4, seen->indices);
      context.bindStorage(5, seen->seen);
    }
    if (skyIrradiance && !glossy) context.bindStorage(6, skyIrradiance);
    if (glossy) {
      context.bindStorage(7, elements_.materials);
      context.bindSampled(glsl::ltc_unit, ltc);
    }
    dispatchSent(context, elements_.leafSlots());
  });
  if (sky && glossy) return reflect(r, this->sky(r), direct);
  return {direct, outgoing};
}

BufferHandle LightPasses::pullUp(const PassRequest& r, BufferHandle outgoing) {
  const auto levels = elements_.elements().forest().levels();
  for (size_t level = 1; level < levels.size(); ++level) {
    frame::PassBuilder pass = r.graph.addPass("pull up", technique_);
    pass.read(elements_.groups, Access::storageLoad, "children and areas").cacheable();
    outgoing = pass.write(outgoing, Access::storageLoadStore, "radiance of the next level");
    const auto kernelHandle = elements_.program(pass, "pull_up.comp.glsl");
    pass.execute([this, kernelHandle, outgoing, range = levels[level]](frame::PassContext& context) {
      gpu::Program& kernel = context.program(kernelHandle);
      kernel.use();
      kernel.set("first_group", range.first);
      kernel.set("group_count", range.count);
      context.bindStorage(0, elements_.groups);
      context.bindStorage(1, outgoing);
      dispatchSent(context, 4 * range.count);
    });
  }
  return outgoing;
}

Gathered LightPasses::gather(const PassRequest& r, BufferHandle outgoing, BufferHandle direct,
                             BufferHandle& next) {
  const bool glossy = elements_.glossy();
  frame::PassBuilder pass = r.graph.addPass("gather", technique_);
  elements_.readLinks(pass);
  pass.read(outgoing, Access::storageLoad, "radiance of elements").cacheable();
  if (!glossy) pass.read(direct, Access::storageLoad, "direct light, reflected by leaves");
  const BufferHandle irradiance = pass.write(perSlot(r, "irradiance"), Access::storageStore, "of leaves");
  const BufferHandle reflected =
      glossy ? BufferHandle{}
             : pass.write(perSlot(r, "outgoing"), Access::storageStore, "reflected by leaves");
  const auto kernelHandle = elements_.program(pass, "gather.comp.glsl", gatherDefines(r, false));
  pass.execute([this, kernelHandle, outgoing, direct, irradiance, reflected,
                oneEach = serial(r)](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    context.bindStorage(3, outgoing);
    if (reflected) {
      context.bindStorage(5, direct);
      context.bindStorage(6, reflected);
    }
    gatherChunks(context, kernel, irradiance, oneEach);
  });
  const Gathered gathered{irradiance, outgoing, false};
  next = glossy ? reflect(r, gathered, direct).second : reflected;
  return gathered;
}

LightPasses::Sent LightPasses::reflect(const PassRequest& r, const Gathered& gathered,
                                       BufferHandle direct) const {
  frame::PassBuilder pass = r.graph.addPass("reflect", technique_);
  elements_.readLinks(pass);
  pass.read(gathered.source, Access::storageLoad, "radiance of elements or of the environment")
      .read(gathered.irradiance, Access::storageLoad, "of leaves")
      .read(elements_.materials, Access::storageLoad, "BRDFs")
      .cacheable();
  if (gathered.sky)
    direct = pass.write(direct, Access::storageLoadStore, "direct light, reflected by leaves");
  else
    pass.read(direct, Access::storageLoad, "direct light, reflected by leaves");
  const BufferHandle next =
      pass.write(sent(r, "outgoing"), Access::storageStore, "reflected by leaves, to be pulled up");
  const auto kernelHandle = elements_.program(pass, "reflect.comp.glsl", {{"SKY", gathered.sky ? "1" : "0"}});
  pass.execute([this, kernelHandle, gathered, direct, next](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    elements_.setSpace(kernel);
    context.bindStorage(0, elements_.directions);
    context.bindStorage(1, elements_.leaves);
    context.bindStorage(3, gathered.source);
    context.bindStorage(4, gathered.irradiance);
    context.bindStorage(5, direct);
    context.bindStorage(6, next);
    context.bindStorage(7, elements_.materials);
    for (const LinkChunk& chunk : elements_.chunks) {
      ElementPasses::bind(context, kernel, chunk);
      dispatchSent(context, chunk.count);
    }
  });
  return {direct, next};
}

/// A thread for each leaf instead of a work group: on processors barriers cost more than loads in disorder.
bool LightPasses::serial(const PassRequest& r) {
  return r.inputs.gpuScene.device().software();
}

std::map<std::string, std::string> LightPasses::gatherDefines(const PassRequest& r, bool sky) {
  return {{"SKY", sky ? "1" : "0"}, {"SERIAL", serial(r) ? "1" : "0"}};
}

void LightPasses::gatherChunks(frame::PassContext& context, gpu::Program& kernel, BufferHandle irradiance,
                               bool serial) const {
  elements_.setSpace(kernel);
  context.bindStorage(0, elements_.directions);
  context.bindStorage(1, elements_.leaves);
  context.bindStorage(4, irradiance);
  for (const LinkChunk& chunk : elements_.chunks) {
    ElementPasses::bind(context, kernel, chunk);
    const glm::ivec2 groups = ElementPasses::workGroups(chunk.count);
    if (serial)
      context.dispatch(static_cast<int>(chunk.count), 1, 1, 64, 1);
    else
      context.dispatch(groups.x, groups.y, 1, 1, 1);
  }
}

const Gathered& LightPasses::sky(const PassRequest& r) {
  if (sky_) return *sky_;
  environment_ =
      gpu::Buffer::of<glm::vec4>(r.inputs.gpuScene.device(), "environment of bins", skyBins(r.inputs.scene));
  const BufferHandle bins = r.graph.importBuffer("environment of bins", environment_);
  frame::PassBuilder pass = r.graph.addPass("environment light", technique_);
  elements_.readLinks(pass);
  pass.read(bins, Access::storageLoad, "radiance of bins").cacheable();
  const BufferHandle irradiance =
      pass.write(perSlot(r, "environment's irradiance"), Access::storageStore, "of leaves");
  const auto kernelHandle = elements_.program(pass, "gather.comp.glsl", gatherDefines(r, true));
  pass.execute([this, kernelHandle, bins, irradiance, oneEach = serial(r)](frame::PassContext& context) {
    gpu::Program& kernel = context.program(kernelHandle);
    kernel.use();
    context.bindStorage(3, bins);
    gatherChunks(context, kernel, irradiance, oneEach);
  });
  sky_ = Gathered{irradiance, bins, true};
  return *sky_;
}

std::vector<glm::vec4> LightPasses::skyBins(const scene::Scene& scene) const {
  const reference::EnvironmentLight environment(scene.environment);
  const auto n = static_cast<uint32_t>(std::sqrt(static_cast<double>(elements_.binCount()) / 6) + 0.5);
  // Four samples for each pixel of the map, so that no small bright one is missed.
  const double pixels = double(scene.environment.width) * scene.environment.height;
  const int side =
      std::clamp(static_cast<int>(std::ceil(2 * std::sqrt(pixels / double(elements_.binCount())))), 2, 64);
  std::vector<glm::vec4> bins;
  for (uint32_t bin = 0; bin < 6 * n * n; ++bin) {
    glm::vec3 sum(0);
    float weights = 0;
    for (int s = 0; s < side * side; ++s) {
      const glm::vec2 in((static_cast<float>(s % side) + 0.5f) / float(side),
                         (static_cast<float>(s / side) + 0.5f) / float(side));
      const glm::vec2 place = (glm::vec2(float(bin % n), float(bin / n % n)) + in) * (2 / float(n)) - 1.f;
      const glm::vec3 ray = glsl::bin_face_direction(bin / (n * n), place);
      const float length2 = glm::dot(ray, ray), weight = 1 / (length2 * std::sqrt(length2));
      sum += weight * environment.radiance(glm::normalize(elements_.elements().space().worldDirection(ray)));
      weights += weight;
    }
    bins.emplace_back(sum / weights, 0);
  }
  return bins;
}

}  // namespace limn::implicit_visibility
