// Laws of the error's power spectrum, and which frequencies it puts where.
#include "core/image/error_spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "core/base/error.h"

namespace limn {
namespace {

std::vector<unsigned char> everywhere(const Image& image) {
  return std::vector<unsigned char>(image.pixelCount(), 1);
}

Image noise(int width, int height, float deviation) {
  Image image = Image::rgb(width, height);
  std::mt19937 generator(7);
  std::normal_distribution<float> normal(0.0f, deviation);
  for (float& value : image.data()) value = normal(generator);
  return image;
}

TEST(ErrorSpectrum, WhiteNoiseIsLevelAtItsVariance) {
  const Image image = noise(240, 180, 0.1f);
  const std::vector<double> spectrum = errorSpectrum(image, Image::rgb(240, 180), everywhere(image));
  ASSERT_EQ(spectrum.size(), static_cast<std::size_t>(kSpectrumBins));
  const double mean = std::accumulate(spectrum.begin(), spectrum.end(), 0.0) / kSpectrumBins;
  EXPECT_NEAR(mean, 0.01, 0.0005);
  // The outer rings average thousands of frequencies, the innermost a dozen.
  for (std::size_t b = 4; b < spectrum.size(); ++b) EXPECT_NEAR(spectrum[b], 0.01, 0.0015) << "ring " << b;
}

TEST(ErrorSpectrum, SideIsNoMatterForNoise) {
  // 97 x 61 is extended by zeros: the level stays the variance, counted over the compared pixels.
  const Image image = noise(97, 61, 0.1f);
  const std::vector<double> spectrum = errorSpectrum(image, Image::rgb(97, 61), everywhere(image));
  EXPECT_NEAR(std::accumulate(spectrum.begin(), spectrum.end(), 0.0) / kSpectrumBins, 0.01, 0.001);
}

TEST(ErrorSpectrum, WaveStandsInItsRing) {
  constexpr int kSide = 128;
  for (const int cycles : {1, 5, 20, 63}) {
    Image image = Image::rgb(kSide, kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        for (int c = 0; c < 3; ++c)
          image.at(x, y, c) =
              static_cast<float>(0.2 * std::sin(2 * std::numbers::pi * cycles * (c == 1 ? x : y) / kSide));
    const std::vector<double> spectrum = errorSpectrum(image, Image::rgb(kSide, kSide), everywhere(image));
    const auto ring = std::distance(spectrum.begin(), std::ranges::max_element(spectrum));
    EXPECT_EQ(ring, 2 * kSpectrumBins * cycles / kSide) << cycles;
    const double total = std::accumulate(spectrum.begin(), spectrum.end(), 0.0);
    EXPECT_NEAR(spectrum[static_cast<std::size_t>(ring)], total, 1e-6 * total) << cycles;
  }
}

TEST(ErrorSpectrum, MaskedPixelsAreNoError) {
  Image image = Image::rgb(80, 80);
  std::vector<unsigned char> mask(image.pixelCount(), 1);
  image.at(40, 40, 0) = 1e6f;
  mask[40 * 80 + 40] = 0;
  for (const double power : errorSpectrum(image, Image::rgb(80, 80), mask)) EXPECT_EQ(power, 0.0);
  std::ranges::fill(mask, 0);
  for (const double power : errorSpectrum(image, Image::rgb(80, 80), mask)) EXPECT_EQ(power, 0.0);
}

TEST(ErrorSpectrum, OnePixelIsLevel) {
  Image image = Image::rgb(1, 1);
  std::ranges::fill(image.data(), 0.5f);
  for (const double power : errorSpectrum(image, Image::rgb(1, 1), everywhere(image)))
    EXPECT_NEAR(power, 0.25, 1e-6);
}

TEST(ErrorSpectrum, UnequalSizesAreRefused) {
  const Image image = Image::rgb(4, 4);
  EXPECT_THROW(errorSpectrum(image, Image::rgb(5, 4), everywhere(image)), Error);
  EXPECT_THROW(errorSpectrum(image, image, everywhere(Image::rgb(5, 4))), Error);
}

}  // namespace
}  // namespace limn
