// The surface elements of a posed scene: what moves them from frame to frame, and what light needs to know of
// them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/bodies.h"
#include "core/radiosity/forest.h"
#include "core/scene/scene.h"

namespace limn::radiosity {

/// A leaf as shaders see it (storage buffer element, glsl/radiosity.glsl), in world space.
struct Leaf {
  glm::vec4 vertex{0};    ///< xyz: where triangles meet, m; w: 1, or 0 for unused slots
  glm::vec4 position{0};  ///< xyz: the disc's centre, m
  glm::vec4 normal{0};    ///< xyz: unit
  glm::vec4 albedo{0};    ///< rgb: hemispherical reflectance; textures averaged over the disc
};

/// What a leaf's surface reflects with, textures averaged over the disc (storage buffer element): a
/// glsl::SurfaceBrdf. Specular surfaces reflect nothing.
struct LeafMaterial {
  glm::vec4 diffuse{0};     ///< rgb; w: alpha, 0..1
  glm::vec4 f0{0};          ///< rgb; w: f90
  glm::vec4 dielectric{0};  ///< x: dielectric_f0, y: dielectric_f90
};

class LIMN_API SceneElements {
 public:
  /// `longestEdge`: longer edges of triangles are halved; in radii of the scene. All lengths are in units of
  /// the radius that the scene has now. Object i is instance i of the pose. Throws UsageError beyond
  /// `maxElements` leaves.
  SceneElements(const scene::Scene& scene, const scene::Pose& pose, float longestEdge, uint32_t maxElements);
  ~SceneElements();

  /// Whether `pose` differs in where vertices are alone.
  bool fits(const scene::Pose& pose) const;
  /// Positions and normals of `pose`, which fits. All cores; allocates nothing where no instance is deformed.
  void update(const scene::Pose& pose);

  const ElementSpace& space() const { return space_; }
  const Surfels& surfels() const { return surfels_; }
  const Forest& forest() const { return forest_; }
  std::span<const Leaf> leaves() const { return leaves_; }
  /// Of each leaf slot.
  std::span<const LeafMaterial> materials() const { return materials_; }
  /// Of the mesh between the surfels: 3 leaf slots per triangle, front faces counter-clockwise; double-sided
  /// surfaces have one for each side.
  std::span<const uint32_t> triangles() const { return triangles_; }

 private:
  struct Instance;
  void moveInstances(const scene::Pose& pose);
  void moveSurfels();
  void setMaterials();

  const scene::Scene& scene_;
  ElementSpace space_;
  std::vector<Instance> instances_;
  Surfels surfels_;
  Bodies bodies_;
  Forest forest_;
  std::vector<Leaf> leaves_;
  std::vector<LeafMaterial> materials_;
  std::vector<uint32_t> triangles_;
};

}  // namespace limn::radiosity
