// The corners of a level of triangles: each once in the list, and linear interpolation between them.
#include "glsl/numeric/octahedral_grid.glsl"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

TEST(OctahedralGrid, ListsEachCornerOnce) {
  for (const int n : {1, 2, 16}) {
    std::set<uint> seen;
    for (int j = -n; j <= n; ++j)
      for (int i = std::abs(j) - n; i <= n - std::abs(j); ++i)
        seen.insert(octahedral_grid_index(ivec2(i, j), uint(n)));
    EXPECT_EQ(seen.size(), octahedral_grid_size(uint(n)));
    EXPECT_EQ(*seen.rbegin(), octahedral_grid_size(uint(n)) - 1);
  }
}

TEST(OctahedralGrid, InterpolatesPlaces) {
  Random random(1);
  for (const int n : {1, 2, 8, 32}) {
    std::vector<vec3> corners(octahedral_grid_size(uint(n)));
    for (int j = -n; j <= n; ++j)
      for (int i = std::abs(j) - n; i <= n - std::abs(j); ++i) {
        const uint index = octahedral_grid_index(ivec2(i, j), uint(n));
        corners[index] = vec3(i, j, n - std::abs(i) - std::abs(j)) / float(n);
      }
    const auto check = [&](vec3 w) {
      const OctahedralGridPlace place = octahedral_grid_place(w, uint(n));
      vec3 found(0);
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(place.weight[k], -1e-5f);
        ASSERT_LT(place.corner[k], corners.size());
        found += place.weight[k] * corners[place.corner[k]];
      }
      ASSERT_LT(distance(found, w / (abs(w.x) + abs(w.y) + abs(w.z))), 1e-6f) << n;
    };
    for (int i = 0; i < 5000; ++i) {
      const vec3 w = random.direction();
      check({w.x, w.y, std::abs(w.z)});
    }
    // Places on edges and corners.
    for (const vec3& corner : corners) check(corner);
    for (const vec3& corner : {vec3(1, 1, 0), vec3(-1, 1, 0), vec3(1, 1e-8f, 0), vec3(0, -1, 1e-8f)})
      check(corner);
  }
}

}  // namespace
}  // namespace limn::glsl
