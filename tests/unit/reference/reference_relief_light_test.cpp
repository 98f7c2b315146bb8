// Where the reference's light leaves surfaces with height maps, their bumps keep it off; without bumps
// nothing changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/relief/horizon.h"
#include "tests/support/relief_worlds.h"
#include "tests/unit/relief/fields.h"

namespace limn::reference {
namespace {

using namespace test;
using glm::dvec2;
using glm::dvec3;
using glm::vec2;
using glm::vec3;
using relief::HeightField;

TEST(ReferenceReliefLight, AFlatFieldChangesNoBit) {
  const HeightField fields[] = {{{1, 1}, {0.3f}, dvec2(1)},
                                {{3, 2}, std::vector<float>(6, 0.7f), dvec2(0.1, 2), -1e4},
                                {{1, 5}, std::vector<float>(5, 2.f), dvec2(1), 0, 1, relief::Wrap::clamped}};
  for (const HeightField& field : fields) {
    World world = busyWorld();
    scene::Primitive& floor = world.scene.meshes[0].primitives[0];
    completeTangents(floor);
    floor.material = addMap(world, field);
    const World flat = flattened(world);
    for (const Term term : {Term::direct, Term::final, Term::indirect, Term::visibility}) {
      const auto picture = [&](const World& of) {
        Request request = of.request(24, term, 8);
        if (hasBounces(term)) request.bounces = 5;
        if (term == Term::visibility) request.light = 0;
        return render(request).image;
      };
      EXPECT_TRUE(sameBits(picture(world), picture(flat))) << name(term);
    }
    for (const float w : {0, 1}) {
      Request request = world.request(24, Term::relief, 8);
      request.light = static_cast<int>(w);
      const Image image = render(request).image;
      for (int i = 0; i < 24 * 24; ++i)
        ASSERT_EQ(image.at(i % 24, i / 24, image.channel("R")), 1.f)
            << "with and without a map, and where nothing is seen";
    }
  }
}

TEST(ReferenceReliefLight, DirectLightIsThatOfTheFlatSurfaceTimesW) {
  World world = planeWorld(relief::test::eggCrate(32));
  world.addLight(glsl::light_point, {0.6f, -0.3f, 0.5f}, {0, 0, -1}, vec3(1, 2, 3));
  const Image w = reliefOf(world), image = render(world.request(kSide, Term::direct, 2)).image,
              flat = render(flattened(world).request(kSide, Term::direct, 2)).image;
  int dark = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float factor = w.at(x, y, w.channel("W"));
      for (int c = 0; c < 3; ++c) EXPECT_EQ(image.at(x, y, c), factor * flat.at(x, y, c));
      dark += factor == 0.f;
    }
  EXPECT_GT(dark, 100);
  Request request = world.request(kSide, Term::visibility, 2);
  request.light = 0;
  const Image v = render(request).image;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) EXPECT_EQ(v.at(x, y, v.channel("V")), 1.f);
}

/// Radiance = albedo sky A / pi, A the area of the lit part of the disc.
TEST(ReferenceReliefLight, AUniformSkyIsSeenThroughTheLitPartOfTheDisc) {
  const HeightField field = relief::test::eggCrate(16, 0.9);
  World world = planeWorld(field);
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, vec3(2));
  const Image image = render(world.request(8, Term::direct, 512)).image;
  double least = 1;
  const double error = meanRelativeError(world, image, "R", [&](const dvec3& p) {
    constexpr int azimuths = 256;
    double sum = 0;
    for (int i = 0; i < azimuths; ++i) {
      const double e =
          relief::exactHorizon(field, field.place({p.x, -p.y}), 2 * std::numbers::pi * i / azimuths);
      sum += 1 / (1 + e * e) / azimuths;
    }
    least = std::min(least, sum);
    return 0.5 * 2 * sum;
  });
  EXPECT_LT(error, 0.01);  // 64 pixels of 1024 samples of 0 or 1
  EXPECT_LT(least, 0.7);
}

/// A floor and a wall at x = 1 that faces it, both seen from above. The floor shows its whole map, the wall
/// the inner part of its own.
World cornerWorld(const HeightField& floor, const HeightField& wall) {
  World world = planeWorld(floor, {.uv = [](const vec2& p) { return 0.5f + 0.5f * p; }});
  glm::mat4 upright(1);
  upright[0] = {0, -1, 0, 0};
  upright[1] = {0, 0, 1, 0};
  upright[2] = {-1, 0, 0, 0};
  upright[3] = {1, 0, 1, 1};
  addPlane(world, wall, {.uv = [](const vec2& p) { return 0.5f + 0.4f * p; }, .matrix = upright});
  return world;
}

/// Compares pictures of the floor's light by way of the wall alone: with bumps that keep it off, `shadowed`,
/// and with bumps that lie the other way round.
void expectKeptOff(const World& shadowed, const World& lit, Term term) {
  const auto picture = [&](const World& world) {
    Request request = world.request(kSide, term, 16);
    request.bounces = defaultBounces(term);
    if (hasBounces(term)) request.reliefPaths = ReliefPaths::others;
    return render(request).image;
  };
  const Image dark = picture(shadowed), bright = picture(lit), flat = picture(flattened(lit));
  EXPECT_TRUE(sameBits(bright, flat));
  double sum = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const dvec3 p = positionOf(shadowed, dark, x, y);
      if (p.z > 1e-3 || p.x > 0.5 || std::abs(p.y) > 0.9) continue;
      EXPECT_EQ(dark.at(x, y, 0), 0.f);
      sum += static_cast<double>(bright.at(x, y, 0));
    }
  EXPECT_GT(sum, 0);
}

const HeightField kFlat({1, 1}, {0.f}, dvec2(1));

TEST(ReferenceReliefLight, LightFromOtherSurfacesArrivesPastTheBumps) {
  const auto world = [](double slope) {
    World w = cornerWorld(ramp(0, slope), kFlat);
    shineFrom(w, glm::normalize(vec3(-1, 0, 0.2f)));
    return w;
  };
  expectKeptOff(world(50), world(-50), Term::indirect);
}

TEST(ReferenceReliefLight, OtherSurfacesAreLitPastTheirBumps) {
  const auto world = [](double slope) {
    World w = cornerWorld(kFlat, ramp(1, slope));
    shineFrom(w, glm::normalize(vec3(-0.3f, 0, 1)));
    return w;
  };
  expectKeptOff(world(1), world(-1), Term::indirect);
}

TEST(ReferenceReliefLight, CausticsArrivePastTheBumps) {
  const auto world = [](double slope) {
    World w = cornerWorld(ramp(0, slope), kFlat);
    scene::Material& mirror = w.scene.materials[1];
    mirror.metallic = 1;
    mirror.roughness = 0;
    mirror.baseColour = glm::vec4(1);
    shineFrom(w, glm::normalize(vec3(-1, 0, 0.8f)));
    return w;
  };
  expectKeptOff(world(2), world(-2), Term::caustic);
}

}  // namespace
}  // namespace limn::reference
