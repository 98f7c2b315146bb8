#include "core/image/image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/base/file.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("limn_image_" + std::to_string(::getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t fileCount() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  /// Writes through OpenImageIO: pictures of kinds that limn reads but does not write.
  void writeForeign(const fs::path& path, int width, int height, int channels,
                    const std::vector<float>& pixels, const OIIO::TypeDesc& type) {
    auto output = OIIO::ImageOutput::create(path.string());
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    ASSERT_TRUE(output && output->open(path.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close());
  }

  fs::path folder_;
};

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expectRefusal(const std::function<void()>& action, const std::string& part) {
  const std::string message = messageOf(action);
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

Image noise(int width, int height, std::vector<std::string> channels) {
  Image image(width, height, std::move(channels));
  std::mt19937 generator(7);
  std::normal_distribution<float> normal(0.0f, 100.0f);
  for (float& value : image.data()) value = normal(generator);
  return image;
}

TEST(Image, AddressesPixelsFromTheTopLeft) {
  Image image(3, 2, {"R", "G", "B", "Z"});
  image.at(2, 1, 3) = 5.0f;
  EXPECT_EQ(image.data()[(1 * 3 + 2) * 4 + 3], 5.0f);
  EXPECT_EQ(image.pixel(2, 1)[3], 5.0f);
  EXPECT_EQ(image.channel("Z"), 3);
  EXPECT_FALSE(image.findChannel("depth"));
  expectRefusal([&] { image.channel("depth"); }, "R, G, B, Z");
}

TEST(Image, RefusesImpossibleSizesBeforeAllocating) {
  EXPECT_THROW(Image(0, 4, {"R"}), Error);
  EXPECT_THROW(Image(4, -1, {"R"}), Error);
  EXPECT_THROW(Image(32769, 1, {"R"}), Error);
  EXPECT_THROW(Image(32768, 32768, {"R"}), Error);
  EXPECT_THROW(Image(16384, 16384, {"R", "G", "B", "A", "Z"}), Error);
  EXPECT_THROW(Image(4, 4, {}), Error);
  EXPECT_THROW(Image(4, 4, {"R", "R"}), Error);
  EXPECT_THROW(Image(4, 4, {""}), Error);
}

TEST(Image, AddsAndSelectsChannels) {
  Image image = noise(4, 3, {"R", "G", "B"});
  const Image before = image;
  std::vector<float> depth(12);
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = static_cast<float>(i);
  image.addChannel("Z", depth);
  image.addChannel("coverage");
  EXPECT_EQ(image.at(3, 2, 3), 11.0f);
  EXPECT_EQ(image.at(3, 2, 4), 0.0f);
  const Image back = image.select({"R", "G", "B"});
  EXPECT_TRUE(std::ranges::equal(back.data(), before.data()));
  EXPECT_THROW(image.addChannel("Z"), Error);
  EXPECT_THROW(image.addChannel("id", depth = {1.0f}), Error);
  EXPECT_THROW(image.select({"X"}), Error);
}

TEST(Image, AnswersColourForGreyPictures) {
  EXPECT_EQ(Image(1, 1, {"V"}).rgbChannels(), (std::array<int, 3>{0, 0, 0}));
  EXPECT_EQ(Image(1, 1, {"Z", "Y"}).rgbChannels(), (std::array<int, 3>{1, 1, 1}));
  EXPECT_EQ(Image(1, 1, {"B", "G", "R"}).rgbChannels(), (std::array<int, 3>{2, 1, 0}));
  expectRefusal([] { Image(1, 1, {"Z", "id"}).rgbChannels("depth.exr"); }, "depth.exr: no channels R, G, B");
}

/// They may come from a file.
TEST(Image, NamesOfChannelsAreShownInOneLine) {
  expectRefusal([] { Image(1, 1, {"a\nb", "c\x1b"}).rgbChannels(); }, "there are a?b, c?");
  expectRefusal([] { Image(1, 1, {"a\nb", "c\x1b"}).channel("d"); }, "no channel 'd'; there are a?b, c?");
  expectRefusal([] { Image(1, 1, {"a\nb", "a\nb"}); }, "two channels named 'a?b'");
}

TEST_F(ImageFile, ExrKeepsEveryChannelAndTextBitForBit) {
  Image image = noise(37, 19, {"R", "G", "B", "A", "Z", "coverage", "id", "albedo.R", "N.X"});
  image.at(0, 0, 6) = 16777215.0f;
  image.at(1, 0, 0) = std::numeric_limits<float>::infinity();
  image.at(2, 0, 0) = std::numeric_limits<float>::denorm_min();
  image.metadata() = {{"noise_rms", "0.00125"}, {"scene", "cornell box, \"quoted\""}};
  writeExr(folder_ / "a.exr", image);
  const Image back = readImage(folder_ / "a.exr");
  ASSERT_EQ(back.width(), 37);
  ASSERT_EQ(back.height(), 19);
  EXPECT_EQ(back.metadata(), image.metadata());
  const Image ordered = back.select(image.channels());
  EXPECT_EQ(std::memcmp(ordered.data().data(), image.data().data(), image.data().size_bytes()), 0);
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(ImageFile, ExrBytesDependOnTheContentOnly) {
  const Image image = noise(16, 16, {"R", "G", "B"});
  writeExr(folder_ / "a.exr", image);
  writeExr(folder_ / "b.exr", image);
  EXPECT_EQ(readFile(folder_ / "a.exr"), readFile(folder_ / "b.exr"));
}

// An encoder that looks at the clock gives the same bytes within a second only.
TEST_F(ImageFile, ExrHoldsNoWallClock) {
  writeExr(folder_ / "a.exr", noise(4, 4, {"R", "G", "B"}));
  const auto input = OIIO::ImageInput::open((folder_ / "a.exr").string());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().get_string_attribute("DateTime"), "1970:01:01 00:00:00");
}

TEST_F(ImageFile, ExrKeepsOneRowAndOneColumn) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(8192, 1), std::pair(1, 8192)}) {
    const Image image = noise(width, height, {"R", "G", "B"});
    writeExr(folder_ / "thin.exr", image);
    EXPECT_TRUE(std::ranges::equal(readImage(folder_ / "thin.exr").data(), image.data()));
  }
}

TEST_F(ImageFile, PngIsExposureClampAndSrgb) {
  Image image = Image::rgb(6, 1);
  const float values[] = {0.0f, 0.5f, 2.0f, -1.0f, std::nanf(""), 0.18f};
  for (int x = 0; x < 6; ++x) {
    for (int c = 0; c < 3; ++c) image.at(x, 0, c) = values[x];
  }
  writePng(folder_ / "a.png", image);
  const Image8 stored = readImage8(folder_ / "a.png");
  const int expected[] = {0, 188, 255, 0, 0, 118};  // sRGB of 0.5 is 0.7354, of 0.18 is 0.4614
  for (std::size_t x = 0; x < 6; ++x) {
    EXPECT_EQ(stored.data[4 * x], expected[x]);
    EXPECT_EQ(stored.data[4 * x + 3], 255);
  }
  writePng(folder_ / "b.png", image, 1.0f);
  EXPECT_EQ(readImage8(folder_ / "b.png").data[4], 255);
  writePng(folder_ / "c.png", image, -1.0f);
  EXPECT_EQ(readImage8(folder_ / "c.png").data[4 * 2], 255);
  EXPECT_EQ(readImage8(folder_ / "c.png").data[4], 137);  // sRGB of 0.25 is 0.5371
}

/// Keywords and texts of the chunks tEXt of a PNG (ISO/IEC 15948, 11.3.4.3).
std::map<std::string, std::string> textChunks(const std::string& png) {
  std::map<std::string, std::string> texts;
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png[at + i]);
    return value;
  };
  for (std::size_t at = 8; at + 12 <= png.size(); at += 12 + number(at)) {
    if (png.compare(at + 4, 4, "tEXt") != 0) continue;
    const std::string chunk = png.substr(at + 8, number(at));
    texts[chunk.substr(0, chunk.find('\0'))] = chunk.substr(chunk.find('\0') + 1);
  }
  return texts;
}

TEST_F(ImageFile, PngKeepsTheTexts) {
  Image image = noise(5, 3, {"R", "G", "B"});
  image.metadata() = {{"command", "limn render 'a b' --out x.png"}, {"version", "0.1.0"}};
  writePng(folder_ / "a.png", image);
  EXPECT_EQ(readImage(folder_ / "a.png").metadata(), image.metadata());
  const auto chunks = textChunks(readTextFile(folder_ / "a.png"));
  EXPECT_EQ(chunks.at("limn/command"), image.metadata().at("command"));
  EXPECT_EQ(chunks.at("limn/version"), "0.1.0");
  writePng(folder_ / "b.png", image);
  EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png"));
  image.metadata().clear();
  writePng(folder_ / "c.png", image);
  EXPECT_EQ(readImage8(folder_ / "a.png").data, readImage8(folder_ / "c.png").data);
}

TEST_F(ImageFile, PngReadsBackLinear) {
  Image image = Image::rgb(256, 1);
  for (int x = 0; x < 256; ++x) {
    for (int c = 0; c < 3; ++c) image.at(x, 0, c) = static_cast<float>(x) / 255.0f;
  }
  writePng(folder_ / "a.png", image);
  const Image back = readImage(folder_ / "a.png");
  // Half a step of 1/255 in sRGB is at most 0.5 / 255 * 2.28 in linear values (the slope of the decoding at
  // 1).
  for (int x = 0; x < 256; ++x) EXPECT_NEAR(back.at(x, 0, 0), image.at(x, 0, 0), 0.5 / 255 * 2.28);
  writePng(folder_ / "b.png", back);
  EXPECT_EQ(readImage8(folder_ / "a.png").data, readImage8(folder_ / "b.png").data);
}

TEST_F(ImageFile, ReadsHdrJpegGreyAndAlpha) {
  std::vector<float> colour(16 * 16 * 3, 3.0f);
  writeForeign(folder_ / "a.hdr", 16, 16, 3, colour, OIIO::TypeDesc::FLOAT);
  EXPECT_NEAR(readImage(folder_ / "a.hdr").at(5, 5, 1), 3.0f, 3.0f / 128);

  std::fill(colour.begin(), colour.end(), 0.5f);
  writeForeign(folder_ / "a.jpg", 16, 16, 3, colour, OIIO::TypeDesc::UINT8);
  EXPECT_NEAR(readImage8(folder_ / "a.jpg").data[0], 128, 2);
  EXPECT_NEAR(readImage(folder_ / "a.jpg").at(3, 3, 2), 0.2140f, 0.01f);

  writeForeign(folder_ / "grey.png", 2, 1, 1, {0.0f, 1.0f}, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(readImage8(folder_ / "grey.png").data,
            (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 255}));
  EXPECT_EQ(readImage(folder_ / "grey.png").channels(), (std::vector<std::string>{"Y"}));

  writeForeign(folder_ / "alpha.png", 1, 1, 4, {1.0f, 0.2f, 0.0f, 0.4f}, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(readImage8(folder_ / "alpha.png").data, (std::vector<std::uint8_t>{255, 51, 0, 102}));
  EXPECT_NEAR(readImage(folder_ / "alpha.png").at(0, 0, 3), 0.4f, 1e-6f);  // alpha is linear already

  writeForeign(folder_ / "deep.png", 1, 1, 3, {0.25f, 0.5f, 1.0f}, OIIO::TypeDesc::UINT16);
  EXPECT_EQ(readImage8(folder_ / "deep.png").data, (std::vector<std::uint8_t>{64, 128, 255, 255}));
}

/// The size of a Radiance file says from where rows and columns are stored: "-Y" from the top, "+X" from the
/// left.
TEST_F(ImageFile, HdrIsTurnedAsItsSizeSays) {
  const auto reds = [&](const std::string& size) {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n";
    for (int exponent = 129; exponent < 135; ++exponent)  // 1, 2, 4 and so on
      text += {static_cast<char>(128), 0, 0, static_cast<char>(exponent)};
    writeTextFile(folder_ / "a.hdr", text);
    const Image image = readImage(folder_ / "a.hdr");
    EXPECT_EQ(image.width(), 3);
    std::vector<float> values;
    for (std::size_t i = 0; i < image.data().size(); i += 3) values.push_back(image.data()[i]);
    return values;
  };
  EXPECT_EQ(reds("-Y 2 +X 3"), (std::vector<float>{1, 2, 4, 8, 16, 32}));
  EXPECT_EQ(reds("+Y 2 +X 3"), (std::vector<float>{8, 16, 32, 1, 2, 4}));
  EXPECT_EQ(reds("-Y 2 -X 3"), (std::vector<float>{4, 2, 1, 32, 16, 8}));
  EXPECT_EQ(reds("+Y 2 -X 3"), (std::vector<float>{32, 16, 8, 4, 2, 1}));
  for (const char* columns : {"+X 2 -Y 3", "+X 2 +Y 3", "-X 2 +Y 3", "-X 2 -Y 3"})
    expectRefusal([&] { reds(columns); }, "a.hdr: a size that begins with X");
}

/// Cropped files hold the same picture as whole ones, whatever part of it they leave out or add beyond it.
TEST_F(ImageFile, ExrIsAsLargeAsItsDisplayWindow) {
  constexpr int left = 3, top = -2, width = 8, height = 6;
  const auto valueAt = [](int x, int y) { return static_cast<float>(100 + x + 20 * y); };
  const fs::path file = folder_ / "a.exr";
  const OIIO::ROI windows[] = {OIIO::ROI(left, left + width, top, top + 3),
                               OIIO::ROI(left + 2, left + 5, top + 1, top + 5),
                               OIIO::ROI(left - 2, left + width + 4, top - 1, top + height + 3),
                               OIIO::ROI(left + width, left + width + 4, top, top + 4)};
  for (const OIIO::ROI& window : windows) {
    OIIO::ImageSpec spec(window.width(), window.height(), 3, OIIO::TypeDesc::FLOAT);
    spec.set_roi(window);
    spec.set_roi_full(OIIO::ROI(left, left + width, top, top + height));
    std::vector<float> pixels;
    for (int y = window.ybegin; y < window.yend; ++y)
      for (int x = window.xbegin; x < window.xend; ++x) pixels.insert(pixels.end(), 3, valueAt(x, y));
    auto output = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(output && output->open(file.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());

    const Image image = readImage(file);
    ASSERT_EQ(image.width(), width);
    ASSERT_EQ(image.height(), height);
    const ImageChannel first = readFirstChannelMemory(readFile(file), "a.exr", width * height);
    ASSERT_EQ(first.values.size(), image.pixelCount());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float expected = window.contains(left + x, top + y) ? valueAt(left + x, top + y) : 0.0f;
        for (int c = 0; c < 3; ++c) EXPECT_EQ(image.at(x, y, c), expected) << x << ' ' << y;
        EXPECT_EQ(first.values[static_cast<std::size_t>(y * width + x)], expected) << x << ' ' << y;
      }
  }
}

TEST_F(ImageFile, ContentDecidesTheDecoder) {
  writePng(folder_ / "a.png", Image::rgb(2, 2));
  fs::rename(folder_ / "a.png", folder_ / "a.exr");
  EXPECT_EQ(readImage(folder_ / "a.exr").width(), 2);
  const auto bytes = readFile(folder_ / "a.exr");
  EXPECT_EQ(readImage8Memory(bytes, "texture 3").height, 2);
}

TEST_F(ImageFile, RefusesWhatIsNotAPicture) {
  expectRefusal([&] { readImage(folder_ / "none.exr"); }, "none.exr: no such file");
  expectRefusal([&] { readImage(folder_); }, "not a regular file");
  writeTextFile(folder_ / "text.png", "hello");
  expectRefusal([&] { readImage(folder_ / "text.png"); }, "text.png: not a picture");
  writeTextFile(folder_ / "empty.exr", "");
  expectRefusal([&] { readImage(folder_ / "empty.exr"); }, "empty.exr");
  writeExr(folder_ / "float.exr", Image::rgb(2, 2));
  expectRefusal([&] { readImage8(folder_ / "float.exr"); }, "PNG, JPEG or WebP");
}

TEST_F(ImageFile, RefusesTruncatedPicturesOfEveryFormat) {
  const Image image = noise(64, 64, {"R", "G", "B"});
  const std::vector<float> pixels(image.data().begin(), image.data().end());
  writeExr(folder_ / "a.exr", image);
  writeForeign(folder_ / "a.hdr", 64, 64, 3, pixels, OIIO::TypeDesc::FLOAT);
  writeForeign(folder_ / "a.png", 64, 64, 3, pixels, OIIO::TypeDesc::UINT8);
  writeForeign(folder_ / "a.jpg", 64, 64, 3, pixels, OIIO::TypeDesc::UINT8);
  for (const char* name : {"a.exr", "a.hdr", "a.png", "a.jpg"}) {
    const std::vector<std::byte> whole = readFile(folder_ / name);
    EXPECT_NO_THROW(readImageMemory(whole, name));
    for (const double part : {0.01, 0.1, 0.5, 0.9, 0.97}) {
      const std::size_t size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
      expectRefusal([&] { readImageMemory(std::span(whole).first(size), name); }, name);
    }
  }
}

TEST_F(ImageFile, SurvivesDamagedBytes) {
  writeExr(folder_ / "a.exr", noise(32, 32, {"R", "G", "B"}));
  writePng(folder_ / "a.png", noise(32, 32, {"R", "G", "B"}));
  std::mt19937 generator(3);
  for (const char* name : {"a.exr", "a.png"}) {
    const std::vector<std::byte> whole = readFile(folder_ / name);
    for (int trial = 0; trial < 100; ++trial) {
      std::vector<std::byte> damaged = whole;
      for (int i = 0; i < 4; ++i) damaged[generator() % damaged.size()] = static_cast<std::byte>(generator());
      try {
        readImageMemory(damaged, name);
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  }
}

TEST_F(ImageFile, RefusesHugeHeaders) {
  // A PNG header that claims 2^30 x 2^30 pixels.
  writePng(folder_ / "a.png", Image::rgb(2, 2));
  std::vector<std::byte> bytes = readFile(folder_ / "a.png");
  bytes[16] = bytes[20] = std::byte{0x40};
  EXPECT_THROW(readImageMemory(bytes, "huge.png"), Error);
}

TEST_F(ImageFile, WritesWholeOrNotAtAll) {
  const Image image = noise(256, 256, {"R", "G", "B"});
  expectRefusal([&] { writeExr(folder_ / "none" / "a.exr", image); },
                "a.exr: cannot be written: No such file");
  expectRefusal([&] { writeImage(folder_ / "a.tiff", image); }, "'.tiff'");
  EXPECT_THROW(writeImage(folder_ / "a.tiff", image), UsageError);
  expectRefusal([&] { writeExr(folder_ / "a.exr", Image()); }, "empty");

  // A disk that is full after 4 KiB, played by the file size limit. The old file stays.
  writeTextFile(folder_ / "a.exr", "old");
  const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string exr = messageOf([&] { writeExr(folder_ / "a.exr", image); });
  const std::string png = messageOf([&] { writePng(folder_ / "b.png", image); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, oldHandler);
  EXPECT_NE(exr.find("a.exr: cannot be written"), std::string::npos) << exr;
  EXPECT_NE(png.find("b.png: cannot be written"), std::string::npos) << png;
  EXPECT_EQ(fileCount(), 1u);
  EXPECT_EQ(readTextFile(folder_ / "a.exr"), "old");
}

}  // namespace
}  // namespace limn
