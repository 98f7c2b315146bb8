// Declares rays from bump to bump of a height field, and the paths along which light comes to its texels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/base/export.h"
#include "core/relief/height_field.h"

namespace limn::relief {

/// Returns where a ray from the surface above `place` first meets the bilinear field, exactly (a quadratic
/// per cell), in texels; nothing where it leaves over the highest level, or runs for 64 sizes of the map. The
/// surface at `place` itself is met only by rays that go below it.
LIMN_API std::optional<glm::dvec2> traceRay(const HeightField& field, const glm::dvec2& place,
                                            const glm::dvec3& direction);

/// Names the directions that light is gathered from.
enum class BounceDirections {
  ownFrame,        ///< a spiral by the cosine about each texel's normal
  shared,          ///< one uniform spiral, down to the steepest slope below the base plane
  published,       ///< random ones, uniform over the base's hemisphere
  publishedDeeper  ///< random ones down to the steepest slope
};

/// Is one path to a texel: where its light comes from, and its share of pi, the cosine included.
struct BouncePath {
  glm::vec2 place{-1};  ///< in texels, inside of the map; -1 of the sky
  float weight = 0;

  bool hits() const { return place.x >= 0; }
};

/// Holds the paths to each texel (the maps S_i of all directions): those of one texel lie side by side, and
/// their weights add up to pi.
struct LIMN_API BouncePaths {
  int paths = 0;
  std::vector<BouncePath> list;
};

/// Takes the paths to one texel.
using BouncePathsTaker = std::function<void(std::size_t texel, std::span<const BouncePath> paths)>;

/// Traces `paths` paths to each texel and hands them to `take`, which several threads call at once; random
/// directions are the same for the same seed. Throws UsageError for less than one.
LIMN_API void traceBounces(const HeightField& field, BounceDirections directions, int paths,
                           const BouncePathsTaker& take, std::uint32_t seed = 1);

/// Returns the same paths, of all texels.
LIMN_API BouncePaths traceBounces(const HeightField& field, BounceDirections directions, int paths,
                                  std::uint32_t seed = 1);

}  // namespace limn::relief
