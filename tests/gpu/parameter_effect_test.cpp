// Parameters do what they say: with the second of two values the picture differs from that with the first by
// about as much as it did when the test was written, and where the parameter says so it is brighter or
// darker. A parameter that a technique no longer reads, or reads for another, shows here; what it is good for
// is tested with the technique.
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "tests/gpu/render_test.h"

namespace limn {
namespace {

enum class Brightness { more, less, either };

/// A parameter and what the second value makes of the picture that the first one gives.
struct ParameterEffect {
  const char *parameter, *first, *second;
  double least;  ///< root mean square difference of the two, a third of what was measured
  Brightness brightness = Brightness::either;
};

class ParameterEffectTest : public RenderTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  /// A scene and what draws it.
  struct Stage {
    scene::Scene scene;
    render::Renderer renderer;
    explicit Stage(const char* name) : scene(asset(name)), renderer(device(), scene) {}
  };

  /// Of the first light where the term is visibility.
  static void expectEffects(Stage& on, const char* asked, Term term, const Values& common,
                            std::initializer_list<ParameterEffect> effects) {
    for (const ParameterEffect& e : effects) {
      SCOPED_TRACE(std::string(asked) + "." + e.parameter);
      const auto with = [&](const char* value) {
        Values values = common;
        values.emplace_back(e.parameter, value);
        return picture(on.renderer,
                       settings(64, 48, term, {technique(asked, values)}, term == Term::visibility ? 0 : -1));
      };
      const Image first = with(e.first), second = with(e.second);
      EXPECT_GT(rmse(first, second), e.least);
      if (e.brightness == Brightness::more) {
        EXPECT_GT(mean(second), mean(first));
      }
      if (e.brightness == Brightness::less) {
        EXPECT_LT(mean(second), mean(first));
      }
    }
  }
};

/// A blocker must lie farther above the receiver's tangent plane: fewer do.
TEST_F(ParameterEffectTest, ALargeBiasTakesShadowsAway) {
  Stage balls("balls");
  const ParameterEffect fewer{"bias", "1", "64", 0.05, Brightness::more};
  for (const char* name :
       {"hard_shadow_map", "pcf", "pcss", "savsm", "vssm", "cssm", "moment_soft_shadow_map", "backprojection",
        "bitmask_soft_shadows", "sampled_area_light"})
    expectEffects(balls, name, Term::visibility, {{"shadow_map_size", "128"}}, {fewer});
}

TEST_F(ParameterEffectTest, ALargeBiasTakesShadowsOfTheSkyAway) {
  Stage ballsSky("balls_sky");
  const ParameterEffect fewer{"bias", "1", "64", 0.05, Brightness::more};
  expectEffects(ballsSky, "sampled_environment_light", Term::direct,
                {{"shadow_map_size", "128"}, {"samples", "16"}}, {fewer});
  expectEffects(ballsSky, "subtractive_shadows", Term::direct, {{"shadow_map_size", "128"}, {"lights", "16"}},
                {fewer});
}

TEST_F(ParameterEffectTest, ALargeBiasTakesShadowsOfVirtualLightsAway) {
  Stage cornellBox("cornell_box");
  const ParameterEffect fewer{"bias", "0.25", "64", 0.0015, Brightness::more};
  expectEffects(cornellBox, "instant_radiosity", Term::indirect,
                {{"vpls", "64"}, {"map_size", "64"}, {"block", "1"}}, {fewer});
  expectEffects(cornellBox, "imperfect_shadow_maps", Term::indirect,
                {{"vpls", "64"}, {"points", "256"}, {"block", "1"}}, {fewer});
  expectEffects(cornellBox, "clustered_visibility", Term::indirect,
                {{"vpls", "64"}, {"vals", "8"}, {"map_size", "64"}, {"block", "1"}}, {fewer});
}

TEST_F(ParameterEffectTest, ALargeBiasTakesShadowsOfBumpsAway) {
  Stage bumpWall("bump_wall");
  expectEffects(bumpWall, "bump_interreflection", Term::indirect, {{"paths", "8"}},
                {{"bias", "0", "64", 0.0012, Brightness::more}});
}

TEST_F(ParameterEffectTest, OfVssm) {
  Stage balls("balls");
  const Values maps{{"shadow_map_size", "256"}};
  expectEffects(balls, "vssm", Term::visibility, maps,
                {{"blocker_cells", "1", "8", 0.002},
                 {"visibility_cells", "1", "8", 0.002},
                 {"least_gap", "0.001", "1", 0.002},
                 {"passes", "1", "4", 0.0015}});
  expectEffects(balls, "vssm", Term::visibility, {maps[0], {"passes", "3"}},
                {{"pass_gap", "0", "1", 0.0015}});
  expectEffects(balls, "vssm", Term::visibility, {maps[0], {"contact", "jittered"}},
                {{"contact_texels", "1", "64", 0.006}});
  expectEffects(balls, "vssm", Term::visibility, {maps[0], {"subdivision", "adaptive"}},
                {{"tree_height", "1", "5", 0.0007}});
}

/// V is raised to the power 1 + A exp(-B (d - z)).
TEST_F(ParameterEffectTest, OfCssm) {
  Stage balls("balls");
  expectEffects(balls, "cssm", Term::visibility,
                {{"shadow_map_size", "256"}, {"splits", "1"}, {"contact", "sharpened"}},
                {{"sharpening", "0", "1000", 0.06, Brightness::less},
                 {"falloff", "0", "1000", 0.07, Brightness::more}});
}

TEST_F(ParameterEffectTest, OfMomentSoftShadowMaps) {
  Stage balls("balls");
  expectEffects(balls, "moment_soft_shadow_map", Term::visibility, {{"shadow_map_size", "256"}},
                {{"moment_bias", "1e-7", "0.1", 0.02},
                 {"least_gap", "0.001", "1", 0.04},
                 {"direct_texels", "0", "32", 0.008},
                 {"passes", "1", "4", 0.018}});
}

/// What is nearer to an area light than `near` does not block, and behind the light is V = `behind`.
TEST_F(ParameterEffectTest, OfClusteredVisibility) {
  Stage cornellBox("cornell_box");
  const Values few{{"vpls", "64"}, {"vals", "8"}, {"map_size", "64"}, {"block", "1"}};
  expectEffects(cornellBox, "clustered_visibility", Term::indirect, few,
                {{"weight_position", "0", "1", 0.006},
                 {"weight_angle", "0", "1", 0.001},
                 {"contact_texels", "0", "16", 0.0004},
                 {"near", "0", "0.5", 0.01, Brightness::more},
                 {"behind", "0", "1", 0.0009, Brightness::more},
                 {"search", "solid_angle", "nearest", 0.0007},
                 {"splits", "1", "2", 0.0006},
                 {"terms", "1", "4", 0.0016}});
}

/// Wide splats hide more, and so do closed holes.
TEST_F(ParameterEffectTest, OfMapsOfPoints) {
  Stage cornellBox("cornell_box");
  Values few{{"vpls", "64"}, {"points", "256"}, {"block", "1"}};
  expectEffects(cornellBox, "imperfect_shadow_maps", Term::indirect, few,
                {{"fill_levels", "0", "4", 0.0005, Brightness::less},
                 {"splat", "0.5", "16", 0.0015, Brightness::less}});
  Values filled = few;
  filled.emplace_back("fill_levels", "4");
  expectEffects(cornellBox, "imperfect_shadow_maps", Term::indirect, filled,
                {{"fill_depth", "0", "1", 0.002}});
  for (const auto& [name, value] : {std::pair("vals", "8"), {"map_size", "64"}, {"maps", "points"}})
    few.emplace_back(name, value);
  expectEffects(
      cornellBox, "clustered_visibility", Term::indirect, few,
      {{"fill_levels", "0", "4", 0.002, Brightness::less}, {"splat", "0.5", "32", 0.003, Brightness::less}});
}

/// The techniques that gather virtual lights share them.
TEST_F(ParameterEffectTest, OfTheBlurOverInterleavedPixels) {
  Stage cornellBox("cornell_box");
  expectEffects(
      cornellBox, "reflective_shadow_map", Term::indirect, {{"vpls", "256"}, {"block", "8"}},
      {{"blur_position", "0", "1", 0.016}, {"blur_plane", "0", "1", 0.01}, {"blur_normal", "-1", "1", 0.01}});
}

/// Links hide points of a light where they are shorter than `reach`: all but those to the light itself do at
/// 0.98.
TEST_F(ParameterEffectTest, OfImplicitVisibility) {
  Stage cornellBox("cornell_box");
  const Values coarse{{"bins", "8"}, {"longest_edge", "0.1"}};
  expectEffects(cornellBox, "implicit_visibility", Term::indirect, coarse,
                {{"opening", "0.5", "16", 0.003},
                 {"sharing", "0.01", "1", 0.0012},
                 {"closing", "0.01", "1", 0.0007},
                 {"lift", "0", "1", 0.0007}});
  // Discs of elements that are closed reach below the horizon.
  expectEffects(cornellBox, "implicit_visibility", Term::indirect, {coarse[0], coarse[1], {"opening", "16"}},
                {{"below_horizon", "0", "1", 1e-5}});
  expectEffects(cornellBox, "implicit_visibility", Term::visibility,
                {coarse[0], coarse[1], {"outlines", "vertex"}},
                {{"reach", "0.1", "0.98", 0.09, Brightness::less}});
}

TEST_F(ParameterEffectTest, OfIlluminationSamples) {
  Stage threeLights("three_lights");
  expectEffects(threeLights, "illumination_samples", Term::indirect, {{"longest_edge", "0.2"}},
                {{"receiver", "off", "on", 0.0015},
                 {"min_level", "0", "4", 0.0004},
                 {"light_rays", "1", "16", 0.0017}});
}

/// Rays of different beams do not share a stretch of light.
TEST_F(ParameterEffectTest, OfCausticRays) {
  Stage glassSphere("glass_sphere"), ring("ring");
  const Values few{{"buffer_size", "64"}};
  expectEffects(glassSphere, "surface_caustics", Term::caustic, few,
                {{"scene_map_size", "16", "512", 0.012},
                 {"exit_steps", "1", "64", 6e-5},
                 {"kernel", "0.5", "4", 0.003}});
  expectEffects(ring, "surface_caustics", Term::caustic, few, {{"beam_cosine", "-1", "0.999", 0.005}});
  expectEffects(glassSphere, "volume_caustics", Term::media, few,
                {{"scene_map_size", "16", "512", 0.0003}, {"exit_steps", "1", "64", 2.5e-5}});
  expectEffects(glassSphere, "volume_caustics", Term::media, {few[0], {"steps", "4"}},
                {{"step", "0.001", "0.3", 9e-6}});
  expectEffects(ring, "volume_caustics", Term::media, few, {{"beam_cosine", "-1", "0.999", 0.0007}});
  expectEffects(glassSphere, "krueger_caustics", Term::media, few,
                {{"scene_map_size", "16", "512", 0.0004}, {"exit_steps", "1", "64", 6e-5}});
}

TEST_F(ParameterEffectTest, OfRefraction) {
  Stage glassware("glassware");
  expectEffects(glassware, "image_space_refraction", Term::specular, {{"buffer_size", "64"}},
                {{"exit_steps", "1", "64", 1e-4}});
}

TEST_F(ParameterEffectTest, OfSubsurfaceScattering) {
  Stage translucentHead("translucent_head");
  expectEffects(translucentHead, "separable_subsurface", Term::subsurface, {},
                {{"follow_surface", "false", "true", 0.0003}, {"depth_limit", "0.001", "1000", 0.001}});
  expectEffects(translucentHead, "subsurface_scattering", Term::subsurface,
                {{"samples", "16"}, {"uniform_share", "0.5"}}, {{"uniform_radius", "0.3", "30", 0.001}});
  const Values points{{"shadow_map_size", "128"}, {"points", "1024"}};
  expectEffects(translucentHead, "hierarchical_subsurface", Term::subsurface, points,
                {{"tolerance", "0.01", "1", 0.0013}});
  expectEffects(translucentHead, "hierarchical_subsurface", Term::subsurface,
                {points[0], points[1], {"tolerance", "1"}}, {{"bias", "0", "64", 4e-5}});
  expectEffects(translucentHead, "texture_space_subsurface", Term::subsurface, {{"shadow_map_size", "128"}},
                {{"bias", "0", "64", 1e-4}});
}

TEST_F(ParameterEffectTest, OfSubtractiveShadows) {
  Stage ballsSky("balls_sky");
  expectEffects(ballsSky, "subtractive_shadows", Term::direct,
                {{"block", "8"}, {"lights", "16"}, {"shadow_map_size", "128"}},
                {{"position_width", "0.3", "30", 0.02}, {"normal_width", "0.01", "10", 0.015}});
}

}  // namespace
}  // namespace limn
