// Light from bump to bump against closed forms, the library's iteration and pictures without it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "tests/gpu/bump_bounces.h"
#include "tests/support/relief_bounces.h"

namespace limn {
namespace {

constexpr double kIrradiance = 2;  // of the floor's light

class BumpInterreflectionTest : public BumpBouncesTest {
 protected:
  struct Difference {
    double rms;   ///< over the RMS of what is expected
    double mean;  ///< over the mean of what is expected
  };

  /// Compares a picture with the radiance of texels, at pixels within 1/4 of a texel of a centre: with that
  /// of this texel, or between texels.
  static Difference difference(const Image& picture, const relief::HeightField& field,
                               const std::vector<double>& expected, bool between = false) {
    double error = 0, power = 0, sum = 0, all = 0;
    int counted = 0;
    forEachPoint(picture, [&](float value, const glm::vec3& p) {
      const glm::dvec2 place = field.place(0.5 * (glm::dvec2(p.x, p.z) + 1.0)), centre = glm::round(place);
      if (std::max(std::abs(place.x - centre.x), std::abs(place.y - centre.y)) > 0.25) return;
      const double wanted = relief::test::between(field, expected, between ? place : centre);
      const double seen = static_cast<double>(value);
      error += (seen - wanted) * (seen - wanted);
      power += wanted * wanted;
      sum += seen;
      all += wanted;
      ++counted;
    });
    EXPECT_GT(counted, 1500);
    return {.rms = std::sqrt(error / power), .mean = sum / all};
  }

  /// Returns the paths with their ends at the texels that are nearest to them.
  static relief::BouncePaths toNearestTexels(relief::BouncePaths paths) {
    for (relief::BouncePath& path : paths.list)
      if (path.hits()) path.place = glm::round(path.place);
    return paths;
  }

  /// What `bounces` bounces along the paths add to the direct light of the texels under slantedLight().
  static std::vector<double> bounced(const relief::HeightField& field, const relief::BouncePaths& paths,
                                     int bounces) {
    const glm::dvec3 l(slantedLight());
    const std::vector<double> direct =
        relief::test::directRadiance(field, {l.x, l.z, l.y}, static_cast<double>(kAlbedo), kIrradiance);
    std::vector<double> result =
        relief::test::bounce(field, paths, direct, static_cast<double>(kAlbedo), 0, bounces);
    for (size_t i = 0; i < result.size(); ++i) result[i] -= direct[i];
    return result;
  }
};

/// The texels of each floor count, though they share the height map.
TEST_F(BumpInterreflectionTest, MoreTexelsThanAStorageBufferHoldsAreRefused) {
  constexpr int size = 256;
  scene::Scene scene = bumps(slantedLight(), {{size, size}, std::vector<float>(size * size), glm::dvec2(2)});
  const scene::Node floor = scene.nodes[0];
  const int64_t most = device().limits().maxStorageBlockBytes / (int64_t{size} * size * 4);
  if (most > 4096) GTEST_SKIP() << "storage buffers hold the texels of " << most << " floors";
  for (int64_t i = 0; i < most; ++i) scene.nodes.push_back(floor);
  const auto drawn = [&](const std::string& space) {
    return light(scene, {{"space", space}, {"paths", "1"}, {"azimuths", "8"}, {"shadows", "false"}});
  };
  EXPECT_THROW(drawn("texture"), UsageError);
  EXPECT_NO_THROW(drawn("pixel"));
}

// What differs is that shadows are those of 128 azimuths, which get 0.001 of directions wrong, up to 0.01 of
// texels at 35 degrees, and that weights are stored in 8 bits.
TEST_F(BumpInterreflectionTest, IsTheLibrarysBounceTexelByTexel) {
  const relief::HeightField field = eggCrate();
  const scene::Scene scene = bumps(slantedLight(), field);
  using relief::BounceDirections;
  for (const auto& [name, directions] :
       {std::pair("own_frame", BounceDirections::ownFrame), std::pair("shared", BounceDirections::shared),
        std::pair("published", BounceDirections::published)}) {
    const std::vector<double> expected =
        bounced(field, toNearestTexels(relief::traceBounces(field, directions, 64)), 1);
    for (const std::string& space : kSpaces) {
      SCOPED_TRACE(name + (", " + space));
      const Image picture =
          light(scene, {{"directions", name}, {"space", space}, {"lookup", "nearest"}, {"azimuths", "128"}});
      const Difference d = difference(picture, field, expected);
      EXPECT_LT(d.rms, 0.03);
      EXPECT_NEAR(d.mean, 1, 0.01);
    }
  }
}

TEST_F(BumpInterreflectionTest, BouncesAddUp) {
  const relief::HeightField field = eggCrate();
  const scene::Scene scene = bumps(slantedLight(), field);
  const relief::BouncePaths paths =
      toNearestTexels(relief::traceBounces(field, relief::BounceDirections::ownFrame, 64));
  const std::vector<double> expected = bounced(field, paths, 3);
  for (const std::string& space : kSpaces) {
    SCOPED_TRACE(space);
    const Image picture =
        light(scene, {{"space", space}, {"bounces", "3"}, {"lookup", "nearest"}, {"azimuths", "128"}});
    const Difference d = difference(picture, field, expected);
    // Of a pixel each path goes on by one path: some 20 of 64 meet a bump, and of theirs 0.15 meet light
    // again. As random choices these would get sqrt(0.85 / 0.15 / 20) = 0.53 of the second bounce wrong,
    // which is a fifth of the light.
    EXPECT_LT(d.rms, space == "texture" ? 0.03 : 0.12);
    EXPECT_NEAR(d.mean, 1, space == "texture" ? 0.01 : 0.02);
  }
}

// Own frames get 0.09 of the bounce wrong, ends at the nearest texel 0.04 and the shadows of 16 azimuths,
// which are wrong for 0.004 of directions, as much.
TEST_F(BumpInterreflectionTest, SixtyFourPathsAreEnoughAndPublishedOnesLoseLight) {
  const relief::HeightField field = eggCrate();
  const scene::Scene scene = bumps(slantedLight(), field);
  const std::vector<double> exact =
      bounced(field, relief::traceBounces(field, relief::BounceDirections::ownFrame, 1024), 1);
  for (const std::string& space : kSpaces) {
    for (const std::string lookup : {"nearest", "between"})
      for (const auto& [azimuths, rms, bias] :
           {std::tuple("16", 0.12, 0.02), std::tuple("128", 0.105, 0.015)}) {
        const Difference off =
            difference(light(scene, {{"space", space}, {"lookup", lookup}, {"azimuths", azimuths}}), field,
                       exact, lookup == "between");
        // Pixels between texels meet ends between texels, which are interpolated: 0.111 is measured.
        const double most = lookup == "between" && space == "pixel" ? std::max(rms, 0.115) : rms;
        EXPECT_LE(off.rms, most) << space << ", " << lookup << ", " << azimuths << " azimuths: mean "
                                 << off.mean;
        EXPECT_NEAR(off.mean, 1, bias)
            << space << ", " << lookup << ", " << azimuths << " azimuths: RMS " << off.rms;
      }
    const Difference published = difference(
        light(scene, {{"space", space}, {"directions", "published"}, {"paths", "512"}}), field, exact);
    EXPECT_LT(published.mean, 0.8) << space;
  }
}

// An egg-crate that is turned over is itself with u or v mirrored, by its coordinates or by its node.
// Mirrored spirals err otherwise than those of what is expected; a relief that lay another way would be lit
// on its other sides.
TEST_F(BumpInterreflectionTest, MirroredCoordinatesMirrorTheRelief) {
  const relief::HeightField turnedOver = eggCrate(-0.141);
  const std::vector<double> exact =
      bounced(turnedOver, relief::traceBounces(turnedOver, relief::BounceDirections::ownFrame, 1024), 1);
  scene::Scene u = bumps(slantedLight(), eggCrate()), v = u, node = u;
  moveCoordinates(u, [](const glm::vec2& uv) { return glm::vec2(1 - uv.x, uv.y); });
  moveCoordinates(v, [](const glm::vec2& uv) { return glm::vec2(uv.x, 1 - uv.y); });
  node.nodes[0].transform.scale.x = -1;
  for (const auto& [name, scene] :
       {std::pair("u mirrored", u), std::pair("v mirrored", v), std::pair("mirrored by its node", node),
        std::pair("turned over", bumps(slantedLight(), turnedOver))})
    for (const std::string& space : kSpaces) {
      SCOPED_TRACE(name + (", " + space));
      const Difference d =
          difference(light(scene, {{"space", space}, {"lookup", "nearest"}}), turnedOver, exact);
      EXPECT_LE(d.rms, 0.15);
      EXPECT_NEAR(d.mean, 1, 0.02);
    }
}

// Under light from the zenith both walls, of 45 degrees, are lit alike. What a strip of one receives of the
// other is (1 - cos a) / 2 of what that sends, where a is the angle between its own wall and the other crest.
TEST_F(BumpInterreflectionTest, WallsOfAGrooveExchangeTheirFormFactor) {
  const scene::Scene scene = bumps({0, 1, 0}, groove());
  const double albedo = static_cast<double>(kAlbedo);
  const double sent = albedo / std::numbers::pi * kIrradiance * std::sqrt(0.5);
  for (const std::string& space : kSpaces) {
    double sum = 0, exact = 0;
    int counted = 0;
    forEachPoint(light(scene, {{"space", space}, {"paths", "256"}}), [&](float value, const glm::vec3& p) {
      const double texel = 0.5 * (static_cast<double>(p.x) + 1) * kTexels - 0.5;  // crests at 0 and kTexels
      const double way = std::min(texel, kTexels - texel) / kTexels;              // to the nearer crest
      // Normals of crests and bottoms lie between those of the walls.
      if (way * kTexels < 2 || (0.5 - way) * kTexels < 2) return;
      const glm::dvec2 crest = glm::normalize(glm::dvec2(1 - way, way)),
                       down(std::sqrt(0.5), -std::sqrt(0.5));
      const double expected = albedo * sent * (1 - glm::dot(crest, down)) / 2;
      EXPECT_NEAR(static_cast<double>(value), expected, 0.1 * albedo * sent) << space << ' ' << way;
      sum += static_cast<double>(value);
      exact += expected;
      ++counted;
    });
    ASSERT_GT(counted, 4000);
    EXPECT_NEAR(sum / exact, 1, 0.05) << space;
  }
}

TEST_F(BumpInterreflectionTest, FlatFieldsHaveNone) {
  const relief::HeightField point({1, 1}, {0.5f}, glm::dvec2(2));
  for (const relief::HeightField& field : {flat(), point})
    for (const std::string& space : kSpaces) {
      const scene::Scene scene = bumps({1, 1, 0.5f}, field);
      EXPECT_EQ(sumOf(light(scene, {{"space", space}, {"bounces", "3"}})), 0) << space;
      EXPECT_TRUE(same(drawn(scene, Term::final, {technique("bump_interreflection", {{"space", space}})}),
                       drawn(scene, Term::final, {})))
          << space;
    }
}

TEST_F(BumpInterreflectionTest, ScenesWithoutHeightMapsAreLeftAlone) {
  const scene::Scene scene = floorUnder({1, 1, 0.5f}, {});
  std::vector<frame::PassReport> passes;
  EXPECT_TRUE(same(drawn(scene, Term::final, {technique("bump_interreflection")}, &passes),
                   drawn(scene, Term::final, {})));
  bool said = false;
  for (const frame::PassReport& pass : passes) {
    for (const frame::AccessReport& access : pass.accesses) EXPECT_NE(access.resource, "tangent");
    if (pass.technique != "bump_interreflection") continue;
    EXPECT_EQ(pass.state, frame::PassState::leftOut);
    said = said || pass.reason == "no material has a height map";
  }
  EXPECT_TRUE(said);
}

TEST_F(BumpInterreflectionTest, OtherSurfacesShadowIt) {
  scene::Scene scene = bumps({0, 1, 0}, eggCrate());
  // A roof above the camera, which looks from 2 m down.
  scene::Node roof;
  roof.mesh = test::addMesh(scene, test::floorPrimitive(3, test::addMaterial(scene)));
  roof.transform.translation = {0, 4, 0};
  scene.nodes.push_back(roof);
  for (const std::string& space : kSpaces) {
    EXPECT_EQ(sumOf(light(scene, {{"space", space}})), 0) << space;
    EXPECT_GT(sumOf(light(scene, {{"space", space}, {"shadows", "false"}})), 0) << space;
  }
}

TEST_F(BumpInterreflectionTest, CurvedSurfacesAreAnsweredForPixelByPixelBesideFlatOnes) {
  scene::Scene scene = bumps(slantedLight(), eggCrate());
  scene::Primitive bent = test::floorPrimitive(1, 0);
  bent.positions[1].y = 0.02f;
  scene::Node node;
  node.mesh = test::addMesh(scene, std::move(bent));
  node.transform.translation = {1, 0.01f, 0};  // above the right half of the flat one
  scene.nodes.push_back(node);
  const Image pixel = light(scene, {}), texture = light(scene, {{"space", "texture"}});
  int differing = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = kSide / 2 + 2; x < kSide; ++x) ASSERT_EQ(texture.at(x, y, 0), pixel.at(x, y, 0));
    for (int x = 0; x < kSide / 2 - 2; ++x) differing += texture.at(x, y, 0) != pixel.at(x, y, 0);
  }
  EXPECT_GT(differing, 1000);
  EXPECT_NEAR(sumOf(texture) / sumOf(pixel), 1, 0.01);
}

/// Geometry of a source, as metaballs are, that stands above the right half of a flat floor.
TEST_F(BumpInterreflectionTest, SourcesAreAnsweredForPixelByPixelBesideFlatSurfaces) {
  scene::Scene scene = bumps(slantedLight(), eggCrate());
  scene::Primitive above = test::floorPrimitive(1, 0);
  for (glm::vec3& p : above.positions) p += glm::vec3(1, 0.01f, 0);
  above = test::finish(std::move(above));
  scene.dynamic.push_back({"floor", std::make_shared<test::StillSource>(std::move(above)), 0});
  const Image pixel = light(scene, {}), texture = light(scene, {{"space", "texture"}});
  int lit = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = kSide / 2 + 2; x < kSide; ++x) {
      ASSERT_EQ(texture.at(x, y, 0), pixel.at(x, y, 0));
      lit += texture.at(x, y, 0) > 0;
    }
  EXPECT_GT(lit, 1000);
}

TEST_F(BumpInterreflectionTest, ScalesWithTheLightAndAddsUpOverLights) {
  const scene::Scene one = bumps(slantedLight(), eggCrate());
  scene::Scene other = bumps({-1, 1, 0.3f}, eggCrate()), both = one;
  both.lights.push_back(other.lights[0]);
  both.nodes.push_back(other.nodes.back());
  both.nodes.back().light = 1;
  for (const std::string& space : kSpaces) {
    const Image a = light(one, {{"space", space}}), b = light(other, {{"space", space}}),
                sum = light(both, {{"space", space}});
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        ASSERT_NEAR(sum.at(x, y, 0), a.at(x, y, 0) + b.at(x, y, 0), 1e-5f) << space;
    scene::Scene brighter = one;
    brighter.lights[0].intensity *= 1e6f;
    EXPECT_NEAR(sumOf(light(brighter, {{"space", space}})) / sumOf(a), 1e6, 10) << space;
  }
}

TEST_F(BumpInterreflectionTest, LightOfAnyHeightIsFinite) {
  for (const float height : {1000.f, 1e-4f, 0.f, -0.5f})
    for (const std::string& space : kSpaces)
      for (const std::string shape : {"horizon_map", "moments"}) {
        const scene::Scene scene = bumps({1, height, 0.2f}, groove());
        forEachPoint(light(scene, {{"space", space}, {"shape", shape}, {"bounces", "4"}}),
                     [&](float value, const glm::vec3&) {
                       ASSERT_TRUE(std::isfinite(value) && value >= 0);
                       if (height < 0) {
                         ASSERT_EQ(value, 0) << "from below the base";
                       }
                     });
      }
}

}  // namespace
}  // namespace limn
