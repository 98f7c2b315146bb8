#include "core/image/greedy_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace limn {
namespace {

double luminance(const glm::dvec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

/// Sums over rectangles of texels in constant time.
class Sums {
 public:
  Sums(int width, int height)
      : width_(width),
        height_(height),
        sums_(static_cast<size_t>(width + 1) * static_cast<size_t>(height + 1)) {}

  /// `value(index of a texel)`.
  template <class Value>
  void fill(const Value& value) {
    for (int y = 0; y < height_; ++y) {
      double row = 0;
      for (int x = 0; x < width_; ++x) {
        row += value(static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x));
        at(x + 1, y + 1) = at(x + 1, y) + row;
      }
    }
  }

  double over(const Region& r) const {
    return std::max(0.0, at(r.x1, r.y1) - at(r.x0, r.y1) - at(r.x1, r.y0) + at(r.x0, r.y0));
  }

 private:
  double at(int x, int y) const {
    return sums_[static_cast<size_t>(y) * static_cast<size_t>(width_ + 1) + static_cast<size_t>(x)];
  }
  double& at(int x, int y) {
    return sums_[static_cast<size_t>(y) * static_cast<size_t>(width_ + 1) + static_cast<size_t>(x)];
  }

  int width_, height_;
  std::vector<double> sums_;
};

/// The state of one decomposition.
class Decomposition {
 public:
  Decomposition(const TexelGrid& grid, double threshold, RegionShape shape)
      : grid_(grid),
        threshold_(threshold),
        shape_(shape),
        brightness_(grid.energy.size()),
        left_(grid.energy.size(), 1.0),
        covers_(grid.energy.size(), 0),
        energy_(grid.width, grid.height),
        uncovered_(grid.width, grid.height),
        measure_(grid.width, grid.height) {
    for (size_t i = 0; i < brightness_.size(); ++i) brightness_[i] = luminance(grid.energy[i]);
    measure_.fill([&](size_t i) { return grid_.measure[i]; });
  }

  /// The next region, or nothing when everything that emits is covered.
  std::optional<Region> next() {
    const std::optional<size_t> start = brightestUncovered();
    if (!start) return std::nullopt;
    energy_.fill([&](size_t i) { return left_[i] * brightness_[i]; });
    uncovered_.fill([&](size_t i) { return covers_[i] == 0 ? brightness_[i] : 0; });
    const int x = static_cast<int>(*start) % grid_.width, y = static_cast<int>(*start) / grid_.width;
    Region region{x, y, x + 1, y + 1};
    while (grow(region)) {
    }
    take(region);
    return region;
  }

  /// Gives what is left of each texel to the regions that cover it.
  void distributeRest(std::vector<Region>& regions) const {
    for (Region& region : regions)
      forEachTexel(region,
                   [&](size_t i) { region.energy += left_[i] / double(covers_[i]) * grid_.energy[i]; });
  }

 private:
  template <class Function>
  void forEachTexel(const Region& region, const Function& function) const {
    for (int y = region.y0; y < region.y1; ++y)
      for (int x = region.x0; x < region.x1; ++x)
        function(static_cast<size_t>(y) * static_cast<size_t>(grid_.width) + static_cast<size_t>(x));
  }

  std::optional<size_t> brightestUncovered() const {
    std::optional<size_t> best;
    for (size_t i = 0; i < brightness_.size(); ++i)
      if (covers_[i] == 0 && brightness_[i] > (best ? brightness_[*best] : 0)) best = i;
    return best;
  }

  bool inside(const Region& r) const {
    return r.x0 >= 0 && r.y0 >= 0 && r.x1 <= grid_.width && r.y1 <= grid_.height;
  }

  bool grow(Region& region) const {
    return shape_ == RegionShape::squares ? growSquare(region) : growSides(region);
  }

  /// One texel row on each side where it pays.
  bool growSides(Region& region) const {
    bool grown = false;
    constexpr std::array<std::array<int, 4>, 4> sides{
        {{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    for (const auto& side : sides) {
      const Region larger = moved(region, side);
      if (!inside(larger) || !pays(region, larger, 1)) continue;
      region = larger;
      grown = true;
    }
    return grown;
  }

  /// Towards the corner where the most energy that no region covers lies, or else the most of what is left.
  bool growSquare(Region& region) const {
    constexpr std::array<std::array<int, 4>, 4> corners{
        {{-1, -1, 0, 0}, {0, -1, 1, 0}, {-1, 0, 0, 1}, {0, 0, 1, 1}}};
    std::optional<Region> best;
    for (const auto& corner : corners) {
      const Region larger = moved(region, corner);
      if (!inside(larger)) continue;
      const auto gain = [&](const Region& r) { return std::pair(uncovered_.over(r), energy_.over(r)); };
      if (!best || gain(larger) > gain(*best)) best = larger;
    }
    if (!best || !pays(region, *best, 2)) return false;
    region = *best;
    return true;
  }

  static Region moved(Region r, const std::array<int, 4>& by) {
    return {r.x0 + by[0], r.y0 + by[1], r.x1 + by[2], r.y1 + by[3]};
  }

  bool pays(const Region& region, const Region& larger, double sides) const {
    const double total = energy_.over(larger);
    return total > 0 && total - energy_.over(region) > sides * threshold_ * total;
  }

  /// Energy per measure of the texels around the region; 0 where there are none.
  double densityAround(const Region& region) const {
    const Region around{std::max(region.x0 - 1, 0), std::max(region.y0 - 1, 0),
                        std::min(region.x1 + 1, grid_.width), std::min(region.y1 + 1, grid_.height)};
    const double measure = measure_.over(around) - measure_.over(region);
    return measure > 1e-9 * measure_.over(around)
               ? std::max(0.0, energy_.over(around) - energy_.over(region)) / measure
               : 0;
  }

  void take(Region& region) {
    const double density = densityAround(region);
    forEachTexel(region, [&](size_t i) {
      ++covers_[i];
      if (!(brightness_[i] > 0)) return;
      const double residual = std::min(left_[i], density * grid_.measure[i] / brightness_[i]);
      region.energy += (left_[i] - residual) * grid_.energy[i];
      left_[i] = residual;
    });
  }

  const TexelGrid& grid_;
  double threshold_;
  RegionShape shape_;
  std::vector<double> brightness_;
  std::vector<double> left_;  ///< share of each texel's energy that no region took
  std::vector<int> covers_;   ///< regions over each texel
  Sums energy_;               ///< of the luminance that is left
  Sums uncovered_;            ///< of the luminance of texels that no region covers
  Sums measure_;
};

}  // namespace

std::vector<Region> greedyRegions(const TexelGrid& grid, double threshold, RegionShape shape, int mostRegions,
                                  const char* what) {
  if (!(threshold > 0 && threshold < 1))
    throw UsageError(fmt::format("{}: threshold {} is not accepted; expected more than 0 and less than 1",
                                 what, threshold));
  Decomposition decomposition(grid, threshold, shape);
  std::vector<Region> regions;
  while (const std::optional<Region> region = decomposition.next()) {
    if (static_cast<int>(regions.size()) == mostRegions)
      throw UsageError(
          fmt::format("{}: the threshold {} asks for more than {} lights; a smaller one gives fewer", what,
                      threshold, mostRegions));
    regions.push_back(*region);
  }
  decomposition.distributeRest(regions);
  return regions;
}

}  // namespace limn
