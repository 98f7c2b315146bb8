// Planes over a floor under a rectangular light that faces them, and the closed form of their shadow.
#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "tests/gpu/technique_harness.h"
#include "tests/support/test_scenes.h"

namespace limn::test {

/// A floor under a square light; what hides the light is up to the test.
struct Planes {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraPose camera;

  explicit Planes(float light = 0.8f, float height = 4) {
    addMesh(scene, floorPrimitive(4, addMaterial(scene)));
    addInstance(scene, pose, 0);
    addLight(pose, rectangleLight({0, height, 0}, {0, -1, 0}, light, light));
    camera = scene::lookAt({0, 3, 6}, {0, 0, 0}, 0.8f);
  }
  void addPlane(float half, const glm::mat4& place) {
    addMesh(scene, floorPrimitive(half, 0));
    addInstance(scene, pose, static_cast<int>(scene.meshes.size()) - 1, place);
  }
  glm::vec3 position(const Answer& v, int x, int y) const { return positionOf(v, camera, pose.bounds, x, y); }
};

class PlanesTest : public TechniqueTest {
 protected:
  using Settings = std::map<std::string, std::string>;

  /// V of the light, in maps of 256 texels where `settings` do not say otherwise.
  Answer answer(const Planes& s, Settings settings = {}, const std::string& name = "vssm") {
    settings.try_emplace("shadow_map_size", "256");
    Answer v = visibility(name, settings, s.scene, s.pose, s.camera);
    int bad = 0;
    for (const float value : v.lights[0]) bad += !(value >= 0 && value <= 1);
    EXPECT_EQ(bad, 0) << name << ": outside [0, 1] or NaN";
    return v;
  }
};

/// The share of the light, which is `light` m wide along one axis and 4 m above the floor, that a square of
/// side 1 m, 1 m above the floor, hides along that axis from the floor's place p. The product of both axes'
/// shares is hidden.
inline float hiddenShare(float p, float light) {
  const float half = 0.5f * light, a = p + 4 * (0.5f - p), b = p + 4 * (-0.5f - p);
  return std::clamp(std::min(a, half) - std::max(b, -half), 0.f, light) / light;
}

}  // namespace limn::test
