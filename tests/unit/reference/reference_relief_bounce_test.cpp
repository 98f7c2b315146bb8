// Light from bump to bump in the reference: against closed forms, quadrature, and the bounces of core/relief.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "glsl/relief/bounce_directions.glsl"
#include "tests/support/relief_bounces.h"
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

/// A plane whose picture shows one tile of the field, of 1 m, from above; its normals come from the heights.
World tileWorld(const HeightField& field, float albedo) {
  World world = planeWorld(field, {.uv = [](const vec2& p) { return vec2(0.5f + p.x, 0.5f - p.y); }});
  world.camera = scene::lookAt({0, 0, 0.5f / std::tan(0.4f)}, vec3(0), 0.8f);
  scene::Material& material = world.scene.materials[0];
  material.normalTexture.image = scene::kNone;
  material.baseColour = glm::vec4(albedo, albedo, albedo, 1);
  return world;
}

/// A direction of the field as one of the world: v falls with y.
vec3 toWorld(const dvec3& d) {
  return {d.x, -d.y, d.z};
}

dvec3 lightAt(double degrees) {
  const double elevation = degrees * std::numbers::pi / 180;
  return {std::cos(elevation) * std::cos(0.5), std::cos(elevation) * std::sin(0.5), std::sin(elevation)};
}

Result resultOf(const World& world, int side, int spp, int bounces, Term term = Term::indirect,
                ReliefPaths paths = ReliefPaths::both) {
  Request request = world.request(side, term, spp);
  request.bounces = bounces;
  request.reliefPaths = paths;
  return render(request);
}

double meanOf(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) sum += static_cast<double>(image.at(x, y, 0));
  return sum / static_cast<double>(image.pixelCount());
}

struct Comparison {
  double mean;  ///< over the expected one
  double rms;   ///< of the differences, over the expected mean
};

Comparison compared(const Image& image, const std::function<double(int, int)>& expected) {
  double sum = 0, wanted = 0, square = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double value = static_cast<double>(image.at(x, y, 0)), e = expected(x, y);
      sum += value;
      wanted += e;
      square += (value - e) * (value - e);
    }
  return {.mean = sum / wanted, .rms = std::sqrt(square * static_cast<double>(image.pixelCount())) / wanted};
}

TEST(ReferenceReliefBounce, ManyBouncesAreThoseOfTexels) {
  constexpr int side = 64;
  const HeightField field = relief::test::eggCrate(side, 0.94);
  World world = tileWorld(field, 0.7f);
  const dvec3 light = lightAt(60);
  shineFrom(world, toWorld(light));
  const relief::BouncePaths paths = relief::traceBounces(field, relief::BounceDirections::ownFrame, 256);
  const std::vector<double> direct = relief::test::directRadiance(field, light, 0.7, 1);
  for (const int bounces : {1, 4}) {
    const std::vector<double> all = relief::test::bounce(field, paths, direct, 0.7, 0, bounces);
    const Result result = resultOf(world, side, 64, bounces);
    const Comparison difference = compared(result.image, [&](int x, int y) {
      const size_t texel = field.index({x, y});
      return all[texel] - direct[texel];
    });
    EXPECT_NEAR(difference.mean, 1, 0.01);
    EXPECT_LT(difference.rms, 1.2 * result.noiseRms);
  }
}

/// Is a numerical integral of one bounce at places between texels, where no crease of the field lies.
class BounceOfPlaces {
 public:
  BounceOfPlaces(const HeightField& field, const dvec3& light, double albedo)
      : field_(field), light_(light), albedo_(albedo) {}

  double at(const dvec2& place) const {
    constexpr int directions = 4096;
    double sum = 0;
    for (int i = 0; i < directions; ++i) {
      const dvec3 d = glsl::own_frame_direction(i, directions, vec3(normal(place)), 0);
      if (const auto met = relief::traceRay(field_, place, d)) sum += direct(*met);
    }
    return albedo_ * sum / directions;
  }

 private:
  dvec3 normal(const dvec2& place) const {
    const dvec2 corner = glm::floor(place), part = place - corner;
    const glm::ivec2 at(corner), x(1, 0), y(0, 1);
    const dvec2 slope = glm::mix(glm::mix(field_.slope(at), field_.slope(at + x), part.x),
                                 glm::mix(field_.slope(at + y), field_.slope(at + x + y), part.x), part.y);
    return glm::normalize(dvec3(-slope, 1));
  }
  double direct(const dvec2& place) const {
    if (relief::traceRay(field_, place, light_)) return 0;
    return albedo_ / std::numbers::pi * std::max(glm::dot(normal(place), light_), 0.0);
  }

  const HeightField& field_;
  dvec3 light_;
  double albedo_;
};

TEST(ReferenceReliefBounce, OneBounceIsItsIntegral) {
  constexpr int side = 16;
  const dvec3 light = lightAt(40);
  for (const HeightField& field : {relief::test::eggCrate(side, 0.94), relief::test::noise(side, 0.5),
                                   relief::test::bricks(side, 1.5)}) {
    World world = tileWorld(field, 0.7f);
    for (vec2& uv : world.scene.meshes[0].primitives[0].uvs) uv += 0.5f / side;
    shineFrom(world, toWorld(light));
    const BounceOfPlaces exact(field, light, 0.7);
    const Result result = resultOf(world, side, 1024, 1);
    const Comparison difference =
        compared(result.image, [&](int x, int y) { return exact.at(dvec2(x, y) + 0.5); });
    EXPECT_NEAR(difference.mean, 1, 0.01);
    EXPECT_LT(difference.rms, 1.2 * result.noiseRms);
  }
}

/// Opening angle 2 h: the walls' form factor is 1 - sin h; that of a strip is (1 - cos a) / 2, where a is the
/// angle between its own wall and the other crest. Light from the zenith is the same everywhere on the walls.
TEST(ReferenceReliefBounce, WallsOfAGrooveSeeEachOther) {
  constexpr int texels = 512;
  constexpr double slope = 1.3, albedo = 0.5;
  const double half = std::atan(1 / slope);
  const HeightField field = relief::test::groove(texels, slope);
  World world = tileWorld(field, static_cast<float>(albedo));
  shineFrom(world, {0, 0, 1});
  const Result result = resultOf(world, kSide, 512, 1);
  const double direct = albedo / std::numbers::pi * std::sin(half);
  double sum = 0, whole = 0;
  int count = 0;
  const auto seen = [&](double x) {  // metres from a crest
    const double to = std::min(x, 1 - x);
    return (1 - glm::dot(glm::normalize(dvec2(1 - to, slope * to)), glm::normalize(dvec2(1, -slope)))) / 2;
  };
  for (int x = 0; x < kSide; ++x) {
    const double at = (x + 0.5) / kSide - 0.5 / texels;
    whole += seen(at) / kSide;
    if (x % (kSide / 2) == 0) continue;  // has the crest's, or the bottom's, normal in it
    double column = 0;
    for (int y = 0; y < kSide; ++y) column += static_cast<double>(result.image.at(x, y, 0)) / kSide;
    // Of 32 x 512 paths a share of up to .5 arrives: 4 deviations are .016.
    EXPECT_NEAR(column / (albedo * direct), seen(at), 0.016) << x;
    sum += column / (albedo * direct) - seen(at);
    ++count;
  }
  EXPECT_NEAR(whole, 1 - std::sin(half), 0.002);
  EXPECT_NEAR(sum / count / whole, 0, 0.01);
}

/// A tile of white bumps under an even sky of radiance 1.
World furnace(const HeightField& field) {
  World world = tileWorld(field, 1);
  world.scene.environment.width = 4;
  world.scene.environment.height = 2;
  world.scene.environment.texels.assign(8, vec3(1));
  return world;
}

/// Paths that have not left after 12 bounces are the deficit: fewer than 1 in 1000.
TEST(ReferenceReliefBounce, AFurnaceIsOne) {
  for (const HeightField& field : {relief::test::eggCrate(64, 0.94), relief::test::bricks(64, 1.52)}) {
    const World world = furnace(field);
    double last = 0;
    for (const int bounces : {0, 1, 3, 7, 11}) {
      const double mean = meanOf(resultOf(world, kSide, 64, bounces, Term::final).image);
      EXPECT_GT(mean, last);
      last = mean;
    }
    EXPECT_NEAR(last, 1, 1e-3);
  }
}

/// Direct light of the sky is the first bounce. 65536 paths leave a deviation of 0.002.
TEST(ReferenceReliefBounce, AFurnaceFillsAsFastAsWallsHideTheSky) {
  const World world = furnace(relief::test::eggCrate(64, 0.94));
  for (const auto& [bounces, expected] :
       {std::pair(1, 0.742), std::pair(2, 0.922), std::pair(4, 0.992), std::pair(8, 0.9999)})
    EXPECT_NEAR(meanOf(resultOf(world, kSide, 64, bounces - 1, Term::final).image), expected, 0.01)
        << bounces << " bounces";
}

/// A groove whose walls are white (u < 1/2) and black.
TEST(ReferenceReliefBounce, BumpsHaveTheColourOfTheirOwnPlace) {
  World world = tileWorld(relief::test::groove(512, 1.3), 1);
  shineFrom(world, {0, 0, 1});
  const double plain = meanOf(resultOf(world, kSide, 16, 1).image);
  scene::TextureImage& walls = world.scene.images[0];
  constexpr int texels = 512;
  walls.levels[0] = {.width = texels, .height = 1, .rgba = std::vector<uint8_t>(4 * texels, 255)};
  for (size_t i = 4 * texels / 2; i < 4 * texels; ++i) walls.levels[0].rgba[i] = 0;
  world.scene.materials[0].baseColourTexture.image = 0;
  EXPECT_LT(meanOf(resultOf(world, kSide, 16, 1).image), 0.02 * plain);
  for (size_t i = 0; i < 4 * texels; ++i) walls.levels[0].rgba[i] = 128;
  const double grey = 128.0 / 255;
  EXPECT_NEAR(meanOf(resultOf(world, kSide, 16, 1).image), grey * grey * plain, 1e-3 * plain);
}

/// Two planes that face each other across an edge, both with bumps.
World bumpyCorner() {
  World world = tileWorld(relief::test::eggCrate(32, 0.9), 0.8f);
  glm::mat4 upright(1);
  upright[0] = {0, -1, 0, 0};
  upright[1] = {0, 0, 1, 0};
  upright[2] = {-1, 0, 0, 0};
  upright[3] = {0.5f, 0, 0.5f, 1};
  addPlane(world, relief::test::noise(16, 0.5), {.matrix = upright});
  shineFrom(world, glm::normalize(vec3(-0.5f, 0.2f, 1)));
  return world;
}

TEST(ReferenceReliefBounce, ReliefPathsAndOthersAddUpToBoth) {
  const World world = bumpyCorner();
  for (const Term term : {Term::indirect, Term::final}) {
    const auto picture = [&](ReliefPaths paths) { return resultOf(world, kSide, 16, 5, term, paths).image; };
    const Image both = picture(ReliefPaths::both), relief = picture(ReliefPaths::relief),
                others = picture(ReliefPaths::others),
                direct = render(world.request(kSide, Term::direct, 16)).image;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const float twice = term == Term::final ? direct.at(x, y, 0) : 0.f;
        EXPECT_NEAR(relief.at(x, y, 0) + others.at(x, y, 0) - twice, both.at(x, y, 0), 1e-5f);
      }
    const double common = term == Term::final ? meanOf(direct) : 0;
    EXPECT_GT(meanOf(relief) - common, 0.05 * (meanOf(both) - common));
    EXPECT_GT(meanOf(others) - common, 0.05 * (meanOf(both) - common));
  }
}

TEST(ReferenceReliefBounce, WithoutBumpsOthersAreAll) {
  const World world = flattened(bumpyCorner());
  const auto picture = [&](ReliefPaths paths) {
    return resultOf(world, kSide, 4, 3, Term::indirect, paths).image;
  };
  EXPECT_TRUE(sameBits(picture(ReliefPaths::both), picture(ReliefPaths::others)));
  EXPECT_EQ(meanOf(picture(ReliefPaths::relief)), 0);
}

TEST(ReferenceReliefBounce, MapsOnMirroredSurfacesBounceAlike) {
  // The same field in the world: mirrored by the instance, and by the texture coordinates.
  const HeightField field = relief::test::noise(32, 0.9);
  World plain = tileWorld(field, 0.7f), mirrored = plain;
  const glm::mat4 mirror = glm::scale(glm::mat4(1), vec3(-1, 1, 1));
  mirrored.pose.instances[0].objectToWorld = mirror;
  scene::Primitive& p = mirrored.scene.meshes[0].primitives[0];
  for (auto& uv : p.uvs) uv.x = 1 - uv.x;
  completeTangents(p);
  for (World* world : {&plain, &mirrored}) shineFrom(*world, toWorld(lightAt(45)));
  const Image a = resultOf(plain, kSide, 64, 3).image, b = resultOf(mirrored, kSide, 64, 3).image;
  // Each mean of 65536 paths has a deviation of about 0.2 %.
  EXPECT_NEAR(meanOf(b), meanOf(a), 0.01 * meanOf(a));
}

}  // namespace
}  // namespace limn::reference
