// The work of the rendering thread, step by step and without a window.
#include "apps/view/picture_studio.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <thread>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/technique/technique.h"
#include "tests/cli/process.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/paths.h"

namespace limn::app {
namespace {

using test::GltfBuilder;

/// A lamp of a mesh, seen from above.
std::vector<std::byte> lamp(const char* name = "lamp") {
  GltfBuilder b;
  const int material = b.append("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  const int corners = b.vec3({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  const int mesh = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), material);
  b.node({{"name", name}, {"mesh", mesh}});
  return b.glb();
}

/// Darkens everything, in one frame alone.
class OneFrame : public Technique {
 public:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs&,
                                 const TermRequest& request) override {
    frame::PassBuilder pass = graph.addPass("clear", "one_frame");
    const auto target = pass.write(request.target, frame::Access::copyTarget, "black");
    pass.execute([target](frame::PassContext& passContext) {
      passContext.gl().ClearTexImage(passContext.texture(target).id(), 0, GL_RED, GL_FLOAT, nullptr);
    });
    return target;
  }
  bool update(const scene::Pose&) override { throw Error("there is no second frame"); }
};

constexpr TechniqueInfo kOneFrame{.name = "one_frame",
                                  .title = "One frame",
                                  .source = "a test",
                                  .terms = termSet(Term::visibility),
                                  .parameters = {},
                                  .stress = {}};

const TechniquePlugin kOneFramePlugin{
    {},
    &kOneFrame,
    [] { return std::span<const gpu::EmbeddedSource>(); },
    []() -> std::unique_ptr<Technique> { return std::make_unique<OneFrame>(); }};

/// Darkens everything, in frames that take so long that pictures are smaller while things move.
class SlowFrames : public Technique {
 public:
  frame::TextureHandle addPasses(frame::FrameGraph& graph, const TechniqueInputs&,
                                 const TermRequest& request) override {
    frame::PassBuilder pass = graph.addPass("clear", "slow_frames");
    const auto target = pass.write(request.target, frame::Access::copyTarget, "black");
    pass.execute([target](frame::PassContext& passContext) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      passContext.gl().ClearTexImage(passContext.texture(target).id(), 0, GL_RED, GL_FLOAT, nullptr);
    });
    return target;
  }
};

constexpr TechniqueInfo kSlowFrames{.name = "slow_frames",
                                    .title = "Slow frames",
                                    .source = "a test",
                                    .terms = termSet(Term::visibility),
                                    .parameters = {},
                                    .stress = {}};

const TechniquePlugin kSlowFramesPlugin{
    {},
    &kSlowFrames,
    [] { return std::span<const gpu::EmbeddedSource>(); },
    []() -> std::unique_ptr<Technique> { return std::make_unique<SlowFrames>(); }};

/// A picture at rest takes more frames than the one that is shown at first. The window goes on where one of
/// them fails, and does not try it over and over.
TEST(PictureStudio, AFrameThatFailsAtRestIsSaid) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.scene.aa = 2;
  order.techniques.push_back({&kOneFramePlugin, ParameterValues(kOneFrame.name, kOneFrame.parameters)});
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  const auto step = [&] { studio.step(order, [] { return false; }); };
  step();
  EXPECT_EQ(facts.picture.problem, "there is no second frame");
  EXPECT_TRUE(facts.settled);
  const uint64_t pictures = facts.pictures;
  step();
  EXPECT_EQ(facts.pictures, pictures);
  order.scene.aa = 1;
  step();
  EXPECT_EQ(facts.picture.problem, "");
}

/// Nor does a frame of a sequence that fails leave a renderer with half of it: the window's picture comes
/// back.
TEST(PictureStudio, AfterASequenceThatFailsThePictureComesBack) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.techniques.push_back({&kOneFramePlugin, ParameterValues(kOneFrame.name, kOneFrame.parameters)});
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  const auto step = [&] { studio.step(order, [] { return false; }); };
  step();
  EXPECT_EQ(facts.picture.problem, "");
  studio.save({.picture = order, .file = folder / "a.png", .command = {}, .frames = FrameRange{0, 1}});
  while (studio.saving()) studio.saveNext();
  EXPECT_EQ(facts.message, "frame 1: there is no second frame");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.0000.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.0001.png"));
  step();
  EXPECT_EQ(facts.picture.problem, "");
}

/// As when a file is to be opened, which turns out to be impossible: nothing has changed, and the whole
/// picture stays.
TEST(PictureStudio, NoSmallerPictureTakesThePlaceOfTheSameOne) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.techniques.push_back({&kSlowFramesPlugin, ParameterValues(kSlowFrames.name, kSlowFrames.parameters)});
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  const auto step = [&] { studio.step(order, [] { return false; }); };
  step();
  EXPECT_TRUE(facts.picture.whole) << facts.picture.problem;
  const uint64_t pictures = facts.pictures;
  order.moving = true;
  step();
  EXPECT_EQ(facts.pictures, pictures);
  EXPECT_TRUE(facts.picture.whole);
  EXPECT_FALSE(facts.settled);
  order.scene.eye = "0.4,3,0.7";
  order.scene.target = "0.5,0,0.5";
  step();
  EXPECT_FALSE(facts.picture.whole) << "it takes too long while things move";
  order.moving = false;
  step();
  EXPECT_TRUE(facts.picture.whole);
}

/// A picture that is made again gives the scene its lights again, for which the truth stops reading it. Where
/// these were changed meanwhile and are as before, the question is the same, and it must be asked again.
TEST(PictureStudio, TheTruthGoesOnWhenLightsAreSetAgain) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.scene.defaultLights = "on";  // which follow the camera
  order.scene.lightSettings = {"lamp.intensity=3"};
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  order.beside = Beside::reference;
  const auto never = [] { return false; };
  studio.step(order, never);
  EXPECT_EQ(facts.picture.problem, "");
  EXPECT_TRUE(facts.reference.running);
  order.tone.exposureEv = 1;
  studio.step(order, never);
  EXPECT_TRUE(facts.reference.running);
}

/// Not even for the frame of the window in which the reference has not been asked again.
TEST(PictureStudio, TheTruthOfBeforeNeverStandsBesideANewPicture) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  std::shared_ptr<const Image8> before;
  bool stale = false;
  PictureStudio studio(
      device, {}, {},
      [&](const PictureFacts& newest) {
        stale = stale || (before && newest.truth == before && newest.pictures > facts.pictures);
        facts = newest;
      },
      [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  order.beside = Beside::reference;
  const auto step = [&] { studio.step(order, [] { return false; }); };
  step();
  for (int i = 0; i < 200 && !facts.truth; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    step();
  }
  before = facts.truth;
  ASSERT_TRUE(before) << facts.reference.problem;
  order.scene.eye = "0.4,3,0.7";
  order.scene.target = "0.5,0,0.5";
  step();
  EXPECT_EQ(facts.picture.problem, "");
  EXPECT_FALSE(stale);
}

/// A lamp that an animation turns below a node of unequal scale is no rectangle for a while, and then no
/// light that could be found. Its picture is refused then, whoever asks, and comes back with the light.
TEST(PictureStudio, LightsThatWereNoneForAWhileComeBack) {
  const test::TemporaryFolder folder;
  GltfBuilder b;
  const int glow = b.append("materials", {{"emissiveFactor", {1, 1, 1}}});
  const int corners = b.vec3({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const int quad = b.mesh({{"POSITION", corners}}, b.indices({0, 1, 2, 0, 2, 3}), glow);
  const int holder = b.node({{"scale", {2, 1, 1}}});
  const int node = b.node({{"name", "lamp"}, {"mesh", quad}});
  b.root["nodes"][static_cast<size_t>(holder)]["children"] = GltfBuilder::json::array({node});
  const float angle = glm::radians(22.5f);  // half of how far it turns
  const int times = b.floats({0, 1}),
            turns = b.vec4({{0, 0, 0, 1}, {0, 0, std::sin(angle), std::cos(angle)}});
  b.append("animations",
           {{"samplers", GltfBuilder::json::array({{{"input", times}, {"output", turns}}})},
            {"channels", GltfBuilder::json::array(
                             {{{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}}})}});
  writeFile(folder / "lamp.glb", b.glb());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.scene.lightSettings = {"lamp.position=0,2,0"};
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  const auto problemAt = [&](double time, const char* eye) {
    order.scene.time = time;
    order.scene.eye = eye;
    order.scene.target = "0,0,0";
    studio.step(order, [] { return false; });
    return facts.picture.problem;
  };
  EXPECT_EQ(problemAt(0, "0,0,5"), "");
  EXPECT_NE(problemAt(0.75, "0,0,5").find("'lamp' is not in the scene"), std::string::npos);
  EXPECT_NE(problemAt(0.75, "0,0,4"), "") << "also at the same time again";
  EXPECT_EQ(problemAt(0, "0,0,5"), "");
  EXPECT_EQ(facts.lights.size(), 1u);
}

/// What the scene was read from is not lost to a picture, as it is not to limn render.
TEST(PictureStudio, PicturesDoNotReplaceTheEnvironmentThatLightsThem) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const std::filesystem::path map = folder / "sky.exr";
  std::filesystem::copy_file(std::string(test::kBinaryDir) + "/assets/environments/sky.exr", map);
  const auto bytes = std::filesystem::file_size(map);
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.scene.environment = map.string();
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 12};
  const auto save = [&](const char* name) {
    studio.save({.picture = order, .file = folder / name, .command = {}, .frames = {}});
  };
  save("sky.exr");
  EXPECT_TRUE(facts.problem);
  EXPECT_EQ(std::filesystem::file_size(map), bytes);
  save("picture.exr");
  EXPECT_FALSE(facts.problem) << facts.message;
}

/// A file that nobody should take for a result is not written, as by the command that it would name.
TEST(PictureStudio, PicturesThatAreNotFiniteAreNotSaved) {
  const test::TemporaryFolder folder;
  GltfBuilder b;
  b.triangle();
  // So close to the surface this is more than a float holds.
  b.root["nodes"][0]["scale"] = {1e-6, 1e-6, 1e-6};
  b.light({{"type", "point"}, {"intensity", 1e30}}, {{"translation", {3e-7, 3e-7, 1e-7}}});
  writeFile(folder / "blinding.glb", b.glb());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "blinding.glb").string();
  order.scene.term = "direct";
  studio.open({.scene = order.scene});
  ASSERT_TRUE(facts.scene) << facts.message;
  order.of = facts.scene;
  order.size = {16, 16};
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
TEST(PictureStudio, AnimationsWithoutAnEndInSightAreEndless) {
  const test::TemporaryFolder folder;
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
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
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
TEST(PictureStudio, LightsAreThoseOfTheSceneThatWasOpened) {
  const test::TemporaryFolder folder;
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  for (const char* name : {"lamp", "panel"}) {
    SCOPED_TRACE(name);
    PictureOrder order;
    order.scene.scene = (folder / (std::string(name) + ".glb")).string();
    writeFile(order.scene.scene, lamp(name));
    studio.open({.scene = order.scene});
    ASSERT_EQ(facts.lights.size(), 1u) << facts.message;
    EXPECT_EQ(facts.lights[0].name, name);
    EXPECT_TRUE(facts.lights[0].editable);
    order.of = facts.scene;
    order.size = {16, 12};
    studio.step(order, [] { return false; });
    EXPECT_EQ(facts.picture.problem, "");
  }
}

/// What was wrong with a shader is said no longer when another scene is opened, whose programs are new.
TEST(PictureStudio, ProblemsOfShadersEndWithTheScene) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const std::filesystem::path inside = "glsl/deferred/tone_map.comp.glsl";
  std::filesystem::create_directories((folder.path() / inside).parent_path());
  const std::string good = readTextFile(std::filesystem::path(test::kSourceDir) / inside);
  writeTextFile(folder.path() / inside, good);
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, folder.path(), {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  order.size = {16, 12};
  const auto step = [&] { studio.step(order, [] { return false; }); };
  const auto open = [&] {
    studio.open({.scene = order.scene});
    order.of = facts.scene;
    step();
  };
  open();
  EXPECT_EQ(facts.picture.problem, "");
  writeTextFile(folder.path() / inside, good + "not a shader");
  for (int i = 0; i < 200 && facts.shaderProblem.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    step();
  }
  ASSERT_NE(facts.shaderProblem, "");
  writeTextFile(folder.path() / inside, good);
  open();
  EXPECT_EQ(facts.shaderProblem, "");
  EXPECT_EQ(facts.picture.problem, "");
}

/// Whoever operates the window by a script reads what happened line by line.
TEST(PictureStudio, SaysInOneLineWhatFailed) {
  const test::TemporaryFolder folder;
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
  SceneQuestion scene;
  scene.scene = (folder / "two\nlines.glb").string();
  studio.open({.scene = scene});
  EXPECT_TRUE(facts.problem);
  EXPECT_NE(facts.message.find("two lines.glb"), std::string::npos) << facts.message;
}

/// What was asked for while an environment that cannot be read was still being opened.
TEST(PictureStudio, ARefusedOrderTakesNothingElseWithIt) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  PictureStudio studio(
      device, {}, {}, [&](const PictureFacts& newest) { facts = newest; }, [] {});
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
TEST(PictureStudio, SaysWhatCanBeEnded) {
  const test::TemporaryFolder folder;
  writeFile(folder / "lamp.glb", lamp());
  const auto context = Context::create({});
  gpu::Device device(*context);
  PictureFacts facts;
  std::vector<std::string> endable, jobs;
  PictureStudio studio(
      device, {}, {},
      [&](const PictureFacts& newest) {
        facts = newest;
        if (!facts.job.empty()) (facts.saving ? endable : jobs).push_back(facts.job);
      },
      [] {});
  PictureOrder order;
  order.scene.scene = (folder / "lamp.glb").string();
  studio.open({.scene = order.scene});
  order.of = facts.scene;
  order.size = {16, 12};
  studio.save({.picture = order, .file = folder / "a.png", .command = {}, .frames = FrameRange{0, 1}});
  while (studio.saving()) studio.saveNext();
  EXPECT_EQ(jobs, std::vector<std::string>{"opening lamp.glb"});
  EXPECT_EQ(endable, std::vector<std::string>{"frame 1 of 2"});
  EXPECT_FALSE(facts.saving);
  EXPECT_FALSE(facts.problem) << facts.message;
}

}  // namespace
}  // namespace limn::app
