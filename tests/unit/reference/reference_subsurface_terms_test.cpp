// Translucent surfaces beside other terms, and what bodies and coefficients may be like.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/translucent_worlds.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::vec3;

constexpr float kTermsIor = 1.4f;

/// A translucent ball beside a white wall, with a highlight, lamps and a sky.
World mixedWorld() {
  World world = busyWorld();
  const int material = addTranslucent(world, vec3(20, 30, 40), {0.02f, 0.1f, 0.3f}, kTermsIor);
  world.scene.materials[static_cast<size_t>(material)].specularFactor = 1;
  world.scene.materials[static_cast<size_t>(material)].roughness = 0.4f;
  world.scene.meshes[1].primitives[0].material = material;
  world.addQuad({-0.8f, 0.5f, 0}, {0, 0, 2}, {0, 2, 0}, world.addMaterial(vec3(0.8f)));
  return world;
}

Image picture(const World& world, Term term, SubsurfaceModel model = SubsurfaceModel::bssrdf, int bounces = 0,
              int spp = 16) {
  Request request = world.request(24, term, spp);
  request.bounces = bounces;
  request.subsurface = model;
  return render(request).image;
}

float channelSum(const Image& image) {
  float sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) sum += image.at(x, y, c);
  return sum;
}

TEST(ReferenceSubsurfaceTerms, FinalIsTheSumOfItsTerms) {
  const World world = mixedWorld();
  for (const SubsurfaceModel model :
       {SubsurfaceModel::bssrdf, SubsurfaceModel::walk, SubsurfaceModel::local}) {
    const Image direct = picture(world, Term::direct), indirect = picture(world, Term::indirect, {}, 2),
                below = picture(world, Term::subsurface, model, 2),
                all = picture(world, Term::final, model, 2);
    const int coverage = all.channel("coverage");
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        if (all.at(x, y, coverage) == 0.f) continue;
        for (int c = 0; c < 3; ++c) {
          const float sum = direct.at(x, y, c) + indirect.at(x, y, c) + below.at(x, y, c);
          EXPECT_NEAR(all.at(x, y, c), sum, 1e-5f * sum + 1e-6f) << name(model) << " " << x << " " << y;
        }
      }
  }
}

/// What is no light from below a surface does not know how such light is followed, and is black without a
/// highlight.
TEST(ReferenceSubsurfaceTerms, ReflectionIsTheBoundarysAlone) {
  World world = mixedWorld();
  const auto colourOfBall = [&](Term term, int bounces) {
    const Image image = picture(world, term, SubsurfaceModel::bssrdf, bounces);
    return image.at(12, 12, 0);
  };
  ASSERT_EQ(picture(world, Term::direct).at(12, 12, 6), 1.f) << "the ball is in the middle";
  const float direct = colourOfBall(Term::direct, 0), indirect = colourOfBall(Term::indirect, 1);
  EXPECT_GT(direct, 0);
  EXPECT_GT(indirect, 0);
  world.scene.materials[2].subsurface->absorption = vec3(1);
  world.scene.materials[2].baseColour = glm::vec4(0, 0, 0, 1);
  EXPECT_EQ(colourOfBall(Term::direct, 0), direct) << "whatever lies below";
  EXPECT_EQ(colourOfBall(Term::indirect, 1), indirect);
  world.scene.materials[2].specularFactor = 0;
  EXPECT_EQ(colourOfBall(Term::direct, 0), 0);
  EXPECT_EQ(colourOfBall(Term::indirect, 1), 0);
}

/// One surface under light that comes over another one alone.
TEST(ReferenceSubsurfaceTerms, LightEntersOverOtherSurfaces) {
  const World world = mixedWorld();
  const Image none = picture(world, Term::subsurface, SubsurfaceModel::local),
              one = picture(world, Term::subsurface, SubsurfaceModel::local, 1);
  EXPECT_GT(channelSum(one), 1.02f * channelSum(none));
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) EXPECT_GE(one.at(x, y, 0), none.at(x, y, 0));
}

TEST(ReferenceSubsurfaceTerms, OpaqueScenesAreTheSameToTheBit) {
  const World world = busyWorld();
  for (const Term term : {Term::final, Term::specular}) {
    const auto bits = [&](SubsurfaceModel model) {
      Request request = world.request(24, term, 8);
      request.interfaces = defaultInterfaces(term);
      request.bounces = 1;
      request.subsurface = model;
      return render(request).image;
    };
    EXPECT_TRUE(sameBits(bits(SubsurfaceModel::bssrdf), bits(SubsurfaceModel::walk)));
    EXPECT_TRUE(sameBits(bits(SubsurfaceModel::bssrdf), bits(SubsurfaceModel::local)));
  }
  EXPECT_EQ(channelSum(picture(world, Term::subsurface)), 0);
}

/// Other bodies cast shadows and hand on no light from below.
TEST(ReferenceSubsurfaceTerms, LightStaysInItsBody) {
  World world;
  const int material = addTranslucent(world, vec3(2), vec3(0.05f), kTermsIor);
  const int ball = world.addMesh(World::sphere(48, material));
  world.addInstance(ball);
  world.addLight(glsl::light_directional, vec3(0), {0, 0, -1}, vec3(1));
  world.camera = scene::lookAt({0, 0, 4}, vec3(0), 0.4f);
  World two = world;
  two.addInstance(ball, glm::translate(glm::mat4(1), vec3(2.01f, 0, 0)));
  for (const SubsurfaceModel model : {SubsurfaceModel::bssrdf, SubsurfaceModel::walk}) {
    const Measured alone = measured(picture(world, Term::subsurface, model, 0, 128)),
                   beside = measured(picture(two, Term::subsurface, model, 0, 128));
    EXPECT_NEAR(beside.mean, alone.mean, 4 * std::hypot(alone.deviation, beside.deviation)) << name(model);
    EXPECT_LT(alone.deviation, 0.02 * alone.mean);
  }
}

TEST(ReferenceSubsurfaceTerms, ScaleDoesNotMatter) {
  for (const SubsurfaceModel model : {SubsurfaceModel::bssrdf, SubsurfaceModel::walk}) {
    World world = mixedWorld();
    const Image whole = picture(world, Term::subsurface, model);
    for (const float factor : {0x1p-13f, 0x1p13f}) {
      World scaled = mixedWorld();
      scaled.rescale(factor);
      scaled.scene.materials[2].subsurface->extinction /= factor;
      EXPECT_LT(largestDifference(whole, picture(scaled, Term::subsurface, model), "R"), 1e-3)
          << name(model) << " " << factor;
    }
  }
}

/// The radiance of every pixel, finite and not negative.
void expectSound(const World& world, SubsurfaceModel model, const std::string& what) {
  const Image image = picture(world, Term::subsurface, model, 1, 4);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(image.at(x, y, c))) << what << " " << name(model);
        ASSERT_GE(image.at(x, y, c), 0) << what << " " << name(model);
      }
}

TEST(ReferenceSubsurfaceTerms, ExtremesAndBrokenBodiesAreSound) {
  for (const SubsurfaceModel model :
       {SubsurfaceModel::bssrdf, SubsurfaceModel::walk, SubsurfaceModel::local}) {
    for (const float extinction : {1e-6f, 1.f, 1e5f, 1e9f})
      for (const float absorption : {0.f, 1.f})
        for (const float ior : {1.f, 3.f}) {
          if (absorption == 0 && extinction > 1 && model == SubsurfaceModel::walk) continue;  // long walks
          World world = mixedWorld();
          world.scene.materials[2].subsurface = {.extinction = vec3(extinction),
                                                 .absorption = vec3(absorption)};
          world.scene.materials[2].ior = ior;
          expectSound(
              world, model,
              "extinction " + std::to_string(extinction) + " absorption " + std::to_string(absorption));
        }
    World open = mixedWorld();  // half a ball
    auto& indices = open.scene.meshes[1].primitives[0].indices;
    indices.resize(indices.size() / 6 * 3);
    expectSound(open, model, "open");
    open.scene.materials[2].doubleSided = true;
    expectSound(open, model, "open, both sides");
    World flat = mixedWorld();
    for (vec3& p : flat.scene.meshes[1].primitives[0].positions) p.y = 0;
    expectSound(flat, model, "flat");
    World textured = mixedWorld();  // colours that differ between vertices
    auto& ball = textured.scene.meshes[1].primitives[0];
    for (size_t i = 0; i < ball.positions.size(); ++i) ball.colours.emplace_back(vec3(i % 3 == 0 ? 0 : 1), 1);
    textured.scene.materials[2].subsurface->albedoFromBaseColour = true;
    expectSound(textured, model, "colours");
  }
}

}  // namespace
}  // namespace limn::reference
