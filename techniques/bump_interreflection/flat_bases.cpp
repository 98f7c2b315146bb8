#include "techniques/bump_interreflection/flat_bases.h"

#include <cmath>

#include "core/scene/draw_instance.h"

namespace limn::bump_interreflection {
namespace {

/// Limits the deviation of normals and tangents, and that of vertices from the plane over their distance.
constexpr float kDeviation = 1e-4f;

bool isFlat(const scene::Primitive& primitive) {
  if (primitive.positions.empty() || primitive.tangents.size() != primitive.positions.size()) return false;
  const glm::vec3 n = primitive.normals.front(), p = primitive.positions.front();
  const glm::vec4 t = primitive.tangents.front();
  for (size_t i = 0; i < primitive.positions.size(); ++i) {
    const glm::vec3 way = primitive.positions[i] - p;
    // False for what is no number, too.
    const bool even = std::abs(glm::dot(way, n)) <= kDeviation * glm::length(way) &&
                      glm::distance(primitive.normals[i], n) <= kDeviation &&
                      glm::distance(primitive.tangents[i], t) <= kDeviation;
    if (!even) return false;
  }
  return true;
}

}  // namespace

FlatBases flatBases(const scene::Scene& scene, const scene::Pose& pose) {
  FlatBases result;
  result.ofInstances.assign(pose.instances.size(), glsl::no_instance);
  for (size_t i = 0; i < pose.instances.size(); ++i) {
    const scene::DrawInstance& instance = pose.instances[i];
    const int height = scene::materialOf(scene, instance).height;
    if (height == scene::kNone) continue;
    const scene::Primitive& primitive = scene::primitiveOf(scene, pose, instance);
    // Geometry of a source may be another one in each frame.
    if (instance.node == scene::kNone || instance.deformed != scene::kNone || !isFlat(primitive)) {
      result.curved = true;
      continue;
    }
    result.ofInstances[i] = static_cast<uint32_t>(result.bases.size());
    result.bases.push_back({.tangent = glm::vec3(primitive.tangents.front()),
                            .instance = static_cast<uint32_t>(i),
                            .normal = primitive.normals.front(),
                            .height = height,
                            // The bitangent of normal maps points up the texture, against v.
                            .left_handed = primitive.tangents.front().w >= 0 ? 1u : 0u,
                            .first = static_cast<uint32_t>(result.texels),
                            .unused_0 = 0,
                            .unused_1 = 0});
    result.texels += scene.heights[static_cast<size_t>(height)].texels();
  }
  return result;
}

}  // namespace limn::bump_interreflection
