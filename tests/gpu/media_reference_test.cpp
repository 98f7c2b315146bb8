// Media and the light in them against the reference: airlight, lines and surfaces behind a medium.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/bench/private/stress_scene.h"
#include "core/scene/camera.h"
#include "tests/gpu/media_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using MediaTest = MediaHarness;

/// The standard deviation of mean() of a reference, whose pixels are independent.
double noiseOfMean(const Image& truth) {
  const int variance = truth.channel("variance");
  double sum = 0;
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x) sum += truth.at(x, y, variance);
  return std::sqrt(sum) / (truth.width() * truth.height());
}

/// Both parts have a truth of their own: what the reference loses where specular surfaces turn black are the
/// lines, 5 to 38 % of all light. Beside four standard deviations of the references' noise,
/// airlight may err by 1 % (AirlightNeedsFewStretches: 0.4 % of every pixel), and lines by the 2 % that
/// BufferAndScreenResolutionDoNotChangeTheMean lets buffers change (0.7 % in the ring against 4096 samples).
TEST_F(MediaTest, InScatteredLightIsTheReferencesForEveryPhaseFunction) {
  for (const char* name : {"glass_sphere", "ring", "gem"}) {
    scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);  // which reads the medium in each frame
    for (const float g : {-0.7f, 0.f, 0.7f}) {
      SCOPED_TRACE(fmt::format("{} g {}", name, g));
      scene.medium.g = g;
      const Image airlight = picture(renderer, settings(width, height, Term::media, {technique("airlight")}));
      const Image lines =
          picture(renderer, settings(width, height, Term::media, {technique("volume_caustics")}));
      const Image truth = reference(renderer, scene, Term::media, 32);
      EXPECT_NEAR((mean(airlight) + mean(lines)) / mean(truth), 1, 0.05);
      const Image airlightTruth = reference(renderer, withoutCaustics(scene), Term::media, 32);
      const double linesTruth = mean(truth) - mean(airlightTruth);
      EXPECT_NEAR(mean(airlight), mean(airlightTruth),
                  0.01 * mean(airlightTruth) + 4 * noiseOfMean(airlightTruth));
      EXPECT_NEAR(mean(lines), linesTruth,
                  0.02 * linesTruth + 4 * std::hypot(noiseOfMean(truth), noiseOfMean(airlightTruth)));
    }
  }
}

/// The lamp stands 1 m within the rim of a pool of 10 m and 0.3 m above it. Half a cube that looks at the
/// pool's middle would lack the water right behind the lamp: 10 % of the light that meets it.
TEST_F(MediaTest, ALampBesideTheMiddleOfAWidePoolLosesNothing) {
  scene::Scene scene;
  test::show(scene,
             test::quad({0, 0, 0}, {10, 0, 0}, {0, 0, -10}, test::addMaterial(scene, test::glass(1.33f))));
  test::show(scene, test::quad({0, -1, 0}, {12, 0, 0}, {0, 0, -12},
                               test::addMaterial(scene, test::lambertian(0.5f))));
  test::shine(scene, test::lamp(glsl::light_point, 10), {4, 0.3f, 0});
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = scene::lookAt({4.6f, -0.2f, 3}, {4.6f, -1, 0}, 0.9f);  // below the water
  const auto brightness = [&](Term term, const char* name) {
    return mean(picture(renderer, settings(64, 64, term, {technique(name)}), camera));
  };
  const reference::Request asked =
      test::request(scene, renderer.pose(), camera, {64, 64}, Term::caustic, 256);
  EXPECT_NEAR(brightness(Term::caustic, "surface_caustics") / mean(reference::render(asked).image), 1, 0.03);
}

TEST_F(MediaTest, SurfacesAreAttenuatedAsInTheReference) {
  scene::Scene scene = asset("lights");
  scene.medium.sigmaA = glm::vec3(0.05f, 0.1f, 0.2f);
  render::Renderer renderer(device(), scene);
  for (uint32_t light = 0; light < renderer.pose().lights.size(); ++light) {
    SCOPED_TRACE(renderer.pose().lightNames[light]);
    const double truth = mean(reference(renderer, scene, Term::direct, 64, int(light)));
    for (const char* shadows : {"sampled_area_light", "vssm"}) {
      const Image lit =
          picture(renderer, settings(width, height, Term::direct, {technique(shadows)}, int(light)));
      EXPECT_NEAR(mean(lit) / truth, 1, 0.04) << shadows;
    }
  }
}

TEST_F(MediaTest, EveryLightShinesIntoTheMedium) {
  const scene::Scene scene = bench::inFog(asset("lights"));
  render::Renderer renderer(device(), scene);
  for (size_t light = 0; light < renderer.pose().lights.size(); ++light) {
    SCOPED_TRACE(renderer.pose().lightNames[light]);
    const double truth = mean(reference(renderer, scene, Term::media, 32, int(light)));
    const Image ours = picture(
        renderer, settings(width, height, Term::media,
                           {technique("airlight", {{"light_samples", "16"}}),
                            technique("volume_caustics", {{"light_samples", "16"}, {"buffer_size", "64"}})},
                           int(light)));
    EXPECT_NEAR(mean(ours) / truth, 1, 0.05);
  }
}

TEST_F(MediaTest, TheWholePictureIsAsBrightAsTheReference) {
  for (const char* name : {"glass_sphere", "gem"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    const Image ours =
        picture(renderer, settings(width, height, Term::final,
                                   {technique("hard_shadow_map"), technique("airlight"),
                                    technique("surface_caustics"), technique("volume_caustics")}));
    EXPECT_NEAR(mean(ours) / mean(reference(renderer, scene, Term::final, 32)), 1, 0.02);
  }
}

/// Light from the middle of the ball goes through half a metre of glass, which absorbs half of it every 0.1
/// m, and which no medium fills: what the latter takes is that of the ways outside, as in the reference.
TEST_F(MediaTest, LightFromWithinABodyIsAbsorbedThereAndMeetsNoMedium) {
  scene::Scene scene = asset("glass_sphere");
  const auto ball = std::ranges::find(scene.nodes, "ball", &scene::Node::name);
  ASSERT_NE(ball, scene.nodes.end());
  for (scene::Node& node : scene.nodes)
    if (node.light != scene::kNone) node.transform.translation = ball->transform.translation;
  for (scene::LightSource& light : scene.lights) light.type = glsl::light_point;
  const auto brightness = [&](Term term, const char* name) {
    render::Renderer renderer(device(), scene);
    return mean(picture(renderer, settings(width, height, term, {technique(name)})));
  };
  scene.medium.sigmaS = glm::vec3(1);
  {
    render::Renderer renderer(device(), scene);
    EXPECT_NEAR(
        brightness(Term::caustic, "surface_caustics") / mean(reference(renderer, scene, Term::caustic, 64)),
        1, 0.05);
  }
  for (const auto& [term, name] :
       {std::pair(Term::media, "volume_caustics"), std::pair(Term::caustic, "surface_caustics")}) {
    SCOPED_TRACE(name);
    const double clear = brightness(term, name);
    for (scene::Material& material : scene.materials) {
      material.attenuationColour = glm::vec3(0.5f);
      material.attenuationDistance = 0.1f;
    }
    // Triangles lie up to 5e-4 of the radius within the ball.
    EXPECT_NEAR(brightness(term, name) / clear, std::pow(0.5, 5), 1e-3 * std::pow(0.5, 5) * 5);
    for (scene::Material& material : scene.materials) material.attenuationDistance = 0;
  }
}

}  // namespace
}  // namespace limn
