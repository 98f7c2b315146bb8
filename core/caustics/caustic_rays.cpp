#include "core/caustics/caustic_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/same_bytes.h"
#include "core/caustics/private/light_reach.h"
#include "core/caustics/ray_lists.h"
#include "core/caustics/specular_buffers.h"
#include "core/gpu_scene/light_textures.h"
#include "core/shadow/light_fit.h"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/numeric/sampling.glsl"
#include "glsl/scene/blocks.glsl"

namespace limn::caustics {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr int kGroupSide = 8;

/// The light as its map of the specular objects sees it: finite lights look at the middle of the objects.
glsl::Light aimed(const glsl::Light& light, const glm::vec3& origin, const scene::Bounds& objects) {
  if (light.type == glsl::light_directional) return light;
  glsl::Light eye{};
  const glm::vec3 towards = objects.centre() - origin;
  const float distance = glm::length(towards);
  eye.position = origin;
  eye.direction = distance > 0 ? towards / distance : glm::vec3(0, -1, 0);
  // Where the box, with a little room, reaches behind the eye, all faces of a cube: those of a half one end
  // 45 degrees behind it. Within the box there are no directions without it.
  const bool behind = distance <= glm::dot(0.52f * (objects.high - objects.low), glm::abs(eye.direction));
  eye.type = glsl::light_rectangle;
  eye.flags = behind ? glsl::light_flag_two_sided : 0u;
  eye.own_instance = glsl::no_instance;
  return eye;
}

/// One set of rays and what it is made from.
struct Request {
  std::vector<uint32_t> asked;   ///< lights that do not stand for the environment
  std::vector<uint32_t> lights;  ///< those of them that have rays
  CausticRayDesc desc;
  CausticRays made;
  std::vector<glm::vec2> samples;  ///< as ShadowMapDesc has them
  std::vector<glsl::ShadowView> views, lastViews;
  std::vector<glsl::CausticLayer> layers, lastLayers;  ///< of the pass that traces
  SpecularBuffers buffers;
  gpu::Buffer viewBuffer, layerBuffer;
  frame::BufferHandle importedViews;

  explicit Request(scene::GpuScene& scene) : buffers(scene) {}
};

}  // namespace

struct CausticRayService::Implementation {
  gpu::Device& device;
  scene::GpuScene& scene;
  std::vector<glsl::Light> lights = {};
  std::vector<scene::Bounds> boxes = {};  ///< of the specular instances
  std::vector<std::unique_ptr<Request>> requests = {};

  /// Lights and boxes of `pose`, all that views depend on. True if they changed.
  bool take(const scene::Pose& pose) {
    bool changed = !sameBytes(lights, pose.lights);
    if (changed) lights = pose.lights;
    size_t count = 0;
    for (uint32_t i = 0; i < scene.instanceCount(); ++i) {
      const scene::Bounds& box = scene.bounds(i);
      if (!scene.specular(i) || box.empty()) continue;
      if (count == boxes.size()) boxes.emplace_back();
      changed = changed || boxes[count] != box;
      boxes[count++] = box;
    }
    changed = changed || boxes.size() != count;
    boxes.resize(count);
    return changed;
  }
  /// Whether a light may reach a specular object.
  bool reaches(uint32_t light) const { return mayReach(lights.at(light), boxes); }
  /// Whether a light without rays needs some. One that no longer does keeps them while the graph lives, so
  /// that a light that comes and goes does not have it built again each time.
  bool lacksLights(const Request& request) const {
    return std::ranges::any_of(request.asked, [&](uint32_t light) {
      return std::ranges::find(request.lights, light) == request.lights.end() && reaches(light);
    });
  }
  void fit(Request& request) const;
  void upload(Request& request) const;
  static frame::BufferHandle trace(const Request& request, const FrameContext& building);
  CausticRays add(std::unique_ptr<Request> made, const FrameContext& context);
};

/// Views of the specular objects for the current lights and bounds.
void CausticRayService::Implementation::fit(Request& request) const {
  const scene::Bounds objects = scene.specularBounds();
  const float diameter = request.buffers.widest();
  request.views.clear();
  request.layers.clear();
  float mapIndex = 0;
  const shadow::ShadowMapDesc samplesDesc{.samples = request.samples};
  shadow::ShadowMapDesc desc{.size = request.desc.size, .samples = {glm::vec2(0)}};
  std::vector<glsl::ShadowLight> ofPoint;
  for (const uint32_t index : request.lights) {
    const glsl::Light& light = lights[index];
    const std::vector<glm::vec2> points = shadow::samplesOf(light, samplesDesc);
    for (const glm::vec2& point : points) {
      desc.samples[0] = point;
      const glm::vec3 origin = glsl::rectangle_point(light, point - 0.5f);
      const glsl::Light eye = aimed(light, origin, objects);
      ofPoint.clear();
      shadow::appendViews(eye, index, shadow::fitLayout(eye, boxes, desc), boxes, desc, nullptr,
                          request.views, ofPoint);
      request.layers.resize(request.views.size(), glsl::CausticLayer{.light = mapIndex,
                                                                     .diameter = diameter,
                                                                     .first = ofPoint[0].first_layer,
                                                                     .faces = ofPoint[0].faces});
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

frame::BufferHandle CausticRayService::Implementation::trace(const Request& request,
                                                             const FrameContext& building) {
  frame::FrameGraph& graph = building.graph;
  const SceneHandles& handles = building.handles;
  const shadow::ShadowMaps& maps = request.made.scene;
  const SpecularBuffer &front = request.buffers.front(), &back = request.buffers.back();
  frame::PassBuilder pass = graph.addPass("caustic rays", "caustics");
  pass.read(handles.medium, Access::uniformBuffer, "FrameBlock", "medium, and where the scene ends")
      .read(handles.lights, Access::storageLoad, "Lights", "what lights send")
      .read(handles.instances, Access::storageLoad, "Instances", "materials of instances")
      .read(handles.materials, Access::storageLoad, "Materials", "index of refraction, colours")
      .read(request.importedViews, Access::storageLoad, "Views", "projections")
      .read(request.made.layerLights, Access::storageLoad, "Layers", "map of each layer")
      .read(maps.depth, Access::sampled, "scene_depth", "where rays end")
      .read(maps.views, Access::storageLoad, "SceneViews", "projections of the scene")
      .read(maps.lights, Access::storageLoad, "SceneLights", "layers of each light")
      .cacheable();
  const std::pair<const char*, TextureHandle> specular[] = {{"front_surface", front.surface},
                                                            {"front_depth", front.depth},
                                                            {"back_surface", back.surface},
                                                            {"back_depth", back.depth},
                                                            {"front_geometric_normal", front.geometricNormal},
                                                            {"back_geometric_normal", back.geometricNormal}};
  for (const auto& [name, texture] : specular)
    if (texture) pass.read(texture, Access::sampled, name, "where light is reflected and refracted");
  const frame::BufferHandle rays =
      pass.write(graph.createBuffer("caustic rays",
                                    {static_cast<size_t>(request.made.count()) * sizeof(glsl::CausticRay)}),
                 Access::storageStore, "Rays", "light behind specular objects");
  gpu::ProgramDesc source{.files = {"glsl/caustics/trace_rays.comp.glsl"},
                          .defines = {{"PATHS", std::to_string(request.desc.paths)},
                                      {"PATH_COUNT", std::to_string(request.made.paths)},
                                      {"OBJECT_FACES", request.made.pointLayers > 1 ? "1" : "0"},
                                      {"EXIT_STEPS", std::to_string(request.desc.exitSteps)}}};
  const scene::MediumInput medium(handles, request.desc.mediumSteps);
  medium.define(source.defines);
  medium.declare(pass);
  const scene::LightTextureInput textures(handles);
  textures.define(source.defines);
  textures.declare(pass);
  const auto program = pass.program(std::move(source));
  pass.execute([program, desc = request.desc, layers = request.made.layers](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    kernel.set("light_samples", desc.lightSamples);
    kernel.set("steps", desc.steps);
    context.dispatch(desc.size, desc.size, layers, kGroupSide, kGroupSide);
  });
  return rays;
}

CausticRays CausticRayService::Implementation::add(std::unique_ptr<Request> made,
                                                   const FrameContext& context) {
  Request& request = *made;
  fit(request);
  request.made.layers = static_cast<int>(request.views.size());
  request.made.size = request.desc.size;
  request.made.paths = std::popcount(request.desc.paths);
  // Whether one point has several views does not change while the number of views stays.
  const bool several = std::ranges::any_of(request.layers, [](const glsl::CausticLayer& layer) {
    return layer.faces != glsl::shadow_faces_single;
  });
  request.made.pointLayers = several ? static_cast<int>(glsl::shadow_face_count(glsl::shadow_faces_cube)) : 1;
  requests.push_back(std::move(made));
  if (request.views.empty()) return request.made;
  if (request.made.layers > device.limits().maxArrayLayers)
    throw UsageError(
        fmt::format("caustic rays in {} layers: the device has at most {} in one array; ask for fewer "
                    "light_samples or fewer lights",
                    request.made.layers, device.limits().maxArrayLayers));
  const int64_t bytes = int64_t{request.made.layers} * request.desc.size * request.desc.size *
                        request.made.paths * static_cast<int64_t>(sizeof(glsl::CausticRay));
  // Passes bind the rays as one block, and list them in one dispatch.
  const int64_t most = std::min(device.limits().maxStorageBlockBytes,
                                kMostListedRays * static_cast<int64_t>(sizeof(glsl::CausticRay)));
  if (bytes > most)
    throw UsageError(fmt::format(
        "caustic rays of {} layers of {} x {} texels and {} paths take {} MiB, more than the {} MiB of a "
        "storage buffer; ask for a smaller buffer_size, fewer light_samples or fewer lights",
        request.made.layers, request.desc.size, request.desc.size, request.made.paths, bytes >> 20,
        most >> 20));
  request.viewBuffer =
      gpu::Buffer::of<glsl::ShadowView>(device, "specular views", request.views, gpu::BufferUse::updated);
  request.layerBuffer =
      gpu::Buffer::of<glsl::CausticLayer>(device, "specular layers", request.layers, gpu::BufferUse::updated);
  request.importedViews = context.graph.importBuffer("specular views", request.viewBuffer);
  request.made.layerLights = context.graph.importBuffer("specular layers", request.layerBuffer);
  request.made.scene = context.services.get<shadow::ShadowMapService>().request(
      request.lights, {.size = request.desc.sceneSize,
                       .projection = shadow::Projection::cube,
                       .samples = request.samples,
                       .specular = false});
  request.made.sceneLights =
      static_cast<int>(request.lights.size() * std::max<size_t>(request.samples.size(), 1));
  const bool refracts = (request.desc.paths & glsl::caustic_refraction) != 0;
  request.buffers.add(context.graph, context.handles, request.importedViews, request.desc.size,
                      refracts ? GeometricNormals::both : GeometricNormals::front, "caustics");
  request.made.rays = trace(request, context);
  return request.made;
}

CausticRayService::CausticRayService(gpu::Device& device, scene::GpuScene& scene)
    : implementation_(new Implementation{device, scene}) {}
CausticRayService::~CausticRayService() = default;

void CausticRayService::begin() {
  implementation_->requests.clear();
  implementation_->take(context().pose);
}

CausticRays CausticRayService::request(std::span<const uint32_t> lights, const CausticRayDesc& desc) {
  Implementation& s = *implementation_;
  auto made = std::make_unique<Request>(s.scene);
  if (!s.boxes.empty())
    std::ranges::copy_if(lights, std::back_inserter(made->asked), [&](uint32_t light) {
      return (s.lights.at(light).flags & glsl::light_flag_environment) == 0;
    });
  for (const auto& known : s.requests)
    if (known->desc == desc && known->asked == made->asked) return known->made;
  for (const uint32_t light : made->asked) {
    if (s.reaches(light))
      made->lights.push_back(light);
    else
      context().graph.leaveOut(fmt::format("rays of light {}", context().pose.lightNames.at(light)),
                               "caustics", "it reaches no specular surface");
  }
  made->desc = desc;
  made->samples = shadow::pointsOnLights(desc.lightSamples);
  return s.add(std::move(made), context());
}

bool CausticRayService::update(frame::FrameGraph& graph, const scene::Pose& pose) {
  Implementation& s = *implementation_;
  if (s.requests.empty()) return false;
  const bool some = !s.boxes.empty(), lightsCameOrWent = pose.lights.size() != s.lights.size();
  if (!s.take(pose)) return false;
  if (lightsCameOrWent || some == s.boxes.empty()) return true;
  for (const auto& request : s.requests) {
    if (s.lacksLights(*request)) return true;
    if (request->views.empty()) continue;
    std::vector<glsl::ShadowView>&views = request->views, &last = request->lastViews;
    std::vector<glsl::CausticLayer>&layers = request->layers, &lastLayers = request->lastLayers;
    views.swap(last);
    layers.swap(lastLayers);
    s.fit(*request);
    if (views.size() != last.size()) return true;
    if (sameBytes(views, last) && sameBytes(layers, lastLayers)) continue;
    s.upload(*request);
    graph.touch(request->importedViews);
    graph.touch(request->made.layerLights);
  }
  return false;
}

}  // namespace limn::caustics
