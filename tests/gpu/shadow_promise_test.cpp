// What each of the shadow-map techniques promises.
#include <algorithm>

#include "core/image/image.h"
#include "tests/gpu/ball_scene.h"
#include "tests/support/density_grids.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

/// The folder that LIMN_TEST_PICTURES names for pictures for people; null: there is none.
const char* pictureFolder() {
  return std::getenv("LIMN_TEST_PICTURES");
}

/// Saves a picture for people, where there is a folder for it.
void keep(const Answer& v, const std::string& name) {
  const char* folder = pictureFolder();
  if (folder == nullptr) return;
  for (size_t l = 0; l < v.lights.size(); ++l) {
    Image image = Image::rgb(v.width, v.height);
    for (int y = 0; y < v.height; ++y) {
      for (int x = 0; x < v.width; ++x) {
        for (float& c : image.pixel(x, v.height - 1 - y)) c = v.at(l, x, y);
      }
    }
    writePng(std::filesystem::path(folder) / (name + "_" + std::to_string(l) + ".png"), image);
  }
}

/// Signed distance, in sphere radii, between the segment from p to the light's centre and the ball's surface.
float clearance(const BallScene& s, const glsl::Light& light, const vec3& p) {
  const bool directional = light.type == glsl::light_directional;
  const vec3 to = directional ? -light.direction : light.position - p;
  const vec3 d = glm::normalize(to), ball = s.scale * vec3(0, 1, 0);
  const float along = glm::dot(ball - p, d);
  if (along < 0 || (!directional && along > glm::length(to))) return 1;
  return (glm::distance(ball, p + along * d) / s.scale - 0.5f) / 0.5f;
}

class ShadowPromiseTest : public BallTest {};

TEST_F(ShadowPromiseTest, HardShadowOfABallUnderEveryLight) {
  for (const char* filter : {"nearest", "2x2"}) {
    const BallScene s;
    const Answer v = visibility("hard_shadow_map", {{"filter", filter}, {"shadow_map_size", "512"}}, s.scene,
                                s.pose, s.camera);
    keep(v, std::string("hard_") + filter);
    for (size_t l = 0; l < s.pose.lights.size(); ++l) {
      int shadowed = 0, lit = 0, wrong = 0;
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          const size_t i = static_cast<size_t>(y * side + x);
          if (v.instance[i] != 0) continue;  // the floor
          const vec3 p = s.position(v, x, y);
          const float c = clearance(s, s.pose.lights[l], p);
          if (std::abs(c) < 0.04f) continue;  // a few texels around the silhouette
          const vec3 centre(s.pose.lights[l].position), axis(s.pose.lights[l].direction);
          const bool masked = s.pose.lights[l].type == glsl::light_rectangle && s.pose.lights[l].flags == 0 &&
                              glm::dot(axis, p - centre) <= 0;
          const bool outside = s.pose.lights[l].type == glsl::light_spot &&
                               glm::dot(axis, glm::normalize(p - centre)) < s.pose.lights[l].cos_outer;
          const float expected = c > 0 || masked || outside ? 1.f : 0.f;
          (expected > 0 ? lit : shadowed) += 1;
          if (v.lights[l][i] != expected) ++wrong;
        }
      }
      EXPECT_GT(shadowed, 100) << "light " << l;
      EXPECT_GT(lit, 1000) << "light " << l;
      EXPECT_EQ(wrong, 0) << "light " << l << " filter " << filter;
    }
  }
}

/// With the same maps: what is fitted to the view depends on the light's size.
TEST_F(ShadowPromiseTest, LightsWithoutSizeGiveHardShadows) {
  const BallScene s;
  const Answer hard = visibility("hard_shadow_map", {{"shadow_map_size", "256"}}, s.scene, s.pose, s.camera);
  const Answer soft =
      visibility("pcss", {{"light_size", "0"}, {"shadow_map_size", "256"}, {"shadow_map_fit", "scene"}},
                 s.scene, s.pose, s.camera);
  EXPECT_EQ(soft.lights, hard.lights);
  auto settings = quick(registry().find("pcss"));
  settings["shadow_map_fit"] = "scene";
  const Answer own = visibility("pcss", settings, s.scene, s.pose, s.camera);
  EXPECT_EQ(own.lights[0], hard.lights[0]) << "point";
  EXPECT_EQ(own.lights[1], hard.lights[1]) << "spot";
}

/// Planar, parallel light, blocker and receiver: percentage-closer soft shadows are exact up to sampling.
TEST_F(ShadowPromiseTest, ParallelPlanesAreExactWithPcss) {
  BallScene s(1, false);
  addMesh(s.scene, floorPrimitive(0.5f, 0));
  addInstance(s.scene, s.pose, 2, at(0, 1, 0));
  const auto hides = [](const vec3& from, const vec3& to) {
    const vec3 p = from + (1 / to.y) * to;
    return std::max(std::abs(p.x), std::abs(p.z)) < 0.5f;
  };
  for (const char* search : {"near", "narrowed"}) {
    for (const char* pattern : {"grid", "r2"}) {
      const Answer v = visibility("pcss",
                                  {{"pattern", pattern},
                                   {"blocker_samples", "256"},
                                   {"filter_samples", "576"},
                                   {"search", search},
                                   {"shadow_map_fit", "scene"}},
                                  s.scene, s.pose, s.camera, {3});
      Answer four = v;
      four.lights.insert(four.lights.begin(), 3, {});
      const Errors e = floorErrors(s, four, 3, hides);
      EXPECT_GT(e.penumbra, 150);
      EXPECT_LT(e.rms, 0.015) << search << " " << pattern;
      EXPECT_LT(e.worst, 0.1) << search << " " << pattern;
    }
  }
}

TEST_F(ShadowPromiseTest, PcssOfABallIsCloseToTheTruth) {
  const BallScene s;
  const Answer v = visibility("pcss", {{"shadow_map_size", "512"}}, s.scene, s.pose, s.camera);
  keep(v, "pcss");
  if (pictureFolder() != nullptr)
    keep(visibility("pcss", {{"search", "near"}, {"pattern", "grid"}}, s.scene, s.pose, s.camera),
         "pcss_near");
  for (size_t light = 2; light < v.lights.size(); ++light) {
    const Errors e = floorErrors(s, v, light, ballHides);
    EXPECT_GT(e.penumbra, 50) << light;
    EXPECT_LT(e.rms, 0.1) << light;
  }
}

TEST_F(ShadowPromiseTest, SamplesOfAnAreaLightConverge) {
  const BallScene s;
  const std::vector<uint32_t> extended{2, 3, 4, 5};
  std::vector<double> previous(s.pose.lights.size(), 1);
  for (const char* samples : {"4", "16", "64"}) {
    Answer v = visibility("sampled_area_light", {{"samples", samples}, {"shadow_map_size", "256"}}, s.scene,
                          s.pose, s.camera, extended);
    keep(v, std::string("sampled_") + samples);
    v.lights.insert(v.lights.begin(), 2, {});
    for (const uint32_t light : extended) {
      const Errors e = floorErrors(s, v, light, ballHides);
      EXPECT_LT(e.rms, 0.75 * previous[light]) << samples << " samples, light " << light;
      previous[light] = e.rms;
    }
  }
  for (size_t light = 2; light < previous.size(); ++light)
    EXPECT_LT(previous[light], 0.04) << "light " << light;
}

/// Tracing has no texels: what is left is the number of rays, and the facets of the ball.
TEST_F(ShadowPromiseTest, ShadowRaysConverge) {
  const BallScene s;
  const std::vector<uint32_t> extended{2, 3, 4, 5};
  std::vector<double> previous(s.pose.lights.size(), 1);
  for (const char* rays : {"1", "8", "64"}) {
    Answer v = visibility("ray_traced_area_light", {{"rays", rays}, {"filter", "none"}}, s.scene, s.pose,
                          s.camera, extended);
    keep(v, std::string("rays_") + rays);
    v.lights.insert(v.lights.begin(), 2, {});
    for (const uint32_t light : extended) {
      const Errors e = floorErrors(s, v, light, ballHides);
      EXPECT_LT(e.rms, 0.5 * previous[light]) << rays << " rays, light " << light;
      previous[light] = e.rms;
    }
  }
  for (size_t light = 2; light < previous.size(); ++light)
    EXPECT_LT(previous[light], 0.02) << "light " << light;
}

TEST_F(ShadowPromiseTest, BatchesOfSamplesAddUp) {
  const BallScene s;
  for (const Term term : {Term::visibility, Term::direct}) {
    const auto draw = [&](const char* memory) {
      return visibility("sampled_area_light",
                        {{"samples", "8"}, {"shadow_map_size", "128"}, {"memory", memory}}, s.scene, s.pose,
                        s.camera, {}, term);
    };
    const Answer whole = draw("256"), batches = draw("4");
    for (size_t l = 0; l < whole.lights.size(); ++l) {
      for (size_t i = 0; i < whole.lights[l].size(); ++i)
        EXPECT_NEAR(batches.lights[l][i], whole.lights[l][i], 1e-4f);
    }
  }
}

/// 100 batches of one map each. Shares of 1/100 that were added up as 16 bits round them, 655 / 65535, would
/// be 0.05 % less than the whole.
TEST_F(ShadowPromiseTest, BatchesOfSamplesCountExactly) {
  const BallScene s;
  for (const bool ofBound : {false, true}) {
    bound = ofBound;
    const auto draw = [&](const char* memory) {
      return visibility("sampled_area_light",
                        {{"samples", "100"}, {"shadow_map_size", "400"}, {"memory", memory}}, s.scene, s.pose,
                        s.camera, {3});
    };
    const Answer whole = draw("256"), batches = draw("1");
    EXPECT_EQ(whole.passes.size(), 1u);
    EXPECT_EQ(batches.passes.size(), 100u);
    EXPECT_EQ(std::ranges::max(batches.lights[0]), 1);
    EXPECT_EQ(batches.lights[0], whole.lights[0]);
  }
}

/// Through the grid of a medium light takes so many steps of a software renderer's loops that samples of six
/// lights would not fit one batch, whose maps are kept. V needs no medium.
TEST_F(ShadowPromiseTest, MediaDoNotPartTheSamplesOfVisibility) {
  drawn = 16;
  BallScene s;
  s.scene.medium.sigmaA = vec3(0.01f);
  scene::setGrid(s.scene.medium, constantGrid(s.pose.bounds, 1));
  const Answer v = visibility("sampled_area_light", {{"samples", "64"}, {"shadow_map_size", "16"}}, s.scene,
                              s.pose, s.camera);
  EXPECT_EQ(v.passes, std::vector<std::string>{"visibility"});
}

/// A light that emits nothing has its maps in batches where no other shines.
TEST_F(ShadowPromiseTest, DarkLightsTakeNoMoreMemoryThanAskedFor) {
  BallScene s;
  s.pose.lights[3].emission = vec3(0);
  for (const auto& [lights, batches] :
       {std::pair(std::vector<uint32_t>{3}, 8u), {std::vector<uint32_t>{3, 4}, 8u}}) {
    const Answer v =
        visibility("sampled_area_light", {{"samples", "8"}, {"shadow_map_size", "512"}, {"memory", "1"}},
                   s.scene, s.pose, s.camera, lights);
    EXPECT_EQ(v.passes.size(), batches) << lights.size() << " lights";
  }
}

TEST_F(ShadowPromiseTest, OneSampleIsAHardShadow) {
  const BallScene s;
  const Answer hard = visibility("hard_shadow_map", {{"shadow_map_size", "256"}}, s.scene, s.pose, s.camera);
  const Answer one = visibility("sampled_area_light",
                                {{"samples", "1"}, {"shadow_map_size", "256"}, {"shadow_map_fit", "scene"}},
                                s.scene, s.pose, s.camera);
  for (size_t l = 0; l < 3; ++l) EXPECT_EQ(one.lights[l], hard.lights[l]) << l;
}

TEST_F(ShadowPromiseTest, SampledDirectLightEqualsClosedForms) {
  BallScene s(1, false);
  scene::Material& lambert = s.scene.materials[0];
  lambert.metallic = 0;
  lambert.specularFactor = 0;
  for (const uint32_t light : {0u, 2u, 3u, 4u}) {
    const Answer v = visibility("sampled_area_light", {{"samples", "256"}, {"shadow_map_size", "64"}},
                                s.scene, s.pose, s.camera, {light}, Term::direct);
    const glsl::Light& l = s.pose.lights[light];
    double sum = 0, difference = 0;
    for (int y = 0; y < side; y += 3) {
      for (int x = 0; x < side; x += 3) {
        const size_t i = static_cast<size_t>(y * side + x);
        if (v.instance[i] != 0) continue;
        const vec3 p = s.position(v, x, y), n(0, 1, 0);
        float irradiance = 0;
        if (l.type != glsl::light_rectangle) {
          const vec3 to = light == 2 ? -l.direction : l.position - p;
          irradiance = glsl::punctual_irradiance(l, p).x * glm::normalize(to).y;
        } else if (glsl::rectangle_emits_towards(l, p)) {
          irradiance = glsl::rectangle_irradiance(glsl::rectangle_from(l, p), n);
        }
        sum += irradiance / glsl::pi;
        difference += std::abs(v.lights[0][i] - irradiance / glsl::pi);
      }
    }
    EXPECT_LT(difference, 0.005 * sum) << "light " << light;
  }
}

/// A thin wall that stands on the floor: its shadow begins at its foot.
TEST_F(ShadowPromiseTest, ContactShadowsDoNotDetach) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(2, addMaterial(scene)));
  addMesh(scene, floorPrimitive(0.5f, 0));
  addInstance(scene, pose, 0);
  // Leans 30 degrees from the floor towards +x, its lower edge on the line x = 0.
  const glm::mat4 lean = glm::rotate(glm::mat4(1), glsl::pi / 6, {0, 0, 1}) * at(0.5f, 0, 0);
  addInstance(scene, pose, 1, lean);
  addLight(pose, directionalLight({0.3f, -1, 0}, 0));
  const auto camera = scene::lookAt({0.3f, 0.6f, 2.5f}, {0.1f, 0, 0}, 0.5f);  // from the side, under the wall
  constexpr float texel = 4 / 256.f;                                          // of the map on the floor
  const Answer v = visibility("hard_shadow_map", {{"shadow_map_size", "256"}}, scene, pose, camera);
  keep(v, "contact");
  glsl::FrameBlock frame{};
  scene::setCamera(frame, camera, pose.bounds, side, side);
  int shadowed = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const size_t i = static_cast<size_t>(y * side + x);
      if (v.instance[i] != 0) continue;
      const vec3 p =
          vec3(frame.camera_position) +
          v.depth[i] * (vec3(frame.view_ray_origin) + static_cast<float>(x) * vec3(frame.view_ray_dx) +
                        static_cast<float>(y) * vec3(frame.view_ray_dy));
      if (std::abs(p.z) > 0.45f || p.x < 0 || p.x > 0.8f) continue;
      if (p.x < 4 * texel / std::tan(glsl::pi / 6)) continue;
      ++shadowed;
      EXPECT_EQ(v.lights[0][i], 0.f) << p.x << " " << p.z;
    }
  }
  EXPECT_GT(shadowed, 300);
}

}  // namespace
}  // namespace limn
