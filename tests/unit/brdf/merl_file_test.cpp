#include "core/brdf/merl_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <limits>
#include <tuple>
#include <variant>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/brdf/measured_file.h"
#include "tests/unit/brdf/materials.h"

namespace limn::brdf {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr glm::ivec3 kSmall{4, 3, 2};

std::vector<std::byte> smallFile() {
  TabulatedBrdf table{.size = kSmall, .values = {}};
  for (int i = 0; i < 24; ++i) table.values.emplace_back(0.1f * static_cast<float>(i), 1, 0.5f);
  return encodeMerl(table);
}

void put(std::vector<std::byte>& bytes, std::size_t number, double value) {
  std::memcpy(bytes.data() + 12 + 8 * number, &value, sizeof value);
}

std::string refusedMerl(const std::vector<std::byte>& bytes, const glm::ivec3& size = kSmall) {
  try {
    decodeMerl(bytes, "paint.binary", size);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("paint.binary: "));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "read";
}

TEST(MerlFile, ScalesAndOrderAreTheDatabases) {
  // By hand, as the format is published: planes of red, green, blue; phiD fastest.
  std::vector<std::byte> bytes(12 + 8 * 3 * 24);
  const std::int32_t header[] = {4, 3, 2};
  std::memcpy(bytes.data(), header, sizeof header);
  for (std::size_t i = 0; i < 72; ++i) put(bytes, i, 1500);
  put(bytes, (2 * 3 + 1) * 2 + 1, 3000);
  const TabulatedBrdf table = decodeMerl(bytes, "file", kSmall);
  EXPECT_EQ(table.size, kSmall);
  EXPECT_NEAR(table.values[0].x, 1, 1e-6f);
  EXPECT_NEAR(table.values[0].y, 1.15f, 1e-6f);
  EXPECT_NEAR(table.values[0].z, 1.66f, 1e-6f);
  const auto [l, v] = directions(table.node(2, 1, 1));
  EXPECT_NEAR(table.evaluate(l, v).x, 2, 1e-4f);
}

TEST(MerlFile, WhatIsWrittenIsReadToTheBit) {
  std::string folder = (std::filesystem::temp_directory_path() / "limn-merl-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::filesystem::path path = std::filesystem::path(folder) / "gold.binary";
  const Microfacets gold{.m = 0.3};
  TabulatedBrdf table = tabulate(kMerlSize, gold);
  writeMerl(path, table);
  EXPECT_EQ(std::filesystem::file_size(path), 34992012u);
  EXPECT_EQ(std::get<TabulatedBrdf>(readMeasured(path)).values, table.values);

  // A byte too many is refused, and one too few.
  std::filesystem::resize_file(path, 34992013);
  EXPECT_THROW(readMeasured(path), Error);
  std::filesystem::resize_file(path, 34992011);
  EXPECT_THROW(readMeasured(path), Error);
  EXPECT_THROW(readMeasured(path / "none"), Error);

  table = tabulate(kSmall, gold);
  EXPECT_THROW(writeMerl(path, table), Error);
  std::filesystem::remove_all(folder);
}

TEST(MerlFile, NegativeNumbersAreGaps) {
  std::vector<std::byte> bytes = smallFile();
  const TabulatedBrdf whole = decodeMerl(bytes, "file", kSmall);
  put(bytes, 24 + 5, -1);  // green of node 5
  const TabulatedBrdf table = decodeMerl(bytes, "file", kSmall);
  EXPECT_NEAR(table.values[5].y, whole.values[5].y, 1e-6f);
  for (const glm::vec3& f : table.values) EXPECT_GE(f.x, 0);
  for (std::size_t i = 0; i < 24; ++i) put(bytes, 48 + i, -1e300);
  EXPECT_THAT(refusedMerl(bytes), HasSubstr("without any measured node"));
}

TEST(MerlFile, BrokenFilesEndInOneLine) {
  const std::vector<std::byte> good = smallFile();
  EXPECT_EQ(refusedMerl(good), "read");
  EXPECT_THAT(refusedMerl({}), HasSubstr("0 bytes, too short for a MERL BRDF of 4 x 3 x 2"));
  EXPECT_THAT(refusedMerl({good.begin(), good.begin() + 11}), HasSubstr("11 bytes"));
  EXPECT_THAT(refusedMerl({good.begin(), good.end() - 1}),
              HasSubstr("587 bytes; a MERL BRDF of 4 x 3 x 2 nodes has 588"));
  std::vector<std::byte> bytes = good;
  bytes.push_back({});
  EXPECT_THAT(refusedMerl(bytes), HasSubstr("589 bytes"));
  // A header that promises other nodes, or none, or more than there is memory.
  EXPECT_THAT(refusedMerl(good, kMerlSize),
              HasSubstr("not a MERL BRDF: 4 x 3 x 2 nodes; 90 x 90 x 180 are accepted"));
  for (const std::int32_t side : {0, -3, 2147483647, -2147483647 - 1}) {
    bytes = good;
    std::memcpy(bytes.data() + 4, &side, sizeof side);
    EXPECT_THAT(refusedMerl(bytes), HasSubstr("4 x 3 x 2 are accepted"));
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double number : {std::nan(""), infinity, -infinity, 1e300, 1.6e13}) {
    bytes = good;
    put(bytes, 24 + 3, number);
    EXPECT_THAT(refusedMerl(bytes), HasSubstr("at node 3 of green: f from 0 to 1e+10"));
  }
}

/// A lookup as programs that read these files have it: the node below, whatever the remainder.
BrdfFunction truncated(const TabulatedBrdf& table) {
  return [&table](const glm::vec3& l, const glm::vec3& v) {
    const HalfDifference a = halfDifference(l, v);
    const double u[] = {std::sqrt(a.thetaH * 2 / kPi), a.thetaD * 2 / kPi, a.phiD / kPi};
    std::size_t node = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int at = std::min(static_cast<int>(u[axis] * table.size[axis]), table.size[axis] - 1);
      node = node * static_cast<std::size_t>(table.size[axis]) + static_cast<std::size_t>(at);
    }
    return table.values[node];
  };
}

// Published for other lights: 1.9 % and 5.8 % too bright by truncation, and 0.003 and 0.010 of error without
// it.
TEST(MerlFile, TrilinearLookupIsUnbiasedWhereTruncationIsNot) {
  for (const auto& [m, bias, bound] : {std::tuple(0.3, 0.019, 0.003), std::tuple(0.1, 0.058, 0.010)}) {
    const Microfacets metal{.m = m};
    const TabulatedBrdf table = tabulate(kMerlSize, metal);
    const SphereError ours = compareOnSphere(lookup(table), metal);
    const SphereError usual = compareOnSphere(truncated(table), metal);
    EXPECT_LT(ours.rms, bound) << m;
    EXPECT_GT(usual.bias, bias) << m;
    EXPECT_LT(std::abs(ours.bias), 0.03 * usual.bias) << m;
  }
}

}  // namespace
}  // namespace limn::brdf
