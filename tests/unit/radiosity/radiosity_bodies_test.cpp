// Implicit visibility on the CPU where surfaces touch, enclose or lie within each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "core/radiosity/illumination.h"
#include "tests/support/radiosity_meshes.h"
#include "tests/unit/radiosity/radiosity_world.h"

namespace limn::radiosity {
namespace {

/// A block that stands on a floor, with its lowest face in the floor's plane: the floor's vertices below it
/// are corners of triangles that are seen around it, and must not be as bright as if no block were there.
TEST(RadiosityBodiesTest, WhatLiesWithinAClosedBodyTakesTheLightAroundIt) {
  TriangleMesh block = roomMesh(8);
  for (size_t t = 0; t < block.indices.size(); t += 3) std::swap(block.indices[t + 1], block.indices[t + 2]);
  for (glm::vec3& n : block.normals) n = -n;
  for (glm::vec3& p : block.positions) p = glm::vec3(0.5f, 1, 0.5f) * p + glm::vec3(0.05f, 1, 0.05f);
  const World world({block, rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 21)}, {});
  ASSERT_EQ(world.surfels.backless[0], 1);
  const std::vector<float> light = world.received({0, 0}, 1);
  const ElementSpace space = spaceOf({block, rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 21)});
  size_t within = 0;
  for (size_t i = 0; i < light.size(); ++i) {
    const glm::vec3 p = space.worldPoint(world.surfels.vertices[i]);
    if (world.surfels.objects[i] != 1 || std::max(std::abs(p.x - 0.05f), std::abs(p.z - 0.05f)) > 0.5f)
      continue;
    ++within;
    // At the foot of a wall half of the sky is hidden, at a corner of the block a quarter.
    EXPECT_LT(light[i], 0.85f);
    EXPECT_GT(light[i], 0.4f) << "lit as its neighbours, and not dark";
    const glm::vec3 from = space.worldPoint(world.surfels.positions[i]);
    EXPECT_GT(std::max(std::abs(from.x - 0.05f), std::abs(from.z - 0.05f)), 0.5f);
  }
  EXPECT_GT(within, 16u);
}

/// Adds a mesh to another.
void append(TriangleMesh& to, const TriangleMesh& more) {
  const auto first = static_cast<uint32_t>(to.positions.size());
  to.positions.insert(to.positions.end(), more.positions.begin(), more.positions.end());
  to.normals.insert(to.normals.end(), more.normals.begin(), more.normals.end());
  for (const uint32_t i : more.indices) to.indices.push_back(first + i);
}

/// Two balls that are one object, as a limb that is sunk into a body: no element sees from within.
TEST(RadiosityBodiesTest, WhatLiesWithinAPieceOfItsOwnObjectSeesFromOutside) {
  const glm::vec3 centres[2] = {{0, 0, 0}, {0.8f, 0.1f, 0.05f}};
  const float radii[2] = {1, 0.5f};
  TriangleMesh both = sphereMesh(centres[0], radii[0], 16);
  append(both, sphereMesh(centres[1], radii[1], 12));
  const Surfels surfels = surfelsOf({both});
  const ElementSpace space = spaceOf({both});
  EXPECT_EQ(surfels.pieceCount, 2u);
  EXPECT_TRUE(surfels.rims.empty());
  size_t moved = 0;
  for (size_t i = 0; i < surfels.size(); ++i) {
    const size_t other = 1 - surfels.pieces[i];
    const auto within = [&](const glm::vec3& p) {
      return glm::length(space.worldPoint(p) - centres[other]) < 0.97f * radii[other];
    };
    EXPECT_FALSE(within(surfels.positions[i]));
    if (within(surfels.vertices[i])) ++moved;
  }
  EXPECT_GT(moved, 20u);
}

/// Many such pairs: each limb is sunk into its own body and into no other.
TEST(RadiosityBodiesTest, EachOfManyPiecesIsLookedForWhereItIs) {
  constexpr size_t kPairs = 40;
  const float radii[2] = {1, 0.5f};
  std::vector<glm::vec3> centres;
  TriangleMesh all;
  for (size_t pair = 0; pair < kPairs; ++pair) {
    const glm::vec3 place(4 * float(pair % 8), 4 * float(pair / 8), 0);
    for (const glm::vec3& offset : {glm::vec3(0), glm::vec3(0.8f, 0.1f, 0.05f)}) {
      centres.push_back(place + offset);
      append(all, sphereMesh(centres.back(), radii[(centres.size() - 1) % 2], 16));
    }
  }
  const Surfels surfels = surfelsOf({all});
  const ElementSpace space = spaceOf({all});
  ASSERT_EQ(surfels.pieceCount, 2 * kPairs);
  std::vector<size_t> moved(2 * kPairs, 0);
  for (size_t i = 0; i < surfels.size(); ++i) {
    const size_t other = surfels.pieces[i] ^ 1;
    const auto within = [&](const glm::vec3& p) {
      return glm::length(space.worldPoint(p) - centres[other]) < 0.97f * radii[other % 2];
    };
    EXPECT_FALSE(within(surfels.positions[i]));
    if (within(surfels.vertices[i])) ++moved[surfels.pieces[i]];
  }
  for (const size_t count : moved) EXPECT_GT(count, 10u);
}

/// What lies within an open piece of another object sees its back, which is black; a floor is no body.
TEST(RadiosityBodiesTest, OpenPiecesEncloseNothingOfOthers) {
  TriangleMesh bowl = sphereMesh({0, 0, 0}, 1, 16);
  std::vector<uint32_t> lower;
  for (size_t t = 0; t < bowl.indices.size(); t += 3) {
    const auto height = [&](size_t k) { return bowl.positions[bowl.indices[t + k]].y; };
    if (std::max({height(0), height(1), height(2)}) < 0.1f)
      lower.insert(lower.end(), bowl.indices.begin() + static_cast<std::ptrdiff_t>(t),
                   bowl.indices.begin() + static_cast<std::ptrdiff_t>(t) + 3);
  }
  bowl.indices = lower;
  const Surfels surfels = surfelsOf({bowl, rectangleMesh({-2, -0.5f, -2}, {0, 0, 4}, {4, 0, 0}, 21)});
  EXPECT_EQ(surfels.pieceCount, 2u);
  EXPECT_EQ(surfels.holeCount, 2u);
  for (size_t i = 0; i < surfels.size(); ++i)
    EXPECT_EQ(surfels.positions[i], surfels.centre(i, surfels.vertices, surfels.normals[i]));
}

/// Whether a ray from `p` meets one of the triangles of object 0 (Moller and Trumbore 1997).
bool hidden(const Surfels& surfels, const glm::dvec3& p, const glm::dvec3& ray) {
  for (size_t t = 0; t < surfels.triangles.size(); t += 3) {
    if (surfels.objects[surfels.triangles[t]] != 0) break;
    const auto corner = [&](size_t k) { return glm::dvec3(surfels.vertices[surfels.triangles[t + k]]); };
    const glm::dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a, across = glm::cross(ray, ac);
    const double det = glm::dot(ab, across);
    if (std::abs(det) < 1e-14) continue;
    const double u = glm::dot(p - a, across) / det;
    const glm::dvec3 q = glm::cross(p - a, ab);
    const double v = glm::dot(ray, q) / det, at = glm::dot(ac, q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && at > 1e-9) return true;
  }
  return false;
}

/// How wrong the part of the sky is that elements of object 1 see within `radius` of the origin, in the plane
/// of a floor: the greatest error.
double contactError(const std::vector<TriangleMesh>& meshes, const LinkSettings& settings, double radius) {
  const World world(meshes, settings);
  const ElementSpace space = spaceOf(meshes);
  const std::vector<float> sky = world.received({0, 0}, 1);
  const std::vector<glm::vec4> table = binTable(settings.resolution);
  double most = 0;
  size_t elements = 0;
  for (size_t i = 0; i < sky.size(); ++i) {
    const glm::vec3 place = space.worldPoint(world.surfels.positions[i]);
    if (world.surfels.objects[i] != 1 || glm::length(glm::dvec2(place.x, place.z)) > radius) continue;
    const glm::dvec3 p(world.surfels.positions[i]), up(world.surfels.normals[i]);
    double seen = 0, weights = 0;
    for (const glm::vec4& bin : table) {
      const double weight = bin.w * glm::dot(glm::dvec3(bin), up);
      if (weight <= 0) continue;
      weights += weight;
      if (!hidden(world.surfels, p, glm::dvec3(bin))) seen += weight;
    }
    most = std::max(most, std::abs(sky[i] - seen / weights));
    ++elements;
  }
  EXPECT_GT(elements, 8u);
  return most;
}

/// Where a sphere or a block rests on a floor, elements near the contact see the sphere's or the block's
/// nearest triangles, whose discs would lie edge-on.
TEST(RadiosityBodiesTest, ElementsAtContactsAreHidden) {
  const TriangleMesh floor = rectangleMesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 60);
  TriangleMesh block = roomMesh(8);
  for (size_t t = 0; t < block.indices.size(); t += 3) std::swap(block.indices[t + 1], block.indices[t + 2]);
  for (glm::vec3& n : block.normals) n = -n;
  for (glm::vec3& p : block.positions) p = 0.5f * p + glm::vec3(0.017f, 0.5f, 0.009f);
  const struct {
    const char* name;
    TriangleMesh body;
    double radius;
  } cases[] = {{"sphere", sphereMesh({0.017f, 0.5f, 0.009f}, 0.5f, 24), 0.5},
               {"coarse sphere", sphereMesh({0.017f, 0.5f, 0.009f}, 0.5f, 10), 0.5},
               {"block", block, 0.9}};
  for (const auto& [name, body, radius] : cases) {
    const auto error = [&](Fill fill) {
      return contactError({body, floor}, {.resolution = 16, .fill = fill}, radius);
    };
    const double discs = error(Fill::footprint), triangles = error(Fill::triangles);
    std::printf("under a %s: error of the sky %.4f by discs, %.4f by triangles\n", name, discs, triangles);
    EXPECT_LE(triangles, 0.02);
    EXPECT_LT(triangles, 0.25 * discs);
  }
}

/// What of a bright sky gets into closed bodies, whose elements do not cover all directions: nothing should.
TEST(RadiosityBodiesTest, CoarseMeshesLeakLittle) {
  for (const int n : {4, 8, 16, 24}) {
    const World sphere({sphereMesh({0, 0, 0}, 1, n, -1)}, {}), room({roomMesh(n)}, {});
    const double intoSphere = sphere.mean(sphere.received({0}, 1), 0),
                 intoRoom = room.mean(room.received({0}, 1), 0);
    std::printf("leaks: sphere of %zu surfels %.6f, room of %zu %.6f\n", sphere.surfels.size(), intoSphere,
                room.surfels.size(), intoRoom);
    EXPECT_LT(intoSphere, 2e-4) << sphere.surfels.size() << " surfels";
    EXPECT_LT(intoRoom, 2e-4) << room.surfels.size() << " surfels";
  }
}

}  // namespace
}  // namespace limn::radiosity
