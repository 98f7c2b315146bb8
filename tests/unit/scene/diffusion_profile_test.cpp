// Which translucent materials a scene draws, and what stands for their textures.
#include "core/scene/diffusion_profile.h"

#include <gtest/gtest.h>

#include "core/image/byte_values.h"
#include "core/scene/subsurface.h"
#include "tests/support/test_scenes.h"

namespace limn::scene {
namespace {

Material translucent(float extinction) {
  Material material;
  material.subsurface = Subsurface{.extinction = glm::vec3(extinction), .absorption = glm::vec3(0.1f)};
  return material;
}

/// Techniques dispatch for each kind, over the whole picture.
TEST(TranslucentKinds, AreThoseThatAreDrawnEachOnce) {
  Scene scene;
  test::addMaterial(scene);
  for (const float extinction : {10.f, 20.f, 10.f, 30.f}) test::addMaterial(scene, translucent(extinction));
  Pose pose;
  for (const int material : {0, 1, 3}) test::addMesh(scene, test::floorPrimitive(1, material));
  EXPECT_TRUE(translucentKinds(scene, pose).kinds.empty()) << "nothing is drawn";
  for (const int mesh : {0, 1, 2}) test::addInstance(scene, pose, mesh);
  scene.dynamic.push_back({"source", nullptr, 4});

  TranslucentKinds found = translucentKinds(scene, pose);
  EXPECT_EQ(found.kinds.size(), 1u);
  EXPECT_EQ(found.ofMaterials, (std::vector<uint32_t>{~0u, 0, ~0u, 0, ~0u}));

  pose.instances.push_back({.node = kNone, .mesh = 0});
  found = translucentKinds(scene, pose);
  ASSERT_EQ(found.kinds.size(), 2u);
  EXPECT_EQ(found.kinds[1].extinction, glm::vec3(30));
  EXPECT_EQ(found.ofMaterials, (std::vector<uint32_t>{~0u, 0, ~0u, 0, 1}));
}

/// Vertex colours are factors on the albedo, and materials that they tell apart are of two kinds.
TEST(TranslucentKinds, HaveTheMeanColourOfTheirVertices) {
  Scene scene;
  Material material = translucent(10);
  material.subsurface->albedoFromBaseColour = true;
  material.baseColour = glm::vec4(0.8f, 0.5f, 1, 1);
  for (int i = 0; i < 3; ++i) test::addMaterial(scene, material);
  Pose pose;
  for (const int index : {0, 1, 1, 2}) {
    Primitive plane = test::floorPrimitive(1, index);
    if (index == 1 && scene.meshes.size() == 1) plane.colours.assign(4, glm::vec4(0.5f, 0, 1, 0));
    test::addInstance(scene, pose, test::addMesh(scene, plane));
  }
  const TranslucentKinds found = translucentKinds(scene, pose);
  ASSERT_EQ(found.kinds.size(), 2u);
  EXPECT_EQ(found.ofMaterials, (std::vector<uint32_t>{0, 1, 0}));
  EXPECT_EQ(found.kinds[0].albedo, glm::vec3(0.8f, 0.5f, 1));
  EXPECT_EQ(found.kinds[1].albedo, glm::vec3(0.75f * 0.8f, 0.5f * 0.5f, 1))
      << "half of the vertices are white";
  EXPECT_FALSE(found.kinds[0].textured) << "all pixels have the same albedo";
  EXPECT_TRUE(found.kinds[1].textured && found.textured);
  for (const TranslucentKind& kind : found.kinds)
    EXPECT_EQ(kind.absorption, subsurfaceAbsorption(kind.albedo, material.ior));
}

/// Passes read the albedo of pixels only where it is not one for the whole material.
TEST(TranslucentKinds, AreTexturedWhereTheirAlbedoVaries) {
  Scene scene;
  scene.images.resize(1);
  const auto textured = [&](bool fromBaseColour, int image, bool coloured) {
    Material material = translucent(10);
    material.subsurface->albedoFromBaseColour = fromBaseColour;
    material.baseColourTexture.image = image;
    Primitive plane = test::floorPrimitive(1, test::addMaterial(scene, material));
    if (coloured) plane.colours.assign(4, glm::vec4(1));
    Pose pose;
    test::addInstance(scene, pose, test::addMesh(scene, plane));
    return translucentKinds(scene, pose).textured;
  };
  EXPECT_FALSE(textured(true, kNone, false));
  EXPECT_TRUE(textured(true, 0, false));
  EXPECT_TRUE(textured(true, kNone, true)) << "white ones count as well";
  EXPECT_FALSE(textured(false, 0, true)) << "coefficients say what absorbs";
}

TEST(BaseAlbedo, IsTheMeanOrTheLargestOfItsTexture) {
  Scene scene;
  TextureImage& image = scene.images.emplace_back();
  image.srgb = true;
  image.levels.push_back({2, 1, {200, 10, 0, 255, 100, 30, 0, 255}});
  image.levels.push_back({1, 1, {160, 22, 0, 255}});
  Material material;
  material.baseColour = glm::vec4(0.5f, 1, 1, 1);
  material.baseColourTexture.image = 0;
  const auto& values = byteValues(true);
  EXPECT_EQ(baseAlbedo(scene, material, OfTexels::mean), glm::vec3(0.5f * values[160], values[22], 0));
  EXPECT_EQ(baseAlbedo(scene, material, OfTexels::largest), glm::vec3(0.5f * values[200], values[30], 0));

  image.levels.clear();  // it counts as white
  for (const OfTexels which : {OfTexels::mean, OfTexels::largest})
    EXPECT_EQ(baseAlbedo(scene, material, which), glm::vec3(0.5f, 1, 1));
}

}  // namespace
}  // namespace limn::scene
