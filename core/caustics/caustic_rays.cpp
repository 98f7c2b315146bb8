#include "core/caustics/caustic_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/caustics/specular_buffers.h"
#include "core/scene/gpu_medium.h"
#include "core/scene/light_textures.h"
#include "core/shadow/light_fit.h"
#include "glsl/blocks.glsl"
#include "glsl/sampling.glsl"

namespace limn::caustics {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int64_t bufferLimit = int64_t{128} << 20;  // bytes of one storage buffer that every device has
constexpr int group = 8;

/// The light as its map of the specular objects sees it: finite lights look at the middle of the objects.
glsl::Light aimed(const glsl::Light& light, const glm::vec3& origin, const scene::Bounds& objects) {
  if (light.info.x == glsl::light_directional) return light;
  glsl::Light eye{};
  const glm::vec3 towards = objects.centre() - origin;
  const float distance = glm::length(towards);
  eye.position = glm::vec4(origin, 1);
  eye.direction = glm::vec4(distance > 0 ? towards / distance : glm::vec3(0, -1, 0), 0);
  // Within the objects' box there are no directions without them: all faces of a cube.
  const glm::vec3 room = 0.02f * (objects.high - objects.low);
  const bool within = glm::all(glm::lessThanEqual(objects.low - room, origin)) &&
                      glm::all(glm::lessThanEqual(origin, objects.high + room));
  eye.info = {glsl::light_rectangle, within ? glsl::light_flag_two_sided : 0u, glsl::no_instance, 0};
  return eye;
}

/// One set of rays and what it is made from.
struct Request {
  std::vector<uint32_t> lights;
  CausticRayDesc desc;
  CausticRays made;
  std::vector<glm::vec2> samples;  ///< as ShadowMapDesc has them
  std::vector<glsl::ShadowView> views;
  std::vector<glm::vec4> layers;  ///< of the pass that traces
  SpecularBuffers buffers;
  gpu::Buffer viewBuffer, layerBuffer;
  frame::BufferHandle importedViews;

  explicit Request(scene::GpuScene& scene) : buffers(scene) {}
};

}  // namespace

struct CausticRayService::Implementation {
  gpu::Device& device;
  scene::GpuScene& scene;
  shadow::ShadowMapService& shadowMaps;
  frame::FrameGraph* graph = nullptr;
  SceneHandles handles = {};
  std::vector<glsl::Light> lights = {};
  std::vector<scene::Bounds> boxes = {};  ///< of the specular instances
  std::vector<std::unique_ptr<Request>> requests = {};

  void take(const scene::Pose& pose) {
    lights = pose.lights;
    boxes.clear();
    for (uint32_t i = 0; i < scene.instanceCount(); ++i)
      if (scene.specular(i) && !scene.bounds(i).empty()) boxes.push_back(scene.bounds(i));
  }
  void fit(Request& request) const;
  void upload(Request& request) const;
  frame::BufferHandle trace(const Request& request);
  CausticRays add(std::unique_ptr<Request> made);
};

/// Views of the specular objects for the current lights and bounds.
void CausticRayService::Implementation::fit(Request& request) const {
  scene::Bounds objects;
  for (const scene::Bounds& box : boxes) objects.add(box);
  request.views.clear();
  request.layers.clear();
  float mapIndex = 0;
  const shadow::ShadowMapDesc samplesDesc{.samples = request.samples};
  for (const uint32_t index : request.lights) {
    const glsl::Light& light = lights[index];
    const std::vector<glm::vec2> points = shadow::samplesOf(light, samplesDesc);
    for (const glm::vec2& point : points) {
      const shadow::ShadowMapDesc desc{.size = request.desc.size, .samples = {point}};
      const glm::vec2 ab = point - 0.5f;
      const glm::vec3 origin = glm::vec3(light.position) + ab.x * light.axis_u.w * glm::vec3(light.axis_u) +
                               ab.y * light.axis_v.w * glm::vec3(light.axis_v);
      const glsl::Light eye = aimed(light, origin, objects);
      std::vector<glsl::ShadowLight> unused;
      shadow::appendViews(eye, index, shadow::fitLayout(eye, boxes, desc), boxes, desc, nullptr,
                          request.views, unused);
      request.layers.resize(request.views.size(), glm::vec4(mapIndex, 2 * objects.radius(), 0, 0));
      ++mapIndex;
    }
    // Lights without extent share one map among all samples.
    mapIndex += static_cast<float>(std::max<size_t>(request.samples.size(), 1) - points.size());
  }
  request.buffers.setViews(request.views);
}

void CausticRayService::Implementation::upload(Request& request) const {
  request.viewBuffer.update(0, request.views.data(), request.views.size() * sizeof(request.views[0]));
  request.layerBuffer.update(0, request.layers.data(), request.layers.size() * sizeof(request.layers[0]));
}

frame::BufferHandle CausticRayService::Implementation::trace(const Request& request) {
  const shadow::ShadowMaps& maps = request.made.scene;
  const SpecularBuffer &front = request.buffers.front(), &back = request.buffers.back();
  frame::PassBuilder pass = graph->addPass("caustic rays", "caustics");
  pass.read(handles.frame, Access::uniformBuffer, "medium")
      .read(handles.lights, Access::storageLoad, "what lights send")
      .read(handles.instances, Access::storageLoad, "materials of instances")
      .read(handles.materials, Access::storageLoad, "index of refraction, colours")
      .read(request.importedViews, Access::storageLoad, "projections")
      .read(request.made.layerLights, Access::storageLoad, "map of each layer")
      .read(maps.depth, Access::sampled, "where rays end")
      .read(maps.views, Access::storageLoad, "projections of the scene")
      .read(maps.lights, Access::storageLoad, "layers of each light");
  for (const TextureHandle texture :
       {front.surface, front.depth, back.surface, back.depth, front.geometricNormal, back.geometricNormal})
    pass.read(texture, Access::sampled, "where light is reflected and refracted");
  const frame::BufferHandle rays =
      pass.write(graph->createBuffer("caustic rays",
                                     {static_cast<size_t>(request.made.count()) * sizeof(glsl::CausticRay)}),
                 Access::storageStore, "light behind specular objects");
  gpu::ProgramDesc source{.files = {"glsl/caustics/trace_rays.comp.glsl"},
                          .defines = {{"PATHS", std::to_string(request.desc.paths)},
                                      {"PATH_COUNT", std::to_string(request.made.paths)}}};
  const scene::MediumInput medium(handles);
  medium.define(source.defines);
  medium.declare(pass);
  const scene::LightTextureInput textures(handles);
  textures.define(source.defines);
  textures.declare(pass);
  const auto program = pass.program(std::move(source));
  pass.execute([=, handles = handles, desc = request.desc, layers = request.made.layers,
                views = request.importedViews,
                indices = request.made.layerLights](frame::PassContext& context) {
    gpu::Program& kernel = context.program(program);
    kernel.use();
    kernel.set("light_samples", desc.lightSamples);
    kernel.set("steps", desc.steps);
    context.bindUniform(glsl::FrameBlock::binding, handles.frame);
    medium.bind(context);
    textures.bind(context);
    unsigned unit = 0;
    for (const TextureHandle texture : {front.surface, front.depth, back.surface, back.depth, maps.depth,
                                        front.geometricNormal, back.geometricNormal})
      context.bindSampled(unit++, texture);
    unsigned binding = 0;
    for (const frame::BufferHandle buffer : {handles.lights, views, indices, handles.instances,
                                             handles.materials, maps.views, maps.lights, rays})
      context.bindStorage(binding++, buffer);
    context.dispatch(desc.size, desc.size, layers, group, group);
  });
  return rays;
}

CausticRays CausticRayService::Implementation::add(std::unique_ptr<Request> made) {
  Request& request = *made;
  fit(request);
  request.made.layers = static_cast<int>(request.views.size());
  request.made.size = request.desc.size;
  request.made.paths = std::popcount(request.desc.paths);
  requests.push_back(std::move(made));
  if (request.views.empty()) return request.made;
  const int64_t bytes = int64_t{request.made.layers} * request.desc.size * request.desc.size *
                        request.made.paths * static_cast<int64_t>(sizeof(glsl::CausticRay));
  if (bytes > bufferLimit || request.made.layers > device.limits().maxArrayLayers)
    throw UsageError(fmt::format(
        "caustic rays of {} layers of {} x {} texels and {} paths take {} MiB, more than the {} MiB of a "
        "storage buffer; ask for a smaller buffer_size, fewer light_samples or fewer lights",
        request.made.layers, request.desc.size, request.desc.size, request.made.paths, bytes >> 20,
        bufferLimit >> 20));
  request.viewBuffer =
      gpu::Buffer::of<glsl::ShadowView>(device, "specular views", request.views, gpu::BufferUse::updated);
  request.layerBuffer =
      gpu::Buffer::of<glm::vec4>(device, "specular layers", request.layers, gpu::BufferUse::updated);
  request.importedViews = graph->importBuffer("specular views", request.viewBuffer);
  request.made.layerLights = graph->importBuffer("specular layers", request.layerBuffer);
  request.made.scene = shadowMaps.request(request.lights, {.size = request.desc.sceneSize,
                                                           .projection = shadow::Projection::cube,
                                                           .samples = request.samples,
                                                           .specular = false});
  request.made.sceneLights =
      static_cast<int>(request.lights.size() * std::max<size_t>(request.samples.size(), 1));
  request.buffers.add(*graph, handles, request.importedViews, request.desc.size, "caustics");
  request.made.rays = trace(request);
  return request.made;
}

CausticRayService::CausticRayService(gpu::Device& device, scene::GpuScene& scene,
                                     shadow::ShadowMapService& shadowMaps)
    : implementation_(new Implementation{device, scene, shadowMaps}) {}
CausticRayService::~CausticRayService() = default;

void CausticRayService::begin(frame::FrameGraph& graph, const SceneHandles& handles,
                              const scene::Pose& pose) {
  implementation_->requests.clear();
  implementation_->graph = &graph;
  implementation_->handles = handles;
  implementation_->take(pose);
}

void CausticRayService::forget() {
  implementation_->graph = nullptr;
}

CausticRays CausticRayService::request(std::span<const uint32_t> lights, const CausticRayDesc& desc) {
  Implementation& s = *implementation_;
  auto made = std::make_unique<Request>(s.scene);
  if (!s.boxes.empty())
    std::ranges::copy_if(lights, std::back_inserter(made->lights), [&](uint32_t light) {
      return (s.lights.at(light).info.y & glsl::light_flag_environment) == 0;
    });
  for (const auto& known : s.requests)
    if (known->desc == desc && known->lights == made->lights) return known->made;
  made->desc = desc;
  for (int i = 0; desc.lightSamples > 1 && i < desc.lightSamples; ++i)
    made->samples.push_back(glsl::r2_sequence(static_cast<uint32_t>(i) + 1));
  return s.add(std::move(made));
}

bool CausticRayService::update(const scene::Pose& pose) {
  Implementation& s = *implementation_;
  const bool some = !s.boxes.empty(), lightsCameOrWent = pose.lights.size() != s.lights.size();
  s.take(pose);
  if (lightsCameOrWent || some == s.boxes.empty()) return true;
  for (const auto& request : s.requests) {
    if (request->views.empty()) continue;
    const std::vector<glsl::ShadowView> views = request->views;
    const std::vector<glm::vec4> layers = request->layers;
    s.fit(*request);
    if (request->views.size() != views.size()) return true;
    const bool same =
        std::memcmp(views.data(), request->views.data(), views.size() * sizeof(views[0])) == 0 &&
        layers == request->layers;
    if (same) continue;
    s.upload(*request);
    if (s.graph == nullptr) continue;
    s.graph->touch(request->importedViews);
    s.graph->touch(request->made.layerLights);
  }
  return false;
}

}  // namespace limn::caustics
