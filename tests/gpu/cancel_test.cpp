// Frames that are given up leave nothing behind that a later frame could see.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "glsl/scene/blocks.glsl"
#include "tests/gpu/render_test.h"
#include "tests/support/environment_maps.h"

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

  /// Holds the contents of buffers that frames update, by what the buffers are called.
  using Held = std::map<std::string, std::multiset<std::string>>;

  /// Returns what those of all renderers hold, of a scene posed like this. Waits for the GPU. A driver may
  /// move a buffer that is read, and update it in another way from then on: copies are read.
  static Held held(const scene::Pose& pose) {
    constexpr GLuint names = 1 << 16;
    constexpr size_t whole = ~size_t{0};  // made of data, behind which their room is 0; that of others is not
    const std::map<std::string_view, size_t> updated{
        {"lights", pose.lights.size() * sizeof(glsl::Light)},
        {"instances", pose.instances.size() * sizeof(glsl::Instance)},
        {"shadow views", whole},
        {"shadow lights", whole},
        {"specular views", whole},
        {"specular layers", whole}};
    Held all;
    for (GLuint id = 1; id < names; ++id) {
      if (gl().IsBuffer(id) == GL_FALSE) continue;
      char label[64] = {};
      gl().GetObjectLabel(GL_BUFFER, id, sizeof label, nullptr, label);
      const auto found = updated.find(label);
      if (found == updated.end()) continue;
      GLint room = 0;
      gl().GetNamedBufferParameteriv(id, GL_BUFFER_SIZE, &room);
      const size_t bytes = std::min(static_cast<size_t>(room), found->second);
      const gpu::Buffer copy(device(), "copy", bytes);
      gl().CopyNamedBufferSubData(id, copy.id(), 0, 0, static_cast<GLsizeiptr>(bytes));
      std::string contents(bytes, '\0');
      copy.read(0, contents.data(), bytes);
      all[label].insert(std::move(contents));
    }
    return all;
  }

  /// Holds a picture and what it was made of.
  struct Made {
    std::vector<float> picture;
    Held held;
  };
  static Made made(const render::Renderer& renderer, const scene::Pose& pose) {
    return {rgb(renderer), held(pose)};
  }

  /// Says which buffers of the only renderer there is hold something else than when a picture was made, and
  /// which passes kept their results: what a wrong picture was made of. Where all buffers hold the same, a
  /// shader read something else than its buffer holds.
  static std::string madeOf(const render::Renderer& renderer, const scene::Pose& pose, const Made& wanted) {
    std::string other;
    for (const auto& [name, contents] : held(pose)) {
      const auto before = wanted.held.find(name);
      if (before == wanted.held.end() || before->second != contents) other += fmt::format(" '{}'", name);
    }
    std::string text = other.empty() ? "all updated buffers hold the same" : "other contents:" + other;
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

  /// Returns a scene that has what the technique answers for.
  static scene::Scene shown(const TechniqueInfo& info) {
    const auto answers = [&](Term term) { return contains(info.terms, term); };
    const char* name = "cornell_box";
    if (answers(Term::caustic) || answers(Term::media) || answers(Term::specular)) name = "glass_sphere";
    if (answers(Term::surface)) name = "torus_metal";
    if (info.places) name = "bump_sphere";
    if (answers(Term::subsurface)) name = "translucent_spheres";
    scene::Scene scene = asset(name);
    if (answers(Term::environment))
      scene.environment = test::environmentOf(32, [](glm::vec3 to) { return glm::vec3(1.5f + to.y); });
    return scene;
  }

  static bool declares(const TechniqueInfo& info, std::string_view parameter) {
    return std::ranges::any_of(info.parameters, [&](const Parameter& p) { return p.name == parameter; });
  }

  /// Puts the last node that is seen or shines elsewhere, a light in most scenes used here, and turns it:
  /// where directional lights are does not matter.
  static void move(scene::Scene& scene, const scene::Pose& pose, int place) {
    for (size_t n = scene.nodes.size(); n-- > 0;) {
      scene::Node& node = scene.nodes[n];
      if (node.light == scene::kNone && node.mesh == scene::kNone) continue;
      node.placed = pose.nodeToWorld[n];
      if (place > 0) {
        const float distance = 0.1f * static_cast<float>(place);
        (*node.placed)[3].x += distance;
        *node.placed = glm::rotate(*node.placed, distance, {1, 0, 0});
      }
      return;
    }
  }
};

TEST_F(CancelTest, leavesNoTrace) {
  for (const TechniquePlugin* plugin : testedTechniques()) {
    const std::string name = plugin->info->name;
    scene::Scene scene = shown(*plugin->info);
    const scene::Pose pose = scene::evaluate(scene, 0);
    render::Settings settings;
    settings.size = {32, 24};
    // What a frame leaves behind shows in few texels and elements as in many, whose frames take seconds, and
    // in few area lights as in many. On a GPU, not on the paths for GPUs that a software renderer takes, it
    // may also depend on what is still being drawn.
    settings.techniques = {context().info().software ? smallest(name) : quick(name)};
    ParameterValues& parameters = settings.techniques[0].parameters;
    if (cutsSurfaces(name)) parameters.set("longest_edge", "0.3");
    if (declares(*plugin->info, "vals")) parameters.set("vals", "4");
    settings.dynamic = false;
    // Begun where the other begins: hierarchies that follow what moves depend on that. What comes back to a
    // place without being given up is the control: where that differs, giving up is not what does it.
    std::vector<Made> wanted;
    std::optional<render::Renderer> undisturbed(std::in_place, device(), scene);
    undisturbed->configure(settings);
    undisturbed->setCamera(pose.cameras.at(0));
    for (size_t frame = 0; frame < 4; ++frame) {
      const size_t place = frame % 2;
      move(scene, pose, static_cast<int>(place));
      undisturbed->setTime(0);
      undisturbed->render();
      if (frame < 2) {
        wanted.push_back(made(*undisturbed, pose));
        continue;
      }
      const std::string changed = difference(rgb(*undisturbed), wanted[place].picture, settings.size.x);
      ASSERT_EQ(changed, "") << name << " back at place " << place
                             << ", never given up: " << madeOf(*undisturbed, pose, wanted[place])
                             << afterwards(*undisturbed, wanted[place].picture);
    }
    undisturbed.reset();
    ASSERT_NE(wanted[0].picture, wanted[1].picture) << name;
    // What the first frame makes and none renews would be wrong in every frame of the other place.
    // Hierarchies of elements have tests of their own.
    if (!cutsSurfaces(name)) {
      move(scene, pose, 1);
      render::Renderer begun(device(), scene);
      begun.configure(settings);
      begun.setCamera(pose.cameras.at(0));
      begun.setTime(0);
      begun.render();
      const std::vector<float> there = rgb(begun);
      double off = 0, moved = 0;
      for (size_t i = 0; i < there.size(); ++i) {
        off += std::pow(double{there[i]} - wanted[1].picture[i], 2);
        moved += std::pow(double{wanted[0].picture[i]} - wanted[1].picture[i], 2);
      }
      EXPECT_LE(std::sqrt(off / moved), 0.01)
          << name << " begun at place 1: " << difference(there, wanted[1].picture, settings.size.x);
    }

    render::Renderer renderer(device(), scene);
    renderer.configure(settings);
    renderer.setCamera(pose.cameras.at(0));
    const auto draw = [&](size_t there, int passes) {
      move(scene, pose, static_cast<int>(there));
      renderer.setTime(0);
      return renderer.render(frame::Timing::off, [&passes] { return passes-- == 0; });
    };
    // Says what is wrong with a frame behind one that is given up before its pass `passes`, if it has that,
    // and else is drawn whole; nothing waits for that one.
    bool whole = false;
    const auto trace = [&](size_t givenUp, size_t drawn, int passes) -> std::string {
      whole = draw(givenUp, passes);
      EXPECT_TRUE(draw(drawn, -1));
      const std::vector<float> seen = rgb(renderer);
      const std::string changed = difference(seen, wanted[drawn].picture, settings.size.x);
      if (changed.empty()) return "";
      const std::string before = whole ? "whole" : fmt::format("given up before pass {}", passes);
      // Light of the other place with the shadows of this one tells which buffer was read as it was there.
      const std::string other = difference(seen, wanted[1 - drawn].picture, settings.size.x);
      return fmt::format("{} at place {} {}, then drawn at place {}: {}; to the other place: {}; {}{}", name,
                         givenUp, before, drawn, changed, other, madeOf(renderer, pose, wanted[drawn]),
                         afterwards(renderer, wanted[drawn].picture));
    };
    // With each pass the light comes back, so that what ran has to run again, and stays, so that the rest has
    // to run. Where a technique fails, the others say whether the fault is its own.
    size_t place = 0;
    std::string found = trace(place, place, 0);
    // Another control: where this fails, it is frames that follow one another without a wait, given up or
    // not.
    constexpr int all = 1 << 20;
    if (found.empty()) found = trace(1 - place, place, all);
    whole = false;
    for (int passes = 0; passes < 64 && !whole && found.empty(); ++passes) {
      found = trace(1 - place, place, passes);
      if (!found.empty()) break;
      found = trace(1 - place, 1 - place, passes);
      place = 1 - place;
    }
    EXPECT_EQ(found, "");
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
