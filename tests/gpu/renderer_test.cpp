// What a renderer does between frames: shaders that change on disk, pictures that are too large.
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

class RendererTest : public RenderTest {};

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

TEST_F(RendererTest, picturesThatCannotBeReadBackAreRefusedAtOnce) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(renderer.configure(settings(16384, 8192, Term::direct)), UsageError);
  EXPECT_NO_THROW(renderer.configure(settings(16384, 8191, Term::direct)));
}

}  // namespace
}  // namespace limn
