// W of bumps and their light for each other where maps, coordinates, scales and views are unusual, against
// the reference.
#include <functional>

#include "core/reference/reference.h"
#include "tests/gpu/bump_floor.h"
#include "tests/unit/relief/fields.h"

namespace limn {
namespace {

constexpr int kNoise = 48;                         // texels along a side
constexpr float kReceived = 2 * glsl::inverse_pi;  // of white bumps that face the light, W/(sr m^2)

class BumpStabilityTest : public BumpFloorTest {
 protected:
  using Change = std::function<void(scene::Scene&)>;

  /// The noise on a tile of so many metres; a scale of as many gives it that slope.
  static relief::HeightField noise(double slope, relief::Wrap wrap = relief::Wrap::periodic, double scale = 2,
                                   double tile = 2) {
    const relief::HeightField field = relief::test::noise(kNoise, slope);
    std::vector<float> heights;
    for (int y = 0; y < kNoise; ++y)
      for (int x = 0; x < kNoise; ++x) heights.push_back(static_cast<float>(field.texel({x, y})));
    return {field.size(), heights, glm::dvec2(tile), scale, 0, wrap};
  }

  /// 36 texels of all heights below 1, mixed, under light that rises by a half.
  static scene::Scene blocksOf(const glm::ivec2& size, double scale) {
    std::vector<float> values;
    for (int i = 0; i < 36; ++i) values.push_back(static_cast<float>(i * 7 % 36) / 36);
    return floorUnder({1, 0.5f, 0.2f}, {{size, values, glm::dvec2(2), scale}});
  }

  /// `samples` x `samples` pixels of the reference for each of a picture.
  Image truth(const scene::Scene& scene, int samples = 1, const scene::CameraPose& from = camera()) {
    render::Renderer renderer(device(), scene);
    reference::Request asked =
        test::request(scene, renderer.pose(), from, glm::ivec2(samples * kSide), Term::relief, 2);
    asked.light = 0;
    return reference::render(asked).image.select({"R"});
  }

  /// The sum over the floor's pixels of what bumps reflect to each other once, by the reference.
  double trueBounce(const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    reference::Request asked =
        test::request(scene, renderer.pose(), camera(), glm::ivec2(kSide), Term::indirect, 32);
    asked.bounces = 1;
    asked.reliefPaths = ReliefPaths::relief;
    double sum = 0;
    forEachPoint(reference::render(asked).image,
                 [&](float value, const glm::vec3&) { sum += static_cast<double>(value); });
    return sum;
  }

  /// The share of the pixels that show a surface that faces the light, whose W differs from the reference's,
  /// where at least `least` of them are lit and as many dark. `aside`: pixels around the middle of the
  /// picture that do not count.
  double wrongShare(const scene::Scene& scene, const std::string& shape, double least = 0.1,
                    const scene::CameraPose& from = camera(), double aside = 0) {
    const Image wanted = truth(scene, 1, from);
    const Image w = drawn(scene, Term::relief,
                          {technique("bump_horizon", {{"shape", shape}, {"steps", "256"}})}, nullptr, from);
    const Image plain = drawn(scene, Term::direct, {}, nullptr, from);
    int wrong = 0, lit = 0, dark = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (w.at(x, y, w.channel("Z")) <= 0 || plain.at(x, y, 0) == 0) continue;
        if (std::hypot(x - 0.5 * (kSide - 1), y - 0.5 * (kSide - 1)) < aside) continue;
        const bool expected = wanted.at(x, y, 0) > 0.5f;
        (expected ? lit : dark) += 1;
        wrong += expected != (w.at(x, y, 0) > 0.5f);
      }
    const double all = lit + dark;
    EXPECT_GT(all, kSide * kSide / 4);
    EXPECT_GE(lit, least * all);
    EXPECT_GE(dark, least * all);
    return wrong / all;
  }

  /// Returns the RMS over the floor's pixels of what W is off by from the mean of the reference's places.
  double offTheMean(const Image& w, const Image& wanted) {
    const int samples = wanted.width() / kSide;
    double sum = 0;
    int counted = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (w.at(x, y, w.channel("Z")) <= 0) continue;
        float mean = 0;
        for (int i = 0; i < samples * samples; ++i)
          mean += wanted.at(samples * x + i % samples, samples * y + i / samples, 0);
        const float off = w.at(x, y, 0) - mean / static_cast<float>(samples * samples);
        sum += static_cast<double>(off * off);
        ++counted;
      }
    EXPECT_GT(counted, kSide * kSide / 4);
    return std::sqrt(sum / counted);
  }

  /// Expects that bumps, which are white, reflect to each other at each bounce no more than `most`. Returns
  /// the sums over the floor's pixels.
  std::pair<double, double> expectBoundedBounces(const scene::Scene& scene, int bounces = 4,
                                                 float most = 1.01f * kReceived,
                                                 const std::string& azimuths = "16") {
    std::pair<double, double> sums;
    for (const auto& [space, sum] : {std::pair("pixel", &sums.first), std::pair("texture", &sums.second)}) {
      SCOPED_TRACE(space);
      const render::TechniqueUse use =
          technique("bump_interreflection",
                    {{"space", space}, {"bounces", std::to_string(bounces)}, {"azimuths", azimuths}});
      forEachPoint(drawn(scene, Term::indirect, {use}), [&, sum = sum](float value, const glm::vec3&) {
        ASSERT_TRUE(value >= 0 && value <= most * static_cast<float>(bounces)) << value;
        *sum += static_cast<double>(value);
      });
    }
    return sums;
  }

  /// Expects in both spaces, in the mean over the floor, the reference's light of one bounce. What the bumps
  /// see of a low light is not what is asked for: it is that of many azimuths.
  void expectTrueBounce(const scene::Scene& scene) {
    const auto [pixel, texture] = expectBoundedBounces(scene, 1, 1.01f * kReceived, "128");
    const double wanted = trueBounce(scene);
    ASSERT_GT(wanted, 0);
    EXPECT_NEAR(pixel / wanted, 1, 0.05) << "pixel " << pixel << ", reference " << wanted;
    EXPECT_NEAR(texture / wanted, 1, 0.05) << "texture " << texture << ", reference " << wanted;
    EXPECT_NEAR(texture / pixel, 1, 0.03) << "texture " << texture << ", pixel " << pixel;
  }

  /// Expects that all shapes leave of direct light a part of [0, 1].
  void expectPartOfTheLight(const scene::Scene& scene) {
    const Image plain = drawn(scene, Term::direct, {});
    for (const std::string& shape : kShapes) {
      const Image image = drawn(scene, Term::direct, {technique("bump_horizon", {{"shape", shape}})});
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          ASSERT_TRUE(image.at(x, y, 0) >= 0 && image.at(x, y, 0) <= plain.at(x, y, 0)) << shape;
    }
  }
};

/// A map that lay another way would get about half of the pixels wrong; light at 18 degrees is hard for
/// ellipses.
TEST_F(BumpStabilityTest, MapsLieOnTheFloorAsInTheReference) {
  const std::vector<std::pair<const char*, Change>> changes{
      {"as it is", [](scene::Scene&) {}},
      {"u mirrored",
       [](scene::Scene& s) {
         moveCoordinates(s, [](const glm::vec2& uv) { return glm::vec2(1 - uv.x, uv.y); });
       }},
      {"v mirrored",
       [](scene::Scene& s) {
         moveCoordinates(s, [](const glm::vec2& uv) { return glm::vec2(uv.x, -uv.y); });
       }},
      {"u and v swapped",
       [](scene::Scene& s) {
         moveCoordinates(s, [](const glm::vec2& uv) { return glm::vec2(uv.y, uv.x); });
       }},
      {"turned, across seams",
       [](scene::Scene& s) {
         moveCoordinates(s, [](const glm::vec2& uv) {
           return glm::vec2(0.8f * uv.x - 0.6f * uv.y, 0.6f * uv.x + 0.8f * uv.y) + 7.3f;
         });
       }},
      {"mirrored by its node", [](scene::Scene& s) { s.nodes[0].transform.scale.x = -1; }}};
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    scene::Scene scene = floorUnder({1, 0.35f, 0.4f}, {noise(0.6)});
    change(scene);
    EXPECT_LT(wrongShare(scene, "march"), 0.01);
    EXPECT_LT(wrongShare(scene, "horizon_map"), 0.05);
    EXPECT_LT(wrongShare(scene, "moments"), 0.15);
  }
}

/// Stretched and sheared coordinates: the map's own metres decide, in the picture as in the reference.
TEST_F(BumpStabilityTest, CoordinatesMayBeSheared) {
  scene::Scene scene = floorUnder({1, 0.35f, 0.4f}, {noise(0.6)});
  moveCoordinates(scene,
                  [](const glm::vec2& uv) { return glm::vec2(1.3f * uv.x + 0.4f * uv.y, 0.8f * uv.y); });
  EXPECT_LT(wrongShare(scene, "march"), 0.01);
  EXPECT_LT(wrongShare(scene, "horizon_map"), 0.05);
  expectTrueBounce(scene);
}

TEST_F(BumpStabilityTest, ClampedMapsAreFollowedInside) {
  const scene::Scene scene = floorUnder({1, 0.35f, 0.4f}, {noise(0.6, relief::Wrap::clamped)});
  EXPECT_LT(wrongShare(scene, "march"), 0.01);
  EXPECT_LT(wrongShare(scene, "horizon_map"), 0.05);
  expectTrueBounce(scene);
}

TEST_F(BumpStabilityTest, VerticalStepsShadow) {
  std::vector<float> steps;
  for (int i = 0; i < 32; ++i) steps.push_back(i % 16 < 8 ? 0.f : 0.2f);
  const scene::Scene scene = floorUnder({1, 0.5f, 0}, {{{32, 1}, steps, glm::dvec2(2)}});
  EXPECT_LT(wrongShare(scene, "march"), 0.02);
  EXPECT_LT(wrongShare(scene, "horizon_map"), 0.06);
  const auto [pixel, texture] = expectBoundedBounces(scene);
  EXPECT_GT(pixel, 0);
  EXPECT_GT(texture, 0);
}

TEST_F(BumpStabilityTest, HeightsOfAnyScaleAndMapsOfAnySizeLeaveAPart) {
  for (const double scale : {0.0, 1e-4, 1e4, -1e4}) {
    SCOPED_TRACE(scale);
    expectPartOfTheLight(blocksOf({6, 6}, scale));
    const auto [pixel, texture] = expectBoundedBounces(blocksOf({6, 6}, scale));
    if (scale == 0) {
      EXPECT_EQ(pixel, 0);
      EXPECT_EQ(texture, 0);
    }
  }
  expectBoundedBounces(blocksOf({6, 6}, 1e-4), 1, 1e-3f);
  for (const glm::ivec2& size : {glm::ivec2(1, 36), glm::ivec2(36, 1)}) {
    SCOPED_TRACE(size.x);
    expectPartOfTheLight(blocksOf(size, 0.3));
    expectBoundedBounces(blocksOf(size, 0.3));
  }
  expectPartOfTheLight(floorUnder({1, 0.5f, 0.2f}, {{{1, 1}, {3}, glm::dvec2(2), -1e4}}));
}

/// Bumps that rise by 3 in ten thousand hide nothing of light that rises by a half.
TEST_F(BumpStabilityTest, LowBumpsHideNoLight) {
  for (const double scale : {0.0, 1e-4}) {
    const scene::Scene scene = blocksOf({6, 6}, scale);
    const Image plain = drawn(scene, Term::direct, {});
    EXPECT_GT(mean(plain), 0);
    for (const char* shape : {"horizon_map", "march"}) {
      const Image image = drawn(scene, Term::direct, {technique("bump_horizon", {{"shape", shape}})});
      EXPECT_TRUE(same(image, plain)) << shape << ", scale " << scale << ": mean " << mean(image) << " for "
                                      << mean(plain) << ", RMSE " << rmse(image, plain);
    }
  }
}

/// Between walls that rise by thousands the sun, which rises by a half, reaches nothing but the highest
/// summit, a point of the reference's and a texel here: of what a texel that faces the light receives, bumps
/// send each other a ninth, where the reference has a ten-thousandth.
TEST_F(BumpStabilityTest, TowersLeaveTheLightOfTheirSummit) {
  const scene::Scene scene = blocksOf({6, 6}, 1e4);
  EXPECT_LT(wrongShare(scene, "march", 0), 0.04);  // of pixels that face the light; a texel is 0.03 of all
  const auto [pixel, texture] = expectBoundedBounces(scene, 1);
  constexpr double pixels = kSide * kSide;  // the floor fills the picture
  const double wanted = trueBounce(scene) / pixels, most = 0.125 * static_cast<double>(kReceived);
  EXPECT_NEAR(pixel / pixels, wanted, most);
  EXPECT_NEAR(texture / pixels, wanted, most);
}

/// A ball seen from above its pole, where u turns once around within a few pixels. Next to the pole itself,
/// triangles have no place in the map that is theirs alone: those within three pixels do not count.
TEST_F(BumpStabilityTest, PolesOfABallAreShadowedAsInTheReference) {
  constexpr float elevation = 20 * glsl::pi / 180;
  scene::Scene scene = floorUnder({std::cos(elevation), std::sin(elevation), 0}, {noise(0.6)});
  scene::Primitive& ball = scene.meshes[0].primitives[0];
  // Rings are so narrow that normals of triangles are about those of the ball.
  ball = test::spherePrimitive(1, ball.material, 192);
  ball.tangents = scene::generateTangents(ball.positions, ball.normals, ball.uvs, ball.indices);
  const scene::CameraPose above = scene::lookAt({0, 3, 0.01f}, {0, 0, 0}, 0.7f);
  std::vector<std::string> shapes = kShapes;
  shapes.emplace_back("ambient");
  for (const std::string& shape : shapes) {
    SCOPED_TRACE(shape);
    const Image w =
        drawn(scene, Term::relief, {technique("bump_horizon", {{"shape", shape}})}, nullptr, above);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        ASSERT_TRUE(w.at(x, y, 0) >= 0 && w.at(x, y, 0) <= 1) << w.at(x, y, 0) << " at " << x << ',' << y;
  }
  EXPECT_LE(wrongShare(scene, "march", 0.1, above, 3), 0.02);
}

/// Heights turned over are those of the negative scale.
TEST_F(BumpStabilityTest, NegativeScalesTurnTheReliefOver) {
  const scene::Scene scene = floorUnder({1, 0.35f, 0.4f}, {noise(0.6, relief::Wrap::periodic, -2)});
  EXPECT_LT(wrongShare(scene, "march"), 0.01);
}

/// A pixel shows 9 x 9 texels. Means of so many err by 0.10, single texels, as horizon maps have them, by
/// 0.26.
TEST_F(BumpStabilityTest, FarTexelsAreMeans) {
  constexpr int tiles = 32;
  constexpr double tile = 2.0 / tiles;
  scene::Scene scene = floorUnder({1, 0.5f, 0.4f}, {noise(0.6, relief::Wrap::periodic, tile, tile)});
  moveCoordinates(scene, [](const glm::vec2& uv) { return static_cast<float>(tiles) * uv; });
  const Image wanted = truth(scene, 4);
  const auto off = [&](const char* shape) {
    return offTheMean(drawn(scene, Term::relief, {technique("bump_horizon", {{"shape", shape}})}), wanted);
  };
  const double ofMeans = off("moments");
  EXPECT_LT(ofMeans, 0.15);
  EXPECT_LT(ofMeans, 0.6 * off("horizon_map"));
}

/// The camera sees places whose bumps are turned away from it. Lambertian ones reflect towards it what they
/// receive all the same, metals no more than that.
TEST_F(BumpStabilityTest, BumpsTurnedAwayFromTheEyeReflectNoMoreThanTheyReceive) {
  constexpr int slope = 6;
  std::vector<float> values;
  for (int i = 0; i < 64; ++i) values.push_back(2.f / 64 * static_cast<float>(i));
  scene::Scene scene =
      floorUnder({0, 0.5f, -1}, {{{1, 64}, values, glm::dvec2(2), slope, 0, relief::Wrap::clamped}});
  const glm::vec3 n = glm::normalize(glm::vec3(0, 1, -slope)), l = glm::normalize(glm::vec3(0, 0.5f, -1));
  const float received = 2 * glm::dot(n, l);
  expectBoundedBounces(scene);
  for (const float metallic : {0.f, 1.f})
    for (const float roughness : {0.f, 0.3f, 1.f}) {
      scene.materials[0].metallic = metallic;
      scene.materials[0].roughness = roughness;
      int counted = 0;
      forEachPoint(drawn(scene, Term::direct, {technique("bump_horizon", {{"shape", "horizon_map"}})}),
                   [&](float value, const glm::vec3& p) {
                     if (std::abs(p.z + 0.3f) > 0.5f)
                       return;  // to the edge of the map, and to where the eye sees fronts
                     ASSERT_LT(glm::dot(n, glm::vec3(0, 2, 0.7f) - p), 0);
                     ASSERT_GE(value, 0);
                     ASSERT_LE(value, 1.01f * glsl::inverse_pi * received) << metallic << ' ' << roughness;
                     if (metallic == 0) {
                       ASSERT_NEAR(value, glsl::inverse_pi * received, 0.01f);
                     }
                     ++counted;
                   });
      EXPECT_GT(counted, 2000);
    }
}

}  // namespace
}  // namespace limn
