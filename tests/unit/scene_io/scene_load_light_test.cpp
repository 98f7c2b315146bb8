// What a loaded scene holds: lights and media.
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::test {
namespace {

using json = nlohmann::json;
using scene::kNone;
using scene::Scene;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(SceneLoad, Medium) {
  GltfBuilder b;
  b.append("scenes",
           {{"extras", {{"limn_medium", {{"sigma_a", 0.25}, {"sigma_s", {1, 2, 3}}, {"g", 0.5}}}}}});
  const Scene scene = loadBuilt(b);
  EXPECT_EQ(scene.medium.sigmaA, glm::vec3(0.25f));
  EXPECT_EQ(scene.medium.sigmaS, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.medium.g, 0.5f);
  EXPECT_TRUE(scene.medium.present());
  EXPECT_FALSE(scene.medium.inhomogeneous());
}

TEST(SceneLoad, Smoke) {
  GltfBuilder b;
  const json smoke = {{"low", {-1, 0, -2}}, {"high", {1, 3, 2}}, {"whirl", 0.5},
                      {"rise", 0.25},       {"seed", 7},         {"resolution", 40}};
  b.append("scenes", {{"extras", {{"limn_medium", {{"sigma_s", 1}, {"smoke", smoke}}}}}});
  const Scene scene = loadBuilt(b);
  ASSERT_TRUE(scene.medium.inhomogeneous());
  EXPECT_EQ(scene.medium.smoke->low, glm::vec3(-1, 0, -2));
  EXPECT_EQ(scene.medium.smoke->high, glm::vec3(1, 3, 2));
  EXPECT_EQ(scene.medium.smoke->whirl, 0.5f);
  EXPECT_EQ(scene.medium.smoke->rise, 0.25f);
  EXPECT_EQ(scene.medium.smoke->seed, 7u);
  EXPECT_EQ(scene.medium.smoke->resolution, 40);
}

TEST(SceneLoad, OnlyDirectionalLightsHaveAnAngle) {
  GltfBuilder b;
  b.light({{"type", "point"}, {"extras", {{"limn_angle", 0.1}}}});
  b.light({{"type", "point"}}, {{"extras", {{"limn_angle", 0.2}}}});
  b.light({{"type", "directional"}, {"extras", {{"limn_angle", 0.3}}}});
  b.light({{"type", "directional"}}, {{"extras", {{"limn_angle", 0.4}}}});
  const Scene scene = loadBuilt(b);
  ASSERT_EQ(scene.lights.size(), 5u) << "the last node has a light of its own";
  EXPECT_EQ(scene.lights[0].angle, 0);
  EXPECT_EQ(scene.lights[1].angle, 0);
  EXPECT_EQ(scene.lights[2].angle, 0.3f);
  EXPECT_EQ(scene.lights[4].angle, 0.4f);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("light 0: limn_angle has a meaning for directional"),
                                          HasSubstr("node 1: limn_angle has a meaning for directional")));
}

TEST(SceneLoad, SpotsShineThroughTextures) {
  GltfBuilder b;
  b.texturedMaterial(png(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}));
  b.light({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"extras", {{"limn_texture", 0}}}});
  b.light({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"extras", {{"limn_texture", 0}}}});
  b.light({{"type", "point"}, {"extras", {{"limn_texture", 0}}}});
  const Scene scene = loadBuilt(b);
  ASSERT_EQ(scene.lightTextures.size(), 1u) << "one image is one texture";
  EXPECT_EQ(scene.lights[0].texture, 0);
  EXPECT_EQ(scene.lights[1].texture, 0);
  EXPECT_EQ(scene.lights[2].texture, kNone);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("only spots")));
  const auto& texels = scene.lightTextures[0].texels;
  constexpr int side = scene::LightTexture::side;
  EXPECT_EQ(texels[0], glm::vec3(0, 0, 1)) << "lower left";
  EXPECT_EQ(texels[side - 1], glm::vec3(1));
  EXPECT_EQ(texels[size_t{side} * (side - 1)], glm::vec3(1, 0, 0)) << "upper left";
}

}  // namespace
}  // namespace limn::test
