// What a floor and a wall reflect onto each other by virtual point lights, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "glsl/surface/brdf.glsl"
#include "tests/gpu/corner_scene.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

using IndirectTest = CornerTest;

/// The wall gets flux / pi cos cos / d^2 from the speck; the floor, which lies in its plane, nothing.
TEST_F(IndirectTest, AWallLitByASpeckOfTheFloor) {
  const Corner s;
  const Answer v = answer("reflective_shadow_map", s, {{"vpls", "64"}, {"block", "1"}, {"clamp", "0"}});
  int seen = 0;
  for (int y = 8; y < side; y += 8) {
    for (int x = 4; x < side; x += 8) {
      const uint32_t instance = v.instance[static_cast<size_t>(y * side + x)];
      if (instance == 0) {
        EXPECT_NEAR(v.at(0, x, y), 0, 2e-3f);
      }
      if (instance != 1) continue;
      const vec3 p = s.position(v, x, y);
      const double d2 = glm::dot(p, p), exact = s.flux / glsl::pi * p.y * p.x / (d2 * d2);
      EXPECT_NEAR(v.at(0, x, y), Corner::albedo / glsl::pi * exact, 0.02 * exact + 1e-3) << x << "," << y;
      ++seen;
    }
  }
  EXPECT_GT(seen, 30);
}

TEST_F(IndirectTest, ReceiversReflectWithTheirWholeBrdf) {
  scene::Material glossy = lambert(Corner::albedo);
  glossy.specularFactor = 1;
  glossy.roughness = 0.5f;
  Corner s;
  s.paintWall(glossy);
  const Answer v = answer("reflective_shadow_map", s, {{"vpls", "64"}, {"block", "1"}, {"clamp", "0"}});
  const vec3 eye(glm::inverse(s.camera.worldToView)[3]), n(-1, 0, 0);
  const glsl::SurfaceBrdf brdf = glsl::surface_brdf(vec3(Corner::albedo), 0, 0.5f, 1, vec3(1), 1.5f);
  int seen = 0;
  for (int y = 8; y < side; y += 8) {
    for (int x = 4; x < side; x += 8) {
      if (v.instance[static_cast<size_t>(y * side + x)] != 1) continue;
      const vec3 p = s.position(v, x, y);
      const double d2 = glm::dot(p, p), irradiance = s.flux / glsl::pi * p.y * p.x / (d2 * d2);
      const double exact = irradiance * glsl::brdf(brdf, n, glm::normalize(eye - p), glm::normalize(-p)).x;
      EXPECT_NEAR(v.at(0, x, y), exact, 0.03 * exact + 1e-3) << x << "," << y;
      ++seen;
    }
  }
  EXPECT_GT(seen, 30);
}

/// All of the wall, which is metal and so has no other part, lies within the bound of the speck's lights; the
/// sub-buffers of a block get nearly the same of it.
TEST_F(IndirectTest, TheBoundOfHighlightsDoesNotFallWithAHistory) {
  scene::Material metal = lambert(Corner::albedo);
  metal.metallic = 1;
  metal.roughness = 0.5f;
  Corner s;
  s.paintWall(metal);
  const auto ofWall = [&](const char* block, const char* history) {
    const Answer v = answer("reflective_shadow_map", s,
                            {{"vpls", "64"}, {"block", block}, {"clamp", "1"}, {"history", history}});
    double sum = 0;
    for (size_t i = 0; i < v.instance.size(); ++i)
      if (v.instance[i] == 1) sum += v.lights[0][i];
    return sum;
  };
  for (const char* block : {"1", "2"}) {
    const double once = ofWall(block, "1");
    ASSERT_GT(once, 0) << block;
    EXPECT_NEAR(ofWall(block, "16") / once, 1, 0.03) << block;
  }
}

/// The light of the speck came 1 m from the spot, to 0.13 %, in a medium that fills the corner's bounding
/// sphere: T = exp(-0.7). The way from there to the wall is free, as in the reference.
TEST_F(IndirectTest, TheMediumTakesOfTheLightThatIsReflected) {
  const Corner clear;
  Corner filled;
  filled.scene.medium.sigmaA = vec3(0.7f);
  for (const char* name :
       {"reflective_shadow_map", "instant_radiosity", "imperfect_shadow_maps", "clustered_visibility"}) {
    const auto light = [&](const Corner& s) {
      const Answer v = answer(name, s, {{"vpls", "64"}});
      return std::accumulate(v.lights[0].begin(), v.lights[0].end(), 0.0);
    };
    EXPECT_NEAR(light(filled) / light(clear), std::exp(-0.7), 0.003) << name;
  }
}

class PlateTest : public CornerTest {
 protected:
  void expectHides(const std::string& name, Settings settings, const Shadow& shadow) {
    Corner s;
    s.addPlate();
    settings.insert({"vpls", "64"});
    expectPlateHides(s, answer("reflective_shadow_map", s, {{"vpls", "64"}}), answer(name, s, settings),
                     shadow);
  }
};

TEST_F(PlateTest, HidesTheSpeckFromTheWall) {
  expectHides("instant_radiosity", {{"map_size", "256"}}, {0.02f, 0.01f, 0.05f, 500});
}

/// A texel of 64 is 2 to 4 degrees wide, 0.04 m on the plate; splats and filling move the edge by up to two,
/// and the map of one virtual light in 64 may miss there.
TEST_F(PlateTest, HidesTheSpeckWhenItIsMadeOfPoints) {
  expectHides("imperfect_shadow_maps", {{"points", "16384"}}, {0.15f, 0.03f, 0.1f, 500});
}

}  // namespace
}  // namespace limn
