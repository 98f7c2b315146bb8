#include "core/image/error_spectrum.h"

#include <fmt/format.h>
#include <kissfft/kiss_fftnd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <type_traits>

#include "core/base/error.h"

namespace limn {
namespace {

/// A plane of complex values and its transform.
class Plane {
 public:
  Plane(int width, int height) : width_(extended(width)), height_(extended(height)) {
    const int sides[] = {height_, width_};
    plan_.reset(kiss_fftnd_alloc(sides, 2, 0, nullptr, nullptr));
    if (!plan_) throw std::bad_alloc();
    values_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    transformed_.resize(values_.size());
  }

  kiss_fft_cpx& value(int x, int y) { return values_[index(x, y)]; }
  void transform() { kiss_fftnd(plan_.get(), values_.data(), transformed_.data()); }

  /// Adds the power of every frequency to its ring, and 1 to the ring's count.
  void addPower(std::span<double> power, std::span<double> count) const {
    for (int y = 0; y < height_; ++y) {
      const double v = static_cast<double>(std::min(y, height_ - y)) / height_;
      for (int x = 0; x < width_; ++x) {
        const double u = static_cast<double>(std::min(x, width_ - x)) / width_;
        const auto ring = static_cast<std::size_t>(2 * kSpectrumBins * std::hypot(u, v));
        if (ring >= power.size()) continue;
        const kiss_fft_cpx& c = transformed_[index(x, y)];
        power[ring] += static_cast<double>(c.r) * c.r + static_cast<double>(c.i) * c.i;
        count[ring] += 1;
      }
    }
  }

 private:
  /// Every ring has a frequency, and no side a prime factor beyond 5.
  static int extended(int side) { return kiss_fft_next_fast_size(std::max(side, 2 * kSpectrumBins)); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  struct Free {
    void operator()(kiss_fftnd_cfg plan) const { kiss_fft_free(plan); }
  };

  int width_, height_;
  std::vector<kiss_fft_cpx> values_, transformed_;
  std::unique_ptr<std::remove_pointer_t<kiss_fftnd_cfg>, Free> plan_;
};

}  // namespace

std::vector<double> errorSpectrum(const Image& image, const Image& reference,
                                  std::span<const unsigned char> mask) {
  if (image.width() != reference.width() || image.height() != reference.height() ||
      mask.size() != image.pixelCount()) {
    throw Error(fmt::format(
        "spectrum: the image has {}x{} pixels, the reference {}x{}, the mask {}; they must be equal",
        image.width(), image.height(), reference.width(), reference.height(), mask.size()));
  }
  std::vector<double> power(kSpectrumBins), count(kSpectrumBins);
  const auto pixels = static_cast<double>(std::count(mask.begin(), mask.end(), 1));
  if (pixels == 0) return power;
  Plane plane(image.width(), image.height());
  const std::array<int, 3> x = image.rgbChannels(), r = reference.rgbChannels();
  // R + iG, then B: a ring holds f and -f, over which the power of a complex plane is that of its two parts.
  for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
    for (int row = 0; row < image.height(); ++row) {
      const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width());
      for (int column = 0; column < image.width(); ++column) {
        if (mask[first + static_cast<std::size_t>(column)] != 1) continue;
        const auto error = [&](std::size_t i) {
          return image.at(column, row, x[i]) - reference.at(column, row, r[i]);
        };
        plane.value(column, row) = {error(c), c == 0 ? error(1) : 0.0f};
      }
    }
    plane.transform();
    plane.addPower(power, count);
  }
  constexpr double kChannels = 3, kTransforms = 2;  // the count is the transforms', too
  for (std::size_t b = 0; b < power.size(); ++b) power[b] *= kTransforms / (kChannels * count[b] * pixels);
  return power;
}

}  // namespace limn
