// Geometry in the reference: scale, places far from the origin, instances, deformation, features, pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/reference/reference.h"
#include "tests/support/reference_scene.h"

namespace limn::reference {
namespace {

using namespace test;

TEST(ReferenceGeometry, ScaleDoesNotMatter) {
  const World world = busyWorld();
  const Image image = render(world.request(24, Term::direct, 64)).image;
  for (const float factor : {1e-4f, 1e4f}) {
    World scaled = world;
    scaled.rescale(factor);
    const Image other = render(scaled.request(24, Term::direct, 64)).image;
    double squares = 0, sum = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        squares +=
            std::pow(static_cast<double>(image.at(x, y, 0)) - static_cast<double>(other.at(x, y, 0)), 2);
        sum += static_cast<double>(image.at(x, y, 0));
      }
    EXPECT_LT(std::sqrt(squares * 24 * 24) / sum, 1e-3) << factor;
  }
}

TEST(ReferenceGeometry, FarFromTheOriginPlanesDoNotShadowThemselves) {
  World world = floorWorld();
  world.addRectangle({0.5f, 1.5f, 0}, {1, 0, 0}, {0, 0, -1}, 4);
  const glm::vec3 away(1000, -2000, 500);
  world.pose.instances[0].objectToWorld = glm::translate(glm::mat4(1), away);
  world.pose.lights[0].position += away;
  world.pose.bounds.low += away;
  world.pose.bounds.high += away;
  world.camera = scene::lookAt(away + glm::vec3(0, 1, 2.5f), away, 0.8f);
  Request request = world.request(32, Term::visibility, 16);
  request.light = 0;
  const Image image = render(request).image;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) EXPECT_EQ(image.at(x, y, image.channel("V")), 1.f) << x << " " << y;
}

/// As of a geometry source that returned nothing: its instance stays.
TEST(ReferenceGeometry, WithoutTrianglesThereIsNothingToSee) {
  const World world = busyWorld();
  World gone = world;
  gone.scene.dynamic.push_back({"gone", nullptr, 0});
  gone.pose.dynamic.push_back({std::make_shared<const scene::Primitive>(), {}});
  gone.pose.instances.emplace_back().mesh = 0;
  const Image before = render(world.request(8, Term::final, 4)).image;
  EXPECT_TRUE(sameBits(render(gone.request(8, Term::final, 4)).image, before));
}

TEST(ReferenceGeometry, InstancesEqualCopies) {
  // The same spheres: one mesh drawn three times (mirrored once), or three meshes.
  const glm::mat4 places[3] = {
      glm::translate(glm::mat4(1), glm::vec3(-0.8f, 0.5f, 0)) * glm::scale(glm::mat4(1), glm::vec3(0.3f)),
      glm::translate(glm::mat4(1), glm::vec3(0.1f, 0.3f, 0.2f)) *
          glm::scale(glm::mat4(1), glm::vec3(0.2f, 0.3f, 0.2f)),
      glm::translate(glm::mat4(1), glm::vec3(0.8f, 0.4f, -0.2f)) *
          glm::scale(glm::mat4(1), glm::vec3(-0.3f, 0.3f, 0.3f))};
  World shared = floorWorld();
  shared.addRectangle({0.2f, 1.5f, -0.1f}, {1, 0, 0}, {0, 0, -0.6f}, 7);
  shared.camera = scene::lookAt({0, 2, 3}, {0, 0.2f, 0}, 0.8f);
  World copied = shared;
  const int mesh = shared.addMesh(World::sphere(32, shared.addMaterial(glm::vec3(0.6f))));
  const int material = copied.addMaterial(glm::vec3(0.6f));
  for (const glm::mat4& place : places) {
    shared.addInstance(mesh, place);
    copied.addInstance(copied.addMesh(World::sphere(32, material)), place);
  }
  const Image a = render(shared.request(48, Term::direct, 64)).image;
  const Image b = render(copied.request(48, Term::direct, 64)).image;
  double difference = 0, sum = 0;
  int ids = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      difference += std::abs(static_cast<double>(a.at(x, y, 0)) - static_cast<double>(b.at(x, y, 0)));
      sum += static_cast<double>(a.at(x, y, 0));
      ids += a.at(x, y, a.channel("id")) != b.at(x, y, b.channel("id"));
    }
  EXPECT_LT(difference / sum, 1e-3);
  EXPECT_LE(ids, 2);
  EXPECT_GT(sum, 0);
}

/// A sphere whose height is nothing, and one whose height has an inverse beyond what rays may be: of a mesh
/// that is drawn twice, and of a mesh of its own.
TEST(ReferenceGeometry, CopiesWithoutAnInverseEqualMeshesOfTheirOwn) {
  for (const float height : {0.f, 1e-25f}) {
    World copied = floorWorld();
    copied.addLight(glsl::light_point, {0, 2, 0}, {0, -1, 0}, glm::vec3(3));
    const int mesh = copied.addMesh(World::sphere(16, copied.addMaterial(glm::vec3(0.6f))));
    copied.addInstance(mesh, glm::translate(glm::mat4(1), glm::vec3(0, 0.5f, 0)) *
                                 glm::scale(glm::mat4(1), glm::vec3(0.5f, height, 0.5f)));
    const World alone = copied;
    copied.addInstance(mesh, glm::translate(glm::mat4(1), glm::vec3(0, -50, 0)));
    const Image image = render(copied.request(16, Term::direct, 2)).image;
    EXPECT_EQ(image.at(8, 8, image.channel("id")), 1.f) << height;
    const Image expected = render(alone.request(16, Term::direct, 2)).image;
    EXPECT_LT(largestDifference(expected, image, "R"), 1e-4) << height;
  }
}

/// What is not a number is no small difference, in whichever picture it is.
TEST(ReferenceGeometry, TheDifferenceOfPicturesThatAreNotNumbersIsLarge) {
  Image sound(2, 1, {"R"});
  sound.at(0, 0, 0) = 1;
  Image broken = sound;
  broken.at(1, 0, 0) = std::nanf("");
  EXPECT_EQ(largestDifference(sound, sound, "R"), 0);
  EXPECT_FALSE(largestDifference(sound, broken, "R") < 1e300);
  EXPECT_FALSE(largestDifference(broken, sound, "R") < 1e300);
}

TEST(ReferenceGeometry, RaysFromBeyondAllScenesMeetNothing) {
  World world = floorWorld();
  world.camera = scene::lookAt({0, 1e19f, 1}, {0, 0, 0}, 0.8f);
  const Image image = render(world.request(4, Term::direct, 2)).image;
  EXPECT_EQ(image.at(2, 2, image.channel("coverage")), 0.f);
}

/// Mounted on a ceiling, in whose plane it lies, level or tilted, at any scale: the ceiling does not hide the
/// lamp.
TEST(ReferenceGeometry, ALampInTheCeilingLightsTheRoom) {
  for (const float tilt : {0.f, 0.4f})
    for (const float size : {1e-3f, 1.f, 1e3f}) {
      const glm::vec3 up(std::sin(tilt), std::cos(tilt), 0), along(std::cos(tilt), -std::sin(tilt), 0);
      const glm::vec3 lamp = 1.5f * up + 0.3f * along;
      World world;
      const int material = world.addMaterial(glm::vec3(0.5f), true);
      for (const float height : {0.f, 1.5f}) world.addQuad(height * up, 4.f * along, {0, 0, -4}, material);
      world.addLight(glsl::light_point, lamp, -up, glm::vec3(3));
      world.camera = scene::lookAt(1.2f * up + glm::vec3(0, 0, 0.3f), {0, 0, 0}, 1.4f);
      world.rescale(size);
      const Image image = render(world.request(24, Term::direct, 2)).image;
      const double error = meanRelativeError(world, image, "R", [&](const glm::dvec3& place) {
        const glm::dvec3 way = static_cast<double>(size) * glm::dvec3(lamp) - place;
        const double distance = glm::length(way) / static_cast<double>(size);
        return 0.5 / M_PI * 3 * glm::dot(glm::dvec3(up), glm::normalize(way)) / (distance * distance);
      });
      EXPECT_LT(error, 1e-4) << tilt << " " << size;
    }
}

/// Joints that mirror turn the winding and the bitangents round as the transform of a rigid mesh does.
TEST(ReferenceGeometry, MirroredSkinsEqualMirroredInstances) {
  World rigid = floorWorld();
  rigid.scene.images.emplace_back().levels.push_back({1, 1, {160, 192, 220, 255}});
  rigid.scene.materials[0].normalTexture.image = 0;
  scene::Primitive& primitive = rigid.scene.meshes[0].primitives[0];
  primitive.tangents.assign(4, {1, 0, 0, 1});
  rigid.scene.nodes.resize(3);  // a root, its mesh and its joint
  rigid.scene.nodes[0].transform.scale = {-1, 1, 1};
  rigid.scene.nodes[1].parent = rigid.scene.nodes[2].parent = 0;
  rigid.scene.nodes[1].mesh = 0;
  World skinned = rigid;
  scene::Primitive& bound = skinned.scene.meshes[0].primitives[0];
  bound.joints.assign(4, glm::u16vec4(0));
  bound.weights.assign(4, glm::vec4(1, 0, 0, 0));
  bound.jointBounds = {{0, bound.bounds}};
  skinned.scene.skins.push_back({{2}, {glm::mat4(1)}});
  skinned.scene.nodes[1].skin = 0;
  for (World* world : {&rigid, &skinned}) {
    world->pose = scene::evaluate(world->scene, 0);
    world->addLight(glsl::light_point, {0.5f, 1, 0.5f}, {0, -1, 0}, glm::vec3(1));
  }
  const Image expected = render(rigid.request(17, Term::direct, 2)).image;
  const Image image = render(skinned.request(17, Term::direct, 2)).image;
  EXPECT_EQ(image.at(8, 8, image.channel("coverage")), 1.f);
  EXPECT_LT(std::abs(expected.at(8, 8, expected.channel("N.Y"))), 0.95f) << "the map tilts the normal";
  for (const char* channel : {"coverage", "id", "N.X", "N.Y", "N.Z", "R"})
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 17; ++x)
        EXPECT_NEAR(image.at(x, y, image.channel(channel)), expected.at(x, y, expected.channel(channel)),
                    1e-5f)
            << channel << ' ' << x << ' ' << y;
}

TEST(ReferenceGeometry, SkinnedAndMorphedPrimitivesAreTracedDeformed) {
  World world = floorWorld();
  auto& primitive = world.scene.meshes[0].primitives[0];
  primitive.joints.assign(4, glm::u16vec4(0));
  primitive.weights.assign(4, glm::vec4(1, 0, 0, 0));
  primitive.morphTargets.emplace_back().positions.assign(4, glm::vec3(0, 0.5f, 0));
  scene::Deformation state;
  state.mesh = 0;
  state.joints = {glm::translate(glm::mat4(1), glm::vec3(0, 0.25f, 0))};
  state.morphWeights = {0.5f};
  world.pose.deformed.push_back(state);
  world.pose.instances[0].deformed = 0;
  world.addLight(glsl::light_point, {0, 1, 0}, {0, -1, 0}, glm::vec3(1));
  const Image image = render(world.request(9, Term::direct, 2)).image;
  EXPECT_NEAR(positionOf(world, image, 4, 4).y, 0.5, 1e-5);
  EXPECT_NEAR(image.at(4, 4, 0), 0.5f * glsl::inverse_pi / 0.25f, 1e-3f);  // 0.5 m below the light
}

TEST(ReferenceGeometry, FeaturesAreThoseOfTheSurface) {
  const World world = busyWorld();
  const Image image = render(world.request(33, Term::direct, 2)).image;
  const auto value = [&](const char* channel, int x, int y) {
    return image.at(x, y, image.channel(channel));
  };
  EXPECT_EQ(value("coverage", 16, 30), 1.f);
  EXPECT_EQ(value("id", 16, 30), 0.f);
  EXPECT_EQ(value("N.Y", 16, 30), 1.f);
  EXPECT_EQ(value("albedo.R", 16, 30), 0.5f);
  EXPECT_EQ(value("coverage", 0, 0), 0.f);
  EXPECT_EQ(value("A", 16, 30), 1.f);
  EXPECT_EQ(value("A", 0, 0), 0.f);
  EXPECT_NEAR(positionOf(world, image, 16, 30).y, 0, 1e-5);
}

TEST(ReferenceGeometry, SupersamplingAverages) {
  const World world = busyWorld();
  Request request = world.request(24, Term::direct, 16);
  const Image fine = render(request).image;
  request.width = request.height = 12;
  request.aa = 2;
  const Image coarse = render(request).image;
  ASSERT_EQ(coarse.width(), 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 12; ++x) {
      for (const int c : {0, fine.channel("A")}) {
        const float mean = 0.25f * (fine.at(2 * x, 2 * y, c) + fine.at(2 * x + 1, 2 * y, c) +
                                    fine.at(2 * x, 2 * y + 1, c) + fine.at(2 * x + 1, 2 * y + 1, c));
        EXPECT_NEAR(coarse.at(x, y, c), mean, 1e-5f * (1 + mean)) << x << ' ' << y << ' ' << c;
      }
    }
}

}  // namespace
}  // namespace limn::reference
