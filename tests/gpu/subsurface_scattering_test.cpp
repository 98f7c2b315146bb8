// Light below surfaces from points in the image: pictures against closed forms, line integrals and the local
// limit.
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/gpu/subsurface_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using glm::vec3;

constexpr float kDark = 0.3f, kBright = 0.8f;  ///< albedos of two colours

class SubsurfaceScatteringTest : public SubsurfaceHarness {
 protected:
  /// A scene with a plate above the camera, which takes the light away where x < edge.
  static scene::Scene shadowed(scene::Scene scene, float edge) {
    scene::Node plate;
    plate.mesh = test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
    plate.transform.translation = {edge - 2, 3, 0};
    scene.nodes.push_back(plate);
    return scene;
  }
  /// A floor of two colours that meet at x = 0, between two columns of pixels; the darker one has x < 0.
  static scene::Scene twoColours() {
    scene::Scene scene = floor(kExtinction, absorptionOf(kBright));
    scene.materials[0].baseColour = glm::vec4(vec3(kBright), 1);
    scene.materials[0].subsurface->albedoFromBaseColour = true;
    scene::Primitive plane = test::joined(test::quad({-1, 0, 0}, {2, 0, 0}, {0, 0, -4}, 0),
                                          test::quad({1, 0, 0}, {2, 0, 0}, {0, 0, -4}, 0));
    for (size_t i = 0; i < 8; ++i) plane.colours.emplace_back(vec3(i < 4 ? kDark / kBright : 1), 1);
    scene.nodes[0].mesh = test::addMesh(scene, test::finish(plane));
    return scene;
  }
  static float absorptionOf(float albedo) {
    return glsl::walk_absorption(glsl::walk_reflectance(glsl::diffusion_boundary(kMatterIor)), albedo);
  }
  /// Rd of matter of an albedo, per mean free path.
  static double profileAt(size_t profile, float albedo, float r) {
    const glsl::DiffusionBoundary boundary = glsl::diffusion_boundary(kMatterIor);
    const float absorption = absorptionOf(albedo);
    return static_cast<double>(
        profile == 0 ? glsl::diffusion_dipole_profile(glsl::diffusion_dipole(absorption, boundary), r)
                     : glsl::normalised_diffusion_profile(
                           glsl::normalised_diffusion(absorption, glsl::walk_reflectance(boundary)), r));
  }
  /// B over an even E at a distance, in mean free paths, from the line where another colour begins: across it
  /// light goes by the root of both profiles.
  static double besideColour(size_t profile, float own, float other, double edge) {
    double sum = reflectanceOverAlbedo(profile, absorptionOf(own)) * static_cast<double>(own);
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps, r = edge + t / (1 - t);
      const double area = 2 * r * std::acos(edge / r) / (kSteps * (1 - t) * (1 - t));
      const double mine = profileAt(profile, own, static_cast<float>(r));
      sum += area * (std::sqrt(mine * profileAt(profile, other, static_cast<float>(r))) - mine);
    }
    return sum;
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
  const scene::Scene open = floor(kExtinction, kAbsorption), scene = shadowed(open, 0);
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
    EXPECT_LE(error({{"block", "1"}, {"samples", "64"}}), 0.05) << kProfileNames[profile];
    EXPECT_LE(error({{"samples", "64"}}), 0.05) << kProfileNames[profile];
    EXPECT_GT(error({{"block", "1"}}), 3 * usual) << kProfileNames[profile];
  }
}

// Pixels lie on one side of the line, so that all that errs are the points: of 256 by up to 0.016, and the
// means over the pattern, which mix columns up to 2 pixels away, by 0.009 (RMS). At the line the other
// colour adds 0.2 or takes as much.
TEST_F(SubsurfaceScatteringTest, ColoursMixByTheRootOfBothOrStayTheirOwn) {
  const scene::Scene scene = twoColours();
  std::vector<double> local;  // over the albedo
  forEachPoint(drawn(scene, Term::subsurface, {}), [&](float value, const vec3& p) {
    local.push_back(static_cast<double>(value / (p.x < 0 ? kDark : kBright)));
  });
  struct Errors {
    double largest = 0, squares = 0;
    int count = 0;
    double rms() const { return std::sqrt(squares / count); }
  };
  for (size_t profile = 0; profile < kProfileNames.size(); ++profile) {
    SCOPED_TRACE(kProfileNames[profile]);
    const auto errors = [&](Choices values, bool root) {
      values.emplace_back("profile", kProfileNames[profile]);
      values.emplace_back("mixing", root ? "root" : "own");
      Errors e;
      size_t index = 0;
      forEachPoint(below(scene, values), [&](float value, const vec3& p) {
        const double one = local[index++];
        if (std::abs(p.x) > 0.3f || std::abs(p.z) > 0.45f) return;
        const float own = p.x < 0 ? kDark : kBright, other = p.x < 0 ? kBright : kDark;
        const double wanted =
            root ? besideColour(profile, own, other, static_cast<double>(std::abs(p.x) * kExtinction))
                 : reflectanceOverAlbedo(profile, absorptionOf(own)) * static_cast<double>(own);
        const double error = static_cast<double>(value) / (one * wanted) - 1;
        e.largest = std::max(e.largest, std::abs(error));
        e.squares += error * error;
        ++e.count;
      });
      EXPECT_GT(e.count, 1500);
      return e;
    };
    const Errors shared = errors({{"block", "1"}, {"samples", "256"}}, true);
    EXPECT_LT(shared.largest, 0.025);
    EXPECT_LT(shared.rms(), 0.01);
    EXPECT_LT(errors({}, true).rms(), 0.02);
    EXPECT_LT(errors({}, false).largest, 1e-3);
  }
}

// Few points tell of a channel whose light gets a twentieth as far as that of those they are drawn for. By
// the inequality of Cauchy and Schwarz no integral over the root of two profiles is larger.
TEST_F(SubsurfaceScatteringTest, FewPointsBringNoMoreThanTheRootOfBothReflectances) {
  scene::Scene scene = twoColours();
  scene.materials[0].subsurface->extinction = vec3(20 * kExtinction, kExtinction, kExtinction);
  std::vector<double> entering;
  forEachPoint(drawn(scene, Term::subsurface, {}), [&](float value, const vec3& p) {
    entering.push_back(static_cast<double>(value / (p.x < 0 ? kDark : kBright)));
  });
  const auto reflectance = [&](size_t profile, float albedo) {
    return reflectanceOverAlbedo(profile, absorptionOf(albedo)) * static_cast<double>(albedo);
  };
  for (size_t profile = 0; profile < kProfileNames.size(); ++profile)
    for (const char* samples : {"1", "2", "4", "16"}) {
      double largest = 0;
      size_t index = 0;
      const Choices values{{"profile", kProfileNames[profile]}, {"samples", samples}};
      forEachPoint(below(scene, values), [&](float value, const vec3& p) {
        const double own = reflectance(profile, p.x < 0 ? kDark : kBright);
        const double most = std::sqrt(own * reflectance(profile, kBright)) * entering[index++];
        largest = std::max(largest, static_cast<double>(value) / most);
      });
      EXPECT_LE(largest, 1.005) << kProfileNames[profile] << ' ' << samples;
    }
}

TEST_F(SubsurfaceScatteringTest, OtherBodiesGetNoLight) {
  // The shadow reaches a little further than the one of two bodies.
  const scene::Scene scene = shadowed(floor(kExtinction, kAbsorption), 0.05f);
  for (const char* views : {"0", "1"}) {
    EXPECT_GT(inTheDark(below(scene, {{"light_views", views}})), 1);
    EXPECT_EQ(inTheDark(below(halves(scene), {{"light_views", views}})), 0) << views;
  }
}

TEST_F(SubsurfaceScatteringTest, BodiesAreTheSameBesideOthers) {
  scene::Scene scene = shadowed(floor(kExtinction, kAbsorption), 0);
  scene.nodes.back().transform.translation = {0, 3, -2};  // the shadow's edge lies across both bodies
  expectBodiesAreTheSameBesideOthers(scene, [&](const scene::Scene& both) {
    return below(both, {{"light_views", "1"}});
  });
}

/// Each material has points of its own, whether it is seen or not.
TEST_F(SubsurfaceScatteringTest, MorePointsThanAStorageBufferHoldsAreRefused) {
  scene::Scene scene = floor(kExtinction, kAbsorption);
  const int64_t most = device().limits().maxStorageBlockBytes / (int64_t{1024} * 16 * 16 * 16);
  if (most > 1024) GTEST_SKIP() << "storage buffers hold the points of " << most << " materials";
  for (int64_t i = 1; i <= most; ++i) {
    scene::Material material = scene.materials[0];
    material.subsurface->absorption *= 1 + 0.01f * static_cast<float>(i);
    scene::Node node;
    node.mesh = test::addMesh(scene, test::floorPrimitive(0.01f, test::addMaterial(scene, material)));
    scene.nodes.push_back(node);
  }
  EXPECT_THROW(below(scene, {{"samples", "1024"}, {"block", "16"}}), UsageError);
  EXPECT_NO_THROW(below(scene, {}));
}

}  // namespace
}  // namespace limn
