#include "core/image/tone_mapping.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "glsl/numeric/tone_curve.glsl"

namespace limn {
namespace {

Image gradient() {
  Image image = Image::rgb(16, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) =
            0.01f * static_cast<float>((x + 1) * (x + 1) * (c + 1)) + 0.1f * static_cast<float>(y);
  return image;
}

TEST(ToneMapping, CurvesHaveNames) {
  EXPECT_EQ(parseToneCurve("none"), ToneCurve::none);
  EXPECT_EQ(parseToneCurve("neutral"), ToneCurve::neutral);
  EXPECT_EQ(parseToneCurve("agx"), ToneCurve::agx);
  try {
    parseToneCurve("agv");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean agx"));
    EXPECT_THAT(error.what(), testing::HasSubstr("none, neutral, agx"));
  }
}

/// Files hold what windows show, and the default is what writeImage() writes.
TEST(ToneMapping, FilesHoldWhatWindowsShow) {
  const Image image = gradient();
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "tone_mapping.png";
  for (const ToneCurve curve : {ToneCurve::none, ToneCurve::neutral, ToneCurve::agx}) {
    const ToneMapping tone{-0.5f, curve};
    writePicture(file, image, tone);
    EXPECT_EQ(readImage8(file).data, toneMapped(image, tone).data)
        << kToneCurves[static_cast<std::size_t>(curve)];
  }
  writePicture(file, image, {1.0f});
  const std::vector<std::uint8_t> shown = readImage8(file).data;
  writeImage(file, image, 1.0f);
  EXPECT_EQ(readImage8(file).data, shown);
  std::filesystem::remove(file);
}

TEST(ToneMapping, LeavesExrAlone) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "tone_mapping.exr";
  const Image image = gradient();
  writePicture(file, image, {3.0f, ToneCurve::agx});
  const Image back = readImage(file);
  EXPECT_TRUE(std::equal(back.data().begin(), back.data().end(), image.data().begin(), image.data().end()));
  std::filesystem::remove(file);
}

TEST(ToneMapping, KeepsTheMetadata) {
  Image image = gradient();
  image.metadata()["command"] = "limn render x";
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "tone_metadata.png";
  writePicture(file, image, {0.0f, ToneCurve::neutral});
  EXPECT_EQ(readImage(file).metadata().at("command"), "limn render x");
  std::filesystem::remove(file);
}

TEST(AutomaticExposure, TakesTheGeometricMeanToMiddleGrey) {
  Image image = Image::rgb(10, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = x < 5 ? 0.36f : 1.44f;
  EXPECT_NEAR(automaticExposure(image), -2.0f, 1e-5f);
}

/// A black background, a lamp and what is no number decide nothing.
TEST(AutomaticExposure, IgnoresWhatIsNoPartOfThePicture) {
  Image image = Image::rgb(20, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = 0.045f;
  for (int c = 0; c < 3; ++c) {
    image.at(0, 0, c) = 1e6f;
    image.at(1, 0, c) = std::numeric_limits<float>::quiet_NaN();
    image.at(2, 0, c) = std::numeric_limits<float>::infinity();
    image.at(3, 0, c) = -1.0f;
  }
  EXPECT_NEAR(automaticExposure(image), 2.0f, 1e-5f);
}

TEST(AutomaticExposure, IsZeroInTheDarkAndBounded) {
  Image image = Image::rgb(2, 2);
  EXPECT_EQ(automaticExposure(image), 0.0f);
  for (float& value : image.data()) value = 1e-30f;
  EXPECT_EQ(automaticExposure(image), 60.0f);
}

}  // namespace
}  // namespace limn
