// Light below surfaces along rows and columns: pictures against closed forms, quadratures and the local
// limit.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "glsl/diffusion/normalised.glsl"
#include "techniques/separable_subsurface/line_kernel.h"
#include "tests/gpu/two_bodies.h"

namespace limn {
namespace {

using glm::vec3;
using Values = std::vector<std::pair<std::string, std::string>>;

constexpr float kIor = 1.3f;
constexpr float kLit = 0.5f;   ///< radius of the spot's light on the floor, m
constexpr float kHeight = 40;  ///< of the spot, m
const std::vector<std::string> kProfiles{"dipole", "normalised_diffusion"};

class SeparableSubsurfaceTest : public TwoBodiesTest {
 protected:
  static scene::Material matter(float extinction, float absorption, float ior = kIor) {
    const glsl::WalkReflectance walk = glsl::walk_reflectance(glsl::diffusion_boundary(ior));
    scene::Material material;
    material.metallic = 0;
    material.specularFactor = 0;
    material.ior = ior;
    material.baseColour = glm::vec4(vec3(glsl::walk_albedo(walk, absorption)), 1);
    material.subsurface = scene::Subsurface{.extinction = vec3(extinction), .absorption = vec3(absorption)};
    return material;
  }

  /// A floor of 2 m x 2 m under a spot far above it, which lights a disc of that radius.
  static scene::Scene lit(const scene::Material& material, float radius) {
    scene::Scene scene = floorUnder({0, 1, 0}, {});
    scene.materials[0] = material;
    scene::LightSource& light = scene.lights[0];
    light.type = glsl::light_spot;
    light.intensity = kHeight * kHeight;
    light.outerCone = std::atan(radius / kHeight);
    light.innerCone = 0.9999f * light.outerCone;
    scene.nodes.back().transform.translation = {0, kHeight, 0};
    return scene;
  }

  /// Light from straight above a floor, none of which a plate above the camera lets through to where
  /// dot(place, side) < edge. The whole scene is turned by `turn`.
  static scene::Scene shadowed(const scene::Material& material, const vec3& side, float edge,
                               const glm::quat& turn = glm::quat(1, 0, 0, 0)) {
    scene::Scene scene = floorUnder({0, 1, 0}, {});
    scene.materials[0] = material;
    scene::Node plate;
    plate.mesh = test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
    plate.transform.translation = vec3(0, 3, 0) + (edge - 2) * side;
    scene.nodes.push_back(plate);
    for (scene::Node& node : scene.nodes) {
      node.transform.translation = turn * node.transform.translation;
      node.transform.rotation = turn * node.transform.rotation;
    }
    return scene;
  }

  Image belowShadow(const scene::Scene& scene, const Values& values = {}) {
    return drawn(scene, Term::subsurface,
                 {technique("hard_shadow_map", {{"shadow_map_size", "2048"}}),
                  technique("separable_subsurface", values)});
  }

  Image below(const scene::Scene& scene, const Values& values = {}) {
    return drawn(scene, Term::subsurface, {technique("separable_subsurface", values)});
  }

  /// The largest of |a / b / ratio - 1| over the points that b lights.
  static double largestDifference(const Image& a, const Image& b, double ratio = 1) {
    double largest = 0;
    int counted = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto wanted = static_cast<double>(b.at(x, y, 0)) * ratio;
        const auto seen = static_cast<double>(a.at(x, y, 0));
        if (wanted == 0) {
          EXPECT_EQ(seen, 0);
          continue;
        }
        largest = std::max(largest, std::abs(seen / wanted - 1));
        ++counted;
      }
    EXPECT_GT(counted, 1500);
    return largest;
  }

  /// RMS of a - b over that of b.
  static double rmsDifference(const Image& a, const Image& b) {
    double error = 0, power = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto wanted = static_cast<double>(b.at(x, y, 0));
        error += std::pow(static_cast<double>(a.at(x, y, 0)) - wanted, 2);
        power += wanted * wanted;
      }
    return std::sqrt(error / power);
  }

  /// C of a profile over the albedo of the local limit.
  static double reflectanceOverAlbedo(const scene::Material& material, bool normalised) {
    const auto profile = separable_subsurface::profileOf(
        material.subsurface->extinction, material.subsurface->absorption, material.ior, normalised);
    return profile[0].reflectance / static_cast<double>(material.baseColour.x);
  }
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
  const scene::Material material = matter(30, 0.04f);
  for (const float degrees : {0.f, -35.f}) {  // seen at 19 and at 54 degrees
    const glm::quat turn = glm::angleAxis(glm::radians(degrees), vec3(1, 0, 0));
    for (const vec3 side : {vec3(1, 0, 0), vec3(0, 0, 1)}) {
      const scene::Scene scene = shadowed(material, side, 0, turn);
      const Image whole = drawn(scene, Term::subsurface, {});
      std::vector<double> lit;
      forEachPoint(whole, [&](float value, const vec3&) { lit.push_back(static_cast<double>(value)); });
      for (const bool normalised : {false, true}) {
        const auto profile = separable_subsurface::profileOf(
            material.subsurface->extinction, material.subsurface->absorption, kIor, normalised)[0];
        const double ratio = reflectanceOverAlbedo(material, normalised);
        double squares = 0;
        size_t index = 0;
        int counted = 0;
        forEachPoint(belowShadow(scene, {{"profile", kProfiles[normalised]}, {"taps", "51"}}),
                     [&](float value, const vec3& p) {
                       const double all = lit[index++] * ratio;
                       const vec3 place = glm::inverse(turn) * p;
                       const auto x = static_cast<double>(dot(place, side));
                       if (std::abs(place.x) > 0.4f || std::abs(place.z) > 0.4f) return;
                       const double share = separable_subsurface::lineShare(profile, std::abs(x));
                       const double error =
                           static_cast<double>(value) / all - 0.5 - std::copysign(0.5 * share, x);
                       squares += error * error;
                       ++counted;
                     });
        // A tap holds up to 1/40 of the light, a pixel at the edge, 12 to 20 mm wide, up to 1/10 of it.
        EXPECT_GT(counted, 2000);
        EXPECT_LT(std::sqrt(squares / counted), 0.01)
            << kProfiles[normalised] << ' ' << side.x << ' ' << degrees;
      }
    }
  }
}

TEST_F(SeparableSubsurfaceTest, AlbedosOfTheBaseColourAreThoseOfCoefficients) {
  for (const float absorption : {0.001f, 0.2f}) {
    scene::Material material = matter(30, absorption);
    const scene::Scene coefficients = lit(material, kLit);
    material.subsurface->albedoFromBaseColour = true;
    const scene::Scene albedo = lit(material, kLit);
    for (const std::string& profile : kProfiles) {
      const Image wanted = below(coefficients, {{"profile", profile}});
      // Taps fall into other pixels where widths differ by rounding.
      EXPECT_LT(rmsDifference(below(albedo, {{"profile", profile}}), wanted), 2e-3)
          << profile << ' ' << absorption;
    }
  }
}

TEST_F(SeparableSubsurfaceTest, PixelsOfAnotherAlbedoAreWiderOrNarrower) {
  // Taps are those of a white material, and the albedo is that of vertices. Profiles of normalised diffusion
  // differ by their widths alone.
  const Values values{{"profile", "normalised_diffusion"}};
  scene::Material material = matter(30, 0.2f);
  const Image wanted = belowShadow(shadowed(material, {1, 0, 0}, 0), values);
  const glm::vec4 albedo = material.baseColour;
  material.subsurface->albedoFromBaseColour = true;
  material.subsurface->absorption = vec3(0);
  material.baseColour = glm::vec4(1);
  scene::Scene scene = shadowed(material, {1, 0, 0}, 0);
  scene.meshes[0].primitives[0].colours.assign(scene.meshes[0].primitives[0].positions.size(), albedo);
  EXPECT_LT(rmsDifference(belowShadow(scene, values), wanted), 0.01);
}

TEST_F(SeparableSubsurfaceTest, OtherBodiesGetNoLight) {
  // The shadow reaches a little further than the one of two bodies.
  const scene::Scene scene = shadowed(matter(30, 0.04f), {1, 0, 0}, 0.05f);
  EXPECT_GT(inTheDark(belowShadow(scene)), 1);
  EXPECT_EQ(inTheDark(belowShadow(halves(scene))), 0);
}

TEST_F(SeparableSubsurfaceTest, ExtremesStayWithinTheLightThatEnters) {
  for (const float extinction : {1e-6f, 1.f, 1e9f})
    for (const float absorption : {0.f, 1e-5f, 1.f})
      for (const float ior : {1.f, 3.f}) {
        scene::Material material = matter(extinction, absorption, ior);
        material.baseColour = glm::vec4(1);
        const scene::Scene scene = lit(material, kLit);
        const Image entering = drawn(lit(material, 5), Term::subsurface, {});
        for (const std::string& profile : kProfiles)
          for (const char* footprint : {"tangent", "facing"}) {
            const Image seen = below(scene, {{"profile", profile}, {"footprint", footprint}});
            for (int y = 0; y < kSide; ++y)
              for (int x = 0; x < kSide; ++x) {
                EXPECT_GE(seen.at(x, y, 0), 0);
                EXPECT_LE(seen.at(x, y, 0), 1.0001f * entering.at(x, y, 0));
              }
          }
      }
}

TEST_F(SeparableSubsurfaceTest, ScenesWithoutTranslucentMaterialsAreLeftAlone) {
  const scene::Scene scene = floorUnder({1, 1, 0.5f}, {});
  std::vector<frame::PassReport> passes;
  EXPECT_TRUE(same(drawn(scene, Term::final, {technique("separable_subsurface")}, &passes),
                   drawn(scene, Term::final, {})));
  for (const frame::PassReport& pass : passes)
    if (pass.technique == "separable_subsurface") {
      EXPECT_EQ(pass.state, frame::PassState::leftOut);
    }
}

}  // namespace
}  // namespace limn
