// Scenes that the rendering thread opens and files that it writes, step by step and without a window.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "apps/view/picture_studio.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/paths.h"
#include "tests/support/skewed_lamp.h"
#include "tests/view/picture_studio_harness.h"

namespace limn::app {
namespace {

using test::GltfBuilder;

/// What the scene was read from is not lost to a picture, as it is not to limn render.
TEST_F(PictureStudioTest, PicturesDoNotReplaceTheEnvironmentThatLightsThem) {
  const std::filesystem::path map = folder / "sky.exr";
  std::filesystem::copy_file(std::string(test::kBinaryDir) + "/assets/environments/sky.exr", map);
  const auto bytes = std::filesystem::file_size(map);
  order.scene.environment = map.string();
  open(lampFile());
  const auto save = [&](const char* name) {
    studio.save({.picture = order, .file = folder / name, .command = {}, .frames = {}});
  };
  save("sky.exr");
  EXPECT_TRUE(facts.problem);
  EXPECT_EQ(std::filesystem::file_size(map), bytes);
  save("picture.exr");
  EXPECT_FALSE(facts.problem) << facts.message;
}

/// The scene's pictures lie beside it, where those that are made of it may be wanted.
TEST_F(PictureStudioTest, PicturesDoNotReplaceTheTexturesOfTheScene) {
  const std::filesystem::path wood = folder / "wood.png";
  writePng(wood, Image::rgb(2, 2));
  const auto bytes = std::filesystem::file_size(wood);
  GltfBuilder b;
  b.append("images", {{"uri", "wood.png"}});
  b.append("textures", {{"source", 0}});
  b.triangle(b.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}));
  open(b.glb());
  const auto save = [&](const std::filesystem::path& file) {
    studio.save({.picture = order, .file = file, .command = {}, .frames = {}});
  };
  save(wood);
  EXPECT_TRUE(facts.problem) << facts.message;
  EXPECT_EQ(std::filesystem::file_size(wood), bytes);
  save(folder / "lamp.glb");
  EXPECT_TRUE(facts.problem) << facts.message;
  save(folder / "picture.png");
  EXPECT_FALSE(facts.problem) << facts.message;
}

/// A file that nobody should take for a result is not written, as by the command that it would name.
TEST_F(PictureStudioTest, PicturesThatAreNotFiniteAreNotSaved) {
  GltfBuilder b;
  b.triangle();
  // So close to the surface this is more than a float holds.
  b.root["nodes"][0]["scale"] = {1e-6, 1e-6, 1e-6};
  b.light({{"type", "point"}, {"intensity", 1e30}}, {{"translation", {3e-7, 3e-7, 1e-7}}});
  order.scene.term = "direct";
  order.size = {16, 16};
  open(b.glb());
  for (const char* name : {"a.png", "a.exr"}) {
    studio.save({.picture = order, .file = folder / name, .command = {}, .frames = {}});
    EXPECT_TRUE(facts.problem) << name;
    EXPECT_NE(facts.message.find("pixels of term direct by no technique are not finite"), std::string::npos)
        << facts.message;
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
  EXPECT_EQ(facts.picture.problem, "") << "it is shown all the same";
}

/// ImGui ends the program at a slider that goes as far as a float does.
TEST_F(PictureStudioTest, AnimationsWithoutAnEndInSightAreEndless) {
  GltfBuilder b;
  const int node = b.triangle();
  const int places = b.vec3({{0, 0, 0}, {1, 0, 0}});
  for (const float end : {3e38f, 2.f}) {
    const int times = b.floats({0, end});
    b.append("animations",
             {{"samplers", GltfBuilder::json::array({{{"input", times}, {"output", places}}})},
              {"channels", GltfBuilder::json::array(
                               {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}})}});
  }
  writeFile(folder / "long.glb", b.glb());
  SceneQuestion scene;
  scene.scene = (folder / "long.glb").string();
  const auto secondsOf = [&](const char* animation) {
    scene.animation = animation;
    studio.open({.scene = scene});
    return facts.scene ? facts.scene->seconds : -1;
  };
  EXPECT_EQ(secondsOf("#0"), 0) << facts.message;
  EXPECT_TRUE(facts.scene->animated);
  EXPECT_EQ(secondsOf("#1"), 2) << facts.message;
}

/// From then on, not from its first picture on, whose shaders may take seconds: a light of the scene before
/// that is changed meanwhile would be one that the scene does not have.
TEST_F(PictureStudioTest, LightsAreThoseOfTheSceneThatWasOpened) {
  for (const char* name : {"lamp", "panel"}) {
    SCOPED_TRACE(name);
    order.scene.scene = (folder / (std::string(name) + ".glb")).string();
    writeFile(order.scene.scene, lampFile(name));
    studio.open({.scene = order.scene});
    ASSERT_EQ(facts.lights.size(), 1u) << facts.message;
    EXPECT_EQ(facts.lights[0].name, name);
    EXPECT_TRUE(facts.lights[0].editable);
    order.of = facts.scene;
    step();
    EXPECT_EQ(facts.picture.problem, "");
  }
}

/// What was wrong with a shader is said no longer when another scene is opened, whose programs are new.
TEST_F(PictureStudioTest, ProblemsOfShadersEndWithTheScene) {
  writeFile(folder / "lamp.glb", lampFile());
  const std::filesystem::path inside = "glsl/deferred/tone_map.comp.glsl";
  std::filesystem::create_directories((folder.path() / inside).parent_path());
  const std::string good = readTextFile(std::filesystem::path(test::kSourceDir) / inside);
  writeTextFile(folder.path() / inside, good);
  PictureStudio reading(
      device, folder.path(), {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  order.scene.scene = (folder / "lamp.glb").string();
  const auto follow = [&] { reading.step(order, [] { return false; }); };
  const auto openAgain = [&] {
    reading.open({.scene = order.scene});
    order.of = facts.scene;
    follow();
  };
  openAgain();
  EXPECT_EQ(facts.picture.problem, "");
  writeTextFile(folder.path() / inside, good + "not a shader");
  for (int i = 0; i < 200 && facts.shaderProblem.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    follow();
  }
  ASSERT_NE(facts.shaderProblem, "");
  writeTextFile(folder.path() / inside, good);
  openAgain();
  EXPECT_EQ(facts.shaderProblem, "");
  EXPECT_EQ(facts.picture.problem, "");
}

/// Whoever operates the window by a script reads what happened line by line.
TEST_F(PictureStudioTest, SaysInOneLineWhatFailed) {
  SceneQuestion scene;
  scene.scene = (folder / "two\nlines.glb").string();
  studio.open({.scene = scene});
  EXPECT_TRUE(facts.problem);
  EXPECT_NE(facts.message.find("two lines.glb"), std::string::npos) << facts.message;
}

/// What was asked for while an environment that cannot be read was still being opened.
TEST_F(PictureStudioTest, ARefusedOrderTakesNothingElseWithIt) {
  writeFile(folder / "lamp.glb", lampFile());
  SceneQuestion scene;
  scene.scene = (folder / "lamp.glb").string();
  studio.open({.scene = scene, .file = 1});
  ASSERT_TRUE(facts.scene) << facts.message;
  SceneQuestion lit = scene;
  lit.environment = (folder / "missing.hdr").string();
  studio.open({.scene = lit, .file = 1});
  EXPECT_TRUE(facts.problem);
  SceneQuestion floored = lit;
  floored.floor = "on";
  studio.open({.scene = floored, .file = 1, .after = lit});
  EXPECT_EQ(facts.scene->options.floor, "on");
  EXPECT_EQ(facts.scene->options.environment, "");
  EXPECT_TRUE(facts.problem) << "why there is no environment is still said";
  EXPECT_EQ(facts.opened, 3u);
  SceneQuestion scattering = floored;  // which starts from what was asked, not from what was opened
  scattering.sigmaS = "0.1";
  studio.open({.scene = scattering, .file = 1, .after = floored});
  EXPECT_EQ(facts.scene->options.floor, "on");
  EXPECT_EQ(facts.scene->options.sigmaS, "0.1");
  studio.open({.scene = floored, .file = 1});
  EXPECT_EQ(facts.scene->options.sigmaS, "0.1") << "nothing is left of an order that starts from no other";
}

/// What can be ended is a sequence that is being saved, not a scene that is being opened.
TEST_F(PictureStudioTest, SaysWhatCanBeEnded) {
  std::vector<std::string> endable, jobs;
  heard = [&](const PictureFacts& newest) {
    if (!newest.job.empty()) (newest.saving ? endable : jobs).push_back(newest.job);
  };
  open(lampFile());
  studio.save({.picture = order, .file = folder / "a.png", .command = {}, .frames = FrameRange{0, 1}});
  while (studio.saving()) studio.saveNext();
  EXPECT_EQ(jobs, std::vector<std::string>{"opening lamp.glb"});
  EXPECT_EQ(endable, std::vector<std::string>{"frame 1 of 2"});
  EXPECT_FALSE(facts.saving);
  EXPECT_FALSE(facts.problem) << facts.message;
}

/// What is saved stands alone: neither frames of a sequence nor a picture of another place than the one shown
/// have a truth beside them that is not theirs.
TEST_F(PictureStudioTest, WhatIsSavedHasNoTruthOfAnotherPicture) {
  open(lampFile());
  order.beside = Beside::reference;
  const auto awaitTruth = [&] {
    for (int i = 0; i < 200 && !facts.truth; ++i) {
      step();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  };
  awaitTruth();
  ASSERT_TRUE(facts.truth) << facts.reference.problem;
  bool stale = false;
  heard = [&](const PictureFacts& newest) {
    stale = stale || newest.truth || newest.metrics || newest.reference.running;
  };
  PictureOrder alone = order;
  alone.beside = Beside::nothing;
  studio.save({.picture = alone, .file = folder / "a.png", .command = {}, .frames = FrameRange{0, 1}});
  while (studio.saving()) studio.saveNext();
  EXPECT_FALSE(facts.problem) << facts.message;
  EXPECT_FALSE(stale);
  heard = nullptr;
  awaitTruth();  // it goes on
  const std::shared_ptr<const Image8> before = facts.truth;
  ASSERT_TRUE(before) << facts.reference.problem;
  heard = [&](const PictureFacts& newest) { stale = stale || newest.truth == before; };
  PictureOrder moved = order;
  moved.scene.eye = "0.4,3,0.7";
  moved.scene.target = "0.5,0,0.5";
  studio.save({.picture = moved, .file = folder / "b.png", .command = {}, .frames = {}});
  EXPECT_FALSE(facts.problem) << facts.message;
  EXPECT_FALSE(stale);
}

/// A lamp that shines from the second frame on takes programs that the first one does without. Once they are
/// compiled, the window says it no longer.
TEST_F(PictureStudioTest, FramesThatCompileSayWhenTheyAreDone) {
  GltfBuilder b;
  b.triangle();
  const int glow = b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  const int corners = b.vec3({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  const int quad = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), glow);
  const int lamp = b.node({{"name", "lamp"}, {"mesh", quad}});
  const int times = b.floats({0, 2}), sizes = b.vec3({{0, 0, 0}, {1, 1, 1}});
  b.append("animations",
           {{"samplers", GltfBuilder::json::array({{{"input", times}, {"output", sizes}}})},
            {"channels",
             GltfBuilder::json::array({{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "scale"}}}}})}});
  open(b.glb());
  bool compiled = false;
  heard = [&](const PictureFacts& newest) {
    compiled = compiled || (newest.job == "frame 1 of 2" && newest.toCompile > 0);
  };
  studio.save(
      {.picture = order, .file = folder / "a.png", .command = {}, .frames = FrameRange{0, 1}, .fps = 1});
  while (studio.saving()) studio.saveNext();
  EXPECT_FALSE(facts.problem) << facts.message;
  EXPECT_TRUE(compiled);
  EXPECT_EQ(facts.toCompile, 0);
}

/// Lights have numbers. A lamp that an animation turns below a node of unequal scale is no light any more, so
/// that the one behind it gets another number: it is still the chosen one that shines in all frames.
TEST_F(PictureStudioTest, FramesKeepTheChosenLight) {
  GltfBuilder b;
  b.triangle();
  test::addSkewedLamp(b, true);
  order.scene.term = "direct";
  order.scene.light = "chosen";
  order.scene.eye = "0.3,0.3,0.8";
  order.scene.target = "0.3,0.3,0";
  open(b.glb());
  ASSERT_EQ(facts.lights.size(), 2u);
  EXPECT_EQ(facts.lights[1].name, "chosen");
  studio.save(
      {.picture = order, .file = folder / "a.exr", .command = {}, .frames = FrameRange{0, 1}, .fps = 2});
  while (studio.saving()) studio.saveNext();
  EXPECT_FALSE(facts.problem) << facts.message;
  EXPECT_EQ(facts.lights.size(), 1u);
  order.scene.time = 0.5;
  studio.save({.picture = order, .file = folder / "b.exr", .command = {}, .frames = {}});
  EXPECT_FALSE(facts.problem) << facts.message;
  const auto middle = [&](const char* name) {
    const Image image = readImage(folder / name);
    return image.at(image.width() / 2, image.height() / 2, *image.findChannel("R"));
  };
  EXPECT_GT(middle("b.exr"), 0.f);
  EXPECT_FLOAT_EQ(middle("a.0001.exr"), middle("b.exr"));
  EXPECT_NEAR(middle("a.0000.exr"), middle("b.exr"), 0.01f * middle("b.exr")) << "it stands still";
}

}  // namespace
}  // namespace limn::app
