// Illumination samples in the cases that tend to break them, and what reflecting them together saves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/unit/radiosity/sample_world.h"

namespace limn::radiosity {
namespace {

/// Light goes to and fro between plates that are nearly mirrors. Each reflection takes its part, and each way
/// across moves the light by a 20th and a 50th of a side, so that its edge misses the plate.
TEST(SampleCases, FacingMirrorsGainNoLight) {
  SampleWorld world(facingPlates(8), {metalLeaf(0.05f), metalLeaf(0.05f)});
  world.lightFrom(0, glm::normalize(glm::vec3(0.05f, 1, 0.02f)), 0.01f, 1);
  const auto lit = [](int ways) { return (1 - 0.05 * ways) * (1 - 0.02 * ways); };
  double sent = 1 / double(world.space.radius() * world.space.radius()), before[2] = {0, 0};
  for (int bounce = 0; bounce < 8; ++bounce) {
    world.solver->reflect();
    world.solver->shoot(FreeSight());
    const int to = (bounce + 1) % 2;
    const double arrived = world.flux(uint32_t(to)) - before[to];
    const double overlap = lit(bounce + 1) / lit(bounce);
    std::printf("bounce %d: %.3f of the light before, of which %.3f meet the plate\n", bounce + 1,
                arrived / sent, overlap);
    // Elements are as wide as 50 lobes: 0.75 of what meets the plate becomes 0.83 at the first bounce, and
    // falls to 0.53 as the light spreads.
    EXPECT_GT(arrived / sent, 0.7 * 0.75 * overlap) << "bounce " << bounce + 1 << ", overlap " << overlap;
    EXPECT_LT(arrived / sent, bounce == 0 ? 0.85 : 0.75 * overlap) << "bounce " << bounce + 1;
    before[to] += arrived;
    EXPECT_EQ(world.flux(uint32_t(1 - to)), before[1 - to]) << "the plate that sends gets nothing";
    sent = arrived;
  }
}

/// A mirror's light that a plate on it meets close to the edge alone. The pair of both as wholes, with which
/// links begin, reach into each other: their centres lie in a direction into which the mirror sends nothing.
TEST(SampleCases, PlatesOnMirrorsMeetTheLightOfAllOfThem) {
  SampleWorld world({rectangleMesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 40),
                     rectangleMesh({-0.9f, 0, -0.15f}, {0, 0, 0.3f}, {0, 0.3f, 0}, 12)},
                    {metalLeaf(0.05f), diffuseLeaf(0.5f)});
  const float elevation = glsl::pi / 9;
  world.lightFrom(0, {-std::cos(elevation), std::sin(elevation), 0}, 0.05f, 1);
  world.solver->reflect();
  world.solver->shoot(FreeSight());
  // What falls onto the tenth in front of the plate, on the plate's height, of which metal reflects 0.75.
  const double expected = 0.75 * double(std::sin(elevation)) * 0.1 / 0.3;
  std::printf("on the plate: %.3f of %.3f\n", world.mean(1), expected);
  EXPECT_NEAR(world.mean(1) / expected, 1, 0.5);
}

TEST(SampleCases, ScaleChangesNothing) {
  double mean[3];
  int k = 0;
  for (const float scale : {1.f, 1e-4f, 1e4f}) {
    std::vector<TriangleMesh> meshes = floorAndRoom(6, 6);
    for (TriangleMesh& mesh : meshes)
      for (glm::vec3& p : mesh.positions) p *= scale;
    SampleWorld world(meshes, {metalLeaf(0.3f), diffuseLeaf(0.5f)});
    world.light({0, 1});
    for (int bounce = 0; bounce < 2; ++bounce) {
      world.solver->reflect();
      world.solver->shoot(FreeSight());
    }
    mean[k++] = world.mean(1);
  }
  EXPECT_NEAR(mean[1] / mean[0], 1, 1e-3);
  EXPECT_NEAR(mean[2] / mean[0], 1, 1e-3);
}

/// What a floor under the light of a room takes to reflect it.
struct Reflected {
  uint64_t evaluations = 0;
  size_t cells = 0;
  double light = 0;

  Reflected(float roughness, bool immediate, bool frozen) {
    const TreeSettings published{.criterion = TreeSettings::Criterion::relative,
                                 .error = 0.5f,
                                 .minLevel = 1,
                                 .maxLevel = 5,
                                 .frozen = frozen};
    SampleWorld world(floorAndRoom(4, 6), {metalLeaf(roughness), diffuseLeaf(0.5f)},
                      {.linkError = 0.01f, .tree = published, .immediate = immediate});
    world.light({0, 1});
    world.solver->reflect();
    world.solver->shoot(FreeSight());
    world.solver->project(published);
    evaluations = world.solver->evaluations();
    for (const DirectionalTree& tree : world.solver->shown()) {
      cells += tree.cellCount();
      light += double(tree.flux().x);
    }
  }
};

/// Cells, and lobes that were evaluated, which most of the time goes by: as published, without frozen lobes,
/// down to a roughness of 0.3; with them below.
TEST(SampleCases, ReflectingSamplesTogetherSaves) {
  struct Row {
    float roughness;
    bool frozen;
    double cells, evaluations;  ///< of those that samples reflected each by itself take, at most
  };
  for (const Row& row : {Row{0.5f, false, 0.5, 0.6}, Row{0.3f, false, 1, 0.85}, Row{0.2f, true, 1, 0.25}}) {
    const Reflected together(row.roughness, false, row.frozen), each(row.roughness, true, false);
    const double cells = double(together.cells) / double(each.cells);
    const double evaluations = double(together.evaluations) / double(each.evaluations);
    std::printf("roughness %.1f: together %.3f of the cells, %.3f of the evaluations\n",
                double(row.roughness), cells, evaluations);
    EXPECT_LT(cells, row.cells);
    EXPECT_LT(evaluations, row.evaluations);
    EXPECT_NEAR(together.light / each.light, 1, 0.01);
  }
}

}  // namespace
}  // namespace limn::radiosity
