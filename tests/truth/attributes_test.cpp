// Every vertex attribute on geometry that is rigid, skinned, morphed, both, instanced or made on the way: the
// picture's surfaces are the reference's.
#include <gtest/gtest.h>

#include "tests/gpu/comparability.h"
#include "tests/gpu/render_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

enum class Colours { none, everywhere, elsewhere };
enum class Maps { none, colour, colourAndNormals };

struct Case {
  Colours colours;
  Maps maps;
};

scene::TextureImage image(bool srgb, glm::u8vec3 a, glm::u8vec3 b) {
  scene::TextureImage image;
  image.srgb = srgb;
  scene::TextureImage::Level level{2, 1, {a.x, a.y, a.z, 255, b.x, b.y, b.z, 255}};
  image.levels.push_back(std::move(level));
  image.levels.push_back({1, 1, {a.x, a.y, a.z, 255}});
  return image;
}

scene::Primitive sphere(int material, const Case& with) {
  scene::Primitive p = test::spherePrimitive(0.8f, material, 16);
  for (const glm::vec3& n : p.normals) {
    if (with.maps == Maps::colourAndNormals) {
      const glm::vec3 along = glm::vec3(n.z, 0, -n.x) + glm::vec3(1e-4f, 0, 0);
      p.tangents.emplace_back(glm::normalize(along), 1.f);
    }
    if (with.colours == Colours::everywhere) p.colours.emplace_back(0.5f + 0.5f * n.x, 0.9f, 0.6f, 1.f);
  }
  if (with.maps == Maps::none) p.uvs.clear();
  return p;
}

void skin(scene::Primitive& p) {
  p.jointBounds = {{0, p.bounds}, {1, p.bounds}};
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const float upper = 0.5f + 0.5f * p.normals[i].y;
    p.joints.emplace_back(0, 1, 0, 0);
    p.weights.emplace_back(1 - upper, upper, 0, 0);
  }
}

void morph(scene::Primitive& p) {
  scene::MorphTarget& target = p.morphTargets.emplace_back();
  target.deltaBounds.add(glm::vec3(0));
  for (const glm::vec3& n : p.normals) {
    target.positions.push_back({0.3f * n.y, 0, 0});
    target.normals.push_back({0, -0.2f * n.x, 0});
    target.deltaBounds.add(target.positions.back());
  }
}

class Made : public scene::GeometrySource {
 public:
  explicit Made(scene::Primitive primitive)
      : primitive_(std::make_shared<const scene::Primitive>(std::move(primitive))) {}
  std::shared_ptr<const scene::Primitive> at(double) override { return primitive_; }

 private:
  std::shared_ptr<const scene::Primitive> primitive_;
};

int place(scene::Scene& scene, scene::Primitive primitive, const glm::vec3& at) {
  scene::Node node;
  node.mesh = test::addMesh(scene, std::move(primitive));
  if (!scene.meshes.back().primitives[0].morphTargets.empty()) {
    scene.meshes.back().morphWeights = {0};
    node.morphWeights = {0.8f};
  }
  node.transform.translation = at;
  scene.nodes.push_back(std::move(node));
  return static_cast<int>(scene.nodes.size()) - 1;
}

/// Two joints at `at`, of which the upper one is turned.
int addSkin(scene::Scene& scene, const glm::vec3& at) {
  scene::Skin skin;
  for (const float turn : {0.f, 0.6f}) {
    scene::Node joint;
    joint.transform = {at, glm::angleAxis(turn, glm::vec3(0, 0, 1)), glm::vec3(1)};
    skin.joints.push_back(static_cast<int>(scene.nodes.size()));
    skin.inverseBind.emplace_back(1);
    scene.nodes.push_back(joint);
  }
  scene.skins.push_back(skin);
  return static_cast<int>(scene.skins.size()) - 1;
}

scene::Scene spheres(const Case& with) {
  scene::Scene scene;
  scene.images = {image(true, {200, 90, 40}, {60, 160, 220}), image(false, {160, 128, 240}, {96, 140, 240})};
  scene::Material material;
  material.baseColour = {0.9f, 0.7f, 0.5f, 1};
  material.metallic = 0;
  if (with.maps != Maps::none) material.baseColourTexture.image = 0;
  if (with.maps == Maps::colourAndNormals) material.normalTexture.image = 1;
  const int paint = test::addMaterial(scene, material);
  place(scene, sphere(paint, with), {-2, 1, 0});

  scene::Primitive skinned = sphere(paint, with);
  skin(skinned);
  scene::Primitive both = skinned, morphed = sphere(paint, with);
  morph(morphed);
  morph(both);
  const int first = place(scene, std::move(skinned), {0, 0, 0}),
            last = place(scene, std::move(both), {0, 0, 0});
  scene.nodes[static_cast<size_t>(first)].skin = addSkin(scene, {0, 1, 0});
  scene.nodes[static_cast<size_t>(last)].skin = addSkin(scene, {2, 1, 0});
  place(scene, std::move(morphed), {-2, -1, 0});

  const int copies = place(scene, sphere(paint, with), {0, -1, 0});
  scene.nodes[static_cast<size_t>(copies)].instances = {
      {.translation = {-0.3f, 0, 0}, .scale = glm::vec3(0.5f)},
      {.translation = {0.5f, 0, 0}, .scale = glm::vec3(0.4f)}};
  scene::Primitive made = sphere(paint, with);
  for (glm::vec3& p : made.positions) p += glm::vec3(2, -1, 0);
  scene.dynamic.push_back({"made", std::make_shared<Made>(std::move(made)), paint});

  if (with.colours == Colours::elsewhere) {
    scene::Primitive other = test::floorPrimitive(4, paint);
    other.colours.assign(4, glm::vec4(0.2f, 0.8f, 0.4f, 1));
    place(scene, std::move(other), {0, -2.2f, 0});
  }
  return scene;
}

class AttributesTest : public RenderTest {};

TEST_F(AttributesTest, AreTheSameForBothOnEveryKindOfGeometry) {
  for (const Colours colours : {Colours::none, Colours::everywhere, Colours::elsewhere}) {
    for (const Maps maps : {Maps::none, Maps::colour, Maps::colourAndNormals}) {
      SCOPED_TRACE(testing::Message() << "colours " << int(colours) << ", maps " << int(maps));
      const scene::Scene scene = spheres({colours, maps});
      const test::Pair pair =
          test::renderBoth(device(), scene, scene::evaluate(scene, 0),
                           scene::lookAt({0, 0.3f, 7}, {0, 0, 0}, 0.7f), {128, 96}, Term::direct, 2);
      const test::Agreement found = test::agreement(pair.image, pair.reference);
      EXPECT_GT(found.covered, pair.image.pixelCount() / 5);
      EXPECT_LT(found.maskedShare, 0.01);
      EXPECT_LT(found.albedo, 1e-3);
      EXPECT_LT(found.normalMedian, 0.1);
      EXPECT_LT(found.normalTail, 3);
    }
  }
}

}  // namespace
}  // namespace limn
