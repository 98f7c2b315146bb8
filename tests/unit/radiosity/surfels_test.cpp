// Surface elements at the vertices of meshes: which vertices are one, and what is next to what.
#include "core/radiosity/surfels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/support/radiosity_meshes.h"

namespace limn::radiosity {
namespace {

TEST(SurfelsTest, SplitEdgesStayClosed) {
  const Surfels coarse = surfelsOf({sphereMesh({0, 0, 0}, 1, 8)});
  const Surfels fine = surfelsOf({sphereMesh({0, 0, 0}, 1, 8)}, 0.07f);
  EXPECT_EQ(coarse.backless[0], 1);
  EXPECT_EQ(fine.backless[0], 1) << "no crack between triangles that share an edge";
  EXPECT_GT(fine.size(), 4 * coarse.size());
}

TEST(SurfelsTest, DuplicateVerticesAreOneSurfel) {
  const TriangleMesh sphere = sphereMesh({0, 0, 0}, 1, 12);
  TriangleMesh soup;
  for (const uint32_t i : sphere.indices) {
    soup.indices.push_back(static_cast<uint32_t>(soup.positions.size()));
    soup.positions.push_back(sphere.positions[i]);
    soup.normals.push_back(sphere.normals[i]);
  }
  const Surfels whole = surfelsOf({sphere}), split = surfelsOf({soup});
  EXPECT_EQ(whole.size(), split.size());
  EXPECT_EQ(whole.size(), 24u * 11 + 2);
  EXPECT_EQ(split.backless[0], 1);
}

/// A sphere that is tiny beside the scene: all of its vertices lie at one place, and elements differ by their
/// normals alone, which are means over each vertex once.
TEST(SurfelsTest, VerticesOfATinyMeshCountOnceEach) {
  const std::vector<TriangleMesh> meshes{sphereMesh({0, 0, 0}, 1e-7f, 16)};
  const Surfels surfels = createSurfels(meshes, 1);
  EXPECT_LT(surfels.size(), 64u);
  std::set<uint32_t> all;
  for (size_t i = 0; i < surfels.size(); ++i) {
    std::set<uint32_t> own;
    for (uint32_t k = surfels.firstOrigin[i]; k < surfels.firstOrigin[i + 1]; ++k) {
      const SurfelOrigin& o = surfels.origins[k];
      const uint32_t vertex = o.vertices[o.weights.x == 1 ? 0 : o.weights.y == 1 ? 1 : 2];
      EXPECT_TRUE(own.insert(vertex).second) << vertex;
      all.insert(vertex);
    }
  }
  EXPECT_GE(all.size() + 4, meshes[0].positions.size());
}

/// A wheel, whose middle is a neighbour of all others. The centroid of a corner's third of a triangle lies
/// 7 / 36 of the way to each of the other two.
TEST(SurfelsTest, NeighboursCountOnceEach) {
  constexpr uint32_t kSpokes = 1000;
  TriangleMesh wheel;
  wheel.positions.emplace_back(0.f);
  for (uint32_t i = 0; i < kSpokes; ++i) {
    const float angle = 2 * glsl::pi * static_cast<float>(i) / static_cast<float>(kSpokes);
    wheel.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    wheel.indices.insert(wheel.indices.end(), {0, 1 + i, 1 + (i + 1) % kSpokes});
  }
  wheel.normals.assign(wheel.positions.size(), {0, 0, 1});
  const std::vector<TriangleMesh> meshes{wheel};
  const Surfels surfels = createSurfels(meshes, 10);
  ASSERT_EQ(surfels.size(), size_t{kSpokes} + 1);
  for (size_t i = 0; i < surfels.size(); ++i) {
    std::set<uint32_t> own;
    double weight = 0;
    for (const Surfels::Neighbour& n : surfels.neighboursOf(i)) {
      EXPECT_TRUE(own.insert(n.surfel).second) << i;
      weight += double(n.weight);
    }
    EXPECT_EQ(own.size(), surfels.vertices[i] == glm::vec3(0) ? size_t{kSpokes} : size_t{3});
    EXPECT_NEAR(weight, 2 * 7 / 36., 1e-4) << i;
  }
}

}  // namespace
}  // namespace limn::radiosity
