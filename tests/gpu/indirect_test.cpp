// What indirect light gathered from virtual point lights promises beyond what every technique does.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "glsl/brdf.glsl"
#include "tests/gpu/render_test.h"
#include "tests/gpu/technique_harness.h"
#include "tests/gpu/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;
using render::Output;

using Settings = std::map<std::string, std::string>;

scene::Material lambert(float albedo) {
  scene::Material m;
  m.baseColour = glm::vec4(albedo, albedo, albedo, 1);
  m.metallic = 0;
  m.specularFactor = 0;
  return m;
}

/// A floor (y = 0) and a wall (x = 1, facing -x). A narrow spot over the origin lights a speck of the floor.
struct Corner {
  static constexpr float albedo = 0.6f, halfAngle = 0.05f;
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera = scene::lookAt({-2, 1.5f, 2}, {0.8f, 0.4f, 0}, 0.7f);
  double flux = 0;  ///< reflected by the speck, W

  explicit Corner(const scene::Material& material = lambert(albedo)) {
    const int mesh = addMesh(scene, floorPrimitive(1, addMaterial(scene, material)));
    addInstance(scene, pose, mesh);
    addInstance(
        scene, pose, mesh,
        glm::translate(glm::mat4(1), {1, 1, 0}) * glm::rotate(glm::mat4(1), 0.5f * glsl::pi, vec3(0, 0, 1)));
    glsl::Light light = spotLight({0, 1, 0}, {0, -1, 0}, halfAngle);
    light.emission = glm::vec4(1000);
    addLight(pose, light);
    const double inner = 1 - light.cone.x, outer = 1 - light.cone.y;
    flux = albedo * 1000 * 2 * glsl::pi * (inner + (outer - inner) / 3);
  }
  vec3 position(const Answer& v, int x, int y) const {
    glsl::FrameBlock frame{};
    scene::setCamera(frame, camera, pose.bounds, v.width, v.height);
    return vec3(frame.camera_position) +
           v.depth[static_cast<size_t>(y * v.width + x)] *
               (vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                static_cast<float>(y) * vec3(frame.view_ray_dy));
  }
};

class IndirectTest : public TechniqueTest {
 protected:
  Answer answer(const std::string& name, const Corner& s, const Settings& settings) {
    Answer v = visibility(name, settings, s.scene, s.pose, s.camera, {}, Term::indirect);
    for (const float value : v.lights[0]) EXPECT_TRUE(std::isfinite(value) && value >= 0);
    return v;
  }
};

/// The wall gets flux / pi cos cos / d^2 from the speck; the floor, which lies in its plane, nothing.
TEST_F(IndirectTest, AWallLitByASpeckOfTheFloor) {
  const Corner s;
  const Answer v = answer("reflective_shadow_map", s, {{"vpls", "64"}, {"block", "1"}, {"clamp", "0"}});
  int seen = 0;
  for (int y = 8; y < side; y += 8) {
    for (int x = 4; x < side; x += 8) {
      const uint32_t instance = v.instance[static_cast<size_t>(y * side + x)];
      if (instance == 0) {
        EXPECT_NEAR(v.at(0, x, y), 0, 2e-3f);
      }
      if (instance != 1) continue;
      const vec3 p = s.position(v, x, y);
      const double d2 = glm::dot(p, p), exact = s.flux / glsl::pi * p.y * p.x / (d2 * d2);
      EXPECT_NEAR(v.at(0, x, y), Corner::albedo / glsl::pi * exact, 0.02 * exact + 1e-3) << x << "," << y;
      ++seen;
    }
  }
  EXPECT_GT(seen, 30);
}

TEST_F(IndirectTest, ReceiversReflectWithTheirWholeBrdf) {
  scene::Material glossy = lambert(Corner::albedo);
  glossy.specularFactor = 1;
  glossy.roughness = 0.5f;
  Corner s;
  const int material = addMaterial(s.scene, glossy);
  s.scene.meshes.push_back(s.scene.meshes[0]);
  s.scene.meshes[1].primitives[0].material = material;
  s.pose.instances[1].mesh = 1;
  const Answer v = answer("reflective_shadow_map", s, {{"vpls", "64"}, {"block", "1"}, {"clamp", "0"}});
  const vec3 eye(glm::inverse(s.camera.worldToView)[3]), n(-1, 0, 0);
  const glsl::SurfaceBrdf brdf = glsl::surface_brdf(vec3(Corner::albedo), 0, 0.5f, 1, vec3(1), 1.5f);
  int seen = 0;
  for (int y = 8; y < side; y += 8) {
    for (int x = 4; x < side; x += 8) {
      if (v.instance[static_cast<size_t>(y * side + x)] != 1) continue;
      const vec3 p = s.position(v, x, y);
      const double d2 = glm::dot(p, p), irradiance = s.flux / glsl::pi * p.y * p.x / (d2 * d2);
      const double exact = irradiance * glsl::brdf(brdf, n, glm::normalize(eye - p), glm::normalize(-p)).x;
      EXPECT_NEAR(v.at(0, x, y), exact, 0.03 * exact + 1e-3) << x << "," << y;
      ++seen;
    }
  }
  EXPECT_GT(seen, 30);
}

/// A plate between the speck and the wall, halfway.
class PlateTest : public IndirectTest {
 protected:
  Corner corner_;
  PlateTest() {
    const int mesh = addMesh(corner_.scene, floorPrimitive(0.15f, 0));
    addInstance(corner_.scene, corner_.pose, mesh,
                glm::translate(glm::mat4(1), {0.5f, 0.4f, 0}) *
                    glm::rotate(glm::mat4(1), 0.5f * glsl::pi, vec3(0, 0, 1)));
  }
  /// What the plate hides is dark but for `leak` of its light, what it does not is as without shadows but for
  /// `stray`; `blurred`: half width of the edge, m at the plate.
  void expectHides(const std::string& name, Settings settings, float leak, float stray, float blurred) {
    settings.merge(Settings{{"vpls", "64"}, {"block", "1"}, {"clamp", "0"}});
    const Answer all =
        answer("reflective_shadow_map", corner_, {{"vpls", "64"}, {"block", "1"}, {"clamp", "0"}});
    const Answer seen = answer(name, corner_, settings);
    int hidden = 0, lit = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (all.instance[static_cast<size_t>(y * side + x)] != 1) continue;
        const vec3 p = corner_.position(all, x, y);
        // On the plate's plane, x = 1/2, the ray from the origin is at half of p; the speck is 0.1 m wide.
        const float outside = std::max(std::abs(0.5f * p.y - 0.4f), std::abs(0.5f * p.z)) - 0.15f;
        if (outside < -blurred) {
          EXPECT_NEAR(seen.at(0, x, y), 0, leak * all.at(0, x, y)) << x << "," << y;
          ++hidden;
        } else if (outside > blurred) {
          EXPECT_NEAR(seen.at(0, x, y), all.at(0, x, y), stray * all.at(0, x, y) + 1e-4f) << x << "," << y;
          ++lit;
        }
      }
    }
    EXPECT_GT(hidden, 50);
    EXPECT_GT(lit, 500);
  }
};

TEST_F(PlateTest, HidesTheSpeckFromTheWall) {
  expectHides("instant_radiosity", {{"map_size", "256"}}, 0.02f, 0.01f, 0.05f);
}

/// A texel of 64 is 2 to 4 degrees wide, 0.04 m on the plate; splats and filling move the edge by up to two,
/// and the map of one virtual light in 64 may miss there.
TEST_F(PlateTest, HidesTheSpeckWhenItIsMadeOfPoints) {
  expectHides("imperfect_shadow_maps", {{"points", "16384"}}, 0.15f, 0.03f, 0.1f);
}

class IndirectPictureTest : public RenderTest {
 protected:
  Image indirect(render::Renderer& renderer, const std::string& name,
                 const std::vector<std::pair<std::string, std::string>>& values) {
    return picture(renderer, settings(96, 72, Output::indirect, {technique(name, values)}));
  }
};

TEST_F(IndirectPictureTest, SplittingAndMergingChangesNothing) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  for (const char* block : {"3", "8"}) {
    const Image addressed = indirect(renderer, "reflective_shadow_map", {{"vpls", "300"}, {"block", block}});
    const Image split = indirect(renderer, "reflective_shadow_map",
                                 {{"vpls", "300"}, {"block", block}, {"interleaving", "split"}});
    EXPECT_TRUE(std::ranges::equal(addressed.data(), split.data())) << block;
  }
}

/// Each pixel of a block has other virtual lights, all of them together every one; where N is not divisible,
/// too.
TEST_F(IndirectPictureTest, InterleavingKeepsTheMean) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto mean = [&](const char* vpls, const char* block, const char* blur) {
    return IndirectPictureTest::mean(indirect(
        renderer, "reflective_shadow_map",
        {{"vpls", vpls}, {"block", block}, {"blur", blur}, {"clamp", "0.05"}, {"compensation", "false"}}));
  };
  for (const char* vpls : {"1024", "777"}) {
    const double all = mean(vpls, "1", "false");
    EXPECT_NEAR(mean(vpls, "8", "false") / all, 1, 0.02) << vpls;
    EXPECT_NEAR(mean(vpls, "8", "true") / all, 1, 0.02) << vpls;
    EXPECT_NEAR(mean(vpls, "5", "true") / all, 1, 0.02) << vpls;
  }
  EXPECT_NEAR(mean("1", "8", "false") / mean("1", "1", "false"), 1, 1e-6) << "no more pixels than lights";
}

TEST_F(IndirectPictureTest, CompensationGivesBackWhatTheClampTakes) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto mean = [&](const char* clamp, const char* compensation) {
    return IndirectPictureTest::mean(
        indirect(renderer, "reflective_shadow_map",
                 {{"vpls", "4096"}, {"block", "1"}, {"clamp", clamp}, {"compensation", compensation}}));
  };
  const double all = mean("0", "false");
  for (const char* clamp : {"0.03", "0.1"}) {
    EXPECT_LT(mean(clamp, "false"), 0.995 * all) << clamp;
    EXPECT_NEAR(mean(clamp, "true") / all, 1, 0.05) << clamp;
  }
}

TEST_F(IndirectPictureTest, ShadowsOfVirtualLightsOnlyTakeLightAway) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const std::vector<std::pair<std::string, std::string>> values{
      {"vpls", "128"}, {"block", "1"}, {"compensation", "false"}};
  const Image open = indirect(renderer, "reflective_shadow_map", values);
  const Image shadowed = indirect(renderer, "instant_radiosity", values);
  int brighter = 0;
  for (size_t i = 0; i < open.data().size(); ++i)
    brighter += shadowed.data()[i] > open.data()[i] * (1 + 1e-5f);
  EXPECT_EQ(brighter, 0);
  EXPECT_LT(mean(shadowed), 0.95 * mean(open));
  EXPECT_GT(mean(shadowed), 0.5 * mean(open));
}

TEST_F(IndirectPictureTest, BatchesOfMapsGiveTheSamePicture) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  for (const char* block : {"1", "4"}) {
    const Image once = indirect(renderer, "instant_radiosity",
                                {{"vpls", "90"}, {"map_size", "256"}, {"memory", "512"}, {"block", block}});
    const Image batches = indirect(renderer, "instant_radiosity",
                                   {{"vpls", "90"}, {"map_size", "256"}, {"memory", "16"}, {"block", block}});
    EXPECT_LT(rmse(once, batches), 1e-5 * mean(once)) << block;
  }
}

TEST_F(IndirectPictureTest, NothingIsRedrawnWhileOnlyTheCameraMoves) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  render::Settings s = settings(64, 48, Output::indirect, {technique("instant_radiosity", {{"vpls", "16"}})});
  s.dynamic = false;
  picture(renderer, s);
  renderer.setCamera(renderer.pose().cameras.at(1));
  renderer.render();
  for (const auto& pass : renderer.explain())
    if (pass.technique == "indirect" || pass.technique == "shadow" || pass.name == "paraboloid maps") {
      EXPECT_EQ(pass.state, frame::PassState::cached) << pass.name;
    }
}

}  // namespace
}  // namespace limn
