// Caustics on surfaces against the reference, splatted on the screen and into maps of the light.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/render/supersample.h"
#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "glsl/diffusion/boundary.glsl"
#include "tests/gpu/media_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using SurfaceCausticsTest = MediaHarness;

/// As bright, and as sharp: of the ring's two sheets one leaves the spot's cone, and its cusp is thinner than
/// the distance between photons.
TEST_F(SurfaceCausticsTest, SurfaceCausticsAreThoseOfTheReference) {
  struct Bound {
    const char* scene;
    double rms;  ///< relative, with the noise of the reference
  };
  for (const auto& [name, ofRms] : {Bound{"glass_sphere", 0.03}, Bound{"gem", 0.08}, Bound{"ring", 0.35}}) {
    scene::Scene scene = asset(name);
    scene.medium = {};
    render::Renderer renderer(device(), scene);
    const Image truth = reference(renderer, scene, Term::caustic, 64);
    for (const char* splat : {"screen", "light"}) {
      SCOPED_TRACE(fmt::format("{} {}", name, splat));
      const Image ours = picture(renderer, settings(width, height, Term::caustic,
                                                    {technique("surface_caustics", {{"splat", splat}})}));
      EXPECT_NEAR(mean(ours) / mean(truth), 1, 0.03);
      EXPECT_LT(relativeRms(ours, truth), ofRms);
    }
  }
}

/// A lamp between two balls has a view of its own to each side of it, and the edge between two of these cuts
/// a ball. Light that left the glass at that edge would be 7.5 % too little, and off by 0.31.
TEST_F(SurfaceCausticsTest, ABodyThatLiesInTwoViewsRefractsAsOne) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  for (scene::LightSource& light : scene.lights) light.type = glsl::light_point;
  const auto ball = std::ranges::find(scene.nodes, "ball", &scene::Node::name);
  ASSERT_NE(ball, scene.nodes.end());
  scene::Node other = *ball;
  ball->transform.translation = {-0.2f, 0.65f, 0};
  other.transform.translation = {-2, 2.45f, 0};
  scene.nodes.push_back(other);
  for (scene::Node& node : scene.nodes)
    if (node.light != scene::kNone) node.transform.translation = {-1.1f, 1.75f, 0};
  render::Renderer renderer(device(), scene);
  const Image truth = reference(renderer, scene, Term::caustic, 1024);
  const Image ours = picture(renderer, settings(width, height, Term::caustic,
                                                {technique("surface_caustics", {{"buffer_size", "384"}})}));
  EXPECT_NEAR(mean(ours) / mean(truth), 1, 0.03);
  EXPECT_LT(relativeRms(ours, truth), 0.15);
  const Image map = picture(
      renderer, settings(width, height, Term::caustic,
                         {technique("surface_caustics", {{"buffer_size", "384"}, {"splat", "light"}})}));
  EXPECT_NEAR(mean(map) / mean(truth), 1, 0.05);
}

/// Where light goes does not depend on who looks, in a medium or without one.
TEST_F(SurfaceCausticsTest, RaysAreKeptWhileOnlyTheCameraMoves) {
  for (const bool medium : {false, true}) {
    scene::Scene scene = asset("glass_sphere");
    if (!medium) scene.medium = {};
    render::Renderer renderer(device(), scene);
    render::Settings asked = settings(width, height, Term::caustic, {technique("surface_caustics")});
    asked.dynamic = false;
    picture(renderer, asked);
    renderer.setCamera(scene::lookAt({0.6f, 4, 0.01f}, {0.6f, 0, 0}, 0.3f));
    renderer.render();
    int kept = 0;
    for (const frame::PassReport& pass : renderer.explain()) {
      if (pass.name != "caustic rays") continue;
      EXPECT_EQ(pass.state, frame::PassState::cached) << "medium " << medium;
      ++kept;
    }
    EXPECT_EQ(kept, 1);
  }
}

/// Which rays are photons, and what a map of the light holds of them, does not depend on who looks either.
/// What is kept goes when light or glass moves.
TEST_F(SurfaceCausticsTest, PhotonsAreListedAndMapsMadeOnceWhileOnlyTheCameraMoves) {
  for (const bool map : {false, true}) {
    SCOPED_TRACE(map ? "light" : "screen");
    scene::Scene scene = asset("glass_sphere");
    render::Renderer renderer(device(), scene);
    render::Settings asked = settings(width, height, Term::caustic,
                                      {technique("surface_caustics", {{"splat", map ? "light" : "screen"}})});
    asked.dynamic = false;
    picture(renderer, asked);
    const scene::CameraPose above = scene::lookAt({0.6f, 4, 0.01f}, {0.6f, 0, 0}, 0.3f);
    renderer.setCamera(above);
    renderer.render();
    const Image kept = renderer.read();
    std::vector<std::string> cached;
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.technique == "surface_caustics" && pass.state == frame::PassState::cached)
        cached.push_back(pass.name);
    std::vector<std::string> wanted{"ray kinds", "ray places", "ray lists"};
    if (map) wanted.insert(wanted.end(), {"caustic map draws", "caustic map"});
    EXPECT_EQ(cached, wanted);
    render::Renderer fresh(device(), scene);
    const Image first = picture(fresh, asked, above);
    EXPECT_GT(mean(first), 0);
    EXPECT_TRUE(sameBits(kept, first));

    for (scene::Node& node : scene.nodes)
      if (node.light != scene::kNone) node.transform.translation.x += 0.5f;
    renderer.setTime(0);
    renderer.render();
    const Image moved = renderer.read();
    EXPECT_FALSE(sameBits(moved, kept));
    render::Renderer other(device(), scene);
    EXPECT_TRUE(sameBits(moved, picture(other, asked, above)));
  }
}

/// A floor under a layer of index 1.8 that is seen head-on: of what the layer leaves to the diffuse part,
/// Fresnel's term at the half vector takes ((n - 1) / (n + 1))^2, and less than 0.002 more (Schlick's (1 -
/// v.h)^5 is at most 0.0022 there, at grazing incidence).
TEST_F(SurfaceCausticsTest, DielectricFloorsReflectWhatFresnelLeaves) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  const auto brightness = [&] {
    render::Renderer renderer(device(), scene);
    renderer.configure(settings(width, height, Term::caustic, {technique("surface_caustics")}));
    renderer.setCamera(scene::lookAt({0.6f, 4, 0.01f}, {0.6f, 0, 0}, 0.3f));
    renderer.render();
    return mean(renderer.read());
  };
  const double matte = brightness();
  ASSERT_GT(matte, 0);
  for (scene::Material& m : scene.materials) {
    if (m.specularSurface()) continue;
    m.specularFactor = m.roughness = 1;
    m.ior = 1.8f;
  }
  EXPECT_NEAR(brightness() / matte, 1 - std::pow(0.8 / 2.8, 2), 0.004);
}

/// A floor with a model shows of a caustic what its diffuse part reflects: that of kd = 0.6 what the
/// Lambertian floor of that albedo does, whatever its lobe, and the reference's without one. Under a coat of
/// index 1.5 that is seen head-on it shows (1 - F) (1 - Fi) / (1 - kd Fi) of it: F = 0.04 is reflected at the
/// coat, and Fi = 0.596 of diffuse light below it.
TEST_F(SurfaceCausticsTest, FloorsWithAModelReflectTheirDiffusePart) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  const auto brightness = [&](bool compared = false) {
    render::Renderer renderer(device(), scene);
    const render::Settings asked = settings(width, height, Term::caustic, {technique("surface_caustics")});
    if (compared) {
      EXPECT_NEAR(mean(picture(renderer, asked)) / mean(reference(renderer, scene, Term::caustic, 64)), 1,
                  0.03);
    }
    return mean(picture(renderer, asked, scene::lookAt({0.6f, 4, 0.01f}, {0.6f, 0, 0}, 0.3f)));
  };
  const auto paint = [&](const glsl::MaterialModel* model) {
    for (scene::Material& m : scene.materials) {
      if (m.specularSurface()) continue;
      m = test::lambertian(0.6f);
      if (model) scene::setModel(m, *model);
    }
  };
  paint(nullptr);
  const double matte = brightness();
  ASSERT_GT(matte, 0);
  glsl::MaterialModel model{};
  model.kind = glsl::model_phong;
  model.kd = glm::vec3(0.6f);
  model.exponent = 10;
  paint(&model);
  EXPECT_NEAR(brightness(true) / matte, 1, 1e-3);
  model.ks = glm::vec3(0.3f);
  paint(&model);
  EXPECT_NEAR(brightness() / matte, 1, 1e-3);
  model = {};
  model.kind = glsl::model_coated;
  model.options = glsl::model_option_physical;
  model.eta = glm::vec3(1.5f);
  model.kd = glm::vec3(0.6f);
  paint(&model);
  EXPECT_NEAR(brightness() / matte, (1 - 0.04) * (1 - 0.596) / (1 - 0.6 * 0.596), 0.01);
}

/// A translucent floor shows a caustic by its local limit: of what enters, F_t of what arrives, A F_t / (1 -
/// F_de) comes out. Maps of the light do not know where it comes from: what enters is 1 - F_de, the mean of
/// F_t, in place of 3/4, which enters within 30 degrees of the normal. With an index of 3 and a camera that
/// looks along the floor a Lambertian one of the same albedo would be 1.44 times as bright.
TEST_F(SurfaceCausticsTest, TranslucentFloorsShowTheirLocalLimit) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  for (scene::Material& m : scene.materials) {
    if (m.specularSurface()) continue;
    m = test::lambertian(0.6f);
    m.ior = 3;
    m.subsurface.emplace();
  }
  render::Renderer renderer(device(), scene);
  const double truth = mean(reference(renderer, scene, Term::caustic, 64));
  const auto ratio = [&](const char* splat) {
    return mean(picture(renderer, settings(width, height, Term::caustic,
                                           {technique("surface_caustics", {{"splat", splat}})}))) /
           truth;
  };
  EXPECT_NEAR(ratio("screen"), 1, 0.02);
  EXPECT_NEAR(ratio("light"), double(glsl::diffusion_boundary(3.f).entering) / 0.75, 0.02);
}

/// A photon has at least a pixel's width already: samples beside a pixel's middle do not move it, or a pixel
/// would hold the mean over two (off by 0.024 here).
TEST_F(SurfaceCausticsTest, PhotonsArePixelsWideHoweverManySamplesAPixelHas) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  render::Renderer renderer(device(), scene);
  renderer.configure(settings(width, height, Term::caustic, {technique("surface_caustics")}));
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  const Image one = render::supersample(renderer, camera, {width, height}, 1);
  ASSERT_GT(mean(one), 0);
  EXPECT_LT(relativeRms(render::supersample(renderer, camera, {width, height}, 2), one), 0.005);
}

/// The search for the end of a ray begins on the steep sides of what it leaves as well: points close together
/// are not to find it within. A ball would lose 2.7 % of its caustic that way, and the ring 14 %.
TEST_F(SurfaceCausticsTest, AFinerSearchLosesNoLight) {
  for (const char* name : {"glass_sphere", "ring"}) {
    scene::Scene scene = asset(name);
    scene.medium = {};
    render::Renderer renderer(device(), scene);
    const auto brightness = [&](const char* steps) {
      return mean(picture(renderer, settings(64, 48, Term::caustic,
                                             {technique("surface_caustics", {{"ray_steps", steps}})})));
    };
    EXPECT_NEAR(brightness("1024") / brightness("64"), 1, 0.005) << name;
  }
}

/// Under the floor, which ends 2.5 m from its middle, goes on another one to 600 m: the points at which rays
/// are searched for their ends lie 13 m apart then. Bisected eight times they are 5 cm apart, and photons
/// that lie more than their width of 1 cm above or below the floor do not light it: half of them.
TEST_F(SurfaceCausticsTest, ASceneThatReachesFarHasTheCausticsOfWhatIsNear) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  const auto brightness = [&] {
    render::Renderer renderer(device(), scene);
    return mean(picture(renderer, settings(width, height, Term::caustic, {technique("surface_caustics")}),
                        scene::lookAt({0.6f, 4, 0.01f}, {0.6f, 0, 0}, 0.3f)));
  };
  const double near = brightness();
  ASSERT_GT(near, 0);
  test::show(scene, test::quad({0, -0.01f, 0}, {1200, 0, 0}, {0, 0, -1200},
                               test::addMaterial(scene, test::lambertian(0.5f))));
  EXPECT_NEAR(brightness() / near, 1, 0.03);
}

/// All of the floor is seen by the light. Where the ring's caustic is thinner than a pixel, photons on the
/// screen are wider than those in the map: a kernel has at least a pixel, or a texel.
TEST_F(SurfaceCausticsTest, CausticMapsShowWhatPhotonsOnTheScreenDo) {
  struct Bound {
    const char* scene;
    double mean, rms;  ///< relative
  };
  for (const auto& [name, ofMean, ofRms] : {Bound{"glass_sphere", 0.01, 0.1}, Bound{"gem", 0.01, 0.1},
                                            Bound{"gem_4_lights", 0.01, 0.1}, Bound{"ring", 0.05, 0.3}}) {
    SCOPED_TRACE(name);
    scene::Scene scene = asset(name);
    scene.medium = {};
    render::Renderer renderer(device(), scene);
    const auto splat = [&](const char* where) {
      return picture(renderer, settings(width, height, Term::caustic,
                                        {technique("surface_caustics", {{"splat", where}})}));
    };
    const Image screen = splat("screen"), map = splat("light");
    EXPECT_EQ(stateOf(renderer, "surface_caustics", "caustic map"), "run");
    EXPECT_EQ(stateOf(renderer, "surface_caustics", "photons"), "unknown");
    EXPECT_NEAR(mean(map) / mean(screen), 1, ofMean);
    EXPECT_LT(relativeRms(map, screen), ofRms);
  }
}

/// Layers of the maps have draws for photons of their own point on the light alone: as many for each, however
/// many points there are.
TEST_F(SurfaceCausticsTest, DrawsOfCausticMapsGrowWithThePointsOnLights) {
  scene::Scene scene = asset("glass_sphere");
  for (scene::Node& node : scene.nodes)
    if (node.light != scene::kNone) node.limnArea = {0.2f, 0.2f};
  render::Renderer renderer(device(), scene);
  const auto bytesOfDraws = [&](const char* points) {
    picture(renderer, settings(8, 6, Term::caustic,
                               {technique("surface_caustics", {{"splat", "light"},
                                                               {"buffer_size", "8"},
                                                               {"scene_map_size", "16"},
                                                               {"light_samples", points}})}));
    int64_t bytes = 0;
    for (const auto& pass : renderer.explain())
      for (const auto& access : pass.accesses)
        if (pass.name == "caustic map draws" && access.write) bytes += access.bytes;
    return bytes;
  };
  const int64_t two = bytesOfDraws("2");
  EXPECT_GT(two, 0);
  EXPECT_EQ(bytesOfDraws("16"), 8 * two);
}

/// A point light's map is a cube: photons near its edges lie in two faces.
TEST_F(SurfaceCausticsTest, CausticMapsOfCubesHaveNoSeams) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  for (scene::LightSource& light : scene.lights) light.type = glsl::light_point;
  render::Renderer renderer(device(), scene);
  const auto brightness = [&](const char* where) {
    return mean(picture(renderer, settings(width, height, Term::caustic,
                                           {technique("surface_caustics", {{"splat", where}})})));
  };
  EXPECT_NEAR(brightness("light") / brightness("screen"), 1, 0.02);
}

/// Depth maps of a lamp of 8192 x 8192 texels a face fit what a request may take; caustic maps of as many
/// texels would take 6 GiB.
TEST_F(SurfaceCausticsTest, CausticMapsThatTakeTooMuchMemoryAreRefused) {
  scene::Scene scene = asset("glass_sphere");
  for (scene::LightSource& light : scene.lights) light.type = glsl::light_point;
  render::Renderer renderer(device(), scene);
  const auto draw = [&] {
    picture(renderer,
            settings(8, 6, Term::caustic,
                     {technique("surface_caustics", {{"splat", "light"}, {"scene_map_size", "8192"}})}));
  };
  EXPECT_THAT(draw, testing::ThrowsMessage<UsageError>(testing::HasSubstr("caustic maps of 6 layers")));
}

}  // namespace
}  // namespace limn
