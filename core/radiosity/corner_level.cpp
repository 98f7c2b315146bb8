#include "core/radiosity/private/corner_level.h"

#include <algorithm>
#include <mutex>

#include "core/radiosity/private/unit_cell.h"
#include "glsl/numeric/octahedral_grid.glsl"

namespace limn::radiosity {
namespace {

/// Adds what is below a cell: a third of a cell's weight belongs to each of its corners.
void addCells(int levelsLeft, uint32_t n, const UnitCell& cell, CornerLevel& level) {
  if (levelsLeft > 0) {
    glm::vec3 middles[3];
    cell.middles(middles);
    for (uint32_t k = 0; k < 4; ++k) addCells(levelsLeft - 1, n, cell.child(k, middles), level);
    return;
  }
  // The numbers of its corners: those around its centre.
  const glm::vec3 centre = cell.centre();
  const glm::uvec3 corners = glsl::octahedral_grid_place(centre, n).corner;
  const float weight = cellWeight(cell.corners[0], cell.corners[1], cell.corners[2]) / 3;
  for (int i = 0; i < 3; ++i) {
    level.weights[corners[i]] += weight;
    level.edgeCosine = std::min(level.edgeCosine, glm::dot(cell.corners[i], cell.corners[(i + 1) % 3]));
  }
}

CornerLevel made(int levelIndex) {
  const uint32_t n = 1u << levelIndex, size = glsl::octahedral_grid_size(n);
  const int side = static_cast<int>(n);
  CornerLevel level;
  level.directions.resize(size);
  level.weights.assign(size, 0);
  for (int j = -side; j <= side; ++j)
    for (int i = -(side - std::abs(j)); i <= side - std::abs(j); ++i) {
      const auto up = static_cast<float>(side - std::abs(i) - std::abs(j));
      level.directions[glsl::octahedral_grid_index({i, j}, n)] =
          glm::normalize(glm::vec3(float(i), float(j), up));
    }
  for (uint32_t face = 0; face < DirectionalTree::kFaces; ++face)
    addCells(levelIndex, n, UnitCell::face(face), level);
  return level;
}

}  // namespace

const CornerLevel& cornerLevel(int level) {
  static std::once_flag flags[DirectionalTree::kMaxUniformLevel + 1];
  static CornerLevel levels[DirectionalTree::kMaxUniformLevel + 1];
  std::call_once(flags[level], [&] { levels[level] = made(level); });
  return levels[level];
}

}  // namespace limn::radiosity
