// What the camera sees in specular surfaces: against closed forms and the reference with the same limit, and
// what is left out where there are none.
#include <fmt/format.h>

#include <array>

#include "core/bench/private/stress_scene.h"
#include "core/render/supersample.h"
#include "core/scene/camera.h"
#include "tests/gpu/media_harness.h"
#include "tests/support/environment_maps.h"
#include "tests/support/scene_nodes.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;
using test::quad;
using test::show;

class SpecularTest : public MediaHarness {
 protected:
  static render::TechniqueUse refraction(
      const std::vector<std::pair<std::string, std::string>>& values = {}) {
    return technique("image_space_refraction", values);
  }

  static Image truth(render::Renderer& renderer, const scene::Scene& scene, const scene::CameraPose& camera,
                     int interfaces, int spp, Term term = Term::specular) {
    reference::Request asked = test::request(scene, renderer.pose(), camera, {width, height}, term, spp);
    asked.interfaces = interfaces;
    return reference::render(asked).image;
  }

  static double luminance(const Image& image, int x, int y) {
    return (double(image.at(x, y, 0)) + double(image.at(x, y, 1)) + double(image.at(x, y, 2))) / 3;
  }

  /// Share of the pixels in which `truth` shows anything that differ from it by more than a tenth of what
  /// these show on average.
  static double shareOff(const Image& image, const Image& truth) {
    double sum = 0;
    int shown = 0, off = 0;
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width(); ++x) {
        sum += luminance(truth, x, y);
        shown += luminance(truth, x, y) > 0;
      }
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width(); ++x)
        off += luminance(truth, x, y) > 0 &&
               !(std::abs(luminance(image, x, y) - luminance(truth, x, y)) <= 0.1 * sum / shown);
    return shown > 0 ? double(off) / shown : 0;
  }

  static int addLambert(scene::Scene& scene) { return test::addMaterial(scene, test::lambertian(1)); }
  static int addGlass(scene::Scene& scene, float ior) { return test::addMaterial(scene, test::glass(ior)); }

  /// A white wall at z = -3, facing +z, and a lamp before it.
  static scene::Scene wall() {
    scene::Scene scene;
    show(scene, quad({0, 0, -3}, {20, 0, 0}, {0, 20, 0}, addLambert(scene)));
    scene::LightSource source;
    source.intensity = 10;
    scene.lights.push_back(source);
    scene::Node node;
    node.light = 0;
    node.transform.translation = vec3(lamp);
    scene.nodes.push_back(node);
    return scene;
  }
  static constexpr dvec3 lamp{0.3, 0.2, -1.5};
  static double wallAt(const dvec3& p) {
    const dvec3 towards = lamp - p;
    return 10 / double(glsl::pi) * towards.z / std::pow(glm::length(towards), 3);
  }

  /// How much of the picture of what is seen in glass, under a sky, changes where the matte `pane` becomes
  /// glass, too: a part of its root mean square.
  double changeWithGlass(scene::Scene& scene, int pane, const scene::CameraPose& camera) {
    scene.environment = test::environmentOf(64, [](const vec3& d) { return 1.f + 0.5f * d; });
    const auto seen = [&] {
      render::Renderer renderer(device(), scene);
      return picture(renderer, settings(width, height, Term::specular, {refraction()}), camera);
    };
    const Image alone = seen();
    EXPECT_GT(mean(alone), 0);
    scene.materials[static_cast<size_t>(pane)] = test::glass(1.5f);
    return relativeRms(seen(), alone);
  }

  static dvec3 rayOf(const scene::CameraPose& camera, const scene::Bounds& bounds, int x, int y) {
    return test::ViewRays(camera, bounds, {width, height}).direction(x, y);
  }
};

/// From straight before it, and by a view that is sheared by 20 and 10 pixels, as it is by up to half a pixel
/// for samples beside a pixel's middle. An eye that is read off a sheared matrix as if that only turned and
/// moved stands 0.5 m aside, from where the buffers lack a fifth of what the picture shows of the slab.
TEST_F(SpecularTest, ASlabShiftsTheWallByItsClosedForm) {
  struct Case {
    float ior;
    glm::dvec2 shear;  ///< pixels
  };
  for (const auto& [ior, shear] : {Case{1.0001f, {0, 0}}, Case{1.5f, {0, 0}}, Case{3.f, {0, 0}},
                                   Case{1.5f, {20, 10}}, Case{3.f, {20, 10}}}) {
    SCOPED_TRACE(fmt::format("index {}, sheared by {}, {}", ior, shear.x, shear.y));
    scene::Scene scene = wall();
    const int glass = addGlass(scene, ior);
    scene::Primitive slab = quad({0, 0, 0.5f}, {3, 0, 0}, {0, 2, 0}, glass);
    const scene::Primitive back = quad({0, 0, -0.5f}, {3, 0, 0}, {0, -2, 0}, glass);
    slab.positions.insert(slab.positions.end(), back.positions.begin(), back.positions.end());
    slab.normals.insert(slab.normals.end(), back.normals.begin(), back.normals.end());
    for (const uint32_t index : back.indices) slab.indices.push_back(index + 4);
    show(scene, std::move(slab));
    render::Renderer renderer(device(), scene);
    const dvec3 eye(0.2, 0.1, 3);
    const auto camera =
        render::shifted(scene::lookAt(vec3(eye), vec3(eye) - vec3(0, 0, 1), 0.8f), shear, {width, height});
    const Image image = picture(renderer, settings(width, height, Term::specular, {refraction()}), camera);
    int shown = 0, off = 0;
    double shift = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const dvec3 d = rayOf(camera, renderer.pose().bounds, x, y);
        const dvec3 front = eye + (0.5 - eye.z) / d.z * d;
        const double n = double(ior), sine2 = (d.x * d.x + d.y * d.y) / (n * n);
        const dvec3 inside(d.x / n, d.y / n, -std::sqrt(1 - sine2)), exit = front - inside / inside.z;
        const auto within = [](const dvec3& p) { return std::abs(p.x) < 1.45 && std::abs(p.y) < 0.95; };
        // The slab has no sides: where the camera sees its front alone, it is a sheet.
        if (!within(front) || !within(exit) || !within(eye + (-0.5 - eye.z) / d.z * d)) continue;
        const double passes = 1 - double(glsl::fresnel_reflectance(float(-d.z), 1, ior));
        const dvec3 hit = exit + (-2.5 / d.z) * d, straight = eye + (-3 - eye.z) / d.z * d;
        const double expected = passes * passes * wallAt(hit);
        ++shown;
        off += !(std::abs(double(image.at(x, y, 0)) / expected - 1) < 0.005);
        shift = std::max(shift, std::abs(wallAt(straight) / wallAt(hit) - 1));
      }
    EXPECT_GT(shown, 3000);
    EXPECT_LT(off, 0.01 * shown);
    EXPECT_TRUE(shift > 0.05 || ior < 1.1f) << "the shift must show";
  }
}

TEST_F(SpecularTest, AMirrorShowsTheMirroredWall) {
  scene::Scene scene = wall();
  scene::Material silver;
  silver.metallic = 1;
  silver.roughness = 0;
  // On a floor before the wall: what it mirrors is on the screen, too.
  show(scene, quad({0, -1.2f, -1}, {2.4f, 0, 0}, {0, 0, -2}, test::addMaterial(scene, silver)));
  render::Renderer renderer(device(), scene);
  const dvec3 eye(0.1, 0.4, 3);
  const auto camera = scene::lookAt(vec3(eye), {0, -0.1f, -3}, 0.9f);
  const Image image = picture(renderer, settings(width, height, Term::specular, {refraction()}), camera);
  int shown = 0, off = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const dvec3 d = rayOf(camera, renderer.pose().bounds, x, y);
      const dvec3 p = eye + (-1.2 - eye.y) / d.y * d;
      if (!(d.y < 0) || std::abs(p.x) > 1.1 || std::abs(p.z + 1) > 0.9) continue;
      const dvec3 hit = p + (-3 - p.z) / d.z * dvec3(d.x, -d.y, d.z);
      ++shown;
      off += !(std::abs(double(image.at(x, y, 0)) / wallAt(hit) - 1) < 0.005);
    }
  EXPECT_GT(shown, 800);
  EXPECT_LT(off, 0.01 * shown);
}

TEST_F(SpecularTest, IsTheReferencesWithTheSameLimit) {
  struct Case {
    const char* scene;
    const char* shadows;
    double share, mean;
  };
  for (const Case& c :
       {Case{"glass_sphere", "hard_shadow_map", 0.25, 0.05}, Case{"ring", "hard_shadow_map", 0.2, 0.05},
        Case{"gem", "hard_shadow_map", 0.05, 0.05}, Case{"glassware", "sampled_area_light", 0.42, 0.1}}) {
    SCOPED_TRACE(c.scene);
    const scene::Scene scene = asset(c.scene);
    render::Renderer renderer(device(), scene);
    const Image image =
        picture(renderer, settings(width, height, Term::specular, {technique(c.shadows), refraction()}));
    const Image expected = truth(renderer, scene, renderer.pose().cameras.at(0), 2, 16);
    EXPECT_LT(shareOff(image, expected), c.share);  // edges of textures and shadows, rays off the screen
    EXPECT_NEAR(mean(image) / mean(expected), 1, c.mean);
  }
}

TEST_F(SpecularTest, MoreInterfacesFollowTotalReflection) {
  const scene::Scene scene = asset("gem");
  render::Renderer renderer(device(), scene);
  for (const int interfaces : {2, 4}) {
    const Image image = picture(
        renderer,
        settings(width, height, Term::specular,
                 {technique("hard_shadow_map"), refraction({{"interfaces", std::to_string(interfaces)}})}));
    const Image expected = truth(renderer, scene, renderer.pose().cameras.at(0), interfaces, 16);
    EXPECT_NEAR(mean(image) / mean(expected), 1, 0.15) << interfaces;
  }
}

TEST_F(SpecularTest, RaysThatTheScreenDoesNotKnowSeeTheEnvironment) {
  scene::Scene scene;
  scene.environment.width = 16;
  scene.environment.height = 8;
  for (int i = 0; i < 128; ++i) scene.environment.texels.emplace_back(0.2f + float(i % 5), 0.5f, 1.f);
  const int glass = addGlass(scene, 1.5f);
  show(scene, test::spherePrimitive(1, glass));
  render::Renderer renderer(device(), scene);
  const auto camera = scene::lookAt({0.5f, 1, 3}, {0, 0, 0}, 0.9f);
  for (const bool mirror : {false, true}) {
    scene.materials[0].metallic = mirror ? 1.f : 0.f;
    scene.materials[0].transmission = mirror ? 0.f : 1.f;
    render::Renderer other(device(), scene);
    const Image image = picture(other, settings(width, height, Term::final, {refraction()}), camera);
    const Image expected = truth(other, scene, camera, 2, 2, Term::final);
    EXPECT_LT(shareOff(image, expected), 0.01) << mirror;
  }
}

/// A ball of 5 cm and, 500 m behind the camera, a pane as wide that is glass or not: the search for where
/// light leaves the ball spans the wider one, and is not to be coarser than the ball's texels.
TEST_F(SpecularTest, GlassFarAwayDoesNotBlurTheSearchThroughABall) {
  scene::Scene scene;
  const int ball = addGlass(scene, 1.5f), pane = addLambert(scene);
  show(scene, test::spherePrimitive(0.025f, ball));
  show(scene, quad({0, 0, 500}, {500, 0, 0}, {0, 500, 0}, pane));
  EXPECT_LT(changeWithGlass(scene, pane, scene::lookAt({0, 0, 0.15f}, {0, 0, 0}, 0.4f)), 0.005);
}

/// A body of a ball and, beside it, a bar along the view, and far behind the camera a small pane. Light that
/// enters the ball at its left leaves it towards the bar. Points of a search over the way to the pane lie
/// further apart than all of the body is long, and halving the way between would first come upon the bar, as
/// if the gap were glass.
TEST_F(SpecularTest, GlassFarAwayFillsNoGapOfABody) {
  scene::Scene scene;
  const int glass = addGlass(scene, 1.5f), pane = addLambert(scene);
  const vec3 x(0.1f, 0, 0), y(0, 0.1f, 0), z(0, 0, 0.8f), middle(0.105f, 0, -0.4f);
  scene::Primitive body = test::spherePrimitive(0.05f, glass);
  for (const auto& [out, u, v] : {std::array{x, y, z}, std::array{y, z, x}, std::array{z, x, y}}) {
    body = test::joined(std::move(body), quad(middle + 0.5f * out, u, v, glass));
    body = test::joined(std::move(body), quad(middle - 0.5f * out, v, u, glass));
  }
  show(scene, std::move(body));
  show(scene, quad({0, 0, 500}, x, y, pane));
  EXPECT_LT(changeWithGlass(scene, pane, scene::lookAt({0.05f, 0, 4}, {0.05f, 0, 0}, 0.045f)), 0.05);
}

TEST_F(SpecularTest, WithoutSpecularSurfacesThereAreNoPasses) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  const Image with =
      picture(renderer, settings(width, height, Term::final, {technique("pcf"), refraction()}));
  EXPECT_EQ(stateOf(renderer, "image_space_refraction", "specular surfaces"),
            "the scene has no specular surface");
  for (const char* pass : {"refraction", "specular front", "specular back"})
    EXPECT_EQ(stateOf(renderer, "image_space_refraction", pass), "unknown");
  EXPECT_EQ(stateOf(renderer, "core", "matte gbuffer"), "unknown");
  EXPECT_TRUE(sameBits(with, picture(renderer, settings(width, height, Term::final, {technique("pcf")}))));
  expectWithin(picture(renderer, settings(width, height, Term::specular, {refraction()})), 0, 0);
}

TEST_F(SpecularTest, WhatIsSeenBesideSpecularSurfacesStaysTheSameToTheBit) {
  const scene::Scene scene = asset("glassware");
  render::Renderer renderer(device(), scene);
  // A filter over the screen would average with what lies behind the glass.
  const std::vector<render::TechniqueUse> lit{technique("pcss"),
                                              technique("reflective_shadow_map", {{"blur", "false"}})};
  std::vector<render::TechniqueUse> all = lit;
  all.push_back(refraction());
  render::Settings s = settings(width, height, Term::final, all);
  s.channels = true;
  const Image with = picture(renderer, s);
  s.techniques = lit;
  const Image without = picture(renderer, s);
  int specular = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float id = with.at(x, y, with.channel("id"));
      ASSERT_EQ(id, without.at(x, y, without.channel("id")));
      if (id >= 0 &&
          scene
              .materials[size_t(
                  scene.meshes[size_t(renderer.pose().instances[size_t(id)].mesh)].primitives[0].material)]
              .specularSurface()) {
        ++specular;
        continue;
      }
      for (int c = 0; c < 3; ++c) ASSERT_EQ(with.at(x, y, c), without.at(x, y, c)) << x << " " << y;
    }
  EXPECT_GT(specular, 500);
}

TEST_F(SpecularTest, TermsSumToTheFinalPicture) {
  const scene::Scene scene = asset("gem");
  render::Renderer renderer(device(), scene);
  const std::vector<render::TechniqueUse> all{technique("hard_shadow_map"), technique("surface_caustics"),
                                              technique("airlight"), refraction()};
  const Image whole = picture(renderer, settings(width, height, Term::final, all));
  double sum = 0;
  for (const Term part : {Term::direct, Term::caustic, Term::media, Term::specular})
    sum += mean(picture(renderer, settings(width, height, part, all)));
  EXPECT_NEAR(sum / mean(whole), 1, 1e-4);
}

TEST_F(SpecularTest, ExtremesStayFinite) {
  for (const float ior : {1.f, 1.0001f, 2.42f, 3.f}) {
    scene::Scene scene = asset("gem");
    for (scene::Material& material : scene.materials) {
      material.ior = ior;
      material.doubleSided = true;  // the camera within sees the stone's back
    }
    render::Renderer renderer(device(), scene);
    for (const float radii : {0.f, 0.3f, 1.05f}) {
      SCOPED_TRACE(fmt::format("index {}, camera at {} radii", ior, radii));
      const auto camera =
          bench::cameraAtSmallest(scene, renderer.pose(), renderer.pose().cameras.at(0), radii);
      for (const char* interfaces : {"2", "16"})
        expectWithin(
            picture(renderer,
                    settings(64, 48, Term::final,
                             {technique("hard_shadow_map"), refraction({{"interfaces", interfaces}})}),
                    camera),
            0, 1e4f);
    }
  }
}

/// White glass is clear over however many of its attenuation distances: here over more than floats reach to,
/// in the environment's picture, on the ways of light through the ball, and of what the camera sees in it.
TEST_F(SpecularTest, WhiteGlassIsClearHoweverThickItIs) {
  scene::Scene scene = bench::stressed(asset("glass_sphere"), StressChange::sceneScale, 1e4);
  scene.environment = test::environmentOf(16, [](const vec3&) { return vec3(1); });
  const auto seen = [&](float attenuationDistance, const std::vector<render::TechniqueUse>& techniques) {
    for (scene::Material& material : scene.materials) {
      if (!(material.transmission > 0)) continue;
      material.thickness = 1e4f;
      material.attenuationDistance = attenuationDistance;
    }
    render::Renderer renderer(device(), scene);
    return picture(renderer, settings(64, 48, Term::final, techniques));
  };
  const std::vector<render::TechniqueUse> none,
      all{technique("surface_caustics"), technique("volume_caustics"), refraction()};
  for (const std::vector<render::TechniqueUse>& techniques : {none, all}) {
    const Image clear = seen(0, techniques);
    ASSERT_GT(mean(clear), 0);
    EXPECT_LT(rmse(seen(1.2e-38f, techniques), clear), 1e-5 * mean(clear));
  }
}

TEST_F(SpecularTest, ScalesOfTheSceneChangeNothing) {
  const scene::Scene scene = asset("gem");
  render::Renderer renderer(device(), scene);
  const Image usual = picture(renderer, settings(width, height, Term::specular, {refraction()}));
  for (const float factor : {1e-4f, 1e4f}) {
    const scene::Scene scaled = bench::stressed(scene, StressChange::sceneScale, double(factor));
    render::Renderer other(device(), scaled);
    EXPECT_LT(shareOff(picture(other, settings(width, height, Term::specular, {refraction()})), usual), 0.02)
        << factor;
  }
}

TEST_F(SpecularTest, TheCameraMovesAndTheBuffersFollow) {
  const scene::Scene scene = asset("glass_sphere");
  render::Renderer moved(device(), scene), fresh(device(), scene);
  render::Settings s = settings(width, height, Term::specular, {refraction()});
  s.dynamic = false;
  picture(moved, s);
  moved.setCamera(moved.pose().cameras.at(1));
  moved.render();
  EXPECT_TRUE(sameBits(moved.read(), picture(fresh, s, fresh.pose().cameras.at(1))));
}

}  // namespace
}  // namespace limn
