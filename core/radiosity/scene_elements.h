// Declares the surface elements of a posed scene: what moves them from frame to frame, and what light needs
// to know of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/bodies.h"
#include "core/radiosity/forest.h"
#include "core/scene/scene.h"
#include "glsl/surface/brdf.glsl"

namespace limn::radiosity {

/// Holds a leaf as shaders see it (storage buffer element, glsl/indirect/surface_leaf.glsl), in world space.
struct Leaf {
  glm::vec3 vertex{0};    ///< where triangles meet, m
  float used = 0;         ///< 1, or 0 for unused slots
  glm::vec4 position{0};  ///< the disc's centre, m
  glm::vec4 normal{0};    ///< unit
  glm::vec3 albedo{0};    ///< hemispherical reflectance; textures averaged over the disc
  float unused = 0;
};
static_assert(sizeof(Leaf) == 64 && offsetof(Leaf, position) == 16);

/// Holds the reflectance of a leaf's surface, textures averaged over the disc, as an element of a storage
/// buffer of glsl::SurfaceBrdf. Specular surfaces reflect nothing.
struct LeafMaterial {
  glsl::SurfaceBrdf brdf{};
  glm::vec2 unused{0};
};
static_assert(sizeof(LeafMaterial) == 48 && offsetof(glsl::SurfaceBrdf, dielectric_f0) == 32);

class LIMN_API SceneElements {
 public:
  /// Makes the elements. Edges of triangles longer than `longestEdge`, in radii of the scene, are halved. All
  /// lengths are in units of the radius that the scene has now. Object i is instance i of the pose. `lift` is
  /// as Bodies has it, `shape` as Forest. Throws UsageError beyond `maxElements` leaf slots.
  SceneElements(const scene::Scene& scene, const scene::Pose& pose, float longestEdge, uint32_t maxElements,
                double lift = kDefaultLift, LeafShape shape = LeafShape::disc);
  ~SceneElements();

  /// Returns whether `pose` differs only in where vertices are. It does not where an instance's matrix
  /// mirrors it, or changes an area by more than half, or where a skin or morph targets change the area of
  /// all of it by more than half: elements keep the areas that they were made with.
  bool fits(const scene::Pose& pose) const { return fits(pose, pose.instances); }
  /// Does so for elements that were made of these instances of `pose` alone.
  bool fits(const scene::Pose& pose, std::span<const scene::DrawInstance> instances) const;
  /// Sets the positions and normals of `pose`, which must fit. Uses all cores; allocates nothing where no
  /// instance is deformed.
  void update(const scene::Pose& pose);

  /// Returns the scene that the elements were made of.
  const scene::Scene& scene() const { return scene_; }
  const ElementSpace& space() const { return space_; }
  const Surfels& surfels() const { return surfels_; }
  const Forest& forest() const { return forest_; }
  std::span<const Leaf> leaves() const { return leaves_; }
  /// Returns the material of each leaf slot.
  std::span<const LeafMaterial> materials() const { return materials_; }
  /// Returns the mesh between the surfels: 3 leaf slots per triangle, front faces counter-clockwise;
  /// double-sided surfaces have one for each side.
  std::span<const uint32_t> triangles() const { return forest_.triangles(); }

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
};

}  // namespace limn::radiosity
