// Surface elements that techniques keep from frame to frame follow what moves.
#include <string>

#include "core/scene/camera.h"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using MovingElementsTest = RenderTest;

/// All indirect light of the floor comes from a wall, most of it to the wall's foot, which moves by more than
/// the wall is high.
TEST_F(MovingElementsTest, LightFollowsAWallThatMovesAsAWhole) {
  scene::Scene scene;
  const int grey = test::addMaterial(scene, test::lambertian(0.8f));
  test::show(scene, test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, grey));
  test::show(scene, test::quad({0, 0.6f, 0}, {0, 0, -1}, {0, 1, 0}, grey));
  test::shine(scene, test::lamp(glsl::light_point, 9), {1.5f, 1.5f, 0});
  scene.nodes[1].matrix.reset();
  scene::Animation& animation = scene.animations.emplace_back();
  animation.duration = 2;
  animation.channels.push_back({scene::AnimationChannel::Path::translation,
                                scene::AnimationChannel::Interpolation::linear,
                                1,
                                {0, 1},
                                {-1.5f, 0, 0, 0, 0, 0}});
  for (const char* name : {"implicit_visibility", "illumination_samples"}) {
    SCOPED_TRACE(name);
    render::Settings s = settings(64, 48, Term::indirect, {technique(name, {{"longest_edge", "0.1"}})});
    s.dynamic = false;
    const auto at = [&](render::Renderer& renderer, double time) {
      renderer.setTime(time, 0);
      renderer.setCamera(scene::lookAt({2.5f, 3, 0.5f}, {-0.5f, 0, 0}, 0.8f));
      renderer.render();
      return renderer.read();
    };
    render::Renderer moved(device(), scene), fresh(device(), scene);
    moved.configure(s);
    fresh.configure(s);
    const Image before = at(moved, 0), after = at(moved, 1), wanted = at(fresh, 1);
    const double change = rmse(before, wanted);
    EXPECT_GT(change, 0.2 * mean(wanted));
    EXPECT_LT(rmse(after, wanted), 0.2 * change)
        << "the hierarchy over the elements is that of the first frame";
  }
}

}  // namespace
}  // namespace limn
