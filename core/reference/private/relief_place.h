// Declares where a surface lies in its material's height map, and which light the bumps around it let pass.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/relief/height_field.h"
#include "glsl/numeric/geometry.glsl"

namespace limn::reference {

/// Holds a place in a field of heights over a base that counts as flat: what leaves the field goes on from
/// the base's point.
struct ReliefPlace {
  const relief::HeightField* field = nullptr;  ///< null: no bumps
  glm::dvec2 place{0};                         ///< in texels
  glsl::Frame frame{};                         ///< t along rising u, b along rising v, n off the base; world

  /// Returns W for light from `direction` (unit): whether a ray from the field's surface above the place
  /// leaves the field. Light from below the base plane arrives nowhere, light on a surface without bumps
  /// everywhere.
  bool lit(const glm::vec3& direction) const { return abovePlane(direction) && !bumpAlong(direction); }
  /// Returns whether `direction` points to above the base plane, as what leaves the field does; true without
  /// bumps.
  bool abovePlane(const glm::vec3& direction) const { return !field || glm::dot(frame.n, direction) > 0.f; }
  /// Returns where a ray along `direction` (unit), which may point to below the base plane, meets the field:
  /// nothing where it leaves, or without bumps.
  std::optional<glm::dvec2> bumpAlong(const glm::vec3& direction) const;
  /// Returns the unit tangent in world space, with the sign of the bitangent as meshes have it.
  glm::vec4 tangent() const;
  /// Returns the place as a texture coordinate of the map's own tile.
  glm::vec2 uv() const;
};

/// Returns the place of a texture coordinate on a base with that normal and tangent in world space (any
/// length; w: the sign of the bitangent, which points up the texture, negated where object to world is a
/// mirroring). A vanishing normal or tangent, or a coordinate that is not finite, leaves the base without
/// bumps.
ReliefPlace reliefPlace(const relief::HeightField& field, const glm::vec2& uv, const glm::vec3& normal,
                        const glm::vec4& tangent);

}  // namespace limn::reference
