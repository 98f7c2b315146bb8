#include "core/brdf/measured_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/brdf/merl_file.h"
#include "tests/unit/brdf/tensor_builder.h"

namespace limn::brdf {
namespace {

using namespace test;
using testing::HasSubstr;

/// A table whose values tell their places: none is like another.
AnisotropicTable counted(int size) {
  AnisotropicTable table{.size = size, .values = {}};
  const int count = size * size * size * size;
  for (int i = 0; i < count; ++i)
    table.values.push_back(glm::vec3(i, 0.25f * static_cast<float>(i), 1) / static_cast<float>(count));
  return table;
}

std::string refusedTable(const std::vector<std::byte>& bytes, std::string_view name = "cloth.bsdf") {
  try {
    decodeMeasured(bytes, name);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(std::string(name) + ": "));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "read";
}

std::string refusedToEncode(const AnisotropicTable& table, MeasuredFormat format = MeasuredFormat::half) {
  try {
    encodeMeasured(table, format);
  } catch (const Error& error) {
    return error.what();
  }
  return "encoded";
}

TEST(MeasuredFile, FloatsComeBackToTheBitAndHalvesRounded) {
  AnisotropicTable table = counted(3);
  table.values[7] = {0, 65504, 1e-8f};
  const auto floats = decodeMeasured(encodeMeasured(table, MeasuredFormat::float32), "any name");
  ASSERT_TRUE(std::holds_alternative<AnisotropicTable>(floats));
  EXPECT_EQ(std::get<AnisotropicTable>(floats).size, 3);
  EXPECT_EQ(std::get<AnisotropicTable>(floats).values, table.values);

  const std::vector<std::byte> bytes = encodeMeasured(table);
  EXPECT_LT(bytes.size(), 81u * 6 + 100);
  const AnisotropicTable halves = decodeDiscPairs(bytes, "any name");
  ASSERT_EQ(halves.values.size(), table.values.size());
  for (std::size_t i = 0; i < table.values.size(); ++i)
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_EQ(halves.values[i][channel], glm::unpackHalf1x16(glm::packHalf1x16(table.values[i][channel])));
}

// Written by the other encoder, that of the tests: v.y slowest, channels fastest.
TEST(MeasuredFile, OrderOfAxes) {
  const AnisotropicTable table = counted(2);
  Array array{.shape = {2, 2, 2, 2, 3}, .values = {}};
  for (int vy = 0; vy < 2; ++vy)
    for (int vx = 0; vx < 2; ++vx)
      for (int ly = 0; ly < 2; ++ly)
        for (int lx = 0; lx < 2; ++lx) {
          const glm::vec3 f = table.evaluate(table.texelDirection(lx, ly), table.texelDirection(vx, vy));
          for (int channel = 0; channel < 3; ++channel) array.values.push_back(f[channel]);
        }
  const AnisotropicTable read = decodeDiscPairs(tensorFile({{"disc_pairs", array}}), "file");
  for (std::size_t i = 0; i < table.values.size(); ++i)
    EXPECT_NEAR(glm::distance(read.values[i], table.values[i]), 0, 1e-6f);
}

TEST(MeasuredFile, FilesAppearWholeAndAreToldApart) {
  std::string name = (std::filesystem::temp_directory_path() / "limn-measured-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  const std::filesystem::path folder = name, path = folder / "cloth.bsdf";
  writeMeasured(path, counted(4), MeasuredFormat::float32);
  EXPECT_EQ(std::get<AnisotropicTable>(readMeasured(path)).values, counted(4).values);
  try {
    writeMeasured(path, {});
    ADD_FAILURE() << "an empty table was written";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(path.string() + ": a table of 0 texels"));
  }
  EXPECT_EQ(std::get<AnisotropicTable>(readMeasured(path)).size, 4);
  EXPECT_THROW(readMeasured(folder / "none.bsdf"), Error);

  TabulatedBrdf paint{.size = kMerlSize, .values = {}};
  paint.values.assign(90 * 90 * 180, glm::vec3(0.5f));
  writeMerl(folder / "paint.binary", paint);
  EXPECT_EQ(std::get<TabulatedBrdf>(readMeasured(folder / "paint.binary")).size, kMerlSize);
  std::filesystem::remove_all(folder);

  // Without the array it is a file of the RGL, or a broken one.
  EXPECT_THAT(refusedTable(tensorFile({{"phi_i", {{1}, {0}}}})), HasSubstr("without the array 'theta_i'"));
  EXPECT_THAT(refusedTable({}), HasSubstr("'tensor_file'"));
  EXPECT_THAT(refusedTable({}, "paint.binary"), HasSubstr("too short for a MERL BRDF"));
}

TEST(MeasuredFile, WrongDimensionsEndInOneLine) {
  const auto shaped = [](const std::vector<std::uint64_t>& shape, std::size_t count) {
    return refusedTable(tensorFile({{"disc_pairs", {shape, std::vector<float>(count, 1)}}}));
  };
  EXPECT_EQ(shaped({1, 1, 1, 1, 3}, 3), "read");
  EXPECT_THAT(shaped({2, 2, 2, 2}, 16), HasSubstr("array 'disc_pairs' has 4 dimensions of type 10"));
  EXPECT_THAT(shaped({2, 2, 2, 1, 3}, 24), HasSubstr("is 2 x 2 x 2 x 1 x 3; N x N x N x N x 3"));
  EXPECT_THAT(shaped({2, 2, 2, 2, 1}, 16), HasSubstr("is 2 x 2 x 2 x 2 x 1"));
  EXPECT_THAT(shaped({49, 1, 1, 1, 3}, 147), HasSubstr("with N from 1 to 48"));
  EXPECT_THAT(shaped({0, 0, 0, 0, 3}, 0), HasSubstr("none of them empty"));
  // Sides whose product overflows, or is more than there are bytes.
  const std::uint64_t many = std::uint64_t{1} << 32;
  EXPECT_THAT(shaped({many, many, many, many, 3}, 3), HasSubstr("lies beyond"));
  EXPECT_THAT(shaped({48, 48, 48, 48, 3}, 3), HasSubstr("lies beyond"));
}

TEST(MeasuredFile, ShortFilesAndOtherTypesEndInOneLine) {
  const std::vector<std::byte> good = encodeMeasured(counted(2));
  EXPECT_EQ(refusedTable(good), "read");
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(refusedTable({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}), "read")
        << length;
  // The type stands behind magic, version, count, name and dimensions.
  const std::size_t type = 12 + 2 + 4 + 2 + 10 + 2;
  std::vector<std::byte> bytes = good;
  ASSERT_EQ(bytes[type], std::byte{9});
  bytes[type] = std::byte{4};  // of as many bytes
  EXPECT_THAT(refusedTable(bytes), HasSubstr("of type 4 and 96 bytes"));
}

TEST(MeasuredFile, ValuesThatAreNoneEndInOneLine) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float value : {std::nanf(""), infinity, -infinity, -1e-6f, 1.01e10f}) {
    EXPECT_THAT(refusedTable(tensorFile({{"disc_pairs", {{1, 1, 1, 1, 3}, {1, value, 1}}}})),
                HasSubstr("array 'disc_pairs' holds"));
    AnisotropicTable table = counted(1);
    table.values[0].y = value;
    for (const MeasuredFormat format : {MeasuredFormat::half, MeasuredFormat::float32})
      EXPECT_THAT(refusedToEncode(table, format), HasSubstr("a table that holds"));
  }
  // Halves that are no numbers: infinity, NaN and -1.
  for (const std::uint16_t value : {0x7c00, 0x7e01, 0xbc00}) {
    std::vector<std::byte> bytes = encodeMeasured(counted(1));
    std::memcpy(bytes.data() + bytes.size() - 4, &value, sizeof value);
    EXPECT_THAT(refusedTable(bytes), HasSubstr("array 'disc_pairs' holds"));
  }
  AnisotropicTable bright = counted(1);
  bright.values[0].x = 65505;
  EXPECT_THAT(refusedToEncode(bright), HasSubstr("numbers from 0 to 65504"));
  EXPECT_EQ(refusedToEncode(bright, MeasuredFormat::float32), "encoded");
  EXPECT_THAT(refusedToEncode({.size = 2, .values = {}}), HasSubstr("2 texels a side and 0 values"));
  EXPECT_THAT(refusedToEncode({.size = -1, .values = {}}), HasSubstr("-1 texels"));
  EXPECT_THAT(refusedToEncode(AnisotropicTable{.size = 49, .values = {}}), HasSubstr("1 to 48"));
}

}  // namespace
}  // namespace limn::brdf
