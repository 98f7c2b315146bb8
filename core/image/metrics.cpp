#include "core/image/metrics.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/private/flip.h"
#include "core/image/private/row_filter.h"
#include "glsl/numeric/srgb.glsl"

namespace limn {
namespace {

/// Runs per row and adds the rows' results in order, so that the sum does not depend on the number of
/// threads.
template <class Value, class RowSum>
Value sumRows(int height, RowSum rowSum) {
  std::vector<Value> rows(static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) { rows[static_cast<std::size_t>(y)] = rowSum(y); });
  Value total{};
  for (const Value& row : rows) total += row;
  return total;
}

/// R, G, B of every pixel, interleaved. Throws Error at the first value that is not finite.
std::vector<float> finiteRgb(const Image& image, const char* role) {
  const std::array<int, 3> rgb = image.rgbChannels();
  std::vector<float> values(image.pixelCount() * 3);
  const auto badInRow = [&](int y) {
    int bad = 0;
    for (int x = 0; x < image.width(); ++x) {
      const std::span<const float> pixel = image.pixel(x, y);
      float* out = &values[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
                                static_cast<std::size_t>(x))];
      for (std::size_t c = 0; c < 3; ++c) {
        out[c] = pixel[static_cast<std::size_t>(rgb[c])];
        const bool counted = c > 0 && rgb[c] == rgb[0];  // of a picture with a single channel
        bad += std::isfinite(out[c]) || counted ? 0 : 1;
      }
    }
    return bad;
  };
  const int bad = sumRows<int>(image.height(), badInRow);
  if (bad == 0) return values;
  const std::size_t first = static_cast<std::size_t>(
      std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); }) - values.begin());
  const std::size_t width = static_cast<std::size_t>(image.width());
  throw Error(
      fmt::format("compare: the {} has {} values that are not finite, the first at pixel ({}, {}): {}", role,
                  bad, first / 3 % width, first / 3 / width, values[first]));
}

/// A channel that may be missing.
class OptionalChannel {
 public:
  OptionalChannel(const Image& image, const char* name) : image_(image), channel_(image.findChannel(name)) {}
  explicit operator bool() const { return channel_.has_value(); }
  float at(int x, int y) const { return image_.at(x, y, *channel_); }

 private:
  const Image& image_;
  std::optional<int> channel_;
};

struct MaskCounts {
  std::size_t covered = 0;    // in either picture
  std::size_t different = 0;  // of these, in coverage, id or depth
  MaskCounts& operator+=(const MaskCounts& other) {
    covered += other.covered;
    different += other.different;
    return *this;
  }
};

/// Decides pixel by pixel whether both pictures see the same surface.
class SurfaceMask {
 public:
  SurfaceMask(const Image& image, const Image& reference, const CompareOptions& options)
      : coverage_{OptionalChannel{image, "coverage"}, OptionalChannel{reference, "coverage"}},
        undefined_{OptionalChannel{image, "masked"}, OptionalChannel{reference, "masked"}},
        id_{OptionalChannel{image, "id"}, OptionalChannel{reference, "id"}},
        depth_{OptionalChannel{image, "Z"}, OptionalChannel{reference, "Z"}},
        depthTolerance_(options.depthTolerance),
        background_(options.background) {}

  /// True where the pixel is to be compared; adds to `counts`.
  bool keeps(int x, int y, MaskCounts& counts) const {
    for (const OptionalChannel& channel : undefined_) {
      if (channel && channel.at(x, y) >= 0.5f) return false;
    }
    const bool first = !coverage_[0] || coverage_[0].at(x, y) >= 0.5f;
    const bool second = !coverage_[1] || coverage_[1].at(x, y) >= 0.5f;
    if (!first && !second) return background_;
    if (first != second) {
      if (!coverage_[0] || !coverage_[1]) return false;  // only one picture knows its background
      ++counts.covered;
      ++counts.different;
      return false;
    }
    ++counts.covered;
    const bool same = sameId(x, y) && sameDepth(x, y);
    counts.different += same ? 0 : 1;
    return same;
  }

 private:
  bool sameId(int x, int y) const { return !id_[0] || !id_[1] || id_[0].at(x, y) == id_[1].at(x, y); }
  bool sameDepth(int x, int y) const {
    if (!depth_[0] || !depth_[1]) return true;
    const double z = depth_[0].at(x, y), r = depth_[1].at(x, y);
    // False for NaN, and where one depth is infinite (no surface): the tolerance would be infinite, too.
    return z == r || (std::isfinite(r) && std::abs(z - r) <= depthTolerance_ * std::abs(r));
  }

  std::array<OptionalChannel, 2> coverage_, undefined_, id_, depth_;
  double depthTolerance_;
  bool background_;
};

void applySurfaceMask(const Image& image, const Image& reference, const CompareOptions& options,
                      Comparison& result) {
  const SurfaceMask mask(image, reference, options);
  const MaskCounts counts = sumRows<MaskCounts>(image.height(), [&](int y) {
    MaskCounts row;
    unsigned char* out = &result.mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width())];
    for (int x = 0; x < image.width(); ++x) out[x] = mask.keeps(x, y, row) ? 1 : 0;
    return row;
  });
  result.metrics.masked_share =
      counts.covered == 0 ? 0.0 : static_cast<double>(counts.different) / static_cast<double>(counts.covered);
  if (result.metrics.masked_share > options.maxMaskedShare) {
    throw Error(
        fmt::format("compare: {:.3f} % of the covered pixels differ in coverage, instance or depth; at most "
                    "{:.3f} % is accepted",
                    100 * result.metrics.masked_share, 100 * options.maxMaskedShare));
  }
}

/// Nearest-rank percentile; reorders `values`.
double percentile(std::vector<float>& values, double fraction) {
  const std::size_t rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The sums behind the metrics, over the compared pixels of two RGB pictures.
class ErrorSums {
 public:
  ErrorSums(std::span<const float> image, std::span<const float> reference, int width, int height,
            std::span<const unsigned char> mask)
      : image_(image),
        reference_(reference),
        width_(static_cast<std::size_t>(width)),
        height_(height),
        mask_(mask) {}

  void evaluate(Metrics& metrics) const {
    const double values = 3.0 * static_cast<double>(metrics.pixels);
    const double mean = sum([](double, double r) { return r; }) / values;
    metrics.bias = sum([](double x, double r) { return x - r; }) / values;
    metrics.rmse = std::sqrt(sum([](double x, double r) { return (x - r) * (x - r); }) / values);
    metrics.rel_mse = sum([&](double x, double r) {
                        const double square = (x - r) * (x - r);
                        return square == 0.0 ? 0.0 : square / (r * r + 1e-2 * mean * mean);
                      }) /
                      values;
    std::vector<float> errors, peaks;
    collectLuminance(errors, peaks);
    metrics.p999 = percentile(errors, 0.999);
    metrics.psnr = 20.0 * std::log10(std::max(percentile(peaks, 0.999), 0.0) / metrics.rmse);
    if (metrics.rmse == 0.0) metrics.psnr = std::numeric_limits<double>::infinity();
    metrics.structured = std::sqrt(structuredSquares() / values);
  }

 private:
  template <class Term>
  double sum(Term term) const {
    return sumRows<double>(height_, [&](int y) {
      double row = 0;
      const std::size_t first = static_cast<std::size_t>(y) * width_;
      for (std::size_t i = first; i < first + width_; ++i) {
        if (!mask_[i]) continue;
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) row += term(image_[c], reference_[c]);
      }
      return row;
    });
  }

  void collectLuminance(std::vector<float>& errors, std::vector<float>& peaks) const {
    for (std::size_t i = 0; i < mask_.size(); ++i) {
      if (!mask_[i]) continue;
      const auto luminance = [i](std::span<const float> values) {
        return glsl::luminance({values[3 * i], values[3 * i + 1], values[3 * i + 2]});
      };
      errors.push_back(std::abs(luminance(image_) - luminance(reference_)));
      peaks.push_back(luminance(reference_));
    }
  }

  /// Sum of squares of the filtered error; weights are renormalised over the compared pixels of each window.
  double structuredSquares() const {
    constexpr int kBandRows = 32;
    const int bands = (height_ + kBandRows - 1) / kBandRows;
    return sumRows<double>(bands, [&](int band) {
      const int first = band * kBandRows, count = std::min(kBandRows, height_ - first);
      return structuredBand(first, count);
    });
  }

  double structuredBand(int first, int count) const {
    static constexpr int kRadius = 4;
    static constexpr double kSigma = 2.0;
    std::array<float, 2 * kRadius + 1> taps{};
    for (int t = -kRadius; t <= kRadius; ++t) {
      taps[static_cast<std::size_t>(t + kRadius)] =
          static_cast<float>(std::exp(-t * t / (2 * kSigma * kSigma)));
    }
    // Three error planes and the mask, filtered along the rows.
    std::vector<Rows> planes(4, Rows(width_, static_cast<std::size_t>(count + 2 * kRadius)));
    for (int i = 0; i < count + 2 * kRadius; ++i) {
      const int y = first - kRadius + i;
      if (y < 0 || y >= height_) continue;
      for (std::size_t c = 0; c < 4; ++c) {
        std::vector<float> padded(width_ + 2 * kRadius);
        for (std::size_t x = 0; x < width_; ++x) {
          const std::size_t pixel = static_cast<std::size_t>(y) * width_ + x;
          if (!mask_[pixel]) continue;
          padded[x + kRadius] = c == 3 ? 1.0f : image_[3 * pixel + c] - reference_[3 * pixel + c];
        }
        filterAlongRow(padded, taps, planes[c][static_cast<std::size_t>(i)]);
      }
    }
    double squares = 0;
    Rows filtered(width_, 4);
    for (int row = 0; row < count; ++row) {
      for (std::size_t c = 0; c < 4; ++c) {
        filterAcrossRows(planes[c], static_cast<std::size_t>(row), taps, filtered[c]);
      }
      for (std::size_t x = 0; x < width_; ++x) {
        if (!mask_[static_cast<std::size_t>(first + row) * width_ + x]) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          const double error = static_cast<double>(filtered[c][x]) / static_cast<double>(filtered[3][x]);
          squares += error * error;
        }
      }
    }
    return squares;
  }

  std::span<const float> image_, reference_;
  std::size_t width_;
  int height_;
  std::span<const unsigned char> mask_;
};

/// Display values, linear: clamp(2^ev * radiance, 0, 1).
std::vector<float> displayed(std::vector<float> radiance, float exposureEv) {
  const float scale = std::exp2(exposureEv);
  for (float& value : radiance) value = std::clamp(value * scale, 0.0f, 1.0f);
  return radiance;
}

/// The mean of the FLIP map, which becomes 0 where nothing is compared.
double meanFlip(Comparison& result) {
  double total = 0;
  for (std::size_t i = 0; i < result.flipMap.size(); ++i) {
    if (!result.mask[i]) result.flipMap[i] = 0.0f;
    total += result.flipMap[i];
  }
  return total / static_cast<double>(result.metrics.pixels);
}

/// The mean of the channel over the compared pixels.
double meanVariance(const Image& reference, int channel, const Comparison& result) {
  const double sum = sumRows<double>(reference.height(), [&](int y) {
    double row = 0;
    const auto first = static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width());
    for (int x = 0; x < reference.width(); ++x) {
      if (!result.mask[first + static_cast<std::size_t>(x)]) continue;
      const double value = reference.at(x, y, channel);
      row += value >= 0 ? value : std::numeric_limits<double>::quiet_NaN();
    }
    return row;
  });
  if (!std::isfinite(sum))
    throw Error("compare: the reference's channel 'variance' has other values than numbers >= 0");
  return sum / static_cast<double>(result.metrics.pixels);
}

/// Noise differs between the parts of a picture: that of the compared pixels counts where the reference says
/// it of each. A picture of another program may say it of the whole alone.
std::optional<double> noiseFloor(const Image& reference, std::span<const float> rgb,
                                 const Comparison& result) {
  if (const std::optional<int> variance = reference.findChannel("variance"))
    return 3.0 * std::sqrt(meanVariance(reference, *variance, result));
  const auto found = reference.metadata().find("noise_rms");
  if (found == reference.metadata().end()) return std::nullopt;
  const std::optional<double> relative = parseNumber(found->second);
  if (!relative || *relative < 0) {
    throw Error(fmt::format("compare: the reference's noise_rms is '{}'; a number >= 0 is accepted",
                            oneLine(found->second, 60)));
  }
  double mean = 0;
  for (const float value : rgb) mean += value;
  return 3.0 * *relative * std::abs(mean) / static_cast<double>(rgb.size());
}

void checkComparable(const Image& image, const Image& reference) {
  if (image.empty() || reference.empty()) throw Error("compare: an empty picture");
  if (image.width() != reference.width() || image.height() != reference.height()) {
    throw Error(fmt::format("compare: the image has {}x{} pixels, the reference {}x{}; they must be equal",
                            image.width(), image.height(), reference.width(), reference.height()));
  }
}

/// Keeps the pixels whose reference, R, lies in the open interval.
void narrow(std::vector<unsigned char>& mask, std::span<const float> reference,
            std::pair<float, float> range) {
  const auto [low, high] = range;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!(reference[3 * i] > low && reference[3 * i] < high)) mask[i] = 0;
  }
}

std::size_t comparedPixels(const Comparison& result) {
  return static_cast<std::size_t>(std::count(result.mask.begin(), result.mask.end(), 1));
}

/// What is known of the compared pixels: all metrics but their number and the masked share. `x` and `r` are
/// R, G, B of the two pictures.
void evaluate(std::span<const float> x, std::span<const float> r, const Image& reference,
              Comparison& result) {
  ErrorSums(x, r, result.width, result.height, result.mask).evaluate(result.metrics);
  result.metrics.flip = meanFlip(result);
  result.metrics.noise_floor = noiseFloor(reference, r, result);
}

}  // namespace

Comparison compareImagesDetailed(const Image& image, const Image& reference, const CompareOptions& options) {
  checkComparable(image, reference);
  const std::vector<float> x = finiteRgb(image, "image");
  const std::vector<float> r = finiteRgb(reference, "reference");
  Comparison result;
  result.width = image.width();
  result.height = image.height();
  result.mask.assign(image.pixelCount(), 1);
  if (options.useMask) applySurfaceMask(image, reference, options, result);
  if (options.maskTermRange) narrow(result.mask, r, *options.maskTermRange);
  result.metrics.pixels = comparedPixels(result);
  if (result.metrics.pixels == 0) throw Error("compare: no pixel is left to compare");
  result.flipMap = flipMap(displayed(x, options.exposureEv), displayed(r, options.exposureEv), result.width,
                           result.height);
  evaluate(x, r, reference, result);
  return result;
}

Metrics compareImages(const Image& image, const Image& reference, const CompareOptions& options) {
  return compareImagesDetailed(image, reference, options).metrics;
}

std::optional<Metrics> metricsWithin(const Image& image, const Image& reference, const Comparison& whole,
                                     std::pair<float, float> range) {
  checkComparable(image, reference);
  if (whole.width != image.width() || whole.height != image.height())
    throw Error(fmt::format("compare: the image has {}x{} pixels, the comparison {}x{}; they must be equal",
                            image.width(), image.height(), whole.width, whole.height));
  const std::vector<float> x = finiteRgb(image, "image");
  const std::vector<float> r = finiteRgb(reference, "reference");
  Comparison part = whole;
  narrow(part.mask, r, range);
  part.metrics.pixels = comparedPixels(part);
  if (part.metrics.pixels == 0) return std::nullopt;
  evaluate(x, r, reference, part);
  return part.metrics;
}

}  // namespace limn
