#include "techniques/illumination_samples/solution.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/gpu_scene/gpu_scene.h"
#include "core/shadow/sample_batches.h"

namespace limn::illumination_samples {

using frame::Access;

namespace {

/// What an element takes at least: its place in all levels, and some samples.
constexpr uint64_t kBytesPerElement = 512;

uint32_t mostElements(const SolutionSettings& settings) {
  return static_cast<uint32_t>(
      std::min<uint64_t>(settings.samples.memory / kBytesPerElement, uint64_t{1} << 28));
}

}  // namespace

Elements::Elements(frame::FrameGraph& graph, const TechniqueInputs& inputs, const SolutionSettings& settings)
    : scene_(inputs.scene),
      pose_(inputs.pose),
      elements_(inputs.scene, inputs.pose, settings.longestEdge, mostElements(settings)) {
  gpu::Device& device = inputs.gpuScene.device();
  const auto most = static_cast<size_t>(device.limits().maxStorageBlockBytes);
  const size_t largest = std::max({elements_.leaves().size_bytes(), elements_.triangles().size_bytes(),
                                   elements_.forest().slots() * sizeof(glsl::SampleSender)});
  if (largest > most)
    throw UsageError(fmt::format(
        "illumination samples: {} elements take {} MiB, more than the {} MiB of a storage buffer; "
        "raise longest_edge",
        elements_.forest().slots(), largest >> 20, most >> 20));
  leafBuffer_ = gpu::Buffer(device, "leaves", elements_.leaves().size_bytes(), gpu::BufferUse::updated);
  cornerBuffer_ = gpu::Buffer::of(device, "triangles between leaves", elements_.triangles());
  parentBuffer_ = gpu::Buffer::of(device, "parents of element groups", elements_.forest().parents());
  leaves = graph.importBuffer("leaves", leafBuffer_);
  corners = graph.importBuffer("triangles between leaves", cornerBuffer_);
  parents = graph.importBuffer("parents of element groups", parentBuffer_);
  frame::PassBuilder pass = graph.addPass("update elements", settings.technique);
  pass.read(inputs.handles.geometry, Access::storageLoad, "vertices, which the CPU moves as well")
      .read(inputs.handles.instances, Access::storageLoad, "where instances are")
      .cacheable();
  if (inputs.handles.density)
    pass.read(inputs.handles.density, Access::sampled, "smoke, which the CPU has as well");
  leaves = pass.write(leaves, Access::copyTarget, "vertices and normals");
  pass.execute([this](frame::PassContext&) {
    elements_.update(pose_);
    occlusion_ = radiosity::sceneOcclusion(scene_, pose_);
    leafBuffer_.update(0, elements_.leaves().data(), elements_.leaves().size_bytes());
  });
}

Solution::Solution(frame::FrameGraph& graph, const TechniqueInputs& inputs, const Elements& elements,
                   std::span<const uint32_t> lights, const SolutionSettings& settings)
    : elements_(elements),
      settings_(settings),
      lights_(lights.begin(), lights.end()),
      solver_(elements.elements().surfels(), elements.elements().forest(), elements.elements().space(),
              elements.elements().materials(), settings.samples) {
  gpu::Device& device = inputs.gpuScene.device();
  irradianceNow_.resize(elements.elements().forest().leafSlots());
  addLights(graph, inputs);
  irradiance = lit_;
  for (int bounce = 0; bounce < settings.bounces; ++bounce) addBounce(graph, device);
  if (settings.shown == Shown::gathered)
    addSamples(graph, inputs);
  else
    addTrees(graph, device);
}

void Solution::addLights(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
  litBuffer_ = gpu::Buffer(inputs.gpuScene.device(), "light of lights", 16, gpu::BufferUse::updated);
  frame::PassBuilder pass = graph.addPass("light samples", settings_.technique);
  pass.read(elements_.leaves, Access::copySource, "elements, in the CPU's memory as well")
      .read(inputs.handles.lights, Access::storageLoad, "lights, which the CPU has as well")
      .cacheable();
  lit_ = pass.write(graph.importBuffer("light of lights", litBuffer_), Access::copyTarget,
                    "stands for the light at leaves, which stays in the CPU's memory");
  pass.execute([this, &pose = inputs.pose](frame::PassContext&) { light(pose); });
}

void Solution::light(const scene::Pose& pose) {
  std::vector<glsl::Light> lights;
  for (const uint32_t index : lights_) lights.push_back(pose.lights[index]);
  solver_.begin();
  radiosity::lightLeaves(elements_.elements(), lights, elements_.occlusion(), settings_.lightRays, solver_);
}

void Solution::addBounce(frame::FrameGraph& graph, gpu::Device& device) {
  gpu::Buffer& buffer =
      irradianceBuffers_.emplace_back(device, fmt::format("irradiance {}", irradianceBuffers_.size() + 1),
                                      irradianceNow_.size() * sizeof(glm::vec4), gpu::BufferUse::updated);
  frame::PassBuilder pass = graph.addPass("shoot", settings_.technique);
  pass.read(irradiance, Access::copySource, "light that arrived, in the CPU's memory as well").cacheable();
  irradiance = pass.write(
      graph.importBuffer(fmt::format("irradiance over {} surfaces", irradianceBuffers_.size()), buffer),
      Access::copyTarget, "of leaves");
  pass.execute([this, &buffer](frame::PassContext&) {
    solver_.reflect();
    solver_.shoot(elements_.occlusion());
    std::ranges::transform(solver_.irradiance(), irradianceNow_.begin(),
                           [](const glm::vec3& e) { return glm::vec4(e, 0); });
    buffer.update(0, irradianceNow_.data(), irradianceNow_.size() * sizeof(glm::vec4));
  });
}

void Solution::addSamples(frame::FrameGraph& graph, const TechniqueInputs& inputs) {
  gpu::Device& device = inputs.gpuScene.device();
  rangesNow_.resize(elements_.elements().forest().slots());
  rangeBuffer_ = gpu::Buffer(device, "ranges of samples", rangesNow_.size() * sizeof(glm::uvec2),
                             gpu::BufferUse::updated);
  sampleBuffer_ =
      gpu::Buffer(device, "illumination samples", sizeof(glsl::IlluminationSample), gpu::BufferUse::updated);
  sendersNow_.resize(rangesNow_.size());
  senderBuffer_ = gpu::Buffer(device, "senders of samples", sendersNow_.size() * sizeof(glsl::SampleSender),
                              gpu::BufferUse::updated);
  frame::PassBuilder pass = graph.addPass("upload", settings_.technique);
  pass.read(irradiance, Access::copySource, "samples, in the CPU's memory").cacheable();
  ranges = pass.write(graph.importBuffer("ranges of samples", rangeBuffer_), Access::copyTarget,
                      "which samples an element has");
  samples = pass.write(graph.importBuffer("illumination samples", sampleBuffer_), Access::copyTarget,
                       "of all elements");
  senders = pass.write(graph.importBuffer("senders of samples", senderBuffer_), Access::copyTarget,
                       "where elements are");
  pass.execute([this, &device, mostSteps = shadow::mostStepsOfLoops(inputs)](frame::PassContext&) {
    uploadSamples(device, mostSteps);
  });
}

void Solution::addTrees(frame::FrameGraph& graph, gpu::Device& device) {
  treesNow_.resize(elements_.elements().forest().leafSlots());
  treeBuffer_ =
      gpu::Buffer(device, "trees of leaves", treesNow_.size() * sizeof(LeafTree), gpu::BufferUse::updated);
  nodeBuffer_ = gpu::Buffer(device, "nodes of trees", sizeof(glm::uvec2), gpu::BufferUse::updated);
  frame::PassBuilder pass = graph.addPass("project", settings_.technique);
  pass.read(irradiance, Access::copySource, "samples, in the CPU's memory").cacheable();
  trees =
      pass.write(graph.importBuffer("trees of leaves", treeBuffer_), Access::copyTarget, "where they begin");
  nodes = pass.write(graph.importBuffer("nodes of trees", nodeBuffer_), Access::copyTarget,
                     "what leaves reflect of their samples, by directions");
  pass.execute([this, &device](frame::PassContext&) {
    solver_.project(settings_.shownTree);
    uploadTrees(device);
  });
}

namespace {

/// Grows a buffer to at least `bytes`. Throws UsageError for what no storage block of the device holds.
void reserve(gpu::Device& device, gpu::Buffer& buffer, const char* what, size_t bytes) {
  const auto most = static_cast<size_t>(device.limits().maxStorageBlockBytes);
  if (bytes > most)
    throw UsageError(
        fmt::format("illumination_samples: {} take {} MiB; a storage block holds {}: a larger link_error, "
                    "direction_error or longest_edge makes fewer",
                    what, bytes >> 20, most >> 20));
  if (buffer.size() < bytes) buffer = gpu::Buffer(device, what, bytes, gpu::BufferUse::updated);
}

/// Throws UsageError where a pixel of a glossy surface has more samples than its loops may take steps.
void checkSteps(const radiosity::SampleSolver& solver, int mostSteps) {
  const uint64_t most = solver.mostSamplesAround();
  if (most > static_cast<uint64_t>(mostSteps))
    throw UsageError(
        fmt::format("illumination_samples: display=gather reflects up to {} samples at a pixel; software "
                    "renderers take {}: a larger link_error or longest_edge makes fewer, and display=pixel "
                    "reflects them at elements",
                    most, mostSteps));
}

}  // namespace

void Solution::uploadTrees(gpu::Device& device) {
  nodesNow_.clear();
  const auto shown = solver_.shown();
  for (size_t leaf = 0; leaf < shown.size(); ++leaf) {
    treesNow_[leaf] = {};
    if (shown[leaf].empty()) continue;
    treesNow_[leaf].first = static_cast<uint32_t>(nodesNow_.size());
    treesNow_[leaf].scale = shown[leaf].pack(nodesNow_);
  }
  const size_t bytes = nodesNow_.size() * sizeof(glm::uvec2);
  reserve(device, nodeBuffer_, "nodes of trees", bytes);
  treeBuffer_.update(0, treesNow_.data(), treesNow_.size() * sizeof(LeafTree));
  nodeBuffer_.update(0, nodesNow_.data(), bytes);
}

void Solution::uploadSamples(gpu::Device& device, int mostSteps) {
  checkSteps(solver_, mostSteps);
  const size_t bytes = solver_.sampleCount() * sizeof(glsl::IlluminationSample);
  reserve(device, sampleBuffer_, "illumination samples", bytes);
  const radiosity::ElementSpace& space = elements_.elements().space();
  samplesNow_.clear();
  for (uint32_t slot = 0; slot < rangesNow_.size(); ++slot) {
    const auto own = solver_.samples(slot);
    rangesNow_[slot] = {static_cast<uint32_t>(samplesNow_.size()), static_cast<uint32_t>(own.size())};
    for (const radiosity::SampleAtElement& sample : own)
      samplesNow_.push_back({.radiance = sample.radiance, .sender = sample.sender});
    const radiosity::Sender sender = solver_.sender(slot);
    if (!(sender.area > 0)) continue;  // an unused lane, which sends nothing
    sendersNow_[slot] = {.position = space.worldPoint(sender.position),
                         .area = space.radius() * space.radius() * sender.area,
                         .side = space.radius() * space.worldDirection(sender.side),
                         .normal = glsl::vertex_pack_normal(space.worldDirection(sender.normal))};
  }
  senderBuffer_.update(0, sendersNow_.data(), sendersNow_.size() * sizeof(glsl::SampleSender));
  rangeBuffer_.update(0, rangesNow_.data(), rangesNow_.size() * sizeof(glm::uvec2));
  sampleBuffer_.update(0, samplesNow_.data(), bytes);
}

}  // namespace limn::illumination_samples
