#include "core/indirect/paraboloid_maps.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "core/base/error.h"
#include "core/indirect/point_maps.h"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

struct Drawn {
  std::vector<glsl::ShadowView> views;
  std::vector<float> depth = {};
  int size = 0;
  uint64_t triangles = 0;

  float stored(int map, int x, int y) const {
    return depth[static_cast<size_t>((map * size + y) * size + x)];
  }
  glm::vec2 place(int x, int y) const {
    return (glm::vec2(x, y) + 0.5f) / (0.5f * static_cast<float>(size)) - 1.f;
  }
  vec3 direction(int map, int x, int y) const {
    return glsl::shadow_world_offset(views[static_cast<size_t>(map)],
                                     glsl::paraboloid_direction(place(x, y)));
  }
};

class ParaboloidMapsTest : public GlTest {
 protected:
  using Views = std::vector<glsl::ShadowView>;

  /// What `add` declares for the maps of some views; with `move`, of the frame after it was called.
  template <class Add>
  Drawn make(const scene::Scene& scene, const scene::Pose& pose, const Views& views, const Add& add,
             const std::function<void(scene::GpuScene&)>& move = {}) {
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
    frame::ResourcePool pool(device());
    frame::FrameGraph graph;
    const gpu::Buffer buffer = gpu::Buffer::of<glsl::ShadowView>(device(), "views", views);
    const SceneHandles handles = gpuScene.import(graph);
    const indirect::ParaboloidMaps maps = add(graph, gpuScene, handles, graph.importBuffer("views", buffer));
    graph.output(maps.depth);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    if (move) {
      move(gpuScene);
      graph.execute();
    }
    Drawn out{.views = {views.begin() + maps.first, views.begin() + maps.first + maps.count},
              .size = maps.size};
    out.depth.resize(static_cast<size_t>(maps.count * maps.size * maps.size));
    graph.texture(maps.depth).read(0, GL_RED, GL_FLOAT, out.depth.data(), out.depth.size() * sizeof(float));
    for (const frame::PassReport& row : graph.explain()) out.triangles += row.triangles;
    gpuScene.forget();
    return out;
  }

  Drawn draw(const scene::Scene& scene, const scene::Pose& pose, const Views& views,
             const indirect::ParaboloidDesc& desc) {
    indirect::ParaboloidMapPass pass;
    return make(scene, pose, views,
                [&](frame::FrameGraph& graph, scene::GpuScene& gpuScene, const SceneHandles& handles,
                    frame::BufferHandle handle) { return pass.add(graph, gpuScene, handles, handle, desc); });
  }

  /// The same from points, of which each of the first `windows` maps has its own; at `later`, if there is
  /// one, which follows `pose`.
  Drawn splat(const scene::Scene& scene, const scene::Pose& pose, const Views& views,
              const indirect::PointMapDesc& desc, int windows = 1, const scene::Pose* later = nullptr) {
    indirect::PointMapPass pass(device(), scene, pose, desc.points, windows);
    const auto add = [&](frame::FrameGraph& graph, scene::GpuScene&, const SceneHandles& handles,
                         frame::BufferHandle handle) {
      pass.place(graph, handles, "indirect");
      return pass.add(graph, device(), handle, desc);
    };
    if (later == nullptr) return make(scene, pose, views, add);
    return make(scene, pose, views, add, [&](scene::GpuScene& gpuScene) {
      gpuScene.update(*later, scene::frameBounds(later->bounds), {64, 64}, 1);
      pass.update(*later);
    });
  }
};

/// A box of twelve large triangles, seen from inside.
scene::Primitive boxPrimitive(vec3 half, int material) {
  scene::Primitive p;
  for (int i = 0; i < 8; ++i)
    p.positions.push_back(half * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  p.normals.assign(8, {0, 1, 0});
  p.tangents.assign(8, {1, 0, 0, 1});
  p.uvs.assign(8, {0, 0});
  p.indices = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
               2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  p.material = material;
  return finish(p);
}

/// Where a ray from inside the box leaves it.
float leaves(vec3 from, vec3 along, vec3 half) {
  float t = 1e30f;
  for (int i = 0; i < 3; ++i)
    if (along[i] != 0) t = std::min(t, ((along[i] > 0 ? half[i] : -half[i]) - from[i]) / along[i]);
  return t;
}

/// Twelve triangles as large as the room: exact for every texel, without cracks, at every scale.
TEST_F(ParaboloidMapsTest, ARoomOfLargeTrianglesIsExactFromEveryView) {
  for (const float scale : {1.f, 1e-4f, 1e4f}) {
    const vec3 half = scale * vec3(2, 1.5f, 1);
    scene::Scene scene;
    addMesh(scene, boxPrimitive(half, addMaterial(scene)));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    const float far = 10 * scale;
    std::vector<glsl::ShadowView> views;
    const vec3 origins[] = {{0, 0, 0}, {1.9f, -1.4f, 0.9f}, {-1.2f, -1.499f, 0.3f}, {0.4f, 1.2f, -0.99f}};
    const vec3 axes[] = {{0, 1, 0}, {-1, 0.2f, -0.4f}, {0, 1, 0}, {0.3f, 0.1f, 1}};
    for (uint32_t i = 0; i < 4; ++i)
      views.push_back(
          glsl::paraboloid_view(scale * origins[i], glm::normalize(axes[i]), 1e-4f * scale, far, i, 96));
    const Drawn drawn = draw(scene, pose, views, {.count = 4, .size = 96});
    EXPECT_EQ(drawn.triangles, 48u);
    for (int map = 0; map < 4; ++map)
      for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
          const glm::vec2 p = drawn.place(x, y);
          const glsl::ShadowView& view = drawn.views[static_cast<size_t>(map)];
          const float expected =
              glm::dot(p, p) > 1
                  ? 1
                  : glsl::shadow_normalise(view, leaves(view.origin, drawn.direction(map, x, y), half));
          ASSERT_NEAR(drawn.stored(map, x, y), expected, 2e-5f)
              << "map " << map << " texel " << x << "," << y;
        }
  }
}

/// What points show of a room is the room, as their discs lie in its walls; where none lies, nothing is.
/// Holes are closed as far as the levels reach, in maps of more than one tile, too.
TEST_F(ParaboloidMapsTest, PointsShowTheRoomBetweenHolesThatFillingCloses) {
  const vec3 half(2, 1.5f, 1);
  scene::Scene scene;
  addMesh(scene, boxPrimitive(half, addMaterial(scene)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  const glsl::ShadowView view = glsl::paraboloid_view({0.3f, -1.2f, 0.1f}, {0, 1, 0}, 1e-4f, 10, 0, 96);
  struct Shares {
    double holes = 0, wrong = 0;  ///< of the texels within the disc
  };
  const auto sharesOf = [&](const Drawn& drawn, int map) {
    Shares found;
    int texels = 0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x) {
        if (glm::length(drawn.place(x, y)) > 0.95f) continue;
        ++texels;
        const float stored = drawn.stored(map, x, y);
        const float expected =
            glsl::shadow_normalise(view, leaves(view.origin, drawn.direction(map, x, y), half));
        if (stored == 1)
          ++found.holes;
        else if (std::abs(stored - expected) > 1e-3f)
          ++found.wrong;
      }
    return Shares{found.holes / texels, found.wrong / texels};
  };
  const std::vector<glsl::ShadowView> views(2, view);
  const indirect::PointMapDesc desc{.count = 2, .size = 96, .points = 8192, .splat = 16, .fillDepth = 0.02f};
  const Drawn open = splat(scene, pose, views, desc, 2);
  EXPECT_EQ(open.triangles, 0u);
  const Shares ofOpen = sharesOf(open, 0);
  EXPECT_GT(ofOpen.holes, 0.02);
  EXPECT_LT(ofOpen.holes, 0.4);
  EXPECT_LT(ofOpen.wrong, 0.08) << "discs that reach over the edges of walls are seen in holes";
  EXPECT_FALSE(std::ranges::equal(std::span(open.depth).first(96 * 96), std::span(open.depth).last(96 * 96)))
      << "each map has points of its own";
  indirect::PointMapDesc filling = desc;
  filling.fillLevels = 3;
  const Drawn filled = splat(scene, pose, views, filling, 2);
  EXPECT_LT(sharesOf(filled, 1).holes, 1e-3);
  for (size_t i = 0; i < open.depth.size(); ++i)
    if (open.depth[i] < 1) {
      ASSERT_EQ(filled.depth[i], open.depth[i]) << "what is known stays";
    }
}

/// Points lie as densely on what its node stretches, or makes flat, as on the same triangles in the world.
TEST_F(ParaboloidMapsTest, PointsAreSpreadByAreasInTheWorld) {
  const auto depths = [&](const vec3& room, float plate, bool stretched) {
    scene::Scene scene;
    const int material = addMaterial(scene);
    addMesh(scene, boxPrimitive(room, material));
    addMesh(scene, floorPrimitive(plate, material));
    const glm::mat4 one(1), raised = glm::translate(one, {0, 0.5f, 0});
    scene::Pose pose;
    addInstance(scene, pose, 0, stretched ? glm::scale(one, vec3(2, 1.5f, 1)) : one);
    addInstance(scene, pose, 1, stretched ? glm::scale(raised, vec3(4, 0, 4)) : raised);
    const Views views = {glsl::paraboloid_view({0.3f, -1.2f, 0.1f}, {0, 1, 0}, 1e-4f, 10, 0, 96)};
    return splat(scene, pose, views, {.count = 1, .size = 96, .points = 8192, .splat = 16}).depth;
  };
  const std::vector<float> expected = depths({2, 1.5f, 1}, 0.5f, false),
                           found = depths(vec3(1), 0.125f, true);
  int other = 0;
  for (size_t i = 0; i < expected.size(); ++i) other += std::abs(found[i] - expected[i]) > 1e-5f ? 1 : 0;
  EXPECT_LT(other, 10) << "texels, at the rims of splats";
}

/// A body that grows from nothing gets the points of its area; those of one that barely grows stay.
TEST_F(ParaboloidMapsTest, PointsAreChosenAgainWhereABodyChangesItsSize) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(1, addMaterial(scene), 24));
  const auto posed = [&](float size) {
    scene::Pose pose;
    addInstance(scene, pose, 0, at(-2, 0, 0));
    addInstance(scene, pose, 0, at(2, 0, 0, size));
    return pose;
  };
  const Views views = {glsl::paraboloid_view({0, -4, 0}, {0, 1, 0}, 1e-4f, 12, 0, 96)};
  const indirect::PointMapDesc desc{.count = 1, .size = 96, .points = 2048, .splat = 16};
  const scene::Pose now = posed(1);
  const std::vector<float> expected = splat(scene, now, views, desc).depth;
  for (const float before : {0.f, 0.5f, 3.f})
    EXPECT_EQ(splat(scene, posed(before), views, desc, 1, &now).depth, expected) << before;
  EXPECT_NE(splat(scene, posed(1.2f), views, desc, 1, &now).depth, expected);
}

/// Points lie in the triangles that a source has now, though they were chosen in those of another topology.
TEST_F(ParaboloidMapsTest, PointsAreChosenAgainWhereTrianglesChange) {
  scene::Scene scene;
  const int plate = addMesh(scene, floorPrimitive(1, addMaterial(scene)));
  scene.dynamic.push_back({"source", std::make_shared<StillSource>(spherePrimitive(1, 0, 4)), 0});
  const auto posed = [&](const scene::Primitive& primitive) {
    scene::Pose pose;
    addInstance(scene, pose, plate, at(0, 2, 0));
    pose.dynamic.push_back({std::make_shared<const scene::Primitive>(primitive), primitive.bounds});
    pose.bounds.add(primitive.bounds);
    scene::DrawInstance drawn;
    drawn.mesh = 0;
    pose.instances.push_back(drawn);
    return pose;
  };
  const Views views = {glsl::paraboloid_view({0.2f, -4, 0.1f}, {0, 1, 0}, 1e-4f, 12, 0, 96)};
  const indirect::PointMapDesc desc{.count = 1, .size = 96, .points = 2048, .splat = 16};
  const scene::Pose before = posed(spherePrimitive(1, 0, 24));
  for (const scene::Primitive& primitive : {spherePrimitive(0.7f, 0, 5), boxPrimitive({1, 0.5f, 1}, 0)}) {
    const scene::Pose later = posed(primitive);
    const std::vector<float> expected = splat(scene, later, views, desc).depth;
    EXPECT_EQ(splat(scene, before, views, desc, 1, &later).depth, expected);
    EXPECT_NE(splat(scene, before, views, desc).depth, expected);
  }
}

TEST_F(ParaboloidMapsTest, ASphereOfSmallTriangles) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(1, addMaterial(scene), 96));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  const std::vector<glsl::ShadowView> views = {
      glsl::paraboloid_view({0.5f, 0, 3}, {0, 0, -1}, 0.01f, 8, 0, 128),
      glsl::paraboloid_view({0, 0, -3}, {0, 0, -1}, 0.01f, 8, 1, 128)};
  const Drawn drawn = draw(scene, pose, views, {.count = 2, .size = 128});
  int covered = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      EXPECT_EQ(drawn.stored(1, x, y), 1) << "behind the hemisphere";
      if (drawn.stored(0, x, y) >= 1) continue;
      ++covered;
      const vec3 p =
          views[0].origin + glsl::shadow_metres(views[0], drawn.stored(0, x, y)) * drawn.direction(0, x, y);
      EXPECT_NEAR(glm::length(p), 1, 1e-3f);
    }
  // The sphere is a circle of half angle asin(1 / |origin|), which covers the share sin^2 / (cos theta + cos
  // a)^2.
  const vec3 towards = glm::normalize(vec3(-0.5f, 0, -3));
  const float a = std::asin(1 / std::sqrt(9.25f));
  const float width = glsl::paraboloid_kernel(glsl::shadow_view_axes(views[0], towards), 2 * a).width;
  EXPECT_NEAR(covered, 0.25f * glsl::pi * width * width * 128 * 128, 12);
}

TEST_F(ParaboloidMapsTest, WhatIsNearerThanNearIsNotSeen) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(1, addMaterial(scene), 24));
  addMesh(scene, spherePrimitive(3, addMaterial(scene), 24));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, 1);
  const vec3 origin(0.2f, 0.1f, 0), axis(0, 0, 1);
  const std::vector<glsl::ShadowView> views = {glsl::paraboloid_view(origin, axis, 0.1f, 8, 0, 64),
                                               glsl::paraboloid_view(origin, axis, 1.5f, 8, 1, 64)};
  const Drawn drawn = draw(scene, pose, views, {.count = 2, .size = 64});
  EXPECT_LT(glsl::shadow_metres(views[0], drawn.stored(0, 32, 32)), 1.1f);
  EXPECT_GT(glsl::shadow_metres(views[1], drawn.stored(1, 32, 32)), 2.7f);
}

/// Batches: part of the views to an array of their own.
TEST_F(ParaboloidMapsTest, ABatchIsOfItsOwnViews) {
  scene::Scene scene;
  addMesh(scene, spherePrimitive(3, addMaterial(scene), 12));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  std::vector<glsl::ShadowView> views;
  constexpr uint32_t batch = 50;
  for (uint32_t i = 0; i < 2 * batch; ++i) {
    const vec3 origin(0.01f * static_cast<float>(i), 0, 0.1f);
    views.push_back(glsl::paraboloid_view(origin, {0, 0, 1}, 0.1f, 10, i % batch, 16));
  }
  const Drawn first = draw(scene, pose, views, {.count = batch, .size = 16});
  const Drawn second = draw(scene, pose, views, {.count = batch, .first = batch, .size = 16});
  EXPECT_NE(second.depth, first.depth);
  const Views own(views.begin() + batch, views.end());
  EXPECT_EQ(second.depth, draw(scene, pose, own, {.count = batch, .size = 16}).depth);
}

TEST_F(ParaboloidMapsTest, BatchesFitTheDevice) {
  EXPECT_GE(indirect::paraboloidBatch(device(), 128), 1024);
  EXPECT_GE(indirect::paraboloidBatch(device(), 256), 1024);
  EXPECT_LE(indirect::paraboloidBatch(device(), 16), device().limits().maxArrayLayers);
  scene::Scene scene;
  addMesh(scene, spherePrimitive(3, addMaterial(scene), 4));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  const std::vector<glsl::ShadowView> views(4);
  EXPECT_THROW(draw(scene, pose, views, {.count = 0, .size = 16}), UsageError);
  EXPECT_THROW(draw(scene, pose, views, {.count = 1 << 20, .size = 256}), UsageError);
  EXPECT_THROW(splat(scene, pose, views, {.count = 0, .size = 16}), UsageError);
  EXPECT_THROW(splat(scene, pose, views, {.count = 1 << 20, .size = 256}), UsageError);
}

}  // namespace
}  // namespace limn
