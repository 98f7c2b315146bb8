// Implicit visibility on the CPU against closed forms: areas, form factors, white furnaces; and its hierarchy
// against all pairs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "core/base/error.h"
#include "core/radiosity/illumination.h"
#include "glsl/numeric/equirectangular.glsl"
#include "glsl/surface/brdf.glsl"
#include "tests/support/radiosity_meshes.h"
#include "tests/unit/radiosity/radiosity_world.h"

namespace limn::radiosity {
namespace {

double coaxialDiscs(double r1, double r2, double h) {
  const double a = r1 / h, b = r2 / h, x = 1 + (1 + b * b) / (a * a);
  return 0.5 * (x - std::sqrt(x * x - 4 * (b / a) * (b / a)));
}

std::vector<TriangleMesh> discs(float r1, float r2, float h, int n = 32) {
  return {discMesh({0, 0, 0}, r1, 1, n), discMesh({0, h, 0}, r2, -1, n)};
}

double rmse(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  return std::sqrt(sum / double(a.size()));
}

TEST(RadiosityTest, BinsAreWhereTheirDirectionsPointAndFillTheSphere) {
  for (const uint32_t n : {4u, 8u, 12u, 16u, 32u}) {
    double sphere = 0;
    for (uint32_t bin = 0; bin < 6 * n * n; ++bin) {
      EXPECT_EQ(glsl::bin_of(glsl::bin_direction(bin, n), n), bin);
      sphere += glsl::bin_solid_angle(bin, n);
    }
    EXPECT_NEAR(sphere, 4 * glsl::pi, 1e-4);
  }
}

/// What a white metal reflects of a uniform sky by looking its lobe up at the bins' centres, which
/// display=pixel does, for normals and views all over the sphere: as many bins see it, no more and no less.
TEST(RadiosityTest, LobesAtTheCentresOfBinsKeepTheirEnergy) {
  for (const uint32_t resolution : {8u, 12u, 16u}) {
    const std::vector<glm::vec4> table = binTable(static_cast<int>(resolution));
    const auto reflected = [&](const glm::vec3& n, const glm::vec3& v, float alpha) {
      glsl::SurfaceBrdf metal = glsl::surface_brdf(glm::vec3(1), 1, 1, 1, glm::vec3(1), 1.5f);
      metal.alpha = alpha;
      float sum = 0, weights = 0;
      for (const glm::vec4& bin : table) {
        const float weight = bin.w * glm::dot(n, glm::vec3(bin));
        if (weight <= 0) continue;
        weights += weight;
        sum += weight * glsl::brdf(metal, n, v, glm::vec3(bin)).x;
      }
      return glsl::pi * sum / weights;
    };
    constexpr float alpha = 0.15f * 0.15f;  // roughness 0.15
    glm::vec2 narrow(1e9f, 0), wide(1e9f, 0);
    for (int i = 0; i < 400; ++i) {
      // Spiral points, and views up to 45 degrees from the normal.
      const float z = 1 - (static_cast<float>(i) + 0.5f) / 200, turn = 2.39996323f * static_cast<float>(i);
      const float r = std::sqrt(1 - z * z);
      const glm::vec3 n(r * std::cos(turn), r * std::sin(turn), z);
      const glm::vec3 across = glm::normalize(glm::cross(n, glm::vec3(0.3f, 0.5f, 0.8f)));
      const float tilt = static_cast<float>(i % 10) / 10 * glsl::pi / 4;
      const glm::vec3 v = std::cos(tilt) * n + std::sin(tilt) * across;
      const auto extend = [](glm::vec2& range, float value) {
        range = {std::min(range.x, value), std::max(range.y, value)};
      };
      extend(narrow, reflected(n, v, alpha));
      extend(wide, reflected(n, v, glsl::binned_alpha(alpha, resolution)));
    }
    std::printf("%u bins, roughness 0.15: %.2f to %.2f of the energy as it is, %.2f to %.2f widened\n",
                resolution, double(narrow.x), double(narrow.y), double(wide.x), double(wide.y));
    EXPECT_GT(wide.x, 0.85f);
    EXPECT_LT(wide.y, 1.15f);
  }
}

/// A single bright pixel of a large map arrives whole, wherever it lies, and a sky that is the same all round
/// stays so. A bin of 4 a side holds 5461 pixels of the map on average, of which the 300 or so at its edge
/// are counted with their centres.
TEST(RadiosityTest, BinsHoldEveryPixelOfAnEnvironment) {
  constexpr int n = 4, width = 1024, height = 512;
  const std::vector<glm::vec4> table = binTable(n);
  const ElementSpace space(glm::vec3(0), 1);
  scene::Environment map;
  map.width = width;
  map.height = height;
  map.scale = 2;
  map.rotation = 1;
  for (const glm::ivec2 bright : {glm::ivec2(300, 200), glm::ivec2(801, 255), glm::ivec2(17, 40)}) {
    map.texels.assign(size_t{width} * height, glm::vec3(0));
    map.texels[static_cast<size_t>(bright.y * width + bright.x)] = {1000, 0, 0};
    const std::vector<glm::vec4> bins = environmentBins(map, space, n);
    double power = 0;
    for (size_t bin = 0; bin < bins.size(); ++bin) power += double(bins[bin].x) * double(table[bin].w);
    const double exact = 2 * 1000 * double(glsl::equirectangular_pixel_solid_angle(bright.y, width, height));
    EXPECT_NEAR(power / exact, 1, 0.01) << bright.x << " " << bright.y;
  }
  map.texels.assign(size_t{width} * height, glm::vec3(0.5f));
  for (const glm::vec4& bin : environmentBins(map, space, n)) EXPECT_NEAR(bin.x, 1, 1e-6);
}

TEST(RadiosityTest, LeafAreasSumToTheMeshArea) {
  const glm::vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  TriangleMesh triangle;
  triangle.positions.assign(std::begin(corners), std::end(corners));
  triangle.normals.assign(3, {0, 0, 1});
  triangle.indices = {0, 1, 2};
  for (const float longest : {10.f, 0.3f, 0.05f}) {
    const Surfels surfels = createSurfels(std::span(&triangle, 1), longest);
    EXPECT_NEAR(std::accumulate(surfels.areas.begin(), surfels.areas.end(), 0.0), 1, 1e-5);
    EXPECT_GE(surfels.size(), 3u);
  }
  const World sphere({sphereMesh({0, 0, 0}, 1, 32)});
  double roots = 0;
  for (const uint32_t root : sphere.forest.roots()) roots += sphere.forest.groups()[root].area.x;
  EXPECT_NEAR(roots, sphere.area(), 1e-4);
  EXPECT_NEAR(sphere.area() / (4 * glsl::pi / 3), 1, 0.01);  // its bounds' diagonal is 2 sqrt 3 of its radius
}

TEST(RadiosityTest, TrianglesWithoutAreaAndSingleTrianglesAreHarmless) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {2, 0, 0}};
  mesh.normals.assign(5, {0, 0, 1});
  mesh.indices = {0, 1, 2, 0, 3, 0, 0, 1, 4, 1, 1, 1};
  for (const bool flat : {false, true}) {
    const World world({mesh}, {}, flat);
    EXPECT_EQ(world.surfels.size(), 3u);
    for (const float e : world.received({1})) EXPECT_EQ(e, 0);
    for (const float e : world.received({1}, 0.5f)) EXPECT_NEAR(e, 0.5, 1e-5);
  }
  const World nothing(std::vector<TriangleMesh>{TriangleMesh{}});
  EXPECT_EQ(nothing.forest.slots(), 0u);
}

TEST(RadiosityTest, FormFactorOfCoaxialDiscs) {
  for (const auto& [r1, r2, h] :
       {std::tuple(1.f, 1.f, 1.f), std::tuple(0.5f, 1.f, 1.f), std::tuple(1.f, 1.f, 0.5f)})
    for (const Fill fill : {Fill::centre, Fill::footprint}) {
      const World world(discs(r1, r2, h), {.resolution = 16, .fill = fill, .opening = kPublished});
      const double f12 = world.mean(world.received({0, 1}), 0), f21 = world.mean(world.received({1, 0}), 1);
      const double exact = coaxialDiscs(r1, r2, h);
      std::printf("discs %g %g at %g, %s: F12 %.4f (%.4f), ratio %.3f\n", r1, r2, h,
                  fill == Fill::centre ? "centre" : "footprint", f12, exact, f12 / exact);
      // A bin of which an element fills a part counts as full by its centre, or as its share by its
      // footprint.
      EXPECT_NEAR(f12 / exact, 1, fill == Fill::footprint ? 0.05 : 0.1);
      EXPECT_NEAR(f12 * r1 * r1 / (f21 * r2 * r2), 1, fill == Fill::footprint ? 0.05 : 0.1) << "reciprocity";
    }
}

TEST(RadiosityTest, FormFactorOfParallelSquares) {
  // Unit squares at distance 1 (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11).
  const World world({rectangleMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 32),
                     rectangleMesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 32)});
  EXPECT_NEAR(world.mean(world.received({0, 1}), 0) / 0.19982, 1, 0.05);
}

TEST(RadiosityTest, UnevenTessellationKeepsTheFormFactor) {
  // The lower square in two halves, of 72 and of 1152 rectangles, which become narrow with the power.
  const auto strip = [](float from, float to, int n, int m, double power) {
    return gridMesh(
        n, m,
        [=](float a, float b) {
          return glm::vec3(b, 0, from + (to - from) * static_cast<float>(std::pow(double(a), power)));
        },
        [](float, float) { return glm::vec3(0, 1, 0); });
  };
  for (const double power : {1.0, 2.0, 3.0}) {
    const World world({strip(0, 0.5f, 6, 12, power), strip(0.5f, 1, 48, 24, power),
                       rectangleMesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 32)});
    const std::vector<float> seen = world.received({0, 0, 1});
    const double f = 0.5 * (world.mean(seen, 0) + world.mean(seen, 1)),
                 back = world.mean(world.received({1, 1, 0}), 2);
    std::printf("uneven squares, power %g: %zu surfels, F12 %.4f, F21 %.4f (0.1998)\n", power, seen.size(), f,
                back);
    // The coarse half's outline is fattened by a fifth of its elements.
    EXPECT_NEAR(f / 0.19982, 1, 0.05);
    EXPECT_NEAR(back / 0.19982, 1, 0.08);
  }
}

TEST(RadiosityTest, PairsThatFaceAwayAreNotLinked) {
  const World world({sphereMesh({0, 0, 0}, 1, 16), sphereMesh({3, 0, 0}, 1, 16)}, {}, true);
  const auto groups = world.forest.groups();
  const auto at = [&](uint32_t slot, bool normal) {
    const glsl::ElementGroup& g = groups[slot / 4];
    const int k = static_cast<int>(slot % 4);
    return normal ? glm::vec3(g.nx[k], g.ny[k], g.nz[k]) : glm::vec3(g.x[k], g.y[k], g.z[k]);
  };
  size_t linked = 0, wrong = 0;
  for (const uint32_t leaf : world.forest.leafOf())
    for (const uint32_t link : world.links.of(leaf)) {
      if (link == glsl::no_link) continue;
      ++linked;
      const glm::vec3 d = at(link, false) - at(leaf, false);
      wrong += !(glm::dot(d, at(leaf, true)) > 0 && glm::dot(d, at(link, true)) < 0);
    }
  EXPECT_GT(linked, 1000u);
  EXPECT_EQ(wrong, 0u);
}

TEST(RadiosityTest, BacksOfOpenSurfacesBlockAndAreBlack) {
  // Above a floor a plate that faces up: from below its back hides the sky and gives nothing.
  const World world({rectangleMesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 20),
                     rectangleMesh({-1, 0.5f, -1}, {0, 0, 2}, {2, 0, 0}, 20)});
  const double sky = 1 - coaxialDiscs(1, 1, 0.5);  // about
  EXPECT_NEAR(world.mean(world.received({0, 5}, 1), 0), sky, 0.1);
  EXPECT_NEAR(world.mean(world.received({0, 5}, 1), 1), 1, 1e-4);
}

/// On an open bowl of few triangles with smooth normals, split into smaller ones: neighbours lean towards
/// each other, which must not pass for backs of other surfaces.
TEST(RadiosityTest, NeighboursOnACoarseOpenSurfaceDoNotHideEachOther) {
  TriangleMesh bowl = sphereMesh({0, 0, 0}, 1, 10);
  bowl.indices.resize(bowl.indices.size() * 7 / 10);  // open at the top
  const World world({bowl}, {}, false, 0.06f);
  ASSERT_EQ(world.surfels.backless.front(), 0);
  const std::vector<float> sky = world.received({0}, 1);
  const auto darkened = std::ranges::count_if(sky, [](float v) { return v < 0.98f; });
  EXPECT_LT(double(darkened) / double(sky.size()), 0.01) << *std::ranges::min_element(sky);
}

TEST(RadiosityTest, ScaleOfTheSceneDoesNotMatter) {
  const auto scaled = [](float factor) {
    auto meshes = std::vector{sphereMesh({0.1f, 0.9f, 0}, 0.5f, 24),
                              rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 40)};
    for (TriangleMesh& mesh : meshes)
      for (glm::vec3& p : mesh.positions) p *= factor;
    return World(std::move(meshes));
  };
  const std::vector<float> same = scaled(1).received({1, 0.2f}, 0.5f);
  for (const float factor : {1e-4f, 1e4f}) {
    const std::vector<float> other = scaled(factor).received({1, 0.2f}, 0.5f);
    ASSERT_EQ(other.size(), same.size());
    EXPECT_LT(rmse(other, same), 1e-4);
  }
}

TEST(RadiosityTest, HierarchyAgreesWithAllPairs) {
  const std::vector<TriangleMesh> meshes{sphereMesh({0, 0.7f, 0}, 0.5f, 32),
                                         rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 48),
                                         rectangleMesh({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, 12)};
  for (const LinkSettings& settings :
       {LinkSettings{.resolution = 8, .fill = Fill::centre, .opening = kPublished},
        LinkSettings{.resolution = 8, .opening = kPublished},
        LinkSettings{.fill = Fill::centre, .opening = kPublished}, LinkSettings{.opening = kPublished},
        LinkSettings{}}) {
    const World tree(meshes, settings), flat(meshes, settings, true);
    const std::vector<float> a = tree.received({0.3f, 0.5f, 4}, 0.5f),
                             b = flat.received({0.3f, 0.5f, 4}, 0.5f);
    const bool footprint = settings.fill == Fill::footprint;
    std::printf("N %d, %s, opening %g: %zu surfels, RMSE %.4f\n", settings.resolution,
                footprint ? "footprint" : "centre", settings.opening, a.size(), rmse(a, b));
    EXPECT_LT(rmse(a, b), settings.resolution == 16 && footprint ? 0.02 : 0.1);
  }
}

/// Below a plate that hides a bright ceiling: what comes through between links that receivers share and those
/// of their own.
TEST(RadiosityTest, SharedLinksLeaveNoHoles) {
  const std::vector<TriangleMesh> meshes = {
      rectangleMesh({-1.6f, 0.5f, -1.6f}, {3.2f, 0, 0}, {0, 0, 3.2f}, 40),
      rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 60),
      rectangleMesh({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, 30)};
  const World shared(meshes, {}), flat(meshes, {}, true);
  const std::vector<float> through = shared.received({0, 0, 1}), around = flat.received({0, 0, 1});
  const ElementSpace space = spaceOf(meshes);
  float most = 0;
  for (size_t i = 0; i < through.size(); ++i) {
    const glm::vec3 p = space.worldPoint(shared.surfels.vertices[i]);
    if (shared.surfels.objects[i] == 1 && std::max(std::abs(p.x), std::abs(p.z)) < 1)
      most = std::max(most, through[i] - around[i]);
  }
  std::printf("through a plate: at most %.5f of the ceiling\n", double(most));
  EXPECT_LT(most, 0.002f);
}

/// A sphere that turns under a sky darkens the floor always alike; what changes is the method's.
TEST(RadiosityTest, ARotatingBodyFlickersLittle) {
  constexpr int n = 24, steps = 8;
  std::vector<float> last;
  double change = 0, darkness = 0;
  for (int step = 0; step < steps; ++step) {
    TriangleMesh body = sphereMesh({0, 0, 0}, 0.5f, n);
    const float angle = glsl::pi / n * static_cast<float>(step) / steps, cosine = std::cos(angle),
                sine = std::sin(angle);
    const auto turned = [&](const glm::vec3& p) {
      return glm::vec3(cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x);
    };
    for (glm::vec3& p : body.positions) p = turned(p) + glm::vec3(0, 0.7f, 0);
    for (glm::vec3& normal : body.normals) normal = turned(normal);
    const World world({body, rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 48)}, {});
    const std::vector<float> all = world.received({0, 0}, 1);
    std::vector<float> floor;
    for (size_t i = 0; i < all.size(); ++i)
      if (world.surfels.objects[i] == 1) floor.push_back(all[i]);
    if (step == 0) darkness = rmse(floor, std::vector<float>(floor.size(), 1));
    if (step > 0) change = std::max(change, rmse(floor, last));
    last = floor;
  }
  std::printf("rotating sphere: the floor changes by %.4f, its shadow is %.4f (RMS)\n", change, darkness);
  EXPECT_LT(change, 0.02 * darkness);
}

TEST(RadiosityTest, AFurnaceConvergesFromBelow) {
  struct Case {
    const char* name;
    TriangleMesh mesh;
  };
  for (const Case& c : {Case{"sphere", sphereMesh({0, 0, 0}, 1, 32, -1)}, Case{"room", roomMesh(20)}}) {
    const World world({c.mesh}, {.resolution = 12, .opening = 0.5f});
    size_t holes = 0, above = 0;
    const std::vector<float> seen = world.received({1});
    for (const float e : seen) holes += e<0.9999f, above += e> 1.0001f;
    std::printf("%s: %zu surfels, %zu with holes, mean %.6f\n", c.name, seen.size(), holes,
                world.mean(seen, 0));
    EXPECT_EQ(above, 0u);
    for (const float albedo : {0.5f, 0.9f, 0.99f}) {
      std::vector<glm::vec3> outgoing(world.forest.slots()), irradiance(world.forest.leafSlots());
      const auto emission = world.perLeaf({1});
      std::copy(emission.begin(), emission.end(), outgoing.begin());
      pullUp(world.forest, outgoing);
      const auto table = binTable(world.links.resolution());
      const float exact = 1 / (1 - albedo);
      float low = 0, high = 0;  // of what leaves give, in parts of the exact
      std::vector<float> lows;  // after each bounce
      const int bounces = static_cast<int>(std::ceil(std::log(1e-5) / std::log(double(albedo))));
      for (int bounce = 0; bounce < bounces; ++bounce) {
        gather(world.forest, world.links, table, outgoing, {}, irradiance);
        low = 1e9f, high = 0;
        for (const uint32_t leaf : world.forest.leafOf()) {
          outgoing[leaf] = emission[leaf] + albedo * irradiance[leaf] * glsl::inverse_pi;
          low = std::min(low, outgoing[leaf].x / exact);
          high = std::max(high, outgoing[leaf].x / exact);
        }
        pullUp(world.forest, outgoing);
        lows.push_back(low);
      }
      /// Bounces until all leaves give more than that part of the exact; 0: they never do.
      const auto until = [&](float part) {
        const auto found = std::ranges::find_if(lows, [part](float share) { return share > part; });
        return found == lows.end() ? 0 : static_cast<int>(found - lows.begin()) + 1;
      };
      const int one = until(0.99f), tenth = until(0.999f * low);
      const std::string what = fmt::format(
          "{}, albedo {}: {:.4f} to {:.4f} of E / (1 - albedo), 1 % after {} bounces, 0.1 % of its own "
          "limit after {}",
          c.name, albedo, low, high, one, tenth);
      std::printf("%s\n", what.c_str());
      EXPECT_GT(low, 0.995) << what;
      EXPECT_LT(high, 1 + 1e-4) << what;
      // After k bounces albedo^(k + 1) is missing, and up to 0.4 % for good: log(0.006) is 1.11 log(0.01).
      const double least = std::log(0.01) / std::log(double(albedo));
      EXPECT_GE(one, std::floor(least)) << what;
      EXPECT_LT(one, 1.15 * least) << what;
      // 9, 65 and 687 bounces.
      EXPECT_GT(tenth, 0) << what;
      EXPECT_LE(tenth, 1.15 * std::floor(std::log(0.001) / std::log(double(albedo)))) << what;
    }
  }
}

TEST(RadiosityTest, WhatIsNotGivenToGatherIsDark) {
  World world(discs(1, 1, 1, 8));
  const std::vector<glm::vec4> table = binTable(world.links.resolution());
  const std::vector<glm::vec3> dark(world.forest.slots(), glm::vec3(0)),
      sky(world.links.binCount(), glm::vec3(2));
  std::vector<glm::vec3> expected(world.forest.leafSlots(), glm::vec3(0)), irradiance = expected;
  const std::vector<glm::vec3> nothing = expected;
  gather(world.forest, world.links, table, dark, sky, expected);
  gather(world.forest, world.links, table, {}, sky, irradiance);
  EXPECT_EQ(irradiance, expected);
  EXPECT_NE(irradiance, nothing);
  gather(world.forest, world.links, table, {}, {}, irradiance);
  EXPECT_EQ(irradiance, nothing);
  // Leaves without a normal see no bin.
  std::ranges::fill(world.surfels.normals, glm::vec3(0));
  world.forest.refit(world.surfels);
  gather(world.forest, world.links, table, {}, sky, irradiance);
  EXPECT_EQ(irradiance, nothing);
}

TEST(RadiosityTest, ResolutionsOutOfRangeAreRefused) {
  const Surfels surfels = surfelsOf({sphereMesh({0, 0, 0}, 1, 4)});
  const Forest forest(surfels);
  Links links;
  EXPECT_THROW(links.build(forest, {.resolution = 3}), UsageError);
  EXPECT_THROW(links.build(forest, {.resolution = 33}), UsageError);
}

}  // namespace
}  // namespace limn::radiosity
