// Shadow rays on the GPU against those of the reference: what is static, instanced, masked, skinned, or new
// in every frame.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "core/reference/reference.h"
#include "core/render/supersample.h"
#include "tests/gpu/render_test.h"
#include "tests/gpu/technique_harness.h"
#include "tests/support/scene_nodes.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

class RayTracedAreaLightTest : public RenderTest {
 protected:
  static constexpr int kWidth = 96, kHeight = 72;

  static render::Settings rays(int count, int light = 0, const char* filter = "none") {
    render::Settings s = settings(
        kWidth, kHeight, Term::visibility,
        {technique("ray_traced_area_light", {{"rays", std::to_string(count)}, {"filter", filter}})}, light);
    s.channels = true;
    return s;
  }

  static Image at(render::Renderer& renderer, double time) {
    renderer.setTime(time, scene::kNone);
    renderer.setCamera(renderer.pose().cameras.at(0));
    renderer.render();
    return renderer.read();
  }

  /// V where both pictures show the same surface, root mean square of the difference.
  static double difference(const Image& image, const Image& truth) {
    double sum = 0, count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float z = truth.at(x, y, truth.channel("Z"));
        if (image.at(x, y, image.channel("id")) != truth.at(x, y, truth.channel("id")) ||
            std::abs(image.at(x, y, image.channel("Z")) - z) > 1e-3f * z)
          continue;
        sum += std::pow(double(image.at(x, y, 0)) - truth.at(x, y, 0), 2);
        ++count;
      }
    }
    EXPECT_GT(count, kWidth * kHeight / 2);
    return std::sqrt(sum / count);
  }

  static std::vector<float> values(const Image& image) { return {image.data().begin(), image.data().end()}; }

  static Image truth(render::Renderer& renderer, const scene::Scene& scene, int light) {
    reference::Request asked = test::request(renderer, scene, {kWidth, kHeight}, Term::visibility, 128);
    asked.light = light;
    return reference::render(asked).image;
  }
};

TEST_F(RayTracedAreaLightTest, ConvergesToTheReference) {
  struct Case {
    const char* scene;
    double time;
    int lights;  ///< how many of them, if there are as many
  };
  for (const Case& c : {Case{"balls", 0, 1},
                        {"plant", 0, 1},
                        {"foliage_card", 0, 1},
                        {"robot", 0.4, 1},
                        {"cornell_horse", 1.3, 1},
                        {"metaballs", 0.7, 1},
                        {"lights", 0, 4}}) {
    SCOPED_TRACE(c.scene);
    const scene::Scene scene = asset(c.scene);
    render::Renderer renderer(device(), scene);
    const int lights = std::min(c.lights, static_cast<int>(renderer.pose().lights.size()));
    for (int light = 0; light < lights; ++light) {
      renderer.configure(rays(4, light));
      const Image few = at(renderer, c.time);
      const Image exact = truth(renderer, scene, light);
      renderer.configure(rays(128, light));
      const double error[] = {difference(few, exact), difference(at(renderer, c.time), exact)};
      std::printf("%s at %.1f s, light %d: RMSE of V %.4f with 4 rays, %.4f with 128\n", c.scene, c.time,
                  light, error[0], error[1]);
      EXPECT_LT(error[0], 0.1);
      EXPECT_LT(error[1], 0.025);
    }
  }
}

/// Rays begin on the triangle that the pixel shows, not above its neighbours.
TEST_F(RayTracedAreaLightTest, SmallTrianglesShadeEachOther) {
  const scene::Scene scene = asset("statue");
  render::Renderer renderer(device(), scene);
  renderer.configure(rays(128));
  const Image picture = at(renderer, 0);
  EXPECT_LT(difference(picture, truth(renderer, scene, 0)), 0.012);
}

/// The filter takes noise away and leaves what many rays have found, and hard shadows.
TEST_F(RayTracedAreaLightTest, TheFilterErrsLessWithFewRaysAndLittleMoreWithMany) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  renderer.configure(rays(4));
  const Image few = at(renderer, 0);
  const Image exact = truth(renderer, scene, 0);
  const auto filtered = [&](int count) {
    renderer.configure(rays(count, 0, "spatial"));
    return difference(at(renderer, 0), exact);
  };
  EXPECT_LT(filtered(4), 0.9 * difference(few, exact));
  EXPECT_LT(filtered(128), 0.01);
}

/// Four frames of four rays are the sixteen rays of one frame.
TEST_F(RayTracedAreaLightTest, FramesOfAHistoryAddTheirRays) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  const auto picture = [&](int count, const char* history, const char* filter) {
    render::Settings s = rays(count, 0, filter);
    s.techniques[0].parameters.set("history", history);
    renderer.configure(std::move(s));
    return render::supersample(renderer, renderer.pose().cameras.at(0), {kWidth, kHeight}, 1);
  };
  const Image exact = truth(renderer, scene, 0);
  for (const char* filter : {"none", "spatial"}) {
    const Image one = picture(16, "1", filter), frames = picture(4, "4", filter);
    EXPECT_NEAR(difference(frames, exact), difference(one, exact), 0.003) << filter;
    renderer.render();  // the fifth frame has the rays of the first
    EXPECT_EQ(values(renderer.read()), values(frames)) << filter;
  }
}

/// As the camera turns, a place comes to pixels whose rays have other shifts. The noise between them is no
/// light that changes: k frames count, whose mean has 1 / sqrt(k) of the noise, and less where neighbours
/// share in it.
TEST_F(RayTracedAreaLightTest, FramesOfAHistoryCountAsTheCameraTurns) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose last = renderer.pose().cameras.at(0);
  const Image exact = truth(renderer, scene, 0);
  render::Settings s = rays(1);
  s.techniques[0].parameters.set("history", "4");
  const auto error = [&](int frames) {
    renderer.configure(s);
    for (int frame = frames - 1; frame >= 0; --frame) {
      scene::CameraPose camera = last;
      camera.worldToView =
          glm::rotate(glm::mat4(1), glm::radians(0.5f * static_cast<float>(frame)), glm::vec3(0, 1, 0)) *
          last.worldToView;
      renderer.setCamera(camera);
      renderer.render();
    }
    return difference(renderer.read(), exact);
  };
  EXPECT_LT(error(8), 0.6 * error(1));
}

TEST_F(RayTracedAreaLightTest, LightsWithoutExtentPassTheFilter) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  const scene::Pose& pose = renderer.pose();
  const auto found = std::ranges::find_if_not(pose.lights, glsl::light_has_extent);
  ASSERT_NE(found, pose.lights.end());
  const int light = static_cast<int>(found - pose.lights.begin());
  renderer.configure(rays(1, light));
  const Image plain = at(renderer, 0);
  renderer.configure(rays(1, light, "spatial"));
  EXPECT_EQ(values(at(renderer, 0)), values(plain));
}

TEST_F(RayTracedAreaLightTest, WhatMovedIsWhatAFreshStartSees) {
  for (const char* name : {"robot", "cornell_horse", "metaballs", "flying_dragon"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = asset(name);
    render::Renderer moved(device(), scene), fresh(device(), scene);
    moved.configure(rays(2));
    fresh.configure(rays(2));
    at(moved, 0);
    at(moved, 2.1);
    EXPECT_EQ(values(at(moved, 0.9)), values(at(fresh, 0.9)));
  }
}

/// Sources fill again what nobody holds any more: geometry is not known by its address after frames without
/// rays, of which nobody asks.
TEST_F(RayTracedAreaLightTest, GeometryThatChangedWithoutRaysIsWhatAFreshStartSees) {
  const scene::Scene scene = asset("metaballs"), other = asset("metaballs");
  render::Renderer paused(device(), scene), fresh(device(), other);
  paused.configure(rays(2));
  at(paused, 0);
  paused.configure(settings(kWidth, kHeight, Term::visibility, {technique("pcss")}, 0));
  at(paused, 1);
  at(paused, 2);
  paused.configure(rays(2));
  const Image now = at(paused, 2);
  fresh.configure(rays(2));
  EXPECT_EQ(values(now), values(at(fresh, 2)));
}

/// A leaf of 1.6 m, 1 m high, of which the part with x below 0 is there, and from 1 s on the other one.
class HalfLeaf : public scene::GeometrySource {
 public:
  HalfLeaf(bool textured, int material) {
    for (auto* leaf : {&left_, &right_}) {
      scene::Primitive half = test::quad({0, 1, 0}, {1.6f, 0, 0}, {0, 0, -1.6f}, material);
      for (size_t i = 0; i < half.positions.size(); ++i) {
        const bool there = (half.positions[i].x < 0) == (leaf == &left_);
        half.uvs[i].x = there ? 0.f : 1.f;
        if (!textured) half.colours.emplace_back(1.f, 1.f, 1.f, there ? 1.f : 0.f);
      }
      if (!textured) half.uvs.clear();
      *leaf = std::make_shared<const scene::Primitive>(std::move(half));
    }
  }
  std::shared_ptr<const scene::Primitive> at(double time) override { return time < 1 ? left_ : right_; }

 private:
  std::shared_ptr<const scene::Primitive> left_, right_;
};

/// Of geometry that a source makes, too: by a texture or by colours of its vertices.
TEST_F(RayTracedAreaLightTest, MasksOfASourceLetLightPass) {
  for (const bool textured : {true, false}) {
    SCOPED_TRACE(textured ? "texture" : "colours");
    scene::Scene scene;
    scene::TextureImage half;
    half.levels.push_back({2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
    scene.images.push_back(half);
    scene::Material mask = test::lambertian(0.5f);
    mask.alphaCutoff = 0.5f;
    if (textured) mask.baseColourTexture = {0, scene::Wrap::clamp, scene::Wrap::clamp};
    const int ground = test::addMaterial(scene, test::lambertian(0.5f));
    const int masked = test::addMaterial(scene, mask);
    test::show(scene, test::quad({0, 0, 0}, {8, 0, 0}, {0, 0, -8}, ground));
    scene.dynamic.push_back({"leaf", std::make_shared<HalfLeaf>(textured, masked), masked});
    test::shine(scene, test::lamp(glsl::light_point, 6), {0, 3, 0});
    render::Renderer renderer(device(), scene);
    const scene::CameraPose camera = scene::lookAt({0, 1.5f, 4}, {0, 0, 0}, 0.8f);
    renderer.configure(rays(1));
    for (const double time : {0.0, 1.0, 0.0}) {
      renderer.setTime(time, scene::kNone);
      renderer.setCamera(camera);
      renderer.render();
      const Image image = renderer.read();
      const test::ViewRays view(camera, renderer.pose().bounds, {kWidth, kHeight});
      int shaded = 0, lit = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          if (image.at(x, y, image.channel("id")) != 0.f) continue;
          const glm::dvec3 p = view.eye() + double(image.at(x, y, image.channel("Z"))) * view.ray(x, y);
          // The leaf's shadow reaches 1.2 m to all sides.
          if (std::abs(p.x) < 0.1 || std::max(std::abs(p.x), std::abs(p.z)) > 1.1) continue;
          const bool hidden = (p.x < 0) == (time < 1);
          (hidden ? shaded : lit) += 1;
          ASSERT_EQ(image.at(x, y, 0), hidden ? 0.f : 1.f) << p.x << " " << p.z << " at " << time;
        }
      }
      EXPECT_GT(std::min(shaded, lit), 100);
    }
  }
}

/// They have their triangles in world space: a block that is flat moves, rises to its height and falls again.
TEST_F(RayTracedAreaLightTest, FlatInstancesThatMovedAreWhatAFreshStartSees) {
  const glm::mat4 start = glm::translate(glm::mat4(1), {0, 0.5f, 0});
  const glm::mat4 moved = glm::rotate(glm::translate(start, {-0.4f, 0, -0.2f}), 0.3f, {0, 0, 1});
  const glm::vec3 flat(1, 0, 1), high(1);
  scene::Scene scene = asset("cornell_box");
  std::optional<glm::mat4>& place = std::ranges::find(scene.nodes, "short_block", &scene::Node::name)->placed;
  render::Renderer renderer(device(), scene);
  renderer.configure(rays(2));
  std::vector<float> before;
  for (const glm::mat4& now :
       {glm::scale(start, flat), glm::scale(moved, flat), glm::scale(moved, high), glm::scale(start, flat)}) {
    place = now;
    render::Renderer fresh(device(), scene);
    fresh.configure(rays(2));
    const std::vector<float> seen = values(at(renderer, 0));
    EXPECT_EQ(seen, values(at(fresh, 0)));
    EXPECT_NE(seen, before);
    before = seen;
  }
}

TEST_F(RayTracedAreaLightTest, FramesOfWhatStandsStillAreAlike) {
  const scene::Scene scene = asset("robot");
  render::Renderer renderer(device(), scene);
  renderer.configure(rays(3));
  const Image first = at(renderer, 0.5);
  EXPECT_EQ(values(at(renderer, 0.5)), values(first));
}

using RayClearanceTest = test::TechniqueTest;

/// All that is seen of the first instance, more than `least` pixels.
void expectLit(const test::Answer& v, int least) {
  int seen = 0;
  for (size_t i = 0; i < v.instance.size(); ++i) {
    if (v.instance[i] != 0) continue;
    ++seen;
    ASSERT_EQ(v.lights[0][i], 1.f);
  }
  EXPECT_GT(seen, least);
}

/// Far from the origin coordinates round by less than rays must start above what a distant camera sees.
TEST_F(RayClearanceTest, LeavesCloseToTheCameraShadeTheirFloorFarFromTheOrigin) {
  using glm::vec3;
  constexpr float far = 1000;  // m; of which a millionth is a millimetre
  scene::Scene scene;
  scene::Pose pose;
  test::addMesh(scene, test::floorPrimitive(4, test::addMaterial(scene)));
  test::addMesh(scene, test::floorPrimitive(0.5f, 0));
  test::addInstance(scene, pose, 0, test::at(far, 0, 0));
  test::addInstance(scene, pose, 1, test::at(far, 0.03f, 0));
  test::addLight(pose, test::rectangleLight({far, 4, 0}, {0, -1, 0}, 0.8f, 0.8f));
  // Between the floor and the leaf.
  const scene::CameraPose camera = scene::lookAt({far, 0.015f, 0.45f}, {far, 0, 0}, 0.8f);
  const test::Answer v = visibility("ray_traced_area_light", {{"filter", "none"}}, scene, pose, camera);
  int below = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
      const vec3 p = positionOf(v, camera, pose.bounds, x, y);
      if (std::max(std::abs(p.x - far), std::abs(p.z)) > 0.4f) continue;
      ++below;
      EXPECT_EQ(v.at(0, x, y), 0) << p.x << " " << p.z;
    }
  }
  EXPECT_GT(below, 100);
}

/// Of a large triangle, whose corners are known less exactly than what is near the camera.
TEST_F(RayClearanceTest, FloorsOfAnySizeDoNotShadeThemselves) {
  for (const float half : {1.f, 100.f, 1e4f}) {
    for (const float turn : {0.f, 0.7f}) {
      SCOPED_TRACE(testing::Message() << half << " m, turned by " << turn);
      const glm::mat4 tilt = glm::rotate(glm::mat4(1), turn, glm::normalize(glm::vec3(1, 2, 3)));
      const auto placed = [&](float x, float y, float z) { return glm::vec3(tilt * glm::vec4(x, y, z, 1)); };
      scene::Scene scene;
      scene::Pose pose;
      test::addMesh(scene, test::floorPrimitive(half, test::addMaterial(scene)));
      test::addInstance(scene, pose, 0, tilt);
      test::addLight(
          pose, test::rectangleLight(placed(0, 4, -3), glm::vec3(tilt * glm::vec4(0, -1, 0, 0)), 0.8f, 0.8f));
      const scene::CameraPose camera = scene::lookAt(placed(0, 0.6f, 0.5f), placed(0, 0, -1), 0.8f);
      const test::Answer v = visibility("ray_traced_area_light", {{"filter", "none"}}, scene, pose, camera);
      expectLit(v, 2000);
    }
  }
}

/// Mounted on a ceiling, in whose plane it lies, level or tilted, at any scale: the ceiling does not hide the
/// lamp, on whichever side of it rounding puts it.
TEST_F(RayClearanceTest, ALampInTheCeilingLightsTheFloor) {
  using glm::vec3;
  for (const float tilt : {0.f, 0.4f}) {
    for (const float size : {1e-3f, 1.f, 1e3f}) {
      SCOPED_TRACE(testing::Message() << "tilt " << tilt << ", size " << size);
      const glm::mat4 room = glm::rotate(glm::scale(glm::mat4(1), vec3(size)), tilt, vec3(0, 0, 1));
      const auto placed = [&](float x, float y, float z) { return vec3(room * glm::vec4(x, y, z, 1)); };
      scene::Scene scene;
      scene::Pose pose;
      test::addMesh(scene, test::floorPrimitive(2, test::addMaterial(scene)));
      test::addInstance(scene, pose, 0, room);
      test::addInstance(scene, pose, 0, room * test::at(0, 1.5f, 0));
      test::addLight(pose, test::pointLight(placed(0.3f, 1.5f, 0.1f)));
      const scene::CameraPose camera = scene::lookAt(placed(0, 1.2f, 0.3f), vec3(0), 1.4f);
      const test::Answer v = visibility("ray_traced_area_light", {{"filter", "none"}}, scene, pose, camera);
      expectLit(v, 5000);
    }
  }
}

/// Balls that a scale between two turns makes discs. What rounds their matrices looks like an inverse.
TEST_F(RayClearanceTest, FlatInstancesHideWhatDiscsHide) {
  using glm::vec3;
  const vec3 lamp(0, 6, 0), centre(0, 1.5f, 0);
  const glm::mat4 tilt =
      glm::rotate(glm::translate(glm::mat4(1), centre), 0.35f, glm::normalize(vec3(1, 0.3f, 0.2f)));
  const glm::mat4 turn = glm::rotate(glm::mat4(1), 1.34f, glm::normalize(vec3(0.3f, 0.7f, 0.5f)));
  const vec3 normal(tilt[1]);
  for (const float height : {0.f, 1e-8f, 1e-7f, 1e-6f, 1e-5f, 1e-4f}) {
    SCOPED_TRACE(height);
    scene::Scene scene;
    scene::Pose pose;
    test::addMesh(scene, test::floorPrimitive(4, test::addMaterial(scene)));
    test::addMesh(scene, test::spherePrimitive(1, 0));
    test::addInstance(scene, pose, 0);
    test::addInstance(scene, pose, 1, glm::scale(tilt, {1, height, 1}) * turn);
    test::addLight(pose, test::pointLight(lamp));
    const scene::CameraPose camera = scene::lookAt({0, 4, 7}, {0, 1, 0}, 0.8f);
    const test::Answer v = visibility("ray_traced_area_light", {{"filter", "none"}}, scene, pose, camera);
    int hidden = 0, lit = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
        const vec3 p = positionOf(v, camera, pose.bounds, x, y);
        const vec3 ray = lamp - p;
        const vec3 met = p + glm::dot(normal, centre - p) / glm::dot(normal, ray) * ray;
        const float radius = glm::distance(met, centre);
        if (std::abs(radius - 1) < 0.03f) continue;
        (radius < 1 ? hidden : lit) += 1;
        ASSERT_EQ(v.at(0, x, y), radius < 1 ? 0 : 1) << p.x << " " << p.z;
      }
    }
    EXPECT_GT(hidden, 300);
    EXPECT_GT(lit, 3000);
  }
}

/// Of a disc that rises by a tenth of its diameter above the floor, all tries of many pixels miss what
/// counts.
TEST_F(RayClearanceTest, DiscsMostlyBelowTheHorizonAreHiddenByAWall) {
  scene::Scene scene;
  scene::Pose pose;
  test::addMesh(scene, test::floorPrimitive(1, test::addMaterial(scene)));
  test::addMesh(scene, test::floorPrimitive(20, 0));
  test::addInstance(scene, pose, 0);
  test::addInstance(scene, pose, 1,
                    test::at(-2, 0, 0) * glm::rotate(glm::mat4(1), -glsl::pi / 2, glm::vec3(0, 0, 1)));
  // Its centre lies 0.8 of its half angle below the horizon, behind the wall.
  test::addLight(pose, test::directionalLight({std::cos(0.4f), std::sin(0.4f), 0}, 1));
  const scene::CameraPose camera = scene::lookAt({0, 2, 2}, {0, 0, 0}, 0.6f);
  const test::Answer v = visibility("ray_traced_area_light", {{"filter", "none"}}, scene, pose, camera);
  int floor = 0;
  for (size_t i = 0; i < v.instance.size(); ++i) {
    if (v.instance[i] != 0) continue;
    ++floor;
    ASSERT_EQ(v.lights[0][i], 0.f);
  }
  EXPECT_GT(floor, 1000);
}

}  // namespace
}  // namespace limn
