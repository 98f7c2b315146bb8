// Laws of maps fitted to what the camera sees (core/shadow/private/window_fit.h, visible_scene.h, convex.h).
#include "core/shadow/private/window_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <random>

#include "core/scene/camera.h"
#include "core/shadow/light_fit.h"
#include "glsl/light/light_view.glsl"
#include "tests/support/test_scenes.h"

namespace limn::shadow {
namespace {

using namespace limn::test;
using glm::vec2;
using glm::vec3;
using glm::vec4;

TEST(Convex, CutsKeepWhatLiesInsideAndNothingElse) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const scene::Bounds box{vec3(-1), vec3(1, 1, i % 3 == 0 ? -1 : 1)};  // some flat
    std::array<vec4, 3> planes;
    for (vec4& p : planes)
      p = vec4(glm::normalize(vec3(normal(random), normal(random), normal(random))), uniform(random));
    Convex solid;
    solid.setBox(boxCorners(box));
    for (const vec4& p : planes) solid.clip(p);
    for (const vec3& p : solid.corners()) {
      for (const vec4& plane : planes) EXPECT_GE(glm::dot(vec3(plane), p) + plane.w, -1e-5f);
      EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.00001f);
    }
    // What lies inside is nowhere farther along any direction than some corner.
    const vec3 direction(normal(random), normal(random), normal(random));
    float farthest = -1e9f;
    for (const vec3& p : solid.corners()) farthest = std::max(farthest, glm::dot(direction, p));
    for (int k = 0; k < 200; ++k) {
      const vec3 p = glm::clamp(vec3(uniform(random), uniform(random), uniform(random)), box.low, box.high);
      bool inside = true;
      for (const vec4& plane : planes) inside = inside && glm::dot(vec3(plane), p) + plane.w > 0;
      if (inside) {
        EXPECT_LE(glm::dot(direction, p), farthest + 1e-4f);
      }
    }
  }
}

/// A floor and a cloud of triangles over it, some of them near the light.
struct Cloud {
  scene::Scene scene;
  scene::Pose pose;
  std::vector<scene::Bounds> boxes;
  std::vector<std::array<vec3, 3>> triangles;

  explicit Cloud(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    addMesh(scene, floorPrimitive(6, addMaterial(scene)));
    scene::Primitive soup;
    for (uint32_t i = 0; i < 240; ++i) {
      const vec3 at(4 * uniform(random), 1.6f + 1.5f * uniform(random), 4 * uniform(random));
      for (uint32_t k = 0; k < 3; ++k) {
        soup.positions.push_back(at + 0.15f * vec3(uniform(random), uniform(random), uniform(random)));
        soup.indices.push_back(3 * i + k);
      }
    }
    soup.normals.assign(soup.positions.size(), {0, 1, 0});
    addMesh(scene, finish(soup));
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 1;
    addInstance(scene, pose, 0);
    addInstance(scene, pose, 1, glm::rotate(glm::mat4(1), 0.3f, {0, 1, 0}));
    for (const scene::DrawInstance& drawn : pose.instances) {
      scene::Bounds box;
      const scene::Primitive& p = scene.meshes[static_cast<size_t>(drawn.mesh)].primitives[0];
      for (size_t i = 0; i < p.indices.size(); i += 3) {
        std::array<vec3, 3> triangle;
        for (size_t k = 0; k < 3; ++k) {
          triangle[k] = vec3(drawn.objectToWorld * vec4(p.positions[p.indices[i + k]], 1));
          box.add(triangle[k]);
        }
        triangles.push_back(triangle);
      }
      boxes.push_back(box);
    }
  }
};

/// Where the segment from a to b meets a triangle.
std::optional<vec3> hit(const std::array<vec3, 3>& t, const vec3& a, const vec3& b) {
  const vec3 u = t[1] - t[0], v = t[2] - t[0], d = b - a, p = glm::cross(d, v);
  const float determinant = glm::dot(u, p);
  if (std::abs(determinant) < 1e-12f) return {};
  const vec3 s = a - t[0], q = glm::cross(s, u);
  const float x = glm::dot(s, p) / determinant, y = glm::dot(d, q) / determinant,
              at = glm::dot(v, q) / determinant;
  if (x < 0 || y < 0 || x + y > 1 || at < 0 || at > 1) return {};
  return a + at * d;
}

bool seenBy(const scene::CameraPose& camera, float aspect, const vec3& p) {
  const vec3 v(camera.worldToView * vec4(p, 1));
  const float up = std::tan(0.5f * camera.yfov);
  return v.z < 0 && std::abs(v.y) < -up * v.z && std::abs(v.x) < -up * aspect * v.z;
}

struct Fitted {
  std::vector<glsl::ShadowView> views;
  std::vector<glsl::ShadowLight> lights;
};

Fitted fit(const Cloud& cloud, const glsl::Light& light, const ShadowMapDesc& desc,
           const VisibleScene* visible) {
  Fitted f;
  appendViews(light, 0, fitLayout(light, cloud.boxes, desc), cloud.boxes, desc, visible, f.views, f.lights);
  return f;
}

float sideOf(const glsl::ShadowView& view) {
  return 1 / view.scale;
}

class WindowFit : public ::testing::TestWithParam<int> {
 protected:
  glsl::Light light() const {
    switch (GetParam()) {
      case 0:
        return rectangleLight({-2.5f, 6.5f, 1}, {0.3f, -1, -0.1f}, 0.8f, 0.6f);
      case 1:
        return spotLight({-2.5f, 3.8f, 1}, {0.6f, -1, -0.2f}, 0.9f);
      case 2:
        return directionalLight({0.3f, -1, 0.2f}, 0.2f);
      default:
        return rectangleLight({0.5f, 5, 0}, {0, -1, 0}, 2.5f, 2.5f);
    }
  }
};

TEST_P(WindowFit, HoldsEveryReceiverAndWhatBlocksIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  const glsl::Light l = light();
  int receivers = 0, blockers = 0, smaller = 0;
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const Cloud cloud(seed);
    VisibleScene visible(cloud.scene);
    const scene::CameraPose camera = scene::lookAt({3 * uniform(random) - 1.5f, 0.6f + uniform(random), 3.5f},
                                                   {uniform(random), 0.2f, 0}, 0.5f);
    visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
    const Fitted whole = fit(cloud, l, {.size = 256}, &visible);
    const Fitted cut = fit(cloud, l, {.size = 256, .fit = MapFit::view}, &visible);
    std::vector<vec2> points;
    for (int i = 0; i < 8; ++i) points.emplace_back(uniform(random), uniform(random));
    const Fitted many = fit(cloud, l, {.size = 256, .samples = points, .fit = MapFit::view}, &visible);
    ASSERT_EQ(whole.views.size(), 1u);
    ASSERT_EQ(cut.views.size(), 1u);
    EXPECT_LE(sideOf(cut.views[0]), sideOf(whole.views[0]) * 1.0001f);
    if (sideOf(cut.views[0]) < 0.9f * sideOf(whole.views[0])) ++smaller;
    for (int i = 0; i < 4000; ++i) {
      const auto& t = cloud.triangles[i % 8 == 0 ? static_cast<size_t>(i / 8) % 2
                                                 : static_cast<size_t>(i) % cloud.triangles.size()];
      const float a = std::sqrt(uniform(random)), b = uniform(random);
      const vec3 p = t[0] + a * (1 - b) * (t[1] - t[0]) + a * b * (t[2] - t[0]);
      if (!seenBy(camera, 1.3f, p)) continue;
      if (!glsl::shadow_inside(glsl::shadow_project(whole.views[0], p))) continue;
      ++receivers;
      EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(cut.views[0], p)));
      for (const glsl::ShadowView& view : many.views)
        EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(view, p)));
      const glsl::LightView seen = glsl::light_view(l, p, {0, 1, 0}, -1);
      if (seen.masked) continue;
      const vec3 slope = glsl::light_view_point(seen, {uniform(random), uniform(random)});
      const vec3 end = p + slope * (seen.cone ? 20.f : seen.depth);
      for (const auto& blocker : cloud.triangles) {
        const std::optional<vec3> at = hit(blocker, p + 1e-3f * (end - p), end);
        if (!at || !glsl::shadow_inside(glsl::shadow_project(whole.views[0], *at))) continue;
        ++blockers;
        const glsl::ShadowPoint q = glsl::shadow_project(cut.views[0], *at);
        EXPECT_TRUE(glsl::shadow_inside(q)) << q.uv.x << " " << q.uv.y;
        EXPECT_GE(q.depth, cut.views[0].near);
      }
    }
  }
  EXPECT_GT(receivers, 500);
  EXPECT_GT(blockers, GetParam() == 1 ? 5 : 20);
  EXPECT_GE(smaller, 3);
}

TEST_P(WindowFit, StaysWhatItIsWhileTheCameraMovesLittle) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  std::optional<Fitted> before;
  int changes = 0;
  for (int i = 0; i < 50; ++i) {
    const float x = 0.001f * static_cast<float>(i);
    visible.update(cloud.pose, cloud.boxes, scene::lookAt({x, 1.2f, 3.5f}, {x, 0.2f, 0}, 0.5f), 1.3f);
    const Fitted now = fit(cloud, light(), {.size = 256, .fit = MapFit::view}, &visible);
    if (before && std::memcmp(&now.views[0], &before->views[0], sizeof(glsl::ShadowView)) != 0) ++changes;
    before = now;
  }
  EXPECT_LE(changes, 6);
}

Cloud scaledBy(const Cloud& cloud, float scale) {
  Cloud scaled = cloud;
  for (scene::DrawInstance& drawn : scaled.pose.instances)
    drawn.objectToWorld = glm::scale(glm::mat4(1), vec3(scale)) * drawn.objectToWorld;
  for (scene::Bounds& box : scaled.boxes) box = {scale * box.low, scale * box.high};
  return scaled;
}

TEST_P(WindowFit, ScalesWithTheScene) {
  const Cloud cloud(1);
  const scene::CameraPose camera = scene::lookAt({0, 1.2f, 3.5f}, {0, 0.2f, 0}, 0.5f);
  VisibleScene visible(cloud.scene);
  visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
  const glsl::ShadowView one = fit(cloud, light(), {.size = 256, .fit = MapFit::view}, &visible).views[0];
  for (const float scale : {1e-3f, 1e3f}) {
    const Cloud scaled = scaledBy(cloud, scale);
    visible.update(scaled.pose, scaled.boxes,
                   scene::lookAt(scale * vec3(0, 1.2f, 3.5f), scale * vec3(0, 0.2f, 0), 0.5f), 1.3f);
    glsl::Light l = light();
    for (int i = 0; i < 3; ++i) l.position[i] *= scale;
    if (l.type == glsl::light_rectangle) {
      l.length_u *= scale;
      l.length_v *= scale;
    }
    const glsl::ShadowView view = fit(scaled, l, {.size = 256, .fit = MapFit::view}, &visible).views[0];
    EXPECT_NEAR(view.middle.x, one.middle.x, 1e-3f);
    EXPECT_NEAR(view.near / scale, one.near, 1e-3f * one.near);
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, WindowFit, ::testing::Range(0, 4));

/// The square that stands for a spot faces the receiver: seen from one aside of the axis, a part of it lies
/// behind the spot, and what blocks there lies farther out in the map than beside it.
TEST(FitWindow, HoldsWhatBlocksBesideALightThatFacesTheReceiver) {
  const vec3 receiver(-8, 0, 4);
  for (const float size : {0.25f, 0.5f, 2.f, 6.f}) {
    const vec3 point =
        size * glm::normalize(vec3(-1, 0, -2));  // of the light, across the way to the receiver
    const float along = (0.2f - point.z) / (receiver.z - point.z);
    const vec3 blocker = point + along * (receiver - point);
    scene::Scene scene;
    scene::Pose pose;
    addMesh(scene, floorPrimitive(0.01f, addMaterial(scene)));
    std::vector<scene::Bounds> boxes;
    for (const vec3& place : {receiver, blocker}) {
      addInstance(scene, pose, 0, glm::translate(glm::mat4(1), place));
      boxes.push_back({place - vec3(0.01f, 0, 0.01f), place + vec3(0.01f, 0, 0.01f)});
    }
    VisibleScene visible(scene);
    visible.update(pose, boxes, scene::lookAt(receiver + vec3(0, 0.2f, 0.2f), receiver, 0.5f), 1);
    const MapEye eye{vec3(0), {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, true, vec3(size)};
    MapWindow window;
    std::vector<vec3> receivers;
    ASSERT_TRUE(
        fitWindow(eye, visible, glsl::no_instance, {vec2(-1e3f), vec2(1e3f), 0.01f, 20}, window, receivers));
    EXPECT_LE(window.low.x, blocker.x / blocker.z) << size;
    EXPECT_LE(window.near, blocker.z) << size;
    EXPECT_GE(window.high.x, receiver.x / receiver.z);
  }
}

/// A half cube, a cube of a point light, and one of a rectangle that shines both ways.
glsl::Light lightOfFaces(int kind) {
  glsl::Light light = rectangleLight({-0.4f, 3.6f, 0.3f}, {0.05f, -1, 0.03f}, 0.8f, 0.5f);
  if (kind == 1) light = pointLight({-0.4f, 3.6f, 0.3f});
  if (kind == 2) light.flags |= glsl::light_flag_two_sided;
  return light;
}

/// The view of a light that sees p.
const glsl::ShadowView& viewOf(const Fitted& fitted, const glsl::ShadowLight& light, const vec3& p) {
  return fitted.views[light.first_layer + glsl::shadow_face(light.faces, fitted.views[light.first_layer], p)];
}

TEST(WindowFitOf, FacesOfSamplesHoldEveryReceiverAndWhatBlocksIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int kind = 0; kind < 3; ++kind) {
    const glsl::Light l = lightOfFaces(kind);
    int receivers = 0, blockers = 0;
    int smaller = 0;  // or empty
    for (uint32_t seed = 1; seed <= 6; ++seed) {
      const Cloud cloud(seed);
      VisibleScene visible(cloud.scene);
      const scene::CameraPose camera = scene::lookAt(
          {3 * uniform(random) - 1.5f, 0.6f + uniform(random), 3.5f}, {uniform(random), 0.2f, 0}, 0.5f);
      visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
      ShadowMapDesc desc{.size = 256, .fit = MapFit::view};
      for (int i = 0; i < 5; ++i) desc.samples.emplace_back(uniform(random), uniform(random));
      const Fitted cut = fit(cloud, l, desc, &visible);
      ASSERT_EQ(cut.views.size(), kind == 0 ? 25u : kind == 1 ? 6u : 30u);
      for (const glsl::ShadowView& view : cut.views)
        smaller += sideOf(view) < 1.8f || view.near >= 0.5f * view.far ? 1 : 0;
      for (int i = 0; i < 4000; ++i) {
        const auto& t = cloud.triangles[i % 8 == 0 ? static_cast<size_t>(i / 8) % 2
                                                   : static_cast<size_t>(i) % cloud.triangles.size()];
        const float a = std::sqrt(uniform(random)), b = uniform(random);
        const vec3 p = t[0] + a * (1 - b) * (t[1] - t[0]) + a * b * (t[2] - t[0]);
        if (!seenBy(camera, 1.3f, p)) continue;
        if (glsl::light_view(l, p, glm::normalize(l.position - p), -1).masked) continue;
        ++receivers;
        for (const glsl::ShadowLight& sample : cut.lights) {
          const glsl::ShadowView& view = viewOf(cut, sample, p);
          EXPECT_TRUE(glsl::shadow_inside(glsl::shadow_project(view, p))) << kind;
          if (i % 4 != 1) continue;
          for (const auto& blocker : cloud.triangles) {
            const std::optional<vec3> at = hit(blocker, p + 1e-3f * (sample.origin - p), sample.origin);
            if (!at || glm::distance(*at, vec3(sample.origin)) < 0.01f) continue;
            ++blockers;
            const glsl::ShadowPoint q = glsl::shadow_project(view, *at);
            EXPECT_TRUE(glsl::shadow_inside(q)) << kind << ": " << q.uv.x << " " << q.uv.y;
            EXPECT_GE(q.depth, view.near);
            EXPECT_LE(q.depth, view.far);
          }
        }
      }
    }
    EXPECT_GT(receivers, 500);
    EXPECT_GT(blockers, 20);
    EXPECT_GE(smaller, 20);
  }
}

TEST(WindowFitOf, FacesScaleWithTheScene) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  const auto fitted = [&](const Cloud& world, int kind, float scale) {
    visible.update(world.pose, world.boxes,
                   scene::lookAt(scale * vec3(0, 1.2f, 3.5f), scale * vec3(0, 0.2f, 0), 0.5f), 1.3f);
    glsl::Light l = lightOfFaces(kind);
    for (int i = 0; i < 3; ++i) l.position[i] *= scale;
    l.length_u *= scale;
    l.length_v *= scale;
    return fit(world, l, {.size = 256, .samples = {{0.3f, 0.6f}}, .fit = MapFit::view}, &visible).views;
  };
  for (int kind = 0; kind < 3; ++kind) {
    const std::vector<glsl::ShadowView> one = fitted(cloud, kind, 1);
    for (const float scale : {1e-3f, 1e3f}) {
      const std::vector<glsl::ShadowView> views = fitted(scaledBy(cloud, scale), kind, scale);
      ASSERT_EQ(views.size(), one.size());
      for (size_t i = 0; i < views.size(); ++i) {
        EXPECT_EQ(showsNothing(views[i]), showsNothing(one[i])) << kind << ", face " << i;
        EXPECT_NEAR(views[i].middle.x, one[i].middle.x, 1e-2f) << kind << ", face " << i;
        EXPECT_NEAR(views[i].near / scale, one[i].near, 1e-3f * one[i].near) << kind << ", face " << i;
      }
    }
  }
}

TEST(WindowFitOf, FacesStayWhatTheyAreWhileTheCameraMovesLittle) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  std::optional<Fitted> before;
  int changes = 0;
  for (int i = 0; i < 50; ++i) {
    const float x = 0.001f * static_cast<float>(i);
    visible.update(cloud.pose, cloud.boxes, scene::lookAt({x, 1.2f, 3.5f}, {x, 0.2f, 0}, 0.5f), 1.3f);
    const Fitted now =
        fit(cloud, lightOfFaces(0), {.size = 256, .samples = {{0.3f, 0.6f}}, .fit = MapFit::view}, &visible);
    if (before && std::memcmp(now.views.data(), before->views.data(), 5 * sizeof(glsl::ShadowView)) != 0)
      ++changes;
    before = now;
  }
  EXPECT_LE(changes, 15);
}

/// Of a light that shines only where the camera does not look, nobody looks into the maps.
TEST(WindowFitOf, MapsOfLightsOnNothingThatIsSeenStayEmpty) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  const scene::CameraPose ahead = scene::lookAt({0, 1.2f, 3.5f}, {0, 0.2f, 8}, 0.5f),
                          up = scene::lookAt({0, 5, 0}, {0.1f, 60, 1}, 0.5f);
  const auto expectEmpty = [&](const glsl::Light& light, const scene::CameraPose& camera,
                               const ShadowMapDesc& desc) {
    visible.update(cloud.pose, cloud.boxes, camera, 1.3f);
    EXPECT_EQ(visible.visible().empty(), &camera == &up);
    const Fitted cut = fit(cloud, light, desc, &visible);
    for (const glsl::ShadowView& view : cut.views) {
      EXPECT_TRUE(showsNothing(view)) << view.layer;
      for (const auto& triangle : cloud.triangles) {
        for (const vec3& p : triangle) {
          const glsl::ShadowPoint q = glsl::shadow_project(view, p);
          EXPECT_FALSE(glsl::shadow_inside(q) && q.depth >= view.near && q.depth <= view.far);
        }
      }
    }
    ShadowMapDesc ofScene = desc;
    ofScene.fit = MapFit::scene;
    const Fitted whole = fit(cloud, light, ofScene, &visible);
    for (const glsl::ShadowView& view : whole.views) EXPECT_FALSE(showsNothing(view)) << view.layer;
  };
  const std::vector<vec2> points{{0.5f, 0.5f}, {0.3f, 0.6f}};
  const glsl::Light rectangle = rectangleLight({-2.5f, 6.5f, 1}, {0.3f, -1, -0.1f}, 0.8f, 0.6f),
                    spot = spotLight({0, 3.8f, -3}, {0, -1, 0}, 0.3f),
                    sun = directionalLight({0.3f, -1, 0.2f}, 0.2f);
  for (const glsl::Light& light : {rectangle, spot, sun}) {
    const scene::CameraPose& camera = light.type == glsl::light_spot ? ahead : up;
    expectEmpty(light, camera, {.size = 64, .fit = MapFit::view});
    expectEmpty(light, camera, {.size = 64, .samples = points, .fit = MapFit::view});
    expectEmpty(light, camera, {.size = 64, .views = 2, .fit = MapFit::view});
  }
  for (int kind = 0; kind < 3; ++kind)
    expectEmpty(lightOfFaces(kind), up, {.size = 64, .samples = points, .fit = MapFit::view});
}

TEST(VisibleSceneOf, FollowsWhatMovedAndIsLeftAsItIsOtherwise) {
  Cloud cloud(1);
  scene::CameraPose camera = scene::lookAt({0, 1.2f, 3.5f}, {0, 0.2f, 0}, 0.5f);
  float aspect = 1.3f;
  VisibleScene visible(cloud.scene);
  const auto expectToFollow = [&](const char* what) {
    SCOPED_TRACE(what);
    EXPECT_TRUE(visible.update(cloud.pose, cloud.boxes, camera, aspect));
    EXPECT_FALSE(visible.update(cloud.pose, cloud.boxes, camera, aspect));
    VisibleScene anew(cloud.scene);
    anew.update(cloud.pose, cloud.boxes, camera, aspect);
    EXPECT_EQ(visible.visible().size(), anew.visible().size());
    ASSERT_EQ(visible.parts().size(), anew.parts().size());
    for (size_t i = 0; i < anew.parts().size(); ++i)
      EXPECT_EQ(visible.parts()[i].bounds, anew.parts()[i].bounds) << i;
  };
  expectToFollow("the first time");
  camera = scene::lookAt({0.5f, 1.2f, 3.5f}, {0, 0.2f, 0}, 0.5f);
  expectToFollow("the camera");
  aspect = 1;
  expectToFollow("the picture's shape");
  cloud.pose.instances[1].objectToWorld *= glm::mat4(glm::mat3(-1, 0, 0, 0, 1, 0, 0, 0, -1));
  expectToFollow("an instance turned, within bounds that stay");
  cloud.pose.instances[1].deformed = 0;
  expectToFollow("an instance that is deformed now");
  cloud.boxes[1].high.y += 1;
  expectToFollow("its bounds");
}

TEST(VisibleSceneOf, CornersOfWhatIsSeenAreThoseOfItsFaces) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  visible.update(cloud.pose, cloud.boxes, scene::lookAt({0, 2, 8}, {0, 1, 0}, 0.6f), 1.3f);
  int whole = 0, cut = 0;
  for (const VisiblePart& part : visible.visible()) {
    const std::vector<vec3>& solid = part.solid.corners();
    for (const vec3& p : solid) EXPECT_NE(std::ranges::find(part.corners, p), part.corners.end());
    for (const vec3& p : part.corners) EXPECT_NE(std::ranges::find(solid, p), solid.end());
    const bool isWhole = solid.size() == 24;  // six faces of four
    EXPECT_TRUE(!isWhole || part.corners.size() == 8) << part.corners.size();
    ++(isWhole ? whole : cut);
  }
  EXPECT_GT(whole, 5);
  EXPECT_GT(cut, 5);
}

TEST(WindowFitOf, CubesAndWhatSeesEverythingCoversTheScene) {
  const Cloud cloud(1);
  VisibleScene visible(cloud.scene);
  visible.update(cloud.pose, cloud.boxes, scene::lookAt({0, 60, 1}, {0, 0, 0}, 1), 1);
  for (const glsl::Light& light : {pointLight({0, 5, 0}), directionalLight({0.3f, -1, 0.2f}, 0),
                                   rectangleLight({0, 30, 0}, {0, -1, 0}, 1, 1)}) {
    const Fitted whole = fit(cloud, light, {.size = 64}, &visible);
    const Fitted cut = fit(cloud, light, {.size = 64, .fit = MapFit::view}, &visible);
    ASSERT_EQ(cut.views.size(), whole.views.size());
    for (size_t i = 0; i < cut.views.size(); ++i)
      EXPECT_EQ(std::memcmp(&cut.views[i], &whole.views[i], sizeof(glsl::ShadowView)), 0);
  }
}

}  // namespace
}  // namespace limn::shadow
