// What the frames that light is averaged over promise.
#include "core/history/frame_history.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "core/render/supersample.h"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

class FrameHistoryTest : public RenderTest {
 protected:
  static constexpr int kFrames = 4;
  static constexpr glm::ivec2 kSize{64, 48};

  static render::Settings gathered(int lights, int history) {
    return settings(kSize.x, kSize.y, Term::indirect,
                    {technique("reflective_shadow_map", {{"vpls", std::to_string(lights)},
                                                         {"block", "1"},
                                                         {"rsm_size", "64"},
                                                         {"history", std::to_string(history)}})});
  }
  static Image next(render::Renderer& renderer, const scene::CameraPose& camera) {
    renderer.setCamera(camera);
    renderer.render();
    return renderer.read();
  }
  /// The camera, turned to the right.
  static scene::CameraPose turned(scene::CameraPose camera, float degrees) {
    camera.worldToView =
        glm::rotate(glm::mat4(1), glm::radians(degrees), glm::vec3(0, 1, 0)) * camera.worldToView;
    return camera;
  }
  static Image still(render::Renderer& renderer, render::Settings s, const scene::CameraPose& camera) {
    renderer.configure(std::move(s));
    return render::supersample(renderer, camera, kSize, 1);
  }
  /// Pixels of `now` that show another surface than `before` have the light of a frame `alone`, and others
  /// that of frames before, too.
  static void expectNoTrace(const Image& before, const Image& now, const Image& alone) {
    const int id = now.channel("id");
    int changed = 0, kept = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x)
        for (int c = 0; c < 3; ++c)
          if (before.at(x, y, id) != now.at(x, y, id)) {
            EXPECT_FLOAT_EQ(now.at(x, y, c), alone.at(x, y, c)) << x << "," << y;
            ++changed;
          } else {
            kept += now.at(x, y, c) != alone.at(x, y, c);
          }
    EXPECT_GT(changed, 100);
    EXPECT_GT(kept, 300) << "frames before count where the same surface was seen";
  }
  static scene::Node& nodeOf(scene::Scene& scene, std::string_view name) {
    return *std::ranges::find(scene.nodes, name, &scene::Node::name);
  }
  /// A floor and, 1 m above it, a leaf, below a wide lamp; nodes 1 to 3, which come along with node 0.
  static scene::Scene leafUnderLamp() {
    scene::Scene scene;
    const int grey = test::addMaterial(scene, test::lambertian(0.5f));
    scene.nodes.emplace_back();
    test::show(scene, test::quad({0, 0, 0}, {8, 0, 0}, {0, 0, -8}, grey));
    test::show(scene, test::quad({0, 0, 0}, {1.6f, 0, 0}, {0, 0, -1.6f}, grey),
               glm::translate(glm::mat4(1), {0, 1, 0}));
    test::shine(scene, test::lamp(glsl::light_point, 6), {0, 3, 0});
    scene.nodes.back().limnArea = glm::vec2(1.5f);
    for (size_t i = 1; i < scene.nodes.size(); ++i) scene.nodes[i].parent = 0;
    return scene;
  }
  /// One ray of a pixel and frame: a part of those that a frame sends to a place.
  static render::Settings oneRay() {
    render::Settings s =
        settings(kSize.x, kSize.y, Term::visibility,
                 {technique("ray_traced_area_light",
                            {{"rays", "1"}, {"filter", "none"}, {"history", std::to_string(kFrames)}})},
                 0);
    s.channels = true;
    return s;
  }
  /// Sees the floor below the leaf.
  static scene::CameraPose underLeaf() { return scene::lookAt({0, 1.5f, 4}, {0, 0, 0}, 0.8f); }
  /// Root mean square of what V of the floor, instance 0, is off.
  static double floorError(const Image& image, const Image& exact) {
    double sum = 0, count = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        if (image.at(x, y, image.channel("id")) != 0.f || exact.at(x, y, exact.channel("id")) != 0.f)
          continue;
        sum += std::pow(double(image.at(x, y, 0)) - double(exact.at(x, y, 0)), 2);
        ++count;
      }
    return std::sqrt(sum / count);
  }
};

TEST_F(FrameHistoryTest, APictureIsTheMeanOfAllSets) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  // The clamp of both: that of n frames is smaller by their root.
  render::Settings once = gathered(64 * kFrames, 1);
  once.techniques[0].parameters.set("clamp", "0.015");
  const Image many = still(renderer, once, camera);
  once = gathered(64, 1);
  once.techniques[0].parameters.set("clamp", "0.015");
  const double one = rmse(still(renderer, once, camera), many);
  const double all = rmse(still(renderer, gathered(64, kFrames), camera), many);
  EXPECT_LT(all, 0.2 * one);
}

TEST_F(FrameHistoryTest, StillPicturesStayAsTheyAre) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  const Image first = still(renderer, gathered(64, kFrames), camera);
  expectWithin(first, 0, 1e3f);
  for (int frame = 0; frame < kFrames + 1; ++frame)
    EXPECT_LT(rmse(next(renderer, camera), first), 1e-6 * mean(first)) << frame;
}

TEST_F(FrameHistoryTest, SequencesOfTheSameFramesAreTheSameToTheBit) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  const auto sequence = [&] {
    renderer.configure(gathered(64, kFrames));
    Image last;
    for (int frame = 0; frame < kFrames; ++frame)
      last = next(renderer, turned(camera, static_cast<float>(frame)));
    return last;
  };
  const Image before = sequence();
  EXPECT_TRUE(std::ranges::equal(before.data(), sequence().data()));
}

/// Half as far from what all sets together give as this frame's set alone.
TEST_F(FrameHistoryTest, LightIsFollowedAsTheCameraTurns) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  const scene::CameraPose last = turned(camera, 2);
  const Image all = still(renderer, gathered(64, kFrames), last);
  renderer.configure(gathered(64, kFrames));
  for (int frame = 0; frame < kFrames; ++frame)
    next(renderer, turned(camera, 2.f * static_cast<float>(frame + 1) / kFrames));
  const double followed = rmse(renderer.read(), all);
  renderer.configure(gathered(64, kFrames));
  const double alone = rmse(next(renderer, last), all);
  EXPECT_LT(followed, 0.5 * alone);
}

/// A pixel to which a blur brings no other lights, or that has none, has other ones wherever the camera
/// turns. These are no light that changes: k frames count, whose mean has 1 / sqrt(k) of the noise, and less
/// where neighbours share in it.
TEST_F(FrameHistoryTest, OtherPartsOfThePatternAreNoChangeOfLight) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  const Image all = still(renderer, gathered(256, kFrames), turned(camera, 2));
  for (const auto& [parameter, value] : {std::pair("blur_position", "0"), std::pair("blur", "false")}) {
    render::Settings alone = gathered(256, kFrames);
    alone.techniques[0].parameters.set("block", "4");
    alone.techniques[0].parameters.set(parameter, value);
    const auto error = [&](int frames) {
      renderer.configure(alone);
      for (int frame = 1; frame <= frames; ++frame)
        next(renderer, turned(camera, 2.f * static_cast<float>(frame) / static_cast<float>(frames)));
      return rmse(renderer.read(), all);
    };
    EXPECT_LT(error(2 * kFrames), 0.6 * error(1)) << parameter;
  }
}

TEST_F(FrameHistoryTest, WhereNothingWasSeenBeforeTheFrameStandsAlone) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  scene::CameraPose inside = renderer.pose().cameras.at(0);
  const glm::vec3 middle(0.5f * (renderer.pose().bounds.low + renderer.pose().bounds.high));
  inside.worldToView = glm::lookAt(middle, middle + glm::vec3(1, 0, 0), glm::vec3(0, 1, 0));
  scene::CameraPose other = inside;
  other.worldToView = glm::lookAt(middle, middle - glm::vec3(1, 0, 0), glm::vec3(0, 1, 0));
  renderer.configure(gathered(64, kFrames));
  const Image fresh = next(renderer, other);
  renderer.configure(gathered(64, kFrames));
  for (int frame = 0; frame < kFrames; ++frame) next(renderer, inside);
  EXPECT_TRUE(std::ranges::equal(next(renderer, other).data(), fresh.data()));
  EXPECT_GT(mean(fresh), 0);
}

TEST_F(FrameHistoryTest, OneFrameHasNoPassAndNoTextureForIt) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  next(renderer, renderer.pose().cameras.at(0));
  renderer.configure(gathered(64, 1));
  next(renderer, renderer.pose().cameras.at(0));
  for (const frame::PassReport& pass : renderer.explain()) {
    EXPECT_NE(pass.name, "keep frame");
    if (pass.name == "average frames") {
      EXPECT_EQ(pass.state, frame::PassState::leftOut);
    }
  }
}

/// They would all be the same.
TEST_F(FrameHistoryTest, PicturesWithoutItsLightTakeOneFrame) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  render::Settings s = gathered(64, kFrames);
  renderer.configure(s);
  EXPECT_EQ(renderer.framesOfPicture(), kFrames);
  s.term = Term::direct;
  renderer.configure(s);
  EXPECT_EQ(renderer.framesOfPicture(), 1);
}

/// What is given up leaves no light for the frames after it.
TEST_F(FrameHistoryTest, APictureBehindAFrameThatWasGivenUpHasAllItsFrames) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  renderer.configure(gathered(64, kFrames));
  renderer.setCamera(renderer.pose().cameras.at(0));
  EXPECT_FALSE(renderer.render(frame::Timing::off, [] { return true; }));
  EXPECT_EQ(renderer.framesOfPicture(), kFrames);
  EXPECT_TRUE(renderer.render());
  EXPECT_EQ(renderer.framesOfPicture(), 1);
}

/// Where balls hid the wall it was not seen before, though the camera stands still: the frame has its own
/// light alone there. Its virtual lights are those of the first frame, as kFrames sets take turns.
TEST_F(FrameHistoryTest, GeometryThatChangesLeavesNoTraceOnWhatItHid) {
  const scene::Scene scene = asset("metaballs");
  render::Renderer renderer(device(), scene);
  const scene::CameraPose camera = renderer.pose().cameras.at(0);
  render::Settings s = gathered(64, kFrames);
  s.channels = true;
  const auto at = [&](double seconds) {
    renderer.setTime(seconds);
    return next(renderer, camera);
  };
  renderer.configure(s);
  Image before;
  for (int frame = 0; frame < kFrames; ++frame) before = at(0);
  const Image now = at(3);
  renderer.configure(s);
  expectNoTrace(before, now, at(3));
}

/// Nodes that are placed by hand move without an animation: the short block, into the tall one, as itself and
/// as the joint of its skin, which no instance's matrix shows.
TEST_F(FrameHistoryTest, WhatIsPlacedElsewhereLeavesNoTraceOnWhatItHid) {
  for (const bool skinned : {false, true}) {
    SCOPED_TRACE(skinned ? "skinned" : "rigid");
    scene::Scene scene = asset("cornell_box");
    scene::Node& block = nodeOf(scene, "short_block");
    if (skinned) {
      for (scene::Primitive& primitive : scene.meshes[static_cast<size_t>(block.mesh)].primitives) {
        primitive.joints.assign(primitive.positions.size(), glm::u16vec4(0));
        primitive.weights.assign(primitive.positions.size(), glm::vec4(1, 0, 0, 0));
        primitive.jointBounds = {{uint16_t{0}, primitive.bounds}};
      }
      block.skin = static_cast<int>(scene.skins.size());
      scene.skins.push_back({{static_cast<int>(&block - scene.nodes.data())}, {glm::mat4(1)}});
    }
    render::Renderer renderer(device(), scene);
    const scene::CameraPose camera = renderer.pose().cameras.at(0);
    render::Settings s = gathered(64, kFrames);
    s.channels = true;
    renderer.configure(s);
    Image before;
    for (int frame = 0; frame < kFrames; ++frame) before = next(renderer, camera);
    const glm::mat4 inside = glm::translate(glm::mat4(1), {-0.34f, 0, -0.3f});
    block.placed = glm::translate(glm::scale(inside, glm::vec3(0.6f)), {-0.33f, 0, -0.35f});
    renderer.setTime(0);
    const Image now = next(renderer, camera);
    renderer.configure(s);
    expectNoTrace(before, now, next(renderer, camera));
  }
}

/// Where other things may move, flat instances, whose matrices have no inverse, keep their history.
TEST_F(FrameHistoryTest, FlatInstancesKeepTheirLight) {
  scene::Scene scene = asset("cornell_box");
  // The plane x = -1, in which it lies.
  nodeOf(scene, "left_wall").placed =
      glm::scale(glm::translate(glm::mat4(1), {-1, 0, 0}), glm::vec3(0, 1, 1));
  scene::Scene animated = scene;
  animated.animations.emplace_back();
  const auto seen = [&](const scene::Scene& of) {
    render::Renderer renderer(device(), of);
    return still(renderer, gathered(64, kFrames), renderer.pose().cameras.at(0));
  };
  const Image expected = seen(scene);
  EXPECT_LT(rmse(seen(animated), expected), 0.01 * mean(expected));
}

/// A pixel has the rays that it had kFrames ago as long as the camera stands still, also where what moves
/// changes how far the scene reaches, and with it the depths that clip space holds: here behind the floor.
TEST_F(FrameHistoryTest, ShadowsThatMoveLeaveNoTraceBeforeAStillCamera) {
  for (const float away : {-3.f, -6.f}) {
    SCOPED_TRACE(away);
    scene::Scene scene = leafUnderLamp();
    render::Renderer renderer(device(), scene);
    const auto at = [&](float z) {
      scene.nodes[2].placed = glm::translate(glm::mat4(1), {0, 1, z});
      renderer.setTime(0);
      return next(renderer, underLeaf());
    };
    renderer.configure(oneRay());
    Image before;
    for (int frame = 0; frame < kFrames; ++frame) before = at(0);
    const Image now = at(away);
    const int id = now.channel("id");
    int left = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        if (before.at(x, y, id) != 0.f || now.at(x, y, id) != 0.f || before.at(x, y, 0) > 0.f) continue;
        EXPECT_EQ(now.at(x, y, 0), 1.f) << x << "," << y;
        ++left;
      }
    EXPECT_GT(left, 50);
  }
}

/// What moves comes to pixels with other rays, as it does where the camera moves: k frames count, whose mean
/// has 1 / sqrt(k) of the noise, and less where neighbours share in it.
TEST_F(FrameHistoryTest, FramesCountOnWhatMovesBeforeAStillCamera) {
  scene::Scene scene = leafUnderLamp();
  render::Renderer renderer(device(), scene);
  const auto last = [&](int frames) {
    renderer.configure(oneRay());
    for (int frame = 1 - frames; frame <= 0; ++frame) {
      scene.nodes[0].placed = glm::translate(glm::mat4(1), {0.02f * static_cast<float>(frame), 0, 0});
      renderer.setTime(0);
      renderer.setCamera(underLeaf());
      renderer.render();
    }
    return renderer.read();
  };
  const Image one = last(1), many = last(2 * kFrames);
  reference::Request asked = test::request(scene, renderer.pose(), underLeaf(), kSize, Term::visibility, 256);
  asked.light = 0;
  const Image exact = reference::render(asked).image;
  EXPECT_LT(floorError(many, exact), 0.6 * floorError(one, exact));
}

/// One ray of a lamp without extent is exact: a leaf that is back where it was kFrames ago hides what it hid
/// then, wherever it was meanwhile.
TEST_F(FrameHistoryTest, HardShadowsAreThoseOfThisFrame) {
  for (const char* filter : {"none", "spatial"}) {
    SCOPED_TRACE(filter);
    scene::Scene scene = leafUnderLamp();
    scene.nodes.back().limnArea = glm::vec2(0);
    render::Renderer renderer(device(), scene);
    render::Settings s = oneRay();
    s.techniques[0].parameters.set("filter", filter);
    renderer.configure(s);
    const auto at = [&](float z) {
      scene.nodes[2].placed = glm::translate(glm::mat4(1), {0, 1, z});
      renderer.setTime(0);
      return next(renderer, underLeaf());
    };
    const Image first = at(0);
    Image meanwhile;
    for (int frame = 1; frame < kFrames; ++frame) meanwhile = at(-3);
    EXPECT_FALSE(std::ranges::equal(meanwhile.data(), first.data()));
    EXPECT_TRUE(std::ranges::equal(at(0).data(), first.data()));
  }
}

/// Shaders reach no further into a buffer than the device's largest storage block.
TEST_F(FrameHistoryTest, PlacesOfInstancesLargerThanAStorageBufferAreRefused) {
  constexpr int kMost = history::FrameHistoryService::kMostFrames;
  const auto bytes = static_cast<size_t>(device().limits().maxStorageBlockBytes);
  const size_t tooMany = bytes / (kMost * sizeof(glsl::Instance)) + 1;
  if (tooMany > 100'000) GTEST_SKIP() << "the device takes " << tooMany << " instances";
  scene::Scene scene = asset("cornell_box");
  nodeOf(scene, "short_block").instances.resize(tooMany);
  render::Renderer renderer(device(), scene);
  EXPECT_THAT(errorOf([&] { still(renderer, gathered(64, kMost), renderer.pose().cameras.at(0)); }),
              testing::HasSubstr(fmt::format("more than the {} MiB of a storage buffer", bytes >> 20)));
}

/// Metaballs change their topology, robots walk: light is finite and of the same amount.
TEST_F(FrameHistoryTest, WhatMovesKeepsItsLight) {
  for (const char* name : {"metaballs", "atrium_robots"}) {
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    const auto at = [&](int frame) {
      renderer.setTime(frame / 30.0, scene.animations.empty() ? scene::kNone : 0);
      return next(renderer, renderer.pose().cameras.at(0));
    };
    renderer.configure(gathered(256, kFrames));
    for (int frame = 0; frame < kFrames; ++frame) at(frame);
    const Image moved = at(kFrames);
    expectWithin(moved, 0, 1e4f);
    render::Settings many = gathered(256 * kFrames, 1);
    many.techniques[0].parameters.set("clamp", "0.015");  // as a history of so many frames has it
    renderer.configure(many);
    EXPECT_NEAR(mean(moved) / mean(at(kFrames)), 1, 0.1) << name;
  }
}

}  // namespace
}  // namespace limn
