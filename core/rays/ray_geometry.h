// Declares the scene as rays meet it on the GPU: a hierarchy over the draw instances, whose leaves are
// hierarchies of the primitives' triangles in their own space. Copies of a primitive share one.
//
// What does not move is built once. Where instances move as a whole, the upper hierarchy alone is built
// again, on the CPU. Skinned and morphed primitives keep the tree that they have at the start: passes fetch
// their vertices and refit the boxes. Primitives with new topology (metaballs) are built on the CPU, and so
// are instances that their matrix makes flat wherever they move: floats hold no inverse of it, so that each
// has a hierarchy of its own in world space.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/frame/frame_graph.h"
#include "core/gpu/objects.h"
#include "core/rays/bvh.h"
#include "core/rays/coverage.h"
#include "core/scene/scene.h"
#include "core/technique/frame_service.h"
#include "glsl/rays/ray_node.glsl"

namespace limn::rays {

/// Holds what glsl/rays/ray_trace.glsl reads, in the graph that is being built.
struct LIMN_API RayGeometry {
  frame::BufferHandle nodes, triangles, bodies;
  frame::BufferHandle coverage;  ///< empty: nothing has an alpha mask
  int stack = 0;                 ///< entries

  /// Declares that a pass traces rays.
  void declare(frame::PassBuilder& pass) const;
  /// Adds what its programs are compiled for.
  void define(std::map<std::string, std::string>& defines) const;
};

class LIMN_API RayGeometryService : public FrameService {
 public:
  static constexpr const char* serviceName = "ray geometry";

  RayGeometryService(gpu::Device& device, const scene::Scene& scene);
  ~RayGeometryService() override;

  /// Returns the scene for rays. Instances of which their matrix leaves a line or a point are left out, and
  /// so are those with morph targets that it makes flat. Throws UsageError when the scene takes more memory
  /// than a storage buffer may.
  const RayGeometry& request();

 private:
  /// Triangles that share a hierarchy.
  struct Mesh {
    uint32_t root = 0, firstTriangle = 0;
    uint32_t triangles = 0;  ///< now
    uint32_t capacity = 0;   ///< triangles that there is room for; as many nodes where it is dynamic or flat
    uint32_t coverage = glsl::ray_opaque;
    bool transparent = false;  ///< rays pass all of it
    glm::mat4 place{1};  ///< of a flat instance: from its space to the world, in which the triangles lie
    /// Of a dynamic mesh: what is in the buffers. It is held, since sources fill again what nobody holds.
    std::shared_ptr<const scene::Primitive> built;
  };
  /// What instances have to have in common with what was built.
  struct Source {
    bool dynamic = false;
    int mesh = 0, primitive = 0, deformed = 0;
    int flat = scene::kNone;  ///< number of an instance that is flat
    auto operator<=>(const Source&) const = default;
  };
  /// Buffers while they are being made.
  struct Parts {
    std::vector<glsl::RayNode> nodes;
    std::vector<glm::vec4> triangles;
    std::vector<glsl::RayCorners> corners;
    std::vector<std::vector<uint32_t>> refits;  ///< node numbers, the deepest level first
    CoverageTable coverage;
  };

  void begin() override;
  bool update(frame::FrameGraph& graph, const scene::Pose& pose) override;

  Source sourceOf(const scene::Pose& pose, uint32_t draw) const;
  bool fits(const scene::Pose& pose) const;
  void build(const scene::Pose& pose);
  void checkSize(const scene::Pose& pose) const;
  Mesh addMesh(Parts& parts, const scene::Pose& pose, uint32_t draw);
  void addMotion(Parts& parts, const scene::Primitive& primitive, uint32_t draw, uint32_t firstNode) const;
  void buildTree(const scene::Primitive& primitive, const std::vector<glm::vec3>& positions);
  void appendTree(std::vector<glsl::RayNode>& nodes, std::vector<glm::vec4>& triangles,
                  const scene::Primitive& primitive, const std::vector<glm::vec3>& positions,
                  uint32_t firstNode, uint32_t firstTriangle) const;
  bool rebuildMeshes(const scene::Pose& pose, bool& changed);
  bool placeBodies(const scene::Pose& pose);
  void addRefits(const FrameContext& building);

  gpu::Device& device_;
  const scene::Scene& scene_;
  BvhBuilder builder_;
  std::vector<Source> sources_;      ///< of each instance
  std::vector<glm::mat4> matrices_;  ///< of each instance, in the last frame
  std::vector<uint32_t> meshOf_;     ///< of each instance: index into meshes_
  std::vector<Mesh> meshes_;
  std::vector<uint32_t> refitCounts_;      ///< nodes of each level
  uint32_t topCapacity_ = 0;               ///< nodes before those of the meshes
  uint32_t firstMoving_ = 0, moving_ = 0;  ///< triangles whose vertices are deformed
  int meshStack_ = 0;
  bool masked_ = false, built_ = false, requested_ = false;
  std::vector<glsl::RayNode> top_, dynamicNodes_;
  std::vector<glm::vec4> dynamicTriangles_;
  std::vector<glm::vec3> inWorld_;  ///< positions of a flat instance
  std::vector<glsl::RayBody> bodies_, nextBodies_;
  std::vector<glsl::RayBox> topBoxes_;  ///< of the instances placed
  std::vector<glsl::RayBox> boxes_;     ///< of what is being built
  std::vector<uint32_t> placed_;        ///< instances in the upper hierarchy
  gpu::Buffer nodeBuffer_, triangleBuffer_, bodyBuffer_, coverageBuffer_, cornerBuffer_, refitBuffer_;
  RayGeometry geometry_;
  frame::BufferHandle importedNodes_, importedTriangles_;
};

}  // namespace limn::rays
