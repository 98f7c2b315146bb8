// What implicit visibility promises beyond what every technique does.
#include <cstdio>

#include "core/base/error.h"
#include "core/reference/reference.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

using render::Output;

class ImplicitVisibilityTest : public RenderTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  static Image indirect(render::Renderer& renderer, const Values& values) {
    return picture(renderer, settings(96, 72, Output::indirect, {technique("implicit_visibility", values)}));
  }

  static Image truth(render::Renderer& renderer, const scene::Scene& scene) {
    reference::Request request{.scene = scene,
                               .pose = renderer.pose(),
                               .camera = renderer.pose().cameras.at(0),
                               .width = 96,
                               .height = 72};
    request.term = reference::Term::indirect;
    request.bounces = 1;
    request.spp = 64;
    return reference::render(request).image.select({"R", "G", "B"});
  }
};

/// Satin metal sends light mostly one way; sent evenly, what it throws onto the floor is spread all round.
TEST_F(ImplicitVisibilityTest, GlossySurfacesSendLightWhereTheBrdfDoes) {
  const scene::Scene scene = asset("glossy_sphere");
  render::Renderer renderer(device(), scene);
  const Values coarse{{"bins", "8"}, {"longest_edge", "0.1"}};
  Values glossy = coarse;
  glossy.emplace_back("glossy_bins", "6");
  const Image even = indirect(renderer, coarse), sent = indirect(renderer, glossy);
  const Image exact = truth(renderer, scene);
  std::printf("glossy_sphere, indirect: RMSE %.4f sent evenly, %.4f sent into bins; mean %.4f\n",
              rmse(even, exact), rmse(sent, exact), mean(exact));
  EXPECT_LT(rmse(sent, exact), 0.8 * rmse(even, exact));
  EXPECT_NEAR(mean(sent) / mean(exact), 1, 0.1);
}

/// Each leaf for itself on the GPU, receivers together on the CPU: nearly the same, whatever the structure.
TEST_F(ImplicitVisibilityTest, LinksMadeOnTheGpuSeeWhatThoseOfTheCpuSee) {
  for (const char* name : {"cornell_box", "balls"}) {
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    for (const char* fill : {"footprint", "centre"}) {
      const auto final = [&](const char* parameter, const char* value) {
        return picture(
            renderer,
            settings(
                96, 72, Output::final,
                {technique("implicit_visibility",
                           {{"bins", "8"}, {"fill", fill}, {"longest_edge", "0.1"}, {parameter, value}})}));
      };
      const Image cpu = final("links", "cpu"), gpu = final("links", "gpu"), flat = final("structure", "flat");
      std::printf("%s, %s: RMSE GPU - CPU %.4f, GPU - every pair %.4f, CPU - every pair %.4f; mean %.4f\n",
                  name, fill, rmse(gpu, cpu), rmse(gpu, flat), rmse(cpu, flat), mean(flat));
      EXPECT_LT(rmse(gpu, flat), std::max(1.1 * rmse(cpu, flat), 0.01 * mean(flat)));
    }
  }
}

TEST_F(ImplicitVisibilityTest, EveryPairIsNotTriedOnTheGpu) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(
      picture(renderer,
              settings(8, 8, Output::final,
                       {technique("implicit_visibility", {{"links", "gpu"}, {"structure", "flat"}})})),
      UsageError);
}

/// Where nothing is glossy, bins of directions hold what is sent evenly.
TEST_F(ImplicitVisibilityTest, LambertianSurfacesSendTheSameIntoAllBins) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const Values coarse{{"bins", "8"}, {"longest_edge", "0.2"}, {"bounces", "2"}};
  Values glossy = coarse;
  glossy.emplace_back("glossy_bins", "4");
  const Image even = indirect(renderer, coarse), sent = indirect(renderer, glossy);
  // Elements above the leaves count children by the area that shows.
  EXPECT_LT(rmse(sent, even), 0.02 * mean(even));
  EXPECT_GT(mean(even), 0);
}

}  // namespace
}  // namespace limn
