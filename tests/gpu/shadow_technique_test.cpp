// What every shadow-map technique must hold, and what each of them promises.
#include <gmock/gmock.h>

#include <algorithm>

#include "core/image/image.h"
#include "glsl/light/light_view.glsl"
#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

/// A ball of radius 1/2 at (0, 1, 0) over a floor, seen from above, lit by one light of every type.
struct BallScene {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera;
  float scale;

  explicit BallScene(float s = 1, bool ball = true, const glm::mat4& turn = glm::mat4(1)) : scale(s) {
    addMesh(scene, floorPrimitive(4 * s, addMaterial(scene)));
    addMesh(scene, spherePrimitive(0.5f * s, 0, 64));
    addInstance(scene, pose, 0, turn);
    if (ball) addInstance(scene, pose, 1, at(0, s, 0));
    addLight(pose, pointLight(s * vec3(1, 3, 0.5f)));
    addLight(pose, spotLight(s * vec3(-1, 3, 0.5f), {1, -2.2f, -0.2f}, 0.9f));
    addLight(pose, directionalLight({0.3f, -1, 0.2f}, 0.2f));
    addLight(pose, rectangleLight(s * vec3(0, 4, 0), {0, -1, 0}, 0.8f * s, 0.6f * s));
    addLight(pose,
             rectangleLight(s * vec3(1.5f, 1.5f, 1), {-1, -0.7f, -0.6f}, 0.5f * s, 0.5f * s));  // hemicube
    addLight(pose,
             rectangleLight(s * vec3(0, 3.5f, 0.5f), {0, 1, 0}, 0.5f * s, 0.5f * s, true));  // two-sided
    camera = scene::lookAt(s * vec3(0, 6, 3), s * vec3(0, 0.2f, 0), 0.8f);
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

/// Saves a picture for people, where LIMN_TEST_PICTURES names a folder.
void keep(const Answer& v, const std::string& name) {
  const char* folder = std::getenv("LIMN_TEST_PICTURES");
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

bool has(const TechniquePlugin& plugin, std::string_view parameter) {
  return std::ranges::any_of(plugin.info->parameters,
                             [&](const Parameter& p) { return std::string_view(p.name) == parameter; });
}

/// Small settings for laws that hold at any.
std::map<std::string, std::string> quick(const TechniquePlugin& plugin) {
  std::map<std::string, std::string> settings;
  for (const auto& [name, value] : {std::pair("shadow_map_size", "256"),
                                    {"blocker_samples", "16"},
                                    {"filter_samples", "16"},
                                    {"samples", "4"}}) {
    if (has(plugin, name)) settings[name] = value;
  }
  return settings;
}

/// Exact V of a floor point by brute force: the share of a grid of light points not hidden by `hides(from,
/// to)`.
template <class Hides>
float exactVisibility(const glsl::Light& light, const vec3& p, const Hides& hides) {
  constexpr int cells = 24;
  const glsl::LightView view = glsl::light_view(light, p, {0, 1, 0}, -1);
  if (view.masked) return 1;
  int lit = 0, above = 0;
  for (int i = 0; i < cells * cells; ++i) {
    const glm::vec2 u((static_cast<float>(i % cells) + 0.5f) / cells,
                      (static_cast<float>(i / cells) + 0.5f) / cells);
    const vec3 slope = glsl::light_view_point(view, u);
    if (slope.y <= 0) continue;
    ++above;
    if (!hides(p, slope * (view.cone ? 1e3f : view.depth))) ++lit;
  }
  return static_cast<float>(lit) / static_cast<float>(std::max(above, 1));
}

/// Whether the ball of a BallScene of scale 1 hides what lies at from + to.
bool ballHides(const vec3& from, const vec3& to) {
  const vec3 d = glm::normalize(to), ball(0, 1, 0);
  const float along = glm::dot(ball - from, d);
  return along > 0 && along < glm::length(to) && glm::distance(ball, from + along * d) < 0.5f;
}

struct Errors {
  double rms = 0, worst = 0;
  int penumbra = 0;
};

class ShadowTechniqueTest : public TechniqueTest {
 protected:
  static std::vector<const TechniquePlugin*> techniques() {
    std::vector<const TechniquePlugin*> found;
    for (const TechniquePlugin* plugin : registry().all()) {
      if (contains(plugin->info->terms, Term::visibility)) found.push_back(plugin);
    }
    return found;
  }

  /// Of V on the floor against the exact one, over the pixels of the penumbra.
  template <class Hides>
  static Errors floorErrors(const BallScene& s, const Answer& v, size_t light, const Hides& hides) {
    Errors e;
    double squares = 0;
    for (int y = 0; y < side; y += 2) {
      for (int x = 0; x < side; x += 2) {
        const size_t i = static_cast<size_t>(y * side + x);
        if (v.instance[i] != 0) continue;
        const float exact = exactVisibility(s.pose.lights[light], s.position(v, x, y), hides);
        if (exact == 1 && v.lights[light][i] == 1) continue;
        const double error = v.lights[light][i] - exact;
        squares += error * error;
        e.worst = std::max(e.worst, std::abs(error));
        ++e.penumbra;
      }
    }
    e.rms = std::sqrt(squares / std::max(e.penumbra, 1));
    return e;
  }
};

TEST_F(ShadowTechniqueTest, HardShadowOfABallUnderEveryLight) {
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

TEST_F(ShadowTechniqueTest, LightsGiveTheSameAloneAndTogether) {
  const BallScene s;
  for (const TechniquePlugin* plugin : techniques()) {
    const std::string name = plugin->info->name;
    const Answer together = visibility(name, quick(*plugin), s.scene, s.pose, s.camera);
    for (uint32_t l = 0; l < s.pose.lights.size(); ++l) {
      const Answer alone = visibility(name, quick(*plugin), s.scene, s.pose, s.camera, {l});
      EXPECT_EQ(alone.lights[0], together.lights[l]) << name << " light " << l;
    }
  }
}

TEST_F(ShadowTechniqueTest, PlanesDoNotShadowThemselvesAtAnySlopeAndLightSize) {
  for (const float tilt : {0.f, 0.4f, 1.1f}) {
    const BallScene s(1, false, glm::rotate(glm::mat4(1), tilt, {1, 0, 0.3f}));
    for (const TechniquePlugin* plugin : techniques()) {
      for (const char* size : {"-1", "0.3", "2"}) {
        auto settings = quick(*plugin);
        if (has(*plugin, "light_size")) settings["light_size"] = size;
        const Answer v = visibility(plugin->info->name, settings, s.scene, s.pose, s.camera);
        for (size_t l = 0; l < v.lights.size(); ++l) {
          EXPECT_EQ(*std::ranges::min_element(v.lights[l]), 1.f)
              << plugin->info->name << " tilt " << tilt << " light " << l << " size " << size;
        }
        if (!has(*plugin, "light_size")) break;
      }
    }
  }
}

TEST_F(ShadowTechniqueTest, ScaleChangesNothing) {
  for (const TechniquePlugin* plugin : techniques()) {
    const BallScene one(1);
    const Answer expected = visibility(plugin->info->name, quick(*plugin), one.scene, one.pose, one.camera);
    for (const float scale : {1e-4f, 1e4f}) {
      const BallScene s(scale);
      const Answer v = visibility(plugin->info->name, quick(*plugin), s.scene, s.pose, s.camera);
      for (size_t l = 0; l < v.lights.size(); ++l) {
        double squares = 0;
        for (size_t i = 0; i < v.lights[l].size(); ++i)
          squares += std::pow(double{v.lights[l][i]} - expected.lights[l][i], 2);
        EXPECT_LT(std::sqrt(squares / static_cast<double>(v.lights[l].size())), 5e-3)
            << plugin->info->name << " scale " << scale << " light " << l;
      }
    }
  }
}

/// What all of a pixel's neighbours agree on, within what a texel decides, no fit of the maps changes.
TEST_F(ShadowTechniqueTest, MapsFittedToTheViewLoseNoShadow) {
  BallScene s;
  addInstance(s.scene, s.pose, 1, at(0.4f, 2.6f, -0.2f, 0.3f));  // near the lights, out of sight
  addInstance(s.scene, s.pose, 1, at(1.2f, 0.3f, 0.4f, 0.5f));   // cut by the edge of the picture
  const auto camera = scene::lookAt({0.4f, 0.9f, 2.2f}, {0.4f, 0.1f, 0.1f}, 0.7f);
  for (const TechniquePlugin* plugin : techniques()) {
    if (!has(*plugin, "shadow_map_fit")) continue;
    const auto draw = [&](const char* fit) {
      auto settings = quick(*plugin);
      settings["shadow_map_size"] = "512";
      settings["shadow_map_fit"] = fit;
      return visibility(plugin->info->name, settings, s.scene, s.pose, camera);
    };
    const Answer whole = draw("scene"), cut = draw("view");
    EXPECT_EQ(cut.uncovered, whole.uncovered) << plugin->info->name;
    for (size_t l = 0; l < whole.lights.size(); ++l) {
      int certain = 0, wrong = 0;
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          float low = 1, high = 0;
          for (int dy = -3; dy <= 3; ++dy) {
            for (int dx = -3; dx <= 3; ++dx) {
              const float v = whole.at(l, std::clamp(x + dx, 0, side - 1), std::clamp(y + dy, 0, side - 1));
              low = std::min(low, v);
              high = std::max(high, v);
            }
          }
          if (high - low > 0.02f) continue;
          ++certain;
          if (std::abs(cut.at(l, x, y) - whole.at(l, x, y)) > 0.06f) ++wrong;
        }
      }
      EXPECT_GT(certain, side * side / 8) << plugin->info->name << " light " << l;
      EXPECT_LE(wrong, certain / 500) << plugin->info->name << " light " << l;
    }
  }
}

/// With the same maps: what is fitted to the view depends on the light's size.
TEST_F(ShadowTechniqueTest, LightsWithoutSizeGiveHardShadows) {
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
TEST_F(ShadowTechniqueTest, ParallelPlanesAreExactWithPcss) {
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

TEST_F(ShadowTechniqueTest, PcssOfABallIsCloseToTheTruth) {
  const BallScene s;
  const Answer v = visibility("pcss", {{"shadow_map_size", "512"}}, s.scene, s.pose, s.camera);
  keep(v, "pcss");
  keep(visibility("pcss", {{"search", "near"}, {"pattern", "grid"}}, s.scene, s.pose, s.camera), "pcss_near");
  for (size_t light = 2; light < v.lights.size(); ++light) {
    const Errors e = floorErrors(s, v, light, ballHides);
    EXPECT_GT(e.penumbra, 50) << light;
    EXPECT_LT(e.rms, 0.1) << light;
  }
}

/// The ball under a point light, a disc, a long light, one that the floor cuts, and a wide one.
BallScene wideLights(bool ball) {
  BallScene s(1, ball);
  s.pose.lights = {s.pose.lights[0], s.pose.lights[2]};
  s.pose.lights[1].angular_diameter = 0.04f;  // fewer texels than what is cut
  s.pose.lightNames.resize(2);
  addLight(s.pose, rectangleLight({0, 3, 0}, {0, -1, 0}, 2.4f, 0.3f));
  addLight(s.pose, rectangleLight({2, 1, 0}, {-1, 0, 0}, 3, 3));
  addLight(s.pose, rectangleLight({0, 4, 0}, {0, -1, 0}, 2.5f, 2.5f));
  return s;
}

TEST_F(ShadowTechniqueTest, PartsOfALightAddUp) {
  const BallScene bare = wideLights(false), s = wideLights(true);
  for (const TechniquePlugin* plugin : techniques()) {
    if (!has(*plugin, "views")) continue;
    const char* name = plugin->info->name;
    auto settings = quick(*plugin);
    const auto draw = [&](const BallScene& scene, const char* views) {
      settings["views"] = views;
      return visibility(name, settings, scene.scene, scene.pose, scene.camera);
    };
    const Answer unoccluded = draw(bare, "2");
    EXPECT_EQ(unoccluded.uncovered, 0u) << name;
    for (size_t l = 0; l < unoccluded.lights.size(); ++l)
      EXPECT_GT(*std::ranges::min_element(unoccluded.lights[l]), 0.999f) << name << " light " << l;
    const Answer cut = draw(s, "2"), whole = draw(s, "1"), chosen = draw(s, "0");
    EXPECT_EQ(cut.lights[0], whole.lights[0]) << name << ": a point";
    EXPECT_EQ(chosen.lights[0], whole.lights[0]) << name << ": a point";
    EXPECT_EQ(chosen.lights[1], whole.lights[1]) << name << ": a small disc";
    EXPECT_EQ(chosen.lights[4], cut.lights[4]) << name << ": a wide light";
    for (size_t l = 1; l < cut.lights.size(); ++l) EXPECT_NE(cut.lights[l], whole.lights[l]) << name << l;
    for (const uint32_t light : {3u, 4u}) {
      const Errors one = floorErrors(s, whole, light, ballHides),
                   four = floorErrors(s, cut, light, ballHides);
      EXPECT_GT(one.penumbra, 150);
      EXPECT_LT(four.rms, 0.8 * one.rms) << name << " light " << light;
      EXPECT_LT(four.rms, 0.1) << name << " light " << light;
    }
  }
}

TEST_F(ShadowTechniqueTest, SamplesOfAnAreaLightConverge) {
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
TEST_F(ShadowTechniqueTest, ShadowRaysConverge) {
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

TEST_F(ShadowTechniqueTest, BatchesOfSamplesAddUp) {
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

TEST_F(ShadowTechniqueTest, OneSampleIsAHardShadow) {
  const BallScene s;
  const Answer hard = visibility("hard_shadow_map", {{"shadow_map_size", "256"}}, s.scene, s.pose, s.camera);
  const Answer one = visibility("sampled_area_light",
                                {{"samples", "1"}, {"shadow_map_size", "256"}, {"shadow_map_fit", "scene"}},
                                s.scene, s.pose, s.camera);
  for (size_t l = 0; l < 3; ++l) EXPECT_EQ(one.lights[l], hard.lights[l]) << l;
}

TEST_F(ShadowTechniqueTest, SampledDirectLightEqualsClosedForms) {
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
TEST_F(ShadowTechniqueTest, ContactShadowsDoNotDetach) {
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
