// What is changed by hand in the window: cameras, numbers that are typed, lights in the picture, undo.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "apps/view/gizmo.h"
#include "core/base/file.h"
#include "core/session/view.h"
#include "tests/support/gltf_builder.h"
#include "tests/view/viewer_window_test.h"

namespace limn::test {
namespace {

using json = nlohmann::json;

class ViewerEditTest : public ViewerWindowTest {
 protected:
  /// Makes a text field of the slider at that place. Function keys do nothing while ctrl is held, so that
  /// frames cannot be awaited: each takes less than two seconds.
  static std::string clickWithCtrl(const std::string& place) {
    return "point " + place +
           "; xdotool keydown ctrl; sleep 2; xdotool click 1; sleep 2; xdotool keyup ctrl; frames 2\n";
  }
  /// Types a number into the slider at that place.
  static std::string type(const std::string& place, const std::string& number) {
    return clickWithCtrl(place) + "enter " + number + "\n";
  }
  /// The number that follows this text in a command.
  static double numberAfter(const std::string& text, const std::string& command) {
    const size_t at = command.find(text);
    return at == std::string::npos ? NAN : std::strtod(command.c_str() + at + text.size(), nullptr);
  }
  /// Red, green and blue of the panels left of the picture in window.png.
  std::vector<float> panels() const {
    const Image window = picture("window.png").select({"R", "G", "B"});
    std::vector<float> pixels;
    for (int y = 0; y < window.height(); ++y) {
      const auto row = window.data().begin() + std::ptrdiff_t{3} * y * window.width();
      pixels.insert(pixels.end(), row, row + std::ptrdiff_t{3} * 400);
    }
    return pixels;
  }
};

/// Also after the scene has been read again meanwhile, by which the moved camera belongs to the question.
TEST_F(ViewerEditTest, TheCameraAsOpenedIsTheFirstOne) {
  const Outcome outcome = view(
      "cornell_box --technique hard_shadow_map --eye 0.3,1.2,2.5 --target 0,1,0 --size 160x212 --save a.exr",
      std::string(kDrag) + "xdotool key F4; hear opened 2; save moved.exr\n" +
          "click 250 67; click 250 91; save back.exr; " + kDrag + "save again.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(command("back.exr"), testing::HasSubstr("--eye 0.3,1.2,2.5 --target 0,1,0"));
  EXPECT_NE(command("moved.exr"), command("back.exr"));
  EXPECT_EQ(command("again.exr"), command("moved.exr")) << "the same drag from the same place";
}

/// A scene that was read again is turned around the same point as before.
TEST_F(ViewerEditTest, ReadingAgainLeavesThePointThatIsTurnedAround) {
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 160x212 --save a.exr",
           "save first.exr; point 470 100; xdotool keydown shift; xdotool mousedown 1; frames 2\n"
           "point 500 130; xdotool mouseup 1; frames 2; xdotool keyup shift; frames 2; save around.exr; "
           "sleep 1\n" +
               std::string(kDrag) +
               "save one.exr; sleep 1; xdotool key ctrl+z; save back.exr\n"
               "xdotool key F4; hear opened 2; " +
               kDrag + "save two.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(command("around.exr"), command("one.exr"));
  EXPECT_EQ(command("back.exr"), command("around.exr"));
  EXPECT_EQ(command("two.exr"), command("one.exr"));
}

/// A drag takes a camera from where an animation has brought it, not from where it was opened.
TEST_F(ViewerEditTest, CamerasThatMoveAreTakenFromWhereTheyAre) {
  GltfBuilder scene;
  scene.triangle();
  scene.light({{"type", "point"}, {"intensity", 5}}, {{"translation", {0.3, 0.3, 2}}});
  scene.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.01}}}});
  const int camera = scene.node({{"name", "rail"}, {"camera", 0}});
  const int times = scene.floats({0, 60}), places = scene.vec3({{0, 0.3f, 3}, {60, 0.3f, 3}});
  scene.append("animations",
               {{"samplers", json::array({{{"input", times}, {"output", places}}})},
                {"channels",
                 json::array({{{"sampler", 0}, {"target", {{"node", camera}, {"path", "translation"}}}}})}});
  writeFile(folder_ / "rail.glb", scene.glb());
  const Outcome outcome =
      view("rail.glb --technique hard_shadow_map --size 160x212 --save a.exr",
           "save first.exr; xdotool key space; frames 2; sleep 2; xdotool key space; frames 2\n"
           "save paused.exr; point 470 100; xdotool mousedown 1; frames 2; point 471 100\n"
           "xdotool mouseup 1; frames 2; save dragged.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const double metres = numberAfter("--time ", command("paused.exr"));  // one in each second
  EXPECT_GT(metres, 1);
  EXPECT_NEAR(numberAfter("--eye ", command("dragged.exr")), metres, 0.1);
}

/// What is typed may lie beyond a slider's ends, but not beyond what the command accepts.
TEST_F(ViewerEditTest, TypedNumbersAreOnesThatTheCommandAccepts) {
  const std::string question = "cornell_box --environment sky --technique hard_shadow_map --save a.exr ";
  const Outcome scaled = view(question + "--size 160x212 --open environment",
                              "save first.exr\n" + type("270 162", "20") + "save brighter.exr\n" +
                                  type("270 162", "-1") + "save dark.exr");
  ASSERT_EQ(scaled.status, 0) << scaled.err;
  EXPECT_THAT(command("brighter.exr"), testing::HasSubstr("--environment-scale 20 "));
  EXPECT_THAT(command("dark.exr"), testing::HasSubstr("--environment-scale 0 "));
  const Outcome exposed = view(question + "--size 160x212 --open scene",
                               "save first.exr\n" + type("300 113", "20") + "save brighter.exr\n" +
                                   type("300 113", "100") + "save brightest.exr");
  ASSERT_EQ(exposed.status, 0) << exposed.err;
  EXPECT_THAT(command("brighter.exr"), testing::HasSubstr("--exposure 20 "));
  EXPECT_THAT(command("brightest.exr"), testing::HasSubstr("--exposure 60 "));
}

/// Return ends what is typed, however short its tap and however long the frame in which it came; undo is the
/// window's again then.
TEST_F(ViewerEditTest, ATapWithinAFrameIsSeen) {
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 160x212 --open scene --save a.exr",
           "save first.exr; " + clickWithCtrl("300 113") +
               "xdotool type 20; save typed.exr; kill -STOP $viewer; xdotool key Return; kill -CONT $viewer\n"
               "frames 2; xdotool key ctrl+z; save undone.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(command("typed.exr"), testing::HasSubstr("--exposure 20 ")) << "F5 while the text is open";
  EXPECT_EQ(command("undone.exr"), command("first.exr"));
}

/// A light is marked as changed when a handle has moved it, not when it was only clicked.
TEST_F(ViewerEditTest, HandlesThatAreNotMovedChangeNothing) {
  const glm::ivec2 size(300, 400);
  SceneQuestion question;
  question.scene = "cornell_box";
  question.width = size.x;
  question.height = size.y;
  const session::View opened = session::open(question);
  const app::ScreenCamera screen{opened.camera, {400, 0}, glm::vec2(size)};
  const glm::vec3 light = opened.pose.lights.at(0).position;
  const glm::vec3 end = app::outlineOf(screen, light, {app::GizmoHandle::Kind::axis, 0})[1];
  const auto place = [&](const glm::vec3& point, int right) {
    const glm::vec2 pixel = screen.pixel(point).value();
    return fmt::format("{} {}", std::lround(pixel.x) + right, std::lround(pixel.y));
  };
  const auto panelsAfter = [&](const std::string& script) {
    const Outcome outcome = view(
        "cornell_box --technique hard_shadow_map --size 300x400 --open lights --save a.exr --screenshot "
        "window.png",
        "save first.exr; click " + place(light, 0) + "; point " + place(end, 0) + "\n" + script +
            "frames 2; save last.exr");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return panels();
  };
  const std::string down = "xdotool mousedown 1; frames 2\n", up = "xdotool mouseup 1; frames 2\n";
  const std::vector<float> untouched = panelsAfter("");
  EXPECT_EQ(panelsAfter(down + up), untouched);
  EXPECT_THAT(command("last.exr"), testing::Not(testing::HasSubstr("--set-light")));
  EXPECT_NE(panelsAfter(down + "point " + place(end, 20) + "\n" + up), untouched);
  EXPECT_THAT(command("last.exr"), testing::HasSubstr("--set-light"));
}

/// A light is chosen by its mark although the hand shakes: the camera stays where it is.
TEST_F(ViewerEditTest, MarksAreNotWhereTheSceneIsTurned) {
  SceneQuestion question;
  question.scene = "cornell_box";
  question.width = 300;
  question.height = 400;
  const session::View opened = session::open(question);
  const app::ScreenCamera screen{opened.camera, {400, 0}, {300, 400}};
  const glm::vec2 mark = screen.pixel(opened.pose.lights.at(0).position).value();
  const auto point = [&](int right) {
    return fmt::format("point {} {}", std::lround(mark.x) + right, std::lround(mark.y));
  };
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 300x400 --open lights --save a.exr",
           "save first.exr; " + point(0) + "; xdotool mousedown 1; frames 2; " + point(3) +
               "; xdotool mouseup 1; frames 2; save last.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(command("last.exr"), command("first.exr"));
}

/// A light whose rotation alone was set goes on with its animation when it becomes brighter.
TEST_F(ViewerEditTest, BrighterLightsStillFollowTheirAnimation) {
  GltfBuilder scene;
  scene.triangle();
  const int lamp = scene.light({{"type", "spot"}, {"intensity", 5}, {"spot", json::object()}},
                               {{"name", "lamp"}, {"translation", {0.3, 0.3, 2}}});
  const int times = scene.floats({0, 60}), places = scene.vec3({{0, 0.3f, 3}, {60, 0.3f, 3}});
  scene.append(
      "animations",
      {{"samplers", json::array({{{"input", times}, {"output", places}}})},
       {"channels", json::array({{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "translation"}}}}})}});
  writeFile(folder_ / "rail.glb", scene.glb());
  const Outcome outcome = view(
      "rail.glb --technique hard_shadow_map --set-light lamp.rotation=10,0,0 --size 160x500 --open lights "
      "--save a.exr",
      "save first.exr\n" + type("270 294", "7") + "save brighter.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(command("brighter.exr"), testing::AllOf(testing::HasSubstr("lamp.rotation=10,0,0"),
                                                      testing::HasSubstr("lamp.intensity=7"),
                                                      testing::Not(testing::HasSubstr("lamp.position"))));
}

/// The light that is chosen stays so while an animation scales one before it to nothing, which is none then.
TEST_F(ViewerEditTest, TheChosenLightStaysWhenOneBeforeItVanishes) {
  GltfBuilder scene;
  scene.triangle();
  const int glow = scene.append("materials", {{"emissiveFactor", {1, 1, 1}}});
  const int corners = scene.vec3({{0, 0, 0}, {0.2f, 0, 0}, {0.2f, 0.2f, 0}, {0, 0.2f, 0}});
  const int quad = scene.indices({0, 1, 2, 0, 2, 3});
  const auto lamp = [&](const char* name, double x) {
    const int mesh = scene.mesh({{"POSITION", corners}}, quad, glow);
    return scene.node({{"name", name}, {"mesh", mesh}, {"translation", {x, 1.0, 1.0}}});
  };
  const int first = lamp("first", -0.5);
  lamp("second", 0);
  lamp("third", 0.5);
  const int times = scene.floats({0, 1, 60}), sizes = scene.vec3({{1, 1, 1}, {0, 0, 0}, {0, 0, 0}});
  scene.append(
      "animations",
      {{"samplers", json::array({{{"input", times}, {"output", sizes}}})},
       {"channels", json::array({{{"sampler", 0}, {"target", {{"node", first}, {"path", "scale"}}}}})}});
  writeFile(folder_ / "lamps.glb", scene.glb());
  const Outcome outcome = view(
      "lamps.glb --technique hard_shadow_map --set-light second.intensity=2 --size 160x500 --open lights "
      "--save a.exr",
      "save first.exr; xdotool key space; frames 2; sleep 2; xdotool key space; frames 2\n" +
          type("270 330", "7") + "save brighter.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(command("brighter.exr"), testing::AllOf(testing::HasSubstr("second.intensity=7"),
                                                      testing::Not(testing::HasSubstr("third."))));
}

/// Numbers that are dragged have the digits of a scene of a centimetre.
TEST_F(ViewerEditTest, LightsOfSmallScenesMoveByLessThanAMillimetre) {
  GltfBuilder scene;
  const int corners = scene.vec3({{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}});
  scene.meshNode(scene.mesh({{"POSITION", corners}}));
  scene.light({{"type", "point"}, {"intensity", 1e-3}},
              {{"name", "lamp"}, {"translation", {0.003, 0.003, 0.02}}});
  writeFile(folder_ / "small.glb", scene.glb());
  const Outcome outcome = view(
      "small.glb --technique hard_shadow_map --set-light lamp.intensity=2e-3 --size 160x500 --open lights "
      "--save a.exr",
      "save first.exr; point 150 202; xdotool mousedown 1; frames 2; point 160 202; xdotool mouseup 1\n"
      "frames 2; save moved.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const double metres = numberAfter("lamp.position=", command("moved.exr"));
  EXPECT_GT(metres, 0.003);
  EXPECT_LT(metres, 0.004);
}

/// How lights that stand for the scene's own environment are combined leaves them what they are.
TEST_F(ViewerEditTest, LightsOfAScenesOwnEnvironmentStay) {
  std::filesystem::copy_file(std::string(kBinaryDir) + "/assets/environments/sky.exr", folder_ / "sky.exr");
  GltfBuilder scene;
  const int node = scene.triangle();
  scene.append("scenes", {{"nodes", json::array({node})}, {"extras", {{"limn_environment", "sky.exr"}}}});
  writeFile(folder_ / "own.glb", scene.glb());
  const Outcome outcome = view(
      "own.glb --technique hard_shadow_map --environment-lights 0.05 --size 160x312 --open environment "
      "--save "
      "a.exr",
      "save first.exr; click 250 208; click 250 250; hear opened 2; save last.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(command("last.exr"), testing::AllOf(testing::HasSubstr("--environment-lights 0.05"),
                                                  testing::HasSubstr("--environment-combine ratio")));
}

/// An environment that can no longer be read is passed over.
TEST_F(ViewerEditTest, UndoGoesOnBeyondWhatCannotBeOpened) {
  for (const char* name : {"gone.exr", "kept.exr"})
    std::filesystem::copy_file(std::string(kBinaryDir) + "/assets/environments/sky.exr", folder_ / name);
  const Outcome outcome =
      view("cornell_box --technique hard_shadow_map --size 160x212 --save a.exr",
           "save first.exr; drop gone.exr; hear opened 2; sleep .5; save one.exr; sleep .5\n"
           "drop kept.exr; hear opened 3; sleep .5; save two.exr; sleep .5\n"
           "rm gone.exr; xdotool key ctrl+z; hear gone.exr 1; save refused.exr; sleep .5\n"
           "xdotool key ctrl+z; hear opened 4; save undone.exr");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(command("one.exr"), testing::HasSubstr("gone.exr"));
  EXPECT_EQ(command("refused.exr"), command("two.exr"));
  EXPECT_EQ(command("undone.exr"), command("first.exr"));
}

}  // namespace
}  // namespace limn::test
