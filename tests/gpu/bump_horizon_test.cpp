// What bumps of height maps leave of light, against closed forms and pictures without them.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/base/error.h"
#include "core/scene/camera.h"
#include "tests/gpu/bump_floor.h"

namespace limn {
namespace {

class BumpHorizonTest : public BumpFloorTest {
 protected:
  /// The share of points whose W is not that of the closed form: under light that rises by 1/2 against walls
  /// that rise by 1, those are lit that lie at most a third of the way from a crest to the next one towards
  /// the light. `axis`: of the world, along which grooves repeat and light comes; `sign`: from which end.
  double wrongInGrooves(const std::string& shape, int axis, float sign) {
    glm::vec3 towards(0, 0.5f, 0);
    towards[axis] = sign;
    const scene::Scene scene = floorUnder(towards, {groove(axis == 2)});
    const Image w =
        drawn(scene, Term::relief, {technique("bump_horizon", {{"shape", shape}, {"steps", "256"}})});
    int wrong = 0, counted = 0, lit = 0;
    forEachPoint(w, [&](float value, const glm::vec3& p) {
      const float texel = 0.5f * (p[axis] + 1) * kTexels - 0.5f;  // crests at 0 and kTexels
      const float way = (sign > 0 ? texel : kTexels - texel) / kTexels;
      const float edges = std::min({std::abs(way), std::abs(way - 1), std::abs(way - 1 / 3.f)});
      if (edges * kTexels < 2) return;
      const bool expected = way < 1 / 3.f;
      ++counted;
      lit += expected;
      wrong += expected != (value > 0.5f);
    });
    EXPECT_GT(counted, 4000);
    EXPECT_GT(lit, 500);
    return static_cast<double>(wrong) / counted;
  }
};

TEST_F(BumpHorizonTest, AFlatFieldChangesNoBit) {
  const scene::Scene scene = floorUnder({1, 1, 0.5f}, {flat()});
  const Image plain = drawn(scene, Term::direct, {});
  EXPECT_GT(mean(plain), 0);
  for (const std::string& shape : kShapes)
    EXPECT_TRUE(same(drawn(scene, Term::direct, {technique("bump_horizon", {{"shape", shape}})}), plain))
        << shape;
}

/// Whatever part of the light lies above the base: at 2 degrees more than a third of it does not.
TEST_F(BumpHorizonTest, AFlatFieldHidesNothingOfALightWithASize) {
  for (const int elevation : {2, 5, 10, 20, 45, 90})
    for (const char* shape : {"moments", "nearest"}) {
      const float angle = glm::radians(static_cast<float>(elevation));
      scene::Scene scene = floorUnder({std::cos(angle), std::sin(angle), 0.3f * std::cos(angle)}, {flat()});
      scene.lights[0].angle = 2 * std::asin(0.15f);
      const Image w =
          drawn(scene, Term::relief, {technique("bump_horizon", {{"shape", shape}, {"soft", "true"}})});
      forEachPoint(w,
                   [&](float value, const glm::vec3&) { ASSERT_EQ(value, 1) << shape << ' ' << elevation; });
    }
}

TEST_F(BumpHorizonTest, GroovesAreShadowedAsTheClosedFormSays) {
  for (const int axis : {0, 2})
    for (const float sign : {-1.f, 1.f}) {
      EXPECT_EQ(wrongInGrooves("horizon_map", axis, sign), 0) << axis << ' ' << sign;
      EXPECT_EQ(wrongInGrooves("march", axis, sign), 0) << axis << ' ' << sign;
      EXPECT_LT(wrongInGrooves("moments", axis, sign), 0.3) << axis << ' ' << sign;
      EXPECT_LT(wrongInGrooves("published", axis, sign), 0.3) << axis << ' ' << sign;
    }
}

/// Walls of 45 degrees: a point at a share x of the way from one crest to the next sees, across the grooves,
/// from one crest to the other, and all along them. W is the same under any light above the base.
TEST_F(BumpHorizonTest, AmbientVisibilityIsThatOfAGroove) {
  const render::TechniqueUse ambient = technique("bump_horizon", {{"shape", "ambient"}, {"azimuths", "128"}});
  const Image high = drawn(floorUnder({0, 1, 0.1f}, {groove()}), Term::relief, {ambient}),
              low = drawn(floorUnder({1, 0.1f, 0}, {groove()}), Term::relief, {ambient});
  double worst = 0;
  forEachPoint(high, [&](float value, const glm::vec3& p) {
    const float texel = 0.5f * (p.x + 1) * kTexels - 0.5f;
    const float x = std::clamp(texel / kTexels, 0.f, 1.f), depth = std::min(x, 1 - x);
    // Of an endless strip of sky the cosine-weighted share is half the sum of the sines of its half angles.
    const float exact =
        0.5f * (glm::normalize(glm::vec2(x, depth)).x + glm::normalize(glm::vec2(1 - x, depth)).x);
    if (depth * kTexels > 2 && std::abs(0.5f - x) * kTexels > 2)
      worst = std::max(worst, std::abs(static_cast<double>(value) - static_cast<double>(exact)));
  });
  EXPECT_LT(worst, 0.03);
  EXPECT_GT(mean(high), 0.5);
  forEachPoint(low, [&](float value, const glm::vec3&) { ASSERT_GT(value, 0.3f); });
}

/// 128 grooves of 32 texels, whose walls rise by 2. A pixel shows 20 texels or more, so that what it looks up
/// are means over at least half a groove, which differ by .018 from that over a whole one. The closed form's
/// mean is .620; a crest sees all of the sky instead of .72 of it, which makes .629 with one texel in 32.
TEST_F(BumpHorizonTest, AmbientVisibilityOfNarrowGroovesIsTheirMean) {
  constexpr int period = 32, texels = 128 * period;
  std::vector<float> values;
  for (int i = 0; i < texels; ++i)
    values.push_back(static_cast<float>(std::abs(i % period - period / 2)) / texels);
  // Of a tile of 2 m a texel is 2 / texels m wide.
  const relief::HeightField grooves({texels, 1}, values, glm::dvec2(2), 4);
  const render::TechniqueUse ambient = technique("bump_horizon", {{"shape", "ambient"}, {"azimuths", "128"}});
  double sum = 0;
  int counted = 0;
  forEachPoint(drawn(floorUnder({0, 1, 0.1f}, {grooves}), Term::relief, {ambient}),
               [&](float value, const glm::vec3&) {
                 EXPECT_NEAR(value, 0.629f, 0.03f);
                 sum += static_cast<double>(value);
                 ++counted;
               });
  ASSERT_GT(counted, 4000);
  EXPECT_NEAR(sum / counted, 0.629, 0.01);
}

TEST_F(BumpHorizonTest, LightOfAnyHeightIsFinite) {
  for (const float height : {1000.f, 0.5f, 1e-4f, 0.f, -0.5f}) {
    const scene::Scene scene = floorUnder({1, height, 0.2f}, {groove()});
    for (const std::string& shape : kShapes)
      for (const char* soft : {"false", "true"}) {
        SCOPED_TRACE(shape);
        const render::TechniqueUse use = technique("bump_horizon", {{"shape", shape}, {"soft", soft}});
        forEachPoint(drawn(scene, Term::relief, {use}), [&](float w, const glm::vec3&) {
          ASSERT_TRUE(w >= 0 && w <= 1);
          if (height < 0) {
            ASSERT_EQ(w, 0) << "from below the base";
          }
        });
        const Image lit = drawn(scene, Term::direct, {use});
        for (const float value : lit.data()) ASSERT_TRUE(std::isfinite(value));
      }
  }
}

/// Along a line straight up nothing is higher than where it begins, and no azimuth is its own.
TEST_F(BumpHorizonTest, LightExactlyAtTheZenithIsSeenFromEverywhere) {
  scene::Scene scene = floorUnder({0, 1, 0}, {groove()});
  scene.nodes[1].transform.rotation = glm::quat(0.5f, -0.5f, 0.5f, 0.5f);  // without a rounding
  for (const std::string& shape : kShapes) {
    SCOPED_TRACE(shape);
    const bool exact = shape == "horizon_map" || shape == "march" || shape == "scan";
    for (const char* soft : {"false", "true"})
      forEachPoint(
          drawn(scene, Term::relief, {technique("bump_horizon", {{"shape", shape}, {"soft", soft}})}),
          [&](float w, const glm::vec3&) {
            ASSERT_TRUE(w >= 0 && w <= 1);
            if (exact) {
              ASSERT_EQ(w, 1);
            }
          });
  }
}

TEST_F(BumpHorizonTest, DirectLightIsTheUnshadowedTimesW) {
  const scene::Scene scene = floorUnder({1, 0.5f, 0.3f}, {groove()});
  const render::TechniqueUse bumps = technique("bump_horizon", {{"shape", "horizon_map"}});
  const Image plain = drawn(scene, Term::direct, {}), w = drawn(scene, Term::relief, {bumps}),
              lit = drawn(scene, Term::direct, {bumps}),
              both = drawn(scene, Term::direct, {technique("hard_shadow_map"), bumps});
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      ASSERT_EQ(lit.at(x, y, 0), plain.at(x, y, 0) * w.at(x, y, 0)) << x << ',' << y;
      ASSERT_EQ(both.at(x, y, 0), lit.at(x, y, 0)) << x << ',' << y;
    }
}

TEST_F(BumpHorizonTest, ScenesWithoutHeightMapsAreLeftAlone) {
  const scene::Scene scene = floorUnder({1, 1, 0.5f}, {});
  std::vector<frame::PassReport> passes;
  const Image plain = drawn(scene, Term::direct, {}),
              asked = drawn(scene, Term::direct, {technique("bump_horizon")}, &passes);
  EXPECT_TRUE(same(asked, plain));
  EXPECT_TRUE(same(drawn(scene, Term::final, {technique("bump_horizon")}), drawn(scene, Term::final, {})));
  bool said = false;
  for (const frame::PassReport& pass : passes) {
    for (const frame::AccessReport& access : pass.accesses) EXPECT_NE(access.resource, "tangent");
    if (pass.technique != "bump_horizon") continue;
    EXPECT_EQ(pass.state, frame::PassState::leftOut);
    said = said || pass.reason == "no material has a height map";
  }
  EXPECT_TRUE(said);
  const Image w = drawn(scene, Term::relief, {technique("bump_horizon")});
  forEachPoint(w, [](float value, const glm::vec3&) { ASSERT_EQ(value, 1); });
}

TEST_F(BumpHorizonTest, IsRefusedBesideDirectLight) {
  const scene::Scene scene = floorUnder({1, 1, 0.5f}, {flat()});
  render::Renderer renderer(device(), scene);
  for (const TechniquePlugin* plugin : registry().all()) {
    if (!contains(plugin->info->terms, Term::direct)) continue;
    EXPECT_THROW(renderer.configure(
                     settings(8, 8, Term::final, {technique("bump_horizon"), technique(plugin->info->name)})),
                 UsageError)
        << plugin->info->name;
  }
}

}  // namespace
}  // namespace limn
