#include "techniques/implicit_visibility/element_passes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/radiosity/illumination.h"
#include "core/scene/gpu_scene.h"

namespace limn::implicit_visibility {

using frame::Access;

namespace {

size_t rowBytes(const ElementSettings& settings) {
  const auto n = static_cast<size_t>(settings.links.resolution);
  return 6 * n * n * sizeof(uint32_t);
}

uint32_t mostElements(const ElementSettings& settings) {
  return static_cast<uint32_t>(static_cast<size_t>(settings.memory) / rowBytes(settings));
}

}  // namespace

ElementPasses::ElementPasses(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                             const ElementSettings& settings)
    : settings_(settings),
      pose_(inputs.pose),
      elements_(inputs.scene, inputs.pose, settings.longestEdge, mostElements(settings)) {
  createBuffers(inputs.gpuScene.device());
  groups = graph.importBuffer("element groups", groupBuffer_);
  leaves = graph.importBuffer("leaves", leafBuffer_);
  corners = graph.importBuffer("triangles between leaves", cornerBuffer_);
  directions = graph.importBuffer("directions of bins", directions_);
  addUpdate(graph, inputs);
  addLinks(graph);
}

void ElementPasses::createBuffers(gpu::Device& device) {
  const auto groupsNow = elements_.forest().groups();
  groupBuffer_ = gpu::Buffer(device, "element groups", groupsNow.size_bytes(), gpu::BufferUse::updated);
  leafBuffer_ = gpu::Buffer(device, "leaves", elements_.leaves().size_bytes(), gpu::BufferUse::updated);
  cornerBuffer_ = gpu::Buffer::of(device, "triangles between leaves", elements_.triangles());
  const std::vector<glm::vec4> table = radiosity::binTable(settings_.links.resolution);
  directions_ = gpu::Buffer::of<glm::vec4>(device, "directions of bins", table);
  const auto most =
      static_cast<uint32_t>(static_cast<size_t>(device.limits().maxStorageBlockBytes) / rowBytes(settings_));
  for (uint32_t first = 0; first < std::max(leafSlots(), 1u); first += most) {
    const uint32_t count = std::min(most, leafSlots() - first);
    linkBuffers_.emplace_back(device, fmt::format("links from leaf {}", first), count * rowBytes(settings_),
                              gpu::BufferUse::updated);
    chunks.push_back({{}, first, count});
  }
}

void ElementPasses::addUpdate(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
  frame::PassBuilder pass = graph.addPass("update elements", settings_.technique);
  pass.read(inputs.handles.geometry, Access::storageLoad, "vertices, which the CPU moves as well")
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
    for (size_t i = 0; i < chunks.size(); ++i)
      linkBuffers_[i].update(0, links_.links().data() + chunks[i].first * links_.binCount(),
                             chunks[i].count * rowBytes(settings_));
  });
}

frame::ProgramHandle ElementPasses::program(frame::PassBuilder& pass, const char* file,
                                            std::map<std::string, std::string> defines) const {
  defines["BINS"] = bins();
  return pass.program(
      {.files = {fmt::format("techniques/implicit_visibility/{}", file)}, .defines = defines});
}

void ElementPasses::readLinks(frame::PassBuilder& pass) const {
  pass.read(directions, Access::storageLoad, "directions and solid angles of bins")
      .read(leaves, Access::storageLoad, "normals and albedos");
  for (const LinkChunk& chunk : chunks) pass.read(chunk.links, Access::storageLoad, "links");
}

void ElementPasses::bind(const frame::PassContext& context, gpu::Program& kernel, const LinkChunk& chunk) {
  kernel.set("first_leaf", chunk.first);
  kernel.set("leaf_count", chunk.count);
  context.bindStorage(2, chunk.links);
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
