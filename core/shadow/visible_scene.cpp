#include "core/shadow/visible_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limn::shadow {
namespace {

using glm::vec3;
using scene::Bounds;

constexpr int kMostCells = 4;            // per axis of a primitive's bounds
constexpr size_t kMostBoxes = 1024;      // of a scene, more or less: instances times cells
constexpr float kFrustumMargin = 1e-3f;  // of the tangents of the field of view

/// Boxes around the triangles whose centres lie in the same cell of a grid over the primitive.
std::vector<Bounds> splitPrimitive(const scene::Primitive& primitive, int cells) {
  std::vector<Bounds> boxes(static_cast<size_t>(cells * cells * cells));
  const vec3 extent = glm::max(primitive.bounds.high - primitive.bounds.low, vec3(1e-30f));
  for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    std::array<vec3, 3> corner;
    for (size_t k = 0; k < 3; ++k) corner[k] = primitive.positions[primitive.indices[i + k]];
    const vec3 place = ((corner[0] + corner[1] + corner[2]) / 3.f - primitive.bounds.low) / extent;
    const glm::ivec3 cell =
        glm::clamp(glm::ivec3(place * static_cast<float>(cells)), glm::ivec3(0), glm::ivec3(cells - 1));
    Bounds& box = boxes[static_cast<size_t>((cell.z * cells + cell.y) * cells + cell.x)];
    for (const vec3& p : corner) box.add(p);
  }
  std::erase_if(boxes, [](const Bounds& box) { return box.empty(); });
  return boxes;
}

size_t primitiveInstances(const scene::Scene& scene) {
  size_t count = 0;
  for (const scene::Node& node : scene.nodes) {
    if (node.mesh == scene::kNone) continue;
    count += scene.meshes[static_cast<size_t>(node.mesh)].primitives.size() *
             std::max<size_t>(node.instances.size(), 1);
  }
  return count;
}

/// Planes, world, of what a camera sees: left, right, bottom, top.
std::array<glm::vec4, 4> frustum(const scene::CameraPose& camera, float aspect) {
  const float up = std::tan(0.5f * camera.yfov) * (1 + kFrustumMargin), across = up * aspect;
  const glm::mat4 toWorld = glm::transpose(camera.worldToView);  // of planes
  return {toWorld * glm::vec4(1, 0, -across, 0), toWorld * glm::vec4(-1, 0, -across, 0),
          toWorld * glm::vec4(0, 1, -up, 0), toWorld * glm::vec4(0, -1, -up, 0)};
}

}  // namespace

VisibleScene::VisibleScene(const scene::Scene& scene) {
  const size_t instances = std::max<size_t>(primitiveInstances(scene), 1);
  int cells = kMostCells;
  while (cells > 1 && instances * static_cast<size_t>(cells * cells * cells) > kMostBoxes) --cells;
  boxes_.resize(scene.meshes.size());
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    for (const scene::Primitive& primitive : scene.meshes[m].primitives)
      boxes_[m].push_back(splitPrimitive(primitive, cells));
  }
}

bool VisibleScene::update(const scene::Pose& pose, std::span<const Bounds> instanceBounds,
                          const scene::CameraPose& camera, float aspect) {
  const std::array<glm::vec4, 4> planes = frustum(camera, aspect);
  if (planes == planes_ && pose.instances == instances_ &&
      std::ranges::equal(instanceBounds, instanceBounds_))
    return false;
  planes_ = planes;
  instances_ = pose.instances;
  instanceBounds_.assign(instanceBounds.begin(), instanceBounds.end());
  parts_.clear();
  for (uint32_t i = 0; i < pose.instances.size(); ++i) {
    const scene::DrawInstance& drawn = pose.instances[i];
    if (drawn.node == scene::kNone || drawn.deformed != scene::kNone) {
      if (!instanceBounds[i].empty()) parts_.push_back({instanceBounds[i], i});
      continue;
    }
    for (const Bounds& box : boxes_[static_cast<size_t>(drawn.mesh)][static_cast<size_t>(drawn.primitive)])
      parts_.push_back({scene::transformed(box, drawn.objectToWorld), i});
  }
  visibleCount_ = 0;
  for (const ScenePart& part : parts_) {
    if (visibleCount_ == visible_.size()) visible_.emplace_back();
    VisiblePart& seen = visible_[visibleCount_];
    seen.instance = part.instance;
    seen.solid.setBox(boxCorners(part.bounds));
    for (const glm::vec4& plane : planes) {
      if (!seen.solid.empty()) seen.solid.clip(plane);
    }
    if (seen.solid.empty()) continue;
    seen.corners.clear();
    for (const vec3& p : seen.solid.corners())
      if (std::ranges::find(seen.corners, p) == seen.corners.end()) seen.corners.push_back(p);
    ++visibleCount_;
  }
  return true;
}

}  // namespace limn::shadow
