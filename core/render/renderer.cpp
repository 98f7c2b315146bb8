#include "core/render/renderer.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/render/private/implementation.h"
#include "core/render/private/read_picture.h"
#include "core/shadow/shadow_map.h"
#include "core/technique/module.h"

namespace limn::render {

void Renderer::Implementation::dropGraph() {
  if (!graph) return;
  gpuScene.forget();
  inspector.reset();
  graph.reset();
  bumps = nullptr;
  uses.clear();
}

bool Renderer::Implementation::switched() const {
  if (emitting.size() != pose.lights.size()) return true;  // of a frame before the last, which failed
  for (size_t i = 0; i < emitting.size(); ++i)
    if (emitting[i] != emits(i)) return true;
  return false;
}

void Renderer::Implementation::refreshPose() {
  if (!poseDirty) return;
  scene::evaluate(scene, time, animation, pose);
  poseDirty = false;
}

void Renderer::Implementation::rebuildGraph() {
  dropGraph();
  try {
    build();
  } catch (...) {
    dropGraph();
    throw;
  }
}

frame::FrameGraph& Renderer::Implementation::builtGraph() const {
  if (!graph) throw Error("there is no frame yet: render() comes first");
  return *graph;
}

bool Renderer::Implementation::render(frame::Timing timing, const frame::FrameGraph::Cancelled& cancelled) {
  refreshPose();
  bool rebuild = gpuScene.update(pose, camera, settings.size, frameIndex++) || !graph || switched();
  if (!rebuild) {
    rebuild = services.update(*graph, pose);
    for (Use& use : uses)
      rebuild = inTechnique(*use.settings->plugin, [&] { return use.technique->update(pose); }) || rebuild;
  }
  if (rebuild) rebuildGraph();
  if (settings.dynamic) graph->invalidate();
  bool whole = false;
  try {
    whole = graph->execute(timing, cancelled);
  } catch (...) {
    services.givenUp();
    throw;
  }
  if (!whole) services.givenUp();
  begun = begun || whole;
  return whole;
}

Renderer::Renderer(gpu::Device& device, const scene::Scene& scene, std::filesystem::path shaderOverride)
    : implementation_(std::make_unique<Implementation>(device, scene, std::move(shaderOverride))) {}
Renderer::~Renderer() = default;

void Renderer::configure(Settings settings) {
  checkTechniques(settings.techniques, settings.term);
  constexpr int64_t kMostPixels = (1 << 27) - 1;  // OpenGL reads less than 2 GiB at once, here 16 bytes each
  if (int64_t{settings.size.x} * settings.size.y > kMostPixels)
    throw UsageError(fmt::format("a picture of {}x{} pixels is not accepted: at most {} in all can be read",
                                 settings.size.x, settings.size.y, kMostPixels));
  Implementation& self = *implementation_;
  self.dropGraph();
  self.settings = std::move(settings);
  self.frameIndex = 0;
  self.begun = false;
}

void Renderer::setCamera(const scene::CameraPose& camera) {
  implementation_->camera = camera;
}

void Renderer::setTime(double seconds, int animation) {
  implementation_->time = seconds;
  implementation_->animation = animation;
  implementation_->poseDirty = true;
}

bool Renderer::render(frame::Timing timing, const frame::FrameGraph::Cancelled& cancelled) {
  return implementation_->render(timing, cancelled);
}

int Renderer::framesOfPicture() const {
  const Implementation& self = *implementation_;
  return self.begun ? 1 : historyOf(self.settings.term, self.settings.techniques);
}

const gpu::Texture& Renderer::display() const {
  const Implementation& self = *implementation_;
  if (!self.display || !self.graph) throw Error("nothing to display: Settings::display was not set");
  return self.graph->texture(self.display);
}

const TextureInspector* Renderer::inspector() const {
  return implementation_->inspector.get();
}

void Renderer::setInspectionView(const InspectionView& view) {
  implementation_->inspectionView = view;
}

void Renderer::setCompileProgress(frame::FrameGraph::CompileProgress progress) {
  implementation_->compileProgress = std::move(progress);
}

void Renderer::finish() {
  implementation_->device.gl().Finish();
  implementation_->services.waited();
}

const scene::Pose& Renderer::pose() {
  implementation_->refreshPose();
  return implementation_->pose;
}

Image Renderer::read() const {
  const Implementation& self = *implementation_;
  // Reading waits for the frame anyway. Its time ends here, not after its picture was written.
  self.device.gl().Finish();
  implementation_->services.waited();
  const bool channels = self.settings.channels && self.gbuffer.depth;
  const bool background = showsBackground(self.settings.term, static_cast<bool>(self.scene.environment),
                                          self.scene.medium.present());
  return readPicture(self.builtGraph(), self.settings, self.output, channels ? &self.gbuffer : nullptr,
                     background);
}

frame::FrameGraph& Renderer::graph() {
  return implementation_->builtGraph();
}
std::string Renderer::shaderText(const gpu::ProgramDesc& desc, std::string_view file) const {
  return implementation_->shaders.standalone(desc, file);
}
std::vector<frame::PassReport> Renderer::explain() const {
  return implementation_->builtGraph().explain();
}

int64_t Renderer::memoryBytes() const {
  const gpu::Counters& counters = implementation_->device.counters();
  return counters.bufferBytes + counters.textureBytes;
}

FrameStats Renderer::describe() const {
  const Implementation& self = *implementation_;
  const ContextInfo& info = self.device.context().info();
  FrameStats stats;
  stats.renderer = info.renderer;
  stats.backend = limn::name(info.backend);
  stats.software = info.software;
  stats.timer = frame::preferredTiming(self.device);
  stats.dynamic = self.settings.dynamic;
  stats.width = self.settings.size.x;
  stats.height = self.settings.size.y;
  stats.scene = self.scene.file.string();
  stats.technique = namesOf(self.settings.techniques);
  for (const TechniqueUse& use : self.settings.techniques)
    for (const auto& [parameter, value] : use.parameters.printed())
      stats.parameters.emplace_back(fmt::format("{}.{}", use.plugin->info->name, parameter), value);
  return stats;
}

void Renderer::describeShadowMaps(FrameStats& stats) const {
  const auto& maps = implementation_->services.get<shadow::ShadowMapService>();
  for (const shadow::ShadowMapStats& fit : maps.stats())
    stats.shadowMaps.push_back({fit.light, fit.projection, fit.layers, fit.near, fit.far, fit.halfAngle});
  if (!stats.shadowMaps.empty()) stats.uncoveredPixels = maps.uncoveredPixels();
}

Renderer::Reload Renderer::reloadShaders() {
  gpu::ShaderLibrary::ReloadResult result = implementation_->shaders.reload();
  return {result.changed, result.reloaded, std::move(result.errors)};
}

}  // namespace limn::render
