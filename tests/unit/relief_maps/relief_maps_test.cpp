// Tables of height maps as the GPU reads them, and how numbers are packed in them.
#include "core/relief_maps/relief_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/relief/ellipse.h"
#include "core/relief/horizon.h"
#include "glsl/relief/bounce_paths.glsl"
#include "glsl/surface/gbuffer.glsl"
#include "tests/unit/relief/fields.h"

namespace limn::relief_maps {
namespace {

using relief::HeightField;

HeightField flat(const glm::ivec2& size, relief::Wrap wrap = relief::Wrap::periodic) {
  return {size, std::vector<float>(static_cast<size_t>(size.x * size.y), 0.25f), glm::dvec2(1), 1, 0, wrap};
}

glsl::ReliefEllipse stored(const ReliefTable& table, size_t word) {
  return glsl::relief_ellipse_unpack({table.values[word], table.values[word + 1], table.values[word + 2]});
}

TEST(ReliefMapsTest, TablesAreAsLargeAsTheySay) {
  const std::vector<HeightField> fields{flat({1, 1}), flat({1, 5}), flat({6, 3}),
                                        flat({4, 4}, relief::Wrap::clamped), relief::test::eggCrate(16)};
  for (const Table kind : {Table::moments, Table::nearest, Table::published, Table::ambient, Table::horizons,
                           Table::heights, Table::bounces}) {
    const ReliefMapDesc desc{.table = kind, .azimuths = 9, .directions = 64, .paths = 5};
    const ReliefTable table = makeReliefTable(fields, desc);
    EXPECT_EQ(static_cast<int64_t>(table.values.size()), reliefTableWords(fields, desc));
    ASSERT_EQ(table.fields.size(), fields.size());
    EXPECT_EQ(table.fields[0].first, 0u);
    for (size_t i = 0; i < fields.size(); ++i) {
      EXPECT_EQ(table.fields[i].size, fields[i].size());
      EXPECT_EQ(table.fields[i].clamped, i == 3 ? 1u : 0u);
    }
  }
}

TEST(ReliefMapsTest, FlatFieldsSeeTheWholeSkyAtAllLevels) {
  const std::vector<HeightField> fields{flat({6, 3})};
  const ReliefTable table = makeReliefTable(fields, {.table = Table::moments, .azimuths = 16});
  ASSERT_EQ(table.fields[0].levels, 3);  // 6 x 3, 3 x 1, 1 x 1
  for (size_t word = 0; word < table.values.size(); word += glsl::relief_ellipse_words) {
    const glsl::ReliefEllipse ellipse = stored(table, word);
    EXPECT_NEAR(glsl::ellipse_ambient(ellipse), 1, 1e-3);
    EXPECT_NEAR(ellipse.spread, 0, 1e-3);
    EXPECT_NEAR(glm::length(ellipse.centre), 0, 1e-4);
  }
}

TEST(ReliefMapsTest, TheLastLevelIsTheMeanOfAllTexels) {
  const std::vector<HeightField> fields{relief::test::eggCrate(16)};
  const ReliefTable table = makeReliefTable(fields, {.table = Table::moments, .azimuths = 16});
  relief::EllipseMean all;
  for (const glsl::ReliefEllipse& e : relief::momentEllipses(relief::sweepHorizons(fields[0], 16)))
    all.add(e);
  const glsl::ReliefEllipse mean = all.mean(), last = stored(table, table.values.size() - 3);
  EXPECT_GT(last.spread, 0.05f);
  EXPECT_NEAR(last.spread, mean.spread, 1e-4);
  EXPECT_NEAR(last.xx, mean.xx, 1e-4);
  EXPECT_NEAR(last.yy, mean.yy, 1e-4);
}

/// Steps of 0.2 m with a period of 0.25 m, of which the ones on top see all of the sky and the others half of
/// it or less: shares of texels average linearly, whatever ellipses of such a mean look like.
TEST(ReliefMapsTest, AmbientVisibilityIsTheShareOfTheSkyAtAllLevels) {
  constexpr int kSize = 64, kPeriod = 16, kAzimuths = 32;
  std::vector<float> values;
  for (int x = 0; x < kSize; ++x) values.push_back(x % kPeriod < kPeriod / 2 ? 0.2f : 0.f);
  const std::vector<HeightField> fields{flat({6, 3}), {{kSize, 1}, values, glm::dvec2(1)}};
  const ReliefTable table = makeReliefTable(fields, {.table = Table::ambient, .azimuths = kAzimuths});
  for (size_t word = 0; word < table.fields[1].first; ++word)
    EXPECT_EQ(std::bit_cast<float>(table.values[word]), 1);
  double mean = 0;
  for (int x = 0; x < kSize; ++x) {
    double share = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAzimuths;
      const double radius = relief::litRadius(relief::exactHorizon(fields[1], {x, 0}, angle));
      share += radius * radius / kAzimuths;
    }
    const auto word = table.fields[1].first + static_cast<uint32_t>(x);
    EXPECT_NEAR(std::bit_cast<float>(table.values[word]), share, 0.01) << x;
    mean += share / kSize;
  }
  EXPECT_EQ(table.fields[1].levels, 7);  // 64 x 1 to 1 x 1
  EXPECT_LT(mean, 0.75);
  EXPECT_NEAR(std::bit_cast<float>(table.values.back()), mean, 0.01);
}

TEST(ReliefMapsTest, BouncesAreTheTracedPathsToTheNearestTexel) {
  constexpr int kSize = 20, kPaths = 24;
  const std::vector<HeightField> fields{flat({3, 2}), relief::test::bricks(kSize, 1.2)};
  for (const relief::BounceDirections directions :
       {relief::BounceDirections::ownFrame, relief::BounceDirections::shared,
        relief::BounceDirections::published}) {
    const ReliefTable table =
        makeReliefTable(fields, {.table = Table::bounces, .paths = kPaths, .bounceDirections = directions});
    const HeightField& field = fields[1];
    const size_t texels = field.texels();
    const uint32_t* const words = table.values.data() + table.fields[1].first;
    const relief::BouncePaths traced = relief::traceBounces(field, directions, kPaths);
    int hits = 0;
    for (size_t texel = 0; texel < texels; ++texel) {
      const glm::ivec2 at(static_cast<int>(texel) % kSize, static_cast<int>(texel) / kSize);
      const glm::vec2 slope = glm::unpackHalf2x16(words[texel]);
      EXPECT_NEAR(slope.x, field.slope(at).x, 1e-3);
      EXPECT_NEAR(slope.y, field.slope(at).y, 1e-3);
      const float scale = std::bit_cast<float>(words[glsl::bounce_scale_plane * texels + texel]);
      float sum = 0;
      for (size_t i = 0; i < kPaths; ++i) {
        const glsl::BouncePath path =
            glsl::bounce_path_unpack(words[(glsl::bounce_path_plane + i) * texels + texel]);
        const relief::BouncePath& exact = traced.list[texel * kPaths + i];
        // Weights add up to pi; steps are 1 / 255 of the largest, and there are as many as paths.
        EXPECT_NEAR(path.weight * scale, exact.weight * kPaths / std::numbers::pi_v<float>, 0.1f);
        ASSERT_EQ(path.texel != glsl::bounce_sky, exact.hits());
        sum += path.weight * scale;
        if (!exact.hits()) continue;
        ++hits;
        ASSERT_LT(path.texel, texels);
        const glm::vec2 place(static_cast<float>(path.texel % kSize), static_cast<float>(path.texel / kSize));
        glm::vec2 way = glm::abs(place - exact.place);
        way = glm::min(way, static_cast<float>(kSize) - way);  // the field repeats
        EXPECT_LE(std::max(way.x, way.y), 0.5f + 1e-4f);
      }
      EXPECT_NEAR(sum, kPaths, 1e-3);
    }
    EXPECT_GT(hits, 1000);
    // On the flat field nothing is seen but the sky.
    for (size_t word = glsl::bounce_path_plane * 6; word < table.fields[1].first; ++word)
      if (glsl::bounce_path_unpack(table.values[word]).weight > 0) {
        EXPECT_EQ(glsl::bounce_path_unpack(table.values[word]).texel, glsl::bounce_sky);
      }
  }
}

TEST(ReliefMapsTest, LightGoesOnByPathsOfTheSameNumber) {
  for (const int paths : {1, 7, 64, 100})
    for (const uint32_t texel : {0u, 1u, 12345u}) {
      std::vector<int> next;
      for (int i = 0; i < paths; ++i) next.push_back(glsl::bounce_next_path(i, texel, paths));
      std::ranges::sort(next);
      for (int i = 0; i < paths; ++i) EXPECT_EQ(next[static_cast<size_t>(i)], i) << paths;
    }
}

TEST(ReliefMapsTest, MapsWhoseTexelsHaveNoNumberAreRefused) {
  const std::vector<HeightField> fields{flat({4096, 4096})};
  EXPECT_THROW(makeReliefTable(fields, {.table = Table::bounces, .paths = 1}), UsageError);
}

/// What is asked for would be 8 GiB of horizons; shares of the sky are one word per texel at any number.
TEST(ReliefMapsTest, HorizonsThatAreTooLargeAreRefusedBeforeTheyAreMade) {
  const std::vector<HeightField> fields{flat({64, 32})};
  const auto bytes = [&](Table kind, int azimuths) {
    return reliefHorizonBytes(fields[0], {.table = kind, .azimuths = azimuths});
  };
  for (const Table kind : {Table::moments, Table::nearest, Table::ambient, Table::horizons}) {
    EXPECT_EQ(bytes(kind, 32), 64 * 32 * 32 * 4);
    EXPECT_EQ(bytes(kind, 1 << 20), int64_t{8} << 30);
  }
  EXPECT_EQ(bytes(Table::published, 1), 64 * 32 * 64 * 4);
  EXPECT_EQ(bytes(Table::heights, 32), 0);
  EXPECT_EQ(bytes(Table::bounces, 32), 0);
  try {
    makeReliefTable(fields, {.table = Table::ambient, .azimuths = 1 << 20});
    FAIL() << "8 GiB of horizons";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "the horizons of a height map of 64 x 32 texels along 1048576 azimuths take 8.0 GiB, more "
                 "than 4 GiB; ask for fewer azimuths or a smaller map");
  }
}

TEST(ReliefMapsTest, PackedEllipsesKeepFourDigits) {
  const glsl::ReliefEllipse e{
      .centre = {-0.7f, 0.3f}, .xx = 0.5f, .xy = -0.21f, .yy = 0.013f, .spread = 1.5f};
  const glsl::ReliefEllipse back = glsl::relief_ellipse_unpack(glsl::relief_ellipse_pack(e));
  EXPECT_NEAR(back.centre.x, e.centre.x, 2e-5);
  EXPECT_NEAR(back.centre.y, e.centre.y, 2e-5);
  EXPECT_NEAR(back.xx, e.xx, 1e-5);
  EXPECT_NEAR(back.xy, e.xy, 1e-5);
  EXPECT_NEAR(back.yy, e.yy, 1e-5);
  EXPECT_NEAR(back.spread, e.spread, 4e-5);
}

TEST(ReliefMapsTest, PlacesWrapAsTheirFields) {
  for (const int size : {1, 3, 6, 12, 36, 64})
    for (const int middle : {0, -5000003, 8000000})
      for (int i = middle - 200; i <= middle + 200; ++i) {
        const auto texel = static_cast<float>(i);
        EXPECT_EQ(glsl::relief_wrapped(texel, size, false), ((i % size) + size) % size) << i << ' ' << size;
        EXPECT_EQ(glsl::relief_wrapped(texel, size, true), std::clamp(i, 0, size - 1)) << i << ' ' << size;
      }
}

/// Rays that graze the base get farther than floats, and than integers, count texels.
TEST(ReliefMapsTest, PlacesOfAnyDistanceAreInTheMap) {
  const auto inMap = [](int texel, int size) { return texel >= 0 && texel < size; };
  for (const int size : {1, 3, 6, 12, 36, 4096}) {
    std::vector<float> places{132161216.f, 260492752.f, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()};
    for (float place = 1.7f; place < 1e38f; place *= 1.013f) places.push_back(std::floor(place));
    for (const float place : places)
      for (const float texel : {place, -place})
        for (const bool clamped : {false, true})
          ASSERT_TRUE(inMap(glsl::relief_wrapped(texel, size, clamped), size)) << texel << ' ' << size;
    EXPECT_EQ(glsl::relief_wrapped(1e30f, size, true), size - 1);
    EXPECT_EQ(glsl::relief_wrapped(-1e30f, size, true), 0);
  }
}

TEST(ReliefMapsTest, PlacesOfTheGBufferComeBack) {
  EXPECT_FALSE(glsl::gbuffer_place_unpack(glm::vec3(0)).present);
  for (const float level : {-3.f, 0.f, 0.25f, 7.5f, 15.f, 40.f})
    for (const bool leftHanded : {false, true}) {
      glm::vec3 texel = glsl::gbuffer_place_pack({0.25f, 1}, level, leftHanded);
      texel = glm::round(texel * 65535.f) / 65535.f;
      const glsl::GBufferPlace place = glsl::gbuffer_place_unpack(texel);
      EXPECT_TRUE(place.present);
      EXPECT_EQ(place.left_handed, leftHanded);
      EXPECT_NEAR(place.level, std::clamp(level, 0.f, 15.f), 1e-3);
      EXPECT_NEAR(place.uv.x, 0.25f, 1e-5);
      EXPECT_EQ(place.uv.y, 1);
    }
}

}  // namespace
}  // namespace limn::relief_maps
