// Declares how light_edits changes the nodes of lights, and lights that are meshes (emissive quads): by their
// node's transform and by the emission of their material.
#pragma once

#include <optional>

#include "core/session/light_edits.h"

namespace limn::session {

/// Identifies the node and material of a rigid mesh that is one light.
struct MeshLight {
  int node, material;
  bool shared;  ///< the mesh belongs to several nodes: its material is not this light's own
};
/// Says whether a light is a mesh that has no area now, and therefore gives no light and has neither size nor
/// rotation.
bool withoutArea(const glsl::Light& light);
/// Says whether an emissive quad has no area at rest, or is no light then, in the animation, so that what
/// edits make of it depends on the time at which they are applied (AtRest).
bool appearsLater(const scene::Scene& scene, int animation);
/// Returns the mesh of a light, or nothing for lights that are not such a mesh: see isEditable(). It may have
/// no area in `pose`.
std::optional<MeshLight> meshLightOf(const scene::Scene& scene, const scene::Pose& pose, int light);

/// Changes the node and the material of such a light; leaves one as it is that has no area, neither at rest
/// nor in `pose`. Throws UsageError for edits that a shared mesh does not allow.
void applyToMesh(scene::Scene& scene, const scene::Pose& pose, int animation, int light,
                 const MeshLight& mesh, const LightEdit& edit);
/// Returns the current values of such a light: without size, colour and intensity when its mesh is shared.
LightEdit describeMesh(const scene::Scene& scene, const glsl::Light& light, const MeshLight& mesh);

/// Holds a light and its node where no animation has moved them yet, so that what is made of them is the same
/// whatever the time is: at the start of the one that `pose` is of. A mesh that is no light there, or has no
/// area, is held as it is now.
struct AtRest {
  glsl::Light light;
  glm::mat4 nodeToWorld;
};
AtRest atRest(const scene::Scene& scene, const scene::Pose& pose, int animation, int light, int node);

/// Returns the transform to the world that a light has there.
glm::mat4 frameOf(const glm::mat3& axes, const glm::vec3& position);
/// Returns the right-handed axes of a light that shines along -z.
glm::mat3 axesOf(const glsl::Light& light);

}  // namespace limn::session
