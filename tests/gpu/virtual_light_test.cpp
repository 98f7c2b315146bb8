// Virtual point lights carry the flux that the scene reflects of a light of any kind.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "glsl/light/rectangle_light.glsl"
#include "glsl/numeric/sampling.glsl"
#include "tests/gpu/virtual_light_harness.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

TEST_F(VirtualLightTest, SpotOverAPlane) {
  for (const float scale : {1.f, 1e-4f, 1e4f}) {
    scene::Scene scene;
    addMesh(scene, floorPrimitive(20 * scale, addMaterial(scene, lambert(colour))));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    glsl::Light light = spotLight(vec3(1, 3, 0.5f) * scale, {0.2f, -1, 0.1f}, 0.7f);
    light.emission = glm::vec3(5, 5, 5);
    addLight(pose, light);
    const float inner = light.cos_inner, outer = light.cos_outer;
    const float solid = 2 * kPi * (1 - inner + (inner - outer) / 3);
    const Sampled s = sample(scene, pose, {.count = 1000});
    expectFlux(s, colour * 5.f * solid, 0.01f);
    for (const glsl::VirtualPointLight& v : s.lights) {
      if (v.flux.x == 0) continue;
      EXPECT_NEAR(v.position.y / scale, 0, 1e-4f);
      EXPECT_NEAR(v.normal.y, 1, 1e-3f);
    }
  }
}

TEST_F(VirtualLightTest, PointLightInABox) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, pointLight({0.3f, -0.2f, 0.5f}));
  // A power of two, odd, fewer than the layers, and one.
  for (const int count : {1024, 777, 3, 1}) {
    SCOPED_TRACE(count);
    expectFlux(sample(scene, pose, {.count = count}), colour * 4.f * kPi, 0.01f);
  }
}

TEST_F(VirtualLightTest, StandForTheSurfacesThatTheLightSees) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, pointLight({0.3f, -0.2f, 0.5f}));
  const auto area = [&](int lightSamples) {
    double sum = 0;
    const Sampled s = sample(scene, pose, {.count = 4096, .lightSamples = lightSamples});
    for (const glsl::VirtualPointLight& light : s.lights) sum += light.area;
    return sum;
  };
  EXPECT_NEAR(area(1), 6 * 4, 0.02 * 6 * 4);
  // All points on a light see the same walls.
  pose.lights = {rectangleLight({0, 0, 0}, {0, -1, 0}, 0.5f, 0.25f, true)};
  for (const int lightSamples : {1, 16}) EXPECT_NEAR(area(lightSamples), 6 * 4, 0.02 * 6 * 4) << lightSamples;
}

TEST_F(VirtualLightTest, ParallelLightOnAPlane) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0.3f, -1, 0.2f}, 0.02f));
  const float cosine = 1 / glm::length(vec3(0.3f, -1, 0.2f));
  expectFlux(sample(scene, pose, {.count = 500}), colour * 16.f * cosine, 0.01f);
  expectFlux(sample(scene, pose, {.count = 500, .lightSamples = 4}), colour * 16.f * cosine, 0.01f);
}

/// Half a radian to all sides: points on the disc shine along directions whose mean cosine is 0.94, and give
/// a floor that faces the disc its irradiance together. 16 points of the sequence have that mean to a
/// thousandth.
TEST_F(VirtualLightTest, AWideDiscGivesItsIrradiance) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0, -1, 0}, 1));
  for (const int samples : {1, 16})
    expectFlux(sample(scene, pose, {.count = 500, .lightSamples = samples}), colour * 16.f, 0.01f);
}

/// The upper face of a cube around the receivers, with the irradiance 1 on what is perpendicular to each of
/// its directions: pi F over its solid angle of 2 pi / 3 on a floor (tests/unit/glsl/virtual_light_test.cpp
/// has F), 0.83. As one direction it would give 1.
TEST_F(VirtualLightTest, ADistantRectangleIsNoDirection) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  glsl::Light light = directionalLight({0, -1, 0}, 0);
  light.position = {0, 1, 0};
  light.length_u = light.length_v = 2;
  light.flags = glsl::light_flag_environment;
  light.solid_angle = 2 * kPi / 3;
  addLight(pose, light);
  const float given = 6 / kPi * std::sqrt(0.5f) * std::atan(std::sqrt(0.5f));
  expectFlux(sample(scene, pose, {.count = 500}), colour * (16 * given), 0.01f);
}

TEST_F(VirtualLightTest, RectanglesOneAndTwoSided) {
  for (const bool twoSided : {false, true}) {
    scene::Scene scene;
    scene::Pose pose;
    addBox(scene, pose, addMaterial(scene, lambert(colour)));
    addLight(pose, rectangleLight({0, 0.5f, 0}, {0, -1, 0}, 0.5f, 0.25f, twoSided));
    const vec3 expected = colour * (kPi * 0.125f * (twoSided ? 2.f : 1.f));
    for (const int samples : {1, 5})
      expectFlux(sample(scene, pose, {.count = 300, .lightSamples = samples}), expected, 0.01f);
  }
}

/// A square of 2 m, half a metre above the floor: what the square below it gets is exact, which points of the
/// light's intensity would miss by far.
TEST_F(VirtualLightTest, ALargeRectangleIsNoPoint) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(20, addMaterial(scene, lambert(colour))));
  addInstance(scene, pose, 0);
  const glsl::Light light = rectangleLight({0, 0.5f, 0}, {0, -1, 0}, 2, 2, false);
  addLight(pose, light);
  constexpr int side = 200;
  double below = 0, asPoint = 0;
  for (int i = 0; i < side * side; ++i) {
    const glm::vec2 u = 2.f * glsl::grid_point(i, side) - 1.f;
    const vec3 p(u.x, 0, u.y);
    below += glsl::rectangle_irradiance(glsl::rectangle_from(light, p), {0, 1, 0});
    const double d2 = glm::dot(p, p) + 0.25;
    asPoint += 4 * 0.25 / (d2 * d2);
  }
  below *= 4.0 / (side * side);
  asPoint *= 4.0 / (side * side);
  ASSERT_GT(asPoint, 1.3 * below);
  for (const int samples : {1, 4}) {
    const Sampled s = sample(scene, pose, {.count = 8192, .mapSize = 512, .lightSamples = samples});
    expectFlux(s, colour * (4 * kPi), 0.01f);
    double found = 0;
    for (const glsl::VirtualPointLight& v : s.lights)
      if (std::abs(v.position.x) < 1 && std::abs(v.position.z) < 1) found += v.flux.x;
    EXPECT_NEAR(found, colour.x * below, 0.02 * colour.x * below) << samples << " samples";
  }
}

/// Irradiance at points on the walls of a box, in which nothing hides anything: few virtual lights for each
/// map of a light that is drawn from many points are no reason for more noise.
TEST_F(VirtualLightTest, PointsOfOneLightAddLittleNoise) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, rectangleLight({0.1f, 0.8f, -0.2f}, {0, -1, 0}, 0.5f, 0.4f, false));
  std::vector<std::pair<vec3, vec3>> receivers;  // points and normals
  for (const auto& [axis, wall] :
       {std::pair(0, -1.f), std::pair(0, 1.f), std::pair(1, -1.f), std::pair(2, -1.f)})
    for (int i = 0; i < 10 * 10; ++i) {
      const glm::vec2 u = 2.f * glsl::grid_point(i, 10) - 1.f;
      vec3 point(0), normal(0);
      point[axis] = wall;
      normal[axis] = -wall;
      point[(axis + 1) % 3] = u.x;
      point[(axis + 2) % 3] = u.y;
      receivers.emplace_back(point, normal);
    }
  const auto irradiance = [&](const indirect::VirtualLightDesc& desc) {
    std::vector<double> out;
    const Sampled s = sample(scene, pose, desc);
    for (const auto& [point, normal] : receivers) {
      double sum = 0;
      for (const glsl::VirtualPointLight& light : s.lights) {
        const vec3 to = light.position - point;
        const float d2 = glm::dot(to, to);
        if (d2 > 0)
          sum += light.flux.x / kPi * std::max(glm::dot(normal, to), 0.f) *
                 std::max(-glm::dot(light.normal, to), 0.f) / (d2 * std::max(d2, 0.01f));
      }
      out.push_back(sum);
    }
    return out;
  };
  const std::vector<double> expected = irradiance({.count = 16384});
  const auto error = [&](int count, int lightSamples) {
    const std::vector<double> found = irradiance({.count = count, .lightSamples = lightSamples});
    double sum = 0;
    for (size_t i = 0; i < found.size(); ++i) sum += (found[i] - expected[i]) * (found[i] - expected[i]);
    return std::sqrt(sum / std::inner_product(expected.begin(), expected.end(), expected.begin(), 0.0));
  };
  for (const int count : {256, 1024}) {
    const double one = error(count, 1);
    for (const int lightSamples : {16, 64})
      EXPECT_LT(error(count, lightSamples), 1.4 * one)
          << count << " virtual lights, " << lightSamples << " points";
  }
}

}  // namespace
}  // namespace limn
