// The reference against closed forms. Bound everywhere: 0.5 % mean relative error.
#include "core/reference/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/reference/vertices.h"
#include "glsl/surface/brdf.glsl"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

constexpr double kBound = 0.005;
constexpr double kSkip = std::numeric_limits<double>::quiet_NaN();
const glm::dvec3 up(0, 1, 0);

std::vector<glm::dvec3> corners(const glsl::Light& light) {
  const glm::dvec3 c(light.position);
  const glm::dvec3 u = 0.5 * static_cast<double>(light.length_u) * glm::dvec3(light.axis_u);
  const glm::dvec3 v = 0.5 * static_cast<double>(light.length_v) * glm::dvec3(light.axis_v);
  return {c - u - v, c + u - v, c + u + v, c - u + v};
}

/// Light on a white floor under a rectangle, against Lambert's formula.
void expectLambert(const World& world, int spp = 256) {
  const glsl::Light& light = world.pose.lights[0];
  const Result result = render(world.request(24, Term::direct, spp));
  const double error = meanRelativeError(world, result.image, "R", [&](const glm::dvec3& x) {
    const bool front = glm::dot(glm::dvec3(light.direction), x - glm::dvec3(light.position)) > 0;
    return front
               ? 0.5 / M_PI * static_cast<double>(light.emission.x) * lambertIrradiance(x, up, corners(light))
               : 0.0;
  });
  EXPECT_LT(error, kBound);
}

TEST(ReferenceDirect, RectangleFacingTheFloor) {
  World world = floorWorld();
  world.addRectangle({0.2f, 1.5f, -0.1f}, {1, 0, 0}, {0, 0, -0.6f}, 7);
  expectLambert(world);
}

TEST(ReferenceDirect, TiltedRectangle) {
  World world = floorWorld();
  const glm::vec3 v = glm::normalize(glm::vec3(0.3f, 1, -0.5f));
  world.addRectangle({0.8f, 1, 0.4f}, 0.9f * glm::normalize(glm::cross(v, glm::vec3(1, 0, 0.4f))), 1.2f * v,
                     3);
  expectLambert(world);
}

TEST(ReferenceDirect, RectangleThroughTheHorizon) {
  World world = floorWorld();
  world.addRectangle({-1, 0.2f, 0}, {0, 0, 1.5f}, {0, 1.2f, 0}, 5);  // half of it below the floor
  expectLambert(world, 512);
}

TEST(ReferenceDirect, LargeRectangleNearTheFloor) {
  World world = floorWorld();
  world.addRectangle({0, 0.25f, 0}, {3, 0, 0}, {0, 0, -3}, 1);
  world.camera = scene::lookAt({0, 0.2f, 3.5f}, {0, 0, 0}, 0.8f);
  expectLambert(world, 2048);
}

TEST(ReferenceDirect, RectangleShinesForwardOnlyUnlessTwoSided) {
  World world = floorWorld();
  world.addRectangle({0, 1, 0}, {0, 0, -1}, {1, 0, 0}, 2);  // faces up
  EXPECT_EQ(render(world.request(8, Term::direct, 4)).image.at(4, 4, 0), 0.f);
  world.pose.lights[0].flags = glsl::light_flag_two_sided;
  const Result result = render(world.request(24, Term::direct, 256));
  EXPECT_LT(meanRelativeError(world, result.image, "R",
                              [&](const glm::dvec3& x) {
                                return 0.5 / M_PI * 2 *
                                       lambertIrradiance(x, up, corners(world.pose.lights[0]));
                              }),
            kBound);
}

TEST(ReferenceDirect, HalfBlockedRectangle) {
  World world = floorWorld();
  world.addRectangle({0, 1.5f, 0}, {1, 0, 0}, {0, 0, -1}, 4);
  // Just below the light, over its left half and beyond: what is left is the right half.
  world.addQuad({-5, 1.4999f, 0}, {10, 0, 0}, {0, 0, -10}, world.addMaterial(glm::vec3(0)));
  world.camera = scene::lookAt({0.01f, 1.2f, 0}, {0, 0, 0}, 1.8f);
  const std::vector<glm::dvec3> half{{0, 1.5, -0.5}, {0.5, 1.5, -0.5}, {0.5, 1.5, 0.5}, {0, 1.5, 0.5}};
  const Result direct = render(world.request(24, Term::direct, 512));
  EXPECT_LT(
      meanRelativeError(world, direct.image, "R",
                        [&](const glm::dvec3& x) { return 0.5 / M_PI * 4 * lambertIrradiance(x, up, half); }),
      kBound);
  Request request = world.request(24, Term::visibility, 512);
  request.light = 0;
  const Result visibility = render(request);
  EXPECT_LT(meanRelativeError(world, visibility.image, "V", [](const glm::dvec3&) { return 0.5; }), kBound);
}

/// Points at vertices belong to no draw instance: the quad that is a light lights them as the first and as
/// the last one, by four corners (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3).
TEST(ReferenceVertices, AnEmissiveQuadLightsThemWhicheverInstanceItIs) {
  constexpr double radiance = 8.33, height = 0.8, a = 0.3 / height, b = 0.2 / height;
  const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
  const double expected = radiance * 4 * 0.5 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
  for (const uint32_t own : {0u, 1u}) {
    World world;
    const int material = world.addMaterial(glm::vec3(0));
    const auto addFloor = [&] { world.addQuad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, material); };
    if (own == 1) addFloor();
    world.addQuad({0, float(height), 0}, {0.6f, 0, 0}, {0, 0, 0.4f}, material);
    if (own == 0) addFloor();
    world.addRectangle({0, float(height), 0}, {0.6f, 0, 0}, {0, 0, -0.4f}, float(radiance)).own_instance =
        own;
    const SurfacePoint below{.position = {0, 0, 0}, .normal = {0, 1, 0}};
    const auto irradiance = irradianceAt(world.request(1, Term::direct, 4096), {&below, 1}, 1e-4f);
    EXPECT_NEAR(double(irradiance.at(0).x) / expected, 1, 0.005) << own;
  }
}

TEST(ReferenceVisibility, PenumbraOfAnEdge) {
  World world = floorWorld();
  world.addRectangle({0, 2, 0}, {0.5f, 0, 0}, {0, 0, -0.5f}, 4);
  world.addQuad({-5, 1, 0}, {10, 0, 0}, {0, 0, -10},
                world.addMaterial(glm::vec3(0)));  // edge x = 0 at half height
  world.camera = scene::lookAt({0.3f, 0.8f, 0}, {0, 0, 0}, 1.6f);
  Request request = world.request(32, Term::visibility, 512);
  request.light = 0;
  const Result result = render(request);
  // From x the edge covers the light up to -x.
  EXPECT_LT(meanRelativeError(world, result.image, "V",
                              [](const glm::dvec3& p) { return std::clamp((0.25 + p.x) / 0.5, 0.0, 1.0); }),
            kBound);
  // Where all of the light is seen, exactly 1; where none, exactly 0; both weightings agree there.
  for (int x = 0; x < 32; ++x) {
    const glm::dvec3 p = positionOf(world, result.image, x, 16);
    if (std::abs(p.x) < 0.26) continue;
    EXPECT_EQ(result.image.at(x, 16, result.image.channel("V")), p.x > 0 ? 1.f : 0.f);
    EXPECT_EQ(result.image.at(x, 16, result.image.channel("Vw")), p.x > 0 ? 1.f : 0.f);
  }
}

TEST(ReferenceVisibility, OnlyThePartAboveTheHorizonCounts) {
  World world = floorWorld();
  world.addRectangle({-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 5);  // faces +x, half below the floor
  Request request = world.request(24, Term::visibility, 64);
  request.light = 0;
  const Image image = render(request).image;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      if (image.at(x, y, image.channel("coverage")) == 0.f) continue;
      EXPECT_EQ(image.at(x, y, image.channel("V")), 1.f);
      const double px = positionOf(world, image, x, y).x;
      if (std::abs(px + 1) < 1e-3) continue;
      EXPECT_EQ(image.at(x, y, image.channel("masked")), px < -1 ? 1.f : 0.f);
    }
}

TEST(ReferenceDirect, PointLightInverseSquareAndCosine) {
  World world = floorWorld();
  world.addLight(glsl::light_point, {0.3f, 0.7f, -0.2f}, {0, -1, 0}, glm::vec3(2));
  const Result result = render(world.request(24, Term::direct, 2));
  EXPECT_LT(meanRelativeError(world, result.image, "G",
                              [](const glm::dvec3& x) {
                                const glm::dvec3 d = glm::dvec3(0.3f, 0.7f, -0.2f) - x;
                                const double r = glm::length(d);
                                return 0.5 / M_PI * 2 * d.y / (r * r * r);
                              }),
            1e-4);
  EXPECT_EQ(result.noiseRms, 0);
}

TEST(ReferenceDirect, SpotConeIsAFactorAtTheReceiver) {
  World world = floorWorld();
  glsl::Light& light = world.addLight(glsl::light_spot, {0, 1, 0}, {0, -1, 0}, glm::vec3(3));
  light.flags = glsl::light_flag_cone;
  light.cos_inner = std::cos(0.3f);
  light.cos_outer = std::cos(0.8f);
  light.range = 0;
  light.angular_diameter = 0;
  const Result result = render(world.request(24, Term::direct, 2));
  EXPECT_LT(meanRelativeError(world, result.image, "B",
                              [](const glm::dvec3& x) {
                                const double r = glm::length(glm::dvec3(0, 1, 0) - x), cosine = 1 / r;
                                const double t = std::clamp(
                                    (cosine - std::cos(0.8)) / (std::cos(0.3) - std::cos(0.8)), 0.0, 1.0);
                                return 0.5 / M_PI * 3 * t * t * cosine / (r * r);
                              }),
            1e-4);
}

TEST(ReferenceDirect, DirectionalLightWithAndWithoutAngle) {
  for (const float angle : {0.f, 0.2f}) {
    World world = floorWorld();
    glsl::Light& light = world.addLight(glsl::light_directional, {0, 0, 0}, {1, -1, 0}, glm::vec3(2));
    light.angular_diameter = angle;
    const Result result = render(world.request(16, Term::direct, 64));
    EXPECT_LT(meanRelativeError(world, result.image, "R",
                                [](const glm::dvec3&) { return 0.5 / M_PI * 2 * std::sqrt(0.5); }),
              kBound);
  }
}

TEST(ReferenceVisibility, DirectionalPenumbraIsADiscSegment) {
  World world = floorWorld();
  glsl::Light& light = world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, glm::vec3(2));
  light.angular_diameter = 0.2f;
  world.addQuad({-5, 1, 0}, {10, 0, 0}, {0, 0, -10}, world.addMaterial(glm::vec3(0)));
  world.camera = scene::lookAt({0.1f, 0.5f, 0}, {0, 0, 0}, 0.8f);
  Request request = world.request(24, Term::visibility, 512);
  request.light = 0;
  const Result result = render(request);
  const double radius = std::tan(0.1);
  EXPECT_LT(meanRelativeError(world, result.image, "V",
                              [&](const glm::dvec3& p) {
                                const double d = std::clamp(p.x / radius, -1.0, 1.0);
                                return 0.5 + (std::asin(d) + d * std::sqrt(1 - d * d)) / M_PI;
                              }),
            kBound);
}

TEST(ReferenceDirect, WhiteFurnace) {
  World world;
  world.addInstance(world.addMesh(World::sphere(128, world.addMaterial({0.7f, 0.3f, 1.f}))));
  world.camera = scene::lookAt({0, 0, 4}, {0, 0, 0}, 0.5f);
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(2));
  const Result result = render(world.request(24, Term::direct, 256));
  EXPECT_LT(meanRelativeError(world, result.image, "R", [](const glm::dvec3&) { return 1.4; }), kBound);
  EXPECT_LT(meanRelativeError(world, result.image, "G", [](const glm::dvec3&) { return 0.6; }), kBound);
  const Image final = render(world.request(24, Term::final, 4)).image;
  EXPECT_NEAR(final.at(0, 0, 0), 2.f, 1e-5f);  // background
}

// A floor beside a high wall, which keeps half of a white environment from it; and a roof over both.
TEST(ReferenceDirect, UnshadowedLightIsThatOfAnEmptyScene) {
  World world = floorWorld(0.7f);
  world.addQuad({0, 50, -2}, {100, 0, 0}, {0, 100, 0}, world.addMaterial(glm::vec3(0), true));
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, glm::vec3(2));
  Request request = world.request(12, Term::direct, 256);
  const auto furnace = [](const glm::dvec3&) { return 1.4; };
  EXPECT_GT(meanRelativeError(world, render(request).image, "R", furnace), 0.2) << "the wall occludes";
  request.unshadowed = true;
  EXPECT_LT(meanRelativeError(world, render(request).image, "R", furnace), kBound);

  world.addQuad({0, 5, 0}, {100, 0, 0}, {0, 0, -100}, world.addMaterial(glm::vec3(0), true));
  world.scene.environment.scale = 0;
  world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, glm::vec3(3));
  const auto lamp = [](const glm::dvec3&) { return 0.7 * 3 / M_PI; };
  EXPECT_LT(meanRelativeError(world, render(request).image, "R", lamp), 1e-5);
  request.unshadowed = false;
  EXPECT_GT(meanRelativeError(world, render(request).image, "R", lamp), 0.999);
}

TEST(ReferenceDirect, EnvironmentWithASunIsImportanceSampled) {
  World world = floorWorld();
  auto& environment = world.scene.environment;
  environment.width = 64;
  environment.height = 32;
  environment.texels.assign(64 * 32, glm::vec3(0.1f));
  environment.texels[6 * 64 + 20] = glm::vec3(5000);
  environment.rotation = 0.7f;
  // Irradiance by quadrature of the same bilinear lookup.
  double irradiance = 0;
  const int n = 2048;
  for (int j = 0; j < n / 2; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const double s = (i + 0.5) / (2 * n) * 64 - 0.5, t = (j + 0.5) / n * 32 - 0.5;
      const double ws = std::max(0.0, 1 - std::abs(s - 20)), wt = std::max(0.0, 1 - std::abs(t - 6));
      const double theta = M_PI * (j + 0.5) / n;
      irradiance +=
          (0.1 + (5000 - 0.1) * ws * wt) * std::sin(theta) * std::cos(theta) * (M_PI / n) * (M_PI / n);
    }
  const Result result = render(world.request(12, Term::direct, 512));
  EXPECT_LT(
      meanRelativeError(world, result.image, "R", [&](const glm::dvec3&) { return 0.5 / M_PI * irradiance; }),
      kBound);
}

TEST(ReferenceDirect, EnvironmentTurnsWithItsRotation) {
  // Light from +x only (map centre looks along -z, its right half along +x), turned by 90 degrees about +y:
  // from -z.
  World world;
  world.addInstance(world.addMesh(World::sphere(64, world.addMaterial(glm::vec3(1)))));
  world.camera = scene::lookAt({0, 6, 0.001f}, {0, 0, 0}, 0.5f);
  auto& environment = world.scene.environment;
  environment.width = 64;
  environment.height = 32;
  environment.texels.assign(64 * 32, glm::vec3(0));
  for (int y = 14; y < 18; ++y)
    for (int x = 46; x < 50; ++x) environment.texels[static_cast<size_t>(y * 64 + x)] = glm::vec3(100);
  const Image plain = render(world.request(17, Term::direct, 64)).image;
  EXPECT_GT(plain.at(12, 8, 0), 10 * plain.at(4, 8, 0) + 0.01f);
  environment.rotation = 0.5f * glsl::pi;
  const Image turned = render(world.request(17, Term::direct, 64)).image;
  EXPECT_GT(turned.at(8, 4, 0), 10 * turned.at(8, 12, 0) + 0.01f);
}

TEST(ReferenceDirect, GlossyMisAgreesWithPlainQuadrature) {
  World world = floorWorld();
  world.scene.materials[0].metallic = 1;
  world.scene.materials[0].roughness = 0.4f;
  world.scene.materials[0].specularFactor = 1;
  const glsl::Light light = world.addRectangle({0, 1, -0.8f}, {1, 0, 0}, {0, 0.7f, 0.7f}, 2);
  world.camera = scene::lookAt({0, 1, 3}, {0, 0, 0}, 0.7f);
  const Result result = render(world.request(12, Term::direct, 512));
  const glm::dvec3 eye(0, 1, 3);
  EXPECT_LT(
      meanRelativeError(
          world, result.image, "R",
          [&](const glm::dvec3& x) {
            const glsl::SurfaceBrdf brdf =
                glsl::surface_brdf(glm::vec3(0.5f), 1, 0.4f, 1, glm::vec3(1), 1.5f);
            const auto p = corners(light);
            const int n = 48;
            double sum = 0;
            for (int i = 0; i < n * n; ++i) {
              const glm::dvec3 y =
                  p[0] + (i % n + 0.5) / n * (p[1] - p[0]) + (i / n + 0.5) / n * (p[3] - p[0]);
              const glm::dvec3 d = y - x, w = glm::normalize(d);
              const double cosine = glm::dot(glm::dvec3(light.direction), -w);
              // The light's own area cancels the sum's weight.
              sum +=
                  static_cast<double>(
                      glsl::brdf(brdf, glm::vec3(up), glm::vec3(glm::normalize(eye - x)), glm::vec3(w)).r) *
                  std::max(w.y, 0.0) * std::abs(cosine) / glm::dot(d, d);
            }
            const double area = glm::length(p[1] - p[0]) * glm::length(p[3] - p[0]);
            return glm::dot(glm::dvec3(light.direction), x - p[0]) > 0 ? 2 * sum * area / (n * n) : kSkip;
          }),
      kBound);
}

TEST(ReferenceFinal, EmissiveQuadIsSeenFromTheFrontAndBlocks) {
  World world;
  const int emitter = world.addMaterial(glm::vec3(0));
  world.scene.materials[static_cast<size_t>(emitter)].emission = {3, 2, 1};
  world.addQuad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, emitter);
  glsl::Light& light = world.addRectangle({0, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 3);
  light.flags = glsl::light_flag_geometry;
  light.own_instance = 0;
  world.addQuad({0, 0, 2}, {4, 0, 0}, {0, -4, 0}, world.addMaterial(glm::vec3(0.5f)));  // lit wall facing it
  world.camera = scene::lookAt({0, 0, 3}, {0, 0, 0}, 0.6f);
  const Image front = render(world.request(16, Term::final, 8)).image;  // through the wall's culled back
  EXPECT_EQ(front.at(8, 8, 0), 3.f);
  EXPECT_EQ(front.at(8, 8, 1), 2.f);
  EXPECT_EQ(front.at(8, 8, 2), 1.f);
  world.camera = scene::lookAt({0, 0, -3}, {0, 0, 0}, 0.6f);
  const Result behind =
      render(world.request(16, Term::direct, 256));  // through the emitter's back: the lit wall
  EXPECT_LT(meanRelativeError(
                world, behind.image, "R",
                [&](const glm::dvec3& x) {
                  return 0.5 / M_PI * 3 * lambertIrradiance(x, {0, 0, -1}, corners(world.pose.lights[0]));
                }),
            kBound);
}

/// Turns all triangles over.
void flip(scene::Primitive& primitive) {
  for (size_t i = 0; i < primitive.indices.size(); i += 3)
    std::swap(primitive.indices[i], primitive.indices[i + 1]);
}

TEST(ReferenceDirect, EverySurfaceBlocksFromBothSidesAndMaskedTexelsDoNot) {
  World world = floorWorld();
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, glm::vec3(1));
  const int cutout = world.addMaterial(glm::vec3(1));
  auto& material = world.scene.materials[static_cast<size_t>(cutout)];
  material.alphaCutoff = 0.5f;
  material.baseColourTexture.image = 0;
  auto& image = world.scene.images.emplace_back();
  auto& level = image.levels.emplace_back();
  level.width = 2;
  level.height = 1;
  level.rgba = {255, 255, 255, 255, 255, 255, 255, 0};  // left half opaque
  material.baseColourTexture.wrapS = scene::Wrap::clamp;
  world.addQuad({0, 0.5f, 0}, {1, 0, 0}, {0, 0, -1}, cutout);
  for (const bool flipped : {false, true}) {
    if (flipped) flip(world.scene.meshes[1].primitives[0]);
    world.camera = scene::lookAt({0, 0.4f, 0}, {0, 0, 0}, 1.7f);
    const Image floor = render(world.request(16, Term::direct, 2)).image;
    for (int y = 2; y < 14; ++y)
      for (int x = 0; x < 16; ++x) {
        const glm::dvec3 p = positionOf(world, floor, x, y);
        if (std::abs(p.x) > 0.95 || std::abs(p.z) > 0.95 || std::abs(p.x) < 0.02) continue;
        EXPECT_EQ(floor.at(x, y, 0) > 0.f, p.x > 0) << p.x << " " << p.z << " flipped " << flipped;
      }
  }
  // The camera sees through the transparent half, and through nothing else from the front.
  World above = world;
  flip(above.scene.meshes[1].primitives[0]);
  above.camera = scene::lookAt({0, 2, 0.001f}, {0, 0, 0}, 0.4f);
  const Image ids = render(above.request(16, Term::direct, 2)).image;
  EXPECT_EQ(ids.at(4, 8, ids.channel("id")), 1.f);
  EXPECT_EQ(ids.at(12, 8, ids.channel("id")), 0.f);
}

TEST(ReferenceFinal, SpecularSurfacesShowTheEnvironmentAndTakeNoLight) {
  World world;
  const int metal = world.addMaterial(glm::vec3(1));
  auto& material = world.scene.materials[static_cast<size_t>(metal)];
  material.metallic = 1;
  material.roughness = 0;
  world.addInstance(world.addMesh(World::sphere(64, metal)));
  world.addLight(glsl::light_point, {0, 0, 3}, {0, 0, -1}, glm::vec3(10));
  world.camera = scene::lookAt({0, 0, 4}, {0, 0, 0}, 0.3f);
  auto& environment = world.scene.environment;
  environment.width = 4;
  environment.height = 2;
  environment.texels.assign(8, glm::vec3(2));
  EXPECT_EQ(render(world.request(8, Term::direct, 2)).image.at(4, 4, 0), 0.f);
  EXPECT_NEAR(render(world.request(8, Term::final, 2)).image.at(4, 4, 0), 2.f, 1e-4f);  // a white mirror
  material.metallic = 0;
  material.transmission = 1;
  material.specularFactor = 1;
  // Clear glass: what Fresnel reflects, it does not transmit.
  EXPECT_NEAR(render(world.request(8, Term::final, 2)).image.at(4, 4, 1), 2.f, 1e-4f);
  material.baseColour = {0.5f, 0.5f, 0.5f, 1};
  EXPECT_NEAR(render(world.request(9, Term::final, 2)).image.at(4, 4, 1), 2 * (0.04f + 0.96f * 0.5f), 1e-3f);
}

}  // namespace
}  // namespace limn::reference
