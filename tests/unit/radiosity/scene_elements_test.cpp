// Which poses surface elements follow, and for which they are made again.
#include "core/radiosity/scene_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/scene/material_model.h"
#include "core/scene/metaballs.h"
#include "tests/support/material_models.h"
#include "tests/support/test_scenes.h"

namespace limn::radiosity {
namespace {

/// A sphere, posed by a matrix.
struct PosedSphere {
  scene::Scene scene;

  PosedSphere() { test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene), 8)); }

  scene::Pose pose(const glm::mat4& matrix) const {
    scene::Pose pose;
    test::addInstance(scene, pose, 0, matrix);
    return pose;
  }
  SceneElements elements(const glm::mat4& matrix) const {
    return SceneElements(scene, pose(matrix), 10, 1u << 20);
  }
};

glm::mat4 scaled(const glm::vec3& factors) {
  return glm::scale(glm::mat4(1), factors);
}

/// Triangles face where their normals point, whether the instance or the joints of a skin mirror.
TEST(SceneElementsTest, TurnTheWindingWhereTransformsMirror) {
  scene::Scene scene;
  scene::Primitive floor = test::floorPrimitive(1, test::addMaterial(scene));
  floor.joints.assign(4, glm::u16vec4(0));
  floor.weights.assign(4, glm::vec4(1, 0, 0, 0));
  const int mesh = test::addMesh(scene, floor);
  const glm::mat4 mirror = glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1));
  scene::Pose rigid, skinned;
  test::addInstance(scene, rigid, mesh, mirror);
  test::addInstance(scene, skinned, mesh);
  skinned.instances[0].deformed = 0;
  skinned.instances[0].mirroredSkin = true;
  skinned.deformed.push_back({mesh, 0, {mirror}, {}});
  for (const scene::Pose* pose : {&rigid, &skinned}) {
    const SceneElements elements(scene, *pose, 0.5f, 1u << 20);
    const Surfels& s = elements.surfels();
    ASSERT_FALSE(s.triangles.empty());
    for (size_t t = 0; t < s.triangles.size(); t += 3) {
      const glm::vec3 a = s.vertices[s.triangles[t]], b = s.vertices[s.triangles[t + 1]],
                      c = s.vertices[s.triangles[t + 2]];
      EXPECT_GT(glm::dot(glm::cross(b - a, c - a), s.normals[s.triangles[t]]), 0) << t;
    }
  }
}

TEST(SceneElementsTest, FollowWhatKeepsItsSize) {
  const PosedSphere world;
  const SceneElements elements = world.elements(scaled({1, 2, 1}));
  EXPECT_TRUE(elements.fits(world.pose(scaled({1, 2, 1}))));
  const glm::mat4 turned = glm::rotate(test::at(3, -1, 2), 1.f, glm::normalize(glm::vec3(1, 2, 3)));
  EXPECT_TRUE(elements.fits(world.pose(turned * scaled({1, 2, 1}))));
  EXPECT_TRUE(elements.fits(world.pose(scaled({1.1f, 2.1f, 1.1f}))));
  const SceneElements flat = world.elements(scaled({1, 0, 1}));
  EXPECT_TRUE(flat.fits(world.pose(turned * scaled({1, 0, 1}))));
  const SceneElements none = world.elements(scaled(glm::vec3(0)));
  EXPECT_TRUE(none.fits(world.pose(scaled(glm::vec3(0)))));
}

TEST(SceneElementsTest, DoNotFitWhatGrewVanishedAppearedOrIsMirrored) {
  const PosedSphere world;
  const SceneElements elements = world.elements(glm::mat4(1));
  for (const glm::vec3& factors : {glm::vec3(3), glm::vec3(0.3f), glm::vec3(2, 1, 1), glm::vec3(0),
                                   glm::vec3(1, 0, 1), glm::vec3(-1, 1, 1), glm::vec3(-1)})
    EXPECT_FALSE(elements.fits(world.pose(scaled(factors)))) << factors.x << " " << factors.y;
  const SceneElements none = world.elements(scaled(glm::vec3(0)));
  for (const float size : {1e-6f, 1.f, 1e6f})
    EXPECT_FALSE(none.fits(world.pose(scaled(glm::vec3(size))))) << size;
}

/// Elements keep the areas that they were made with, whatever makes a surface larger.
TEST(SceneElementsTest, DoNotFitSkinsAndMorphsThatChangeTheirArea) {
  scene::Scene scene;
  scene::Primitive floor = test::floorPrimitive(1, test::addMaterial(scene));
  scene::Primitive skin = floor, morph = floor;
  skin.joints.assign(4, glm::u16vec4(0));
  skin.weights.assign(4, glm::vec4(1, 0, 0, 0));
  morph.morphTargets.push_back({floor.positions, {}, {}, {}});  // weight w: 1 + w times as wide
  const int skinned = test::addMesh(scene, skin), morphed = test::addMesh(scene, morph);
  const auto pose = [&](const glm::mat4& joint, float weight) {
    scene::Pose made;
    test::addInstance(scene, made, skinned);
    test::addInstance(scene, made, morphed, scaled(glm::vec3(5)));
    made.instances[0].deformed = 0;
    made.instances[1].deformed = 1;
    made.deformed = {{skinned, 0, {joint}, {}}, {morphed, 0, {}, {weight}}};
    return made;
  };
  const glm::mat4 one(1), turned = glm::rotate(test::at(3, -1, 2), 1.f, glm::normalize(glm::vec3(1, 2, 3)));
  SceneElements elements(scene, pose(one, 0), 10, 1u << 20);
  EXPECT_TRUE(elements.fits(pose(one, 0)));
  EXPECT_TRUE(elements.fits(pose(turned * scaled(glm::vec3(1.2f)), 0.2f)));
  EXPECT_FALSE(elements.fits(pose(scaled(glm::vec3(1.3f)), 0)));
  EXPECT_FALSE(elements.fits(pose(scaled(glm::vec3(0)), 0)));
  EXPECT_FALSE(elements.fits(pose(one, 0.3f)));
  EXPECT_FALSE(elements.fits(pose(one, -0.3f)));
  const scene::Pose larger = pose(scaled(glm::vec3(1.2f)), 0.2f);
  elements.update(larger);
  EXPECT_TRUE(elements.fits(larger));
  EXPECT_FALSE(elements.fits(pose(scaled(glm::vec3(1.2f * 1.2f)), 0.2f))) << "compared with what was made";
}

/// A pose that was asked for and not taken leaves no trace.
TEST(SceneElementsTest, FollowThePoseOfTheirUpdate) {
  scene::Scene scene;
  scene::Primitive floor = test::floorPrimitive(1, test::addMaterial(scene));
  floor.morphTargets.push_back({floor.positions, {}, {}, {}});  // weight w: 1 + w times as wide
  const int mesh = test::addMesh(scene, floor);
  const auto pose = [&](float weight) {
    scene::Pose made;
    test::addInstance(scene, made, mesh);
    made.instances[0].deformed = 0;
    made.deformed = {{mesh, 0, {}, {weight}}};
    return made;
  };
  SceneElements elements(scene, pose(0), 10, 1u << 20);
  const auto widthAfter = [&](float asked, float taken) {
    EXPECT_TRUE(elements.fits(pose(asked)));
    elements.update(pose(taken));
    float most = 0;
    for (const Leaf& leaf : elements.leaves())
      if (leaf.used > 0) most = std::max(most, leaf.vertex.x);
    return most;
  };
  EXPECT_NEAR(widthAfter(0.1f, 0.2f), 1.2, 1e-6);
  EXPECT_NEAR(widthAfter(0.1f, 0.1f), 1.1, 1e-6);
  EXPECT_NEAR(widthAfter(0.1f, 0), 1, 1e-6);
}

/// Instances of a pose may stand for elements of their own.
TEST(SceneElementsTest, FitInstancesOfAPose) {
  const PosedSphere world;
  scene::Pose pose = world.pose(glm::mat4(1));
  test::addInstance(world.scene, pose, 0, scaled(glm::vec3(3)));
  const SceneElements elements = world.elements(glm::mat4(1));
  EXPECT_FALSE(elements.fits(pose));
  EXPECT_TRUE(elements.fits(pose, {&pose.instances[0], 1}));
  EXPECT_FALSE(elements.fits(pose, {&pose.instances[1], 1}));
}

/// Memory is taken for every slot, and small clusters do not fill their groups of four.
TEST(SceneElementsTest, CountTheSlotsOfSmallClusters) {
  scene::Scene scene;
  const int octahedron = test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene), 2));
  scene::Pose pose;
  for (int i = 0; i < 100; ++i)
    test::addInstance(scene, pose, octahedron, test::at(3 * static_cast<float>(i), 0, 0));
  const SceneElements all(scene, pose, 10, 1u << 20);
  ASSERT_EQ(all.surfels().size(), 600u);
  const uint32_t slots = all.forest().leafSlots();
  ASSERT_GT(slots, 700u);
  EXPECT_NO_THROW(SceneElements(scene, pose, 10, slots));
  for (const uint32_t most : {slots - 1, 600u})
    EXPECT_THROW(SceneElements(scene, pose, 10, most), UsageError);
}

/// The message does not know how many there would have been: no more were made than are allowed.
TEST(SceneElementsTest, AreRefusedBeforeTheyAreAllMade) {
  scene::Scene scene;
  const int floor = test::addMesh(scene, test::floorPrimitive(1, test::addMaterial(scene)));
  scene::Pose pose;
  test::addInstance(scene, pose, floor);
  try {
    const SceneElements elements(scene, pose, 0.01f, 100);
    FAIL() << elements.surfels().size();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "surface elements: the scene has more than the 100 that fit the memory allowed");
  }
}

/// Triangles that lie on each other share their elements, of which there may be few.
TEST(SceneElementsTest, AreRefusedWhereManyTrianglesLieOnEachOther) {
  const auto elementsOf = [](int layers) {
    scene::Scene scene;
    scene::Primitive floor = test::floorPrimitive(1, test::addMaterial(scene));
    const std::vector<uint32_t> layer = floor.indices;
    for (int i = 1; i < layers; ++i) floor.indices.insert(floor.indices.end(), layer.begin(), layer.end());
    const int mesh = test::addMesh(scene, floor);
    scene::Pose pose;
    test::addInstance(scene, pose, mesh);
    return SceneElements(scene, pose, 0.1f, 1000).triangles().size() / 3;
  };
  const size_t once = elementsOf(1);
  EXPECT_GT(once, 500u);
  EXPECT_EQ(elementsOf(2), 2 * once);
  EXPECT_THROW(elementsOf(20), UsageError);
}

/// What cuts the mask of a material with a model, a texture and colours of vertices, is no colour of it.
TEST(SceneElementsTest, ModelsHaveTheColourOfTheirOwn) {
  const auto albedo = [](bool model, bool coloured) {
    scene::Scene scene;
    scene::Material material;
    if (coloured) {
      scene.images.emplace_back().levels.push_back({1, 1, {32, 64, 128, 255}});
      material.alphaCutoff = 0.5f;
      material.baseColourTexture.image = 0;
    }
    if (model) scene::setModel(material, test::materialModels().front().model);
    scene::Primitive floor = test::floorPrimitive(1, test::addMaterial(scene, material));
    if (coloured) floor.colours.assign(4, glm::vec4(0.2f, 0.5f, 1, 1));
    const int mesh = test::addMesh(scene, floor);
    scene::Pose pose;
    test::addInstance(scene, pose, mesh);
    const SceneElements elements(scene, pose, 10, 1u << 20);
    return elements.leaves()[elements.forest().leafOf()[0]].albedo;
  };
  EXPECT_EQ(albedo(true, true), albedo(true, false));
  EXPECT_NE(albedo(false, true), albedo(false, false));
}

/// Sources fill again what nobody holds: the address would be the same.
TEST(SceneElementsTest, DoNotFitLaterGeometryOfASource) {
  const std::shared_ptr<scene::GeometrySource> source = scene::makeMetaballs({});
  scene::Scene scene;
  scene.dynamic.push_back({"balls", source, test::addMaterial(scene)});
  scene::Pose pose;
  pose.instances.emplace_back().mesh = 0;
  pose.bounds.add(glm::vec3(-1));
  pose.bounds.add(glm::vec3(1));
  pose.dynamic.push_back({source->at(0), pose.bounds});
  const SceneElements elements(scene, pose, 10, 1u << 20);
  EXPECT_TRUE(elements.fits(pose));
  for (const double time : {1., 2., 3.}) {
    pose.dynamic[0].primitive = source->at(time);
    EXPECT_FALSE(elements.fits(pose)) << time;
  }
}

}  // namespace
}  // namespace limn::radiosity
