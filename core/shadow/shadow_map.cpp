#include "core/shadow/shadow_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/same_bytes.h"
#include "core/shading/ltc_table.h"
#include "core/shadow/light_fit.h"
#include "core/shadow/private/map_memory.h"
#include "core/shadow/private/map_raster.h"
#include "glsl/numeric/sampling.glsl"

namespace limn::shadow {
namespace {

constexpr int64_t kKeptBytesPerTexel = 8;        // linear depth, and rasterised depth beside it
constexpr int64_t kReflectiveBytesPerTexel = 8;  // normal, and albedo or instance, on top
constexpr int64_t kKeptLimit = int64_t{256}
                               << 20;  // bytes of all maps that are kept; what is derived comes on top

std::string_view projectionName(const LightLayout& layout) {
  if (layout.projection == glsl::shadow_orthographic) return "orthographic";
  if (layout.faces == glsl::shadow_faces_cube) return "cube";
  return layout.faces == glsl::shadow_faces_hemicube ? "hemicube" : "perspective";
}

/// What --stats says about a light with such views, of those that show something the first.
ShadowMapStats shownBy(std::span<const glsl::ShadowView> views, ShadowMapStats light) {
  const auto shown = std::ranges::find_if_not(views, showsNothing);
  if (shown == views.end()) return light;
  light.near = shown->near;
  light.far = shown->far;
  if (shown->projection == glsl::shadow_perspective) light.halfAngle = std::atan(0.5f / shown->scale);
  return light;
}

/// What a description asks of maps of lights that are not cut.
ShadowMapDesc ofWholeLights(ShadowMapDesc desc) {
  desc.views = 1;
  if (desc.fit == MapFit::scene) desc.lightSize = -1;
  return desc;
}

/// Whether what the camera sees changes maps with MapFit::view and such a layout.
bool followsView(const LightLayout& layout, const ShadowMapDesc& desc) {
  return layout.faces == glsl::shadow_faces_single ||
         (!desc.samples.empty() && glsl::shadow_face_count(layout.faces) > 2);
}

/// One set of maps and what draws it.
struct Request {
  std::vector<uint32_t> lights;
  std::vector<glm::vec3> directions;  ///< of parallel light, instead of lights
  ShadowMapDesc desc;
  ShadowMaps maps;
  bool kept = false;
  std::vector<LightLayout> layouts;
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> shadowLights;
  std::vector<scene::DepthView> depthViews;
  gpu::Buffer viewBuffer, lightBuffer;
  frame::BufferHandle importedViews, importedLights;
  scene::DrawList drawList;

  /// Whether a light has parts.
  bool cuts() const {
    return std::ranges::any_of(layouts, [](const LightLayout& layout) { return layout.parts() > 1; });
  }
  /// Entries of `shadowLights` for each light.
  size_t stride() const {
    size_t most = std::max<size_t>(desc.samples.size(), 1);
    for (const LightLayout& layout : layouts) most = std::max<size_t>(most, layout.parts());
    return most;
  }
};

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
        derived(onDevice),
        trilinear(onDevice, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR),
        uncovered(onDevice, "uncovered pixels", sizeof(uint32_t)) {}

  gpu::Device& device;
  scene::GpuScene& scene;
  std::vector<glsl::Light> lights;
  std::vector<std::string> lightNames;
  std::vector<scene::Bounds> boxes;
  std::unique_ptr<VisibleScene> visible = {};  ///< made at the first request that is fitted to it
  bool watching = false;                       ///< some request of the graph is
  bool fitted = false;                         ///< the maps are fitted to what was taken
  std::vector<std::unique_ptr<Request>> requests;
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
  /// Lights and bounds of `pose`. True if they changed.
  bool take(const scene::Pose& pose) {
    bool changed = !sameBytes(lights, pose.lights) || lightNames != pose.lightNames ||
                   boxes.size() != scene.instanceCount();
    if (changed) {
      lights = pose.lights;
      lightNames = pose.lightNames;
      boxes.resize(scene.instanceCount());
    }
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i] == scene.bounds(i)) continue;
      boxes[i] = scene.bounds(i);
      changed = true;
    }
    return changed;
  }
  /// What the camera sees of `pose`, which the bounds belong to. True if it changed.
  bool see(const scene::Pose& pose) {
    if (!visible) visible = std::make_unique<VisibleScene>(scene.scene());
    const glm::vec2 size(scene.frame().frame_size);
    return visible->update(pose, boxes, scene.camera(), size.x / size.y);
  }
  const glsl::Light& light(uint32_t index) const {
    if (index >= lights.size())
      throw UsageError(fmt::format("shadow map of light {}: the scene has {} lights", index, lights.size()));
    return lights[index];
  }
  std::vector<scene::Bounds> boxesFor(const glsl::Light& light) const {
    std::vector<scene::Bounds> result = boxes;
    if (light.own_instance < result.size())
      result[light.own_instance] = {};  // its own quad is not in its map
    return result;
  }
  size_t countOf(const Request& request) const {
    return request.directions.empty() ? request.lights.size() : request.directions.size();
  }
  /// The i-th light of a request.
  glsl::Light lightOf(const Request& request, size_t i) const {
    if (request.directions.empty()) return light(request.lights[i]);
    glsl::Light parallel{};
    parallel.direction = request.directions[i];
    parallel.type = glsl::light_directional;
    parallel.own_instance = glsl::no_instance;
    return parallel;
  }
  int layersOf(const glsl::Light& ofLight, const LightLayout& layout, const ShadowMapDesc& desc) const {
    return static_cast<int>(glsl::shadow_face_count(layout.faces) * layout.parts() *
                            samplesOf(ofLight, desc).size());
  }
  /// Lights that choose the number of their parts are cut as long as all maps of the request can be kept.
  std::vector<LightLayout> layoutsOf(const Request& request) const {
    std::vector<LightLayout> layouts;
    int64_t layers = 0;
    for (size_t i = 0; i < countOf(request); ++i) {
      const glsl::Light l = lightOf(request, i);
      const std::vector<scene::Bounds> around = boxesFor(l);
      layouts.push_back(fitLayout(l, around, request.desc));
      layers += layersOf(l, layouts.back(), request.desc);
      const int64_t bytes = layers * request.desc.size * request.desc.size * bytesPerTexel(request.desc);
      if (request.desc.views != 0 || layouts.back().parts() == 1 || bytes <= kKeptLimit) continue;
      layers -= layersOf(l, layouts.back(), request.desc);
      ShadowMapDesc whole = request.desc;
      whole.views = 1;
      layouts.back() = fitLayout(l, around, whole);
      layers += layersOf(l, layouts.back(), whole);
    }
    return layouts;
  }
  bool cacheable(const ShadowMaps& maps) const { return requests.at(maps.index)->kept; }
  static int64_t bytesPerTexel(const ShadowMapDesc& desc) {
    return kKeptBytesPerTexel + (desc.reflective ? kReflectiveBytesPerTexel : 0);
  }
  int64_t bytesOf(const Request& request) const {
    return int64_t{request.maps.size} * request.maps.size * request.maps.layers * bytesPerTexel(request.desc);
  }
  int64_t keptBytes() const {
    int64_t bytes = 0;
    for (const auto& request : requests)
      if (request->kept) bytes += bytesOf(*request);
    return bytes;
  }
  /// Adds a request of known lights and layouts.
  ShadowMaps add(std::unique_ptr<Request> made, const FrameContext& context);
  bool fit(Request& request) const;
  void check(const Request& request, size_t layers) const;
  void addPasses(Request& request, const FrameContext& context);
};

/// Recomputes views for the current lights and bounds. True if they changed.
bool ShadowMapService::Implementation::fit(Request& request) const {
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> shadowLights;
  for (size_t i = 0; i < countOf(request); ++i) {
    const glsl::Light l = lightOf(request, i);
    appendViews(l, request.directions.empty() ? request.lights[i] : glsl::no_light, request.layouts[i],
                boxesFor(l), request.desc, visible.get(), views, shadowLights);
    shadowLights.resize((i + 1) * request.stride(), shadowLights.back());
  }
  request.depthViews.clear();
  for (const glsl::ShadowView& view : views) {
    const bool punctual = view.light != glsl::no_light && !glsl::light_has_extent(lights[view.light]);
    if (punctual && !request.desc.punctual) continue;
    request.depthViews.push_back(
        {.volume = cullVolume(view),
         .skipInstance = view.light == glsl::no_light ? glsl::no_instance : lights[view.light].own_instance,
         .view = view.layer,
         .layer = static_cast<int>(view.layer),
         .surfaces = request.desc.specular ? scene::Surfaces::all : scene::Surfaces::matte});
  }
  const bool changed = !sameBytes(views, request.views) || !sameBytes(shadowLights, request.shadowLights);
  request.views = std::move(views);
  request.shadowLights = std::move(shadowLights);
  return changed;
}

void ShadowMapService::Implementation::check(const Request& request, size_t layers) const {
  const int size = request.desc.size, largest = device.limits().maxTextureSize;
  if (size < 1 || size > largest)
    throw UsageError(fmt::format("shadow map of {} texels: the size must be from 1 to {}", size, largest));
  const auto most = static_cast<size_t>(device.limits().maxArrayLayers);
  if (layers > most)
    throw UsageError(
        fmt::format("shadow maps in {} layers: the device has at most {} in one array", layers, most));
  const int64_t bytes = int64_t{size} * size * bytesPerTexel(request.desc) * static_cast<int64_t>(layers);
  if (bytes > kMemoryLimit)
    throw UsageError(
        fmt::format("shadow maps of {} layers of {} x {} texels take {} MiB, more than the {} MiB that one "
                    "request may; ask for smaller maps or fewer lights at once",
                    layers, size, size, bytes >> 20, kMemoryLimit >> 20));
}

void ShadowMapService::Implementation::addPasses(Request& request, const FrameContext& context) {
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
  s.take(context().pose);
  s.watching = false;
  s.fitted = true;  // requests are, as they are made
}

ShadowMaps ShadowMapService::request(std::span<const uint32_t> lights, const ShadowMapDesc& desc) {
  Implementation& s = *implementation_;
  auto made = std::make_unique<Request>();
  made->lights.assign(lights.begin(), lights.end());
  made->desc = desc;
  made->layouts = s.layoutsOf(*made);
  if (desc.fit == MapFit::view &&
      std::ranges::none_of(made->layouts, [&](const LightLayout& l) { return followsView(l, desc); })) {
    made->desc.fit = MapFit::scene;  // until a layout changes: then the graph is built again
    made->layouts = s.layoutsOf(*made);
  }
  for (const auto& known : s.requests) {
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
  auto made = std::make_unique<Request>();
  made->directions.assign(directions.begin(), directions.end());
  made->desc = desc;
  made->desc.samples.clear();
  made->desc.views = 1;
  for (const auto& known : s.requests) {
    if (!made->desc.cacheable) break;
    if (known->desc == made->desc && !directions.empty() && std::ranges::equal(known->directions, directions))
      return known->maps;
  }
  made->layouts = s.layoutsOf(*made);
  return s.add(std::move(made), context());
}

ShadowMaps ShadowMapService::Implementation::add(std::unique_ptr<Request> made, const FrameContext& context) {
  size_t layers = 0;
  for (size_t i = 0; i < countOf(*made); ++i)
    layers += static_cast<size_t>(layersOf(lightOf(*made, i), made->layouts[i], made->desc));
  check(*made, layers);
  if (made->desc.fit == MapFit::view && !watching) {
    watching = true;
    see(context.pose);
  }
  fit(*made);
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
  made->kept = made->desc.cacheable && (before == 0 || before + bytesOf(*made) <= kKeptLimit);
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
  const bool lightsCameOrWent = pose.lights.size() != s.lights.size();
  if (s.take(pose)) s.fitted = false;
  if (s.watching && s.see(pose)) s.fitted = false;
  if (s.fitted) return false;
  if (lightsCameOrWent) return true;
  for (const auto& request : s.requests) {
    if (s.layoutsOf(*request) != request->layouts) return true;
    const bool changed = s.fit(*request);
    // Lights with extent have a map for each sample, others one for all, in the same layout.
    if (request->views.size() != static_cast<size_t>(request->maps.layers)) return true;
    if (!changed) continue;
    request->viewBuffer.update(0, request->views.data(), request->views.size() * sizeof(request->views[0]));
    request->lightBuffer.update(0, request->shadowLights.data(),
                                request->shadowLights.size() * sizeof(request->shadowLights[0]));
    graph.touch(request->importedViews);
    graph.touch(request->importedLights);
  }
  s.fitted = true;
  return false;
}

int ShadowMapService::layersOf(uint32_t light, const ShadowMapDesc& desc) const {
  const Implementation& s = *implementation_;
  const glsl::Light& l = s.light(light);
  return s.layersOf(l, fitLayout(l, s.boxesFor(l), desc), desc);
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
  for (const auto& request : implementation_->requests) {
    if (!request->directions.empty() && !request->views.empty())
      all.push_back(
          shownBy(request->views,
                  {.light = "parallel light", .projection = "orthographic", .layers = request->maps.layers}));
    const size_t stride = request->stride();
    for (size_t i = 0; i < request->lights.size(); ++i) {
      const LightLayout& layout = request->layouts[i];
      const uint32_t first = request->shadowLights[i * stride].first_layer;
      const std::span<const glsl::ShadowView> faces =
          std::span(request->views).subspan(first, glsl::shadow_face_count(layout.faces));
      all.push_back(shownBy(faces, {.light = implementation_->lightNames[request->lights[i]],
                                    .projection = std::string(projectionName(layout)),
                                    .layers = implementation_->layersOf(
                                        implementation_->light(request->lights[i]), layout, request->desc)}));
    }
  }
  return all;
}

}  // namespace limn::shadow
