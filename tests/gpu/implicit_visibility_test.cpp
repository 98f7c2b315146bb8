// What implicit visibility promises beyond what every technique does.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/reference/reference.h"
#include "tests/gpu/ball_scene.h"
#include "tests/gpu/paths_of_devices.h"
#include "tests/gpu/render_test.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

class ImplicitVisibilityTest : public RenderTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  static Image indirect(render::Renderer& renderer, const Values& values) {
    return picture(renderer, settings(96, 72, Term::indirect, {technique("implicit_visibility", values)}));
  }

  static reference::Result truth(render::Renderer& renderer, const scene::Scene& scene) {
    reference::Request asked = test::request(renderer, scene, {96, 72}, Term::indirect, 256);
    asked.bounces = 1;
    return reference::render(asked);
  }

  /// Over the pixels that show an instance.
  static double rmseOn(int instance, const Image& image, const Image& truth) {
    double sum = 0, count = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        if (truth.at(x, y, truth.channel("id")) != static_cast<float>(instance)) continue;
        for (int c = 0; c < 3; ++c) sum += std::pow(double(image.at(x, y, c)) - truth.at(x, y, c), 2);
        count += 3;
      }
    return std::sqrt(sum / count);
  }
};

/// Satin metal sends light mostly one way; sent evenly, what it throws onto the floor is spread all round.
TEST_F(ImplicitVisibilityTest, GlossySurfacesSendLightWhereTheBrdfDoes) {
  const scene::Scene scene = asset("glossy_sphere");
  render::Renderer renderer(device(), scene);
  const Values coarse{{"bins", "12"}, {"longest_edge", "0.1"}};
  Values glossy = coarse;
  glossy.emplace_back("glossy_bins", "6");
  const Image even = indirect(renderer, coarse), sent = indirect(renderer, glossy);
  const Image exact = truth(renderer, scene).image;
  const double before = rmseOn(0, even, exact), after = rmseOn(0, sent, exact);
  std::printf("floor of glossy_sphere, indirect: RMSE %.5f sent evenly, %.5f sent into bins\n", before,
              after);
  EXPECT_LT(after, 0.8 * before);
}

/// Each leaf for itself on the GPU, receivers together on the CPU: nearly the same, whatever the structure.
TEST_F(ImplicitVisibilityTest, LinksMadeOnTheGpuSeeWhatThoseOfTheCpuSee) {
  for (const char* name : {"cornell_box", "lights"}) {
    const scene::Scene scene = asset(name);
    render::Renderer renderer(device(), scene);
    for (const char* fill : {"triangles", "footprint", "centre"}) {
      const auto final = [&](const char* parameter, const char* value) {
        return picture(renderer, settings(96, 72, Term::final,
                                          {technique("implicit_visibility", {{"bins", "8"},
                                                                             {"fill", fill},
                                                                             {"longest_edge", "0.1"},
                                                                             {"outlines", "vertex"},
                                                                             {parameter, value}})}));
      };
      const Image cpu = final("links", "cpu"), gpu = final("links", "gpu"), flat = final("structure", "flat");
      std::printf("%s, %s: RMSE GPU - CPU %.4f, GPU - every pair %.4f, CPU - every pair %.4f; mean %.4f\n",
                  name, fill, rmse(gpu, cpu), rmse(gpu, flat), rmse(cpu, flat), mean(flat));
      EXPECT_LT(rmse(gpu, flat), std::max(1.1 * rmse(cpu, flat), 0.01 * mean(flat)));
    }
  }
}

/// Software renderers gather on the processor, GPUs in shaders: the same sums in another order.
TEST_F(ImplicitVisibilityTest, TheProcessorGathersWhatShadersGather) {
  for (const char* name : {"cornell_box", "balls_sky"}) {
    const scene::Scene scene = asset(name);
    std::vector<Image> pictures;
    for (const bool hardware : {false, true}) {
      const PathsOfDevices paths(hardware);
      gpu::Device own(context());
      render::Renderer renderer(own, scene);
      pictures.push_back(indirect(renderer, {{"bins", "8"}, {"longest_edge", "0.1"}, {"bounces", "3"}}));
    }
    std::printf("%s: RMSE processor - shaders %.2g, mean %.4f\n", name, rmse(pictures[0], pictures[1]),
                mean(pictures[0]));
    EXPECT_LT(rmse(pictures[0], pictures[1]), 1e-5 * mean(pictures[0]));
    EXPECT_GT(mean(pictures[0]), 0);
  }
}

/// Lists of what may hide a light find outlines that vertices do not; where links are made does not matter.
TEST_F(ImplicitVisibilityTest, PixelsFindOutlines) {
  const scene::Scene scene = asset("frog");
  render::Renderer renderer(device(), scene);
  reference::Request wanted = test::request(renderer, scene, {96, 72}, Term::visibility, 256);
  wanted.light = 0;
  const Image truth = reference::render(wanted).image;
  const auto error = [&](const char* outlines, const char* links) {
    render::Settings asked =
        settings(96, 72, Term::visibility,
                 {technique("implicit_visibility", {{"outlines", outlines}, {"links", links}})}, 0);
    asked.channels = true;
    const Image v = picture(renderer, asked);
    double sum = 0, count = 0;
    for (int y = 0; y < v.height(); ++y)
      for (int x = 0; x < v.width(); ++x) {
        const float id = truth.at(x, y, truth.channel("id"));
        if (v.at(x, y, v.channel("id")) != id || truth.at(x, y, truth.channel("coverage")) == 0) continue;
        sum += std::pow(double(v.at(x, y, 0)) - truth.at(x, y, 0), 2);
        ++count;
      }
    EXPECT_GT(count, 96 * 72 / 2);
    return std::sqrt(sum / count);
  };
  const double vertices = error("vertex", "cpu"), pixels = error("pixel", "cpu"), gpu = error("pixel", "gpu");
  std::printf("frog: RMSE of V of vertices %.4f, of pixels %.4f, with links of the GPU %.4f\n", vertices,
              pixels, gpu);
  EXPECT_LT(pixels, 0.5 * vertices);
  EXPECT_LT(gpu, 0.5 * vertices);
}

TEST_F(ImplicitVisibilityTest, EveryPairIsNotTriedOnTheGpu) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  EXPECT_THROW(
      picture(renderer,
              settings(8, 8, Term::final,
                       {technique("implicit_visibility", {{"links", "gpu"}, {"structure", "flat"}})})),
      UsageError);
}

/// llvmpipe leaves the loops that make links early, whichever paths its device takes.
TEST_F(ImplicitVisibilityTest, SoftwareRenderersMakeNoLinksIntoManyBins) {
  if (!context().info().software) GTEST_SKIP() << "GPUs leave no loop early";
  const scene::Scene scene = asset("cornell_box");
  for (const bool hardware : {false, true}) {
    const PathsOfDevices paths(hardware);
    gpu::Device own(context());
    render::Renderer renderer(own, scene);
    EXPECT_THROW(indirect(renderer, {{"bins", "32"}, {"links", "gpu"}, {"longest_edge", "1"}}), UsageError)
        << (hardware ? "paths for GPUs" : "paths for software renderers");
  }
}

/// Figure 4.2 of the thesis: higher levels have fewer colours, and the element in the middle is white among
/// those that it is linked to.
TEST_F(ImplicitVisibilityTest, HierarchyAndLinksAreShownInColours) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto shown = [&](const char* show, const char* level) {
    return indirect(renderer,
                    {{"bins", "8"}, {"longest_edge", "0.1"}, {"show", show}, {"show_level", level}});
  };
  const auto hues = [](const Image& image) {  // of colours that differ in more than their brightness
    std::set<std::pair<int, int>> all;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (const float red = image.at(x, y, 0); red > 0)
          all.insert(
              {std::lround(100 * image.at(x, y, 1) / red), std::lround(100 * image.at(x, y, 2) / red)});
    return all.size();
  };
  const size_t leaves = hues(shown("level", "0")), third = hues(shown("level", "3")),
               roots = hues(shown("level", "32"));
  std::printf("hues: %zu of leaves, %zu three levels above, %zu of roots\n", leaves, third, roots);
  for (const frame::PassReport& pass : renderer.explain()) {
    if (pass.name.starts_with("links")) {
      EXPECT_EQ(pass.state, frame::PassState::leftOut) << "levels have nothing to do with links";
    }
  }
  EXPECT_GT(leaves, 4 * third);
  EXPECT_GT(third, roots);
  EXPECT_GT(roots, 1u);
  for (const char* show : {"links", "bins"}) {
    const Image image = shown(show, "0");
    int white = 0;  // of the four pixels around the middle
    for (const int y : {35, 36})
      for (const int x : {47, 48})
        white += image.at(x, y, 0) > 0.4f && image.at(x, y, 1) == image.at(x, y, 0) &&
                 image.at(x, y, 2) == image.at(x, y, 0);
    EXPECT_GE(white, 1) << show;
    EXPECT_GT(hues(image), 16u) << show;
  }
  EXPECT_THROW(indirect(renderer, {{"bins", "8"}, {"links", "gpu"}, {"show", "links"}}), UsageError);
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
  EXPECT_LT(rmse(sent, even), 0.05 * mean(even));
  EXPECT_GT(mean(even), 0);
}

TEST_F(ImplicitVisibilityTest, ASkyAloneIsSentIntoBins) {
  const scene::Scene scene = asset("balls_sky");
  render::Renderer renderer(device(), scene);
  const auto final = [&](const char* glossyBins) {
    return picture(
        renderer,
        settings(48, 36, Term::final,
                 {technique("implicit_visibility",
                            {{"bins", "4"}, {"longest_edge", "0.2"}, {"glossy_bins", glossyBins}})}));
  };
  // Buffers that the elements' direct light is written to.
  const auto written = [&] {
    std::ptrdiff_t count = 0;
    for (const frame::PassReport& pass : renderer.explain())
      if (pass.technique == "implicit_visibility" && pass.name.starts_with("direct light"))
        count += std::ranges::count(pass.accesses, true, &frame::AccessReport::write);
    return count;
  };
  const Image even = final("0");
  EXPECT_EQ(written(), 2) << "one to keep, and one to be pulled up";
  const Image sent = final("4");
  EXPECT_EQ(written(), 1) << "the sky is still to be added";
  EXPECT_NEAR(mean(sent) / mean(even), 1, 0.05);
}

/// A lamp that reflects half of what it gets gets nothing from itself: the floor below it is as it would be
/// below a black one.
TEST_F(ImplicitVisibilityTest, ADoubleSidedLampDoesNotLightItself) {
  const auto below = [](float reflectance, const char* glossyBins) {
    scene::Scene scene;
    test::show(scene, test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4},
                                 test::addMaterial(scene, test::lambertian(0.5f))));
    scene::Material emissive = test::lambertian(reflectance);
    emissive.emission = glm::vec3(10);
    emissive.doubleSided = true;
    scene::Primitive lamp = test::quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}, test::addMaterial(scene, emissive));
    lamp.emissiveParts = {{{.sideU = {1, 0, 0}, .sideV = {0, 0, -1}}}};
    test::show(scene, lamp,
               glm::rotate(glm::translate(glm::mat4(1), {0.37f, 1.71f, -0.23f}), 0.4f, {0.6f, 0.3f, 0.8f}));
    render::Renderer renderer(device(), scene);
    return picture(
        renderer,
        settings(48, 36, Term::indirect,
                 {technique("implicit_visibility",
                            {{"bins", "8"}, {"longest_edge", "0.1"}, {"glossy_bins", glossyBins}})}),
        scene::lookAt({0, 1, 0.01f}, {0, 0, 0}, 0.8f));
  };
  for (const char* glossyBins : {"0", "4"})
    EXPECT_EQ(rmse(below(0.5f, glossyBins), below(0, glossyBins)), 0) << glossyBins;
}

class ImplicitVisibilityBallTest : public test::BallTest {};

/// A sun is farther than all that may hide it, wherever the world's origin is: in the floor, or 3 m along its
/// light or against it. The 204 points of the sun's disc that pixels test leave V an RMS error of 0.0055
/// here.
TEST_F(ImplicitVisibilityBallTest, ShadowsOfASunDoNotDependOnTheOrigin) {
  std::vector<test::Answer> answers;
  for (const float along : {0.f, 3.f, -3.f}) {
    test::BallScene s;
    const glm::vec3 offset = along * s.pose.lights[2].direction;
    s.pose.instances.clear();
    s.pose.bounds = {};
    for (const int mesh : {0, 1})
      test::addInstance(s.scene, s.pose, mesh,
                        glm::translate(glm::mat4(1), offset + glm::vec3(0, static_cast<float>(mesh), 0)));
    s.camera = scene::lookAt(offset + glm::vec3(0, 6, 3), offset + glm::vec3(0, 0.2f, 0), 0.8f);
    test::Answer v = visibility("implicit_visibility", {}, s.scene, s.pose, s.camera, {2});
    answers.push_back(v);
    v.lights.insert(v.lights.begin(), 2, {});
    const test::Errors e = floorErrors(s, v, 2, [&](const glm::vec3& from, const glm::vec3& to) {
      return test::ballHides(from - offset, to);
    });
    std::printf("sun, %g m from the origin: RMS error of V %.4f\n", double(along), e.rms);
    EXPECT_GT(e.penumbra, 50) << along;
    EXPECT_LT(e.rms, 0.02) << along;
  }
  for (const test::Answer& moved : {answers[1], answers[2]}) {
    double squares = 0, count = 0;
    for (size_t i = 0; i < moved.instance.size(); ++i) {
      if (moved.instance[i] != 0 || answers[0].instance[i] != 0) continue;  // the floor
      squares += std::pow(double{moved.lights[0][i]} - answers[0].lights[0][i], 2);
      ++count;
    }
    EXPECT_GT(count, side * side / 2);
    EXPECT_LT(std::sqrt(squares / count), 1e-3);
  }
}

}  // namespace
}  // namespace limn
