// Light below surfaces spread in textures: pictures against closed forms, quadratures and the local limit.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/gpu/subsurface_ball.h"
#include "tests/gpu/subsurface_spread.h"

namespace limn {
namespace {

using glm::vec3;

class TextureSpaceSubsurfaceTest : public SubsurfaceSpreadTest {
 protected:
  TextureSpaceSubsurfaceTest() : SubsurfaceSpreadTest("texture_space_subsurface") {}
};

TEST_F(TextureSpaceSubsurfaceTest, UniformLightLeavesByTheReflectance) {
  for (const float absorption : {0.f, 0.04f}) {
    const scene::Material material = matter(30, absorption);
    const scene::Scene scene = lit(material, 5);
    const Image local = drawn(scene, Term::subsurface, {});
    for (const bool normalised : {false, true})
      for (const char* gaussians : {"1", "6", "12"})
        EXPECT_LT(
            largestDifference(below(scene, {{"profile", kProfiles[normalised]}, {"gaussians", gaussians}}),
                              local, reflectanceOverAlbedo(material, normalised)),
            2e-3)  // the light falls by 1 / 800 towards the corners
            << kProfiles[normalised] << ' ' << gaussians;
  }
}

TEST_F(TextureSpaceSubsurfaceTest, ShortPathsAreTheLocalLimit) {
  const scene::Material material = matter(1e6f, 0.04f);
  const scene::Scene scene = lit(material, kLit);
  const Image local = drawn(scene, Term::subsurface, {});
  for (const char* texels : {"16", "256"})
    EXPECT_LT(
        largestDifference(below(scene, {{"texels", texels}}), local, reflectanceOverAlbedo(material, false)),
        1e-3)  // the G-buffer's index is off by up to 0.004
        << texels;
}

TEST_F(TextureSpaceSubsurfaceTest, EdgesOfShadowsSpreadAsLineIntegralsSay) {
  expectEdgesAsLineIntegralsSay({{"texels", "512"}}, 0.01);
}

TEST_F(TextureSpaceSubsurfaceTest, AlbedosOfTheBaseColourAreThoseOfCoefficients) {
  expectAlbedosAsCoefficientsSay();
}

// Gaussians of the white material that is left without the vertices' colours would be several times as wide.
TEST_F(TextureSpaceSubsurfaceTest, AlbedosOfVerticesAreThoseOfCoefficients) {
  scene::Material material = matter(30, 0.2f);
  const Image wanted = belowShadow(shadowed(material, {1, 0, 0}, 0));
  const glm::vec4 albedo = material.baseColour;
  material.subsurface->albedoFromBaseColour = true;
  material.subsurface->absorption = vec3(0);
  material.baseColour = glm::vec4(1);
  scene::Scene scene = shadowed(material, {1, 0, 0}, 0);
  scene::Primitive& floor = scene.meshes[0].primitives[0];
  floor.colours.assign(floor.positions.size(), albedo);
  EXPECT_LT(rmsDifference(belowShadow(scene), wanted), 0.01);
}

TEST_F(TextureSpaceSubsurfaceTest, OtherBodiesGetNoLight) {
  // The shadow reaches a little further than the one of two bodies.
  const scene::Scene scene = shadowed(matter(30, 0.04f), {1, 0, 0}, 0.05f);
  EXPECT_GT(inTheDark(belowShadow(scene)), 1);
  EXPECT_EQ(inTheDark(belowShadow(halves(scene))), 0);
}

TEST_F(TextureSpaceSubsurfaceTest, LightThatEntersBesideThePictureLeavesInIt) {
  const scene::Scene scene = shadowed(matter(8, 0.001f), {1, 0, 0}, 0.95f);
  double entering = 0, leaving = 0;
  forEachPoint(drawn(scene, Term::subsurface, {technique("hard_shadow_map", {{"shadow_map_size", "2048"}})}),
               [&](float value, const vec3&) { entering += static_cast<double>(value); });
  forEachPoint(belowShadow(scene), [&](float value, const vec3&) { leaving += static_cast<double>(value); });
  EXPECT_EQ(entering, 0) << "the camera sees the shadow alone";
  EXPECT_GT(leaving, 10);
}

TEST_F(TextureSpaceSubsurfaceTest, ExtremesStayWithinTheLightThatEnters) {
  std::vector<Values> choices;
  for (const std::string& profile : kProfiles)
    for (const char* texels : {"16", "256"}) choices.push_back({{"profile", profile}, {"texels", texels}});
  expectNoMoreThanEnters(choices);
}

TEST_F(TextureSpaceSubsurfaceTest, ScenesWithoutTranslucentMaterialsAreLeftAlone) {
  expectOpaqueScenesLeftAlone();
}

TEST_F(TextureSpaceSubsurfaceTest, GaussiansThatAreNotSpreadHaveNoPasses) {
  const auto spreads = [&](float extinction) {
    std::vector<frame::PassReport> passes;
    drawn(lit(matter(extinction, 0.04f), kLit), Term::subsurface, {technique("texture_space_subsurface")},
          &passes);
    int count = 0;
    for (const frame::PassReport& pass : passes)
      count += pass.technique == "texture_space_subsurface" && pass.state == frame::PassState::run &&
               (pass.name.starts_with("rows") || pass.name.starts_with("columns"));
    return count;
  };
  EXPECT_EQ(spreads(1e6f), 0);
  EXPECT_GT(spreads(400), 2);
  EXPECT_LT(spreads(400), 12);
  EXPECT_EQ(spreads(1), 12);
}

TEST_F(TextureSpaceSubsurfaceTest, BodiesOfMoreChartsThanFitHaveTheLocalLimitAndAreNamed) {
  const scene::Material material = matter(30, 0.04f);
  scene::Scene scene = lit(material, kLit);
  scene::Primitive& floor = scene.meshes[0].primitives[0];
  const scene::Primitive one = floor;
  for (int i = 1; i < 30; ++i) {  // one over the other, and none touches another
    const auto first = static_cast<uint32_t>(floor.positions.size());
    for (size_t k = 0; k < one.positions.size(); ++k) {
      floor.positions.push_back(one.positions[k] - vec3(0, 0.1f * static_cast<float>(i), 0));
      floor.normals.push_back(one.normals[k]);
      if (!one.uvs.empty()) floor.uvs.push_back(one.uvs[k]);
    }
    for (const uint32_t k : one.indices) floor.indices.push_back(first + k);
  }
  floor = test::finish(std::move(floor));
  std::vector<frame::PassReport> passes;
  const Image seen =
      drawn(scene, Term::subsurface, {technique("texture_space_subsurface", {{"texels", "16"}})}, &passes);
  EXPECT_LT(
      largestDifference(seen, drawn(scene, Term::subsurface, {}), reflectanceOverAlbedo(material, false)),
      1e-3);
  EXPECT_TRUE(std::ranges::any_of(passes, [](const frame::PassReport& pass) {
    return pass.name == "lay finely cut surfaces out" && pass.reason.starts_with("1 bodies");
  }));
}

TEST_F(TextureSpaceSubsurfaceTest, TexturesLargerThanTheirMemoryAreRefused) {
  scene::Scene scene = lit(matter(30, 0.04f), kLit);
  for (int i = 0; i < 2; ++i) scene.nodes.push_back(scene.nodes[0]);
  try {
    below(scene, {{"texels", "4096"}});
    FAIL() << "three textures of 1.5 GiB";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("4096 x 4096"), std::string::npos) << error.what();
  }
  scene.materials[0] = matter(1e6f, 0.04f);
  EXPECT_NO_THROW(below(scene, {{"texels", "4096"}})) << "no texture is made where no light is spread";
}

class TextureSpaceBallTest : public SubsurfaceBallTest {};

// Six charts: light crosses their borders.
TEST_F(TextureSpaceBallTest, BallsUnderLightFromTheSideMeetTheirWholeIntegral) {
  constexpr float kMeanDistances = 10;
  double squares = 0, largest = 0;
  int index = 0, counted = 0;
  forEachPoint(drawn(ball(kMeanDistances), Term::subsurface,
                     {technique("texture_space_subsurface", {{"texels", "512"}})}),
               [&](float value, const vec3& p) {
                 if (index++ % 11 != 0) return;
                 const vec3 normal = glm::normalize(p);
                 const double error = (static_cast<double>(value) / shownOfOne(p, normal) -
                                       meanOverBall(normal, kMeanDistances)) /
                                      entering(1);
                 squares += error * error;
                 largest = std::max(largest, std::abs(error));
                 ++counted;
               });
  EXPECT_GT(counted, 500);
  EXPECT_LT(std::sqrt(squares / counted), 0.02);
  EXPECT_LT(largest, 0.1);
}

TEST_F(TextureSpaceBallTest, BallsUnderLightFromTheSideGainNothing) {
  for (const float meanDistances : {10.f, 3.f, 0.7f})
    forEachPoint(
        drawn(ball(meanDistances), Term::subsurface, {technique("texture_space_subsurface")}),
        [&](float value, const vec3& p) {
          EXPECT_LE(static_cast<double>(value), 1.002 * shownOfOne(p, glm::normalize(p)) * entering(1))
              << meanDistances;
        });
}

}  // namespace
}  // namespace limn
