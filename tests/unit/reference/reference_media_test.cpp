// The reference's media against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/private/ray_scene.h"
#include "glsl/media/airlight.glsl"
#include "tests/support/density_grids.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::vec3;

TEST(ReferenceMedia, ASlabAttenuatesExponentiallyOnBothWays) {
  World world = floorWorld();
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, vec3(1));
  const Image clear = render(world.request(15, Term::direct, 2)).image;
  world.scene.medium.sigmaA = vec3(0.1f, 0.3f, 2);
  const Image dim = render(world.request(15, Term::direct, 2)).image;
  const double path = 1 + std::sqrt(8.0);  // from the light, and to the ball's border under the camera
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(double(dim.at(7, 7, c)) / double(clear.at(7, 7, c)),
                std::exp(-double(world.scene.medium.sigmaA[c]) * path), 1e-3)
        << c;
}

TEST(ReferenceMedia, TheSkyIsSeenThroughAllOfTheMedium) {
  World world = floorWorld();
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, vec3(2));
  world.scene.medium.sigmaA = vec3(0.01f, 0.1f, 0.5f);
  world.camera = scene::lookAt({0, 1, 6}, {0, 1, 0}, 0.1f);
  const Image sky = render(world.request(1, Term::final, 2)).image;
  for (int c = 0; c < 3; ++c) {  // along a chord of the ball of radius root of 8, 1 m from its middle
    const double left = std::exp(-double(world.scene.medium.sigmaA[c]) * 2 * std::sqrt(7.0));
    EXPECT_NEAR(double(sky.at(0, 0, c)), 2 * left, 2e-4) << c;
  }
}

/// Density y + 1/2, where that is not negative.
scene::DensityGrid ramp() {
  return limn::test::gridOf({2, 48, 2}, vec3(-3), vec3(3),
                            [](const vec3& p) { return std::max(p.y + 0.5f, 0.f); });
}

TEST(ReferenceMedia, ARampAttenuatesByItsIntegral) {
  World world = floorWorld();
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, vec3(1));
  const Image clear = render(world.request(15, Term::direct, 2)).image;
  world.scene.medium.sigmaA = vec3(0.05f, 0.3f, 1);
  scene::setGrid(world.scene.medium, ramp());
  const Image dim = render(world.request(15, Term::direct, 2)).image;
  const double border = std::sqrt(8.0), length = 1 + 0.5 * border * border + 0.5 * border;
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(double(dim.at(7, 7, c)) / double(clear.at(7, 7, c)),
                std::exp(-double(world.scene.medium.sigmaA[c]) * length), 1e-3)
        << c;
}

TEST(ReferenceMedia, AGridOfOneDensityIsHomogeneous) {
  World world = floorWorld();
  world.addInstance(world.addMesh(World::sphere(64, world.addClearGlass(1.5f))),
                    glm::translate(glm::mat4(1), vec3(0, 1, 0)) * glm::scale(glm::mat4(1), vec3(0.3f)));
  world.addLight(glsl::light_point, {0.3f, 2.2f, 0.1f}, {0, -1, 0}, vec3(3));
  world.scene.medium.g = 0.4f;
  for (const Term term : {Term::media, Term::caustic, Term::direct, Term::final}) {
    world.scene.medium.sigmaA = vec3(0.2f);
    world.scene.medium.sigmaS = vec3(0.4f);
    world.scene.medium.grid.reset();
    const Image homogeneous = render(world.request(16, term, 16)).image;
    world.scene.medium.sigmaA = vec3(0.1f);
    world.scene.medium.sigmaS = vec3(0.2f);
    scene::setGrid(world.scene.medium, limn::test::constantGrid(world.pose.bounds, 2));
    EXPECT_LT(largestDifference(homogeneous, render(world.request(16, term, 16)).image, "R"), 2e-3)
        << name(term);
  }
}

TEST(ReferenceMedia, AirlightInARampMeetsQuadrature) {
  World world = floorWorld();
  world.scene.medium.sigmaA = vec3(0.1f);
  world.scene.medium.sigmaS = vec3(0.3f);
  scene::setGrid(world.scene.medium, ramp());
  const vec3 light(world.addLight(glsl::light_point, {0.3f, 1.2f, 0.1f}, {0, -1, 0}, vec3(3)).position);
  world.camera = scene::lookAt({0, 1, 2.5f}, {0, 1, 0}, 0.6f);
  constexpr int size = 4;
  const Image image = render(world.request(size, Term::media, 2048)).image;
  glsl::FrameBlock frame{};
  scene::setCamera(frame, world.camera, world.pose.bounds, size, size);
  const vec3 eye(frame.camera_position);
  // Of the density along a line whose height goes from a to b (both above the ramp's foot).
  const auto inside = [](double a, double b, double length) { return (0.5 * (a + b) + 0.5) * length; };
  for (int y = 0; y < size / 2; ++y)  // above the horizon: nothing ends the view
    for (int x = 0; x < size; ++x) {
      const vec3 w = glm::normalize(viewRay(frame, float(x), float(size - 1 - y)));
      const double end = double(glsl::ball_range({vec3(0), std::sqrt(8.f)}, eye, w).y);
      double expected = 0;
      constexpr int steps = 20000;
      for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * end / steps;
        const vec3 p = eye + float(t) * w, d = p - light;
        const double r = double(glm::length(d)), height = double(p.y);
        const double path = inside(double(eye.y), height, t) + inside(double(light.y), height, r);
        expected += end / steps * 0.3 * (height + 0.5) * 3 / (4 * M_PI) * std::exp(-0.4 * path) / (r * r);
      }
      EXPECT_NEAR(double(image.at(x, y, 0)) / expected, 1, 0.02) << x << " " << y;
    }
}

TEST(ReferenceMedia, ASpotShinesThroughItsTexture) {
  World world = floorWorld();
  glsl::Light& light = world.addLight(glsl::light_spot, {0, 1, 0}, {0, -1, 0}, vec3(1));
  light.flags = glsl::light_flag_cone;
  light.cos_inner = 0.8f;
  light.cos_outer = 0.6f;
  light.range = 0;
  light.angular_diameter = 0;
  light.axis_u = glm::vec3(1, 0, 0);
  light.length_u = 0;
  light.axis_v = glm::vec3(0, 0, -1);
  light.length_v = 0;
  world.camera = scene::lookAt({0, 2, 0}, {0, 0, 0}, 0.6f);  // up the picture is -z, as up the texture
  const Image clear = render(world.request(16, Term::direct, 2)).image;
  scene::LightTexture texture;
  constexpr int side = scene::LightTexture::side;
  for (int i = 0; i < side * side; ++i)
    texture.texels.emplace_back((float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side, 1);
  world.scene.lightTextures = {texture};
  light.texture_number = 1;
  const Image tinted = render(world.request(16, Term::direct, 2)).image;
  const double tangent = 0.8 / 0.6;
  for (int y = 0; y < 16; y += 3)
    for (int x = 0; x < 16; x += 3) {
      const glm::dvec3 p = positionOf(world, clear, x, y);
      const auto factor = [&](int c) { return double(tinted.at(x, y, c)) / double(clear.at(x, y, c)); };
      EXPECT_NEAR(factor(0), 0.5 + 0.5 * p.x / tangent, 3e-3);
      EXPECT_NEAR(factor(1), 0.5 - 0.5 * p.z / tangent, 3e-3);
      EXPECT_NEAR(factor(2), 1, 1e-5);
    }
}

TEST(ReferenceMedia, AMediumOfThousandsOfMeanFreePathsIsBlack) {
  World world = floorWorld();
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, vec3(1));
  world.scene.medium.sigmaS = vec3(1000);
  for (const Term term : {Term::direct, Term::final, Term::media}) {
    const Result black = render(world.request(8, term, 2));
    for (const float v : black.image.data()) EXPECT_TRUE(std::isfinite(v));
  }
  EXPECT_LT(render(world.request(8, Term::direct, 2)).image.at(4, 4, 0), 1e-30f);
}

TEST(ReferenceMedia, AirlightOfAPointSourceMeetsQuadrature) {
  World world = floorWorld();
  world.scene.medium.sigmaA = vec3(0.1f);
  world.scene.medium.sigmaS = vec3(0.2f);
  const glsl::Light light = world.addLight(glsl::light_point, {0.3f, 1.2f, 0.1f}, {0, -1, 0}, vec3(3));
  world.camera = scene::lookAt({0, 1, 2.5f}, {0, 1, 0}, 0.6f);
  for (const float g : {-0.7f, 0.f, 0.7f}) {
    world.scene.medium.g = g;
    constexpr int size = 6;
    const Image image = render(world.request(size, Term::media, 1024)).image;
    glsl::FrameBlock frame{};
    scene::setCamera(frame, world.camera, world.pose.bounds, size, size);
    const glsl::Medium medium{vec3(0.3f), vec3(0.2f), g, {vec3(0), std::sqrt(8.f)}};
    for (int y = 0; y < 3; ++y)  // above the horizon: nothing ends the view
      for (int x = 0; x < size; ++x) {
        const vec3 eye(frame.camera_position);
        const vec3 w = glm::normalize(vec3(frame.view_ray_origin) + float(x) * vec3(frame.view_ray_dx) +
                                      float(size - 1 - y) * vec3(frame.view_ray_dy));
        double expected = 0;
        constexpr int steps = 40000;
        const glm::vec2 range = glsl::ball_range(medium.ball, eye, w);
        const double from = std::max(0.f, range.x), step = (double(range.y) - from) / steps;
        for (int i = 0; i < steps; ++i) {
          const float t = float(from + (i + 0.5) * step);
          const vec3 p = eye + t * w, d = p - light.position;
          const double r2 = double(glm::dot(d, d));
          const double inside =
              double(t) - from + double(glsl::ball_length_between(medium.ball, light.position, p));
          expected += step * 0.2 * 3 * double(glsl::phase_function(g, glm::normalize(d), -w)) *
                      std::exp(-0.3 * inside) / r2;
        }
        EXPECT_NEAR(double(image.at(x, y, 0)) / expected, 1, 0.02) << x << " " << y << " g " << g;
      }
  }
}

/// Of a lamp in the plane z = 0 that shines to -z, or to both sides, along lines at a distance from it.
TEST(ReferenceMedia, AirlightOfARectangleMeetsQuadratureOnItsSides) {
  World world = floorWorld();
  world.scene.medium.sigmaA = vec3(0.1f);
  world.scene.medium.sigmaS = vec3(0.2f);
  world.scene.medium.g = 0.5f;
  glsl::Light& light = world.addRectangle({0, 1, 0}, {0.8f, 0, 0}, {0, 0.6f, 0}, 3);
  const auto seenAt = [&](float z) {
    world.camera = scene::lookAt({-2, 1, z}, {0, 1, z}, 0.01f);
    return double(render(world.request(1, Term::media, 4096)).image.at(0, 0, 0));
  };
  constexpr int steps = 400, cells = 10;
  const double g = 0.5, z = -0.5, end = 2 + std::sqrt(8 - 1 - z * z);  // from the eye to the fog's border
  double expected = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < cells * cells; ++j) {
      const double t = (i + 0.5) * end / steps;
      const glm::dvec3 source(0.8 * ((j % cells + 0.5) / cells - 0.5),
                              1 + 0.6 * ((j / cells + 0.5) / cells - 0.5), 0);
      const glm::dvec3 d = glm::dvec3(t - 2, 1, z) - source;
      const double r = glm::length(d), cosine = -d.x / r;
      const double phase = (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosine, 1.5));
      expected += 0.2 * 3 * std::abs(d.z) / r * phase * std::exp(-0.3 * (t + r)) / (r * r);
    }
  expected *= end / steps * 0.8 * 0.6 / (cells * cells);
  EXPECT_NEAR(seenAt(-0.5f) / expected, 1, 0.02);
  EXPECT_EQ(seenAt(0.5f), 0);
  light.flags = glsl::light_flag_two_sided;
  EXPECT_NEAR(seenAt(-0.5f) / expected, 1, 0.02);
  EXPECT_NEAR(seenAt(0.5f) / expected, 1, 0.02);
}

/// Fog under a sun of radius 0.1 radians and half a plane 1 m above the viewing ray, whose edge lies
/// 0.05 m aside of it: half of the disc's radius from its middle.
TEST(ReferenceMedia, AirlightOfADiscHasThePenumbraOfAHalfPlane) {
  World world;
  world.addQuad({-3, 1, 0}, {6, 0, 0}, {0, 0, -12}, world.addMaterial(vec3(0), true));
  world.pose.bounds = {vec3(-1.5f), vec3(1.5f)};
  world.scene.medium.sigmaS = vec3(0.1f);
  world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, vec3(1)).angular_diameter = 0.2f;
  const auto seenBeside = [&](float x) {
    world.camera = scene::lookAt({x, 0, 2}, {x, 0, 0}, 0.01f);
    const Image image = render(world.request(4, Term::media, 4096)).image;
    double sum = 0;
    for (int i = 0; i < 16; ++i) sum += double(image.at(i % 4, i / 4, 0));
    return sum;
  };
  const double cosine = 0.5, hidden = (std::acos(cosine) - cosine * std::sqrt(1 - cosine * cosine)) / M_PI;
  const double partly = seenBeside(0.05f);
  world.pose.instances[0].objectToWorld = glm::translate(glm::mat4(1), vec3(-3, 0, 0));
  EXPECT_NEAR(partly / seenBeside(0.05f), 1 - hidden, 0.01);
}

/// The radiance of a disc is even, so more light passes than arrives on a surface that faces it; in so thin a
/// fog the way that it takes does not matter.
TEST(ReferenceMedia, AirlightOfADiscIsItsFluence) {
  World world = floorWorld();
  world.scene.medium.sigmaS = vec3(1e-4f);
  world.camera = scene::lookAt({0, 1, 1}, {0, 1, 0}, 0.2f);
  glsl::Light& sun = world.addLight(glsl::light_directional, {0, 0, 0}, {0, -1, 0}, vec3(1));
  const auto brightness = [&](float angle) {
    sun.angular_diameter = angle;
    return double(render(world.request(1, Term::media, 1024)).image.at(0, 0, 0));
  };
  EXPECT_NEAR(brightness(2) / brightness(0), 2 / (1 + std::cos(1.0)), 3e-3);
}

/// A sphere of radius 1 and index 1.5 in a thin beam along +x from far away, seen from the side.
TEST(ReferenceMedia, ASphereFocusesWhereALensMakersFormulaSays) {
  World world;
  world.addInstance(world.addMesh(World::sphere(512, world.addClearGlass(1.5f))));
  glsl::Light& light = world.addLight(glsl::light_spot, {-50, 0, 0}, {1, 0, 0}, vec3(1e4f));
  light.flags = glsl::light_flag_cone;
  light.cos_inner = std::cos(0.2f / 50);
  light.cos_outer = std::cos(0.22f / 50);
  light.range = 0;
  light.angular_diameter = 0;
  world.scene.medium.sigmaS = vec3(0.01f);
  world.camera = scene::lookAt({1.4f, 0, 8}, {1.4f, 0, 0}, 0.08f);
  constexpr int size = 41;
  const Image image = render(world.request(size, Term::media, 4096)).image;
  int brightest = 0;
  for (int x = 1; x < size; ++x)
    if (image.at(x, size / 2, 0) > image.at(brightest, size / 2, 0)) brightest = x;
  const double metres = 2 * std::tan(0.04) * 8 / size;
  const double found = 1.4 + (brightest - size / 2) * metres;
  const double focal = 1.5 / (2 * 0.5), expected = 1 / (1 / focal - 1 / 50.0);
  EXPECT_NEAR(found, expected, 0.06);
}

TEST(ReferenceMedia, ThreadsAndInterruptionsDoNotChangeThePicture) {
  World world = floorWorld();
  world.addInstance(world.addMesh(World::sphere(32, world.addClearGlass(1.5f))),
                    glm::translate(glm::mat4(1), vec3(0, 1, 0)) * glm::scale(glm::mat4(1), vec3(0.3f)));
  world.addLight(glsl::light_point, {0, 2, 0}, {0, -1, 0}, vec3(1));
  world.scene.medium.sigmaS = vec3(0.2f);
  Request one = world.request(24, Term::final, 16), two = world.request(24, Term::final, 16);
  one.threads = 1;
  two.threads = 3;
  EXPECT_TRUE(sameBits(render(one).image, render(two).image));
  World scaled = world;
  scaled.rescale(1000);
  scaled.scene.medium.sigmaS /= 1000.f;
  EXPECT_LT(largestDifference(render(one).image, render(scaled.request(24, Term::final, 16)).image, "R"),
            0.5);
}

}  // namespace
}  // namespace limn::reference
