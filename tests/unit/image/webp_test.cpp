// WebP pictures: values as they were stored, and one line for what cannot be read.
#include "tests/support/webp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/base/error.h"
#include "core/image/image.h"
#include "glsl/numeric/srgb.glsl"

namespace limn::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr int kPictureWidth = 37, kPictureHeight = 19;

/// Any colours under alphas from 1 to 255, or a smooth opaque ramp.
std::vector<std::uint8_t> noise() {
  std::mt19937 generator(3);
  std::vector<std::uint8_t> rgba(std::size_t{4} * kPictureWidth * kPictureHeight);
  for (std::size_t i = 0; i < rgba.size(); ++i)
    rgba[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 1 + generator() % 255 : generator() % 256);
  return rgba;
}
std::vector<std::uint8_t> ramp() {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < kPictureHeight; ++y)
    for (int x = 0; x < kPictureWidth; ++x)
      for (const int value : {60 + 3 * x, 50 + 3 * x, 40 + 3 * x, 255})
        rgba.push_back(static_cast<std::uint8_t>(value));
  return rgba;
}

std::string webpRefusal(std::span<const std::byte> bytes) {
  try {
    readImage8Memory(bytes, "texture 3");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::vector<std::byte> bytesOf(const std::vector<int>& values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

/// An extended file of a canvas of that size: its header alone.
std::vector<std::byte> canvas(int flags, int width, int height) {
  std::vector<int> values = {'R', 'I', 'F', 'F', 22, 0, 0, 0, 'W',   'E', 'B', 'P',
                             'V', 'P', '8', 'X', 10, 0, 0, 0, flags, 0,   0,   0};
  for (const int side : {width, height})
    for (const int shift : {0, 8, 16}) values.push_back((side - 1) >> shift & 255);
  return bytesOf(values);
}

/// A lossless picture of that size: its header, and zeros for the pixels.
std::vector<std::byte> lossless(unsigned width, unsigned height) {
  const unsigned bits = (width - 1) | (height - 1) << 14;
  std::vector<int> values = {'R', 'I', 'F', 'F', 40,  0,  0, 0, 'W', 'E', 'B',
                             'P', 'V', 'P', '8', 'L', 28, 0, 0, 0,   0x2f};
  for (const int shift : {0, 8, 16, 24}) values.push_back(static_cast<int>(bits >> shift & 255));
  values.resize(48);
  return bytesOf(values);
}

TEST(Webp, KeepsColoursUnderLowAlpha) {
  const std::vector<std::uint8_t> rgba = noise();
  const Image8 image = readImage8Memory(losslessWebp(kPictureWidth, kPictureHeight, rgba), "a");
  EXPECT_EQ(image.width, kPictureWidth);
  EXPECT_EQ(image.height, kPictureHeight);
  EXPECT_EQ(image.data, rgba);
}

TEST(Webp, ReadsAsALinearPictureToo) {
  const std::vector<std::uint8_t> rgba = noise();
  const Image image = readImageMemory(losslessWebp(kPictureWidth, kPictureHeight, rgba), "a");
  ASSERT_EQ(image.channels(), (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_FLOAT_EQ(image.data()[5], glsl::srgb_decode(static_cast<float>(rgba[5]) / 255.0f));
  EXPECT_FLOAT_EQ(image.data()[7], static_cast<float>(rgba[7]) / 255.0f);  // alpha is linear already
  const Image opaque = readImageMemory(losslessWebp(kPictureWidth, kPictureHeight, ramp()), "a");
  EXPECT_EQ(opaque.channels(), (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_FLOAT_EQ(opaque.at(2, 1, 1), glsl::srgb_decode(56.0f / 255.0f));
}

TEST(Webp, LossyPicturesAreCloseAndKeepTheirAlpha) {
  std::vector<std::uint8_t> rgba = ramp();
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    rgba[i] = static_cast<std::uint8_t>(i % 7 == 0 ? 255 : 128);
  const Image8 image = readImage8Memory(lossyWebp(kPictureWidth, kPictureHeight, rgba), "a");
  ASSERT_EQ(image.data.size(), rgba.size());
  for (std::size_t i = 0; i < rgba.size(); ++i) ASSERT_NEAR(image.data[i], rgba[i], i % 4 == 3 ? 0 : 8) << i;
}

TEST(Webp, RefusesWhatIsTruncatedOrDamaged) {
  for (const std::vector<std::byte>& whole : {losslessWebp(kPictureWidth, kPictureHeight, noise()),
                                              lossyWebp(kPictureWidth, kPictureHeight, noise())}) {
    ASSERT_EQ(webpRefusal(whole), "");
    for (const std::size_t size : {std::size_t{12}, std::size_t{20}, whole.size() / 2, whole.size() - 4})
      EXPECT_EQ(webpRefusal(std::span(whole).first(size)), "texture 3: truncated or damaged WebP") << size;
    std::vector<std::byte> damaged = whole;
    for (std::size_t i = 20; i < damaged.size(); ++i) damaged[i] = std::byte{0xff};
    EXPECT_THAT(webpRefusal(damaged), AllOf(StartsWith("texture 3: "), Not(HasSubstr("\n"))));
  }
  EXPECT_THAT(webpRefusal(bytesOf({'R', 'I', 'F', 'F', 4, 0, 0, 0, 'W', 'E', 'B'})),
              HasSubstr("not a picture"));
}

TEST(Webp, IsNoPictureOfHeights) {
  try {
    readFirstChannelMemory(losslessWebp(kPictureWidth, kPictureHeight, noise()), "texture 3", 1 << 20);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "texture 3: a PNG or an EXR is accepted");
  }
}

TEST(Webp, RefusesAnimations) {
  EXPECT_EQ(webpRefusal(canvas(2, 4, 4)), "texture 3: animated WebP pictures are not accepted");
}

TEST(Webp, ChecksSidesBeforeTakingMemory) {
  EXPECT_THAT(webpRefusal(lossless(16383, 16384)), HasSubstr("16383x16384 pixels of 4 channels"));
  EXPECT_THAT(webpRefusal(lossless(8192, 8192)), HasSubstr("8192x8192 pixels of 4 channels in 48 bytes"));
  EXPECT_THAT(webpRefusal(canvas(0, 40000, 20000)), StartsWith("texture 3: "));
}

}  // namespace
}  // namespace limn::test
