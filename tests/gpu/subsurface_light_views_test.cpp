// Light below surfaces that enters where lights look and the camera does not (light_views).
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/gpu/subsurface_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using glm::vec3;

class SubsurfaceLightViewsTest : public SubsurfaceHarness {
 protected:
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
  struct Ratio {
    double mean, rms;  ///< rms: of the distances from 1
  };
  /// Returns what one picture's light is of another's times `share`, over the middle of the floor.
  static Ratio ratioInTheMiddle(const Image& picture, const Image& of, double share = 1) {
    std::vector<double> wanted;
    forEachPoint(of, [&](float value, const vec3&) { wanted.push_back(double(value) * share); });
    double sum = 0, squares = 0;
    size_t index = 0;
    int counted = 0;
    forEachPoint(picture, [&](float value, const vec3& p) {
      const double ratio = double(value) / wanted[index++];
      if (std::abs(p.x) > 0.5f || std::abs(p.z) > 0.5f) return;
      sum += ratio;
      squares += (ratio - 1) * (ratio - 1);
      ++counted;
    });
    EXPECT_GT(counted, 1500);
    return {sum / counted, std::sqrt(squares / counted)};
  }
};

TEST_F(SubsurfaceLightViewsTest, LightFromBehindComesThrough) {
  const Image local = drawn(plate(0.05f, {0, -1, 0}), Term::subsurface, {});
  for (const float thickness : {0.02f, 0.1f}) {
    const scene::Scene scene = plate(thickness, {0, 1, 0});
    for (size_t profile = 0; profile < kProfileNames.size(); ++profile) {
      SCOPED_TRACE(kProfileNames[profile] + ' ' + std::to_string(thickness));
      const double through = reflectanceOverAlbedo(profile, kAbsorption) * throughPlate(profile, thickness);
      Choices values{{"profile", kProfileNames[profile]}, {"samples", "64"}};
      forEachPoint(below(scene, values), [](float value, const vec3&) { ASSERT_EQ(value, 0); });
      values.emplace_back("light_views", "1");
      const Ratio ratio = ratioInTheMiddle(below(scene, values), local, through);
      EXPECT_NEAR(ratio.mean, 1, 0.02);
      EXPECT_LT(ratio.rms, 0.05);
    }
  }
}

/// Vertex colours make the albedo that of the coefficients, and points are drawn for a brighter one, too: the
/// means of both sets of points differ by up to 0.004.
TEST_F(SubsurfaceLightViewsTest, LightFromBehindGoesByTheAlbedosOfBaseColours) {
  constexpr float kTint = 0.75f;
  for (const float thickness : {0.02f, 0.1f}) {
    const scene::Scene coefficients = plate(thickness, {0, 1, 0});
    scene::Scene coloured = coefficients;
    coloured.materials[0].baseColour = glm::vec4(vec3(albedo(kAbsorption) / kTint), 1);
    coloured.materials[0].subsurface->albedoFromBaseColour = true;
    scene::Primitive& body = coloured.meshes[static_cast<size_t>(coloured.nodes[0].mesh)].primitives[0];
    body.colours.assign(body.positions.size(), glm::vec4(vec3(kTint), 1));
    for (const std::string& profile : kProfileNames) {
      const Choices values{{"profile", profile}, {"samples", "64"}, {"light_views", "1"}};
      const Image wanted = below(coefficients, values);
      for (const char* mixing : {"root", "own"}) {
        Choices mixed = values;
        mixed.emplace_back("mixing", mixing);
        EXPECT_NEAR(ratioInTheMiddle(below(coloured, mixed), wanted).mean, 1, 0.01)
            << profile << ' ' << thickness << ' ' << mixing;
      }
    }
  }
}

/// The medium's ball lies as far below the plate as above it, so that light from both sides loses the same.
TEST_F(SubsurfaceLightViewsTest, MediaTakeOfLightFromBehind) {
  constexpr float kThickness = 0.02f;
  scene::Scene front = plate(kThickness, {0, -1, 0}), behind = plate(kThickness, {0, 1, 0});
  const Image clear = drawn(front, Term::subsurface, {});
  front.medium.sigmaA = behind.medium.sigmaA = vec3(0.5f);
  const Image local = drawn(front, Term::subsurface, {});
  EXPECT_NEAR(ratioInTheMiddle(local, clear).mean, 0.25, 0.05) << "half on each of two ways";
  const double through = reflectanceOverAlbedo(0, kAbsorption) * throughPlate(0, kThickness);
  const Ratio ratio =
      ratioInTheMiddle(below(behind, {{"samples", "64"}, {"light_views", "1"}}), local, through);
  EXPECT_NEAR(ratio.mean, 1, 0.02);
  EXPECT_LT(ratio.rms, 0.05);
}

/// At an index of 1 all that arrives enters, whatever its direction: as much from 16 points on a sun of 2 rad
/// as from its middle. As a surface that faces each of them gets it, 0.77 of that would enter.
TEST_F(SubsurfaceLightViewsTest, ViewsFromASunsDiscBringAllOfItsLight) {
  scene::Scene scene = plate(0.02f, {0, 1, 0});
  scene.materials[0].ior = 1;
  scene.lights[0].angle = 2;
  const Image middle = below(scene, {{"samples", "64"}, {"light_views", "1"}});
  const Image disc = below(scene, {{"samples", "64"}, {"light_views", "16"}});
  EXPECT_NEAR(ratioInTheMiddle(disc, middle).mean, 1, 0.05);
}

/// Nobody asks light views what surfaces reflect.
TEST_F(SubsurfaceLightViewsTest, LightViewsHoldNoAlbedo) {
  std::vector<frame::PassReport> passes;
  drawn(plate(0.02f, {0, 1, 0}), Term::subsurface,
        {technique("subsurface_scattering", {{"light_views", "1"}})}, &passes);
  int maps = 0;
  for (const frame::PassReport& pass : passes) {
    if (!pass.name.starts_with("reflective shadow maps")) continue;
    ++maps;
    for (const frame::AccessReport& access : pass.accesses)
      EXPECT_FALSE(access.resource.starts_with("reflective albedo"));
  }
  EXPECT_EQ(maps, 1);
}

/// What the camera sees is not added a second time, at the picture's border neither, and nor are opaque
/// neighbours and the undersides of what has one side.
TEST_F(SubsurfaceLightViewsTest, LightViewsAddWhatIsHiddenAlone) {
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

  const scene::Scene back = SubsurfaceLightViewsTest::floor(kExtinction, kAbsorption);
  scene::Scene under = back;
  under.nodes[1].transform.rotation = glm::quatLookAt(vec3(0, 1, 0), vec3(0, 0, 1));
  forEachPoint(below(under, {{"light_views", "1"}}), [](float value, const vec3&) { ASSERT_EQ(value, 0); });
}

/// Lamps within, on and far beside a ball, small and large, shared and single points, in all variants.
TEST_F(SubsurfaceLightViewsTest, LightViewsOfAnyLampGiveFiniteLight) {
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
