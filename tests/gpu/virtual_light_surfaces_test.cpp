// What of the flux of virtual point lights surfaces, the medium and other lights leave.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/material_model.h"
#include "glsl/materials/model.glsl"
#include "glsl/numeric/geometry.glsl"
#include "glsl/surface/brdf.glsl"
#include "tests/gpu/virtual_light_harness.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

TEST_F(VirtualLightTest, LightsThatSeeOnlyBackFacesReflectNothing) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, spherePrimitive(1, addMaterial(scene, lambert(colour))));
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 0, 0}));
  EXPECT_EQ(sample(scene, pose, {.count = 100}).flux, vec3(0));
  scene.materials[0].doubleSided = true;
  expectFlux(sample(scene, pose, {.count = 100}), colour * 4.f * kPi, 0.01f);
}

/// Light of a narrow spot is as long on its way as the spot hangs high, to 0.13 %: T = exp(-sigma h) in each
/// channel. Nothing but the medium differs, so that texels and their rounding are the same.
TEST_F(VirtualLightTest, TheMediumTakesOfTheLightOnItsWay) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, spotLight({0, 1, 0}, {0, -1, 0}, 0.05f));
  const vec3 clear = sample(scene, pose, {.count = 64}).reflected;
  scene.medium.sigmaA = {0.7f, 0.2f, 0};
  scene.medium.sigmaS = {0.3f, 0, 0};
  for (const int sets : {1, 4}) {
    const Sampled s = sample(scene, pose, {.count = 64, .sets = sets});
    expectFlux(s, clear * vec3(std::exp(-1.f), std::exp(-0.2f), 1), 0.005f);
  }
}

/// A floor that is black around a small square in its middle, above which the medium's ball, the floor's
/// bounding sphere, reaches up by its radius r: parallel light is taken from there on. The square lies 0.01 m
/// above the ball's plane and is 0.14 m wide to its corners: of sigma = 0.5 that is 0.4 %.
TEST_F(VirtualLightTest, ParallelLightIsTakenFromWhereItEntersTheMedium) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(vec3(0)))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, addMesh(scene, floorPrimitive(0.1f, addMaterial(scene, lambert(colour)))),
              at(0, 0.01f, 0));
  addLight(pose, directionalLight({0, -1, 0}, 0));
  const vec3 clear = sample(scene, pose, {.count = 64}).reflected;
  ASSERT_GT(clear.x, 0);
  scene.medium.sigmaA = {0.5f, 0.25f, 0};
  const float r = pose.bounds.radius();
  const vec3 expected = clear * vec3(std::exp(-0.5f * r), std::exp(-0.25f * r), 1);
  const vec3 found = sample(scene, pose, {.count = 64}).reflected;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.01f * expected[c]) << c;
}

TEST_F(VirtualLightTest, SeveralLightsShareThemByFlux) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, pointLight({0.3f, -0.2f, 0.5f}));
  glsl::Light strong = spotLight({0, 0.5f, 0}, {0, -1, 0}, 0.5f);
  strong.emission = glm::vec3(0, 100, 0);
  addLight(pose, strong);
  glsl::Light dark = pointLight({0, 0, 0});
  dark.emission = glm::vec3(0);
  addLight(pose, dark);
  const float solid = 2 * kPi * (1 - strong.cos_inner + (strong.cos_inner - strong.cos_outer) / 3);
  const vec3 fromStrong = colour * vec3(0, 100, 0) * solid, fromPoint = colour * 4.f * kPi;
  const Sampled s = sample(scene, pose, {.count = 900});
  expectFlux(s, fromPoint + fromStrong, 0.01f);
  int green = 0;
  for (const glsl::VirtualPointLight& v : s.lights) green += v.flux.x == 0 && v.flux.y >= 0;
  const float share = (fromStrong.y) / (fromStrong.y + fromPoint.x + fromPoint.y + fromPoint.z);
  EXPECT_NEAR(static_cast<float>(green) / 900, share, 0.03f);
  expectFlux(sample(scene, pose, {.count = 2}), fromPoint + fromStrong, 0.01f);
}

/// Half of a floor reflects a channel whose mean over the map is below the least float where that of the one
/// sample, if it falls on that half, is not.
TEST_F(VirtualLightTest, ChannelsTooWeakForASumAreLost) {
  for (const float red : {-0.1f, 0.1f}) {
    scene::Scene scene;
    scene::Pose pose;
    addMesh(scene, floorPrimitive(0.1f, addMaterial(scene, lambert({1, 1, 0}))));
    addMesh(scene, floorPrimitive(0.1f, addMaterial(scene, lambert({0, 1, 0}))));
    addInstance(scene, pose, 0, at(red, 0, 0));
    addInstance(scene, pose, 1, at(-red, 0, 0));
    glsl::Light light = directionalLight({0, -1, 0}, 0);
    for (float weak = 1e-36f; weak > 2e-38f; weak *= 0.7f) {
      light.emission = vec3(weak, 1, 0);
      pose.lights.clear();
      pose.lightNames.clear();
      addLight(pose, light);
      EXPECT_GT(sample(scene, pose, {.count = 1, .mapSize = 16}).flux.y, 0) << weak;
    }
  }
}

TEST_F(VirtualLightTest, NothingToLightIsHarmless) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(1, addMaterial(scene, lambert(colour))));
  addInstance(scene, pose, 0);
  addLight(pose, spotLight({0, 2, 0}, {0, 1, 0}, 0.5f));
  EXPECT_EQ(sample(scene, pose, {.count = 64}).flux, vec3(0));
}

/// Fresnel's layer takes its part: the diffuse reflectance of the BRDF itself, integrated.
TEST_F(VirtualLightTest, AlbedoIsTheDiffusePartOfTheBrdf) {
  scene::Scene scene;
  scene::Material material = lambert(colour);
  material.specularFactor = 1;
  material.metallic = 0.25f;
  material.roughness = 0.4f;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, material)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  const vec3 towards = glm::normalize(vec3(-0.8f, 1, 0.3f));
  addLight(pose, directionalLight(-towards, 0));
  const glsl::SurfaceBrdf s = glsl::surface_brdf(colour, 0.25f, 0.4f, 1, vec3(1), 1.5f);
  double weight = 0;
  constexpr int side = 300;
  const vec3 up(0, 0, 1), l(std::sqrt(1 - towards.y * towards.y), 0, towards.y);
  for (int i = 0; i < side * side; ++i) {
    const vec3 v = glsl::sample_cosine({(i % side + 0.5f) / side, (i / side + 0.5f) / side});
    weight += glsl::brdf_diffuse_weight(s, glsl::half_vector(up, v, l).v_dot_h);
  }
  weight /= side * side;
  expectFlux(sample(scene, pose, {.count = 128}), s.diffuse * 16.f * towards.y * static_cast<float>(weight),
             0.01f);
}

/// Vertices have colours for metallic-roughness; a model's are its own.
TEST_F(VirtualLightTest, AModelReflectsItsAlbedoWhateverColoursVerticesHave) {
  glsl::MaterialModel matte{};
  matte.kind = glsl::model_phong;
  matte.exponent = 1;
  matte.kd = colour;
  scene::Scene scene;
  scene::Material material = lambert(vec3(1));
  scene::setModel(material, matte);
  scene::Primitive floor = floorPrimitive(2, addMaterial(scene, material));
  floor.colours.assign(floor.positions.size(), glm::vec4(0.1f, 0.2f, 0.3f, 1));
  addMesh(scene, floor);
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0, -1, 0}, 0));
  expectFlux(sample(scene, pose, {.count = 128}), colour * 16.f, 0.01f);
}

}  // namespace
}  // namespace limn
