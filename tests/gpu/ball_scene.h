// A ball over a floor, and what shadow-map techniques say of its shadow against the exact one.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/technique/registry.h"
#include "glsl/light/light_view.glsl"
#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn::test {

using glm::vec3;

/// A ball of radius 1/2 at (0, 1, 0) over a floor, seen from above, lit by one light of every type.
struct BallScene {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera;
  float scale;

  explicit BallScene(float s = 1, bool ball = true, const glm::mat4& turn = glm::mat4(1), int rings = 64)
      : scale(s) {
    addMesh(scene, floorPrimitive(4 * s, addMaterial(scene)));
    addMesh(scene, spherePrimitive(0.5f * s, 0, rings));
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

  vec3 position(const Answer& v, int x, int y) const { return positionOf(v, camera, pose.bounds, x, y); }
};

/// Whether the technique has that parameter.
inline bool has(const TechniquePlugin& plugin, std::string_view parameter) {
  return std::ranges::any_of(plugin.info->parameters,
                             [&](const Parameter& p) { return std::string_view(p.name) == parameter; });
}

/// Small settings for laws that hold at any.
inline std::map<std::string, std::string> quick(const TechniquePlugin& plugin) {
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
inline bool ballHides(const vec3& from, const vec3& to) {
  const vec3 d = glm::normalize(to), ball(0, 1, 0);
  const float along = glm::dot(ball - from, d);
  return along > 0 && along < glm::length(to) && glm::distance(ball, from + along * d) < 0.5f;
}

/// The errors of V in the penumbra: their root mean square, the largest, and the number of pixels there.
struct Errors {
  double rms = 0, worst = 0;
  int penumbra = 0;
};

/// Asks techniques about the lights of a BallScene.
class BallTest : public TechniqueTest {
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

}  // namespace limn::test
