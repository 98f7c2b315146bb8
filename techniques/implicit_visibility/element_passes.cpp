#include "techniques/implicit_visibility/element_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/radiosity/illumination.h"
#include "core/shadow/sample_batches.h"

namespace limn::implicit_visibility {

using frame::Access;

namespace {

/// Every device dispatches 65535 work groups in a row, each of which may take 64 leaves.
constexpr size_t kMostLeavesOfChunk = size_t{64} * 65535;

size_t rowBytes(const ElementSettings& settings) {
  const auto n = static_cast<size_t>(settings.links.resolution);
  return 6 * n * n * sizeof(uint32_t);
}

/// Radiance that all elements send, in three copies; elements of all levels are a third more than leaves.
size_t sentBytes(const ElementSettings& settings) {
  return 4 * 6 * static_cast<size_t>(settings.glossy * settings.glossy) * sizeof(glm::vec4);
}

uint32_t mostElements(const ElementSettings& settings) {
  return static_cast<uint32_t>(static_cast<size_t>(settings.memory) /
                               (rowBytes(settings) + sentBytes(settings)));
}

/// Returns at how many points the density of a medium is looked up along a bin's way through its grid: the
/// errors of many bins average out. llvmpipe leaves the loops of a thread after 65,535 steps, and a pixel
/// follows the ways of half the bins of three leaves.
int mediumSteps(int resolution) {
  return std::clamp(3072 / (resolution * resolution), 3, 12);
}

}  // namespace

ElementPasses::ElementPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                             const ElementSettings& settings)
    : settings_(settings),
      pose_(inputs.pose),
      elements_(inputs.scene, inputs.pose, settings.longestEdge, mostElements(settings), settings.lift,
                settings.links.fill == radiosity::Fill::triangles ? radiosity::LeafShape::triangles
                                                                  : radiosity::LeafShape::disc) {
  createBuffers(inputs.gpuScene.device());
  boundedLoops_ = shadow::mostStepsOfLoops(inputs) < std::numeric_limits<int>::max();
  groups = graph.importBuffer("element groups", groupBuffer_);
  leaves = graph.importBuffer("leaves", leafBuffer_);
  corners = graph.importBuffer("triangles between leaves", cornerBuffer_);
  directions = graph.importBuffer("directions of bins", directions_);
  if (glossy()) materials = graph.importBuffer("materials of leaves", materialBuffer_);
  addUpdate(graph, inputs);
  if (settings.onGpu) {
    roots_ = graph.importBuffer("roots of clusters", rootBuffer_);
    firstTriangles_ = graph.importBuffer("first triangles of leaves", firstTriangleBuffer_);
    addGpuLinks(graph);
  } else {
    addLinks(graph);
  }
}

void ElementPasses::createBuffers(gpu::Device& device) {
  const auto groupsNow = elements_.forest().groups();
  const auto most = static_cast<size_t>(device.limits().maxStorageBlockBytes);
  const size_t largest =
      std::max({groupsNow.size_bytes(), elements_.leaves().size_bytes(), elements_.triangles().size_bytes()});
  if (largest > most)
    throw UsageError(fmt::format(
        "implicit visibility: {} elements take {} MiB, more than the {} MiB of a storage buffer; raise "
        "longest_edge",
        slots(), largest >> 20, most >> 20));
  groupBuffer_ = gpu::Buffer(device, "element groups", groupsNow.size_bytes(), gpu::BufferUse::updated);
  leafBuffer_ = gpu::Buffer(device, "leaves", elements_.leaves().size_bytes(), gpu::BufferUse::updated);
  cornerBuffer_ = gpu::Buffer::of(device, "triangles between leaves", elements_.triangles());
  binTable_ = radiosity::binTable(settings_.links.resolution);
  directions_ = gpu::Buffer::of<glm::vec4>(device, "directions of bins", binTable_);
  software_ = device.software();
  if (settings_.onGpu) {
    rootBuffer_ = gpu::Buffer::of(device, "roots of clusters", elements_.forest().roots());
    firstTriangleBuffer_ =
        gpu::Buffer::of(device, "first triangles of leaves", elements_.forest().firstTriangle());
  }
  if (glossy()) {
    materialBuffer_ = gpu::Buffer::of(device, "materials of leaves", elements_.materials());
    const size_t bytes = size_t{slots()} * sentCount() * sizeof(glm::vec4);
    if (bytes > most)
      throw UsageError(fmt::format(
          "implicit visibility: what {} elements send into 6 x {} x {} bins takes {} MiB; a storage block "
          "holds {}",
          slots(), settings_.glossy, settings_.glossy, bytes >> 20, most >> 20));
  }
  const auto together = static_cast<uint32_t>(std::min(most / rowBytes(settings_), kMostLeavesOfChunk));
  for (uint32_t first = 0; first < std::max(leafSlots(), 1u); first += together) {
    const uint32_t count = std::min(together, leafSlots() - first);
    linkBuffers_.emplace_back(device, fmt::format("links from leaf {}", first), count * rowBytes(settings_),
                              gpu::BufferUse::updated);
    chunks.push_back({{}, first, count});
  }
}

void ElementPasses::addUpdate(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
  frame::PassBuilder pass = graph.addPass("update elements", settings_.technique);
  pass.read(inputs.handles.geometry, Access::storageLoad, "vertices, which the CPU moves as well")
      .read(inputs.handles.instances, Access::storageLoad, "where instances are")
      .cacheable();
  groups = pass.write(groups, Access::copyTarget, "discs and bounds of all levels");
  leaves = pass.write(leaves, Access::copyTarget, "vertices and normals");
  pass.execute([this](frame::PassContext&) {
    elements_.update(pose_);
    const auto groupsNow = elements_.forest().groups();
    groupBuffer_.update(0, groupsNow.data(), groupsNow.size_bytes());
    leafBuffer_.update(0, elements_.leaves().data(), elements_.leaves().size_bytes());
  });
}

void ElementPasses::addLinks(frame::FrameGraph& graph) {
  frame::PassBuilder pass = graph.addPass("links", settings_.technique);
  pass.read(groups, Access::storageLoad, "elements, in the CPU's memory as well").cacheable();
  for (size_t i = 0; i < chunks.size(); ++i)
    chunks[i].links = pass.write(graph.importBuffer(fmt::format("links {}", i), linkBuffers_[i]),
                                 Access::copyTarget, "the nearest element in each bin of each leaf");
  pass.execute([this](frame::PassContext&) {
    if (settings_.flat)
      links_.buildFlat(elements_.forest(), settings_.links);
    else
      links_.build(elements_.forest(), settings_.links);
    if (!linksRead_) return;
    for (size_t i = 0; i < chunks.size(); ++i)
      linkBuffers_[i].update(0, links_.links().data() + chunks[i].first * links_.binCount(),
                             chunks[i].count * rowBytes(settings_));
  });
}

void ElementPasses::addGpuLinks(frame::FrameGraph& graph) {
  // llvmpipe leaves the loops of a thread after 65,535 steps; a leaf takes about five for each bin it fills.
  if (boundedLoops_ && settings_.links.resolution > 16)
    throw UsageError(
        fmt::format("implicit_visibility.links=gpu: software renderers take at most 16 bins a side, not {}",
                    settings_.links.resolution));
  for (size_t i = 0; i < chunks.size(); ++i) {
    chunks[i].links = graph.importBuffer(fmt::format("links {}", i), linkBuffers_[i]);
    addGpuLinks(graph, chunks[i]);
  }
}

void ElementPasses::addGpuLinks(frame::FrameGraph& graph, LinkChunk& chunk) const {
  frame::BufferHandle lengths = graph.createBuffer("lengths of links", {chunk.count * rowBytes(settings_)});
  const bool footprint = settings_.links.fill != radiosity::Fill::centre,
             triangles = settings_.links.fill == radiosity::Fill::triangles;
  const auto addStep = [&](const char* name, const char* file, Access access, int64_t groupCount,
                           glm::uvec2 someRoots) {
    frame::PassBuilder pass = graph.addPass(name, settings_.technique);
    pass.read(groups, Access::storageLoad, "elements").cacheable();
    if (someRoots.y > 0) pass.also("Groups").read(roots_, Access::storageLoad, "Roots", "where to begin");
    if (someRoots.y > 0 && triangles)
      pass.read(leaves, Access::storageLoad, "Leaves", "vertices")
          .read(corners, Access::storageLoad, "Triangles", "their leaves")
          .read(firstTriangles_, Access::storageLoad, "FirstTriangle", "those of each leaf");
    chunk.links = pass.write(chunk.links, access, "Links", "the nearest element in each bin of each leaf");
    lengths = pass.write(lengths, access, "Distances", "how far it is");
    const auto kernelHandle =
        program(pass, file, {{"FILL", fmt::format("{}", static_cast<int>(settings_.links.fill))}});
    pass.execute(
        [this, kernelHandle, own = chunk, someRoots, groupCount, triangles](frame::PassContext& context) {
          gpu::Program& kernel = context.use(kernelHandle);
          kernel.set("leaf_count", own.count);
          if (someRoots.y > 0) {
            kernel.set("first_leaf", own.first);
            kernel.set("first_root", someRoots.x);
            kernel.set("root_count", someRoots.y);
            kernel.set("opening", settings_.links.opening);
            if (triangles) {
              kernel.set("unit", elements_.space().radius());
              setSpace(kernel);
            }
          }
          context.dispatchRows(groupCount);
        });
  };
  const auto leafCount = static_cast<int64_t>(chunk.count);
  addStep("clear links", "clear_links.comp.glsl", Access::storageStore, leafCount, {0, 0});
  const auto rootCount = static_cast<uint32_t>(elements_.forest().roots().size());
  const uint32_t batch = boundedLoops_ ? 16 : std::max(rootCount, 1u);
  for (uint32_t first = 0; first < rootCount; first += batch)
    addStep("links", "links.comp.glsl", Access::storageLoadStore, (leafCount + 63) / 64,
            {first, std::min(batch, rootCount - first)});
  if (footprint)
    addStep("close links", "close_links.comp.glsl", Access::storageLoadStore, (6 * leafCount + 63) / 64,
            {0, 0});
}

frame::ProgramHandle ElementPasses::program(frame::PassBuilder& pass, const char* file,
                                            std::map<std::string, std::string> defines) const {
  defines["BINS"] = fmt::format("{}u", settings_.links.resolution);
  defines["GLOSSY"] = fmt::format("{}", settings_.glossy);
  return pass.program(
      {.files = {fmt::format("techniques/implicit_visibility/{}", file)}, .defines = defines});
}

void ElementPasses::readDirections(frame::PassBuilder& pass) const {
  pass.read(directions, Access::storageLoad, "Directions", "directions and solid angles of bins");
}

bool ElementPasses::readSky(frame::PassBuilder& pass, const TechniqueInputs& inputs, bool sky,
                            std::map<std::string, std::string>& defines) const {
  const bool medium = sky && inputs.scene.medium.present();
  defines["SKY"] = sky ? "1" : "0";
  defines["MEDIUM"] = medium ? "1" : "0";
  if (!medium) return false;
  const scene::MediumInput input(inputs.handles, mediumSteps(resolution()));
  input.define(defines);
  input.declare(pass);
  return true;
}

void ElementPasses::readInMemory(frame::PassBuilder& pass) const {
  pass.read(groups, Access::storageLoad, "elements, in the CPU's memory as well")
      .read(leaves, Access::storageLoad, "albedos, in the CPU's memory as well");
  for (const LinkChunk& chunk : chunks)
    pass.read(chunk.links, Access::storageLoad, "links, in the CPU's memory as well");
}

frame::SlotHandle ElementPasses::readLinks(frame::PassBuilder& pass) const {
  linksRead_ = true;
  for (const LinkChunk& chunk : chunks) pass.read(chunk.links, Access::storageLoad, "links");
  return pass.slot("Links");
}

void ElementPasses::bind(const frame::PassContext& context, gpu::Program& kernel, frame::SlotHandle links,
                         const LinkChunk& chunk) {
  kernel.set("first_leaf", chunk.first);
  kernel.set("leaf_count", chunk.count);
  context.bind(links, context.buffer(chunk.links));
}

void ElementPasses::setSpace(gpu::Program& program) const {
  const radiosity::ElementSpace& space = elements_.space();
  const glm::vec3 x = space.direction({1, 0, 0}), y = space.direction({0, 1, 0}),
                  z = space.direction({0, 0, 1});
  const char* names[] = {"bins_x", "bins_y", "bins_z"};
  for (int row = 0; row < 3; ++row) {
    const float values[4] = {x[row], y[row], z[row], 0};
    program.set4(names[row], values);
  }
}

}  // namespace limn::implicit_visibility
