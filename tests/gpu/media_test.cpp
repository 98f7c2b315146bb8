// Media and the light in them, alone and together with caustics: closed forms, sums of their parts, and
// extremes.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/bench/private/stress_scene.h"
#include "core/scene/camera.h"
#include "tests/gpu/media_harness.h"
#include "tests/gpu/paths_of_devices.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using MediaTest = MediaHarness;

/// What is extreme of a medium, and the media to be looked at around glass of an index.
struct ExtremeMedium {
  const char* what;
  float sigmaS, g;
};
struct MediaOfAnIndex {
  float ior;
  std::vector<ExtremeMedium> media;
};
using Extremes = std::vector<MediaOfAnIndex>;

/// Calls `use` for each medium and index, with the scene and its renderer: one for each index, since a
/// renderer reads materials once and media in each frame.
void forEachMedium(
    gpu::Device& device, const scene::Scene& asset, const Extremes& extremes,
    const std::function<void(render::Renderer&, const scene::Scene&, const ExtremeMedium&)>& use) {
  for (const auto& [ior, media] : extremes) {
    scene::Scene scene = asset;
    for (scene::Material& material : scene.materials)
      if (material.transmission > 0) material.ior = ior;
    render::Renderer renderer(device, scene);
    for (const ExtremeMedium& medium : media) {
      SCOPED_TRACE(medium.what);
      scene.medium.sigmaS = glm::vec3(medium.sigmaS);
      scene.medium.g = medium.g;
      use(renderer, scene, medium);
    }
  }
}

/// Lines are a part of all light that a black picture would pass as far as airlight goes, so they stand
/// alone. A reference of 200,000 light paths has noise of 1 %, and more where the phase function or the
/// medium let few of them count.
TEST_F(MediaTest, LinesAloneAreTheReferencesAtExtremes) {
  const Extremes extremes = {{1.5f,
                              {{"backward", 0.15f, -0.9f},
                               {"forward", 0.15f, 0.9f},
                               {"thin", 1e-3f / 6, 0},
                               {"thick", 10.f / 6, 0}}},
                             {1.0001f, {{"no refraction", 0.15f, 0}}},
                             {2.42f, {{"diamond", 0.15f, 0}}},
                             {3, {{"ior 3", 0.15f, 0}}}};
  forEachMedium(device(), asset("glass_sphere"), extremes,
                [&](render::Renderer& renderer, const scene::Scene& scene, const ExtremeMedium&) {
                  const double lines =
                      mean(picture(renderer, settings(64, 48, Term::media, {technique("volume_caustics")})));
                  EXPECT_NEAR(lines / meanOfLines(renderer, scene), 1, 0.1);
                });
}

/// Lines of a lamp 2 mm behind the camera, through a thin pane between them: each lies in one pixel, from 1
/// m, where the near plane is, to the wall at 10 m. Of the light the medium leaves exp(-kappa (R + R)), which
/// in the middle of the line is a fortieth of what the integral of dR / R^2 makes of it.
TEST_F(MediaTest, LinesSeenEndOnAreDimmedPlaceByPlace) {
  constexpr int size = 16;
  constexpr double kappa = 0.5, behind = 0.002;
  scene::Scene scene;
  scene.medium.sigmaS = glm::vec3(float(kappa));
  scene::Material pane = test::glass(1);
  pane.thickness = 0;
  test::show(scene, test::quad({0, 0, -0.5f * float(behind)}, {8e-4f, 0, 0}, {0, 8e-4f, 0},
                               test::addMaterial(scene, pane)));
  test::show(scene,
             test::quad({0, 0, -10}, {12, 0, 0}, {0, 12, 0}, test::addMaterial(scene, test::lambertian(0))));
  test::shine(scene, test::lamp(glsl::light_point, 1), {0, 0, 0});
  render::Renderer renderer(device(), scene);
  scene::CameraPose camera = scene::lookAt({0, 0, -float(behind)}, {0, 0, -1}, 0.6f);
  camera.near = 1;
  const Image lines =
      picture(renderer,
              settings(size, size, Term::media,
                       {technique("volume_caustics", {{"buffer_size", "512"}, {"paths", "refraction"}})}),
              camera);
  const test::ViewRays rays(camera, renderer.pose().bounds, {size, size});
  double drawn = 0, expected = 0;
  for (int y = 5; y < 11; ++y)
    for (int x = 5; x < 11; ++x) {
      drawn += double(lines.at(x, y, 1));
      const double metresPerDepth = glm::length(rays.ray(x, y));
      constexpr int steps = 4000;
      for (int i = 0; i < steps; ++i) {
        const double r = metresPerDepth * (1 + 9 * (i + 0.5) / steps);
        expected += metresPerDepth * 9 / steps * kappa / (4 * M_PI) * std::exp(-kappa * (2 * r + behind)) /
                    ((r + behind) * (r + behind));
      }
    }
  // Rays of a texel each, of which 25 lie across a pixel: six pixels have 150, give or take one on each side.
  EXPECT_NEAR(drawn / expected, 1, 0.03);
}

/// A disc's radiance is even, so more of its light passes than arrives on a surface that faces it.
TEST_F(MediaTest, AirlightOfADiscIsItsFluence) {
  const auto brightness = [](float angle) {
    scene::Scene scene;
    test::show(scene, test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4},
                                 test::addMaterial(scene, test::lambertian(0.5f))));
    scene::LightSource sun = test::lamp(glsl::light_directional, 1);
    sun.angle = angle;
    test::shine(scene, sun, {0, 3, 0});
    scene.medium.sigmaS = glm::vec3(0.1f);
    render::Renderer renderer(device(), scene);
    return mean(picture(renderer, settings(16, 16, Term::media, {technique("airlight")}),
                        scene::lookAt({0, 0.5f, 1.5f}, {0, 0.5f, 0}, 0.5f)));
  };
  EXPECT_NEAR(brightness(2) / brightness(0), 2 / (1 + std::cos(1.0)), 1e-3);
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
    std::vector<double> usual;  // with beams and without
    for (const char* beams : {"true", "false"}) {
      usual.push_back(brightness(1, "256", beams));
      EXPECT_NEAR(brightness(1, "512", beams) / usual.back(), 1, 0.02) << "beams " << beams;
      EXPECT_NEAR(brightness(2, "256", beams) / usual.back(), 1, 0.02) << "beams " << beams;
    }
    EXPECT_NEAR(usual[0] / usual[1], 1, 0.02);
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
/// thread, llvmpipe leaves all loops after 65,535, also where its device takes the paths for GPUs.
TEST_F(MediaTest, AirlightOfManyPointsAndStretchesIsAllThere) {
  scene::Scene one = asset("glass_sphere");
  const auto lamp =
      std::ranges::find_if(one.nodes, [](const scene::Node& node) { return node.light != scene::kNone; });
  ASSERT_NE(lamp, one.nodes.end());
  lamp->limnArea = {0.2f, 0.2f};
  scene::Scene eight = one;
  for (int i = 1; i < 8; ++i) eight.nodes.push_back(*lamp);
  for (scene::LightSource& light : one.lights) light.intensity *= 8;
  const auto brightness = [&](const scene::Scene& scene, bool hardware) {
    const PathsOfDevices paths(hardware);
    gpu::Device own(context());
    render::Renderer renderer(own, scene);
    return mean(picture(
        renderer,
        settings(12, 9, Term::media,
                 {technique("airlight",
                            {{"steps", "1024"}, {"light_samples", "16"}, {"shadow_map_size", "64"}})})));
  };
  for (const bool hardware : {false, true})
    EXPECT_NEAR(brightness(eight, hardware) / brightness(one, hardware), 1, 1e-4)
        << (hardware ? "paths for GPUs" : "paths of the renderer");
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
  const Extremes extremes = {{1.5f,
                              {{"backward", 0.15f, -0.99f},
                               {"forward", 0.15f, 0.99f},
                               {"thin", 1e-3f / 6, 0},
                               {"thick", 10.f / 6, 0},
                               {"opaque", 1000.f / 6, 0}}},
                             {1.0001f, {{"no refraction", 0.15f, 0}}},
                             {2.42f, {{"diamond", 0.15f, 0}}},
                             {3, {{"ior 3", 0.15f, 0}}}};
  for (const char* name : {"glass_sphere", "gem"}) {
    SCOPED_TRACE(name);
    forEachMedium(device(), asset(name), extremes,
                  [&](render::Renderer& renderer, const scene::Scene&, const ExtremeMedium& medium) {
                    const Image image =
                        picture(renderer, settings(width, height, Term::media,
                                                   {technique("airlight"), technique("volume_caustics")}));
                    expectWithin(image, 0, 1e4f);
                    if (medium.sigmaS > 100) {
                      EXPECT_LT(mean(image), 1e-3) << "the light is gone before it gets anywhere";
                    }
                  });
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
  for (const auto& [term, name] :
       {std::pair(Term::media, "volume_caustics"), std::pair(Term::caustic, "surface_caustics")}) {
    const double usual = mean(picture(renderer, settings(width, height, term, {technique(name)})));
    for (const char* size : {"1", "2", "3"}) {
      const Image image =
          picture(renderer, settings(width, height, term, {technique(name, {{"buffer_size", size}})}));
      expectWithin(image, 0, 1e5f);
      // The view holds the corners of the ball's box and a quarter more: 5.7 times the ball's solid angle,
      // and what goes through its middle is hardly reflected.
      EXPECT_LT(mean(image), 8 * usual) << name << " " << size;
      if (std::string(size) != "2") {
        EXPECT_GT(mean(image), 0) << name << " " << size;
      }
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
