#include "core/image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <utility>

#include "core/base/error.h"
#include "core/image/compare_report.h"
#include "core/image/metric_table.h"

namespace limn {
namespace {

Image filled(int width, int height, float value) {
  Image image = Image::rgb(width, height);
  std::fill(image.data().begin(), image.data().end(), value);
  return image;
}

Image withNoise(const Image& base, float deviation) {
  Image image = base;
  std::mt19937 generator(11);
  std::normal_distribution<float> normal(0.0f, deviation);
  for (float& value : image.data()) value += normal(generator);
  return image;
}

/// Adds surface channels: everything covered, id 1, Z 10.
Image withSurface(Image image) {
  const std::vector<float> ones(image.pixelCount(), 1.0f), tens(image.pixelCount(), 10.0f);
  image.addChannel("coverage", ones);
  image.addChannel("id", ones);
  image.addChannel("Z", tens);
  return image;
}

void expectError(const std::function<void()>& action, const std::string& part) {
  try {
    action();
    ADD_FAILURE() << "no error; expected one about " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Metrics, ConstantOffset) {
  const Metrics metrics = compareImages(filled(40, 30, 0.6f), filled(40, 30, 0.5f));
  EXPECT_NEAR(metrics.rmse, 0.1, 1e-6);
  EXPECT_NEAR(metrics.bias, 0.1, 1e-6);
  EXPECT_NEAR(metrics.rel_mse, 0.01 / (0.25 * 1.01), 1e-6);
  EXPECT_NEAR(metrics.p999, 0.1, 1e-6);
  EXPECT_NEAR(metrics.psnr, 20 * std::log10(5.0), 1e-5);
  EXPECT_NEAR(metrics.structured, 0.1, 1e-6);  // a constant survives the filter, at the borders too
  EXPECT_EQ(metrics.pixels, 1200u);
  EXPECT_EQ(metrics.masked_share, 0.0);
  EXPECT_FALSE(metrics.noise_floor);
}

TEST(Metrics, EqualPictures) {
  const Image image = withNoise(filled(32, 32, 1.0f), 0.2f);
  const Metrics metrics = compareImages(image, image);
  EXPECT_EQ(metrics.rmse, 0.0);
  EXPECT_EQ(metrics.rel_mse, 0.0);
  EXPECT_EQ(metrics.flip, 0.0);
  EXPECT_EQ(metrics.structured, 0.0);
  EXPECT_EQ(metrics.psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, BlackPicturesAreDefined) {
  EXPECT_EQ(compareImages(filled(8, 8, 0.0f), filled(8, 8, 0.0f)).rel_mse, 0.0);
  EXPECT_EQ(compareImages(filled(8, 8, 0.1f), filled(8, 8, 0.0f)).rel_mse,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(compareImages(filled(8, 8, 0.0f), filled(8, 8, 0.0f)).psnr,
            std::numeric_limits<double>::infinity());
  for (const float peak : {0.0f, -0.5f})
    EXPECT_EQ(compareImages(filled(8, 8, 0.1f), filled(8, 8, peak)).psnr,
              -std::numeric_limits<double>::infinity())
        << peak;
}

TEST(Metrics, OneWrongChannel) {
  Image image = filled(10, 10, 1.0f);
  image.at(4, 4, 0) = 4.0f;
  const Metrics metrics = compareImages(image, filled(10, 10, 1.0f));
  EXPECT_NEAR(metrics.rmse, std::sqrt(9.0 / 300.0), 1e-7);
  EXPECT_NEAR(metrics.bias, 3.0 / 300.0, 1e-7);
  EXPECT_NEAR(metrics.p999, 3.0 * 0.2126, 1e-6);  // rank 100 of 100
}

TEST(Metrics, PercentileIgnoresTheBrightestThousandth) {
  Image image = filled(100, 100, 0.0f);
  for (int x = 0; x < 10; ++x) image.at(x, 0, 1) = 100.0f;  // 10 of 10000 pixels
  EXPECT_EQ(compareImages(image, filled(100, 100, 0.0f)).p999, 0.0);
  image.at(10, 0, 1) = 100.0f;
  EXPECT_NEAR(compareImages(image, filled(100, 100, 0.0f)).p999, 71.52, 1e-4);
}

TEST(Metrics, ScalesWithRadiance) {
  const Image reference = withNoise(filled(32, 32, 1.0f), 0.3f);
  const Metrics one = compareImages(withNoise(reference, 0.1f), reference);
  Image scaledReference = reference, scaled = withNoise(reference, 0.1f);
  for (float& value : scaledReference.data()) value *= 1024.0f;
  for (float& value : scaled.data()) value *= 1024.0f;
  const Metrics many = compareImages(scaled, scaledReference);
  EXPECT_NEAR(many.rmse, 1024 * one.rmse, 1e-3 * one.rmse);
  EXPECT_NEAR(many.rel_mse, one.rel_mse, 1e-9);
  EXPECT_NEAR(many.psnr, one.psnr, 1e-6);
  EXPECT_NEAR(many.structured, 1024 * one.structured, 1e-3 * one.structured);
}

TEST(Metrics, StructuredErrorKeepsBandsAndDropsNoise) {
  const Image reference = filled(128, 128, 1.0f);
  const Metrics noise = compareImages(withNoise(reference, 0.1f), reference);
  // White noise shrinks by the root of the sum of the squared weights: one-dimensional sums of squares of
  // exp(-x^2 / 8) over -4..4, normalised, are 0.14759, and so is the two-dimensional root.
  EXPECT_NEAR(noise.structured / noise.rmse, 0.14759, 0.006);
  Image bands = reference;  // 32 pixels wide
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      for (int c = 0; c < 3; ++c) bands.at(x, y, c) += x / 32 % 2 == 0 ? 0.1f : -0.1f;
    }
  }
  const Metrics banding = compareImages(bands, reference);
  EXPECT_NEAR(banding.rmse, 0.1, 1e-6);
  EXPECT_GT(banding.structured / banding.rmse, 0.9);
}

TEST(Metrics, MaskDropsPixelsThatSeeOtherSurfaces) {
  const Image reference = withSurface(filled(100, 100, 0.5f));
  Image image = withSurface(filled(100, 100, 0.5f));
  const int coverage = image.channel("coverage"), id = image.channel("id"), depth = image.channel("Z");
  image.at(0, 0, coverage) = 0.0f;
  image.at(1, 0, id) = 2.0f;
  image.at(2, 0, depth) = 10.011f;
  image.at(3, 0, depth) = 10.009f;  // within 1e-3
  for (int x = 0; x < 3; ++x) image.at(x, 0, 0) = 100.0f;
  const Metrics metrics = compareImages(image, reference);
  EXPECT_EQ(metrics.pixels, 9997u);
  EXPECT_NEAR(metrics.masked_share, 3e-4, 1e-12);
  EXPECT_EQ(metrics.rmse, 0.0);
  EXPECT_EQ(metrics.structured, 0.0);

  CompareOptions everything;
  everything.useMask = false;
  EXPECT_GT(compareImages(image, reference, everything).rmse, 0.5);
}

TEST(Metrics, BackgroundIsDroppedButNotCounted) {
  Image reference = withSurface(filled(10, 10, 0.5f)), image = reference;
  for (int x = 0; x < 10; ++x) {
    for (Image* picture : {&reference, &image}) {
      picture->at(x, 0, picture->channel("coverage")) = 0.0f;
      picture->at(x, 0, picture->channel("Z")) = std::numeric_limits<float>::infinity();
    }
    image.at(x, 0, 1) = 7.0f;
  }
  const Metrics metrics = compareImages(image, reference);
  EXPECT_EQ(metrics.pixels, 90u);
  EXPECT_EQ(metrics.masked_share, 0.0);
  EXPECT_EQ(metrics.rmse, 0.0);
  // A term that is there without surfaces, too, is compared there.
  CompareOptions background;
  background.background = true;
  EXPECT_EQ(compareImages(image, reference, background).pixels, 100u);
  EXPECT_GT(compareImages(image, reference, background).rmse, 0.0);
  // The reference alone knows its background.
  EXPECT_EQ(compareImages(image.select({"R", "G", "B"}), reference).pixels, 90u);
}

/// Pictures of other programs may have no channel for the coverage, and an infinite depth in its place.
TEST(Metrics, AnInfiniteDepthIsThatOfNoSurface) {
  Image reference = filled(10, 10, 0.5f);
  reference.addChannel("Z", std::vector<float>(reference.pixelCount(), 10.0f));
  Image image = reference;
  const int depth = image.channel("Z");
  for (Image* picture : {&reference, &image})
    picture->at(0, 0, depth) = std::numeric_limits<float>::infinity();
  reference.at(1, 0, depth) = std::numeric_limits<float>::infinity();
  image.at(2, 0, depth) = std::numeric_limits<float>::infinity();
  for (int x = 1; x < 3; ++x) image.at(x, 0, 0) = 100.0f;
  CompareOptions silhouettes;
  silhouettes.maxMaskedShare = 0.05;
  const Metrics metrics = compareImages(image, reference, silhouettes);
  EXPECT_EQ(metrics.pixels, 98u) << "without those where one picture alone sees a surface";
  EXPECT_NEAR(metrics.masked_share, 0.02, 1e-12);
  EXPECT_EQ(metrics.rmse, 0.0);
}

TEST(Metrics, PixelsWithoutAnAnswerAreDropped) {
  Image reference = filled(10, 10, 0.5f), image = reference;
  reference.addChannel("masked");
  reference.at(4, 4, reference.channel("masked")) = 1.0f;
  image.at(4, 4, 0) = 1.0f;
  const Metrics metrics = compareImages(image, reference);
  EXPECT_EQ(metrics.pixels, 99u);
  EXPECT_EQ(metrics.masked_share, 0.0);
  EXPECT_EQ(metrics.rmse, 0.0);
}

TEST(Metrics, RefusesTooManyMaskedPixels) {
  Image reference = withSurface(filled(10, 10, 0.5f)), image = reference;
  image.at(0, 0, image.channel("id")) = 5.0f;
  expectError([&] { compareImages(image, reference); }, "1.000 %");
  CompareOptions foliage;
  foliage.maxMaskedShare = 0.02;
  EXPECT_NEAR(compareImages(image, reference, foliage).masked_share, 0.01, 1e-12);
}

TEST(Metrics, MasksByTermRange) {
  Image reference = filled(4, 1, 0.0f), image = filled(4, 1, 0.0f);
  const float values[] = {0.0f, 0.02f, 0.5f, 1.0f};
  for (int x = 0; x < 4; ++x) {
    for (int c = 0; c < 3; ++c) {
      reference.at(x, 0, c) = values[x];
      image.at(x, 0, c) = values[x] + (x == 2 ? 0.1f : 0.3f);
    }
  }
  CompareOptions penumbra;
  penumbra.maskTermRange = {0.02f, 0.98f};
  const Metrics metrics = compareImages(image, reference, penumbra);
  EXPECT_EQ(metrics.pixels, 1u);
  EXPECT_NEAR(metrics.rmse, 0.1, 1e-6);
  EXPECT_NEAR(metrics.structured, 0.1, 1e-6);  // masked neighbours do not leak in
  penumbra.maskTermRange = {2.0f, 3.0f};
  expectError([&] { compareImages(image, reference, penumbra); }, "no pixel");
}

TEST(Metrics, RefusesNanInfinityAndOtherSizes) {
  const Image good = filled(8, 6, 1.0f);
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Image broken = good;
    broken.at(3, 5, 2) = bad;
    expectError([&] { compareImages(broken, good); },
                "the image has 1 values that are not finite, the first at pixel (3, 5)");
    expectError([&] { compareImages(good, broken); }, "the reference has 1");
    Image grey(8, 6, {"Y"});
    grey.at(3, 5, 0) = bad;
    expectError([&] { compareImages(grey, good); }, "the image has 1 values");
  }
  expectError([&] { compareImages(good, filled(6, 8, 1.0f)); }, "8x6");
  expectError([&] { compareImages(good, Image(8, 6, {"Z", "id"})); }, "R, G, B");
  expectError([&] { compareImages(Image(), Image()); }, "empty");
}

TEST(Metrics, FlipFollowsTheExposure) {
  const Image bright = filled(16, 16, 4.0f), brighter = filled(16, 16, 6.0f);
  EXPECT_EQ(compareImages(bright, brighter).flip, 0.0);  // both white
  CompareOptions darker;
  darker.exposureEv = -3.0f;
  EXPECT_GT(compareImages(bright, brighter, darker).flip, 0.1);
  EXPECT_NEAR(compareImages(filled(16, 16, 0.0f), bright).flip, 0.96738, 1e-4);
}

TEST(Metrics, ReadsTheNoiseOfTheReference) {
  Image reference = filled(8, 8, 0.5f);
  reference.metadata()["noise_rms"] = "0.01";
  const Metrics metrics = compareImages(filled(8, 8, 0.51f), reference);
  ASSERT_TRUE(metrics.noise_floor);
  EXPECT_NEAR(*metrics.noise_floor, 3 * 0.01 * 0.5, 1e-9);
  EXPECT_NE(metricsTable(metrics).find("within it"), std::string::npos);
  reference.metadata()["noise_rms"] = "little";
  expectError([&] { compareImages(reference, reference); }, "'little'");
  reference.metadata()["noise_rms"] = "a\nb";
  expectError([&] { compareImages(reference, reference); }, "'a?b'");
}

/// Half of the picture is lit and known exactly, the other half is penumbra with noise.
TEST(Metrics, NoiseFloorIsThatOfTheComparedPixels) {
  Image reference = filled(16, 8, 1.0f);
  reference.metadata()["noise_rms"] = "0.5";  // of the whole picture: less is known by it
  reference.addChannel("variance");
  const int variance = reference.channel("variance");
  for (int y = 0; y < 8; ++y)
    for (int x = 8; x < 16; ++x) {
      for (int c = 0; c < 3; ++c) reference.at(x, y, c) = 0.5f;
      reference.at(x, y, variance) = x % 2 == 0 ? 0.0001f : 0.0003f;
    }
  const Image image = withNoise(filled(16, 8, 0.6f), 0.1f);
  CompareOptions penumbra;
  penumbra.maskTermRange = {0.02f, 0.98f};
  const Metrics whole = compareImages(image, reference), part = compareImages(image, reference, penumbra);
  ASSERT_TRUE(whole.noise_floor && part.noise_floor);
  EXPECT_NEAR(*whole.noise_floor, 3 * 0.01, 1e-8);
  EXPECT_NEAR(*part.noise_floor, 3 * std::sqrt(0.0002), 1e-8);

  // It bounds the RMSE of what differs from the reference by its noise alone.
  std::mt19937 generator(7);
  Image twin = reference;
  for (int y = 0; y < 8; ++y)
    for (int x = 8; x < 16; ++x)
      for (int c = 0; c < 3; ++c)
        twin.at(x, y, c) +=
            std::normal_distribution<float>(0.0f, std::sqrt(reference.at(x, y, variance)))(generator);
  EXPECT_NEAR(compareImages(twin, reference, penumbra).rmse, *part.noise_floor / 3,
              0.2 * *part.noise_floor / 3);

  reference.at(0, 0, variance) = -1.0f;
  expectError([&] { compareImages(image, reference); }, "channel 'variance'");
  EXPECT_NO_THROW(compareImages(image, reference, penumbra)) << "that pixel is not compared";
}

/// What is known of the whole pictures serves a part of them to the bit.
TEST(Metrics, APartOfAComparisonIsAsOneOfItsOwn) {
  Image reference = withSurface(filled(40, 30, 0.0f)), image = reference;
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> uniform;
  for (Image* picture : {&reference, &image})
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x)
        for (int c = 0; c < 3; ++c) picture->at(x, y, c) = uniform(generator);
  image.at(3, 4, image.channel("id")) = 2.0f;
  reference.metadata()["noise_rms"] = "0.01";
  const std::pair range(0.2f, 0.7f);
  CompareOptions options;
  options.exposureEv = 1;
  const Comparison whole = compareImagesDetailed(image, reference, options);
  const std::optional<Metrics> part = metricsWithin(image, reference, whole, range);
  ASSERT_TRUE(part);
  options.maskTermRange = range;
  const Metrics alone = compareImages(image, reference, options);
  EXPECT_LT(part->pixels, whole.metrics.pixels);
  for (const MetricInfo& info : kMetrics)
    EXPECT_EQ(metricValue(info, *part), metricValue(info, alone)) << info.key;
  EXPECT_FALSE(metricsWithin(image, reference, whole, {2.0f, 3.0f}));
  const Image small = filled(8, 8, 0.5f);
  expectError([&] { metricsWithin(small, small, whole, range); }, "the comparison 40x30");
}

TEST(Metrics, DifferencePictureIsDarkWhereEqual) {
  const Image reference = filled(64, 64, 0.2f);
  Image image = reference;
  for (int y = 0; y < 64; ++y) {
    for (int x = 40; x < 64; ++x) image.at(x, y, 0) = 1.0f;
  }
  const Image picture = differenceImage(compareImagesDetailed(image, reference));
  EXPECT_LT(picture.at(5, 30, 0), 0.01f);
  EXPECT_GT(picture.at(60, 30, 0), 0.2f);
}

TEST(CompareReport, JsonHasTheKeysOfTheContract) {
  const nlohmann::json json =
      nlohmann::json::parse(metricsJson(compareImages(filled(8, 8, 0.6f), filled(8, 8, 0.5f))));
  for (const char* key :
       {"rmse", "rel_mse", "bias", "p999", "psnr", "flip", "structured", "masked_share", "pixels"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_NEAR(json["rmse"].get<double>(), 0.1, 1e-6);
  EXPECT_EQ(json["pixels"], 64);
  const Metrics equal = compareImages(filled(8, 8, 0.5f), filled(8, 8, 0.5f));
  EXPECT_TRUE(nlohmann::json::parse(metricsJson(equal))["psnr"].is_null());
}

TEST(CompareReport, TableNamesEveryMetric) {
  const std::string table = metricsTable(compareImages(filled(8, 8, 0.6f), filled(8, 8, 0.5f)));
  for (const char* name :
       {"RMSE", "relative MSE", "bias", "p99.9", "PSNR", "FLIP", "structured", "64 pixels"}) {
    EXPECT_NE(table.find(name), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace limn
