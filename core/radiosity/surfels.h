// Makes surface elements at the vertices of meshes (thesis, section 4.3.1): oriented discs whose areas add up
// to the meshes'.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/radiosity/bodies.h"

namespace limn::radiosity {

/// Holds the triangles of one object; positions and normals of all objects are in one space.
struct TriangleMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit, one per position
  std::vector<glm::vec2> uvs;      ///< one per position, or none
  std::vector<uint32_t> indices;   ///< 3 per triangle
  bool doubleSided = false;        ///< elements on both sides
};

/// Declares a point of an object as a combination of its vertices, with which a surface element moves.
struct SurfelOrigin {
  std::array<uint32_t, 3> vertices{};
  glm::vec3 weights{1, 0, 0};
  float side = 1;  ///< -1: the back of a double-sided object
};

struct Surfels {
  std::vector<uint32_t> objects;  ///< of each surfel
  /// Surfel i has the origins [firstOrigin[i], firstOrigin[i + 1]). The first one gives its position; its
  /// normal is the mean of all.
  std::vector<uint32_t> firstOrigin;
  std::vector<SurfelOrigin> origins;
  std::vector<glm::vec3> vertices;   ///< where triangles meet
  std::vector<glm::vec3> positions;  ///< of the discs' centres
  std::vector<glm::vec3> normals;
  std::vector<float> areas;  ///< a third of those of the adjacent triangles
  std::vector<float>
      discs;  ///< radius of a disc around the position that covers this third, unless that is long and narrow
  std::vector<uint32_t> clusters;   ///< of each surfel: the coarsest surface element that it is part of
  std::vector<uint32_t> triangles;  ///< 3 surfels each; those of backs have the winding of backs
  std::vector<unsigned char>
      backless;  ///< of each object: closed or double-sided, so that no ray meets a back
  std::vector<unsigned char> doubleSided;  ///< of each object
  uint32_t clusterCount = 0;
  std::vector<uint32_t> pieces;  ///< of each surfel: the connected piece of its object that it is part of
  uint32_t pieceCount = 0;
  /// Holds an edge of a piece's outline, as a triangle that closed the hole would have it.
  struct Rim {
    uint32_t from = 0, to = 0;  ///< surfels
    uint32_t hole = 0;          ///< of holeCount: edges that are connected bound one hole
  };
  std::vector<Rim> rims;
  uint32_t holeCount = 0;
  /// Holds a neighbour, and what it weighs in centre(); those of surfel i are [firstNeighbour[i],
  /// firstNeighbour[i + 1]).
  struct Neighbour {
    uint32_t surfel = 0;
    float weight = 0;
  };
  std::vector<uint32_t> firstNeighbour;
  std::vector<Neighbour> neighbours;

  size_t size() const { return vertices.size(); }
  /// Returns the neighbours of surfel i, each once.
  std::span<const Neighbour> neighboursOf(size_t i) const {
    return std::span(neighbours).subspan(firstNeighbour[i], firstNeighbour[i + 1] - firstNeighbour[i]);
  }
  /// Returns the centre of surfel i for other positions of the vertices: the centroid of its third of the
  /// adjacent triangles, moved along the normal into the vertex's tangent plane. On smooth surfaces that is
  /// nearly the vertex; at the edge of a wall it lies inside the wall's face instead of on the next wall,
  /// where half of what it saw would lie behind that one. Where triangles rise above the tangent plane, in
  /// hollows and on saddles, it lies as high as they do on average, in front of them: from behind it would
  /// see what is outside.
  glm::vec3 centre(size_t i, std::span<const glm::vec3> at, const glm::vec3& normal) const {
    glm::vec3 offset(0);
    float rise = 0;
    for (const Neighbour& n : neighboursOf(i)) {
      const glm::vec3 to = n.weight * (at[n.surfel] - at[i]);
      offset += to;
      rise += std::max(glm::dot(to, normal), 0.f);
    }
    return at[i] + offset + (rise - glm::dot(offset, normal)) * normal;
  }
};

/// Returns the surfels of the objects. Lengths are in units of the scene's radius. Vertices at the same place
/// (within 2^-22) whose normals differ by less than 45 degrees are one surfel; triangles without area and
/// vertices without triangles are ignored. Edges longer than `longestEdge` are halved until none is;
/// triangles that share an edge share the points on it.
///
/// Clusters are the charts of the texture coordinates; for an object without any, they are its connected
/// pieces whose normals have the same dominant axis. Clusters of fewer than 16 surfels are joined, by axis.
/// `lift` is as Bodies has it. Throws UsageError as soon as there are more than `most` surfels, or four times
/// as many triangles between them: how many halved edges make is not known before.
LIMN_API Surfels createSurfels(std::span<const TriangleMesh> objects, float longestEdge,
                               double lift = kDefaultLift, size_t most = std::numeric_limits<size_t>::max());

}  // namespace limn::radiosity
