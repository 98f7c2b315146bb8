// Declares the only tangent generation of limn, for files without tangents, used by both renderers.
#pragma once

#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns one tangent per vertex: xyz is unit and perpendicular to the normal, w is the bitangent's sign, so
/// that bitangent = w * cross(normal, tangent) points up the texture, where v decreases (glTF 2.0, 3.7.2.1
/// and 3.9.3). Directions are those of MikkTSpace; the sign of w is the opposite. Each triangle's direction
/// of increasing u (Lengyel 2001, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh") is projected
/// onto the vertex's tangent plane and accumulated with the triangle's angle at the vertex as its weight; w
/// follows the winding of the majority by the same weight: mirrored halves of a texture need vertices of
/// their own (splitMirrored). A vertex without a usable direction gets any perpendicular, with w = 1.
LIMN_API std::vector<glm::vec4> generateTangents(std::span<const glm::vec3> positions,
                                                 std::span<const glm::vec3> normals,
                                                 std::span<const glm::vec2> uvs,
                                                 std::span<const uint32_t> indices);

/// Returns area-weighted vertex normals; zero for vertices without a triangle of positive area.
LIMN_API std::vector<glm::vec3> smoothNormals(std::span<const glm::vec3> positions,
                                              std::span<const uint32_t> indices);

/// Returns the unit normal of a triangle by its winding (counter-clockwise front); +Y when it has no area.
LIMN_API glm::vec3 triangleNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace limn::scene
