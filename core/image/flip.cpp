#include "core/image/private/flip.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/image/private/row_filter.h"

namespace limn {
namespace {

using Taps = std::vector<float>;

// Parameters of the paper, named as there.
constexpr double kColourExponent = 0.7;         // q_c, section 4.1.3
constexpr double kRemapBreak = 0.4;             // p_c
constexpr double kRemapValue = 0.95;            // p_t
constexpr double kFeatureExponent = 0.5;        // q_f, section 4.2.2
constexpr double kFeatureWidthDegrees = 0.082;  // w, peak to trough of the edge detector

/// One term a sqrt(pi / b) exp(-pi^2 d^2 / b) of a contrast sensitivity function in the spatial domain, d in
/// degrees (section 4.1.1, table 1).
struct Sensitivity {
  double a;
  double b;
};
constexpr Sensitivity kAchromatic{1.0, 0.0047};
constexpr Sensitivity kRedGreen{1.0, 0.0053};
constexpr Sensitivity kBlueYellow1{34.1, 0.04};
constexpr Sensitivity kBlueYellow2{13.5, 0.025};

// Linear Rec. 709 to XYZ, D65; columns are the primaries.
const glm::dmat3 kRgbToXyz(10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0,  // red
                           8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0,   // green
                           4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0);  // blue

/// Colour conversions with the white point divided out: XYZ here means XYZ / white.
struct ColourSpaces {
  ColourSpaces() {
    const glm::dvec3 white = kRgbToXyz * glm::dvec3(1.0);
    glm::dmat3 scale(1.0);
    for (int i = 0; i < 3; ++i) scale[i][i] = 1.0 / white[i];
    toXyz = glm::mat3(scale * kRgbToXyz);
    fromXyz = glm::mat3(glm::inverse(scale * kRgbToXyz));
  }

  /// Linearised CIELAB, an opponent space in which filtering is meaningful (section 4.1.1).
  glm::vec3 rgbToYcxcz(glm::vec3 rgb) const {
    const glm::vec3 xyz = toXyz * rgb;
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
  }
  glm::vec3 ycxczToRgb(glm::vec3 ycxcz) const {
    const float y = (ycxcz.x + 16.0f) / 116.0f;
    return fromXyz * glm::vec3(y + ycxcz.y / 500.0f, y, y - ycxcz.z / 200.0f);
  }
  /// CIELAB with the Hunt adjustment: chroma scaled by 0.01 L (section 4.1.2).
  glm::vec3 rgbToHuntLab(glm::vec3 rgb) const {
    constexpr float kDelta = 6.0f / 29.0f;
    glm::vec3 f = toXyz * rgb;
    for (int i = 0; i < 3; ++i) {
      f[i] =
          f[i] > kDelta * kDelta * kDelta ? std::cbrt(f[i]) : f[i] / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    }
    const float lightness = 116.0f * f.y - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (f.x - f.y), 0.01f * lightness * 200.0f * (f.y - f.z)};
  }

  glm::mat3 toXyz;
  glm::mat3 fromXyz;
};

/// HyAB: city block in lightness, Euclidean in chroma (section 4.1.3).
float hyab(glm::vec3 a, glm::vec3 b) {
  const glm::vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

/// exp(-pi^2 d^2 / b) at the pixels -radius .. radius, summing to 1; *total is the sum before.
Taps sensitivityTaps(Sensitivity s, int radius, double pixelsPerDegree, double* total) {
  std::vector<double> weights;
  *total = 0;
  for (int x = -radius; x <= radius; ++x) {
    const double degrees = x / pixelsPerDegree;
    weights.push_back(std::exp(-M_PI * M_PI * degrees * degrees / s.b));
    *total += weights.back();
  }
  Taps taps;
  for (const double weight : weights) taps.push_back(static_cast<float>(weight / *total));
  return taps;
}

/// Positive taps sum to 1, negative ones to -1.
Taps balanced(const std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (const double w : weights) (w > 0 ? positive : negative) += std::abs(w);
  Taps taps;
  for (const double w : weights) {
    taps.push_back(static_cast<float>(w > 0 ? w / positive : negative > 0 ? w / negative : 0));
  }
  return taps;
}

/// All filters are separable, or for blue-yellow the sum of two that are.
struct Filters {
  explicit Filters(double pixelsPerDegree) {
    const double widest = std::max({kAchromatic.b, kRedGreen.b, kBlueYellow1.b, kBlueYellow2.b});
    colourRadius =
        static_cast<int>(std::ceil(3.0 * std::sqrt(widest / (2.0 * M_PI * M_PI)) * pixelsPerDegree));
    double total = 0, sum1 = 0, sum2 = 0;
    achromatic = sensitivityTaps(kAchromatic, colourRadius, pixelsPerDegree, &total);
    redGreen = sensitivityTaps(kRedGreen, colourRadius, pixelsPerDegree, &total);
    blueYellow1 = sensitivityTaps(kBlueYellow1, colourRadius, pixelsPerDegree, &sum1);
    blueYellow2 = sensitivityTaps(kBlueYellow2, colourRadius, pixelsPerDegree, &sum2);
    const double share1 = kBlueYellow1.a * std::sqrt(M_PI / kBlueYellow1.b) * sum1 * sum1;
    const double share2 = kBlueYellow2.a * std::sqrt(M_PI / kBlueYellow2.b) * sum2 * sum2;
    blueYellowShare1 = static_cast<float>(share1 / (share1 + share2));

    // Section 4.2.1: first and second derivative of a Gaussian.
    const double deviation = 0.5 * kFeatureWidthDegrees * pixelsPerDegree;
    featureRadius = static_cast<int>(std::ceil(3.0 * deviation));
    std::vector<double> gaussian, first, second;
    for (int x = -featureRadius; x <= featureRadius; ++x) {
      gaussian.push_back(std::exp(-x * x / (2.0 * deviation * deviation)));
      first.push_back(-x * gaussian.back());
      second.push_back((x * x / (deviation * deviation) - 1.0) * gaussian.back());
    }
    smooth = balanced(gaussian);
    edge = balanced(first);
    point = balanced(second);
  }

  int radius() const { return std::max(colourRadius, featureRadius); }

  int colourRadius;
  Taps achromatic, redGreen, blueYellow1, blueYellow2;
  float blueYellowShare1;
  int featureRadius;
  Taps smooth, edge, point;
};

/// What is compared, for one row of one picture.
struct RowFeatures {
  explicit RowFeatures(std::size_t width) : colour(width), edge(width), point(width) {}
  std::vector<glm::vec3> colour;  ///< filtered, Hunt-adjusted CIELAB
  std::vector<float> edge;        ///< magnitude of the edge response
  std::vector<float> point;       ///< magnitude of the point response
};

/// Filters a band of rows of one picture: along the rows once for the band and its surroundings, then across.
class Band {
 public:
  Band(std::span<const float> pixels, int width, int height, int firstRow, int rowCount,
       const Filters& filters, const ColourSpaces& spaces)
      : filters_(filters),
        spaces_(spaces),
        width_(static_cast<std::size_t>(width)),
        horizontal_(kPlaneCount, Rows(width_, static_cast<std::size_t>(rowCount + 2 * filters.radius()))) {
    for (int i = 0; i < rowCount + 2 * filters.radius(); ++i) {
      const int y = std::clamp(firstRow - filters.radius() + i, 0, height - 1);
      filterRow(pixels.subspan(static_cast<std::size_t>(y) * width_ * 3, width_ * 3),
                static_cast<std::size_t>(i));
    }
  }

  /// `row` counts from the first row of the band.
  void evaluate(std::size_t row, RowFeatures& result) const {
    evaluateColour(row, result);
    evaluateFeature(row, filters_.edge, kEdge, result.edge);
    evaluateFeature(row, filters_.point, kPoint, result.point);
  }

 private:
  enum Plane { kA, kRg, kBy1, kBy2, kSmooth, kEdge, kPoint, kPlaneCount };

  void filterRow(std::span<const float> rgb, std::size_t target) {
    const std::size_t radius = static_cast<std::size_t>(filters_.radius());
    std::array<std::vector<float>, 3> padded;
    for (auto& values : padded) values.resize(width_ + 2 * radius);
    for (std::size_t i = 0; i < width_ + 2 * radius; ++i) {
      const std::size_t x = std::clamp(i, radius, radius + width_ - 1) - radius;
      const glm::vec3 value = spaces_.rgbToYcxcz({rgb[3 * x], rgb[3 * x + 1], rgb[3 * x + 2]});
      for (int c = 0; c < 3; ++c) padded[static_cast<std::size_t>(c)][i] = value[c];
    }
    const auto apply = [&](std::size_t source, const Taps& taps, Plane plane) {
      const std::size_t skip = radius - taps.size() / 2;
      filterAlongRow(std::span(padded[source]).subspan(skip), taps, horizontal_[plane][target]);
    };
    apply(0, filters_.achromatic, kA);
    apply(1, filters_.redGreen, kRg);
    apply(2, filters_.blueYellow1, kBy1);
    apply(2, filters_.blueYellow2, kBy2);
    // Features are those of Y normalised to [0, 1] (section 4.2.1).
    for (float& value : padded[0]) value = (value + 16.0f) / 116.0f;
    apply(0, filters_.smooth, kSmooth);
    apply(0, filters_.edge, kEdge);
    apply(0, filters_.point, kPoint);
  }

  void across(Plane plane, std::size_t row, const Taps& taps, std::span<float> out) const {
    const std::size_t skip = static_cast<std::size_t>(filters_.radius()) - taps.size() / 2;
    filterAcrossRows(horizontal_[plane], row + skip, taps, out);
  }

  void evaluateColour(std::size_t row, RowFeatures& result) const {
    Rows filtered(width_, 4);
    across(kA, row, filters_.achromatic, filtered[0]);
    across(kRg, row, filters_.redGreen, filtered[1]);
    across(kBy1, row, filters_.blueYellow1, filtered[2]);
    across(kBy2, row, filters_.blueYellow2, filtered[3]);
    for (std::size_t x = 0; x < width_; ++x) {
      const float blueYellow = filtered[3][x] + filters_.blueYellowShare1 * (filtered[2][x] - filtered[3][x]);
      const glm::vec3 rgb = spaces_.ycxczToRgb({filtered[0][x], filtered[1][x], blueYellow});
      result.colour[x] = spaces_.rgbToHuntLab(glm::clamp(rgb, 0.0f, 1.0f));
    }
  }

  void evaluateFeature(std::size_t row, const Taps& detector, Plane plane, std::span<float> magnitude) const {
    Rows responses(width_, 2);
    across(plane, row, filters_.smooth, responses[0]);
    across(kSmooth, row, detector, responses[1]);
    for (std::size_t x = 0; x < width_; ++x) magnitude[x] = std::hypot(responses[0][x], responses[1][x]);
  }

  const Filters& filters_;
  const ColourSpaces& spaces_;
  std::size_t width_;
  std::vector<Rows> horizontal_;
};

/// Colour difference (section 4.1.3) raised by the feature difference (sections 4.2.2 and 4.3).
class ErrorMeasure {
 public:
  explicit ErrorMeasure(const ColourSpaces& spaces)
      : largest_(static_cast<float>(std::pow(
            hyab(spaces.rgbToHuntLab({0, 1, 0}), spaces.rgbToHuntLab({0, 0, 1})), kColourExponent))) {}

  float operator()(const RowFeatures& a, const RowFeatures& b, std::size_t x) const {
    constexpr float kBreak = kRemapBreak, kValue = kRemapValue;
    const float difference = std::pow(hyab(a.colour[x], b.colour[x]), static_cast<float>(kColourExponent));
    const float split = kBreak * largest_;
    const float colour = difference < split
                             ? kValue * difference / split
                             : kValue + (1.0f - kValue) * (difference - split) / (largest_ - split);
    const float feature = std::max(std::abs(a.edge[x] - b.edge[x]), std::abs(a.point[x] - b.point[x]));
    const float exponent = 1.0f - std::pow(feature * std::sqrt(0.5f), static_cast<float>(kFeatureExponent));
    return std::clamp(std::pow(std::min(colour, 1.0f), exponent), 0.0f, 1.0f);
  }

 private:
  float largest_;
};

}  // namespace

std::vector<float> flipMap(std::span<const float> image, std::span<const float> reference, int width,
                           int height, double pixelsPerDegree) {
  const std::size_t pixels =
      static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(height, 0));
  if (pixels == 0 || image.size() != 3 * pixels || reference.size() != 3 * pixels) {
    throw Error(fmt::format("FLIP: {} and {} values for two RGB pictures of {}x{} pixels", image.size(),
                            reference.size(), width, height));
  }
  if (!(pixelsPerDegree >= 1.0 && pixelsPerDegree <= 1000.0)) {
    throw Error(fmt::format("FLIP: {} pixels per degree, 1 to 1000 are accepted", pixelsPerDegree));
  }
  const ColourSpaces spaces;
  const Filters filters(pixelsPerDegree);
  const ErrorMeasure measure(spaces);
  std::vector<float> result(pixels);
  constexpr int kBandRows = 64;
  tbb::parallel_for(0, (height + kBandRows - 1) / kBandRows, [&](int band) {
    const int first = band * kBandRows, count = std::min(kBandRows, height - first);
    const Band imageBand(image, width, height, first, count, filters, spaces);
    const Band referenceBand(reference, width, height, first, count, filters, spaces);
    RowFeatures a(static_cast<std::size_t>(width)), b(static_cast<std::size_t>(width));
    for (int row = 0; row < count; ++row) {
      imageBand.evaluate(static_cast<std::size_t>(row), a);
      referenceBand.evaluate(static_cast<std::size_t>(row), b);
      float* out = result.data() + static_cast<std::size_t>(first + row) * static_cast<std::size_t>(width);
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) out[x] = measure(a, b, x);
    }
  });
  return result;
}

}  // namespace limn
