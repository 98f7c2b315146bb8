// Media and the light in them against the reference, alone and together with caustics, and at extremes.
#include <fmt/format.h>

#include <cmath>

#include "core/bench/private/stress_scene.h"
#include "core/scene/camera.h"
#include "tests/gpu/media_harness.h"

namespace limn {
namespace {

class MediaTest : public MediaHarness {
 protected:
  /// The same scene with black, matte surfaces for the specular ones, which cast the same shadows: what its
  /// medium scatters is airlight alone.
  static scene::Scene withoutCaustics(scene::Scene scene) {
    for (scene::Material& m : scene.materials) {
      if (!m.specularSurface()) continue;
      m = {};
      m.baseColour = glm::vec4(0, 0, 0, 1);
      m.metallic = 0;
      m.specularFactor = 0;
    }
    return scene;
  }

  /// The standard deviation of mean() of a reference, whose pixels are independent.
  static double noiseOfMean(const Image& truth) {
    const int variance = truth.channel("variance");
    double sum = 0;
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width(); ++x) sum += truth.at(x, y, variance);
    return std::sqrt(sum) / (truth.width() * truth.height());
  }
};

/// Both parts have a truth of their own: what the reference loses where specular surfaces turn black are the
/// lines, 5 to 38 % of all light. Beside four standard deviations of the references' noise,
/// airlight may err by 1 % (AirlightNeedsFewStretches: 0.4 % of every pixel), and lines by the 2 % that
/// BufferAndScreenResolutionDoNotChangeTheMean lets buffers change (0.7 % in the ring against 4096 samples).
TEST_F(MediaTest, InScatteredLightIsTheReferencesForEveryPhaseFunction) {
  for (const char* name : {"glass_sphere", "ring", "gem"})
    for (const float g : {-0.7f, 0.f, 0.7f}) {
      SCOPED_TRACE(fmt::format("{} g {}", name, g));
      scene::Scene scene = asset(name);
      scene.medium.g = g;
      render::Renderer renderer(device(), scene);
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

TEST_F(MediaTest, BufferAndScreenResolutionDoNotChangeTheMean) {
  for (const char* name : {"glass_sphere", "ring", "gem"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    const auto brightness = [&](int scale, const char* size, const char* beams) {
      return mean(picture(
          renderer, settings(width * scale, height * scale, Term::media,
                             {technique("volume_caustics", {{"buffer_size", size}, {"beams", beams}})})));
    };
    for (const char* beams : {"true", "false"}) {
      const double usual = brightness(1, "256", beams);
      EXPECT_NEAR(brightness(1, "512", beams) / usual, 1, 0.02) << "beams " << beams;
      EXPECT_NEAR(brightness(2, "256", beams) / usual, 1, 0.02) << "beams " << beams;
    }
    EXPECT_NEAR(brightness(1, "256", "true") / brightness(1, "256", "false"), 1, 0.02);
  }
}

/// Stretches of a viewing ray lie in the spot's cone alone, so that few are enough.
TEST_F(MediaTest, AirlightNeedsFewStretches) {
  for (const char* name : {"glass_sphere", "ring", "gem"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    const auto airlight = [&](const char* steps) {
      return picture(renderer,
                     settings(width, height, Term::media, {technique("airlight", {{"steps", steps}})}));
    };
    EXPECT_LT(relativeRms(airlight("16"), airlight("512")), 0.004);
  }
}

/// Eight lamps shine as one of eight times the light does, however many steps the loops over them take: of a
/// thread, llvmpipe leaves all loops after 65,535.
TEST_F(MediaTest, AirlightOfManyPointsAndStretchesIsAllThere) {
  scene::Scene one = asset("glass_sphere");
  const auto lamp =
      std::ranges::find_if(one.nodes, [](const scene::Node& node) { return node.light != scene::kNone; });
  ASSERT_NE(lamp, one.nodes.end());
  lamp->limnArea = {0.2f, 0.2f};
  scene::Scene eight = one;
  for (int i = 1; i < 8; ++i) eight.nodes.push_back(*lamp);
  for (scene::LightSource& light : one.lights) light.intensity *= 8;
  const auto brightness = [&](const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    return mean(picture(
        renderer,
        settings(12, 9, Term::media,
                 {technique("airlight",
                            {{"steps", "1024"}, {"light_samples", "16"}, {"shadow_map_size", "64"}})})));
  };
  EXPECT_NEAR(brightness(eight) / brightness(one), 1, 1e-4);
}

TEST_F(MediaTest, TermsSumToTheFinalPicture) {
  const scene::Scene scene = asset("glass_sphere");
  render::Renderer renderer(device(), scene);
  const std::vector<render::TechniqueUse> all{technique("hard_shadow_map"), technique("volume_caustics"),
                                              technique("surface_caustics"), technique("airlight")};
  const Image whole = picture(renderer, settings(width, height, Term::final, all));
  double sum = 0;
  for (const Term part : {Term::direct, Term::caustic, Term::media})
    sum += mean(picture(renderer, settings(width, height, part, all)));
  EXPECT_NEAR(sum / mean(whole), 1, 1e-4);
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

TEST_F(MediaTest, LightsTogetherAreTheSumOfTheLightsAlone) {
  const scene::Scene scene = bench::inFog(asset("lights"));
  render::Renderer renderer(device(), scene);
  for (const char* name : {"airlight", "volume_caustics", "surface_caustics"}) {
    SCOPED_TRACE(name);
    const Term term = std::string(name) == "surface_caustics" ? Term::caustic : Term::media;
    double sum = 0;
    for (size_t light = 0; light < renderer.pose().lights.size(); ++light)
      sum += mean(picture(renderer, settings(width, height, term, {technique(name)}, int(light))));
    EXPECT_NEAR(mean(picture(renderer, settings(width, height, term, {technique(name)}))) / sum, 1, 1e-3);
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

TEST_F(MediaTest, ScaleAndRadianceDoNotMatter) {
  const scene::Scene scene = asset("glass_sphere");
  render::Renderer renderer(device(), scene);
  const std::vector<render::TechniqueUse> all{technique("airlight"), technique("surface_caustics"),
                                              technique("volume_caustics")};
  const Image usual = picture(renderer, settings(width, height, Term::final, all));
  for (const float factor : {1e-4f, 1e4f}) {
    const scene::Scene scaled = bench::stressed(scene, StressChange::sceneScale, double(factor));
    render::Renderer other(device(), scaled);
    EXPECT_NEAR(mean(picture(other, settings(width, height, Term::final, all))) / mean(usual), 1, 2e-3)
        << factor;
  }
  for (const float factor : {1e-6f, 1e6f}) {
    const scene::Scene brighter = bench::stressed(scene, StressChange::radiance, double(factor));
    render::Renderer other(device(), brighter);
    EXPECT_NEAR(
        mean(picture(other, settings(width, height, Term::final, all))) / double(factor) / mean(usual), 1,
        1e-4)
        << factor;
  }
}

TEST_F(MediaTest, ExtremeResolutionsGiveFinitePictures) {
  const scene::Scene scene = asset("gem");
  render::Renderer renderer(device(), scene);
  for (const auto& [x, y] : {std::pair(1, 1), std::pair(4096, 1), std::pair(1, 4096), std::pair(17, 3)})
    expectWithin(picture(renderer, settings(x, y, Term::final,
                                            {technique("airlight"), technique("surface_caustics"),
                                             technique("volume_caustics")})),
                 0, 1e6f);
}

TEST_F(MediaTest, ExtremesGiveFinitePictures) {
  struct Extreme {
    const char* what;
    float sigmaS, g, ior;
  };
  const Extreme extremes[] = {{"backward", 0.15f, -0.99f, 1.5f},
                              {"forward", 0.15f, 0.99f, 1.5f},
                              {"no refraction", 0.15f, 0, 1.0001f},
                              {"diamond", 0.15f, 0, 2.42f},
                              {"ior 3", 0.15f, 0, 3},
                              {"thin", 1e-3f / 6, 0, 1.5f},
                              {"thick", 10.f / 6, 0, 1.5f},
                              {"opaque", 1000.f / 6, 0, 1.5f}};
  for (const char* name : {"glass_sphere", "gem"})
    for (const Extreme& e : extremes) {
      SCOPED_TRACE(fmt::format("{} {}", name, e.what));
      scene::Scene scene = asset(name);
      scene.medium.sigmaS = glm::vec3(e.sigmaS);
      scene.medium.g = e.g;
      for (scene::Material& material : scene.materials)
        if (material.transmission > 0) material.ior = e.ior;
      render::Renderer renderer(device(), scene);
      const Image image = picture(renderer, settings(width, height, Term::media,
                                                     {technique("airlight"), technique("volume_caustics")}));
      expectWithin(image, 0, 1e4f);
      if (e.sigmaS > 100) {
        EXPECT_LT(mean(image), 1e-3) << "the light is gone before it gets anywhere";
      }
    }
}

TEST_F(MediaTest, CameraOnALightRayAndLightInsideTheGlass) {
  scene::Scene scene = asset("glass_sphere");
  render::Renderer renderer(device(), scene);
  const glm::vec3 light(renderer.pose().lights.at(0).position);
  renderer.configure(
      settings(width, height, Term::final, {technique("airlight"), technique("volume_caustics")}));
  for (const glm::vec3& eye : {glm::vec3(0.2f, 0.75f, 0), glm::vec3(0.45f, 0.1f, 0), glm::vec3(0, 1.5f, 0)}) {
    renderer.setCamera(scene::lookAt(eye, light, 0.8f));
    renderer.render();
    expectWithin(renderer.read(), 0, 1e5f);
  }
  for (scene::Node& node : scene.nodes)
    if (node.light != scene::kNone) node.transform.translation = {0.1f, 1.6f, 0.05f};
  render::Renderer inside(device(), scene);
  const Image lines = picture(inside, settings(width, height, Term::media, {technique("volume_caustics")}));
  expectWithin(lines, 0, 1e5f);
  EXPECT_NEAR(mean(lines) / mean(reference(inside, scene, Term::media, 64)), 1, 0.05);
}

/// The texel in the middle of an odd number sees the middle of the ball. A ray that is refracted there goes 1
/// m further, 27 pixels, to the floor; what it lights lies within half a pixel of a line, on either side.
TEST_F(MediaTest, OneTexelOfTheBufferIsOneRay) {
  const scene::Scene scene = asset("glass_sphere");
  render::Renderer renderer(device(), scene);
  for (const char* size : {"1", "2", "3"})
    for (const auto& [term, name] :
         {std::pair(Term::media, "volume_caustics"), std::pair(Term::caustic, "surface_caustics")}) {
      const Image image =
          picture(renderer, settings(width, height, term, {technique(name, {{"buffer_size", size}})}));
      expectWithin(image, 0, 1e5f);
      if (std::string(size) != "2") {
        EXPECT_GT(mean(image), 0) << name << " " << size;
      }
    }
  const Image one = picture(
      renderer, settings(width, height, Term::media,
                         {technique("volume_caustics",
                                    {{"buffer_size", "1"}, {"paths", "refraction"}, {"beams", "false"}})}));
  std::vector<glm::dvec2> lit;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (one.at(x, y, 1) > 0) lit.emplace_back(x, y);
  ASSERT_GT(lit.size(), 10u);
  const glm::dvec2 along = glm::normalize(lit.back() - lit.front());
  for (const glm::dvec2& pixel : lit) {
    const glm::dvec2 offset = pixel - lit.front();
    EXPECT_LT(std::abs(along.x * offset.y - along.y * offset.x), 1.5) << pixel.x << "," << pixel.y;
  }
}

}  // namespace
}  // namespace limn
