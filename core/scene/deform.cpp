#include "glsl/geometry/deform.glsl"

#include <algorithm>

#include "core/scene/scene.h"

namespace limn::scene {

void deform(const Primitive& primitive, const Deformation& state, std::vector<glm::vec3>& positions,
            std::vector<glm::vec3>& normals, std::vector<glm::vec4>& tangents) {
  positions.assign(primitive.positions.begin(), primitive.positions.end());
  normals.assign(primitive.normals.begin(), primitive.normals.end());
  tangents.assign(primitive.tangents.begin(), primitive.tangents.end());

  // Morph: base + sum of weight * delta.
  const std::size_t targets = std::min(state.morphWeights.size(), primitive.morphTargets.size());
  for (std::size_t t = 0; t < targets; ++t) {
    const float weight = state.morphWeights[t];
    if (weight == 0) continue;
    const MorphTarget& target = primitive.morphTargets[t];
    for (std::size_t i = 0; i < target.positions.size(); ++i)
      positions[i] = glsl::morph(positions[i], target.positions[i], weight);
    for (std::size_t i = 0; i < target.normals.size(); ++i)
      normals[i] = glsl::morph(normals[i], target.normals[i], weight);
    for (std::size_t i = 0; i < std::min(target.tangents.size(), tangents.size()); ++i)
      tangents[i] = glm::vec4(glsl::morph(glm::vec3(tangents[i]), target.tangents[i], weight), tangents[i].w);
  }
  if (targets > 0) {
    for (std::size_t i = 0; i < normals.size(); ++i)
      normals[i] = glsl::safe_normalize(normals[i], primitive.normals[i]);
    for (std::size_t i = 0; i < tangents.size(); ++i)
      tangents[i] = glm::vec4(glsl::safe_normalize(glm::vec3(tangents[i]), glm::vec3(primitive.tangents[i])),
                              tangents[i].w);
  }
  if (state.joints.empty()) return;

  // Skin: linear blend of the vertex's four joints.
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::u16vec4& j = primitive.joints[i];
    const glm::mat4 joint = glsl::blend_joints(state.joints[j.x], state.joints[j.y], state.joints[j.z],
                                               state.joints[j.w], primitive.weights[i]);
    positions[i] = glsl::skin_position(joint, positions[i]);
    normals[i] = glsl::skin_normal(joint, normals[i]);
    if (!tangents.empty()) tangents[i] = glsl::skin_tangent(joint, tangents[i]);
  }
}

}  // namespace limn::scene
