// Frames that are given up leave nothing behind that a later frame could see.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

class CancelTest : public RenderTest {
 protected:
  static std::vector<float> rgb(const render::Renderer& renderer) {
    const Image image = renderer.read().select({"R", "G", "B"});
    return {image.data().begin(), image.data().end()};
  }

  /// Says where two pictures of a width differ; empty: nowhere.
  static std::string difference(const std::vector<float>& a, const std::vector<float>& b, int width) {
    size_t count = 0, most = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i] == b[i]) continue;
      ++count;
      if (!(std::abs(a[i] - b[i]) <= std::abs(a[most] - b[most]))) most = i;
    }
    if (count == 0) return "";
    const size_t pixel = most / 3, across = static_cast<size_t>(width);
    return fmt::format("{} of {} values, the most at pixel {}, {}: {} instead of {}", count, a.size(),
                       pixel % across, pixel / across, a[most], b[most]);
  }

  /// Says whether the buffer of lights, of the only renderer there is, holds those of its pose, and which
  /// passes kept their results: what a wrong picture was made of.
  static std::string madeOf(render::Renderer& renderer) {
    constexpr GLuint names = 1 << 16;
    std::string text = "no buffer of lights was found";
    for (GLuint id = 1; id < names; ++id) {
      if (gl().IsBuffer(id) == GL_FALSE) continue;
      char label[64] = {};
      gl().GetObjectLabel(GL_BUFFER, id, sizeof label, nullptr, label);
      if (std::string_view(label) != "lights") continue;
      const std::vector<glsl::Light>& wanted = renderer.pose().lights;
      std::vector<glsl::Light> found(wanted.size());
      const size_t bytes = wanted.size() * sizeof(glsl::Light);
      gl().GetNamedBufferSubData(id, 0, static_cast<GLsizeiptr>(bytes), found.data());
      const bool same = std::memcmp(found.data(), wanted.data(), bytes) == 0;
      text = same ? "the GPU has the lights of the pose" : "the GPU has other lights than the pose";
    }
    text += "; kept:";
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.state == frame::PassState::cached) text += fmt::format(" '{}/{}'", pass.technique, pass.name);
    return text;
  }

  /// Says whether the frame is right when it is drawn again, and then with nothing kept: what was read wrong
  /// once, what was kept wrongly and what stays wrong differ in that.
  static std::string afterwards(render::Renderer& renderer, const std::vector<float>& wanted) {
    renderer.render();
    const bool again = rgb(renderer) == wanted;
    renderer.graph().invalidate();
    renderer.render();
    const bool nothingKept = rgb(renderer) == wanted;
    return fmt::format("; drawn again: {}, with nothing kept: {}", again ? "right" : "wrong",
                       nothingKept ? "right" : "wrong");
  }

  /// Puts the last node that is seen or shines elsewhere: a light in the scenes used here.
  static void move(scene::Scene& scene, const scene::Pose& pose, int place) {
    for (size_t n = scene.nodes.size(); n-- > 0;) {
      scene::Node& node = scene.nodes[n];
      if (node.light == scene::kNone && node.mesh == scene::kNone) continue;
      node.placed = pose.nodeToWorld[n];
      (*node.placed)[3].x += 0.1f * static_cast<float>(place);
      return;
    }
  }
};

TEST_F(CancelTest, leavesNoTrace) {
  for (const TechniquePlugin* plugin : testedTechniques()) {
    const std::string name = plugin->info->name;
    const bool glass =
        contains(plugin->info->terms, Term::caustic) || contains(plugin->info->terms, Term::media);
    scene::Scene scene = asset(glass ? "glass_sphere" : "cornell_box");
    const scene::Pose pose = scene::evaluate(scene, 0);
    render::Settings settings;
    settings.size = {40, 30};
    settings.techniques = {quick(name)};
    // What a frame leaves behind shows in few elements as in many, whose frames take seconds.
    if (cutsSurfaces(name)) settings.techniques[0].parameters.set("longest_edge", "0.3");
    settings.dynamic = false;
    // Begun where the other begins: hierarchies that follow what moves depend on that. What comes back to a
    // place without being given up is the control: where that differs, giving up is not what does it.
    std::vector<std::vector<float>> wanted;
    std::optional<render::Renderer> undisturbed(std::in_place, device(), scene);
    undisturbed->configure(settings);
    undisturbed->setCamera(pose.cameras.at(0));
    for (size_t frame = 0; frame < 4; ++frame) {
      const size_t place = frame % 2;
      move(scene, pose, static_cast<int>(place));
      undisturbed->setTime(0);
      undisturbed->render();
      const std::vector<float> found = rgb(*undisturbed);
      if (frame < 2) {
        wanted.push_back(found);
        continue;
      }
      const std::string changed = difference(found, wanted[place], settings.size.x);
      ASSERT_EQ(changed, "") << name << " back at place " << place
                             << ", never given up: " << madeOf(*undisturbed)
                             << afterwards(*undisturbed, wanted[place]);
    }
    undisturbed.reset();
    ASSERT_NE(wanted[0], wanted[1]) << name;

    render::Renderer renderer(device(), scene);
    renderer.configure(settings);
    renderer.setCamera(pose.cameras.at(0));
    bool whole = false;
    for (int passes = 0; passes < 64 && !whole; ++passes) {
      move(scene, pose, passes % 2);
      renderer.setTime(0);
      int left = passes;
      whole = renderer.render(frame::Timing::off, [&] { return left-- == 0; });
      const size_t place = static_cast<size_t>(passes / 2) % 2;
      move(scene, pose, static_cast<int>(place));
      renderer.setTime(0);
      ASSERT_TRUE(renderer.render());
      ASSERT_EQ(difference(rgb(renderer), wanted[place], settings.size.x), "")
          << name << " given up before pass " << passes << ": " << madeOf(renderer)
          << afterwards(renderer, wanted[place]);
    }
  }
}

TEST_F(CancelTest, aFrameAfterOneThatDidNotCompileIsBuiltAgain) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("limn-override-" + std::to_string(getpid()));
  const std::filesystem::path file = folder / "glsl/geometry/gbuffer.frag.glsl";
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "int f() { return undeclared; }\n";
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene, folder);
  renderer.configure(settings(8, 6, Term::direct));
  renderer.setCamera(renderer.pose().cameras.at(0));
  for (int frame = 0; frame < 2; ++frame) {
    EXPECT_THAT([&] { renderer.render(); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("gbuffer.frag.glsl:1")))
        << "frame " << frame;
  }
  EXPECT_THROW(renderer.explain(), Error) << "there is no frame";
  std::filesystem::remove_all(folder);
  renderer.reloadShaders();
  EXPECT_TRUE(renderer.render());
}

}  // namespace
}  // namespace limn
