// What illumination samples promise beyond what every technique does.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/reference/reference.h"
#include "tests/gpu/foggy_ball.h"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

class IlluminationSamplesTest : public RenderTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  /// Of the truth, where its mean alone is looked at. Were each off by twice its mean, that of all 442,368 in
  /// 96 x 72 pixels would be by 0.3 %, a tenth of what means may err.
  static constexpr int kMeanSamples = 64;

  static Image indirect(render::Renderer& renderer, const Values& values) {
    return picture(renderer, settings(96, 72, Term::indirect, {technique("illumination_samples", values)}));
  }

  static Image truth(render::Renderer& renderer, const scene::Scene& scene, int bounces = 1,
                     glm::ivec2 size = {96, 72}, int samples = 256) {
    reference::Request asked = test::request(renderer, scene, size, Term::indirect, samples);
    asked.bounces = bounces;
    return reference::render(asked).image;
  }

  struct Error {
    double rmse = 0, mean = 0;
    double relative() const { return rmse / mean; }
  };
  /// Over the pixels that show an instance.
  static Error errorOn(int instance, const Image& image, const Image& truth) {
    double sum = 0, light = 0, count = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        if (truth.at(x, y, truth.channel("id")) != static_cast<float>(instance)) continue;
        for (int c = 0; c < 3; ++c) {
          sum += std::pow(double(image.at(x, y, c)) - truth.at(x, y, c), 2);
          light += truth.at(x, y, c);
        }
        count += 3;
      }
    return {std::sqrt(sum / count), light / count};
  }

  /// The mean over pixels and colours, whatever else the picture holds.
  static double meanLight(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        for (int c = 0; c < 3; ++c) sum += image.at(x, y, c);
    return sum / (3.0 * image.width() * image.height());
  }

  /// The Cornell box with walls, and blocks if it has them, that reflect 0.99.
  static scene::Scene whiteBox(bool blocks) {
    scene::Scene scene = asset("cornell_box");
    for (scene::Material& material : scene.materials)
      if (material.emission == glm::vec3(0)) material.baseColour = glm::vec4(0.99f, 0.99f, 0.99f, 1);
    for (scene::Node& node : scene.nodes)
      if (!blocks && node.name.find("block") != std::string::npos) node.mesh = scene::kNone;
    return scene;
  }
};

/// The plate sends three spots of light to the wall: its own light by directions is what they need. Paths
/// from the camera rarely find the lamps by it: the truth has noise of an eighth of the mean.
TEST_F(IlluminationSamplesTest, APlateThrowsTheLightOfThreeLampsOntoAWall) {
  const scene::Scene scene = asset("three_lights");
  render::Renderer renderer(device(), scene);
  const Image exact = truth(renderer, scene, 1, {32, 24}, 8192);
  const auto shown = [&](const Values& values) {
    return errorOn(
        1, picture(renderer, settings(32, 24, Term::indirect, {technique("illumination_samples", values)})),
        exact);
  };
  for (const char* cells : {"haar", "uniform"}) {
    const Error error =
        shown({{"longest_edge", "0.04"}, {"display", "gather"}, {"basis", cells}, {"max_level", "5"}});
    std::printf("three_lights, %s: RMSE of the wall %.1f %% of its mean, with the truth's noise\n", cells,
                100 * error.relative());
    EXPECT_LT(error.relative(), 0.2);
  }
  const Error coarse =
      shown({{"longest_edge", "0.04"}, {"display", "gather"}, {"basis", "uniform"}, {"max_level", "2"}});
  std::printf("three_lights, 16 cells a face: %.1f %%\n", 100 * coarse.relative());
  EXPECT_GT(coarse.relative(), 0.25) << "directions matter";
}

/// A satin cap of a sphere that is evenly lit: it sends what it reflects of light from all round.
TEST_F(IlluminationSamplesTest, ACapInAFurnaceReflectsItsReflectance) {
  const scene::Scene scene = asset("glossy_furnace");
  render::Renderer renderer(device(), scene);
  const Image exact = truth(renderer, scene);
  for (const char* display : {"pixel", "gather"}) {
    const Error error =
        errorOn(1, indirect(renderer, {{"display", display}, {"longest_edge", "0.05"}}), exact);
    std::printf("glossy_furnace, %s: RMSE %.1f %%\n", display, 100 * error.relative());
    EXPECT_LT(error.relative(), 0.06);
  }
}

/// A satin floor shows the walls down to their foot, by trees and gathered: one direction for each element of
/// a wall left the floor before it a third too dark, and 15 % RMSE on the whole.
TEST_F(IlluminationSamplesTest, FloorsReflectWallsDownToTheirFoot) {
  const scene::Scene scene = asset("glossy_room");
  render::Renderer renderer(device(), scene);
  const Image exact = truth(renderer, scene, 1, {64, 48}, 1024);
  for (const char* display : {"pixel", "gather"}) {
    const Values values{{"longest_edge", "0.0722"}, {"display", display}};
    const Image shown =
        picture(renderer, settings(64, 48, Term::indirect, {technique("illumination_samples", values)}));
    const Error error = errorOn(0, shown, exact);
    std::printf("glossy_room, %s: RMSE of the floor %.1f %%\n", display, 100 * error.relative());
    EXPECT_LT(error.relative(), 0.12) << display;
  }
}

/// As above, with a floor of another roughness.
scene::Scene roomWithFloor(scene::Scene scene, float roughness) {
  for (scene::Material& material : scene.materials)
    if (material.metallic > 0) material.roughness = roughness;
  return scene;
}

TEST_F(IlluminationSamplesTest, ThreeBouncesOverARoughFloor) {
  const scene::Scene scene = roomWithFloor(asset("glossy_room"), 0.5f);
  render::Renderer renderer(device(), scene);
  const Image exact = truth(renderer, scene, 3, {64, 48}, 1024);
  const Values values{{"longest_edge", "0.0722"}, {"bounces", "3"}};
  const Image shown =
      picture(renderer, settings(64, 48, Term::indirect, {technique("illumination_samples", values)}));
  const Error error = errorOn(0, shown, exact);
  std::printf("glossy_room, roughness 0.5, three bounces: RMSE of the floor %.1f %%\n",
              100 * error.relative());
  EXPECT_LT(error.relative(), 0.12);
}

/// As points, the elements of the walls show as highlights in a floor of narrow lobes.
TEST_F(IlluminationSamplesTest, WideningTakesHighlightsOfElementsAway) {
  const scene::Scene scene = roomWithFloor(asset("glossy_room"), 0.2f);
  render::Renderer renderer(device(), scene);
  const Image exact = truth(renderer, scene, 1, {64, 48}, 1024);
  const auto shown = [&](const char* widen) {
    const Values values{{"longest_edge", "0.0722"}, {"display", "gather"}, {"widen", widen}};
    return errorOn(
        0, picture(renderer, settings(64, 48, Term::indirect, {technique("illumination_samples", values)})),
        exact);
  };
  const Error widened = shown("0.22"), points = shown("0");
  std::printf("glossy_room, roughness 0.2, gathered: RMSE of the floor %.1f %%, of points %.1f %%\n",
              100 * widened.relative(), 100 * points.relative());
  EXPECT_LT(2.5 * widened.relative(), points.relative());
}

TEST_F(IlluminationSamplesTest, SamplesReflectedAtPixelsAreWhatTreesShow) {
  const scene::Scene scene = asset("glossy_room");
  render::Renderer renderer(device(), scene);
  const Values coarse{{"longest_edge", "0.1"}};
  const auto shown = [&](const char* display) {
    Values values = coarse;
    values.emplace_back("display", display);
    return indirect(renderer, values);
  };
  const Image gathered = shown("gather"), pixels = shown("pixel"), vertices = shown("vertex");
  std::printf("glossy_room: RMSE gathered - per pixel %.4f, gathered - per vertex %.4f, mean %.4f\n",
              rmse(gathered, pixels), rmse(gathered, vertices), mean(gathered));
  EXPECT_LT(rmse(gathered, pixels), 0.2 * mean(gathered));
  EXPECT_LT(rmse(gathered, vertices), 0.2 * mean(gathered));
  EXPECT_GT(mean(gathered), 0);
}

/// White walls lose light through the open side of their box alone. (Coarse elements lose some along the
/// blocks, too, which are left out.)
TEST_F(IlluminationSamplesTest, ManyBouncesBetweenWhiteWallsGainNoLight) {
  const scene::Scene scene = whiteBox(false);
  render::Renderer renderer(device(), scene);
  const double wanted = meanLight(truth(renderer, scene, 8, {96, 72}, kMeanSamples));
  const double got = meanLight(indirect(renderer, {{"bounces", "8"}, {"longest_edge", "0.1"}}));
  std::printf("cornell_box, albedo 0.99, 8 bounces: %.1f %% off\n", 100 * (got / wanted - 1));
  EXPECT_NEAR(got / wanted, 1, 0.03);
}

/// Elements of the floor that lie half below a block are lit as far as they are seen, and lose light once,
/// not twice.
TEST_F(IlluminationSamplesTest, ElementsHalfInsideBlocksLoseLittleLight) {
  const scene::Scene scene = whiteBox(true);
  render::Renderer renderer(device(), scene);
  const double wanted = meanLight(truth(renderer, scene, 1, {96, 72}, kMeanSamples));
  const double got = meanLight(indirect(renderer, {{"longest_edge", "0.05"}}));
  std::printf("cornell_box with blocks, albedo 0.99: %.1f %% off\n", 100 * (got / wanted - 1));
  EXPECT_GE(got / wanted, 0.95) << got << " for " << wanted;
  EXPECT_LE(got / wanted, 1.03) << got << " for " << wanted;
}

/// Extremes of lobes, cells and elements give numbers, none of them negative.
TEST_F(IlluminationSamplesTest, ExtremesGiveNumbers) {
  scene::Scene scene = asset("three_lights");
  for (const float roughness : {0.05f, 0.1f, 1.f}) {
    for (scene::Material& material : scene.materials)
      if (material.metallic > 0) material.roughness = roughness;
    render::Renderer renderer(device(), scene);
    for (const Values& values :
         std::vector<Values>{{{"display", "gather"}},
                             {{"direction_error", "0.5"}},
                             {{"max_level", "2"}},
                             {{"max_level", "3"}, {"basis", "uniform"}},
                             {{"criterion", "relative"}, {"direction_error", "0.5"}, {"max_level", "5"}},
                             {{"reflection", "immediate"}, {"max_level", "4"}},
                             {{"longest_edge", "10"}},
                             {{"bounces", "3"}}}) {
      Values coarse{{"longest_edge", "0.1"}};
      coarse.insert(coarse.end(), values.begin(), values.end());
      const Image image =
          picture(renderer, settings(48, 36, Term::indirect, {technique("illumination_samples", coarse)}));
      expectWithin(image, 0, 1e4f);
    }
  }
}

/// Nothing but a corner and a ring in the middle changes, and the corner holds light.
TEST_F(IlluminationSamplesTest, ATreeIsDrawnInACorner) {
  const scene::Scene scene = asset("glossy_room");
  render::Renderer renderer(device(), scene);
  for (const char* basis : {"haar", "uniform"}) {
    const auto shown = [&](const char* show) {
      return picture(
          renderer,
          settings(
              96, 72, Term::indirect,
              {technique("illumination_samples",
                         {{"longest_edge", "0.1"}, {"basis", basis}, {"max_level", "5"}, {"show", show}})}),
          renderer.pose().cameras.at(1));  // the satin floor
    };
    const Image plain = shown("light"), drawn = shown("tree");
    double inCorner = 0;
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 96; ++x) {
        const bool corner = x < 32 && y >= 40;
        const bool ring = std::hypot(x - 48, y - 36) < 6;
        for (int c = 0; c < 3; ++c) {
          if (corner) inCorner += drawn.at(x, y, c);
          if (corner || ring) continue;
          ASSERT_EQ(drawn.at(x, y, c), plain.at(x, y, c)) << basis << ' ' << x << ' ' << y;
        }
      }
    EXPECT_GT(inCorner, 10) << basis;
    expectWithin(drawn, 0, 1e4f);
  }
  EXPECT_THAT(errorOf([&] {
                render::Renderer refused(device(), scene);
                indirect(refused, {{"display", "gather"}, {"show", "tree"}});
              }),
              testing::HasSubstr("show=tree goes with display=pixel"));
}

TEST_F(IlluminationSamplesTest, AMovedCameraRunsTheDisplayAlone) {
  const scene::Scene scene = asset("glossy_room");
  render::Renderer renderer(device(), scene);
  for (const char* display : {"pixel", "vertex", "gather"}) {
    render::Settings s =
        settings(64, 48, Term::indirect,
                 {technique("illumination_samples", {{"longest_edge", "0.2"}, {"display", display}})});
    s.dynamic = false;
    picture(renderer, s);
    renderer.setCamera(renderer.pose().cameras.at(1));
    renderer.render();
    std::vector<std::string> kept;
    for (const auto& pass : renderer.explain())
      if (pass.technique == "illumination_samples" && pass.state == frame::PassState::cached)
        kept.push_back(pass.name);
    const char* last = std::string_view(display) == "gather" ? "upload" : "project";
    EXPECT_THAT(kept, testing::IsSupersetOf({"update elements", "light samples", "shoot", last})) << display;
  }
}

/// On the way to the wall and on that to the eye, 1 m each; between parts of the wall light is free. Where
/// triangles cut the ball ways are up to 0.4 % shorter, and links may be refined otherwise: 3 % in all.
TEST_F(IlluminationSamplesTest, AMediumTakesOfLightFromTheLampToTheWall) {
  const auto seen = [](const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    const Values values{{"longest_edge", "0.3"}, {"link_error", "0.03"}};
    return mean(picture(renderer,
                        settings(32, 32, Term::indirect, {technique("illumination_samples", values)}),
                        test::foggyBallCamera()));
  };
  const double clear = seen(test::foggyBall());
  EXPECT_GT(clear, 0);
  for (const bool grid : {false, true}) {
    scene::Scene fog = test::foggyBall();
    test::fillWithFog(fog, grid);
    EXPECT_NEAR(seen(fog) / clear, std::exp(-2.0), 0.004) << grid;
  }
}

TEST_F(IlluminationSamplesTest, DarkScenesAreDark) {
  scene::Scene scene = asset("glossy_room");
  for (scene::LightSource& light : scene.lights) light.intensity = 0;
  render::Renderer renderer(device(), scene);
  EXPECT_EQ(mean(indirect(renderer, {{"longest_edge", "0.2"}})), 0);
}

TEST_F(IlluminationSamplesTest, ScenesThatTakeTooMuchMemoryAreRefused) {
  const scene::Scene scene = asset("glossy_room");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(indirect(renderer, {{"memory", "1"}, {"longest_edge", "0.01"}}), UsageError);
  EXPECT_THROW(indirect(renderer, {{"memory", "1"}, {"link_error", "0.0001"}}), UsageError);
}

/// A speck of metal that reflects what each of 33,000 elements of a floor sends it: llvmpipe would leave a
/// part of them out, and the picture would be too dark.
TEST_F(IlluminationSamplesTest, PixelsOfMoreSamplesThanSoftwareRenderersTakeAreRefused) {
  scene::Scene scene;
  const int floor = test::addMaterial(scene, test::lambertian(0.5f));
  scene::Material metal;
  metal.baseColour = glm::vec4(0.75f, 0.75f, 0.75f, 1);
  metal.roughness = 0.06f;
  for (const float x : {-1.f, 1.f}) test::show(scene, test::quad({x, 0, 0}, {2, 0, 0}, {0, 0, -2}, floor));
  test::show(scene, test::quad({0, 1, 0}, {0.01f, 0, 0}, {0, 0, 0.01f}, test::addMaterial(scene, metal)));
  test::shine(scene, test::lamp(glsl::light_point, 10), {0, 3, 0});
  render::Renderer renderer(device(), scene);
  const auto shown = [&](const char* longestEdge) {
    const Values values{{"display", "gather"}, {"link_error", "0.001"}, {"longest_edge", longestEdge}};
    return mean(picture(renderer, settings(8, 8, Term::indirect, {technique("illumination_samples", values)}),
                        scene::lookAt({0, 0.5f, 0.5f}, {0, 1, 0}, 0.01f)));
  };
  EXPECT_GT(shown("0.1"), 0);
  if (!device().software()) return;
  EXPECT_THAT(errorOf([&] { shown("0.0125"); }),
              testing::HasSubstr("samples at a pixel; software renderers take 60000"));
}

TEST_F(IlluminationSamplesTest, ScenesWhoseLinksLookAtTooManyPairsAreRefused) {
  const scene::Scene scene = asset("glossy_room");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(indirect(renderer, {{"pairs", "1"}}), UsageError);
}

}  // namespace
}  // namespace limn
