// Light below surfaces from points in the image: pictures against closed forms, line integrals and the local
// limit.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "glsl/diffusion/colours.glsl"
#include "tests/gpu/bump_floor.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using glm::vec3;
using Choices = std::vector<std::pair<std::string, std::string>>;

constexpr float kMatterIor = 1.3f;
constexpr float kExtinction = 40;  ///< per metre; light gets 50 mm in the mean, 4 pixels
constexpr float kAbsorption = 0.04f;
const std::vector<std::string> kProfileNames{"dipole", "normalised_diffusion"};

class SubsurfaceScatteringTest : public BumpFloorTest {
 protected:
  /// A floor that absorbs that share of what it does not let through, under light from straight above.
  static scene::Scene floor(float extinction, float absorption) {
    scene::Scene scene = floorUnder({0, 1, 0}, {});
    scene::Material& material = scene.materials[0];
    material.ior = kMatterIor;
    material.baseColour = glm::vec4(vec3(albedo(absorption)), 1);
    material.subsurface = scene::Subsurface{.extinction = vec3(extinction), .absorption = vec3(absorption)};
    return scene;
  }
  /// A plate of the same matter, thick in metres and without sides, under light along `direction`.
  static scene::Scene plate(float thickness, const vec3& direction) {
    scene::Scene scene = floor(kExtinction, kAbsorption);
    scene.nodes[0].mesh = test::addMesh(
        scene, test::finish(test::joined(test::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, 0),
                                         test::quad({0, -thickness, 0}, {2, 0, 0}, {0, 0, 2}, 0))));
    scene.nodes[1].transform.rotation = glm::quatLookAt(direction, vec3(0, 0, 1));
    return scene;
  }
  /// Share of the light that enters a face far and wide that leaves the other one, by the same profile over
  /// the distance: of the light that leaves at a distance, what does so farther away than the thickness.
  static double throughPlate(size_t profile, float thickness) {
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(kMatterIor);
    const float r = thickness * kExtinction;
    return 1 - static_cast<double>(
                   profile == 0
                       ? glsl::diffusion_dipole_share(glsl::diffusion_dipole(kAbsorption, boundary), r)
                       : glsl::normalised_diffusion_share(
                             glsl::normalised_diffusion(kAbsorption, glsl::walk_reflectance(boundary)), r));
  }
  static float albedo(float absorption) {
    return glsl::walk_albedo(glsl::walk_reflectance(glsl::diffusion_boundary(kMatterIor)), absorption);
  }
  /// C of a profile over the albedo of the local limit.
  static double reflectanceOverAlbedo(size_t profile, float absorption) {
    if (profile == 1) return 1;
    const glsl::DiffusionDipole dipole =
        glsl::diffusion_dipole(absorption, glsl::diffusion_boundary(kMatterIor));
    return static_cast<double>(dipole.reflectance / albedo(absorption));
  }
  /// Share of the light at a distance into the lit side of an edge.
  static double besideEdge(size_t profile, double x) {
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(kMatterIor);
    const auto dipole = glsl::dipole_colours(vec3(kExtinction), vec3(kAbsorption), boundary);
    const auto exponentials = glsl::normalised_colours(vec3(kExtinction), vec3(kAbsorption), boundary);
    constexpr int kQuantiles = 200;
    double sum = 0;
    for (int i = 0; i < kQuantiles; ++i) {
      const float xi = (static_cast<float>(i) + 0.5f) / kQuantiles;
      const auto r = static_cast<double>(profile == 0 ? glsl::diffusion_radius(dipole, 0, xi)
                                                      : glsl::diffusion_radius(exponentials, 0, xi));
      sum += r <= std::abs(x) ? (x > 0 ? 1 : 0) : 1 - std::acos(x / r) / M_PI;
    }
    return sum / kQuantiles;
  }
  /// The largest of |a / b / ratio - 1| over the points of the floor.
  static double largestDifference(const Image& a, const Image& b, double ratio) {
    std::vector<double> wanted;
    forEachPoint(b, [&](float value, const vec3&) { wanted.push_back(static_cast<double>(value) * ratio); });
    double largest = 0;
    size_t i = 0;
    forEachPoint(a, [&](float value, const vec3&) {
      largest = std::max(largest, std::abs(static_cast<double>(value) / wanted[i++] - 1));
    });
    EXPECT_GT(i, 1500u);
    return largest;
  }
  Image below(const scene::Scene& scene, const Choices& values) {
    return drawn(scene, Term::subsurface,
                 {technique("hard_shadow_map", {{"shadow_map_size", "2048"}}),
                  technique("subsurface_scattering", values)});
  }
};

TEST_F(SubsurfaceScatteringTest, UniformLightLeavesByTheReflectance) {
  for (const float absorption : {0.f, kAbsorption}) {
    const scene::Scene scene = floor(kExtinction, absorption);
    const Image local = drawn(scene, Term::subsurface, {});
    for (size_t profile = 0; profile < kProfileNames.size(); ++profile)
      for (const char* planes : {"tangent", "both"})
        for (const char* share : {"0", "0.25"})
          EXPECT_LT(largestDifference(below(scene, {{"profile", kProfileNames[profile]},
                                                    {"planes", planes},
                                                    {"uniform_share", share}}),
                                      local, reflectanceOverAlbedo(profile, absorption)),
                    1e-3)
              << kProfileNames[profile] << ' ' << planes << ' ' << share;
  }
}

TEST_F(SubsurfaceScatteringTest, ShortPathsAreTheLocalLimit) {
  const scene::Scene scene = floor(1e6f, kAbsorption);
  const Image local = drawn(scene, Term::subsurface, {});
  for (const char* normalise : {"none", "count", "weights"})
    EXPECT_LT(largestDifference(below(scene, {{"normalise", normalise}}), local,
                                reflectanceOverAlbedo(0, kAbsorption)),
              1e-3)
        << normalise;
}

TEST_F(SubsurfaceScatteringTest, EdgesOfShadowsSpreadAsLineIntegralsSay) {
  // A plate above the camera takes half of the light away.
  const scene::Scene open = floor(kExtinction, kAbsorption);
  scene::Scene scene = open;
  scene::Node plate;
  plate.mesh = test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
  plate.transform.translation = {-2, 3, 0};
  scene.nodes.push_back(plate);
  for (size_t profile = 0; profile < kProfileNames.size(); ++profile) {
    std::vector<double> whole;
    forEachPoint(drawn(open, Term::subsurface, {}), [&](float value, const vec3&) {
      whole.push_back(static_cast<double>(value) * reflectanceOverAlbedo(profile, kAbsorption));
    });
    const auto error = [&](Choices values) {
      values.emplace_back("profile", kProfileNames[profile]);
      double squares = 0, sum = 0;
      size_t index = 0;
      int counted = 0;
      forEachPoint(below(scene, values), [&](float value, const vec3& p) {
        const double full = whole[index++];
        if (std::abs(p.x) > 0.3f || std::abs(p.z) > 0.45f) return;
        const double wanted = besideEdge(profile, static_cast<double>(p.x));
        squares += std::pow(static_cast<double>(value) / full - wanted, 2);
        sum += wanted;
        ++counted;
      });
      EXPECT_GT(counted, 1500);
      return std::sqrt(squares * counted) / sum;
    };
    const double usual = error({});
    EXPECT_LT(usual, 0.06) << kProfileNames[profile];
    EXPECT_LT(error({{"block", "1"}, {"samples", "64"}}), 0.06) << kProfileNames[profile];
    EXPECT_GT(error({{"block", "1"}}), 2 * usual) << kProfileNames[profile];
  }
}

TEST_F(SubsurfaceScatteringTest, LightFromBehindComesThrough) {
  const Image local = drawn(plate(0.05f, {0, -1, 0}), Term::subsurface, {});
  for (const float thickness : {0.02f, 0.1f}) {
    const scene::Scene scene = plate(thickness, {0, 1, 0});
    for (size_t profile = 0; profile < kProfileNames.size(); ++profile) {
      SCOPED_TRACE(kProfileNames[profile] + ' ' + std::to_string(thickness));
      const double through = reflectanceOverAlbedo(profile, kAbsorption) * throughPlate(profile, thickness);
      Choices values{{"profile", kProfileNames[profile]}, {"samples", "64"}};
      forEachPoint(below(scene, values), [](float value, const vec3&) { ASSERT_EQ(value, 0); });
      values.emplace_back("light_views", "1");
      std::vector<double> wanted;
      forEachPoint(local, [&](float value, const vec3&) { wanted.push_back(double(value) * through); });
      double sum = 0, squares = 0;
      size_t index = 0;
      int counted = 0;
      forEachPoint(below(scene, values), [&](float value, const vec3& p) {
        const double ratio = double(value) / wanted[index++];
        if (std::abs(p.x) > 0.5f || std::abs(p.z) > 0.5f) return;
        sum += ratio;
        squares += (ratio - 1) * (ratio - 1);
        ++counted;
      });
      ASSERT_GT(counted, 1500);
      EXPECT_NEAR(sum / counted, 1, 0.02);
      EXPECT_LT(std::sqrt(squares / counted), 0.05);
    }
  }
}

/// What the camera sees is not added a second time, at the picture's border neither, and nor are opaque
/// neighbours and the undersides of what has one side.
TEST_F(SubsurfaceScatteringTest, LightViewsAddWhatIsHiddenAlone) {
  const scene::Scene lit = plate(0.02f, glm::normalize(vec3(0.4f, -1, 0.2f)));
  for (const char* normalise : {"weights", "count"}) {
    const Image seen = below(lit, {{"normalise", normalise}});
    EXPECT_LT(largestDifference(below(lit, {{"normalise", normalise}, {"light_views", "1"}}), seen, 1), 1e-4)
        << normalise;
  }

  scene::Scene behind = plate(0.02f, {0, 1, 0});
  scene::Node shield;
  shield.mesh = test::addMesh(
      behind, test::finish(test::quad({0, -0.021f, 0}, {2, 0, 0}, {0, 0, 2}, test::addMaterial(behind))));
  behind.nodes.push_back(shield);
  forEachPoint(below(behind, {{"light_views", "1"}}), [](float value, const vec3&) { ASSERT_EQ(value, 0); });

  const scene::Scene back = SubsurfaceScatteringTest::floor(kExtinction, kAbsorption);
  scene::Scene under = back;
  under.nodes[1].transform.rotation = glm::quatLookAt(vec3(0, 1, 0), vec3(0, 0, 1));
  forEachPoint(below(under, {{"light_views", "1"}}), [](float value, const vec3&) { ASSERT_EQ(value, 0); });
}

/// Lamps within, on and far beside a ball, small and large, shared and single points, in all variants.
TEST_F(SubsurfaceScatteringTest, LightViewsOfAnyLampGiveFiniteLight) {
  for (const vec3& place : {vec3(0, -0.5f, 0), vec3(0, -0.3f, 0), vec3(0, -0.1f, 0.3f), vec3(0, -900, 0)})
    for (const float size : {0.f, 1e-4f, 3.f, 1e4f}) {
      scene::Scene scene = floor(kExtinction, kAbsorption);
      scene.nodes[0].mesh = test::addMesh(scene, test::spherePrimitive(0.3f, 0, 16));
      scene.lights[0].type = glsl::light_point;
      scene.nodes[1].transform.translation = place;
      if (size > 0) {
        scene.nodes.pop_back();
        scene.lights.clear();
        scene::Material emitter = test::lambertian(0);
        emitter.emission = vec3(1);
        emitter.doubleSided = true;
        test::show(scene, test::quad(place, {size, 0, 0}, {0, 0, -size}, test::addMaterial(scene, emitter)));
      }
      for (const Choices& values :
           {Choices{{"light_views", "1"}, {"light_view_size", "16"}},
            Choices{{"light_views", "3"}, {"samples", "2"}, {"light_view_size", "64"}},
            Choices{{"light_views", "1"}, {"scale", "1e6"}, {"planes", "both"}},
            Choices{{"light_views", "1"}, {"scale", "1e-6"}, {"normalise", "none"}}}) {
        SCOPED_TRACE(size);
        const Image image = below(scene, values);
        for (int y = 0; y < image.height(); ++y)
          for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) {
              ASSERT_TRUE(std::isfinite(image.at(x, y, c)));
              ASSERT_GE(image.at(x, y, c), 0);
            }
      }
    }
}

}  // namespace
}  // namespace limn
