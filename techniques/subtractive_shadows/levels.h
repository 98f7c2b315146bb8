// Declares the levels of detail between which a frame's time is kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::subtractive_shadows {

struct Level {
  int lights = 1;  ///< whose shadows are found
  int block = 1;   ///< side of the blocks of pixels that share shadows
  bool operator==(const Level&) const = default;

  /// Returns the work of a frame in units of its own: lights times maps and items, which cost about as much
  /// where blocks have four pixels a side.
  double work() const { return lights * (1 + 16.0 / (block * block)); }
};

/// Returns levels from the cheapest to `best`: the lights grow by sqrt(2), and where fewer than kFewestLights
/// would be too many still, blocks are larger.
inline std::vector<Level> levelsBelow(const Level& best) {
  constexpr int kFewestLights = 8, kLargestBlock = 32;
  std::vector<Level> levels{best};
  for (double lights = best.lights / std::sqrt(2.0); static_cast<int>(lights) > kFewestLights;
       lights /= std::sqrt(2.0))
    levels.push_back({static_cast<int>(lights), best.block});
  const int fewest = std::min(best.lights, kFewestLights);
  if (fewest < best.lights) levels.push_back({fewest, best.block});
  for (int block = 2 * best.block; block <= std::min(4 * best.block, kLargestBlock); block *= 2)
    levels.push_back({fewest, block});
  std::ranges::reverse(levels);
  return levels;
}

/// Says what a frame shows: a picture between those of two levels, or of one level twice.
struct Fade {
  Level fewer, more;
  float shareOfMore = 0;
};

/// Returns what a frame at `position` on the way to level `target` shows. On the way these are the level that
/// is left, or was reached, and the one that is next, even where the picture is that of one of them.
inline Fade fadeAt(const std::vector<Level>& levels, double position, int target) {
  const double below = target < position ? std::ceil(position) - 1 : std::floor(position);
  const auto lower = static_cast<size_t>(below);
  const size_t upper = position == target ? lower : std::min(lower + 1, levels.size() - 1);
  return {levels[lower], levels[upper], static_cast<float>(position - below)};
}

}  // namespace limn::subtractive_shadows
