// A scene on the GPU: uploaded once, then moved by small per-frame updates; and the calls that draw it inside
// passes.
//
// Vertices of all primitives lie in two shared streams: positions alone (3 floats, 12 bytes: all that a
// shadow map fetches) and attributes (octahedral normal and tangent, uv: 16 bytes). Primitives that are
// skinned or morphed have a second range there, one per instance, which the deform pass rewrites.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"
#include "core/technique/technique.h"
#include "glsl/blocks.glsl"

namespace limn::scene {

/// What one view may see, for culling on the CPU: planes with dot(plane, (p, 1)) >= 0 inside; unused ones are
/// 0.
struct LIMN_API CullVolume {
  std::array<glm::vec4, 6> planes{};
  bool mayContain(const Bounds& box) const;
};

/// Which surfaces a view shows.
enum class Surfaces : uint8_t {
  all,
  matte,     ///< those that are not specular
  specular,  ///< Material::specularSurface()
};

/// One view of drawDepth(): goes to layer `layer` of the target, and reads element `view` of the caller's
/// view buffer.
struct DepthView {
  CullVolume volume;
  uint32_t skipInstance = glsl::no_instance;  ///< index into Pose::instances
  uint32_t view = 0;
  int layer = 0;
  Surfaces surfaces = Surfaces::all;
};

/// Instances that survive culling, ready to be drawn: one per user (a G-buffer, a set of shadow maps), reused
/// each frame. Buffers grow to the next power of two when they must and are else only rewritten.
class LIMN_API DrawList {
 public:
  DrawList();
  ~DrawList();
  DrawList(DrawList&&) noexcept;
  DrawList& operator=(DrawList&&) noexcept;
  uint64_t triangles() const;  ///< drawn by the last call that used the list, all views together

 private:
  friend class GpuScene;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Programs of the depth passes; `alphaTest` textures unit 0. Both are made from the caller's vertex shader,
/// see glsl/depth/.
struct DrawPrograms {
  frame::ProgramHandle opaque, masked;
};

/// The permutation of the G-buffer's fragment shader that a material needs.
struct SurfaceVariant {
  uint32_t textures = 0;  ///< glsl::material_has_*_texture
  bool masked = false;    ///< some alpha cutoff
  auto operator<=>(const SurfaceVariant&) const = default;
};
using SurfacePrograms = std::map<SurfaceVariant, frame::ProgramHandle>;

class LIMN_API GpuScene {
 public:
  /// Uploads geometry, materials and textures. `scene` and `device` must outlive it. Throws Error when out of
  /// memory.
  GpuScene(gpu::Device& device, const Scene& scene);
  ~GpuScene();
  GpuScene(const GpuScene&) = delete;
  GpuScene& operator=(const GpuScene&) = delete;

  /// Brings the buffers to `pose` as seen by `camera`. Touches, in the graph import() was last called for (if
  /// that still lives: see forget()), what really changed. True: the structure changed (dynamic geometry came
  /// or went, the number of lights or of deformed primitives changed) and the graph must be rebuilt.
  bool update(const Pose& pose, const CameraPose& camera, glm::ivec2 size, uint32_t frameIndex);

  /// Imports the buffers and declares the deform pass (left out, with the reason, when nothing is deformed).
  SceneHandles import(frame::FrameGraph& graph);
  /// The graph of the last import() is about to be destroyed.
  void forget();

  const Scene& scene() const;
  gpu::Device& device() const;
  const glsl::FrameBlock& frame() const;
  const CameraPose& camera() const;
  /// World bounds of one instance at the last update(); conservative for deformed primitives.
  const Bounds& bounds(uint32_t instance) const;
  /// Union of all of them.
  const Bounds& bounds() const;
  uint32_t instanceCount() const;
  uint64_t triangles() const;  ///< instances counted
  /// Whether the instance's material is specular.
  bool specular(uint32_t instance) const;
  bool hasSpecular() const;  ///< some instance is
  bool hasMasked() const;    ///< some material has an alpha cutoff
  bool hasColours() const;   ///< some vertices have colours
  /// Those of all materials of the scene, each once.
  std::vector<SurfaceVariant> surfaceVariants() const;

  /// Whether instances outside a view's volume are left out of its draw calls; true at first.
  void setCulling(bool culling);

  /// Declares what a pass that draws geometry reads (vertex streams, instances, materials).
  static void declareReads(frame::PassBuilder& builder, const SceneHandles& handles);

  /// Draws what the camera sees into the bound framebuffer: back faces of single-sided materials culled,
  /// depth test reversed (cleared to 0). Uniform blocks FrameBlock and 1 (the draw's material), storage
  /// bindings 0 (instances), 2 and 3 (positions, indices) are bound by it. `programs`: of all variants.
  void drawGBuffer(const frame::PassContext& context, const SceneHandles& handles,
                   const SurfacePrograms& programs, Surfaces surfaces, DrawList& list);

  /// Draws surfaces as all `views` see them, both sides (gl_FrontFacing tells them apart): drawDepth() with
  /// the materials and bindings of drawGBuffer(), without its frame block. `programs`: of all variants.
  void drawSurfaces(const frame::PassContext& context, const SceneHandles& handles,
                    const SurfacePrograms& programs, std::span<const DepthView> views, DrawList& list,
                    bool layered, const std::function<void(const DepthView&)>& beginView);

  /// Draws depth of all `views`, both sides of every surface. `layered`: one call for all views, whose vertex
  /// shader writes gl_Layer; otherwise `beginView` is called before each view to bind its target. The vertex
  /// shader gets the instance and view index in attribute 1 (uvec2), instances in storage binding 0.
  void drawDepth(const frame::PassContext& context, const SceneHandles& handles, const DrawPrograms& programs,
                 std::span<const DepthView> views, DrawList& list, bool layered,
                 const std::function<void(const DepthView&)>& beginView);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The G-buffer pass: rasterises what the camera sees. Layout: glsl/gbuffer.glsl.
class LIMN_API GBufferPass {
 public:
  /// Declares the pass "gbuffer", or "matte gbuffer" of the surfaces that are not specular. The pass object
  /// must outlive the graph.
  GBuffer add(frame::FrameGraph& graph, GpuScene& scene, const SceneHandles& handles, glm::ivec2 size,
              Surfaces surfaces = Surfaces::all);

 private:
  DrawList list_;
};

}  // namespace limn::scene
