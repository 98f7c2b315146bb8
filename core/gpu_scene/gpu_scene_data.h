// Declares the implementations of GpuScene and DrawList, shared by the files that implement them.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/gpu_scene/gpu_deform.h"
#include "core/gpu_scene/gpu_geometry.h"
#include "core/gpu_scene/gpu_materials.h"
#include "core/gpu_scene/gpu_medium.h"
#include "core/gpu_scene/gpu_scene.h"

namespace limn::scene {

struct DrawCommand {
  uint32_t count, instanceCount, firstIndex;
  int32_t baseVertex;
  uint32_t baseInstance;
  bool operator==(const DrawCommand&) const = default;
};

/// Holds commands that share textures and fixed-function state.
struct DrawRun {
  int material = 0;
  bool masked = false, mirrored = false, doubleSided = false;
  uint32_t firstCommand = 0, commandCount = 0;
};

struct DrawList::Implementation {
  std::vector<glm::uvec2> entries;  ///< draw instance, view
  std::vector<DrawCommand> commands;
  std::vector<DrawRun> runs;
  std::vector<uint32_t> viewRuns;  ///< first run of each separately drawn view, then the end
  uint64_t triangles = 0;
  gpu::Buffer entryBuffer, commandBuffer;
  std::vector<glm::uvec2> uploadedEntries;  ///< what the buffers hold
  std::vector<DrawCommand> uploadedCommands;

  void clear();
  /// Brings the buffers to the entries and commands, which it takes.
  void upload(gpu::Device& device);
  /// Calls f(run, index of the view or 0 where all were drawn together, whether it is the view's first run).
  template <class F>
  void forEachRun(const F& f) const {
    for (size_t part = 0; part + 1 < viewRuns.size(); ++part)
      for (uint32_t r = viewRuns[part]; r < viewRuns[part + 1]; ++r) f(runs[r], part, r == viewRuns[part]);
  }
};

/// Holds what drawing needs to know about one draw instance.
struct InstanceState {
  GeometryRange range;
  uint32_t primitive = 0;  ///< equal for instances of the same vertices
  int material = 0;
  bool mirrored = false;
  Bounds bounds;
};

struct DynamicState {
  std::shared_ptr<const Primitive> primitive = std::make_shared<Primitive>();
  GeometryRange range;
  uint32_t vertexCapacity = 0, indexCapacity = 0;
  bool dirty = false;
};

struct GpuScene::Implementation {
  Implementation(gpu::Device& device, const Scene& scene);

  bool allocate(const Pose& pose);
  bool writeDynamic();
  void updateInstances(const Pose& pose);
  void sort();
  void fill(DrawList::Implementation& list, const std::vector<uint32_t>& order,
            std::span<const DepthView> views, bool depthOnly) const;
  void fillViews(DrawList::Implementation& list, const std::vector<uint32_t>& order,
                 std::span<const DepthView> views, bool layered, bool depthOnly) const;
  void bindVertices(const gpu::Buffer& entries) const;
  void bindDraws(const DrawList::Implementation& list) const;
  gpu::Program& beginSurfaceRun(const frame::PassContext& context, const SurfacePrograms& programs,
                                const DrawRun& run) const;
  void drawRun(const DrawRun& run) const;
  template <class T>
  bool upload(gpu::Buffer& buffer, const char* label, std::vector<T>& current, std::vector<T>& next);
  void touch(frame::BufferHandle SceneHandles::*member);

  gpu::Device& device;
  const Scene& scene;
  GpuGeometry geometry;
  GpuMaterials materials;
  GpuDeform deform;
  GpuMedium medium;
  gpu::Texture lightTextures;
  gpu::VertexArray vertexArray;

  std::vector<DynamicState> dynamic;
  std::vector<GeometryRange> deformedRanges;
  std::vector<std::pair<int, int>> deformedPrimitives;

  std::vector<InstanceState> states;
  std::vector<uint64_t> sortKeys, nextSortKeys;
  std::vector<uint32_t> cameraOrder, depthOrder;
  bool culling = true;
  std::vector<glsl::Instance> instances, nextInstances;
  std::vector<glsl::Light> lights, nextLights;
  glsl::FrameBlock frame{};
  glsl::FrameBlock mediumAlone{};  ///< SceneHandles::medium
  CameraPose camera;
  float nearPlane = 0;
  Bounds bounds;
  gpu::Buffer instanceBuffer, lightBuffer, frameBuffer, mediumBuffer;

  frame::FrameGraph* graph = nullptr;
  SceneHandles imported;
};

}  // namespace limn::scene
