// What a renderer does between frames, with shaders that change on disk and with pictures that are too large;
// and of a lamp that is seen.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/scene/camera.h"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

class RendererTest : public RenderTest {};

/// Records which buffers are updated by taking the place of one function of the context's table.
class UpdateRecorder {
 public:
  explicit UpdateRecorder(const gl::Functions& gl) : table_(const_cast<gl::Functions&>(gl)) {
    updated.clear();
    original = std::exchange(table_.NamedBufferSubData, &record);
  }
  ~UpdateRecorder() { table_.NamedBufferSubData = original; }
  UpdateRecorder(const UpdateRecorder&) = delete;
  UpdateRecorder& operator=(const UpdateRecorder&) = delete;

  /// Returns what the buffers are called that were updated since the last call.
  std::vector<std::string> take() const {
    std::vector<std::string> names;
    for (const GLuint id : std::exchange(updated, {})) {
      char label[64] = {};
      table_.GetObjectLabel(GL_BUFFER, id, sizeof label, nullptr, label);
      names.emplace_back(label);
    }
    return names;
  }

 private:
  static void record(GLuint id, GLintptr offset, GLsizeiptr bytes, const void* data) {
    updated.push_back(id);
    original(id, offset, bytes, data);
  }
  static inline std::vector<GLuint> updated;
  static inline decltype(gl::Functions::NamedBufferSubData) original = nullptr;
  gl::Functions& table_;
};

/// Everything is drawn again in each frame, but what is drawn is known. A camera before the right wall does
/// not see what lies behind it.
TEST_F(RendererTest, whatIsDrawnIsUploadedWhereItChanged) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene), other(device(), scene);
  const render::Settings shown = settings(40, 30, Term::direct, {technique("hard_shadow_map")});
  const scene::CameraPose front = renderer.pose().cameras.at(0),
                          wall = scene::lookAt({0.8f, 1, 0}, {1, 1, 0}, 0.5f);
  const auto next = [&](const scene::CameraPose& camera) {
    renderer.setCamera(camera);
    renderer.render();
    return renderer.read();
  };
  const Image first = picture(renderer, shown, front), aside = picture(other, shown, wall);
  const UpdateRecorder recorder(gl());
  EXPECT_EQ(rmse(next(front), first), 0);
  EXPECT_THAT(recorder.take(), ElementsAre("frame"));
  EXPECT_EQ(rmse(next(wall), aside), 0);
  EXPECT_THAT(recorder.take(), Contains("draw entries"));
  EXPECT_EQ(rmse(next(front), first), 0);
  EXPECT_THAT(recorder.take(), Contains("draw entries"));
}

TEST_F(RendererTest, forgetsWhatOldShadersLeftInCachedPasses) {
  const std::filesystem::path folder = testing::TempDir() + "reloaded" + std::to_string(getpid());
  const std::string name = "glsl/shadow/depth.vert.glsl", line = "vec3 world = place_vertex(view);";
  std::string shader = readTextFile(std::filesystem::path(test::kSourceDir) / name);
  ASSERT_NE(shader.find(line), std::string::npos);
  createFolder((folder / name).parent_path());
  writeTextFile(folder / name, shader);

  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene, folder);
  render::Settings still = settings(40, 30, Term::visibility, {technique("hard_shadow_map")}, 0);
  still.dynamic = false;
  const Image before = picture(renderer, still);
  EXPECT_EQ(renderer.reloadShaders().programs, 0);

  shader.replace(shader.find(line), line.size(), line + " gl_Position = vec4(2, 2, 2, 1);");
  writeTextFile(folder / name, shader);
  EXPECT_GT(renderer.reloadShaders().programs, 0);
  renderer.render();
  EXPECT_GT(mean(renderer.read()), mean(before)) << "the map has no blockers now";
  std::filesystem::remove_all(folder);
}

/// Rows of a bench are measured one after the other by one renderer.
TEST_F(RendererTest, whatATechniqueNeededCountsInNoLaterOnesMemory) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  const auto bytes = [&](const char* name) {
    const render::Settings shown = settings(40, 30, Term::direct, {technique(name)});
    for (int graph = 0; graph < 2; ++graph) picture(renderer, shown);
    return renderer.memoryBytes();
  };
  const int64_t before = bytes("hard_shadow_map");
  bytes("ray_traced_area_light");
  EXPECT_EQ(bytes("hard_shadow_map"), before);
}

TEST_F(RendererTest, picturesThatCannotBeReadBackAreRefusedAtOnce) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(renderer.configure(settings(16384, 8192, Term::direct)), UsageError);
  EXPECT_NO_THROW(renderer.configure(settings(16384, 8191, Term::direct)));
}

/// Depths put pixels of a lamp on either side of it, by rounding. The lamp fills the picture.
TEST_F(RendererTest, aDoubleSidedLampDoesNotLightItself) {
  scene::Scene scene;
  scene::Material emissive = test::lambertian(0.5f);
  emissive.emission = glm::vec3(10);
  emissive.doubleSided = true;
  scene::Primitive lamp = test::quad({0, 0, 0}, {8, 0, 0}, {0, 8, 0}, test::addMaterial(scene, emissive));
  lamp.emissiveParts = {{{.sideU = {8, 0, 0}, .sideV = {0, 8, 0}}}};
  const glm::vec3 centre(0.37f, 1.71f, -0.23f);
  const glm::mat4 place =
      glm::rotate(glm::translate(glm::mat4(1), centre), 0.7f, glm::vec3(0.6f, 0.3f, 0.8f));
  test::show(scene, lamp, place);
  render::Renderer renderer(device(), scene);
  ASSERT_EQ(renderer.pose().lights.size(), 1u);
  for (const float side : {1.f, -1.f})
    for (const float tilt : {0.f, 0.4f, 0.9f}) {
      const glm::vec3 away(std::sin(tilt), 0, side * std::cos(tilt));
      const auto seen = [&](Term term) {
        renderer.configure(settings(48, 36, term));
        renderer.setCamera(scene::lookAt(centre + glm::mat3(place) * away, centre, 0.6f));
        renderer.render();
        return renderer.read();
      };
      SCOPED_TRACE(side * tilt);
      expectWithin(seen(Term::direct), 0, 0);
      expectWithin(seen(Term::final), 10, 10);
    }
}

}  // namespace
}  // namespace limn
