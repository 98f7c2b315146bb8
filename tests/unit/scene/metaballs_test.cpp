// Surfaces around moving balls: closed, where the field says, made again for every time.
#include "core/scene/metaballs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "tests/support/gltf_builder.h"
#include "tests/support/png.h"
#include "tests/support/scene_files.h"

namespace limn::scene {
namespace {

using namespace limn::test;
using testing::HasSubstr;

/// Edges that do not belong to exactly two triangles, in opposite directions.
std::size_t openEdges(const Primitive& p) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (std::size_t i = 0; i < p.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{p.indices[i + k], p.indices[i + (k + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) open += count != 1 || !edges.count({edge.second, edge.first});
  return open;
}

/// Vertices - edges + faces of a closed surface: 2 for each body, less 2 for each hole through one.
long euler(const Primitive& p) {
  const auto faces = static_cast<long>(p.indices.size() / 3);
  return static_cast<long>(p.positions.size()) - 3 * faces / 2 + faces;
}

/// Volume inside a closed surface.
double volume(const Primitive& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.indices.size(); i += 3)
    sum += glm::dot(glm::dvec3(p.positions[p.indices[i]]),
                    glm::cross(glm::dvec3(p.positions[p.indices[i + 1]]),
                               glm::dvec3(p.positions[p.indices[i + 2]]))) /
           6;
  return sum;
}

TEST(Metaballs, AreClosedSurfacesOfChangingTopology) {
  const auto source = makeMetaballs({.count = 9, .resolution = 24, .radius = 0.2f, .seed = 5});
  std::set<long> topologies;
  std::set<std::size_t> counts;
  for (int frame = 0; frame < 60; ++frame) {
    const auto p = source->at(frame / 6.0);
    ASSERT_EQ(p->positions.size(), p->normals.size());
    EXPECT_EQ(openEdges(*p), 0u) << frame;
    for (std::size_t v = 0; v < p->positions.size(); ++v) {
      EXPECT_LT(glm::length(glm::max(glm::abs(p->positions[v]) - 1.f, glm::vec3(0))), 1e-6f);
      EXPECT_NEAR(glm::length(p->normals[v]), 1, 1e-4);
    }
    topologies.insert(euler(*p));
    counts.insert(p->indices.size());
  }
  EXPECT_GE(topologies.size(), 4u);
  EXPECT_GE(counts.size(), 50u);
}

TEST(Metaballs, ALoneBallIsASphereOfItsRadius) {
  const auto p = makeMetaballs({.count = 1, .resolution = 96, .radius = 0.3f, .seed = 2})->at(1);
  EXPECT_NEAR(volume(*p) / (4 * M_PI / 3 * 0.027), 1, 5e-3);
  EXPECT_EQ(euler(*p), 2);
  Bounds bounds;
  for (const auto& x : p->positions) bounds.add(x);
  for (std::size_t v = 0; v < p->positions.size(); ++v) {
    const glm::vec3 offset = p->positions[v] - bounds.centre();
    EXPECT_NEAR(glm::length(offset), 0.3, 0.005);
    EXPECT_GT(glm::dot(glm::normalize(offset), p->normals[v]), 0.99f);
  }
}

TEST(Metaballs, StandWhereTheirNodeSays) {
  Metaballs settings{.count = 4, .resolution = 16};
  const auto plain = makeMetaballs(settings)->at(3);
  settings.toWorld = glm::mat4(-2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1);  // mirrored
  const auto moved = makeMetaballs(settings)->at(3);
  ASSERT_EQ(plain->positions.size(), moved->positions.size());
  for (std::size_t v = 0; v < plain->positions.size(); ++v)
    EXPECT_LT(
        glm::distance(moved->positions[v], glm::vec3(settings.toWorld * glm::vec4(plain->positions[v], 1))),
        1e-5f);
  EXPECT_EQ(openEdges(*moved), 0u);
  EXPECT_GT(volume(*plain), 0);
  EXPECT_GT(volume(*moved), 0) << "front faces outside, mirrored or not";
}

TEST(Metaballs, TheSameTimeGivesTheSameTrianglesAndWhatIsHeldStays) {
  const Metaballs settings{.count = 6, .resolution = 16, .seed = 9};
  const auto source = makeMetaballs(settings);
  const auto first = source->at(1);
  EXPECT_EQ(source->at(1), first) << "nothing changed";
  const std::vector<glm::vec3> kept = first->positions;
  for (const double time : {2.0, 3.0, 4.0, 5.0}) EXPECT_NE(source->at(time), first);
  EXPECT_EQ(first->positions, kept);
  EXPECT_EQ(makeMetaballs(settings)->at(1)->positions, kept);
  EXPECT_EQ(source->at(1 + 12)->positions, kept) << "the paths close";
  EXPECT_NE(makeMetaballs({.count = 6, .resolution = 16, .seed = 10})->at(1)->positions, kept);
}

GltfBuilder withMetaballs(nlohmann::json extras) {
  GltfBuilder b;
  b.triangle();
  b.append("materials", {{"name", "wax"}});
  b.node(
      {{"name", "balls"}, {"translation", {1, 2, 3}}, {"extras", {{"limn_metaballs", std::move(extras)}}}});
  return b;
}

TEST(Metaballs, ComeFromTheExtrasOfANode) {
  const Scene scene = loadBuilt(
      withMetaballs({{"count", 1}, {"resolution", 16}, {"radius", 0.45}, {"seed", 3}, {"material", 0}}));
  ASSERT_EQ(scene.dynamic.size(), 1u);
  EXPECT_EQ(scene.dynamic[0].name, "balls");
  EXPECT_EQ(scene.dynamic[0].material, 0);
  const Pose pose = evaluate(scene, 2);
  ASSERT_EQ(pose.dynamic.size(), 1u);
  const glm::vec3 offset = pose.dynamic[0].bounds.centre() - glm::vec3(1, 2, 3);
  EXPECT_LT(glm::length(offset), 0.2f);
  EXPECT_NEAR(pose.dynamic[0].bounds.radius(), 0.45 * std::sqrt(3), 0.05);
  EXPECT_EQ(loadBuilt(withMetaballs({{"count", 2}})).dynamic.size(), 1u) << "the others by default";
  EXPECT_EQ(loadError(withMetaballs({{"count", 2}, {"seed", UINT32_MAX}}).glb()), "") << "the largest";
}

/// Without coordinates a texture is white in the reference, and what it is at (0, 0) where it is rasterised.
TEST(Metaballs, HaveNoTexturesForLackOfCoordinates) {
  GltfBuilder b = withMetaballs({{"count", 1}, {"resolution", 8}, {"material", 1}});
  ASSERT_EQ(b.texturedMaterial(png(1, 1, {1, 2, 3, 4})), 1);
  b.root["materials"][1]["pbrMetallicRoughness"]["roughnessFactor"] = 0.25;
  b.node({{"extras", {{"limn_metaballs", {{"count", 1}, {"resolution", 8}, {"material", 1}}}}}});
  const Scene scene = loadBuilt(b);
  ASSERT_EQ(scene.dynamic.size(), 2u);
  EXPECT_EQ(scene.dynamic[0].material, scene.dynamic[1].material) << "one for all";
  EXPECT_TRUE(scene.materials.at(1).textured());
  const Material& plain = scene.materials.at(static_cast<std::size_t>(scene.dynamic[0].material));
  EXPECT_FALSE(plain.textured());
  EXPECT_EQ(plain.roughness, 0.25f);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("balls have no texture coordinates")));
}

/// Without tangents the grain would be one way in the reference and another way where it is rasterised.
TEST(Metaballs, HaveTangentsWhereTheirMaterialHasAGrain) {
  GltfBuilder b = withMetaballs({{"count", 3}, {"resolution", 16}, {"material", 1}});
  b.append("materials", {{"extras", {{"limn_material", {{"model", "ward"}, {"roughness", {0.1, 0.4}}}}}}});
  b.node({{"extras", {{"limn_metaballs", {{"count", 1}, {"resolution", 8}}}}}});
  const Pose pose = evaluate(loadBuilt(b), 1);
  ASSERT_EQ(pose.dynamic.size(), 2u);
  const Primitive& grained = *pose.dynamic[0].primitive;
  ASSERT_FALSE(grained.positions.empty());
  ASSERT_EQ(grained.tangents.size(), grained.positions.size());
  for (std::size_t v = 0; v < grained.tangents.size(); ++v) {
    const glm::vec3 tangent(grained.tangents[v]), normal = grained.normals[v];
    EXPECT_NEAR(glm::length(tangent), 1, 1e-5);
    EXPECT_NEAR(glm::dot(tangent, normal), 0, 1e-5);
    if (std::abs(normal.y) < 0.99f) {
      EXPECT_NEAR(tangent.y, 0, 1e-5) << "circles about the vertical axis";
    }
  }
  EXPECT_TRUE(pose.dynamic[1].primitive->tangents.empty()) << "no grain";
}

TEST(Metaballs, SayThatTheyLightNothing) {
  GltfBuilder b = withMetaballs({{"count", 1}, {"resolution", 8}, {"material", 1}});
  b.append("materials", {{"emissiveFactor", {1, 0.5, 0}}});
  EXPECT_THAT(loadBuilt(b).warnings, testing::ElementsAre(HasSubstr("is displayed but lights nothing")));
  b.root["materials"][1]["extensions"]["KHR_materials_unlit"] = nlohmann::json::object();
  EXPECT_THAT(loadBuilt(b).warnings, testing::IsEmpty()) << "it shows its base colour";
}

TEST(Metaballs, NonsenseIsRefusedByName) {
  const auto error = [](nlohmann::json extras) { return loadError(withMetaballs(std::move(extras)).glb()); };
  EXPECT_THAT(error(7), HasSubstr("limn_metaballs: an object {count, resolution, radius, seed, material}"));
  EXPECT_THAT(error({{"count", 0}}), HasSubstr("count: a whole number in 1 .. 64"));
  EXPECT_THAT(error({{"count", 1e9}}), HasSubstr("count: a whole number"));
  EXPECT_THAT(error({{"count", 2}, {"resolution", 4096}}),
              HasSubstr("resolution: a whole number in 8 .. 128"));
  EXPECT_THAT(error({{"count", 2}, {"resolution", 16.5}}), HasSubstr("resolution: a whole number"));
  EXPECT_THAT(error({{"count", 2}, {"radius", 0.6}}), HasSubstr("radius: a number in 0.02 .. 0.45"));
  EXPECT_THAT(error({{"count", 2}, {"radius", "big"}}), HasSubstr("radius: a number"));
  EXPECT_THAT(error({{"count", 2}, {"seed", -1}}), HasSubstr("seed: a whole number"));
  EXPECT_THAT(error({{"count", 2}, {"material", 1}}),
              HasSubstr("material: an index of the file's 1 materials"));
  EXPECT_THAT(error({{"count", 2}, {"colour", 1}}), HasSubstr("unknown key 'colour'"));
  EXPECT_THAT(error({{"seed", 1}}), HasSubstr("'count', is missing"));
  GltfBuilder flat = withMetaballs({{"count", 2}});
  flat.root["nodes"].back()["scale"] = {1, 0, 1};
  EXPECT_THAT(loadError(flat.glb()), HasSubstr("cannot be inverted"));
  GltfBuilder many = withMetaballs({{"count", 1}, {"resolution", 8}});
  for (int i = 0; i < 20; ++i)
    many.node({{"extras", {{"limn_metaballs", {{"count", 1}, {"resolution", 8}}}}}});
  EXPECT_THAT(loadError(many.glb()), HasSubstr("more than 16 such nodes"));
}

}  // namespace
}  // namespace limn::scene
