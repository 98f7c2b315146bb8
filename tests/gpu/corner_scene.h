// A floor and a wall that see each other, lit by a spot: what tests of indirect light look at, with closed
// forms where the spot is narrow.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn::test {

using Settings = std::map<std::string, std::string>;

inline scene::Material lambert(float albedo) {
  scene::Material m;
  m.baseColour = glm::vec4(albedo, albedo, albedo, 1);
  m.metallic = 0;
  m.specularFactor = 0;
  return m;
}

/// A floor (y = 0) and a wall (x = 1, facing -x). A spot above the floor lights it: by default a speck of 0.1
/// m.
struct Corner {
  static constexpr float albedo = 0.6f;
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera = scene::lookAt({-2, 1.5f, 2}, {0.8f, 0.4f, 0}, 0.7f);
  double flux = 0;  ///< that what the spot lights reflects, W

  /// `halfAngle` of the spot, radians; `spotX`: where it hangs, m.
  explicit Corner(const scene::Material& material = lambert(albedo), float halfAngle = 0.05f,
                  float spotX = 0) {
    const int mesh = addMesh(scene, floorPrimitive(1, addMaterial(scene, material)));
    addInstance(scene, pose, mesh);
    addInstance(scene, pose, mesh, glm::translate(glm::mat4(1), {1, 1, 0}) * upright());
    glsl::Light light = spotLight({spotX, 1, 0}, {0, -1, 0}, halfAngle);
    light.emission = glm::vec3(1000);
    addLight(pose, light);
    const double inner = 1 - light.cos_inner, outer = 1 - light.cos_outer;
    flux = albedo * 1000 * 2 * glsl::pi * (inner + (outer - inner) / 3);
  }
  /// Gives the wall, which is instance 1, a material of its own.
  void paintWall(const scene::Material& material) {
    const int own = addMaterial(scene, material);
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].primitives[0].material = own;
    pose.instances[1].mesh = 1;
  }
  /// Parallel to the wall, 0.3 m high and 2 `halfWidth` wide, at `x` m: by default a square halfway between
  /// the origin and the wall.
  void addPlate(float x = 0.5f, float halfWidth = 0.15f) {
    addInstance(scene, pose, addMesh(scene, floorPrimitive(0.15f, 0)),
                glm::translate(glm::mat4(1), {x, 0.4f, 0}) * upright() *
                    glm::scale(glm::mat4(1), {1, 1, halfWidth / 0.15f}));
  }
  glm::vec3 position(const Answer& v, int x, int y) const { return positionOf(v, camera, pose.bounds, x, y); }

 private:
  static glm::mat4 upright() { return glm::rotate(glm::mat4(1), 0.5f * glsl::pi, glm::vec3(0, 0, 1)); }
};

class CornerTest : public TechniqueTest {
 protected:
  /// Indirect light, of every virtual light in every pixel and without a bound unless `settings` say
  /// otherwise.
  Answer answer(const std::string& name, const Corner& s, Settings settings) {
    settings.insert({{"block", "1"}, {"clamp", "0"}});
    Answer v = visibility(name, settings, s.scene, s.pose, s.camera, {}, Term::indirect);
    for (const float value : v.lights[0]) EXPECT_TRUE(std::isfinite(value) && value >= 0);
    return v;
  }

  struct Shadow {
    float leak;     ///< part of its light that what the plate hides may keep
    float stray;    ///< part by which what it does not hide may differ
    float blurred;  ///< half width of the edge, m at the plate
    int lit;        ///< least number of pixels beyond the edge
  };
  /// What the plate of corner `s` hides of the speck from the wall is dark in `seen`, what it does not is as
  /// in `all`, without shadows.
  static void expectPlateHides(const Corner& s, const Answer& all, const Answer& seen, const Shadow& shadow) {
    int hidden = 0, lit = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (all.instance[static_cast<size_t>(y * side + x)] != 1) continue;
        const glm::vec3 p = s.position(all, x, y);
        // On the plate's plane, x = 1/2, the ray from the origin is at half of p; the speck is 0.1 m wide.
        const float outside = std::max(std::abs(0.5f * p.y - 0.4f), std::abs(0.5f * p.z)) - 0.15f;
        if (outside < -shadow.blurred) {
          EXPECT_NEAR(seen.at(0, x, y), 0, shadow.leak * all.at(0, x, y)) << x << "," << y;
          ++hidden;
        } else if (outside > shadow.blurred) {
          EXPECT_NEAR(seen.at(0, x, y), all.at(0, x, y), shadow.stray * all.at(0, x, y) + 1e-4f)
              << x << "," << y;
          ++lit;
        }
      }
    }
    EXPECT_GT(hidden, 50);
    EXPECT_GT(lit, shadow.lit);
  }
};

}  // namespace limn::test
