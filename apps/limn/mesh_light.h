// Internal to light_edits: lights that are meshes (emissive quads), changed by moving their node and by the
// emission of their material.
#pragma once

#include <optional>

#include "apps/limn/light_edits.h"

namespace limn::app {

/// The one light that a node's rigid mesh is.
struct MeshLight {
  int node, material;
  bool shared;  ///< the mesh belongs to several nodes: its material is not this light's own
};
/// Nothing for lights that are no such mesh: see isEditable().
std::optional<MeshLight> meshLightOf(const scene::Scene& scene, const scene::Pose& pose, int light);

/// Throws UsageError for what a shared mesh cannot do.
void applyToMesh(scene::Scene& scene, const scene::Pose& pose, int light, const MeshLight& mesh,
                 const LightEdit& edit);
LightEdit describeMesh(const scene::Scene& scene, const glsl::Light& light, const MeshLight& mesh);

/// Right-handed axes of a light that shines along -z.
glm::mat3 axesOf(const glsl::Light& light);

}  // namespace limn::app
