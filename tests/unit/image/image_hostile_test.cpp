// Pictures made to fill the memory or to keep the decoder busy: refused in one line before anything is taken.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"

namespace limn {
namespace {

using testing::HasSubstr;
using testing::Not;

/// An OpenEXR file of one part, by "OpenEXR File Layout", with `body` zeros for its pixels.
class ExrBuilder {
 public:
  std::array<std::int32_t, 4> dataWindow{0, 0, 63, 63};
  std::optional<std::array<std::int32_t, 4>> displayWindow;  ///< none: the same
  std::optional<std::array<std::uint32_t, 2>> tiles;
  int channels = 3;
  std::vector<std::byte> extra;
  std::size_t body = 4000;

  std::vector<std::byte> bytes() const {
    std::vector<std::byte> out;
    number(out, 20000630);
    number(out, tiles ? 0x202 : 2);
    std::vector<std::byte> list;
    for (int i = 0; i < channels; ++i) {
      text(list, "c" + std::to_string(1000 + i));
      for (const std::uint32_t value : {1, 0, 1, 1}) number(list, value);  // half, linear, every pixel
    }
    list.push_back({});
    attribute(out, "channels", "chlist", list);
    attribute(out, "compression", "compression", {std::byte{3}});
    for (const auto& [name, window] :
         {std::pair("dataWindow", dataWindow), {"displayWindow", displayWindow.value_or(dataWindow)}}) {
      std::vector<std::byte> box;
      for (const std::int32_t side : window) number(box, static_cast<std::uint32_t>(side));
      attribute(out, name, "box2i", box);
    }
    attribute(out, "lineOrder", "lineOrder", {std::byte{0}});
    attribute(out, "pixelAspectRatio", "float",
              std::vector<std::byte>{{}, {}, std::byte{0x80}, std::byte{0x3f}});
    attribute(out, "screenWindowCenter", "v2f", std::vector<std::byte>(8));
    attribute(out, "screenWindowWidth", "float", std::vector<std::byte>(4));
    if (tiles) {
      std::vector<std::byte> tile;
      number(tile, (*tiles)[0]);
      number(tile, (*tiles)[1]);
      tile.push_back({});
      attribute(out, "tiles", "tiledesc", tile);
    }
    out.insert(out.end(), extra.begin(), extra.end());
    out.resize(out.size() + 1 + body);
    return out;
  }
  static void number(std::vector<std::byte>& out, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(value >> 8 * i));
  }
  static void text(std::vector<std::byte>& out, const std::string& value) {
    for (const char c : value) out.push_back(static_cast<std::byte>(c));
    out.push_back({});
  }

  static void attribute(std::vector<std::byte>& out, const std::string& name, const std::string& type,
                        const std::vector<std::byte>& value) {
    text(out, name);
    text(out, type);
    number(out, static_cast<std::uint32_t>(value.size()));
    out.insert(out.end(), value.begin(), value.end());
  }
};

std::string refusal(std::span<const std::byte> bytes) {
  try {
    readImageMemory(bytes, "bomb.exr");
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    EXPECT_THAT(error.what(), HasSubstr("bomb.exr: "));
    return error.what();
  }
  return {};
}

/// The most memory the process has held so far, bytes.
long mostMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * usage.ru_maxrss;
}

TEST(HostileImage, AttributesLongerThanTheFile) {
  ExrBuilder exr;
  ExrBuilder::text(exr.extra, "comment");
  ExrBuilder::text(exr.extra, "string");
  ExrBuilder::number(exr.extra, 0x7fffffff);
  const long before = mostMemory();
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("truncated or damaged OpenEXR header"));
  EXPECT_LT(mostMemory() - before, 100l << 20);
}

// The library reads a list of channels up to its empty name: a list that says it is one byte long hides an
// attribute of two gigabytes from whoever goes by the lengths.
TEST(HostileImage, AttributesHiddenBehindAShorterLength) {
  ExrBuilder exr;
  std::vector<std::byte> hidden;
  ExrBuilder::text(hidden, "c");
  for (int i = 0; i < 4; ++i) ExrBuilder::number(hidden, 1);
  ExrBuilder::text(hidden, "");
  ExrBuilder::text(hidden, "comment");
  ExrBuilder::text(hidden, "string");
  ExrBuilder::number(hidden, 0x7fffffff);
  ExrBuilder::attribute(exr.extra, "more", "chlist", {hidden.front()});
  exr.extra.insert(exr.extra.end(), hidden.begin() + 1, hidden.end());
  const long before = mostMemory();
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("truncated or damaged OpenEXR header"));
  EXPECT_LT(mostMemory() - before, 100l << 20);
}

TEST(HostileImage, AttributesAreAsLongAsAValueOfTheirType) {
  const auto with = [](const std::string& type, const std::vector<std::byte>& value) {
    ExrBuilder exr;
    ExrBuilder::attribute(exr.extra, "more", type, value);
    return refusal(exr.bytes());
  };
  const auto damaged = HasSubstr("truncated or damaged OpenEXR header");
  for (const auto& [type, size] : {std::pair("box2i", 16), {"lineOrder", 1}, {"m44d", 128}, {"v3f", 12}}) {
    EXPECT_THAT(with(type, std::vector<std::byte>(size)), Not(damaged)) << type;
    EXPECT_THAT(with(type, std::vector<std::byte>(size - 1)), damaged) << type;
    EXPECT_THAT(with(type, std::vector<std::byte>(size + 1)), damaged) << type;
  }
  EXPECT_THAT(with("of another house", std::vector<std::byte>(77)), Not(damaged));

  std::vector<std::byte> texts;
  ExrBuilder::number(texts, 1);
  texts.push_back(std::byte{'a'});
  EXPECT_THAT(with("stringvector", texts), Not(damaged));
  ExrBuilder::number(texts, 0x7fffffff);
  EXPECT_THAT(with("stringvector", texts), damaged);

  std::vector<std::byte> preview;
  for (const std::uint32_t value : {2, 1, 0, 0}) ExrBuilder::number(preview, value);
  EXPECT_THAT(with("preview", preview), Not(damaged));
  preview[0] = std::byte{3};
  EXPECT_THAT(with("preview", preview), damaged);
  preview[3] = preview[7] = std::byte{0x7f};
  EXPECT_THAT(with("preview", preview), damaged);
}

TEST(HostileImage, TilesLargerThanThePicture) {
  ExrBuilder exr;
  exr.tiles = {{16000, 8000}};
  const long before = mostMemory();
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("tiles of 16000x8000 pixels of 3 channels; at most 16777216"));
  exr.tiles = {{0xffffffff, 0xffffffff}};
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("tiles of 4294967295x4294967295 pixels"));
  exr.tiles = {{2048, 2048}};
  exr.channels = 200;
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("tiles of 2048x2048 pixels of 200 channels"));
  EXPECT_LT(mostMemory() - before, 100l << 20);
}

TEST(HostileImage, SizesFarBeyondTheFile) {
  const long before = mostMemory();
  ExrBuilder exr;
  exr.dataWindow = {0, 0, 8191, 8191};
  exr.body = 1'000'000;
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("8192x8192 pixels of 3 channels in"));
  exr.dataWindow = {0, 0, 1023, 1023};
  exr.channels = 250;
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("1024x1024 pixels of 250 channels in"));
  exr.dataWindow = {0, 0, 63, 63};
  exr.channels = 5000;
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("64x64 pixels of 5000 channels; at most"));
  exr.channels = 3;
  exr.dataWindow = {0, 0, 32767, 32767};
  EXPECT_NE(refusal(exr.bytes()), "");
  exr.dataWindow = {-0x7fffffff, -0x7fffffff, 0x7fffffff, 0x7fffffff};
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("4294967295x4294967295 pixels; at most 32768 per side"));
  // The library takes memory for lines of any width before anybody else can see how wide they are.
  exr.dataWindow = {0, 0, 16056321, 0};
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("16056322x1 pixels; at most 32768 per side"));
  EXPECT_LT(mostMemory() - before, 200l << 20);
}

TEST(HostileImage, PicturesFarBeyondTheirPixels) {
  const long before = mostMemory();
  ExrBuilder exr;
  exr.displayWindow = {0, 0, 8191, 8191};
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("8192x8192 pixels of 3 channels in"));
  exr.displayWindow = {-0x3ffffff0, -0x3ffffff0, 0x3ffffff0, 0x3ffffff0};
  EXPECT_THAT(refusal(exr.bytes()), HasSubstr("2147483617x2147483617 pixels of 3 channels; at most"));
  EXPECT_LT(mostMemory() - before, 100l << 20);
}

TEST(HostileImage, HeadersCutOffAnywhere) {
  const std::vector<std::byte> whole = ExrBuilder().bytes();
  for (std::size_t size = 4; size < whole.size(); size += size < 400 ? 1 : 100)
    EXPECT_NE(refusal(std::span(whole).first(size)), "") << size;
}

/// A picture in a format, from OpenImageIO's own encoder.
std::vector<std::byte> encoded(const char* format, const OIIO::TypeDesc& type) {
  std::vector<float> pixels(24 * 16 * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i % 97) / 97;
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create(format);
  output->set_ioproxy(&memory);
  EXPECT_TRUE(output->open(std::string("a.") + format, OIIO::ImageSpec(24, 16, 3, type)));
  EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
  const auto bytes = std::as_bytes(std::span(memory.buffer()));
  return {bytes.begin(), bytes.end()};
}

// The table of an EXR of one block of lines says that the block begins behind the table.
TEST(HostileImage, LinesBeforeTheFileOrBehindIt) {
  const std::vector<std::byte> whole = encoded("exr", OIIO::TypeDesc::FLOAT);
  const auto entryAt = [&](std::size_t place) {
    std::uint64_t entry = 0;
    std::memcpy(&entry, &whole.at(place), sizeof entry);
    return entry;
  };
  std::size_t table = 0;
  while (entryAt(table) != table + sizeof(std::uint64_t)) ++table;
  using Limits = std::numeric_limits<std::int64_t>;
  for (const std::int64_t place : {std::int64_t{-1}, std::int64_t{-40}, -(std::int64_t{1} << 40),
                                   Limits::min(), std::int64_t{1} << 40, Limits::max()}) {
    std::vector<std::byte> astray = whole;
    std::memcpy(&astray.at(table), &place, sizeof place);
    EXPECT_NE(refusal(astray), "") << place;
  }
}

// A pass over the whole picture for four bytes of the file.
TEST(HostileImage, JpegsOfManyScans) {
  const auto file =
      std::filesystem::temp_directory_path() / ("limn_scans_" + std::to_string(::getpid()) + ".jpg");
  const auto output = OIIO::ImageOutput::create("jpeg");
  const std::vector<std::uint8_t> pixels(16 * 16 * 3, 128);
  ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(16, 16, 3, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close());
  std::vector<std::byte> bytes = readFile(file);
  std::filesystem::remove(file);
  EXPECT_EQ(refusal(bytes), "");
  bytes.resize(bytes.size() - 2);  // the end marker
  for (int scan = 0; scan < 100; ++scan)
    for (const int byte : {0xff, 0xda, 0, 2}) bytes.push_back(static_cast<std::byte>(byte));
  for (const int byte : {0xff, 0xd9}) bytes.push_back(static_cast<std::byte>(byte));
  EXPECT_THAT(refusal(bytes), HasSubstr("more than 100 scans"));
}

TEST(HostileImage, DamagedPicturesOfEveryFormat) {
  std::mt19937 random(11);
  const long before = mostMemory();
  int refused = 0;
  for (const auto& [format, type] : {std::pair("exr", OIIO::TypeDesc::HALF),
                                     {"exr", OIIO::TypeDesc::FLOAT},
                                     {"png", OIIO::TypeDesc::UINT8}}) {
    const std::vector<std::byte> whole = encoded(format, type);
    ASSERT_EQ(refusal(whole), "");
    for (int trial = 0; trial < 300; ++trial) {
      std::vector<std::byte> damaged = whole;
      const std::size_t range = trial % 2 ? damaged.size() : std::min<std::size_t>(damaged.size(), 400);
      for (unsigned i = 1 + random() % 3; i > 0; --i)
        damaged[4 + random() % (range - 4)] = static_cast<std::byte>(random() % 3 ? random() : 0xff);
      refused += !refusal(damaged).empty();
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_LT(mostMemory() - before, 700l << 20);
}

}  // namespace
}  // namespace limn
