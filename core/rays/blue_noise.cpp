#include "core/rays/blue_noise.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace limn::rays {
namespace {

constexpr float kSigma = 1.9f;  ///< pixels, Ulichney 1993, section 4

/// Points on a torus of pixels, and how crowded each pixel is by them.
class Crowd {
 public:
  explicit Crowd(int side) : side_(side), weight_(pixels()), density_(pixels(), 0.f), set_(pixels(), false) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto dx = static_cast<float>(std::min(x, side - x)),
                   dy = static_cast<float>(std::min(y, side - y));
        weight_[index(x, y)] = std::exp(-(dx * dx + dy * dy) / (2 * kSigma * kSigma));
      }
    }
  }
  size_t pixels() const { return static_cast<size_t>(side_) * static_cast<size_t>(side_); }
  bool has(size_t pixel) const { return set_[pixel]; }
  void change(size_t pixel, bool present) {
    set_[pixel] = present;
    const float sign = present ? 1.f : -1.f;
    const int px = static_cast<int>(pixel) % side_, py = static_cast<int>(pixel) / side_;
    for (int y = 0; y < side_; ++y) {
      const size_t row = index(0, (y - py + side_) % side_);
      for (int x = 0; x < side_; ++x)
        density_[index(x, y)] += sign * weight_[row + static_cast<size_t>((x - px + side_) % side_)];
    }
  }
  /// Returns the most crowded of the points, or the least crowded of the other pixels.
  size_t extreme(bool among) const {
    size_t best = pixels();
    for (size_t i = 0; i < pixels(); ++i) {
      if (set_[i] != among) continue;
      if (best == pixels() || (among ? density_[i] > density_[best] : density_[i] < density_[best])) best = i;
    }
    return best;
  }

 private:
  size_t index(int x, int y) const { return static_cast<size_t>(y * side_ + x); }
  int side_;
  std::vector<float> weight_, density_;
  std::vector<bool> set_;
};

}  // namespace

std::vector<float> blueNoise(int side, uint32_t seed) {
  Crowd crowd(side);
  const size_t pixels = crowd.pixels(), first = pixels / 10 + 1;
  std::mt19937 random(seed);
  for (size_t set = 0; set < first;) {
    const size_t pixel = random() % pixels;
    if (crowd.has(pixel)) continue;
    crowd.change(pixel, true);
    ++set;
  }
  // The tightest cluster moves into the largest void until it comes from there.
  for (size_t moves = 0; moves < pixels; ++moves) {
    const size_t cluster = crowd.extreme(true);
    crowd.change(cluster, false);
    const size_t hole = crowd.extreme(false);
    crowd.change(hole, true);
    if (hole == cluster) break;
  }
  std::vector<float> thresholds(pixels);
  const auto rank = [&](size_t pixel, size_t number) {
    thresholds[pixel] = (static_cast<float>(number) + 0.5f) / static_cast<float>(pixels);
  };
  Crowd removed = crowd;
  for (size_t number = first; number-- > 0;) {
    const size_t cluster = removed.extreme(true);
    removed.change(cluster, false);
    rank(cluster, number);
  }
  for (size_t number = first; number < pixels; ++number) {
    const size_t hole = crowd.extreme(false);
    crowd.change(hole, true);
    rank(hole, number);
  }
  return thresholds;
}

}  // namespace limn::rays
