// W of bumps where maps, coordinates and scales are unusual, against the reference.
#include <functional>

#include "core/reference/reference.h"
#include "core/scene/tangents.h"
#include "tests/gpu/bump_floor.h"
#include "tests/unit/relief/fields.h"

namespace limn {
namespace {

constexpr int kNoise = 48;  // texels along a side

class BumpStabilityTest : public BumpFloorTest {
 protected:
  using Change = std::function<void(scene::Scene&)>;

  /// The noise on one tile of the floor; a scale of 2 gives it that slope.
  static relief::HeightField noise(double slope, relief::Wrap wrap = relief::Wrap::periodic,
                                   double scale = 2) {
    const relief::HeightField field = relief::test::noise(kNoise, slope);
    std::vector<float> heights;
    for (int y = 0; y < kNoise; ++y)
      for (int x = 0; x < kNoise; ++x) heights.push_back(static_cast<float>(field.texel({x, y})));
    return {field.size(), heights, glm::dvec2(2), scale, 0, wrap};
  }

  /// Gives the floor's vertices the coordinates `uv` of theirs, and tangents that fit.
  static void moveCoordinates(scene::Scene& scene, const std::function<glm::vec2(const glm::vec2&)>& uv) {
    scene::Primitive& p = scene.meshes[0].primitives[0];
    for (glm::vec2& own : p.uvs) own = uv(own);
    p.tangents = scene::generateTangents(p.positions, p.normals, p.uvs, p.indices);
  }

  Image truth(const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    reference::Request request{
        .scene = scene, .pose = renderer.pose(), .camera = camera(), .width = kSide, .height = kSide};
    request.term = Term::relief;
    request.light = 0;
    request.spp = 2;
    return reference::render(request).image.select({"R"});
  }

  /// The share of the floor's pixels whose W differs from the reference's, where at least `least` of them are
  /// lit and as many dark.
  double wrongShare(const scene::Scene& scene, const std::string& shape, double least = 0.1) {
    const Image wanted = truth(scene);
    const Image w =
        drawn(scene, Term::relief, {technique("bump_horizon", {{"shape", shape}, {"steps", "256"}})});
    int wrong = 0, lit = 0, dark = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        if (w.at(x, y, w.channel("Z")) <= 0) continue;
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
}

TEST_F(BumpStabilityTest, ClampedMapsAreFollowedInside) {
  const scene::Scene scene = floorUnder({1, 0.35f, 0.4f}, {noise(0.6, relief::Wrap::clamped)});
  EXPECT_LT(wrongShare(scene, "march"), 0.01);
  EXPECT_LT(wrongShare(scene, "horizon_map"), 0.05);
}

TEST_F(BumpStabilityTest, VerticalStepsShadow) {
  std::vector<float> steps;
  for (int i = 0; i < 32; ++i) steps.push_back(i % 16 < 8 ? 0.f : 0.2f);
  const scene::Scene scene = floorUnder({1, 0.5f, 0}, {{{32, 1}, steps, glm::dvec2(2)}});
  EXPECT_LT(wrongShare(scene, "march"), 0.02);
  EXPECT_LT(wrongShare(scene, "horizon_map"), 0.06);
}

TEST_F(BumpStabilityTest, HeightsOfAnyScaleAndMapsOfAnySizeLeaveAPart) {
  std::vector<float> values;
  for (int i = 0; i < 36; ++i) values.push_back(static_cast<float>(i * 7 % 36) / 36);
  const auto floorWith = [&](const glm::ivec2& size, double scale) {
    return floorUnder({1, 0.5f, 0.2f}, {{size, values, glm::dvec2(2), scale}});
  };
  for (const double scale : {0.0, 1e-4, 1e4, -1e4}) {
    SCOPED_TRACE(scale);
    expectPartOfTheLight(floorWith({6, 6}, scale));
  }
  for (const glm::ivec2& size : {glm::ivec2(1, 36), glm::ivec2(36, 1)}) {
    SCOPED_TRACE(size.x);
    expectPartOfTheLight(floorWith(size, 0.3));
  }
  expectPartOfTheLight(floorUnder({1, 0.5f, 0.2f}, {{{1, 1}, {3}, glm::dvec2(2), -1e4}}));
}

/// Heights turned over are those of the negative scale.
TEST_F(BumpStabilityTest, NegativeScalesTurnTheReliefOver) {
  const scene::Scene scene = floorUnder({1, 0.35f, 0.4f}, {noise(0.6, relief::Wrap::periodic, -2)});
  EXPECT_LT(wrongShare(scene, "march"), 0.01);
}

}  // namespace
}  // namespace limn
