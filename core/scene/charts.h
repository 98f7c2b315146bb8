// Cuts the surface of a body into charts that lie flat in a texture.
//
// A chart is a connected part of the surface whose triangles look roughly along one of the six axes, seen
// along that axis, so that lengths shrink by 1 / 0.2 at most. Around it lie the triangles next to it, as far
// as light goes below the surface: what is spread in the texture then finds the light beyond a chart's
// border, too.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/export.h"

namespace limn::scene {

/// Holds one chart. Places are in metres, from its lowest corner.
struct Chart {
  int axis = 0;                        ///< x, y, z; plus 3 where the surface looks against it
  std::vector<uint32_t> triangles;     ///< its own, each of the body is in one chart
  std::vector<uint32_t> surroundings;  ///< those around it
  glm::vec2 lowest{0}, size{0};        ///< of both, in the plane across the axis
  glm::ivec2 corner{0};                ///< in the texture, texels; set by packCharts()
};

/// Returns where a point lies in the plane across an axis.
LIMN_API glm::vec2 acrossAxis(const glm::vec3& point, int axis);

/// Bounds what makeCharts() makes.
struct ChartLimits {
  size_t charts = std::numeric_limits<size_t>::max();
  size_t triangles = std::numeric_limits<size_t>::max();  ///< of the body and of all surroundings
};

/// Returns the charts of a body, or nothing where it takes more than `most`: `positions` in metres, `indices`
/// three for each triangle. Triangles without area, nearly so (a millionth of the square of their longest
/// side) or with a corner that is not finite are in none. `margin`: how far around a chart its surroundings
/// go, in metres.
LIMN_API std::optional<std::vector<Chart>> makeCharts(std::span<const glm::vec3> positions,
                                                      std::span<const uint32_t> indices, double margin,
                                                      const ChartLimits& most = {});

/// Places the charts in a square texture of `texels` x `texels`, a texel apart, as large as they fit. Returns
/// the texels per metre, 0 if they do not fit.
LIMN_API double packCharts(std::vector<Chart>& charts, int texels);

}  // namespace limn::scene
