// The triangles of directions: they tile the sphere, and a place is found in the cell that it lies in.
#include "glsl/numeric/octahedral_cells.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

/// Calls `visit` for each cell of a level below a face, with the way to it.
void eachCell(int level, const std::function<void(OctahedralCell, const std::vector<uint>&)>& visit) {
  std::vector<uint> way;
  const std::function<void(OctahedralCell)> descend = [&](OctahedralCell cell) {
    if (static_cast<int>(way.size()) == level) return visit(cell, way);
    for (uint k = 0; k < 4; ++k) {
      way.push_back(k);
      descend(octahedral_child(cell, k));
      way.pop_back();
    }
  };
  descend(octahedral_root());
}

/// Solid angle (sr) of the triangle between three unit directions (van Oosterom and Strackee 1983).
float solidAngle(const vec3& a, const vec3& b, const vec3& c) {
  const float volume = abs(dot(a, cross(b - a, c - a)));
  return 2 * atan(volume, 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

struct Sums {
  double solid = 0, projected = 0, least = 1e9, most = 0;
};

Sums sumsOf(int level, uint faces) {
  Sums sums;
  for (uint face = 0; face < faces; ++face)
    eachCell(level, [&](OctahedralCell cell, const std::vector<uint>&) {
      const vec3 signs = octahedral_signs(face);
      const vec3 a = octahedral_corner(cell, signs, 0), b = octahedral_corner(cell, signs, 1),
                 c = octahedral_corner(cell, signs, 2);
      const double solid = double(solidAngle(a, b, c));
      sums.solid += solid;
      sums.projected += double(abs(triangle_projected_angle(a, b, c).z));
      sums.least = std::min(sums.least, solid);
      sums.most = std::max(sums.most, solid);
    });
  return sums;
}

TEST(OctahedralCells, TileTheSphere) {
  for (int level = 0; level <= 7; ++level) {
    EXPECT_NEAR(sumsOf(level, 8).solid, 4 * double(pi), 4e-6) << level;
    EXPECT_NEAR(sumsOf(level, 4).projected, double(pi), 2e-6) << level;
  }
  // What equal weights would get wrong.
  const Sums sums = sumsOf(5, 8);
  EXPECT_NEAR(sums.most / sums.least, 4.9, 0.1);
}

TEST(OctahedralCells, ProjectedAngleOfAnOctant) {
  const vec3 whole = triangle_projected_angle(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(whole[k], pi / 4, 1e-6f);
}

TEST(OctahedralCells, DescendingFindsTheCellOfACentre) {
  for (uint face = 0; face < 8; ++face)
    eachCell(5, [&](OctahedralCell cell, const std::vector<uint>& way) {
      const vec3 signs = octahedral_signs(face);
      const vec3 inside[4] = {octahedral_centre(cell, signs), octahedral_corner(cell, signs, 0),
                              octahedral_corner(cell, signs, 1), octahedral_corner(cell, signs, 2)};
      // The centre, and a place near each corner.
      for (const vec3& towards : inside) {
        const vec3 w = inside[0] + 0.9f * (towards - inside[0]);
        ASSERT_EQ(octahedral_face(w), face);
        vec3 place = octahedral_place(w);
        for (const uint child : way) ASSERT_EQ(octahedral_descend(place), child);
      }
    });
}

TEST(OctahedralCells, ChildrenShareCornersAndTheCentre) {
  const vec3 signs = octahedral_signs(5);
  const OctahedralCell cell = octahedral_child(octahedral_child(octahedral_root(), 3), 1);
  const OctahedralCell inner = octahedral_child(cell, 3);
  EXPECT_LT(distance(octahedral_centre(inner, signs), octahedral_centre(cell, signs)), 1e-7f);
  for (uint i = 0; i < 3; ++i) {
    const OctahedralCell outer = octahedral_child(cell, i);
    EXPECT_EQ(octahedral_corner(outer, signs, i), octahedral_corner(cell, signs, i));
    for (uint j = 0; j < 3; ++j) {
      if (j == i) continue;
      EXPECT_EQ(octahedral_corner(outer, signs, j), octahedral_corner(inner, signs, 3 - i - j));
    }
  }
}

TEST(OctahedralCells, TheHorizonIsAnEdge) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    vec3 w = random.direction();
    EXPECT_EQ(octahedral_face(w) < 4, w.z >= 0);
    const vec3 place = octahedral_place(w);
    EXPECT_NEAR(place.x + place.y + place.z, 1, 1e-6f);
    EXPECT_LT(distance(normalize(octahedral_signs(octahedral_face(w)) * place), w), 1e-6f);
  }
}

}  // namespace
}  // namespace limn::glsl
