#include "core/radiosity/illumination.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace limn::radiosity {

std::vector<glm::vec4> binTable(int resolution) {
  const auto n = static_cast<uint32_t>(resolution);
  std::vector<glm::vec4> table;
  for (uint32_t bin = 0; bin < 6 * n * n; ++bin)
    table.emplace_back(glm::normalize(glsl::bin_direction(bin, n)), glsl::bin_solid_angle(bin, n));
  return table;
}

void gather(const Forest& forest, const Links& links, std::span<const glm::vec4> table,
            std::span<const glm::vec3> outgoing, std::span<const glm::vec3> environment,
            std::span<glm::vec3> irradiance) {
  const auto groups = forest.groups();
  tbb::parallel_for(0u, forest.levels()[0].count, [&](uint32_t g) {
    for (uint32_t lane = 0; lane < groups[g].lanes; ++lane) {
      const int k = static_cast<int>(lane);
      const glm::vec3 normal(groups[g].nx[k], groups[g].ny[k], groups[g].nz[k]);
      const auto row = links.of(4 * g + lane);
      glm::vec3 sum(0);
      float weights = 0;
      for (size_t bin = 0; bin < row.size(); ++bin) {
        const float weight = table[bin].w * glm::dot(normal, glm::vec3(table[bin]));
        if (!(weight > 0)) continue;
        weights += weight;
        const uint32_t link = row[bin];
        if (link == glsl::no_link) {
          if (!environment.empty()) sum += weight * environment[bin];
        } else if ((link & glsl::link_back) == 0 && !outgoing.empty()) {
          sum += weight * outgoing[link];
        }
      }
      irradiance[4 * g + lane] = weights > 0 ? glsl::pi / weights * sum : glm::vec3(0);
    }
  });
}

void pullUp(const Forest& forest, std::span<glm::vec3> outgoing) {
  const auto groups = forest.groups();
  const auto levels = forest.levels();
  for (size_t level = 1; level < levels.size(); ++level)
    tbb::parallel_for(levels[level].first, levels[level].first + levels[level].count, [&](uint32_t g) {
      for (uint32_t lane = 0; lane < groups[g].lanes; ++lane) {
        const uint32_t children = groups[g].children + lane;
        glm::vec3 sum(0);
        float area = 0;
        for (uint32_t k = 0; k < groups[children].lanes; ++k) {
          const float share = groups[children].area[static_cast<int>(k)];
          sum += share * outgoing[4 * children + k];
          area += share;
        }
        outgoing[4 * g + lane] = sum / std::max(area, 1e-37f);
      }
    });
}

}  // namespace limn::radiosity
