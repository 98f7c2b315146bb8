// Handles surface elements within bodies, such as those of a floor below a block that stands on it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/base/export.h"

namespace limn::radiosity {

struct Surfels;

/// Elements look from this part of their disc's radius above it, unless told otherwise: bodies stand on
/// floors with a face of their own in the same plane.
inline constexpr double kDefaultLift = 0.02;

/// Finds the surface elements within bodies and moves them out. Closed bodies have no backs, so that an
/// element inside one would see the light outside, and light interpolated between vertices would shine out
/// along the edge where the body stands. These elements are never visible; they take the place of the nearest
/// ones outside along the mesh, and so their light, as lightmaps are dilated.
///
/// A body is a connected piece of a single-sided object that has volume. It may enclose elements of its own,
/// as where a limb grows out of a body: of those whose centre lies within and whose vertex does not, as in a
/// crease, the place is that of the vertex. Open pieces enclose only their own: other elements within them
/// see backs, which are black, and are meant to. Their inside is where the generalized winding number is more
/// than a half (Jacobson et al. 2013).
class LIMN_API Bodies {
 public:
  Bodies() = default;
  /// Takes the topology from the surfels, and from where they are which pieces have volume. `lift` is in
  /// radii of an element's disc.
  explicit Bodies(const Surfels& surfels, double lift = kDefaultLift);
  /// Moves the positions of enclosed elements out. Elements of a piece that is enclosed as a whole stay. Uses
  /// all cores; allocates nothing once it has seen as many enclosed elements.
  void leave(Surfels& surfels);

 private:
  struct Range {
    uint32_t first = 0, end = 0;
  };
  struct Box {
    glm::vec3 low{0}, high{0};
  };
  /// Holds a point that may lie in a body, and the winding number of the body's surface around it.
  struct Query {
    glm::vec2 place;
    float height;
    uint32_t surfel;
    int winding;
    unsigned char bit;  ///< what of the element it is, if within
  };
  struct Piece {
    Range surfels;              ///< of order_
    Range triangles;            ///< of triangles_
    uint32_t firstOfHoles = 0;  ///< of the triangles that close holes
    bool solid = false;
    Box bounds;
    std::vector<Query> queries, sorted;
    std::vector<Query> inside;  ///< of all queries those that lie in the body
    std::vector<uint32_t> firstOfCell;

    bool open() const { return firstOfHoles < triangles.end; }
  };
  /// Holds corners: surfels, or behind them all the middles of holes.
  using Triangle = std::array<uint32_t, 3>;

  /// Pieces that are passed over together where none of them meets a body.
  static constexpr size_t kBlock = 32;

  void gatherPieces(const Surfels& surfels);
  void update(const Surfels& surfels);
  double volume(const Surfels& surfels, const Piece& piece) const;
  std::array<glm::vec3, 3> corners(const Surfels& surfels, uint32_t triangle) const;
  void find(const Surfels& surfels, Piece& body) const;
  void wind(const Surfels& surfels, Piece& body) const;
  void leaveHoles(const Surfels& surfels, Piece& body) const;

  float lift_ = 0;  ///< radii of an element's disc
  std::vector<Piece> pieces_;
  std::vector<uint32_t> order_;  ///< surfels, those of a piece together
  std::vector<Triangle> triangles_;
  /// Holds a vertex of a hole's outline.
  struct Rim {
    uint32_t surfel, hole;
  };
  std::vector<Rim> rims_;
  std::vector<glm::vec4> holes_;         ///< sums of their outlines' vertices, and how many
  std::vector<uint32_t> fromLeft_;       ///< pieces by their bounds' low x
  std::vector<Box> blocks_;              ///< bounds of each kBlock pieces of fromLeft_
  std::vector<unsigned char> enclosed_;  ///< of each surfel: what is known of it
  struct Move {
    uint32_t from, to;
  };
  std::vector<uint32_t> waiting_, ring_;
  std::vector<Move> moves_;
};

}  // namespace limn::radiosity
