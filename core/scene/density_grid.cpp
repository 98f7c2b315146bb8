#include "core/scene/density_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace limn::scene {
namespace {

/// From world space to voxels, whose centres have whole coordinates.
struct VoxelLine {
  glm::dvec3 origin, direction;
};

VoxelLine inVoxels(const DensityGrid& grid, const glm::vec3& origin, const glm::vec3& direction) {
  const glm::dmat4 toBox(grid.worldToBox);
  const glm::dvec3 size(grid.size);
  return {glm::dvec3(toBox * glm::dvec4(glm::dvec3(origin), 1)) * size - 0.5,
          glm::dmat3(toBox) * glm::dvec3(direction) * size};
}

/// The part of range.x < t < range.y in the box; empty: x > y.
glm::dvec2 withinBox(const VoxelLine& line, const glm::dvec3& size, glm::dvec2 range) {
  for (int axis = 0; axis < 3; ++axis) {
    const double o = line.origin[axis], d = line.direction[axis];
    if (d == 0) {
      if (!(o > -0.5 && o < size[axis] - 0.5)) return {1, 0};
      continue;
    }
    const double a = (-0.5 - o) / d, b = (size[axis] - 0.5 - o) / d;
    range = {std::max(range.x, std::min(a, b)), std::min(range.y, std::max(a, b))};
  }
  return range;
}

double interpolated(const DensityGrid& grid, const glm::dvec3& voxels) {
  const glm::dvec3 last(grid.size - 1);
  const glm::dvec3 p = glm::clamp(voxels, glm::dvec3(0), last);
  const glm::ivec3 low = glm::min(glm::ivec3(p), grid.size - 1), high = glm::min(low + 1, grid.size - 1);
  const glm::dvec3 w = p - glm::dvec3(low);
  const auto value = [&](int x, int y, int z) {
    return static_cast<double>(
        grid.values[(static_cast<size_t>(z) * static_cast<size_t>(grid.size.y) + static_cast<size_t>(y)) *
                        static_cast<size_t>(grid.size.x) +
                    static_cast<size_t>(x)]);
  };
  const auto row = [&](int y, int z) { return (1 - w.x) * value(low.x, y, z) + w.x * value(high.x, y, z); };
  const auto slice = [&](int z) { return (1 - w.y) * row(low.y, z) + w.y * row(high.y, z); };
  return (1 - w.z) * slice(low.z) + w.z * slice(high.z);
}

glm::mat4 toBox(const Smoke& smoke) {
  glm::mat4 result(1);
  for (int axis = 0; axis < 3; ++axis) {
    const float side = smoke.high[axis] - smoke.low[axis];
    result[axis][axis] = 1 / side;
    result[3][axis] = -smoke.low[axis] / side;
  }
  return result;
}

}  // namespace

void setGrid(Medium& medium, DensityGrid grid) {
  medium.smoke.reset();
  medium.grid.reset();
  if (std::ranges::all_of(grid.values, [](float v) { return v == 0; }))
    medium.sigmaA = medium.sigmaS = glm::vec3(0);
  else
    medium.grid = std::make_shared<const DensityGrid>(std::move(grid));
}

float densityAt(const DensityGrid& grid, const glm::vec3& place) {
  const VoxelLine line = inVoxels(grid, place, glm::vec3(0));
  for (int axis = 0; axis < 3; ++axis)
    if (!(line.origin[axis] >= -0.5 && line.origin[axis] <= grid.size[axis] - 0.5)) return 0;
  return static_cast<float>(interpolated(grid, line.origin));
}

double densityLength(const DensityGrid& grid, const glm::vec3& origin, const glm::vec3& direction, float from,
                     float to) {
  const VoxelLine line = inVoxels(grid, origin, direction);
  const glm::dvec2 range = withinBox(line, glm::dvec3(grid.size), {from, to});
  if (!(range.x < range.y)) return 0;
  // Amanatides and Woo 1987, A Fast Voxel Traversal Algorithm: t of the next plane across each axis.
  glm::dvec3 next(std::numeric_limits<double>::infinity()), step = next;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = line.direction[axis], start = line.origin[axis] + range.x * d;
    if (d == 0) continue;
    const double plane = d > 0 ? std::floor(start) + 1 : std::ceil(start) - 1;
    next[axis] = (plane - line.origin[axis]) / d;
    step[axis] = 1 / std::abs(d);
  }
  constexpr double node = 0.57735026918962576;  // of Gauss's rule with two nodes, whose weights are 1
  double sum = 0, t = range.x;
  while (t < range.y) {
    const double end = std::min(range.y, std::min(next.x, std::min(next.y, next.z)));
    const double half = 0.5 * (end - t), middle = t + half;
    if (half > 0)
      sum += half * (interpolated(grid, line.origin + (middle - half * node) * line.direction) +
                     interpolated(grid, line.origin + (middle + half * node) * line.direction));
    for (int axis = 0; axis < 3; ++axis) {
      if (next[axis] > end) continue;
      // From so far that t has fewer digits than there are voxels in between, planes cannot be told apart.
      const double further = next[axis] + step[axis];
      next[axis] = further > next[axis] ? further : std::numeric_limits<double>::infinity();
    }
    t = std::max(t, end);
  }
  return sum;
}

glm::ivec3 smokeVoxels(const Smoke& smoke) {
  const glm::vec3 extent = smoke.high - smoke.low;
  const float longest = std::max({extent.x, extent.y, extent.z});
  const glm::vec3 sides = extent * (static_cast<float>(smoke.resolution) / longest);
  return glm::clamp(glm::ivec3(glm::round(sides)), glm::ivec3(2), glm::ivec3(smoke.resolution));
}

glsl::SmokeBlock smokeBlock(const Smoke& smoke, double time) {
  glsl::SmokeBlock block{};
  block.low = smoke.low;
  block.risen = static_cast<float>(static_cast<double>(smoke.rise) * time);
  block.high = smoke.high;
  block.whirl = smoke.whirl;
  block.voxels = glm::uvec3(smokeVoxels(smoke));
  block.seed = smoke.seed;
  return block;
}

DensityGrid smokeAt(const Smoke& smoke, double time) {
  const glsl::SmokeBlock block = smokeBlock(smoke, time);
  DensityGrid grid;
  grid.size = smokeVoxels(smoke);
  grid.worldToBox = toBox(smoke);
  const glm::ivec3 n = grid.size;
  grid.values.resize(static_cast<size_t>(n.x) * static_cast<size_t>(n.y) * static_cast<size_t>(n.z));
  tbb::parallel_for(0, n.z, [&](int z) {
    float* out = grid.values.data() + static_cast<size_t>(z) * static_cast<size_t>(n.x * n.y);
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const glm::vec3 share = (glm::vec3(x, y, z) + 0.5f) / glm::vec3(n);
        *out++ = glsl::smoke_density(block.low, block.high, block.risen, block.whirl, block.seed,
                                     glm::mix(smoke.low, smoke.high, share));
      }
  });
  return grid;
}

Smoke smokeIn(const Bounds& bounds) {
  // Where there is nothing yet a box of 1 m, since one without a size has no voxels.
  const bool some = bounds.radius() > 0;
  const glm::vec3 low = some ? bounds.low : bounds.centre() - 0.5f;
  const glm::vec3 high = some ? bounds.high : bounds.centre() + 0.5f;
  const glm::vec3 extent = high - low;
  const float size = 0.5f * glm::length(extent);
  Smoke smoke;
  // A flat scene has room for smoke, too.
  smoke.low = low - 0.01f * size;
  smoke.high = glm::max(high, low + 0.25f * size);
  smoke.whirl = 0.25f * std::max({extent.x, extent.y, extent.z});
  smoke.rise = 0.1f * size;
  return smoke;
}

glm::mat4 mediumToBox(const Medium& medium) {
  if (medium.grid) return medium.grid->worldToBox;
  return medium.smoke ? toBox(*medium.smoke) : glm::mat4(1);
}

}  // namespace limn::scene
