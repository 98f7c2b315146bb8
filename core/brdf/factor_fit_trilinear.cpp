#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/brdf/factor_fit_kinds.h"
#include "core/brdf/factor_fit_spread.h"

namespace limn::brdf {

using glm::dvec3;
using glm::vec3;

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
  spread(table, known, 3);
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
