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

/// What is said of one light; the rest is the file's.
struct LightEdit {
  std::optional<glm::vec3> position;  ///< world, metres; the light then stays there, whatever animations say
  /// Pitch, yaw and roll in degrees: a light that shines along -z is rolled about z, then pitched about x,
  /// then turned about y.
  std::optional<glm::vec3> rotation;
  std::optional<glm::vec2>
      size;  ///< sides in metres; of directional lights x is the angular diameter, radians
  std::optional<glm::vec3> colour;
  std::optional<float> intensity;  ///< W/sr; directional: W/m^2
  bool operator==(const LightEdit&) const = default;
};
using LightEdits = std::map<std::string, LightEdit>;  ///< by name

/// NAME.PROPERTY=VALUE each. Throws UsageError naming the properties and what they accept.
LightEdits parseLightEdits(const std::vector<std::string>& settings);
/// The settings that say the same, to the bit.
std::vector<std::string> printed(const LightEdits& edits);

/// Changes the lights of `scene`, whose pose is `pose` (it is not changed). Throws UsageError for a light
/// that is not there or is no light of a node (emissive quads and parts of an environment are not), and for a
/// property that it does not have.
void applyLightEdits(scene::Scene& scene, const scene::Pose& pose, const LightEdits& edits);

/// Whether light `index` of a pose belongs to a node, so that it can be edited.
bool isEditable(const scene::Scene& scene, int index);
/// What the light is now, with every property that it has.
LightEdit describeLight(const scene::Scene& scene, const scene::Pose& pose, int index);

/// The rotation that pitch, yaw and roll (degrees) stand for, and one of those that stand for it.
glm::mat3 rotationOf(const glm::vec3& degrees);
glm::vec3 anglesOf(const glm::mat3& rotation);

}  // namespace limn::app
