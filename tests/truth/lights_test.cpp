// What lamps bring to a matte floor: the inverse square law, KHR_lights_punctual and Lambert's polygon.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kWhite = 1;  // 8 bits hold it exactly

class LightTruth : public TruthTest {
 protected:
  /// A floor in the plane y = 0.
  static scene::Scene floor() {
    scene::Scene scene;
    test::show(scene, test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4},
                                 test::addMaterial(scene, test::lambertian(float(kWhite)))));
    return scene;
  }
  static Question question(int spp = 2) {
    return {.camera = scene::lookAt({0.3f, 3.5f, 1}, {0, 0, 0}, 0.8f), .spp = spp};
  }
  /// Lambert's radiance of the irradiance at a place.
  template <class Irradiance>
  static auto reflected(Irradiance irradiance) {
    return [=](const dvec3& p, const dvec3&) { return kWhite / M_PI * irradiance(p); };
  }
};

TEST_F(LightTruth, APointFollowsTheInverseSquare) {
  scene::Scene scene = floor();
  const dvec3 lamp(0.4, 1.1, -0.3);
  test::shine(scene, test::lamp(glsl::light_point, 7), vec3(lamp));
  expectBoth(scene, question(),
             reflected([&](const dvec3& p) { return 7 * lamp.y / std::pow(glm::length(lamp - p), 3); }),
             {.mean = 1e-3, .average = 1e-3, .largest = 0.01});
}

/// KHR_lights_punctual, "Inner and Outer Cone Angles".
TEST_F(LightTruth, ASpotFallsOffBetweenItsCones) {
  scene::Scene scene = floor();
  const dvec3 lamp(-0.4, 1.5, 0.2), axis = glm::normalize(dvec3(0.3, -1, 0));
  scene::LightSource source = test::lamp(glsl::light_spot, 9);
  source.innerCone = 0.3f;
  source.outerCone = 0.7f;
  test::shine(scene, source, vec3(lamp), vec3(axis));
  const double scale = 1 / (std::cos(0.3) - std::cos(0.7)), offset = -std::cos(0.7) * scale;
  expectBoth(scene, question(), reflected([&](const dvec3& p) {
               const dvec3 away = p - lamp;
               const double distance = glm::length(away);
               const double part = std::clamp(glm::dot(axis, away) / distance * scale + offset, 0.0, 1.0);
               return 9 * part * part * lamp.y / std::pow(distance, 3);
             }),
             {.mean = 2e-3, .average = 2e-3});
}

TEST_F(LightTruth, TheSunFollowsItsCosine) {
  for (const double angle : {0.0, 0.8, 1.4}) {
    scene::Scene scene = floor();
    test::shine(scene, test::lamp(glsl::light_directional, 3), vec3(0),
                vec3(float(std::sin(angle)), float(-std::cos(angle)), 0));
    expectBoth(scene, question(), reflected([&](const dvec3&) { return 3 * std::cos(angle); }),
               {.mean = 1e-3, .average = 1e-3, .largest = 0.01});
  }
}

/// Lambert 1760. Upright, the lamp goes below the horizon of what it lights.
TEST_F(LightTruth, ARectangleIsLambertsPolygon) {
  for (const vec3& facing : {vec3(0.2f, -1, 0.1f), vec3(1, 0, 0)}) {
    SCOPED_TRACE(facing.x);
    scene::Scene scene = floor();
    const vec3 place(-0.5f, 0.45f, 0);
    test::shine(scene, test::lamp(glsl::light_point, 6), place, facing);
    scene.nodes.back().limnArea = {0.8f, 0.5f};
    const auto& turn = scene.nodes.back().transform.rotation;
    const dvec3 u(0.4f * (turn * vec3(1, 0, 0))), v(0.25f * (turn * vec3(0, 1, 0))), middle(place);
    const dvec3 front(glm::normalize(facing));
    const std::vector<dvec3> corners{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    expectBoth(scene, question(64), reflected([&](const dvec3& p) {
                 if (glm::dot(p - middle, front) < 0) return 0.0;
                 return 6 / (0.8 * 0.5) * test::lambertIrradiance(p, {0, 1, 0}, corners);
               }),
               {.mean = 5e-3, .average = 0.03});
  }
}

}  // namespace
}  // namespace limn
