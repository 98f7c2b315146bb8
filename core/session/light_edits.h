// Declares edits of lights from outside the scene's file (--set-light): position, rotation, size and colour.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/scene/scene.h"

namespace limn::session {

/// Holds the new values of one light; absent values stay those of the file and of its animations. The light's
/// whole node moves, with its mesh and with what hangs on it.
struct LightEdit {
  std::optional<glm::dvec3>
      position;  ///< in the file's world, metres; the light then stays there and ignores animations
  /// Holds pitch, yaw and roll in degrees: a light that shines along -z is rolled about z, then pitched about
  /// x, then turned about y.
  std::optional<glm::vec3> rotation;
  std::optional<glm::vec2>
      size;  ///< sides in metres; of directional lights x is the angular diameter, radians
  /// Holds the colour; for rectangles and meshes radiance = colour * intensity / area.
  std::optional<glm::vec3> colour;
  std::optional<float> intensity;  ///< W/sr; directional: W/m^2
  bool operator==(const LightEdit&) const = default;
};
using LightEdits = std::map<std::string, LightEdit>;  ///< by name

/// Returns the edits of the settings, NAME.PROPERTY=VALUE each. Throws UsageError that lists the properties
/// and the values that they accept.
LIMN_API LightEdits parseLightEdits(const std::vector<std::string>& settings);
/// Returns the settings that give the same edits, to the bit.
LIMN_API std::vector<std::string> printed(const LightEdits& edits);

/// Gives every light whose mesh is its own, and that can therefore be edited, its own material as well, so
/// that its emission can be changed alone. To be called once, after the scene is loaded.
LIMN_API void giveOwnMaterials(scene::Scene& scene);

/// Changes the lights of `scene`, which must be those of its file. `pose` is the pose of that scene in
/// `animation` and is not changed; what edits leave of a light's placement is that of `pose` (followTime). A
/// mesh that has no area, neither at rest nor in `pose`, is left as it is. Throws UsageError for a light that
/// does not exist or cannot be changed (isEditable), and for a property that the light does not have.
LIMN_API void applyLightEdits(scene::Scene& scene, const scene::Pose& pose, const LightEdits& edits,
                              int animation = scene::kNone);
/// Says whether an edit sets a part of a light's placement and leaves the other one to animations, so that
/// the edits must be applied again at each time.
LIMN_API bool followTime(const LightEdits& edits);
/// Says whether an edit is one of an emissive mesh, of which applyLightEdits() may change the material.
/// Throws UsageError for a light that does not exist.
LIMN_API bool changeMeshes(const scene::Pose& pose, const LightEdits& edits);

/// Says whether light `index` of a pose can be edited: it belongs to a node, or it is the only light of its
/// node's mesh, which has constant emission and an area, is rigid and not instanced. Of lights that share a
/// name only the first can be edited.
LIMN_API bool isEditable(const scene::Scene& scene, const scene::Pose& pose, int index);
/// Returns the current values of an editable light, with every property that it has. Meshes that several
/// nodes share have neither size nor colour nor intensity here.
LIMN_API LightEdit describeLight(const scene::Scene& scene, const scene::Pose& pose, int index);

/// Returns the rotation of the given pitch, yaw and roll (degrees).
LIMN_API glm::mat3 rotationOf(const glm::vec3& degrees);
/// Returns the pitch, yaw and roll (degrees) of a rotation.
LIMN_API glm::vec3 anglesOf(const glm::mat3& rotation);

}  // namespace limn::session
