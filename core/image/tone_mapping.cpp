#include "core/image/tone_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "glsl/numeric/tone_curve.glsl"

namespace limn {
namespace {

static_assert(static_cast<std::uint32_t>(ToneCurve::none) == glsl::tone_curve_none);
static_assert(static_cast<std::uint32_t>(ToneCurve::neutral) == glsl::tone_curve_neutral);
static_assert(static_cast<std::uint32_t>(ToneCurve::agx) == glsl::tone_curve_agx);

/// Calls f(colour) for each pixel, row by row from the top.
template <class F>
void forEachColour(const Image& image, const F& f) {
  const std::array<int, 3> rgb = image.rgbChannels();
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      f(glm::vec3(image.at(x, y, rgb[0]), image.at(x, y, rgb[1]), image.at(x, y, rgb[2])));
}

}  // namespace

ToneCurve parseToneCurve(const std::string& name) {
  const auto found = std::ranges::find(kToneCurves, name);
  if (found != kToneCurves.end()) return static_cast<ToneCurve>(found - kToneCurves.begin());
  const std::vector<std::string> known(kToneCurves.begin(), kToneCurves.end());
  throw UsageError(fmt::format("unknown tone curve '{}'{}; known are {}", name, didYouMean(name, known),
                               fmt::join(known, ", ")));
}

Image8 toneMapped(const Image& image, const ToneMapping& tone) {
  Image8 result{image.width(), image.height(), {}};
  result.data.reserve(4 * image.pixelCount());
  forEachColour(image, [&](const glm::vec3& colour) {
    const glm::vec3 codes = glsl::tone_map(colour, tone.exposureEv, static_cast<std::uint32_t>(tone.curve));
    for (int c = 0; c < 3; ++c)
      result.data.push_back(static_cast<std::uint8_t>(std::lround(255.0f * codes[c])));
    result.data.push_back(255);
  });
  return result;
}

void writePicture(const std::filesystem::path& path, const Image& image, const ToneMapping& tone) {
  if (path.extension() != ".png" || tone.curve == ToneCurve::none)
    return writeImage(path, image, tone.exposureEv);
  // Linear values of the display, which writePng() encodes to the same codes.
  Image shown = Image::rgb(image.width(), image.height());
  shown.metadata() = image.metadata();
  std::size_t next = 0;
  forEachColour(image, [&](const glm::vec3& colour) {
    const glm::vec3 codes = glsl::tone_map(colour, tone.exposureEv, static_cast<std::uint32_t>(tone.curve));
    for (int c = 0; c < 3; ++c) shown.data()[next++] = glsl::srgb_decode(codes[c]);
  });
  writePng(path, shown);
}

float automaticExposure(const Image& image) {
  constexpr double kMiddleGrey = 0.18, kLeftOut = 0.05, kMost = 60;
  std::vector<float> lit;
  lit.reserve(image.pixelCount());
  forEachColour(image, [&](const glm::vec3& colour) {
    const float luminance = glsl::luminance(colour);
    if (luminance > 0 && std::isfinite(luminance)) lit.push_back(luminance);
  });
  if (lit.empty()) return 0;
  std::sort(lit.begin(), lit.end());
  const auto skipped = static_cast<std::size_t>(kLeftOut * static_cast<double>(lit.size()));
  double sum = 0;
  for (std::size_t i = skipped; i < lit.size() - skipped; ++i) sum += std::log2(static_cast<double>(lit[i]));
  const double mean = sum / static_cast<double>(lit.size() - 2 * skipped);
  return static_cast<float>(std::clamp(std::log2(kMiddleGrey) - mean, -kMost, kMost));
}

}  // namespace limn
