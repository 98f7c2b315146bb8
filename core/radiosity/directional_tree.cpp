#include "core/radiosity/directional_tree.h"

#include <algorithm>
#include <cmath>

#include "core/radiosity/private/corner_level.h"
#include "core/radiosity/private/unit_cell.h"
#include "glsl/indirect/packed_tree.glsl"
#include "glsl/materials/material_model.glsl"

namespace limn::radiosity {
namespace {

using Node = DirectionalTree::Node;

/// Adds a value to all cells below a node.
void addConstant(std::vector<Node>& nodes, uint32_t node, const glm::vec3& value) {
  nodes[node].value += value;
  const uint32_t child = nodes[node].child;
  for (uint32_t k = 0; child != 0 && k < 4; ++k) addConstant(nodes, child + k, value);
}

/// Looks for the bounds over a cone.
struct ConeSearch {
  std::span<const Node> nodes;
  glm::vec3 axis;
  Cone cone;
  bool any = false;
  DirectionBounds found;

  /// Whether the cone meets the circle around the cell's corners.
  bool meets(const UnitCell& cell) const {
    const glm::vec3 centre = cell.centre();
    return glm::dot(axis, centre) >= Cone::meeting(cone, Cone(cell.cornerCosine(centre)));
  }
  void visit(uint32_t node, const UnitCell& cell) {
    if (!meets(cell)) return;
    const Node& own = nodes[node];
    if (own.child == 0) {
      found.low = any ? glm::min(found.low, own.value) : own.value;
      found.high = any ? glm::max(found.high, own.value) : own.value;
      any = true;
      return;
    }
    glm::vec3 middles[3];
    cell.middles(middles);
    for (uint32_t k = 0; k < 4; ++k) visit(own.child + k, cell.child(k, middles));
  }
};

}  // namespace

float cellWeight(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return std::abs(glsl::triangle_projected_angle(a, b, c).z);
}

void DirectionalTree::assign(std::span<const Node> nodes) {
  nodes_.assign(nodes.begin(), nodes.end());
  corners_.clear();
}

void DirectionalTree::assignUniform(int level, std::span<const glm::vec3> corners) {
  level_ = level;
  corners_.assign(corners.begin(), corners.end());
  nodes_.clear();
}

size_t DirectionalTree::cellCount() const {
  if (uniform()) return size_t{kFaces} << (2 * level_);
  return empty() ? 0 : kFaces + 3 * ((nodes_.size() - kFaces) / 4);
}

glm::vec3 DirectionalTree::value(const glm::vec3& w) const {
  uint32_t node = glsl::octahedral_face(w);
  if (empty() || node >= kFaces) return glm::vec3(0);
  if (uniform()) {
    const glsl::OctahedralGridPlace at = glsl::octahedral_grid_place(w, 1u << level_);
    return at.weight.x * corners_[at.corner.x] + at.weight.y * corners_[at.corner.y] +
           at.weight.z * corners_[at.corner.z];
  }
  glm::vec3 place = glsl::octahedral_place(w);
  while (nodes_[node].child != 0) node = nodes_[node].child + glsl::octahedral_descend(place);
  return nodes_[node].value;
}

glm::vec3 DirectionalTree::smoothValue(const glm::vec3& w) const {
  const uint32_t face = glsl::octahedral_face(w);
  if (nodes_.empty() || face >= kFaces) return value(w);
  const glm::vec3 signs = glsl::octahedral_signs(face), place = glsl::octahedral_place(w);
  glm::vec3 inside = place;
  float edge = 1;
  for (uint32_t node = face; nodes_[node].child != 0; edge *= 0.5f)
    node = nodes_[node].child + glsl::octahedral_descend(inside);
  glm::vec3 sum(0);
  for (uint32_t i = 0; i < 6; ++i) {
    glm::vec3 tap = glsl::octahedral_tap(place, signs, edge, i);
    tap.z = std::abs(tap.z);  // the horizon mirrors
    sum += value(tap);
  }
  return sum / 6.f;
}

DirectionBounds DirectionalTree::bounds(const glm::vec3& axis, float cosine) const {
  if (uniform()) return uniformBounds(axis, cosine);
  if (empty()) return {};
  ConeSearch search{nodes_, axis, Cone(cosine), false, {}};
  for (uint32_t face = 0; face < kFaces; ++face) search.visit(face, UnitCell::face(face));
  return search.found;
}

DirectionBounds DirectionalTree::uniformBounds(const glm::vec3& axis, float cosine) const {
  const CornerLevel& level = cornerLevel(level_);
  // Corners of cells that the cone meets are at most an edge away from it.
  const float least = Cone::meeting(Cone(cosine), Cone(level.edgeCosine));
  DirectionBounds found;
  bool any = false;
  for (size_t i = 0; i < corners_.size(); ++i) {
    if (glm::dot(axis, level.directions[i]) < least) continue;
    found.low = any ? glm::min(found.low, corners_[i]) : corners_[i];
    found.high = any ? glm::max(found.high, corners_[i]) : corners_[i];
    any = true;
  }
  return found;
}

glm::vec3 DirectionalTree::flux() const {
  glm::vec3 sum(0);
  if (uniform()) {
    const CornerLevel& level = cornerLevel(level_);
    for (size_t i = 0; i < corners_.size(); ++i) sum += level.weights[i] * corners_[i];
    return sum;
  }
  if (empty()) return sum;
  for (uint32_t face = 0; face < kFaces; ++face) sum += nodes_[face].value;
  return sum * (0.25f * glsl::pi);
}

float DirectionalTree::pack(std::vector<glm::uvec2>& nodes) const {
  float brightest = 0;
  for (const Node& node : nodes_) brightest = std::max(brightest, glsl::largest_channel(node.value));
  for (const glm::vec3& corner : corners_) brightest = std::max(brightest, glsl::largest_channel(corner));
  // Never so small that dividing by it overflows.
  const float scale = std::max(brightest / glsl::packed_tree_brightest, 1e-37f);
  for (const Node& node : nodes_)
    nodes.emplace_back(node.child, glsl::shared_exponent_encode(node.value / scale));
  for (size_t i = 0; i < corners_.size(); i += 2)
    nodes.emplace_back(glsl::shared_exponent_encode(corners_[i] / scale),
                       i + 1 < corners_.size() ? glsl::shared_exponent_encode(corners_[i + 1] / scale) : 0);
  return scale;
}

void DirectionalTree::scale(const glm::vec3& factor) {
  for (Node& node : nodes_) node.value *= factor;
  for (glm::vec3& corner : corners_) corner *= factor;
}

void DirectionalTree::add(const DirectionalTree& other, float weight) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    scale(glm::vec3(weight));
    return;
  }
  for (size_t i = 0; i < corners_.size(); ++i) corners_[i] += weight * other.corners_[i];
  if (uniform()) return;
  for (uint32_t face = 0; face < kFaces; ++face) addBelow(face, other, face, weight);
}

void DirectionalTree::addBelow(uint32_t node, const DirectionalTree& other, uint32_t otherNode,
                               float weight) {
  const Node& theirs = other.nodes_[otherNode];
  if (theirs.child == 0) {
    addConstant(nodes_, node, weight * theirs.value);
    return;
  }
  if (nodes_[node].child == 0) {
    const auto child = static_cast<uint32_t>(nodes_.size());
    nodes_[node].child = child;
    nodes_.insert(nodes_.end(), 4, {nodes_[node].value, 0});
  }
  nodes_[node].value += weight * theirs.value;
  for (uint32_t k = 0; k < 4; ++k) addBelow(nodes_[node].child + k, other, theirs.child + k, weight);
}

}  // namespace limn::radiosity
