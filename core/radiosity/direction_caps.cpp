#include "core/radiosity/direction_caps.h"

#include <algorithm>

#include "core/radiosity/private/corner_level.h"
#include "core/radiosity/private/float4.h"
#include "core/radiosity/private/unit_cell.h"
#include "glsl/materials/material_model.glsl"

namespace limn::radiosity {
namespace {

/// The caps around the cells of the octahedron's first level.
struct CapPlaces {
  alignas(16) float x[DirectionCaps::kCount], y[DirectionCaps::kCount], z[DirectionCaps::kCount];
  Cone widest{1};

  CapPlaces() {
    float smallest = 1;
    size_t count = 0;
    for (uint32_t face = 0; face < 8; ++face) {
      const UnitCell whole = UnitCell::face(face);
      glm::vec3 middles[3];
      whole.middles(middles);
      for (uint32_t k = 0; k < 4; ++k, ++count) {
        const UnitCell cell = whole.child(k, middles);
        const glm::vec3 centre = cell.centre();
        x[count] = centre.x, y[count] = centre.y, z[count] = centre.z;
        smallest = std::min(smallest, cell.cornerCosine(centre));
      }
    }
    widest = Cone(smallest);
  }

  /// Returns the least cosine between an axis and the centre of a cap that the cone around it meets.
  float least(float coneCosine) const { return Cone::meeting(Cone(coneCosine), widest); }
  Float4 cosines(const glm::vec3& axis, size_t first) const {
    return splat(axis.x) * load(x + first) + splat(axis.y) * load(y + first) +
           splat(axis.z) * load(z + first);
  }
};

const CapPlaces& places() {
  static const CapPlaces caps;
  return caps;
}

Float4 where(Int4 comparison, Float4 v) {
  Int4 bits;
  std::memcpy(&bits, &v, sizeof bits);
  bits &= comparison;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}

/// Raises the bounds of all caps that a cone meets.
void raise(float* most, const glm::vec3& axis, float cosine, float value) {
  const Float4 least = splat(places().least(cosine)), raised = splat(value);
  for (size_t i = 0; i < DirectionCaps::kCount; i += 4)
    store(most + i, greater(load(most + i), where(places().cosines(axis, i) >= least, raised)));
}

struct Descent {
  std::span<const DirectionalTree::Node> nodes;
  const glsl::Frame& frame;
  float* most;

  void visit(uint32_t node, const UnitCell& cell) const {
    const DirectionalTree::Node& own = nodes[node];
    if (own.child == 0) {
      const glm::vec3 centre = cell.centre();
      raise(most, glsl::from_local(frame, centre), cell.cornerCosine(centre),
            glsl::largest_channel(own.value));
      return;
    }
    glm::vec3 middles[3];
    cell.middles(middles);
    for (uint32_t k = 0; k < 4; ++k) visit(own.child + k, cell.child(k, middles));
  }
};

}  // namespace

void DirectionCaps::include(const DirectionalTree& tree, const glsl::Frame& frame) {
  if (tree.uniform()) {
    const CornerLevel& level = cornerLevel(tree.level());
    for (size_t i = 0; i < tree.corners().size(); ++i)
      raise(most_.data(), glsl::from_local(frame, level.directions[i]), level.edgeCosine,
            glsl::largest_channel(tree.corners()[i]));
    return;
  }
  if (tree.empty()) return;
  const Descent descent{tree.nodes(), frame, most_.data()};
  for (uint32_t face = 0; face < DirectionalTree::kFaces; ++face) descent.visit(face, UnitCell::face(face));
}

void DirectionCaps::include(const DirectionCaps& other) {
  for (size_t i = 0; i < kCount; ++i) most_[i] = std::max(most_[i], other.most_[i]);
}

float DirectionCaps::most(const glm::vec3& axis, float cosine) const {
  const Float4 least = splat(places().least(cosine));
  Float4 most = splat(0);
  for (size_t i = 0; i < kCount; i += 4)
    most = greater(most, where(places().cosines(axis, i) >= least, load(most_.data() + i)));
  return std::max({most[0], most[1], most[2], most[3]});
}

}  // namespace limn::radiosity
