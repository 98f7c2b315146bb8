#include "core/relief/slopes.h"

#include <algorithm>

#include "glsl/numeric/mip_weights.glsl"

namespace limn::relief {
namespace {

/// Steeper slopes would make the squares in a normal's length infinite.
constexpr double kSteepest = 1e15;

SlopeLevel halved(const SlopeLevel& fine) {
  SlopeLevel coarse{glm::max(fine.size / 2, glm::ivec2(1)), {}};
  for (int y = 0; y < coarse.size.y; ++y) {
    const glm::vec3 rows = glsl::mip_weights(y, fine.size.y, coarse.size.y);
    for (int x = 0; x < coarse.size.x; ++x) {
      const glm::vec3 columns = glsl::mip_weights(x, fine.size.x, coarse.size.x);
      glm::vec2 sum(0);
      for (int r = 0; r < 3 && rows[r] > 0; ++r)
        for (int c = 0; c < 3 && columns[c] > 0; ++c)
          sum += rows[r] * columns[c] *
                 fine.slopes[static_cast<std::size_t>(2 * y + r) * static_cast<std::size_t>(fine.size.x) +
                             static_cast<std::size_t>(2 * x + c)];
      coarse.slopes.push_back(sum);
    }
  }
  return coarse;
}

}  // namespace

std::vector<SlopeLevel> slopeLevels(const HeightField& field) {
  std::vector<SlopeLevel> levels{{field.size(), {}}};
  for (int y = 0; y < field.size().y; ++y)
    for (int x = 0; x < field.size().x; ++x)
      levels[0].slopes.emplace_back(glm::clamp(field.slope({x, y}), -kSteepest, kSteepest));
  while (levels.back().size != glm::ivec2(1)) levels.push_back(halved(levels.back()));
  return levels;
}

}  // namespace limn::relief
