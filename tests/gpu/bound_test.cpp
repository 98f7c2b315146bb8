// The bounds of techniques: they take the place of the kernel they bound, and answer what it answers.
#include "core/technique/bound.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

/// A ball over a floor under one light, seen from above.
struct LitBall {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera = scene::lookAt({0, 6, 3}, {0, 0.2f, 0}, 0.8f);

  explicit LitBall(const glsl::Light& light) {
    addMesh(scene, floorPrimitive(4, addMaterial(scene)));
    addMesh(scene, spherePrimitive(0.5f, 0, 64));
    addInstance(scene, pose, 0);
    addInstance(scene, pose, 1, at(0, 1, 0));
    addLight(pose, light);
  }
};

glsl::Light rectangle() {
  return rectangleLight({0.3f, 4, 0}, {0, -1, 0}, 0.8f, 0.6f);
}

class BoundTest : public TechniqueTest {
 protected:
  Answer answer(const LitBall& s, const std::string& technique,
                const std::map<std::string, std::string>& settings, bool ofBound) {
    bound = ofBound;
    return visibility(technique, settings, s.scene, s.pose, s.camera);
  }
};

/// The share of pixels in which two answers to one light differ by more than rounding to 16 bits.
double differing(const Answer& a, const Answer& b) {
  int count = 0;
  for (size_t i = 0; i < a.lights[0].size(); ++i)
    count += std::abs(a.lights[0][i] - b.lights[0][i]) > 2.0f / 65535 ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(a.lights[0].size());
}

struct Bounded {
  const char* technique;
  std::map<std::string, std::string> settings;
  bool exact;  ///< the bound makes the technique's decisions to the last tangent plane
};

const Bounded kBounded[] = {
    {"hard_shadow_map", {}, false},
    {"hard_shadow_map", {{"filter", "2x2"}}, false},
    {"pcf", {}, true},
    {"pcf", {{"kernel", "11.5"}}, true},
    {"pcss", {}, true},
    {"pcss", {{"pattern", "grid"}}, true},
    {"pcss", {{"search", "narrowed"}}, true},
    {"pcss", {{"search", "near"}}, true},
    {"savsm", {}, true},
    {"savsm", {{"pattern", "grid"}, {"sat_words", "1"}, {"shadow_map_size", "256"}}, true},
    {"cssm", {}, true},
    {"cssm", {{"filter", "mip"}, {"contact", "sharpened"}}, true},
    {"cssm", {{"contact", "plain"}, {"blocker_passes", "1"}}, true},
    {"moment_soft_shadow_map", {}, true},
    {"moment_soft_shadow_map", {{"direct_texels", "0"}, {"passes", "1"}}, true},
    {"backprojection", {}, true},
    {"backprojection", {{"patches", "8"}}, true},
    {"bitmask_soft_shadows", {}, true},
    {"bitmask_soft_shadows", {{"sample_points", "256"}, {"patches", "8"}}, true},
    {"sampled_area_light", {{"samples", "16"}}, false},
    {"sampled_area_light", {{"samples", "16"}, {"memory", "16"}}, false},  // in batches
};

TEST_F(BoundTest, BoundsAnswerWhatTheirTechniquesAnswer) {
  const LitBall s(rectangle());
  for (const Bounded& b : kBounded) {
    const Answer kernel = answer(s, b.technique, b.settings, false);
    const Answer least = answer(s, b.technique, b.settings, true);
    EXPECT_THAT(kernel.passes, testing::Not(testing::Contains(std::string(kBoundPass)))) << b.technique;
    EXPECT_THAT(least.passes, testing::Contains(std::string(kBoundPass))) << b.technique;
    EXPECT_THAT(least.passes, testing::Not(testing::Contains("visibility"))) << b.technique;
    EXPECT_THAT(least.lights[0], testing::Each(testing::AllOf(testing::Ge(0.f), testing::Le(1.f))))
        << b.technique;
    EXPECT_LT(*std::ranges::min_element(least.lights[0]), 0.5f) << b.technique << ": there is no shadow";
    // Exact ones differ where rounding moves a tap across the edge of a texel: with 96 taps, each within 1e-4
    // of an edge, and neighbours that disagree, fewer than 1 % of the pixels. Filters round the same sums,
    // which shows only where they make up for contact, on the ball's horizon. The others leave out the
    // tangent plane, which shows on the ball: 3 % of the pixels.
    EXPECT_LT(differing(kernel, least), b.exact ? 0.01 : 0.05) << b.technique;
  }
}

TEST_F(BoundTest, OnlyRectanglesInOneViewHaveABound) {
  for (const glsl::Light& light : {pointLight({1, 3, 0.5f}), directionalLight({0.3f, -1, 0.2f}, 0.2f)}) {
    const LitBall s(light);
    const Answer kernel = answer(s, "pcss", {}, false), asked = answer(s, "pcss", {}, true);
    EXPECT_THAT(asked.passes, testing::Contains("visibility"));
    EXPECT_EQ(asked.lights, kernel.lights);
  }
}

TEST_F(BoundTest, TechniquesSayWhetherTheyHaveOne) {
  for (const Bounded& b : kBounded) EXPECT_TRUE(hasBound(registry().find(b.technique))) << b.technique;
  for (const char* without : {"vssm", "airlight"})
    EXPECT_FALSE(hasBound(registry().find(without))) << without;
}

}  // namespace
}  // namespace limn
