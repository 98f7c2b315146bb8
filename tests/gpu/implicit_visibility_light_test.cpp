// Which light implicit visibility reflects, and how much of it: lights that are chosen, skies, suns, media.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/shading/environment_decomposition.h"
#include "tests/gpu/ball_scene.h"
#include "tests/gpu/foggy_ball.h"
#include "tests/gpu/render_test.h"
#include "tests/support/environment_maps.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

class ImplicitVisibilityLightTest : public RenderTest {
 protected:
  /// A floor and a wall, 2 m wide, and a lamp, whose node is the last.
  static scene::Scene corner() {
    scene::Scene scene;
    const int material = test::addMaterial(scene, test::lambertian(0.5f));
    test::show(scene, test::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, material));
    test::show(scene, test::quad({0, 1, -1}, {2, 0, 0}, {0, 2, 0}, material));
    test::shine(scene, test::lamp(glsl::light_point, 10), {0.3f, 1.2f, 0.2f});
    return scene;
  }
  static scene::CameraPose camera() { return scene::lookAt({1.2f, 1.2f, 2.5f}, {0, 0.5f, -0.3f}, 0.8f); }

  static scene::Environment uniformSky(float radiance) {
    return test::environmentOf(32, [radiance](const glm::vec3&) { return glm::vec3(radiance); });
  }

  /// A floor and a wall, 2 cm wide, in the middle of a ball of 1 m that specks beside them span: light from
  /// all sides has the same way to them through what fills the ball.
  static scene::Scene smallCorner(const scene::Material& material) {
    scene::Scene scene;
    const int index = test::addMaterial(scene, material);
    test::show(scene, test::quad({0, 0, 0}, {0.02f, 0, 0}, {0, 0, -0.02f}, index));
    test::show(scene, test::quad({0, 0.01f, -0.01f}, {0.02f, 0, 0}, {0, 0.02f, 0}, index));
    for (const float x : {-1.f, 1.f})
      test::show(scene, test::quad({x, 0, 0}, {0.002f, 0, 0}, {0, 0, -0.002f}, index));
    return scene;
  }

  static render::TechniqueUse coarse(TermSet terms = kAnswerableTerms) {
    render::TechniqueUse use = technique("implicit_visibility", {{"bins", "8"}, {"longest_edge", "0.1"}});
    use.terms = terms;
    return use;
  }
  /// Returns how many passes look up V of lights in bins.
  static size_t lookUps(const render::Renderer& renderer) {
    return static_cast<size_t>(std::ranges::count_if(renderer.explain(), [](const frame::PassReport& pass) {
      return pass.technique == "implicit_visibility" && pass.name.starts_with("light visibility") &&
             pass.state != frame::PassState::leftOut;
    }));
  }
  static Image bounce(const scene::Scene& scene, int light, TermSet terms = kAnswerableTerms) {
    render::Renderer renderer(device(), scene);
    return picture(renderer, settings(64, 48, Term::indirect, {coarse(terms)}, light), camera());
  }
};

/// It does as in references, also where it is the only lamp.
TEST_F(ImplicitVisibilityLightTest, AChosenLightBouncesWithoutTheEnvironment) {
  const scene::Scene dark = corner();
  scene::Scene sky = dark;
  sky.environment = uniformSky(10);
  const Image alone = bounce(dark, 0), chosen = bounce(sky, 0), all = bounce(sky, -1);
  EXPECT_EQ(rmse(chosen, alone), 0);
  EXPECT_GT(mean(alone), 0);
  EXPECT_GT(mean(all), 2 * mean(alone));
}

/// Neither a bin looks at it, nor are there elements where it is the only light.
TEST_F(ImplicitVisibilityLightTest, ABlackEnvironmentCostsNothing) {
  const scene::Scene lit = corner();
  scene::Scene night = lit;
  night.environment = uniformSky(1);
  night.environment.scale = 0;
  EXPECT_EQ(rmse(bounce(night, -1), bounce(lit, -1)), 0);
  const auto passesOf = [&](const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    picture(renderer, settings(64, 48, Term::final, {coarse(Term::indirect | Term::environment)}), camera());
    std::vector<std::string> names;
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.technique == "implicit_visibility" && pass.state != frame::PassState::leftOut)
        names.push_back(pass.name);
    return names;
  };
  EXPECT_EQ(passesOf(night), passesOf(lit));
  EXPECT_FALSE(passesOf(lit).empty());
  scene::Scene dark = night;
  dark.nodes.back().light = scene::kNone;
  EXPECT_TRUE(passesOf(dark).empty());
}

/// Whether or not the technique answers the environment's own light as well. Lights and map differ in V,
/// which is by points even over each rectangle for the former.
TEST_F(ImplicitVisibilityLightTest, TheEnvironmentBouncesOnceWhereLightsStandForIt) {
  scene::Scene map = corner();
  map.nodes.back().light = scene::kNone;
  map.environment = uniformSky(1);
  scene::Scene lights = map;
  lights.environment.lights =
      shading::decomposeEnvironment(map.environment, {.threshold = 0.02, .resolution = 24}).lights;
  const double wanted = mean(bounce(map, -1));
  EXPECT_GT(wanted, 0);
  for (const TermSet terms : {kAnswerableTerms, termSet(Term::indirect)})
    EXPECT_NEAR(mean(bounce(lights, -1, terms)) / wanted, 1, 0.2) << terms;
}

/// Under an even sky of radiance 1, a normal that is turned by beta from the surface's sees (1 + cos beta) /
/// 2 of what a free one would: the form factor of the half space above the surface. Bins add 1 % to its edge.
TEST_F(ImplicitVisibilityLightTest, NoLightArrivesFromBelowTheSurface) {
  scene::Scene scene;
  scene.images.emplace_back().levels.push_back({1, 1, {238, 128, 191, 255}});
  const glm::vec3 mapped = 2.f / 255 * glm::vec3(238, 128, 191) - 1.f;
  scene::Material material = test::lambertian(0.5f);
  material.normalTexture.image = 0;
  test::show(scene, test::floorPrimitive(1, test::addMaterial(scene, material)));
  scene.environment = uniformSky(1);
  render::Renderer renderer(device(), scene);
  const Image seen =
      picture(renderer,
              settings(32, 32, Term::direct,
                       {technique("implicit_visibility", {{"longest_edge", "0.3"}, {"display", "pixel"}})}),
              scene::lookAt({0, 2, 0.01f}, {0, 0, 0}, 0.5f));
  const float cosine = glm::normalize(mapped).z;
  EXPECT_NEAR(cosine, 0.5, 0.01);
  EXPECT_NEAR(seen.at(16, 16, 0), 0.5 * 0.5 * (1 + double(cosine)), 0.01);
}

/// Indirect light is asked for twice: what surfaces reflect, and what enters them.
TEST_F(ImplicitVisibilityLightTest, TranslucentSurfacesShareTheBouncesOfOthers) {
  scene::Scene scene = corner();
  scene.materials[0].subsurface = scene::Subsurface{};
  render::Renderer renderer(device(), scene);
  picture(renderer, settings(64, 48, Term::final, {coarse()}), camera());
  int gathered = 0, shown = 0;
  for (const frame::PassReport& pass : renderer.explain()) {
    if (pass.technique != "implicit_visibility" || pass.state == frame::PassState::leftOut) continue;
    gathered += pass.name.starts_with("gather") ? 1 : 0;
    shown += pass.name.starts_with("interpolate") ? 1 : 0;
  }
  EXPECT_EQ(gathered, 1);
  EXPECT_EQ(shown, 2);
}

/// On the way to the wall and on that to the eye, 1 m each; between parts of the wall light is free. Within
/// exp(-1.992), where triangles cut the ball, by which the quotient rises to 0.1364.
TEST_F(ImplicitVisibilityLightTest, AMediumTakesOfLightFromTheLampToTheWall) {
  const auto seen = [](const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    return mean(picture(renderer, settings(32, 32, Term::indirect, {coarse()}), test::foggyBallCamera()));
  };
  const double clear = seen(test::foggyBall());
  EXPECT_GT(clear, 0);
  for (const bool grid : {false, true}) {
    scene::Scene fog = test::foggyBall();
    test::fillWithFog(fog, grid);
    EXPECT_NEAR(seen(fog) / clear, std::exp(-2.0), 0.003) << grid;
  }
}

/// A spot that shines through glass of one colour brings that colour on over surfaces, sent evenly and into
/// bins.
TEST_F(ImplicitVisibilityLightTest, TheTextureOfASpotColoursTheBounce) {
  constexpr size_t kTexels = size_t{scene::LightTexture::side} * scene::LightTexture::side;
  const glm::vec3 colour(1, 0.25f, 0);
  scene::Scene plain = corner();
  plain.lights[0] = test::lamp(glsl::light_spot, 10);
  scene::Scene stained = plain;
  stained.lights[0].texture = 0;
  stained.lightTextures.push_back({std::vector<glm::vec3>(kTexels, colour)});
  for (const char* bins : {"0", "4"}) {
    const auto seen = [&](const scene::Scene& scene) {
      render::Renderer renderer(device(), scene);
      const render::TechniqueUse use =
          technique("implicit_visibility", {{"bins", "8"}, {"longest_edge", "0.1"}, {"glossy_bins", bins}});
      return picture(renderer, settings(64, 48, Term::indirect, {use}), camera());
    };
    const Image white = seen(plain), coloured = seen(stained);
    EXPECT_GT(mean(white), 1e-3) << bins;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(coloured.at(x, y, c), colour[c] * white.at(x, y, c), 1e-6) << bins;
  }
}

/// On the way to the surface that it meets first and on that to the eye, however bins are shown and sent on.
/// Places lie 1 cm off the middle of the ball.
TEST_F(ImplicitVisibilityLightTest, AMediumTakesOfTheEnvironmentsLight) {
  const glm::vec3 eye(0.15f, 0.25f, 0.4f), middle(0, 0.005f, 0);
  scene::Material satin;
  satin.baseColour = glm::vec4(0.5f, 0.5f, 0.5f, 1);
  satin.roughness = 0.5f;
  const auto expectLess = [&](const scene::Material& material, Term term, const char* parameter,
                              const char* value) {
    SCOPED_TRACE(parameter);
    const auto seen = [&](const scene::Scene& scene) {
      render::Renderer renderer(device(), scene);
      const render::TechniqueUse use =
          technique("implicit_visibility", {{"bins", "8"}, {"longest_edge", "0.005"}, {parameter, value}});
      return mean(picture(renderer, settings(48, 48, term, {use}), scene::lookAt(eye, middle, 0.04f)));
    };
    scene::Scene clear = smallCorner(material);
    clear.environment = uniformSky(1);
    const double before = seen(clear);
    EXPECT_GT(before, 0);
    const double ways =
        double(scene::evaluate(clear, 0).bounds.radius()) + double(glm::distance(eye, middle));
    for (const bool grid : {false, true}) {
      scene::Scene fog = clear;
      test::fillWithFog(fog, grid);
      EXPECT_NEAR(seen(fog) / before / std::exp(-ways), 1, 0.03) << grid;
    }
  };
  expectLess(test::lambertian(0.5f), Term::direct, "display", "vertex");
  expectLess(satin, Term::direct, "display", "pixel");
  expectLess(test::lambertian(0.5f), Term::indirect, "links", "gpu");
  expectLess(satin, Term::indirect, "glossy_bins", "4");
}

/// What a medium leaves of light depends on where the light and the surface are.
TEST_F(ImplicitVisibilityLightTest, LightThroughAMediumIsKeptWhileOnlyTheCameraMoves) {
  for (const bool grid : {false, true})
    for (const char* bins : {"0", "4"}) {
      scene::Scene scene = corner();
      scene.environment = uniformSky(1);
      test::fillWithFog(scene, grid);
      render::Renderer renderer(device(), scene);
      const render::TechniqueUse use =
          technique("implicit_visibility", {{"bins", "8"}, {"longest_edge", "0.1"}, {"glossy_bins", bins}});
      render::Settings asked = settings(64, 48, Term::indirect, {use});
      asked.dynamic = false;
      picture(renderer, asked, camera());
      renderer.setCamera(scene::lookAt({1.3f, 1.1f, 2.5f}, {0, 0.5f, -0.3f}, 0.8f));
      renderer.render();
      int kept = 0, shown = 0;
      for (const frame::PassReport& pass : renderer.explain()) {
        if (pass.technique != "implicit_visibility" || pass.state == frame::PassState::leftOut) continue;
        const bool shows = pass.name.starts_with("interpolate");
        shown += shows && pass.state == frame::PassState::run;
        if (!pass.name.starts_with("direct light") && !pass.name.starts_with("environment light") &&
            !pass.name.starts_with("reflect") && !pass.name.starts_with("gather"))
          continue;
        EXPECT_EQ(pass.state, frame::PassState::cached) << pass.name << ", " << grid << ", " << bins;
        ++kept;
      }
      EXPECT_GE(kept, 3);
      EXPECT_EQ(shown, 1);
    }
}

/// Core asks for V of 8 lights at a time, and the bounce for all: both look up the same bins.
TEST_F(ImplicitVisibilityLightTest, BinsAreLookedUpOnceForEachOfManyLights) {
  constexpr int kLights = 11;
  const scene::Scene one = corner();
  scene::Scene many = one;
  many.lights[0].intensity /= kLights;
  const scene::LightSource share = many.lights[0];
  for (int i = 1; i < kLights; ++i) test::shine(many, share, {0.3f, 1.2f, 0.2f});
  render::Renderer single(device(), one), renderer(device(), many);
  const Image wanted = picture(single, settings(64, 48, Term::final, {coarse()}), camera());
  const Image image = picture(renderer, settings(64, 48, Term::final, {coarse()}), camera());
  EXPECT_LT(rmse(image, wanted), 1e-5 * mean(wanted));
  EXPECT_EQ(lookUps(renderer), 2u);
}

/// Core asks for V of the environment's lights apart from that of others where it sums them up by themselves.
TEST_F(ImplicitVisibilityLightTest, BinsAreLookedUpOnceWhereTheEnvironmentsLightsAreApart) {
  scene::Scene scene = corner();
  scene.environment = uniformSky(1);
  scene.environment.lights =
      shading::decomposeEnvironment(scene.environment, {.threshold = 0.02, .resolution = 24}).lights;
  scene.environment.shadowedByRatio = true;
  const size_t ofSky = scene.environment.lights.size();
  ASSERT_GT(ofSky, 0u);
  render::Renderer renderer(device(), scene);
  picture(renderer, settings(64, 48, Term::final, {coarse(Term::visibility | Term::indirect)}), camera());
  EXPECT_EQ(lookUps(renderer), 1 + (ofSky + 7) / 8);
}

class ImplicitVisibilitySunTest : public test::BallTest {};

/// The first point of the sequence is the corner of the square around a sun's disc, which is no part of it.
/// Of 0.39 m around the middle of the ball's shadow nothing of the sun is seen; elements are 0.18 m wide.
TEST_F(ImplicitVisibilitySunTest, OnePointOfASunCastsAShadow) {
  const test::BallScene s;
  const test::Answer v = visibility("implicit_visibility", {{"light_samples", "1"}, {"outlines", "vertex"}},
                                    s.scene, s.pose, s.camera, {2});
  int umbra = 0, dark = 0;
  for (int y = 0; y < side; y += 2)
    for (int x = 0; x < side; x += 2) {
      if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
      if (test::exactVisibility(s.pose.lights[2], s.position(v, x, y), test::ballHides) > 0) continue;
      ++umbra;
      if (v.at(0, x, y) < 0.5f) ++dark;
    }
  std::printf("one point of a sun: %d of %d pixels in full shadow are dark\n", dark, umbra);
  EXPECT_GT(umbra, 20);
  EXPECT_GT(dark, 0.8 * umbra);
}

/// A disc that hides the cone of 0.5 rad around the middle of a sun of 1 rad leaves the solid angle
/// (cos 0.5 - cos 1) / (1 - cos 1) = 0.734 of it, and 0.877 of the area of its disc on a plane.
TEST_F(ImplicitVisibilitySunTest, WideSunsCountBySolidAngle) {
  constexpr int corners = 64;
  scene::Scene scene;
  scene::Pose pose;
  scene::Material twoSided;
  twoSided.doubleSided = true;
  test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
  scene::Primitive disc;
  disc.material = test::addMaterial(scene, twoSided);
  disc.positions.push_back(glm::vec3(0));
  for (int i = 0; i < corners; ++i) {
    const float angle = 2 * glsl::pi * static_cast<float>(i) / corners;
    disc.positions.push_back(std::tan(0.5f) * glm::vec3(std::sin(angle), 0, std::cos(angle)));
    disc.indices.insert(disc.indices.end(),
                        {0, static_cast<uint32_t>(1 + i), static_cast<uint32_t>(1 + (i + 1) % corners)});
  }
  disc.normals.assign(disc.positions.size(), {0, 1, 0});
  test::addMesh(scene, test::finish(disc));
  test::addInstance(scene, pose, 0);
  test::addInstance(scene, pose, 1, test::at(0, 1, 0));
  test::addLight(pose, test::directionalLight({0, -1, 0}, 2));
  const scene::CameraPose camera = scene::lookAt({0, 0.5f, 2.5f}, {0, 0, 0}, 0.4f);
  const test::Answer v =
      visibility("implicit_visibility",
                 {{"bins", "32"}, {"fill", "triangles"}, {"longest_edge", "0.06"}, {"light_samples", "1024"}},
                 scene, pose, camera);
  double sum = 0;
  int count = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
      if (glm::length(test::positionOf(v, camera, pose.bounds, x, y)) > 0.1f) continue;
      sum += v.at(0, x, y);
      ++count;
    }
  ASSERT_GT(count, 20);
  std::printf("half hidden sun of 2 rad: V %.3f\n", sum / count);
  EXPECT_NEAR(sum / count, (std::cos(0.5) - std::cos(1.0)) / (1 - std::cos(1.0)), 0.06);
}

}  // namespace
}  // namespace limn
