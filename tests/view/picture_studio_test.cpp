// The pictures of the rendering thread, step by step and without a window.
#include "apps/view/picture_studio.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <new>
#include <span>
#include <thread>

#include "core/base/error.h"
#include "core/technique/technique.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/skewed_lamp.h"
#include "tests/view/picture_studio_harness.h"

namespace limn::app {
namespace {

using test::GltfBuilder;

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

/// A picture at rest takes more frames than the one that is shown at first. The window goes on where one of
/// them fails, and does not try it over and over.
TEST_F(PictureStudioTest, AFrameThatFailsAtRestIsSaid) {
  order.scene.aa = 2;
  order.techniques.push_back({&kOneFramePlugin, ParameterValues(kOneFrame.name, kOneFrame.parameters)});
  open(lampFile());
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
TEST_F(PictureStudioTest, AfterASequenceThatFailsThePictureComesBack) {
  order.techniques.push_back({&kOneFramePlugin, ParameterValues(kOneFrame.name, kOneFrame.parameters)});
  open(lampFile());
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
TEST_F(PictureStudioTest, NoSmallerPictureTakesThePlaceOfTheSameOne) {
  order.techniques.push_back({&kSlowFramesPlugin, ParameterValues(kSlowFrames.name, kSlowFrames.parameters)});
  open(lampFile());
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

/// As after a file that could not be opened: the figures of the picture that has stayed come back.
TEST_F(PictureStudioTest, FiguresComeBackWithRest) {
  order.beside = Beside::techniques;
  open(lampFile());
  step();
  ASSERT_TRUE(facts.metrics) << facts.whyNoMetrics;
  const uint64_t pictures = facts.pictures;
  order.moving = true;
  step();
  EXPECT_FALSE(facts.metrics);
  order.moving = false;
  step();
  EXPECT_TRUE(facts.metrics) << facts.whyNoMetrics;
  EXPECT_EQ(facts.pictures, pictures) << "the same picture";
}

/// Both parts of the picture are of one view, also where it was given up while the second one was made.
TEST_F(PictureStudioTest, TwoPicturesAreShownTogether) {
  order.beside = Beside::techniques;
  order.others.push_back({&kSlowFramesPlugin, ParameterValues(kSlowFrames.name, kSlowFrames.parameters)});
  open(lampFile());
  step();
  ASSERT_TRUE(facts.other.image) << facts.other.problem;
  const glm::ivec2 before = order.size, after(20, 15);
  order.size = after;
  SlowFrames::ran = false;
  studio.step(order, [] { return SlowFrames::ran.load(); });
  EXPECT_TRUE(SlowFrames::ran);
  SceneQuestion missing;
  missing.scene = (folder / "missing.glb").string();
  studio.open({.scene = missing});  // tells what is shown now
  EXPECT_TRUE(facts.problem);
  EXPECT_EQ(facts.picture.size, before);
  EXPECT_EQ(facts.other.size, before);
  step();
  EXPECT_EQ(facts.picture.size, after) << facts.picture.problem;
  EXPECT_EQ(facts.other.size, after) << facts.other.problem;
}

/// Where the memory ends in the middle of a frame, the window says so and goes on.
TEST_F(PictureStudioTest, AFrameThatLacksMemoryIsSaid) {
  open(lampFile());
  heard = [](const PictureFacts& newest) {
    if (newest.toCompile > 0) throw std::bad_alloc();
  };
  step();
  EXPECT_EQ(facts.picture.problem, "out of memory");
  heard = nullptr;
  order.tone.exposureEv = 1;
  step();
  EXPECT_EQ(facts.picture.problem, "");
}

/// A picture that is made again gives the scene its lights again, for which the truth stops reading it. Where
/// these were changed meanwhile and are as before, the question is the same, and it must be asked again.
TEST_F(PictureStudioTest, TheTruthGoesOnWhenLightsAreSetAgain) {
  order.scene.defaultLights = "on";  // which follow the camera
  order.scene.lightSettings = {"lamp.intensity=3"};
  open(lampFile());
  order.beside = Beside::reference;
  step();
  EXPECT_EQ(facts.picture.problem, "");
  EXPECT_TRUE(facts.reference.running);
  order.tone.exposureEv = 1;
  step();
  EXPECT_TRUE(facts.reference.running);
}

/// Not even for the frame of the window in which the reference has not been asked again.
TEST_F(PictureStudioTest, TheTruthOfBeforeNeverStandsBesideANewPicture) {
  std::shared_ptr<const Image8> before;
  bool stale = false;
  heard = [&](const PictureFacts& newest) {
    stale = stale || (before && newest.truth == before && newest.pictures > facts.pictures);
  };
  open(lampFile());
  order.beside = Beside::reference;
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
TEST_F(PictureStudioTest, LightsThatWereNoneForAWhileComeBack) {
  GltfBuilder b;
  test::addSkewedLamp(b, false);
  order.scene.lightSettings = {"lamp.position=0,2,0"};
  open(b.glb());
  const auto problemAt = [&](double time, const char* eye) {
    order.scene.time = time;
    order.scene.eye = eye;
    order.scene.target = "0,0,0";
    step();
    return facts.picture.problem;
  };
  EXPECT_EQ(problemAt(0, "0,0,5"), "");
  EXPECT_NE(problemAt(0.75, "0,0,5").find("'lamp' is not in the scene"), std::string::npos);
  EXPECT_NE(problemAt(0.75, "0,0,4"), "") << "also at the same time again";
  EXPECT_EQ(problemAt(0, "0,0,5"), "");
  EXPECT_EQ(facts.lights.size(), 1u);
}

/// Where a picture is refused, nothing is said of a texture that nobody wants to see any more, nor of one of
/// the picture before.
TEST_F(PictureStudioTest, ARefusedPictureShowsNoTextureOfTheOneBefore) {
  order.techniques.push_back({&kSlowFramesPlugin, ParameterValues(kSlowFrames.name, kSlowFrames.parameters)});
  order.inspect = InspectionOrder{.texture = {"slow_frames", "clear", 0}, .view = {}};
  order.moving = true;
  open(lampFile());
  step();
  ASSERT_TRUE(facts.inspected && facts.inspected->image) << facts.picture.problem;
  order.scene.light = "missing";
  step();
  EXPECT_NE(facts.picture.problem, "");
  ASSERT_TRUE(facts.inspected);
  EXPECT_EQ(facts.inspected->problem, "the frame has no such texture now");
  order.scene.light.clear();
  step();
  ASSERT_TRUE(facts.inspected && facts.inspected->image) << facts.picture.problem;
  order.inspect.reset();
  order.scene.light = "missing";
  order.moving = false;
  step();
  EXPECT_NE(facts.picture.problem, "");
  EXPECT_FALSE(facts.inspected);
}

/// As where another parameter leaves a texture fewer channels than the one that was chosen: it is 0 there.
TEST_F(PictureStudioTest, AChannelThatATextureLacksHasARange) {
  order.techniques.push_back({&kSlowFramesPlugin, ParameterValues(kSlowFrames.name, kSlowFrames.parameters)});
  order.inspect = InspectionOrder{.texture = {"slow_frames", "clear", 0}, .view = {.channel = 2}};
  open(lampFile());
  step();
  ASSERT_TRUE(facts.inspected && facts.inspected->values) << facts.picture.problem;
  ASSERT_LE(facts.inspected->values->components, 2);
  EXPECT_EQ(facts.inspected->view.low, 0.f);
  EXPECT_EQ(facts.inspected->view.high, 1.f);
}

}  // namespace
}  // namespace limn::app
