// Lights put elsewhere, turned, resized or recoloured from outside the scene's file: --set-light.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace limn::app {

/// What is said of one light; the rest is the file's. A light that is a mesh (an emissive quad) takes its
/// whole node along.
struct LightEdit {
  std::optional<glm::dvec3>
      position;  ///< the file's world, metres; the light then stays there, whatever animations say
  /// Pitch, yaw and roll in degrees: a light that shines along -z is rolled about z, then pitched about x,
  /// then turned about y.
  std::optional<glm::vec3> rotation;
  std::optional<glm::vec2>
      size;  ///< sides in metres; of directional lights x is the angular diameter, radians
  /// Of rectangles and meshes: radiance = colour * intensity / area.
  std::optional<glm::vec3> colour;
  std::optional<float> intensity;  ///< W/sr; directional: W/m^2
  bool operator==(const LightEdit&) const = default;
};
using LightEdits = std::map<std::string, LightEdit>;  ///< by name

/// NAME.PROPERTY=VALUE each. Throws UsageError naming the properties and what they accept.
LightEdits parseLightEdits(const std::vector<std::string>& settings);
/// The settings that say the same, to the bit.
std::vector<std::string> printed(const LightEdits& edits);

/// Gives every light that is a mesh of its own, and can be edited therefore, a material of its own, too, so
/// that its emission can be changed alone. Once, when the scene was loaded.
void giveOwnMaterials(scene::Scene& scene);

/// Changes the lights of `scene`, which are those of its file, and whose pose is `pose` (it is not changed).
/// Throws UsageError for a light that is not there or cannot be changed (isEditable), and for a property that
/// it does not have.
void applyLightEdits(scene::Scene& scene, const scene::Pose& pose, const LightEdits& edits);

/// Whether light `index` of a pose belongs to a node, or is a mesh: the only light that its node's mesh is,
/// of constant emission, rigid and not instanced. Of lights that share a name only the first can be edited.
bool isEditable(const scene::Scene& scene, const scene::Pose& pose, int index);
/// What an editable light is now, with every property that it has. Meshes that several nodes share have
/// neither size nor colour nor intensity here.
LightEdit describeLight(const scene::Scene& scene, const scene::Pose& pose, int index);

/// The rotation that pitch, yaw and roll (degrees) stand for, and one of those that stand for it.
glm::mat3 rotationOf(const glm::vec3& degrees);
glm::vec3 anglesOf(const glm::mat3& rotation);

}  // namespace limn::app
