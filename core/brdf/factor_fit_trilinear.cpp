#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/brdf/factor_fit_kinds.h"

namespace limn::brdf {
namespace {

using glm::dvec3;
using glm::ivec3;
using glm::vec3;

/// Gives each texel without a value the mean of its neighbours that have one, layer by layer outwards.
void fillUnknown(FactorTable& table, std::vector<char>& known) {
  const ivec3 size(table.width, table.height, table.depth);
  const auto index = [&](const ivec3& p) {
    return static_cast<std::size_t>((p.z * size.y + p.y) * size.x + p.x);
  };
  constexpr std::array<ivec3, 6> kNeighbours{ivec3(-1, 0, 0), ivec3(1, 0, 0),  ivec3(0, -1, 0),
                                             ivec3(0, 1, 0),  ivec3(0, 0, -1), ivec3(0, 0, 1)};
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<char> next = known;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const ivec3 p(x, y, z);
          if (known[index(p)]) continue;
          vec3 sum(0);
          int count = 0;
          for (const ivec3& step : kNeighbours) {
            const ivec3 q = p + step;
            if (glm::any(glm::lessThan(q, ivec3(0))) || glm::any(glm::greaterThanEqual(q, size))) continue;
            if (!known[index(q)]) continue;
            sum += table.texels[index(q)];
            ++count;
          }
          if (count == 0) continue;
          table.texels[index(p)] = sum / static_cast<float>(count);
          next[index(p)] = 1;
          changed = true;
        }
    known = std::move(next);
  }
}

}  // namespace

FactoredBrdf fitTrilinear(const Brdf& brdf, const FitSettings& settings) {
  const int across = std::max(settings.texels / 2, 2);
  FactorTable table{settings.texels, across, across, settings.format, {}};
  std::vector<char> known;
  const dvec3 last(table.width - 1, table.height - 1, table.depth - 1);
  double largest = 0;
  for (int z = 0; z < table.depth; ++z)
    for (int y = 0; y < table.height; ++y)
      for (int x = 0; x < table.width; ++x) {
        const dvec3 place = dvec3(x, y, z) / last;
        const double q = (1 - place.x) * (1 - place.x), theta = place.y * std::numbers::pi / 2,
                     phi = place.z * std::numbers::pi / 2;
        dvec3 l, v;
        directionsOf({q * std::sqrt(2 - q * q), 0, 1 - q * q},
                     {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}, l,
                     v);
        const bool above = l.z > 1e-3 && v.z > 1e-3;
        const dvec3 f = above ? brdf(l, v) : dvec3(0);
        known.push_back(above && finite(f) ? 1 : 0);
        table.texels.emplace_back(finite(f) ? glm::max(f, dvec3(0)) : dvec3(0));
        const vec3& texel = table.texels.back();
        largest = std::max(largest, static_cast<double>(std::max({texel.x, texel.y, texel.z})));
      }
  fillUnknown(table, known);
  FactoredBrdf fit;
  fit.factorisation = Factorisation::trilinear;
  fit.name = fmt::format("trilinear {} x {} x {}", table.width, table.height, table.depth);
  if (largest > 0) {
    fit.scale = dvec3(largest);
    for (vec3& texel : table.texels) texel /= static_cast<float>(largest);
  }
  table.round();
  fit.tables.push_back(std::move(table));
  return fit;
}

}  // namespace limn::brdf
