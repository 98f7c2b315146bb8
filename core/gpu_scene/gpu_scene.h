// Declares a scene on the GPU, which is uploaded once and then changed by small per-frame updates, and the
// calls that draw it inside passes.
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
#include "core/gpu_scene/scene_handles.h"
#include "core/scene/scene.h"
#include "glsl/scene/blocks.glsl"

namespace limn::scene {

/// Bounds what one view may see, for culling on the CPU: planes with dot(plane, (p, 1)) >= 0 inside; unused
/// ones are 0.
struct LIMN_API CullVolume {
  std::array<glm::vec4, 6> planes{};
  bool mayContain(const Bounds& box) const;
};

/// Says which surfaces a view shows.
enum class Surfaces : uint8_t {
  all,
  matte,     ///< those that are not specular
  specular,  ///< Material::specularSurface()
};

/// Describes one view of drawDepth(): it is drawn to layer `layer` of the target and reads element `view` of
/// the caller's view buffer.
struct DepthView {
  CullVolume volume;
  uint32_t skipInstance = glsl::no_instance;  ///< index into Pose::instances
  uint32_t view = 0;
  int layer = 0;
  Surfaces surfaces = Surfaces::all;
};

/// Holds the instances that survive culling, ready to be drawn. Each user (a G-buffer, a set of shadow maps)
/// has one list and reuses it every frame. Buffers grow to the next power of two when they must and are
/// otherwise only rewritten.
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

/// Holds the programs of a depth pass, made by GpuScene::declareDepth().
struct DrawPrograms {
  frame::ProgramHandle opaque, masked;
  frame::SlotHandle baseColour;  ///< of masked
};

/// Describes the permutation of the G-buffer's fragment shader that a material needs.
struct SurfaceVariant {
  uint32_t textures = 0;  ///< glsl::material_has_*_texture
  bool masked = false;    ///< the material has an alpha cutoff
  auto operator<=>(const SurfaceVariant&) const = default;
};

/// Holds the programs of a pass that draws surfaces, made by GpuScene::declareSurfaces().
struct SurfacePrograms {
  std::map<SurfaceVariant, frame::ProgramHandle> variants;
  bool materials = false;  ///< the programs read the material: the slots below are declared
  frame::SlotHandle material;
  std::array<frame::SlotHandle, 5> textures;
};

class LIMN_API GpuScene {
 public:
  /// Uploads geometry, materials and textures. `scene` and `device` must outlive this object. Throws
  /// UsageError where vertices, triangles, skins or morph targets are more than a storage buffer of the
  /// device holds, and Error when out of memory.
  GpuScene(gpu::Device& device, const Scene& scene);
  ~GpuScene();
  GpuScene(const GpuScene&) = delete;
  GpuScene& operator=(const GpuScene&) = delete;

  /// Updates the buffers to `pose` as seen by `camera`. Touches what changed in the graph for which import()
  /// was last called (if that still lives: see forget()). Returns true if the structure changed (the number
  /// of lights or of deformed primitives), so that the graph must be rebuilt. Throws as the constructor does
  /// where instances, lights or joints are too many, or deformed and dynamic geometry makes the vertices or
  /// triangles too many.
  bool update(const Pose& pose, const CameraPose& camera, glm::ivec2 size, uint32_t frameIndex);

  /// Imports the buffers and declares the deform pass (left out, with the reason, when nothing is deformed).
  SceneHandles import(frame::FrameGraph& graph);
  /// Forgets the graph of the last import(); called before that graph is destroyed.
  void forget();

  const Scene& scene() const;
  gpu::Device& device() const;
  const glsl::FrameBlock& frame() const;
  const CameraPose& camera() const;
  /// Returns the world bounds of one instance at the last update(); conservative for deformed primitives.
  const Bounds& bounds(uint32_t instance) const;
  /// Returns the union of the bounds of all instances.
  const Bounds& bounds() const;
  /// Returns the union of the bounds of the specular instances.
  Bounds specularBounds() const;
  uint32_t instanceCount() const;
  uint64_t triangles() const;  ///< summed over all instances
  /// Says whether the instance's material is specular.
  bool specular(uint32_t instance) const;
  bool hasSpecular() const;     ///< at least one instance is specular
  bool hasMasked() const;       ///< at least one instance has an alpha cutoff
  bool hasColours() const;      ///< at least one primitive has vertex colours
  bool hasHeights() const;      ///< at least one material has a height map
  bool hasTranslucent() const;  ///< at least one instance is translucent
  /// Returns the variants of all materials of the scene, each once.
  std::vector<SurfaceVariant> surfaceVariants() const;

  /// Sets whether instances outside a view's volume are left out of its draw calls; the default is true.
  void setCulling(bool culling);

  /// Declares what a pass that draws geometry depends on (vertex streams, instances, materials).
  static void declareReads(frame::PassBuilder& builder, const SceneHandles& handles);

  /// Declares what drawDepth() reads, and its programs: `desc` with MASKED 0 and, where materials have an
  /// alpha cutoff, also with MASKED 1. The vertex shaders use the block Instances; the masked program's
  /// fragment shader uses Materials and base_colour_texture.
  DrawPrograms declareDepth(frame::PassBuilder& pass, const SceneHandles& handles,
                            const gpu::ProgramDesc& desc) const;

  /// Declares what drawGBuffer() and drawSurfaces() read, and a program for each variant of the scene's
  /// surfaces: `desc` with MASKED, TEXTURES and COLOURS. The shaders use the blocks Instances, Positions and
  /// Indices (glsl/geometry/triangle_input.glsl), MaterialBlock and the textures of the draw's material
  /// (glsl/geometry/surface_input.glsl). With `materials` false they read no material, and the program `desc`
  /// is used for all.
  SurfacePrograms declareSurfaces(frame::PassBuilder& pass, const SceneHandles& handles,
                                  const gpu::ProgramDesc& desc, bool materials = true) const;

  /// Draws what the camera sees into the bound framebuffer, with back faces of single-sided materials culled
  /// and the depth test reversed (cleared to 0). The programs have the plain uniform near_plane.
  void drawGBuffer(const frame::PassContext& context, const SurfacePrograms& programs, Surfaces surfaces,
                   DrawList& list);

  /// Draws surfaces as all `views` see them, both sides (distinguished by gl_FrontFacing), and otherwise as
  /// drawDepth() does.
  void drawSurfaces(const frame::PassContext& context, const SurfacePrograms& programs,
                    std::span<const DepthView> views, DrawList& list, bool layered,
                    const std::function<void(const DepthView&)>& beginView);

  /// Draws the depth of all `views`, both sides of every surface. With `layered`, one call draws all views,
  /// and its vertex shader writes gl_Layer; otherwise `beginView` is called before each view to bind its
  /// target. The vertex shader gets the instance and view index in attribute 1 (uvec2).
  void drawDepth(const frame::PassContext& context, const DrawPrograms& programs,
                 std::span<const DepthView> views, DrawList& list, bool layered,
                 const std::function<void(const DepthView&)>& beginView);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Rasterises what the camera sees into the G-buffer. Layout: glsl/surface/gbuffer.glsl.
class LIMN_API GBufferPass {
 public:
  /// Declares the pass "gbuffer", or "matte gbuffer" for the surfaces that are not specular. The pass object
  /// must outlive the graph. `places` asks for GBuffer::places.
  GBuffer add(frame::FrameGraph& graph, GpuScene& scene, const SceneHandles& handles, glm::ivec2 size,
              Surfaces surfaces = Surfaces::all, bool places = false);

 private:
  DrawList list_;
};

}  // namespace limn::scene
