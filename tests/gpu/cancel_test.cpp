// Frames that are given up leave nothing behind that a later frame could see.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>
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
    settings.dynamic = false;
    // Begun where the other begins: hierarchies that follow what moves depend on that.
    std::vector<std::vector<float>> wanted;
    render::Renderer undisturbed(device(), scene);
    undisturbed.configure(settings);
    undisturbed.setCamera(pose.cameras.at(0));
    for (int place = 0; place < 2; ++place) {
      move(scene, pose, place);
      undisturbed.setTime(0);
      undisturbed.render();
      wanted.push_back(rgb(undisturbed));
    }
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
      const int place = (passes / 2) % 2;
      move(scene, pose, place);
      renderer.setTime(0);
      ASSERT_TRUE(renderer.render());
      ASSERT_EQ(difference(rgb(renderer), wanted[static_cast<size_t>(place)], settings.size.x), "")
          << name << " given up before pass " << passes;
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
