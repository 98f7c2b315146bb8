// Light below surfaces along rows and columns: pictures against closed forms, quadratures and the local
// limit.
#include <string>
#include <vector>

#include "tests/gpu/subsurface_spread.h"

namespace limn {
namespace {

using glm::vec3;

class SeparableSubsurfaceTest : public SubsurfaceSpreadTest {
 protected:
  SeparableSubsurfaceTest() : SubsurfaceSpreadTest("separable_subsurface") {}
};

TEST_F(SeparableSubsurfaceTest, UniformLightLeavesByTheReflectance) {
  for (const float absorption : {0.f, 0.04f}) {
    const scene::Material material = matter(30, absorption);
    const scene::Scene scene = lit(material, 5);
    const Image local = drawn(scene, Term::subsurface, {});
    for (const bool normalised : {false, true})
      for (const char* missing : {"centre", "mean"})
        EXPECT_LT(largestDifference(below(scene, {{"profile", kProfiles[normalised]}, {"missing", missing}}),
                                    local, reflectanceOverAlbedo(material, normalised)),
                  2e-3)  // the light falls by 1 / 800 towards the corners
            << kProfiles[normalised] << ' ' << missing;
  }
}

TEST_F(SeparableSubsurfaceTest, ShortPathsAreTheLocalLimit) {
  const scene::Material material = matter(1e6f, 0.04f);
  const scene::Scene scene = lit(material, kLit);
  const Image local = drawn(scene, Term::subsurface, {});
  for (const bool normalised : {false, true})
    EXPECT_LT(largestDifference(below(scene, {{"profile", kProfiles[normalised]}}), local,
                                reflectanceOverAlbedo(material, normalised)),
              1e-3)  // the G-buffer's index is off by up to 0.004
        << kProfiles[normalised];
}

TEST_F(SeparableSubsurfaceTest, EdgesOfShadowsSpreadAsLineIntegralsSay) {
  // A tap holds up to 1/40 of the light, a pixel at the edge, 12 to 20 mm wide, up to 1/10 of it.
  expectEdgesAsLineIntegralsSay({{"taps", "51"}}, 0.01);
}

TEST_F(SeparableSubsurfaceTest, AlbedosOfTheBaseColourAreThoseOfCoefficients) {
  expectAlbedosAsCoefficientsSay();
}

TEST_F(SeparableSubsurfaceTest, PixelsOfAnotherAlbedoAreWiderOrNarrower) {
  // Taps are those of the mean of the vertices' albedo and white, which those of a second floor have that is
  // not seen. Profiles of normalised diffusion differ by their widths alone.
  const auto withHidden = [](scene::Scene scene) {
    scene::Node& hidden = scene.nodes.emplace_back();
    hidden.mesh = test::addMesh(scene, test::floorPrimitive(1, 0));
    hidden.transform.translation = {0, -1, 0};
    return scene;
  };
  const Values values{{"profile", "normalised_diffusion"}};
  scene::Material material = matter(30, 0.2f);
  const Image wanted = belowShadow(withHidden(shadowed(material, {1, 0, 0}, 0)), values);
  const glm::vec4 albedo = material.baseColour;
  material.subsurface->albedoFromBaseColour = true;
  material.subsurface->absorption = vec3(0);
  material.baseColour = glm::vec4(1);
  scene::Scene scene = shadowed(material, {1, 0, 0}, 0);
  scene.meshes[0].primitives[0].colours.assign(scene.meshes[0].primitives[0].positions.size(), albedo);
  EXPECT_LT(rmsDifference(belowShadow(withHidden(scene), values), wanted), 0.01);
}

TEST_F(SeparableSubsurfaceTest, OtherBodiesGetNoLight) {
  // The shadow reaches a little further than the one of two bodies.
  const scene::Scene scene = shadowed(matter(30, 0.04f), {1, 0, 0}, 0.05f);
  EXPECT_GT(inTheDark(belowShadow(scene)), 1);
  EXPECT_EQ(inTheDark(belowShadow(halves(scene))), 0);
}

TEST_F(SeparableSubsurfaceTest, BodiesAreTheSameBesideOthers) {
  expectBodiesAreTheSameBesideOthers(shadowed(matter(30, 0.04f), {0, 0, 1}, 0),
                                     [&](const scene::Scene& scene) { return belowShadow(scene); });
}

TEST_F(SeparableSubsurfaceTest, ExtremesStayWithinTheLightThatEnters) {
  std::vector<Values> choices;
  for (const std::string& profile : kProfiles)
    for (const char* footprint : {"tangent", "facing"})
      choices.push_back({{"profile", profile}, {"footprint", footprint}});
  expectNoMoreThanEnters(choices);
}

TEST_F(SeparableSubsurfaceTest, ScenesWithoutTranslucentMaterialsAreLeftAlone) {
  expectOpaqueScenesLeftAlone();
}

}  // namespace
}  // namespace limn
