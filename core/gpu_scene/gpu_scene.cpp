#include "core/gpu_scene/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <set>
#include <tuple>

#include "core/base/same_bytes.h"
#include "core/gpu_scene/gpu_scene_data.h"
#include "core/gpu_scene/light_textures.h"
#include "core/scene/camera.h"
#include "core/scene/draw_instance.h"
#include "core/scene/medium.h"
#include "core/scene/normal_matrix.h"

namespace limn::scene {
namespace {

gpu::VertexArray makeVertexArray(gpu::Device& device, bool colours) {
  // Locations: glsl/geometry/*.vert.glsl. Bindings 0 to 3: positions, attributes, colours, draw entries.
  std::vector<gpu::VertexAttribute> attributes{
      {.location = 0, .components = 3, .type = GL_FLOAT, .binding = 0},
      {.location = 1, .components = 2, .type = GL_UNSIGNED_INT, .integer = true, .binding = 3},
      {.location = 2, .components = 2, .type = GL_UNSIGNED_INT, .integer = true, .binding = 1},
      {.location = 3, .components = 2, .type = GL_FLOAT, .offset = 8, .binding = 1}};
  if (colours) attributes.push_back({.location = 4, .components = 4, .type = GL_HALF_FLOAT, .binding = 2});
  return gpu::VertexArray(device, attributes);
}

}  // namespace

GpuScene::Implementation::Implementation(gpu::Device& onDevice, const Scene& ofScene)
    : device(onDevice),
      scene(ofScene),
      geometry(onDevice, ofScene),
      materials(onDevice, ofScene),
      deform(onDevice, ofScene),
      medium(onDevice, ofScene.medium),
      lightTextures(makeLightTextures(onDevice, ofScene)),
      vertexArray(makeVertexArray(onDevice, geometry.hasColours())),
      dynamic(ofScene.dynamic.size()),
      frameBuffer(onDevice, "frame", sizeof(glsl::FrameBlock), gpu::BufferUse::updated),
      mediumBuffer(onDevice, "medium", sizeof(glsl::FrameBlock), gpu::BufferUse::updated) {}

/// Places deformed and dynamic primitives behind the scene's own. True if places changed.
bool GpuScene::Implementation::allocate(const Pose& pose) {
  const auto partOf = [](const Deformation& d) { return std::pair(d.mesh, d.primitive); };
  bool fits = std::ranges::equal(pose.deformed, deformedPrimitives, {}, partOf);
  for (const DynamicState& d : dynamic) {
    fits = fits && d.primitive->positions.size() <= d.vertexCapacity &&
           d.primitive->indices.size() <= d.indexCapacity;
  }
  if (fits) return false;

  std::vector<std::pair<int, int>> wanted;
  for (const Deformation& d : pose.deformed) wanted.push_back(partOf(d));
  uint64_t vertices = 0, indices = 0;
  for (const auto& [mesh, primitive] : wanted) vertices += geometry.primitive(mesh, primitive).vertexCount;
  for (const DynamicState& d : dynamic) {
    vertices += std::bit_ceil(static_cast<uint32_t>(d.primitive->positions.size()));
    indices += std::bit_ceil(static_cast<uint32_t>(d.primitive->indices.size()));
  }
  geometry.reserve(vertices, indices);
  deformedPrimitives = std::move(wanted);
  deformedRanges.clear();
  for (const auto& [mesh, primitive] : deformedPrimitives) {
    GeometryRange range = geometry.primitive(mesh, primitive);  // shares the indices
    range.firstVertex = geometry.allocateVertices(range.vertexCount);
    deformedRanges.push_back(range);
  }
  for (DynamicState& d : dynamic) {
    d.vertexCapacity = std::bit_ceil(static_cast<uint32_t>(d.primitive->positions.size()));
    d.indexCapacity = std::bit_ceil(static_cast<uint32_t>(d.primitive->indices.size()));
    d.range.firstVertex = geometry.allocateVertices(d.vertexCapacity);
    d.range.firstIndex = geometry.allocateIndices(d.indexCapacity);
    d.dirty = true;
  }
  for (size_t i = 0; i < deformedRanges.size(); ++i)
    geometry.copyColours(geometry.primitive(deformedPrimitives[i].first, deformedPrimitives[i].second),
                         deformedRanges[i]);
  return true;
}

bool GpuScene::Implementation::writeDynamic() {
  bool any = false;
  for (DynamicState& d : dynamic) {
    if (!d.dirty) continue;
    d.dirty = false;
    any = true;
    d.range.vertexCount = static_cast<uint32_t>(d.primitive->positions.size());
    d.range.indexCount = static_cast<uint32_t>(d.primitive->indices.size());
    geometry.write(d.range, *d.primitive);
  }
  return any;
}

void GpuScene::Implementation::updateInstances(const Pose& pose) {
  states.resize(pose.instances.size());
  nextInstances.resize(pose.instances.size());
  bounds = {};
  for (size_t i = 0; i < pose.instances.size(); ++i) {
    const DrawInstance& drawn = pose.instances[i];
    InstanceState& state = states[i];
    state.material = materialIndexOf(scene, drawn);
    if (drawn.node == kNone) {
      const DynamicState& d = dynamic[static_cast<size_t>(drawn.mesh)];
      state.range = d.range;
      state.primitive = geometry.primitiveCount() + static_cast<uint32_t>(drawn.mesh);
    } else {
      state.range = geometry.primitive(drawn.mesh, drawn.primitive);
      state.primitive = geometry.primitiveIndex(drawn.mesh, drawn.primitive);
      if (drawn.deformed != kNone) {
        const auto d = static_cast<size_t>(drawn.deformed);
        state.range = deformedRanges[d];
        state.primitive = geometry.primitiveCount() + static_cast<uint32_t>(dynamic.size() + d);
      }
    }
    const glm::mat3 linear(drawn.objectToWorld);
    state.mirrored = mirrored(drawn);
    state.bounds = instanceBounds(scene, pose, drawn);
    bounds.add(state.bounds);

    glsl::Instance& out = nextInstances[i];
    out.object_to_world = drawn.objectToWorld;
    // Cofactors: the direction of the inverse transpose without its division, so that no scale underflows it.
    const float scale =
        std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]), 1e-30f});
    const glm::mat3 m = linear / scale;
    const float side = mirrors(drawn.objectToWorld) ? -1.f : 1.f;
    out.normal_to_world = glm::mat4(glm::mat3(side * glm::cross(m[1], m[2]), side * glm::cross(m[2], m[0]),
                                              side * glm::cross(m[0], m[1])));
    out.material = static_cast<uint32_t>(state.material);
    out.first_vertex = state.range.firstVertex;
    out.flags = state.mirrored ? glsl::instance_mirrored : 0u;
    out.first_index = state.range.firstIndex;
  }
  sort();
}

/// Orders the instances so that equal states and equal primitives are neighbours; only when those changed.
void GpuScene::Implementation::sort() {
  nextSortKeys.resize(states.size());
  for (size_t i = 0; i < states.size(); ++i) {
    nextSortKeys[i] = uint64_t{states[i].primitive} << 32 | static_cast<uint64_t>(states[i].material) << 1 |
                      (states[i].mirrored ? 1 : 0);
  }
  if (nextSortKeys == sortKeys && !cameraOrder.empty()) return;
  sortKeys.swap(nextSortKeys);
  const auto order = [&](auto key) {
    std::vector<uint32_t> ids(states.size());
    std::iota(ids.begin(), ids.end(), 0u);
    std::stable_sort(ids.begin(), ids.end(),
                     [&](uint32_t a, uint32_t b) { return key(states[a]) < key(states[b]); });
    return ids;
  };
  cameraOrder = order([&](const InstanceState& s) {
    return std::tuple(materials.masked(s.material), materials.textureKey(s.material), s.material, s.mirrored,
                      s.primitive);
  });
  depthOrder = order([&](const InstanceState& s) {
    const bool masked = materials.masked(s.material);
    return std::tuple(masked, masked ? materials.baseColourKey(s.material) : 0u, s.primitive);
  });
}

/// Brings a buffer to `next`, which is swapped with `current`. True if it changed.
template <class T>
bool GpuScene::Implementation::upload(gpu::Buffer& buffer, const char* label, std::vector<T>& current,
                                      std::vector<T>& next) {
  const size_t bytes = next.size() * sizeof(T);
  if (buffer && sameBytes(current, next)) return false;
  if (!buffer || buffer.size() < bytes) buffer = gpu::Buffer(device, label, bytes, gpu::BufferUse::updated);
  buffer.update(0, next.data(), bytes);
  current.swap(next);
  return true;
}

void GpuScene::Implementation::touch(frame::BufferHandle SceneHandles::*member) {
  if (graph != nullptr) graph->touch(imported.*member);
}

GpuScene::GpuScene(gpu::Device& device, const Scene& scene)
    : implementation_(std::make_unique<Implementation>(device, scene)) {}
GpuScene::~GpuScene() = default;

bool GpuScene::update(const Pose& pose, const CameraPose& camera, glm::ivec2 size, uint32_t frameIndex) {
  Implementation& s = *implementation_;
  const bool first = !s.instanceBuffer;
  const size_t deformedBefore = s.deformedPrimitives.size(), lightsBefore = s.lights.size();
  checkStorageBlock(s.device, "draw instances", pose.instances.size() * sizeof(glsl::Instance));
  checkStorageBlock(s.device, "lights", pose.lights.size() * sizeof(glsl::Light));

  for (size_t i = 0; i < s.dynamic.size(); ++i) {
    if (s.dynamic[i].primitive == pose.dynamic[i].primitive) continue;
    s.dynamic[i].primitive = pose.dynamic[i].primitive;
    s.dynamic[i].dirty = true;
  }
  bool moved = s.allocate(pose);
  moved = s.writeDynamic() || moved;
  if (moved) s.touch(&SceneHandles::geometry);
  if (s.materials.update(s.scene)) s.touch(&SceneHandles::materials);
  s.updateInstances(pose);
  const bool deformed = s.deform.update(pose, s.geometry, s.deformedRanges);
  if (deformed && s.graph != nullptr) s.deform.touch(*s.graph);
  if (s.upload(s.instanceBuffer, "instances", s.instances, s.nextInstances))
    s.touch(&SceneHandles::instances);
  if (s.medium.update(pose.time) && s.graph != nullptr) s.medium.touch(*s.graph);
  s.nextLights = pose.lights;
  if (s.upload(s.lightBuffer, "lights", s.lights, s.nextLights)) s.touch(&SceneHandles::lights);

  Bounds seen = pose.bounds;
  seen.add(s.bounds);
  glsl::FrameBlock before = s.frame;
  s.camera = camera;
  s.nearPlane = fitDepthRange(camera, seen).near;
  setCamera(s.frame, camera, seen, size.x, size.y);
  const Environment& environment = s.scene.environment;
  s.frame.environment_rotation = environment.rotation;
  s.frame.environment_scale = environment.scale;
  s.frame.frame_index = frameIndex;
  setMedium(s.frame, s.scene.medium, pose.bounds);
  s.frameBuffer.update(0, &s.frame, sizeof(s.frame));
  before.frame_index = frameIndex;  // what is kept from frame to frame does not depend on it
  if (std::memcmp(&before, &s.frame, sizeof(before)) != 0) s.touch(&SceneHandles::frame);
  const glsl::FrameBlock mediumBefore = s.mediumAlone;
  setMedium(s.mediumAlone, s.scene.medium, pose.bounds);
  if (first || std::memcmp(&mediumBefore, &s.mediumAlone, sizeof(mediumBefore)) != 0) {
    s.mediumBuffer.update(0, &s.mediumAlone, sizeof(s.mediumAlone));
    s.touch(&SceneHandles::medium);
  }
  return !first && (deformedBefore != s.deformedPrimitives.size() || lightsBefore != s.lights.size());
}

SceneHandles GpuScene::import(frame::FrameGraph& graph) {
  Implementation& s = *implementation_;
  s.graph = &graph;
  s.imported = {.frame = graph.importBuffer("frame", s.frameBuffer),
                .medium = graph.importBuffer("medium", s.mediumBuffer),
                .geometry = graph.importBuffer("geometry", s.geometry.positions()),
                .instances = graph.importBuffer("instances", s.instanceBuffer),
                .materials = graph.importBuffer("materials", s.materials.constants()),
                .lights = graph.importBuffer("lights", s.lightBuffer),
                .lightTextures = {},
                .density = {},
                .models = {},
                .modelKinds = s.materials.modelKinds(),
                .surface = {}};
  SceneHandles handles = s.imported;
  if (handles.modelKinds != 0) handles.models = graph.importBuffer("material models", s.materials.models());
  if ((handles.modelKinds & 1u << glsl::model_measured) != 0)
    handles.measured = graph.importBuffer("measured reflectance", s.materials.measured());
  if (s.lightTextures) handles.lightTextures = graph.importTexture("light textures", s.lightTextures);
  handles.density = s.medium.addPass(graph);
  handles.geometry = s.deform.addPass(graph, s.geometry, handles.geometry);
  return handles;
}

void GpuScene::forget() {
  implementation_->graph = nullptr;
  implementation_->deform.forget();
  implementation_->medium.forget();
}

const Scene& GpuScene::scene() const {
  return implementation_->scene;
}
gpu::Device& GpuScene::device() const {
  return implementation_->device;
}
const glsl::FrameBlock& GpuScene::frame() const {
  return implementation_->frame;
}
const CameraPose& GpuScene::camera() const {
  return implementation_->camera;
}
const Bounds& GpuScene::bounds(uint32_t instance) const {
  return implementation_->states.at(instance).bounds;
}
const Bounds& GpuScene::bounds() const {
  return implementation_->bounds;
}
Bounds GpuScene::specularBounds() const {
  Bounds objects;
  for (uint32_t i = 0; i < instanceCount(); ++i)
    if (specular(i)) objects.add(bounds(i));
  return objects;
}
uint32_t GpuScene::instanceCount() const {
  return static_cast<uint32_t>(implementation_->states.size());
}

uint64_t GpuScene::triangles() const {
  uint64_t sum = 0;
  for (const InstanceState& s : implementation_->states) sum += s.range.indexCount / 3;
  return sum;
}

void GpuScene::setCulling(bool culling) {
  implementation_->culling = culling;
}

bool GpuScene::hasSpecular() const {
  for (uint32_t i = 0; i < instanceCount(); ++i)
    if (specular(i)) return true;
  return false;
}

bool GpuScene::specular(uint32_t instance) const {
  return implementation_->materials.specular(implementation_->states.at(instance).material);
}

bool GpuScene::hasMasked() const {
  return std::any_of(implementation_->states.begin(), implementation_->states.end(),
                     [&](const InstanceState& s) { return implementation_->materials.masked(s.material); });
}

bool GpuScene::hasColours() const {
  return implementation_->geometry.hasColours();
}

bool GpuScene::hasHeights() const {
  return std::ranges::any_of(implementation_->scene.materials,
                             [](const Material& material) { return material.height != kNone; });
}

bool GpuScene::hasTranslucent() const {
  const Implementation& s = *implementation_;
  return std::ranges::any_of(s.states, [&](const InstanceState& state) {
    return s.scene.materials[static_cast<size_t>(state.material)].subsurface.has_value();
  });
}

std::vector<SurfaceVariant> GpuScene::surfaceVariants() const {
  std::set<SurfaceVariant> variants;
  for (size_t i = 0; i < implementation_->scene.materials.size(); ++i)
    variants.insert(implementation_->materials.variant(static_cast<int>(i)));
  return {variants.begin(), variants.end()};
}

namespace {

constexpr const char* kInstancesWhy = "transforms and materials of the draw instances";
constexpr const char* kMaterialsWhy = "surfaces and alpha cutoffs";

void declareVertices(frame::PassBuilder& pass, const SceneHandles& handles) {
  pass.read(handles.geometry, frame::Access::vertexBuffer, "positions and attributes")
      .read(handles.geometry, frame::Access::indexBuffer, "triangles");
}

}  // namespace

void GpuScene::declareReads(frame::PassBuilder& builder, const SceneHandles& handles) {
  declareVertices(builder, handles);
  builder.read(handles.instances, frame::Access::storageLoad, kInstancesWhy)
      .read(handles.materials, frame::Access::storageLoad, kMaterialsWhy);
}

DrawPrograms GpuScene::declareDepth(frame::PassBuilder& pass, const SceneHandles& handles,
                                    const gpu::ProgramDesc& desc) const {
  declareVertices(pass, handles);
  pass.read(handles.instances, frame::Access::storageLoad, "Instances", kInstancesWhy)
      .read(handles.materials, frame::Access::storageLoad, kMaterialsWhy);
  const auto program = [&](const char* masked) {
    gpu::ProgramDesc variant = desc;
    variant.defines["MASKED"] = masked;
    return pass.program(std::move(variant));
  };
  DrawPrograms programs;
  programs.opaque = programs.masked = program("0");
  if (!hasMasked()) return programs;
  pass.also("Materials");
  programs.baseColour = pass.slot("base_colour_texture");
  programs.masked = program("1");
  return programs;
}

SurfacePrograms GpuScene::declareSurfaces(frame::PassBuilder& pass, const SceneHandles& handles,
                                          const gpu::ProgramDesc& desc, bool materials) const {
  declareVertices(pass, handles);
  pass.read(handles.instances, frame::Access::storageLoad, "Instances", kInstancesWhy)
      .read(handles.materials, frame::Access::storageLoad, kMaterialsWhy)
      .read(handles.geometry, frame::Access::storageLoad, "Positions",
            "corners of triangles, for their normals")
      .constant("Indices", implementation_->geometry.indices());
  SurfacePrograms programs{.variants = {}, .materials = materials, .material = {}, .textures = {}};
  if (!materials) {
    const frame::ProgramHandle same = pass.program(desc);
    for (const SurfaceVariant& variant : surfaceVariants()) programs.variants[variant] = same;
    return programs;
  }
  programs.material = pass.slot("MaterialBlock");
  for (size_t i = 0; i < programs.textures.size(); ++i)
    programs.textures[i] = pass.slot(GpuMaterials::textureNames[i]);
  for (const SurfaceVariant& variant : surfaceVariants()) {
    gpu::ProgramDesc made = desc;
    made.defines["MASKED"] = variant.masked ? "1" : "0";
    made.defines["TEXTURES"] = fmt::format("{}u", variant.textures);
    made.defines["COLOURS"] = hasColours() ? "1" : "0";
    programs.variants[variant] = pass.program(std::move(made));
  }
  return programs;
}

}  // namespace limn::scene
