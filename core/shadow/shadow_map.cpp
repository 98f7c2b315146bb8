#include "core/shadow/shadow_map.h"

#include <algorithm>

#include "core/shading/ltc_table.h"
#include "core/shadow/light_fit.h"
#include "core/shadow/private/lit_scene.h"
#include "core/shadow/private/map_memory.h"
#include "core/shadow/private/map_raster.h"
#include "core/shadow/private/map_request.h"
#include "glsl/numeric/sampling.glsl"

namespace limn::shadow {
namespace {

/// What a description asks of maps of lights that are not cut.
ShadowMapDesc ofWholeLights(ShadowMapDesc desc) {
  desc.views = 1;
  if (desc.fit == MapFit::scene) desc.lightSize = -1;
  return desc;
}

struct KnownFourierMaps {
  frame::TextureHandle source;
  FourierDesc desc;
  FourierMaps maps;
};

}  // namespace

std::vector<glm::vec2> pointsOnLights(int count) {
  std::vector<glm::vec2> points;
  for (int i = 0; count > 1 && i < count; ++i)
    points.push_back(glsl::r2_point(static_cast<uint32_t>(i), static_cast<uint32_t>(count)));
  return points;
}

struct ShadowMapService::Implementation {
  Implementation(gpu::Device& onDevice, scene::GpuScene& ofScene)
      : device(onDevice),
        scene(ofScene),
        lit(ofScene),
        derived(onDevice),
        trilinear(onDevice, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR),
        uncovered(onDevice, "uncovered pixels", sizeof(uint32_t)) {}

  gpu::Device& device;
  scene::GpuScene& scene;
  LitScene lit;
  bool watching = false;  ///< some request of the graph is fitted to what the camera sees
  bool moved = false;     ///< lights or bounds have changed since the maps were fitted to them
  bool turned = false;    ///< and so has what the camera sees
  std::vector<std::unique_ptr<MapRequest>> requests;
  DerivedMaps derived;
  std::vector<KnownFourierMaps> fourier = {};
  gpu::Sampler trilinear;
  gpu::Buffer uncovered;
  frame::BufferHandle uncoveredHandle = {};
  gpu::Texture ltcTable = {};  ///< what diffuse albedos depend on; uploaded when reflective maps need it
  frame::TextureHandle ltcHandle = {};

  bool lambertian() const {
    return std::ranges::all_of(scene.scene().materials, &scene::Material::lambertian);
  }
  bool cacheable(const ShadowMaps& maps) const { return requests.at(maps.index)->kept; }
  int64_t keptBytes() const {
    int64_t bytes = 0;
    for (const auto& request : requests)
      if (request->kept) bytes += request->bytes();
    return bytes;
  }
  /// Adds a request of known lights and layouts.
  ShadowMaps add(std::unique_ptr<MapRequest> made, const FrameContext& context);
  void addPasses(MapRequest& request, const FrameContext& context);
};

void ShadowMapService::Implementation::addPasses(MapRequest& request, const FrameContext& context) {
  frame::FrameGraph& graph = context.graph;
  ShadowMaps& maps = request.maps;
  request.importedViews = maps.views = graph.importBuffer("shadow views", request.viewBuffer);
  request.importedLights = maps.lights = graph.importBuffer("shadow lights", request.lightBuffer);
  const MapRaster raster{graph,       device, scene, context.handles, request.depthViews, request.drawList,
                         request.kept};
  if (request.desc.reflective) {
    const bool specular = !request.desc.instances && !lambertian();
    if (specular && !ltcHandle) {
      if (!ltcTable) ltcTable = shading::makeLtcTexture(device);
      ltcHandle = graph.importTexture("table of diffuse reflectance", ltcTable);
    }
    addReflectivePass(raster, specular ? ltcHandle : frame::TextureHandle{}, request.desc.instances, maps);
  } else {
    addDepthPass(raster, maps);
  }
}

ShadowMapService::ShadowMapService(gpu::Device& device, scene::GpuScene& scene)
    : implementation_(std::make_unique<Implementation>(device, scene)) {}
ShadowMapService::~ShadowMapService() = default;

void ShadowMapService::begin() {
  Implementation& s = *implementation_;
  s.requests.clear();
  s.derived.clear();
  s.fourier.clear();
  s.ltcHandle = {};
  s.uncovered.clear();
  s.uncoveredHandle = {};
  s.lit.take(context().pose);
  s.watching = false;
  s.moved = s.turned = false;  // requests are fitted as they are made
}

ShadowMaps ShadowMapService::request(std::span<const uint32_t> lights, const ShadowMapDesc& desc) {
  Implementation& s = *implementation_;
  auto made = std::make_unique<MapRequest>();
  made->lights.assign(lights.begin(), lights.end());
  made->desc = desc;
  made->layouts = made->layoutsIn(s.lit);
  // Maps of the scene do as well, until a layout changes: then the graph is built again.
  if (!made->followsView() && !made->hasRange(s.lit)) made->desc.fit = MapFit::scene;
  for (const auto& known : s.requests) {
    if (!made->desc.cacheable) break;
    if (!known->directions.empty() || !std::ranges::equal(known->lights, lights)) continue;
    if (known->desc == made->desc) return known->maps;
    if (made->cuts() || known->cuts() || ofWholeLights(known->desc) != ofWholeLights(made->desc)) continue;
    if (desc.views == 0)
      known->desc = made->desc;  // update() has the graph built again once a light is to be cut
    return known->maps;
  }
  return s.add(std::move(made), context());
}

ShadowMaps ShadowMapService::request(std::span<const glm::vec3> directions, const ShadowMapDesc& desc) {
  Implementation& s = *implementation_;
  auto made = std::make_unique<MapRequest>();
  made->directions.assign(directions.begin(), directions.end());
  made->desc = desc;
  made->desc.samples.clear();
  made->desc.views = 1;
  for (const auto& known : s.requests) {
    if (!made->desc.cacheable) break;
    if (known->desc == made->desc && !directions.empty() && std::ranges::equal(known->directions, directions))
      return known->maps;
  }
  made->layouts = made->layoutsIn(s.lit);
  return s.add(std::move(made), context());
}

ShadowMaps ShadowMapService::Implementation::add(std::unique_ptr<MapRequest> made,
                                                 const FrameContext& context) {
  made->check(lit, device);
  if (made->followsView() && !watching) {
    watching = true;
    lit.see(context.pose);
  }
  made->fit(lit);
  made->viewBuffer =
      gpu::Buffer::of<glsl::ShadowView>(device, "shadow views", made->views, gpu::BufferUse::updated);
  made->lightBuffer = gpu::Buffer::of<glsl::ShadowLight>(device, "shadow lights", made->shadowLights,
                                                         gpu::BufferUse::updated);
  made->maps.layers = static_cast<int>(made->views.size());
  made->maps.lightSamples = static_cast<int>(made->shadowLights.size());
  made->maps.stride = static_cast<int>(made->stride());
  made->maps.size = made->desc.size;
  made->maps.index = static_cast<uint32_t>(requests.size());
  const int64_t before = keptBytes();
  made->kept = made->desc.cacheable && (before == 0 || before + made->bytes() <= kKeptLimit);
  addPasses(*made, context);
  requests.push_back(std::move(made));
  return requests.back()->maps;
}

std::span<const LightLayout> ShadowMapService::layouts(const ShadowMaps& maps) const {
  return implementation_->requests.at(maps.index)->layouts;
}

MinMaxPyramid ShadowMapService::minMaxPyramid(const ShadowMaps& maps, int boxSide) {
  return implementation_->derived.minMaxPyramid(context().graph, maps.depth, implementation_->cacheable(maps),
                                                boxSide);
}

frame::TextureHandle ShadowMapService::minMaxWindows(const ShadowMaps& maps) {
  return implementation_->derived.minMaxWindows(context().graph, maps.depth,
                                                implementation_->cacheable(maps));
}

frame::TextureHandle ShadowMapService::nBuffer(const ShadowMaps& maps) {
  return implementation_->derived.nBuffer(context().graph, maps.depth, implementation_->cacheable(maps));
}

SummedAreaTable ShadowMapService::summedAreaTable(const ShadowMaps& maps, const SatDesc& desc) {
  return implementation_->derived.summedAreaTable(context().graph, maps.depth,
                                                  implementation_->cacheable(maps), desc);
}

MomentTable ShadowMapService::momentTable(const ShadowMaps& maps, int bits) {
  return implementation_->derived.momentTable(context().graph, maps.depth, implementation_->cacheable(maps),
                                              bits);
}

FourierMaps ShadowMapService::fourierMaps(const ShadowMaps& maps, const FourierDesc& desc) {
  Implementation& s = *implementation_;
  for (const KnownFourierMaps& known : s.fourier) {
    if (known.source == maps.depth && known.desc == desc) return known.maps;
  }
  FourierMaps built =
      addFourierMaps(context().graph, s.device, maps.depth, minMaxPyramid(maps), s.cacheable(maps), desc);
  if (desc.filter == FourierFilter::mip) built.trilinear = &s.trilinear;
  s.fourier.push_back({maps.depth, desc, built});
  return built;
}

bool ShadowMapService::update(frame::FrameGraph& graph, const scene::Pose& pose) {
  Implementation& s = *implementation_;
  const bool lightsCameOrWent = pose.lights.size() != s.lit.lightCount();
  if (s.lit.take(pose)) s.moved = true;
  if (s.watching && s.lit.see(pose)) s.turned = true;
  if (!s.moved && !s.turned) return false;
  if (lightsCameOrWent) return true;
  for (const auto& request : s.requests) {
    if (!s.moved && !request->followsView()) continue;
    if (request->layoutsIn(s.lit) != request->layouts) return true;
    const bool changed = request->fit(s.lit);
    // Lights with extent have a map for each sample, others one for all, in the same layout.
    if (request->views.size() != static_cast<size_t>(request->maps.layers)) return true;
    if (!changed) continue;
    request->viewBuffer.update(0, request->views.data(), request->views.size() * sizeof(request->views[0]));
    request->lightBuffer.update(0, request->shadowLights.data(),
                                request->shadowLights.size() * sizeof(request->shadowLights[0]));
    graph.touch(request->importedViews);
    graph.touch(request->importedLights);
  }
  s.moved = s.turned = false;
  return false;
}

int ShadowMapService::layersOf(uint32_t light, const ShadowMapDesc& desc) const {
  const Implementation& s = *implementation_;
  const glsl::Light& l = s.lit.light(light);
  std::vector<scene::Bounds> others;
  return shadow::layersOf(l, fitLayout(l, s.lit.boxesFor(l, others), desc), desc);
}

frame::BufferHandle& ShadowMapService::uncoveredCounter() {
  Implementation& s = *implementation_;
  if (s.uncoveredHandle) return s.uncoveredHandle;
  frame::FrameGraph& graph = context().graph;
  const frame::BufferHandle imported = graph.importBuffer("uncovered pixels", s.uncovered);
  frame::PassBuilder pass = graph.addPass("clear uncovered pixels");
  s.uncoveredHandle = pass.write(imported, frame::Access::copyTarget, "none so far");
  pass.execute([counter = s.uncoveredHandle](frame::PassContext& context) {
    constexpr GLuint none = 0;
    context.gl().ClearNamedBufferData(context.buffer(counter).id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                                      &none);
  });
  return s.uncoveredHandle;
}

uint32_t ShadowMapService::uncoveredPixels() const {
  uint32_t count = 0;
  implementation_->uncovered.read(0, &count, sizeof(count));
  return count;
}

std::vector<ShadowMapStats> ShadowMapService::stats() const {
  std::vector<ShadowMapStats> all;
  for (const auto& request : implementation_->requests) request->report(implementation_->lit, all);
  return all;
}

}  // namespace limn::shadow
