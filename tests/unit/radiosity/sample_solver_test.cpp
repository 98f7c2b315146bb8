// Illumination samples against closed forms: plates, furnaces, bounces; and what must not happen.
#include "core/radiosity/sample_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <set>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "tests/unit/radiosity/sample_world.h"

namespace limn::radiosity {
namespace {

/// A plane of constant x that blocks everything.
class Wall final : public Occlusion {
 public:
  explicit Wall(float x) : x_(x) {}
  bool blocked(const glm::vec3& origin, const glm::vec3& direction, float end) const override {
    const float t = (x_ - origin.x) / direction.x;
    return t > 0 && t < end;
  }

 private:
  float x_;
};

/// The form factor of two parallel squares of side 1 at distance 1.
constexpr double kSquares = 0.19982;

TEST(SampleSolverTest, ParallelPlatesExchangeTheirFormFactor) {
  for (const int n : {4, 12, 24}) {
    SampleWorld world(facingPlates(n), {diffuseLeaf(0.8f), diffuseLeaf(0.5f)});
    world.light({1, 0});
    world.solver->reflect();
    const ShootCounts counts = world.solver->shoot(FreeSight());
    std::printf("plates of %d x %d: %.2f %% off, %zu pairs, %zu links\n", n, n,
                100 * (world.mean(1) / (0.8 * kSquares) - 1), size_t(counts.pairs), size_t(counts.links));
    EXPECT_NEAR(world.mean(1) / (0.8 * kSquares), 1, 0.02);
    EXPECT_EQ(world.mean(0), 0);
    world.solver->reflect();
    world.solver->shoot(FreeSight());
    EXPECT_NEAR(world.mean(0) / (0.8 * kSquares * 0.5 * kSquares), 1, 0.04);
  }
}

/// What stands for elements near by lies in their plane, and is as large and about as long as they are.
TEST(SampleSolverTest, SendersAreRectanglesOfTheirElements) {
  // Cells that are three times as long as wide.
  SampleWorld world({rectangleMesh({0, 0, 0}, {0, 0, 1}, {3, 0, 0}, 8)}, {diffuseLeaf(0.5f)});
  const float unit = world.space.radius();
  const glm::vec3 along = world.space.direction({1, 0, 0});
  double area = 0, inner = 0;
  for (size_t i = 0; i < world.surfels.size(); ++i) {
    const Sender sender = world.solver->sender(world.forest.leafOf()[i]);
    area += double(sender.area) * unit * unit;
    EXPECT_NEAR(glm::dot(sender.side, sender.normal), 0, 1e-5);
    const glm::vec3 at = world.space.worldPoint(sender.position);
    EXPECT_NEAR(at.y, 0, 1e-5) << "on the surface, not above it";
    if (at.x < 0.4f || at.x > 2.6f || at.z < 0.13f || at.z > 0.87f) continue;
    ++inner;
    EXPECT_GT(std::abs(glm::dot(glm::normalize(sender.side), along)), 0.9f);
    const float aspect = glm::dot(sender.side, sender.side) / sender.area;
    EXPECT_GT(aspect, 2);
    EXPECT_LT(aspect, 5);
  }
  EXPECT_NEAR(area, 3, 1e-3);
  EXPECT_GT(inner, 0);
  for (uint32_t slot = world.forest.leafSlots(); slot < world.forest.slots(); ++slot) {
    const Sender sender = world.solver->sender(slot);
    EXPECT_NEAR(glm::dot(sender.side, sender.side), sender.area, 1e-4 * sender.area);
  }
}

TEST(SampleSolverTest, LinksFollowTheErrorAllowed) {
  uint64_t before = 0;
  for (const float error : {0.3f, 0.03f, 0.003f}) {
    SampleWorld world(facingPlates(24), {diffuseLeaf(0.8f), diffuseLeaf(0.5f)}, {.linkError = error});
    world.light({1, 0});
    world.solver->reflect();
    const uint64_t links = world.solver->shoot(FreeSight()).links;
    EXPECT_GT(links, before);
    before = links;
    EXPECT_NEAR(world.mean(1) / (0.8 * kSquares), 1, 0.03);
  }
}

/// The lobe allows so little error that all links are between leaves, each of which brings less than a
/// thousandth of what diffuse surfaces allow.
TEST(SampleSolverTest, NarrowLobesTakeTheLightOfManySmallElements) {
  SampleWorld world(
      {rectangleMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 32), rectangleMesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 4)},
      {diffuseLeaf(0.8f), metalLeaf(0.06f)}, {.linkError = 1});
  world.light({1, 0});
  world.solver->reflect();
  world.solver->shoot(FreeSight());
  std::printf("a plate of roughness 0.06: %.2f %% off\n", 100 * (world.mean(1) / (0.8 * kSquares) - 1));
  EXPECT_NEAR(world.mean(1) / (0.8 * kSquares), 1, 0.03);
}

TEST(SampleSolverTest, FurnacesAreAsBrightAsTheyReflect) {
  for (const bool round : {true, false}) {
    SampleWorld world({round ? sphereMesh({0, 0, 0}, 1, 24, -1) : roomMesh(12)}, {diffuseLeaf(0.5f)});
    world.light({1});
    world.solver->reflect();
    world.solver->shoot(FreeSight());
    double expected = 0.5;
    std::printf("%s: irradiance %.2f %% off\n", round ? "sphere" : "room",
                100 * (world.mean(0) / expected - 1));
    EXPECT_NEAR(world.mean(0) / expected, 1, 0.005);
    for (int bounce = 2; bounce <= 7; ++bounce) {
      world.solver->reflect();
      world.solver->shoot(FreeSight());
      expected += std::pow(0.5, bounce);
    }
    std::printf("%s, 7 bounces: %.2f %% off\n", round ? "sphere" : "room",
                100 * (world.mean(0) / expected - 1));
    EXPECT_NEAR(world.mean(0) / expected, 1, 0.005);
  }
}

TEST(SampleSolverTest, GlossyElementsInAFurnaceReflectTheirReflectance) {
  for (const float roughness : {0.3f, 0.5f}) {
    // The floor alone is metal, and does not see itself.
    SampleWorld world(floorAndRoom(8, 12), {metalLeaf(roughness), diffuseLeaf(0.5f)});
    world.light({0, glsl::pi});
    world.solver->reflect();
    world.solver->shoot(FreeSight());
    std::printf("roughness %.1f: irradiance %.2f %% off\n", double(roughness),
                100 * (world.mean(0) / (0.5 * glsl::pi) - 1));
    EXPECT_NEAR(world.mean(0) / (0.5 * glsl::pi), 1, 0.008);
    world.solver->reflect();
    for (const double degrees : {0.0, 45.0, 80.0}) {
      double sum = 0, count = 0;
      for (size_t i = 0; i < world.surfels.size(); ++i) {
        const uint32_t leaf = world.forest.leafOf()[i];
        if (world.surfels.objects[i] != 0) continue;
        if (glm::length(world.surfels.positions[i] - world.surfels.positions[40]) > 0.3f) continue;
        const glsl::Frame frame = glsl::frame_around(world.surfels.normals[i]);
        for (int turn = 0; turn < 8; ++turn) {
          const double azimuth = turn * glsl::pi / 4, polar = degrees * glsl::pi / 180;
          const glm::vec3 v =
              glsl::from_local(frame, glm::vec3(std::sin(polar) * std::cos(azimuth),
                                                std::sin(polar) * std::sin(azimuth), std::cos(polar)));
          sum += world.solver->unshot(leaf, v).x;
          ++count;
        }
      }
      const glsl::SurfaceBrdf brdf = world.solver->brdf(world.forest.leafOf()[0]);
      const float cosine = static_cast<float>(std::cos(degrees * glsl::pi / 180));
      const double expected =
          0.5 * glsl::ltc_specular_reflectance(brdf, glsl::ltc_lookup(cosine, brdf.alpha)).x;
      std::printf("roughness %.1f at %.0f degrees: %.1f %% off\n", double(roughness), degrees,
                  100 * (sum / count / expected - 1));
      EXPECT_NEAR(sum / count / expected, 1, degrees < 50 ? 0.06 : 0.3);
    }
  }
}

TEST(SampleSolverTest, WhatIsHiddenIsDark) {
  // Two pairs of plates beside each other: light would go across the wall between them.
  std::vector<TriangleMesh> meshes = facingPlates(6);
  for (TriangleMesh mesh : facingPlates(6)) {
    for (glm::vec3& p : mesh.positions) p.x += 1.5f;
    meshes.push_back(mesh);
  }
  SampleWorld world(meshes, {diffuseLeaf(0.8f), diffuseLeaf(0.8f), diffuseLeaf(0.8f), diffuseLeaf(0.8f)});
  world.light({1, 0, 0, 0});
  world.solver->reflect();
  world.solver->shoot(Wall(1.25f));
  EXPECT_NEAR(world.mean(1) / (0.8 * kSquares), 1, 0.02);
  EXPECT_EQ(world.mean(3), 0);
  world.solver->begin();
  world.light({1, 0, 0, 0});
  world.solver->reflect();
  world.solver->shoot(FreeSight());
  EXPECT_GT(world.mean(3), 0.01);
}

TEST(SampleSolverTest, TheSameSceneGivesTheSameLightAgain) {
  SampleWorld world({sphereMesh({0, 0, 0}, 1, 16, -1)}, {diffuseLeaf(0.5f)});
  std::vector<glm::vec3> before;
  for (int turn = 0; turn < 2; ++turn) {
    world.solver->begin();
    world.light({1});
    world.solver->reflect();
    world.solver->shoot(FreeSight());
    const auto now = world.solver->irradiance();
    if (turn == 1) {
      EXPECT_TRUE(std::equal(now.begin(), now.end(), before.begin()));
    }
    before.assign(now.begin(), now.end());
  }
}

TEST(SampleSolverTest, DiffuseScenesMakeNoTree) {
  SampleWorld world(facingPlates(6), {diffuseLeaf(0.8f), diffuseLeaf(0.8f)});
  world.light({1, 0});
  for (int bounce = 0; bounce < 2; ++bounce) {
    world.solver->reflect();
    EXPECT_EQ(world.solver->cellCount(), 0u);
    world.solver->shoot(FreeSight());
  }
  world.solver->project({});
  for (const DirectionalTree& tree : world.solver->shown()) EXPECT_TRUE(tree.empty());
  EXPECT_EQ(world.solver->evaluations(), 0u);
}

/// A plate of satin that a narrow light shines on throws it to where a mirror would.
struct Throw {
  SampleWorld world;
  double where = 0, sum = 0;
  uint64_t cells = 0;

  explicit Throw(const SampleSettings& settings, float roughness = 0.2f)
      : world(meshes(), {metalLeaf(roughness), diffuseLeaf(0.8f)}, settings) {
    for (size_t i = 0; i < world.surfels.size(); ++i) {
      if (world.surfels.objects[i] != 0) continue;
      const glsl::IncidentLight light{world.space.direction(glm::normalize(glm::vec3(0, 1, 1))), 0.05f,
                                      glm::vec3(1)};
      world.solver->light(world.forest.leafOf()[i], glm::vec3(0.7f), {&light, 1});
    }
    world.solver->reflect();
    cells = world.solver->cellCount();
    world.solver->shoot(FreeSight());
    for (size_t i = 0; i < world.surfels.size(); ++i) {
      if (world.surfels.objects[i] != 1) continue;
      const double light =
          double(world.solver->irradiance()[world.forest.leafOf()[i]].x) * world.surfels.areas[i];
      sum += light;
      where += light * world.space.worldPoint(world.surfels.positions[i]).y;
    }
    where /= sum;
  }
  /// A plate of 0.4 a side, and a wall 1 behind it that is 2 high.
  static std::vector<TriangleMesh> meshes() {
    return {rectangleMesh({-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, 8),
            rectangleMesh({-1, 0.01f, -1}, {2, 0, 0}, {0, 2, 0}, 20)};
  }
};

TEST(SampleSolverTest, GlossyElementsThrowLightWhereMirrorsWould) {
  const Throw exact({.linkError = 3e-4f, .tree = {.error = 0.02f}});
  EXPECT_NEAR(exact.where, 1, 0.1);
  const Throw fast({});
  std::printf("a plate's light: height %.3f, flux %.2f %% off; %zu cells\n", fast.where,
              100 * (fast.sum / exact.sum - 1), size_t(fast.cells));
  EXPECT_NEAR(fast.where, exact.where, 0.02);
  EXPECT_NEAR(fast.sum / exact.sum, 1, 0.03);
}

TEST(SampleSolverTest, CellsOfOneLevelTakeMoreOfThemForTheSameLight) {
  const Throw adaptive({});
  for (const bool relative : {true, false}) {
    TreeSettings settings{.minLevel = 5, .maxLevel = 5};
    if (relative)
      settings = {
          .criterion = TreeSettings::Criterion::relative, .error = 0.5f, .minLevel = 1, .maxLevel = 6};
    const Throw other({.tree = settings});
    std::printf("%s: flux %.2f %% off, %zu cells; by error %zu\n", relative ? "as published" : "one level",
                100 * (other.sum / adaptive.sum - 1), size_t(other.cells), size_t(adaptive.cells));
    EXPECT_NEAR(other.sum / adaptive.sum, 1, 0.05);
  }
}

TEST(SampleSolverTest, SamplesReflectedTogetherOrEachByItselfAreTheSameLight) {
  double light[2];
  uint64_t evaluations[2];
  for (const bool immediate : {false, true}) {
    SampleWorld world(facingPlates(8), {diffuseLeaf(0.8f), metalLeaf(0.5f)},
                      {.tree = {.criterion = TreeSettings::Criterion::relative,
                                .error = 0.5f,
                                .minLevel = 1,
                                .maxLevel = 4},
                       .immediate = immediate});
    world.light({1, 0});
    for (int bounce = 0; bounce < 2; ++bounce) {
      world.solver->reflect();
      world.solver->shoot(FreeSight());
    }
    light[immediate] = world.mean(0);
    evaluations[immediate] = world.solver->evaluations();
  }
  std::printf("evaluations: %zu together, %zu each by itself\n", size_t(evaluations[0]),
              size_t(evaluations[1]));
  EXPECT_NEAR(light[1] / light[0], 1, 0.05);
  EXPECT_LT(evaluations[0], evaluations[1]);
}

TEST(SampleSolverTest, DarknessAndSingleTrianglesAreHarmless) {
  TriangleMesh triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.normals.assign(3, {0, 0, 1});
  triangle.indices = {0, 1, 2};
  SampleWorld one({triangle}, {metalLeaf(0.2f)});
  for (const float irradiance : {0.f, 1.f}) {
    one.solver->begin();
    one.light({irradiance});
    one.solver->reflect();
    EXPECT_EQ(one.solver->shoot(FreeSight()).links, 0u);
    EXPECT_EQ(one.mean(0), 0);
  }
}

/// Corners of a triangle may lie in clusters of their own, whose elements have samples of their own: those of
/// a sphere, by the axes of its normals.
TEST(SampleSolverTest, SamplesAroundATriangleAreThoseOfAllElementsAboveIt) {
  SampleWorld world({rectangleMesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 8), sphereMesh({0, 1, 0}, 0.3f, 8)},
                    {diffuseLeaf(0.8f), metalLeaf(0.3f)});
  world.light({1, 0});
  world.solver->reflect();
  world.solver->shoot(FreeSight());
  const std::span<const uint32_t> corners = world.forest.triangles();
  size_t most = 0, oneChain = 0;
  for (size_t t = 0; t < corners.size(); t += 3) {
    if (!world.solver->glossy(corners[t])) continue;
    std::set<uint32_t> around;
    for (const uint32_t leaf : corners.subspan(t, 3)) {
      size_t chain = 0;
      for (uint32_t slot = leaf; slot != glsl::no_link; slot = world.forest.parents()[slot / 4]) {
        around.insert(slot);
        chain += world.solver->samples(slot).size();
      }
      oneChain = std::max(oneChain, chain);
    }
    size_t samples = 0;
    for (const uint32_t slot : around) samples += world.solver->samples(slot).size();
    most = std::max(most, samples);
  }
  EXPECT_GT(oneChain, 0u);
  EXPECT_EQ(world.solver->mostSamplesAround(), most);
}

TEST(SampleSolverTest, ScenesThatTakeTooMuchMemoryAreRefused) {
  SampleWorld world(facingPlates(24), {diffuseLeaf(0.8f), diffuseLeaf(0.5f)},
                    {.linkError = 1e-4f, .memory = 1000});
  world.light({1, 1});
  world.solver->reflect();
  EXPECT_THROW(world.solver->shoot(FreeSight()), UsageError);
}

/// Wide lights are up to 64 pieces for a narrow lobe: hundreds of them would take more than all samples.
TEST(SampleSolverTest, LightOfManyLightsThatTakesTooMuchMemoryIsRefused) {
  SampleWorld world(facingPlates(4), {diffuseLeaf(0.8f), metalLeaf(0.2f)}, {.memory = 4000});
  const std::vector<glsl::IncidentLight> lights(100, {glm::vec3(0, 1, 0), 0.1f, glm::vec3(1)});
  const auto leafOf = [&](uint32_t object) {
    const auto found = std::ranges::find(world.surfels.objects, object);
    return world.forest.leafOf()[static_cast<size_t>(found - world.surfels.objects.begin())];
  };
  for (int time = 0; time < 2; ++time) EXPECT_NO_THROW(world.solver->light(leafOf(0), glm::vec3(1), lights));
  for (int solution = 0; solution < 2; ++solution) {
    world.solver->begin();
    EXPECT_NO_THROW(world.solver->light(leafOf(1), glm::vec3(1), lights));
    EXPECT_THROW(world.solver->light(leafOf(1), glm::vec3(1), lights), UsageError);
  }
}

/// Over all bounces; each solution counts for itself.
TEST(SampleSolverTest, ScenesWhoseLinksLookAtTooManyPairsAreRefused) {
  const auto twoRounds = [](SampleWorld& world) {
    world.solver->begin();
    world.light({1, 1});
    uint64_t pairs = 0;
    for (int round = 0; round < 2; ++round) {
      world.solver->reflect();
      pairs += world.solver->shoot(FreeSight()).pairs;
    }
    return pairs;
  };
  const auto plates = [](const SampleSettings& settings) {
    return SampleWorld(facingPlates(8), {diffuseLeaf(0.8f), diffuseLeaf(0.5f)}, settings);
  };
  SampleWorld free = plates({});
  const uint64_t pairs = twoRounds(free);
  SampleWorld enough = plates({.pairs = pairs});
  for (int solution = 0; solution < 2; ++solution) EXPECT_EQ(twoRounds(enough), pairs);
  SampleWorld tooFew = plates({.pairs = pairs - 1});
  EXPECT_THROW(twoRounds(tooFew), UsageError);
}

}  // namespace
}  // namespace limn::radiosity
