// Charts of surfaces: every triangle in one, none over another, and all of them in the texture.
#include "core/scene/charts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace limn::scene {
namespace {

using glm::vec2;
using glm::vec3;

struct Body {
  std::vector<vec3> positions;
  std::vector<uint32_t> indices;

  size_t triangles() const { return indices.size() / 3; }
  vec3 corner(uint32_t t, uint32_t k) const { return positions[indices[3 * t + k]]; }
  double area(uint32_t t) const {
    return 0.5 * static_cast<double>(
                     glm::length(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0))));
  }
};

/// A grid over the unit square, with a place of the surface for each of its points.
template <class Place>
Body sheet(int cells, Place place) {
  Body body;
  const auto row = static_cast<uint32_t>(cells + 1);
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) body.positions.push_back(place(vec2(x, y) / static_cast<float>(cells)));
  for (uint32_t y = 0; y + 1 < row; ++y)
    for (uint32_t x = 0; x + 1 < row; ++x) {
      const uint32_t a = y * row + x;
      for (const uint32_t i : {a, a + 1, a + row, a + row, a + 1, a + row + 1}) body.indices.push_back(i);
    }
  return body;
}

Body sphere(int cells, float radius = 1, const vec3& centre = vec3(0)) {
  return sheet(cells, [&](vec2 uv) {
    const float turn = uv.x == 1 ? 0 : 2 * std::numbers::pi_v<float> * uv.x,
                fall = std::numbers::pi_v<float> * uv.y;
    if (uv.y == 0 || uv.y == 1) return centre + vec3(0, uv.y == 0 ? radius : -radius, 0);
    return centre +
           radius * vec3(std::sin(fall) * std::cos(turn), std::cos(fall), -std::sin(fall) * std::sin(turn));
  });
}

/// A strip that winds up above itself twice.
Body helix() {
  return sheet(96, [](vec2 uv) {
    const float turn = 4 * std::numbers::pi_v<float> * uv.x;
    return vec3((1 + uv.y) * std::cos(turn), 0.5f * uv.x, (1 + uv.y) * std::sin(turn));
  });
}

vec2 placeOf(const Chart& chart, const vec3& point, double scale) {
  return vec2(glm::dvec2(acrossAxis(point, chart.axis) - chart.lowest) * scale + glm::dvec2(chart.corner));
}

/// Which triangle of the charts' own covers each texel's centre; those of one chart may meet at a texel.
size_t doublyCovered(const Body& body, const std::vector<Chart>& charts, int texels, double scale) {
  std::map<std::pair<int, int>, std::set<uint32_t>> covered;
  for (const Chart& chart : charts)
    for (const uint32_t t : chart.triangles) {
      const vec2 a = placeOf(chart, body.corner(t, 0), scale), b = placeOf(chart, body.corner(t, 1), scale),
                 c = placeOf(chart, body.corner(t, 2), scale);
      const vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c)), e = b - a, f = c - a;
      EXPECT_GE(std::min(low.x, low.y), 0);
      EXPECT_LE(std::max(high.x, high.y), static_cast<float>(texels));
      const float area = e.x * f.y - e.y * f.x;
      for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y)
        for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
          const vec2 d = vec2(x, y) + 0.5f - a;
          const float u = (d.x * f.y - d.y * f.x) / area, v = (e.x * d.y - e.y * d.x) / area;
          if (u > 0.001f && v > 0.001f && u + v < 0.999f) covered[{x, y}].insert(t);
        }
    }
  size_t doubly = 0;
  for (const auto& [texel, triangles] : covered) doubly += triangles.size() > 1;
  EXPECT_GT(covered.size(), static_cast<size_t>(texels) * static_cast<size_t>(texels) / 12);
  return doubly;
}

void expectEachOnce(const Body& body, const std::vector<Chart>& charts) {
  std::vector<int> seen(body.triangles(), 0);
  for (const Chart& chart : charts)
    for (const uint32_t t : chart.triangles) ++seen[t];
  for (uint32_t t = 0; t < body.triangles(); ++t) EXPECT_EQ(seen[t], body.area(t) > 0 ? 1 : 0) << t;
}

TEST(Charts, SpheresHaveSix) {
  const Body body = sphere(48);
  std::vector<Chart> charts = *makeCharts(body.positions, body.indices, 0.1);
  EXPECT_EQ(charts.size(), 6u);
  expectEachOnce(body, charts);
  const double scale = packCharts(charts, 256);
  // Each is as wide as 2 sin(55 degrees) at most, and 0.1 on both sides.
  EXPECT_GT(scale, 256 / (3 * (2 * 0.82 + 0.3)));
  EXPECT_EQ(doublyCovered(body, charts, 256, scale), 0u);
}

TEST(Charts, LayersOfOneSurfaceLieSideBySide) {
  const Body body = helix();
  std::vector<Chart> charts = *makeCharts(body.positions, body.indices, 0);
  EXPECT_GE(charts.size(), 2u);
  EXPECT_LE(charts.size(), 8u);
  expectEachOnce(body, charts);
  EXPECT_EQ(doublyCovered(body, charts, 256, packCharts(charts, 256)), 0u);
}

TEST(Charts, SurroundingsReachAsFarAsTheMargin) {
  const Body body = sphere(96);
  for (const double margin : {0.05, 0.2}) {
    const std::vector<Chart> charts = *makeCharts(body.positions, body.indices, margin);
    for (const Chart& chart : charts) {
      const std::set<uint32_t> own(chart.triangles.begin(), chart.triangles.end());
      double area = 0, outline = 0;
      for (const uint32_t t : chart.surroundings) {
        EXPECT_FALSE(own.contains(t));
        area += body.area(t);
      }
      // A cap of a cube's face on a sphere has an outline of 4 arcs of 70.5 degrees.
      outline = 4 * 70.53 * std::numbers::pi / 180;
      EXPECT_GT(area, 0.7 * margin * outline);
      EXPECT_LT(area, 1.6 * (margin + 0.06) * outline);
    }
  }
}

TEST(Charts, SmallIslandsJoinWhatIsAroundThem) {
  // Bumps of 60 degrees look along other axes than the plane that they are on.
  const Body body =
      sheet(64, [](vec2 uv) { return vec3(uv.x, 0.02f * std::sin(80 * uv.x) * std::sin(80 * uv.y), uv.y); });
  std::vector<Chart> charts = *makeCharts(body.positions, body.indices, 0.01);
  EXPECT_LT(charts.size(), 20u);
  expectEachOnce(body, charts);
  EXPECT_EQ(doublyCovered(body, charts, 512, packCharts(charts, 512)), 0u);
}

TEST(Charts, ScaleAndPlaceDoNotMatter) {
  const Body body = sphere(24);
  const std::vector<Chart> wanted = *makeCharts(body.positions, body.indices, 0.1);
  for (const float factor : {1e-4f, 1e4f}) {
    const Body other = sphere(24, factor);
    std::vector<Chart> charts =
        *makeCharts(other.positions, other.indices, 0.1 * static_cast<double>(factor));
    ASSERT_EQ(charts.size(), wanted.size());
    std::vector<Chart> packed = wanted;
    EXPECT_NEAR(packCharts(charts, 256) * static_cast<double>(factor) / packCharts(packed, 256), 1, 1e-4);
  }
}

TEST(Charts, WhatHasNoAreaHasNoChart) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  most = std::numeric_limits<float>::infinity();
  const std::vector<vec3> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {nan, 0, 0}, {0, most, 0}, {0, 0, 1}};
  const std::vector<uint32_t> indices{0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 0, 5, 0, 5, 1};
  std::vector<Chart> charts = *makeCharts(positions, indices, 1);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(charts[0].triangles, std::vector<uint32_t>{4});
  EXPECT_GT(packCharts(charts, 16), 0);
  std::vector<Chart> none = *makeCharts(positions, std::span(indices).first(12), 1);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(packCharts(none, 16), 0);
}

TEST(Charts, MoreThanFitHaveNoScale) {
  Body body;  // 100 triangles far apart
  for (uint32_t i = 0; i < 100; ++i) {
    const vec3 at(3 * static_cast<float>(i), 0, 0);
    for (const vec3& corner : {at, at + vec3(0, 0, 1), at + vec3(1, 0, 0)}) {
      body.indices.push_back(static_cast<uint32_t>(body.positions.size()));
      body.positions.push_back(corner);
    }
  }
  std::vector<Chart> charts = *makeCharts(body.positions, body.indices, 0);
  ASSERT_EQ(charts.size(), 100u);
  EXPECT_EQ(packCharts(charts, 16), 0);
  EXPECT_GT(packCharts(charts, 64), 0);
  EXPECT_TRUE(makeCharts(body.positions, body.indices, 0, {.charts = 100}));
  EXPECT_FALSE(makeCharts(body.positions, body.indices, 0, {.charts = 99}));
  const Body ball = sphere(24);
  EXPECT_TRUE(makeCharts(ball.positions, ball.indices, 1, {.triangles = 20 * ball.triangles()}));
  EXPECT_FALSE(makeCharts(ball.positions, ball.indices, 1, {.triangles = ball.triangles() + 1}));
}

TEST(Charts, TrianglesAndTheirOwnBacksAreTwoSheets) {
  const Body front = sheet(8, [](vec2 uv) { return vec3(uv.x, 0, uv.y); });
  Body body = front;
  body.indices.clear();
  for (size_t i = 0; i < front.indices.size(); i += 3)
    for (const size_t k : {i, i + 1, i + 2, i, i + 2, i + 1}) body.indices.push_back(front.indices[k]);
  EXPECT_EQ(makeCharts(body.positions, body.indices, 0)->size(), 2u);
}

// Sheets that cover all cells take none of them in the end: 28 GB if they did.
// Of strands across the diagonal the cells around each are 65536, those below it some hundreds: with the
// former it takes seconds.
TEST(Charts, NarrowTrianglesTakeTheCellsBelowThem) {
  Body body;
  constexpr uint32_t strands = 20000;
  for (uint32_t i = 0; i < strands; ++i) {
    const float x = static_cast<float>(i) / strands, width = 0.5f / strands;
    for (const vec3& p : {vec3(x, 0, 0), vec3(x + width, 0, 0), vec3(x + 1, 1, 0)}) {
      body.indices.push_back(static_cast<uint32_t>(body.positions.size()));
      body.positions.push_back(p);
    }
  }
  const auto charts = makeCharts(body.positions, body.indices, 0.01);
  ASSERT_TRUE(charts);
  EXPECT_EQ(charts->size(), strands);
}

TEST(Charts, StacksTakeLittleMemoryAndTime) {
  Body body;
  for (uint32_t i = 0; i < 2000; ++i) {
    const float height = static_cast<float>(i) / 2000;
    for (const vec3& corner : {vec3(0, height, 0), vec3(0, height, 1), vec3(1, height, 0)}) {
      body.indices.push_back(static_cast<uint32_t>(body.positions.size()));
      body.positions.push_back(corner);
    }
  }
  EXPECT_EQ(makeCharts(body.positions, body.indices, 0.1)->size(), 2000u);
}

}  // namespace
}  // namespace limn::scene
