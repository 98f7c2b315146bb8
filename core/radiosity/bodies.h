// Handles surface elements within closed bodies of other objects, such as those of a floor below a block that
// stands on it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/base/export.h"

namespace limn::radiosity {

struct Surfels;

/// Elements look from this part of their disc's radius above it, unless told otherwise: bodies stand on
/// floors with a face of their own in the same plane.
inline constexpr double kDefaultLift = 0.02;

/// Finds the surface elements within closed bodies and moves them out. Closed bodies have no backs, so that
/// an element inside one would see the light outside, and light interpolated between vertices would shine out
/// along the edge where the body stands. These elements are never visible; they take the place of the nearest
/// ones outside along the mesh, and so their light, as lightmaps are dilated.
class LIMN_API Bodies {
 public:
  Bodies() = default;
  /// Takes the topology alone from the surfels. `lift` is in radii of an element's disc.
  explicit Bodies(const Surfels& surfels, double lift = kDefaultLift);
  /// Moves the positions of enclosed elements to those of neighbours outside. Elements of an object that is
  /// enclosed as a whole stay. Uses all cores; allocates nothing once it has seen as many enclosed elements.
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
  };
  struct Object {
    Range surfels, triangles;  ///< triangles: of their corners
    bool closed = false;
    Box bounds;
    std::vector<Query> queries, sorted;
    std::vector<uint32_t> firstOfCell;
  };
  void find(const Surfels& surfels, Object& body) const;
  static void wind(const Surfels& surfels, Object& body);

  float lift_ = 0;  ///< radii of an element's disc
  std::vector<Object> objects_;
  std::vector<unsigned char> enclosed_;  ///< of each surfel
  struct Move {
    uint32_t from, to;
  };
  std::vector<uint32_t> waiting_;
  std::vector<Move> moves_;
};

}  // namespace limn::radiosity
