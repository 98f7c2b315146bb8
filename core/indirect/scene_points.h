// Places points evenly over all surfaces of a scene; the points stick to their triangles.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/scene/scene.h"
#include "glsl/indirect/scene_point.glsl"

namespace limn::indirect {

/// Holds the running sum of the areas of a list of triangles.
struct AreaTable {
  std::vector<float> upTo;  ///< m^2 of the triangles 0 to i
  /// Fills the table; `indices` holds the 3 corners of each triangle and is not empty. `toWorld` maps edges
  /// to those whose areas count.
  void fill(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
            const glm::dmat3& toWorld = glm::dmat3(1));
  float total() const { return upTo.empty() ? 0.f : upTo.back(); }
  /// Returns the triangle in which the fraction `u` in [0, 1) of the area lies; only for a table with an area
  /// above 0.
  uint32_t triangle(float u) const;
};

/// Holds points on the surfaces of a scene.
class ScenePoints {
 public:
  /// Chooses `count` points in proportion to area at `pose`. Any run of consecutive points is spread evenly,
  /// too. Where instances change their size, the density follows the size at the pose of the last choice.
  ScenePoints(gpu::Device& device, const scene::Scene& scene, const scene::Pose& pose, int count);
  /// Chooses again if triangles were added or removed, or an instance's areas changed by more than half.
  void update(const scene::Pose& pose);
  frame::BufferHandle import(frame::FrameGraph& graph);
  float area() const { return area_; }  ///< of all surfaces, m^2
  int count() const { return static_cast<int>(points_.size()); }

 private:
  void measure(const scene::Pose& pose);
  void choose(const scene::Pose& pose);

  const scene::Scene& scene_;
  std::vector<AreaTable> fixed_, deformed_, dynamic_;
  std::vector<AreaTable> stretched_;      ///< of each instance whose triangles do not all change alike
  std::vector<size_t> firstOfMesh_;       ///< index of each mesh's first table in fixed_
  std::vector<const AreaTable*> tables_;  ///< of each instance
  std::vector<float> upTo_;               ///< m^2 of the instances 0 to i
  std::vector<glm::dvec3> areas_;         ///< factors of each instance, at the last choice
  std::vector<uint32_t> chosen_;          ///< points on each instance
  std::vector<std::shared_ptr<const scene::Primitive>> known_;  ///< dynamic ones, at the last choice
  std::vector<glsl::ScenePoint> points_;
  gpu::Buffer buffer_;
  frame::FrameGraph* graph_ = nullptr;
  frame::BufferHandle handle_;
  float area_ = 0;
};

}  // namespace limn::indirect
