// Triangle meshes as the generator builds them: indexed, counter-clockwise seen from outside, metres, Y up.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

namespace limn::assets {

struct Mesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;                ///< unit length, one per position
  std::vector<glm::vec2> uvs;                    ///< one per position; v runs down the picture as in glTF
  std::vector<glm::vec4> tangents;               ///< empty, or one per position (w: handedness)
  std::vector<glm::tvec4<std::uint8_t>> joints;  ///< empty, or one per position
  std::vector<glm::vec4> weights;                ///< empty, or one per position; each sums to 1
  std::vector<std::uint32_t> indices;

  std::size_t triangleCount() const { return indices.size() / 3; }
};

/// Adds `part` to `mesh`, moved by `transform` (rotation, translation and positive scale; normals follow).
void append(Mesh& mesh, const Mesh& part, const glm::mat4& transform = glm::mat4(1));

/// `mesh` moved by `transform`.
Mesh transformed(const Mesh& mesh, const glm::mat4& transform);

/// Multiplies the texture coordinates.
void scaleUv(Mesh& mesh, glm::vec2 factor);

/// Binds every vertex to one joint.
void bindToJoint(Mesh& mesh, int joint);

/// Binds every vertex to two joints: `blend(position)` in [0, 1] is the weight of `second`.
void bindToJoints(Mesh& mesh, int first, int second, const std::function<float(glm::vec3)>& blend);

/// Per-vertex tangents from the texture coordinates (area-weighted, made orthogonal to the normal).
void computeTangents(Mesh& mesh);

/// Tangents along circles about the Y axis, by the texture coordinate that lathe(), sphere() and torus() lay
/// around it: a body turned on a lathe has its grooves there.
void brushAlongCircles(Mesh& mesh);

/// Tangents across those circles: along the radii of a disc, and the meridians of a sphere.
void brushAlongRadii(Mesh& mesh);

/// Smooth normals: the area-weighted mean of the triangles around each vertex.
void computeNormals(Mesh& mesh);

glm::mat4 translation(glm::vec3 offset);
glm::mat4 scaling(glm::vec3 factor);
/// Rotation by `degrees` about `axis`.
glm::mat4 rotation(float degrees, glm::vec3 axis);
/// The rotation that takes -Z to `direction`, with +Y as close to `up` as it can be.
glm::quat facing(glm::vec3 direction, glm::vec3 up = {0, 1, 0});

}  // namespace limn::assets
