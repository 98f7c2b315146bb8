// Declares where a surface lies in its material's height map, and which light the bumps around it let pass.
#pragma once

#include <glm/glm.hpp>

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
  bool lit(const glm::vec3& direction) const { return !field || leaves(direction); }

 private:
  bool leaves(const glm::vec3& direction) const;
};

/// Returns the place of a texture coordinate on a base with that normal and tangent in world space (any
/// length; w: the sign of the bitangent, which points up the texture, negated where object to world is a
/// mirroring). A vanishing normal or tangent, or a coordinate that is not finite, leaves the base without
/// bumps.
ReliefPlace reliefPlace(const relief::HeightField& field, const glm::vec2& uv, const glm::vec3& normal,
                        const glm::vec4& tangent);

}  // namespace limn::reference
