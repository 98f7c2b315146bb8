// Path tracing against closed forms: 0.5 % mean relative error of pixels where they can be sampled that well,
// else 0.3 % of the picture's mean.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "glsl/surface/brdf.glsl"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

constexpr double kPathBound = 0.005;
constexpr double kBoundOfMean = 0.003;
constexpr double kSkipped = std::numeric_limits<double>::quiet_NaN();

Result traced(const World& world, Term term, int bounces, int spp = 256, int size = 16) {
  Request request = world.request(size, term, spp);
  request.bounces = bounces;
  return render(request);
}

/// How far a picture's mean is from that of expected(position), relative to it.
template <class Expected>
double relativeBias(const World& world, const Image& image, const char* channel, Expected expected) {
  double sum = 0, total = 0;
  const int c = image.channel(channel), coverage = image.channel("coverage");
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y, coverage) == 0.f) continue;
      sum += static_cast<double>(image.at(x, y, c));
      total += expected(positionOf(world, image, x, y));
    }
  return std::abs(sum / total - 1);
}

/// 1 + a + ... + a^(count - 1).
double geometricSum(double a, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum = 1 + a * sum;
  return sum;
}

/// A closed cube of side 2 whose walls all reflect `albedo` and emit `radiance` inwards, seen from within.
World glowingBox(const glm::vec3& albedo, float radiance) {
  World world;
  const int walls = world.addMaterial(albedo);
  world.scene.materials[0].emission = glm::vec3(radiance);
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.f, 1.f}) {
      glm::vec3 n(0), u(0);
      n[axis] = -side;
      u[(axis + 1) % 3] = 2;
      const glm::vec3 v = glm::cross(n, u), centre = -n;
      world.addQuad(centre, u, v, walls);
      glsl::Light& light = world.addRectangle(centre, -u, v, radiance);
      light.flags = glsl::light_flag_geometry;
      light.own_instance = static_cast<uint32_t>(world.pose.instances.size()) - 1;
    }
  world.camera = scene::lookAt({0.1f, -0.2f, 0.3f}, {1, 0.7f, 0.8f}, 1.2f);
  return world;
}

/// In a closed room of equal walls every bounce brings a times what the one before it brought.
TEST(ReferencePath, FurnaceOfGlowingWalls) {
  const glm::vec3 albedo(0.6f, 0.3f, 0.9f);
  const World world = glowingBox(albedo, 2);
  for (const int bounces : {1, 2, 5, 24}) {
    const Image indirect = traced(world, Term::indirect, bounces).image;
    const Image final = traced(world, Term::final, bounces).image;
    for (int c = 0; c < 3; ++c) {
      const char* channel = c == 0 ? "R" : c == 1 ? "G" : "B";
      const double a = static_cast<double>(albedo[c]);
      const auto reflected = [&](const glm::dvec3&) { return 2 * a * a * geometricSum(a, bounces); };
      const auto all = [&](const glm::dvec3&) { return 2 * geometricSum(a, bounces + 2); };
      EXPECT_LT(relativeBias(world, indirect, channel, reflected), kBoundOfMean) << bounces << channel;
      EXPECT_LT(relativeBias(world, final, channel, all), kBoundOfMean) << bounces << channel;
      EXPECT_LT(meanRelativeError(world, indirect, channel, reflected), 0.03) << bounces << channel;
    }
  }
}

/// Between any two places of a sphere's inside the form factor is the same, so that a light in its centre
/// makes every bounce uniform.
TEST(ReferencePath, IntegratingSphere) {
  World world;
  const float albedo = 0.7f;
  world.addInstance(world.addMesh(World::sphere(256, world.addMaterial(glm::vec3(albedo), true))));
  world.addLight(glsl::light_point, {0, 0, 0}, {0, -1, 0}, glm::vec3(3));
  world.camera = scene::lookAt({0.2f, 0.3f, -0.4f}, {1, 0, 0.3f}, 1.4f);
  const double a = static_cast<double>(albedo), direct = a * 3 / M_PI;
  for (const int bounces : {1, 3, 40})
    EXPECT_LT(relativeBias(world, traced(world, Term::indirect, bounces, 1024).image, "R",
                           [&](const glm::dvec3&) { return direct * a * geometricSum(a, bounces); }),
              kBoundOfMean)
        << bounces;
}

/// Where nothing is absorbed, every surface in a uniform environment is as bright as it.
TEST(ReferencePath, WhiteCornerInAUniformEnvironment) {
  World world;
  const int white = world.addMaterial(glm::vec3(1));
  world.addQuad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, white);
  world.addQuad({0, 1, -1}, {2, 0, 0}, {0, 2, 0}, white);
  world.addQuad({-1, 1, 0}, {0, 0, -2}, {0, 2, 0}, white);
  world.camera = scene::lookAt({0.9f, 1.9f, 0.9f}, {-1, 0, -1}, 0.9f);
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(2));
  EXPECT_LT(relativeBias(world, traced(world, Term::final, 40, 1024).image, "G",
                         [](const glm::dvec3&) { return 2.0; }),
            kBoundOfMean);
}

const glm::vec3 kLamp(0.2f, 1.4f, 0.8f), kEye(0, 1.6f, 2.6f);

/// A wall over the floor, a point light before both: the floor gets what the wall reflects.
World wallOverFloor() {
  World world = floorWorld();
  world.addQuad({0, 1, -1}, {1.5f, 0, 0}, {0, 1.2f, 0}, world.addMaterial(glm::vec3(0.8f)));
  world.addLight(glsl::light_point, kLamp, {0, -1, 0}, glm::vec3(5));
  world.camera = scene::lookAt(kEye, {0, 0, 0.4f}, 0.6f);
  return world;
}

/// What the wall sends to the floor and the floor to the eye, by quadrature over the wall. NaN on the wall.
double fromWallOverFloor(const glm::dvec3& x, const glsl::SurfaceBrdf& floor, const glsl::SurfaceBrdf& wall) {
  if (x.y > 1e-3) return kSkipped;
  const int n = 48;
  const glm::vec3 up(0, 1, 0), front(0, 0, 1);
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const glm::dvec3 y(-0.75 + 1.5 * (i % n + 0.5) / n, 0.4 + 1.2 * (i / n + 0.5) / n, -1);
    const glm::dvec3 toLamp = glm::dvec3(kLamp) - y, toWall = y - x;
    const glm::vec3 l(glm::normalize(toLamp)), w(glm::normalize(toWall));
    const double irradiance = 5 * static_cast<double>(l.z) / glm::dot(toLamp, toLamp);
    const double geometry = std::max(static_cast<double>(w.y), 0.0) *
                            std::max(static_cast<double>(-w.z), 0.0) / glm::dot(toWall, toWall);
    sum += irradiance * geometry * static_cast<double>(glsl::brdf(wall, front, -w, l).r) *
           static_cast<double>(glsl::brdf(floor, up, glm::vec3(glm::normalize(glm::dvec3(kEye) - x)), w).r);
  }
  return sum * 1.5 * 1.2 / (n * n);
}

TEST(ReferencePath, OneBounceBetweenTwoPatches) {
  const World world = wallOverFloor();
  const glsl::SurfaceBrdf floor = glsl::surface_brdf(glm::vec3(0.5f), 0, 1, 0, glm::vec3(1), 1.5f);
  const glsl::SurfaceBrdf wall = glsl::surface_brdf(glm::vec3(0.8f), 0, 1, 0, glm::vec3(1), 1.5f);
  EXPECT_LT(meanRelativeError(world, traced(world, Term::indirect, 1, 1 << 16, 8).image, "R",
                              [&](const glm::dvec3& x) { return fromWallOverFloor(x, floor, wall); }),
            kPathBound);
}

TEST(ReferencePath, OneBounceBetweenTwoGlossyPatches) {
  World world = wallOverFloor();
  for (auto& material : world.scene.materials) material.specularFactor = material.metallic = 1;
  world.scene.materials[0].roughness = 0.5f;
  world.scene.materials[1].roughness = 0.6f;
  const glsl::SurfaceBrdf floor = glsl::surface_brdf(glm::vec3(0.5f), 1, 0.5f, 1, glm::vec3(1), 1.5f);
  const glsl::SurfaceBrdf wall = glsl::surface_brdf(glm::vec3(0.8f), 1, 0.6f, 1, glm::vec3(1), 1.5f);
  EXPECT_LT(meanRelativeError(world, traced(world, Term::indirect, 1, 1 << 16, 8).image, "R",
                              [&](const glm::dvec3& x) { return fromWallOverFloor(x, floor, wall); }),
            kPathBound);
}

/// Light that reaches the floor over the wall, all pixels together.
double overTheWall(const World& world) {
  const Image image = traced(world, Term::indirect, 1, 64).image;
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (positionOf(world, image, x, y).y < 1e-3) sum += static_cast<double>(image.at(x, y, 0));
  return sum;
}

TEST(ReferencePath, WhatReflectsToOtherSurfaces) {
  World world = wallOverFloor();
  scene::Material& wall = world.scene.materials[1];
  scene::Primitive& quad = world.scene.meshes[1].primitives[0];
  const double plain = overTheWall(world);
  EXPECT_GT(plain, 0);
  // A back, of single-sided surfaces, does not; of others it does.
  World turned = world;
  std::swap(turned.scene.meshes[1].primitives[0].indices[0], turned.scene.meshes[1].primitives[0].indices[1]);
  std::swap(turned.scene.meshes[1].primitives[0].indices[3], turned.scene.meshes[1].primitives[0].indices[4]);
  for (auto& n : turned.scene.meshes[1].primitives[0].normals) n = -n;
  EXPECT_EQ(overTheWall(turned), 0);
  turned.scene.materials[1].doubleSided = true;
  EXPECT_NEAR(overTheWall(turned), plain, 1e-4 * plain);
  // A texture does by its full-size level; where its texels are cut out there is nothing.
  auto& image = world.scene.images.emplace_back();
  image.levels = {{2, 2, std::vector<uint8_t>(16, 255)}, {1, 1, {0, 0, 0, 255}}};
  wall.baseColourTexture.image = 0;
  for (auto& uv : quad.uvs) uv *= 1000.f;
  EXPECT_NEAR(overTheWall(world), plain, 1e-4 * plain);
  wall.baseColour.a = 0.4f;
  EXPECT_NEAR(overTheWall(world), plain, 1e-4 * plain);
  wall.alphaCutoff = 0.5f;
  EXPECT_EQ(overTheWall(world), 0);
}

TEST(ReferencePath, SpecularSurfacesBlock) {
  World world = wallOverFloor();
  world.scene.materials[1].metallic = 1;
  world.scene.materials[1].roughness = 0.01f;
  EXPECT_EQ(overTheWall(world), 0);
  World seen = wallOverFloor();
  seen.scene.materials[0].transmission = 1;
  EXPECT_EQ(overTheWall(seen), 0);
}

/// Two walls and a floor of different colours under a lamp and a sky.
World room() {
  World world = wallOverFloor();
  world.addQuad({-1.2f, 0.8f, 0}, {0, 0, -2}, {0, 1.6f, 0}, world.addMaterial({0.7f, 0.2f, 0.1f}, true));
  world.scene.materials[1].specularFactor = 1;
  world.scene.materials[1].roughness = 0.4f;
  world.addRectangle({0.4f, 1.8f, 0}, {0.6f, 0, 0}, {0, 0, -0.6f}, 4);
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(0.2f, 0.3f, 0.5f));
  return world;
}

TEST(ReferencePath, EveryBounceAddsItsOwnLight) {
  const World world = room();
  const Image direct = traced(world, Term::direct, 0, 32).image;
  Image before = direct;
  for (int bounces = 1; bounces <= 4; ++bounces) {
    const Image indirect = traced(world, Term::indirect, bounces, 32).image;
    const Image final = traced(world, Term::final, bounces, 32).image;
    double share = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        for (int c = 0; c < 3; ++c) {
          if (direct.at(x, y, direct.channel("coverage")) == 0.f) continue;
          const float sum = direct.at(x, y, c) + indirect.at(x, y, c);
          EXPECT_NEAR(final.at(x, y, c), sum, 1e-5f * (1 + sum));
          if (bounces == 1) continue;
          const float more = indirect.at(x, y, c) - before.at(x, y, c);
          EXPECT_GE(more, -1e-6f);
          share += static_cast<double>(more);
        }
    if (bounces > 1) {
      EXPECT_GT(share, 0) << bounces;
    }
    before = indirect;
  }
}

TEST(ReferencePath, LightsAddUp) {
  const World world = room();
  double sum = 0;
  const auto total = [&](int light) {
    Request request = world.request(16, Term::indirect, 256);
    request.bounces = 2;
    request.light = light;
    const Image image = render(request).image;
    double value = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) value += static_cast<double>(image.at(x, y, 0));
    return value;
  };
  for (const int light : {0, 1, 2}) sum += total(light);
  EXPECT_NEAR(sum / total(kAllLights), 1, kPathBound);
}

TEST(ReferencePath, ScaleDoesNotMatter) {
  const World world = room();
  const Image image = traced(world, Term::indirect, 2, 64).image;
  for (const float factor : {1e-4f, 1e4f}) {
    World scaled = world;
    scaled.rescale(factor);
    EXPECT_LT(largestDifference(image, traced(scaled, Term::indirect, 2, 64).image, "R"), 0.05) << factor;
  }
}

TEST(ReferencePath, SameBitsWhateverTheThreadsAndInterruptions) {
  const Folder folder;
  const World world = room();
  Request request = world.request(24, Term::indirect, 100);
  request.bounces = 6;
  request.threads = 1;
  const Result whole = render(request);
  request.threads = 2;
  request.checkpoint = folder.path() / "work.partial";
  request.progress = [](const Progress& p) { return p.spp < 48; };
  EXPECT_THROW(render(request), Error);
  ASSERT_TRUE(std::filesystem::exists(request.checkpoint));
  int first = 0;
  request.progress = [&](const Progress& p) {
    if (first == 0) first = p.spp;
    return true;
  };
  EXPECT_TRUE(sameBits(whole.image, render(request).image));
  EXPECT_GT(first, 48);  // did not start over
}

TEST(ReferencePath, ContentHashSeesTheBounces) {
  const World world = room();
  const auto hash = [&](Term term, int bounces) {
    Request request = world.request(16, term, 16);
    request.bounces = bounces;
    return contentHash(request);
  };
  EXPECT_NE(hash(Term::indirect, 1), hash(Term::indirect, 2));
  EXPECT_NE(hash(Term::final, 0), hash(Term::final, 1));
  EXPECT_NE(hash(Term::final, 1), hash(Term::indirect, 1));
  EXPECT_EQ(hash(Term::indirect, 3), hash(Term::indirect, 3));
}

TEST(ReferencePath, CacheKeepsIndirectLight) {
  const Folder folder;
  const World world = room();
  Cache cache(folder.path());
  Request request = world.request(8, Term::indirect, 4);
  request.bounces = 2;
  const Image image = cache.render(request).image;
  const auto kept = cache.get(contentHash(request));
  ASSERT_TRUE(kept);
  EXPECT_TRUE(sameBits(image, kept->image));
  EXPECT_EQ(kept->image.metadata().at("bounces"), "2");
  EXPECT_EQ(kept->image.metadata().at("term"), "indirect");
}

TEST(ReferencePath, BouncesAreRefusedWhereThereAreNone) {
  const World world = room();
  const auto message = [&](Term term, int bounces) -> std::string {
    try {
      traced(world, term, bounces, 2, 4);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(Term::indirect, 0), "reference: bounces 0 is not in 1 .. 1024 with the term indirect");
  EXPECT_EQ(message(Term::final, 1025), "reference: bounces 1025 is not in 0 .. 1024 with the term final");
  EXPECT_EQ(message(Term::direct, 2),
            "reference: bounces 2 with the term direct; only final, indirect, subsurface and specular have "
            "bounces");
  EXPECT_EQ(message(Term::final, 0), "");
}

}  // namespace
}  // namespace limn::reference
