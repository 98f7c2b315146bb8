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
  /// Of the rectangle that the light of a node is.
  static std::vector<dvec3> corners(const scene::Node& node) {
    const glm::quat& turn = node.transform.rotation;
    const dvec3 u(0.5f * node.limnArea.x * (turn * vec3(1, 0, 0))),
        v(0.5f * node.limnArea.y * (turn * vec3(0, 1, 0))), middle(node.transform.translation);
    return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  }
  /// KHR_lights_punctual, "Inner and Outer Cone Angles", of 0.3 and 0.7 radians.
  static double coneFactor(const dvec3& axis, const dvec3& away) {
    const double scale = 1 / (std::cos(0.3) - std::cos(0.7)), offset = -std::cos(0.7) * scale;
    const double part = std::clamp(glm::dot(axis, away) / glm::length(away) * scale + offset, 0.0, 1.0);
    return part * part;
  }
  static scene::LightSource spot(float intensity) {
    scene::LightSource source = test::lamp(glsl::light_spot, intensity);
    source.innerCone = 0.3f;
    source.outerCone = 0.7f;
    return source;
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

TEST_F(LightTruth, ASpotFallsOffBetweenItsCones) {
  scene::Scene scene = floor();
  const dvec3 lamp(-0.4, 1.5, 0.2), axis = glm::normalize(dvec3(0.3, -1, 0));
  test::shine(scene, spot(9), vec3(lamp), vec3(axis));
  expectBoth(scene, question(), reflected([&](const dvec3& p) {
               return 9 * coneFactor(axis, p - lamp) * lamp.y / std::pow(glm::length(p - lamp), 3);
             }),
             {.mean = 2e-3, .average = 2e-3});
}

/// KHR_lights_punctual, "Range Property".
TEST_F(LightTruth, ARangeEndsTheLightOfALamp) {
  scene::Scene scene = floor();
  const dvec3 lamp(0.4, 1.1, -0.3);
  scene::LightSource source = test::lamp(glsl::light_point, 7);
  source.range = 1.8f;
  test::shine(scene, source, vec3(lamp));
  expectBoth(scene, question(), reflected([&](const dvec3& p) {
               const double distance = glm::length(lamp - p);
               return 7 * std::max(1 - std::pow(distance / 1.8, 4), 0.0) * lamp.y / std::pow(distance, 3);
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
    const std::vector<dvec3> polygon = corners(scene.nodes.back());
    expectBoth(scene, question(64), reflected([&](const dvec3& p) {
                 if (glm::dot(p - dvec3(place), dvec3(facing)) < 0) return 0.0;
                 return 6 / (0.8 * 0.5) * test::lambertIrradiance(p, {0, 1, 0}, polygon);
               }),
               {.mean = 5e-3, .average = 0.03});
  }
}

/// The cone is a factor on all of the light, by the direction from the middle of the rectangle.
TEST_F(LightTruth, ASpotWithSidesIsLambertsPolygonWithinItsCone) {
  scene::Scene scene = floor();
  const vec3 place(-0.3f, 1.2f, 0.1f);
  const dvec3 axis = glm::normalize(dvec3(0.2, -1, 0.1));
  test::shine(scene, spot(6), place, vec3(axis));
  scene.nodes.back().limnArea = {0.8f, 0.5f};
  const std::vector<dvec3> polygon = corners(scene.nodes.back());
  expectBoth(scene, question(64), reflected([&](const dvec3& p) {
               return 6 / (0.8 * 0.5) * coneFactor(axis, p - dvec3(place)) *
                      test::lambertIrradiance(p, {0, 1, 0}, polygon);
             }),
             {.mean = 5e-3, .average = 0.03});
}

/// Half of a disc of directions about the horizon is seen as a segment of the unit circle (Nusselt 1928): of
/// radius a and radiance L it gives L (a - sin a cos a).
TEST_F(LightTruth, ASunOnTheHorizonLightsByTheHalfAboveIt) {
  constexpr double radius = 0.6;
  scene::Scene scene = floor();
  scene::LightSource sun = test::lamp(glsl::light_directional, 3);
  sun.angle = float(2 * radius);
  test::shine(scene, sun, vec3(0), {1, 0, 0});
  const double sine = std::sin(radius), radiance = 3 / (M_PI * sine * sine);
  expectReference(scene, question(64),
                  reflected([&](const dvec3&) { return radiance * (radius - sine * std::cos(radius)); }),
                  {.mean = 5e-3, .average = 0.05});
}

}  // namespace
}  // namespace limn
