// Media that are not homogeneous, and spots that shine through textures: against closed forms, the
// homogeneous medium and the reference.
#include <fmt/format.h>

#include <cmath>

#include "core/bench/private/stress_scene.h"
#include "core/scene/density_grid.h"
#include "tests/gpu/media_harness.h"
#include "tests/support/density_grids.h"

namespace limn {
namespace {

class InhomogeneousMediaTest : public MediaHarness {
 protected:
  /// The whole picture, with buffers of that size: marching through a grid costs much in software.
  static std::vector<render::TechniqueUse> all(const char* size = "64") {
    return {technique("hard_shadow_map"), technique("airlight"),
            technique("surface_caustics", {{"buffer_size", size}}),
            technique("volume_caustics", {{"buffer_size", size}})};
  }

  static double meanOf(const Image& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) sum += double(image.at(x, y, channel));
    return sum / (double(image.width()) * image.height());
  }

  static double rmseOf(const Image& a, const Image& b) {
    double sum = 0;
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x)
        for (int c = 0; c < 3; ++c) sum += std::pow(double(a.at(x, y, c)) - double(b.at(x, y, c)), 2);
    return std::sqrt(sum / (3.0 * a.width() * a.height()));
  }
};

TEST_F(InhomogeneousMediaTest, AGridOfOneDensityIsHomogeneous) {
  scene::Scene homogeneous = asset("glass_sphere");
  scene::Scene grid = homogeneous;
  grid.medium.sigmaA *= 0.5f;
  grid.medium.sigmaS *= 0.5f;
  scene::setGrid(grid.medium, test::constantGrid(scene::evaluate(grid, 0).bounds, 2));
  render::Renderer a(device(), homogeneous), b(device(), grid);
  for (const Term term : {Term::media, Term::caustic, Term::direct, Term::final}) {
    const Image one = picture(a, settings(width, height, term, all()));
    const Image other = picture(b, settings(width, height, term, all()));
    EXPECT_NEAR(mean(other) / mean(one), 1, 1e-3) << name(term);
    EXPECT_LT(rmseOf(one, other) / mean(one), 1e-3) << name(term);
  }
  EXPECT_EQ(stateOf(a, "core", "smoke"), "unknown");
}

/// A GPU's weights between two texels have 8 bits: the density is off by up to 1/512 of a step of the grid.
TEST_F(InhomogeneousMediaTest, ARampAttenuatesSurfacesByItsIntegral) {
  const double tolerance = device().software() ? 2e-3 : 5e-3;
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  render::Renderer clear(device(), scene);
  const Image before = picture(clear, settings(width, height, Term::direct));
  const scene::Bounds bounds = scene::evaluate(scene, 0).bounds;
  const float radius = bounds.radius();
  const glm::vec3 centre = bounds.centre();
  scene::Scene dim = scene;
  dim.medium.sigmaA = glm::vec3(0.05f, 0.2f, 0.8f);
  scene::setGrid(dim.medium,
                 test::gridOf({2, 64, 2}, centre - 1.1f * radius, centre + 1.1f * radius,
                              [&](const glm::vec3& p) { return p.y - centre.y + 1.2f * radius; }));
  render::Renderer renderer(device(), dim);
  const Image after = picture(renderer, settings(width, height, Term::direct));
  const Image truth = reference(renderer, dim, Term::direct, 2);
  int compared = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!(before.at(x, y, 0) > 1e-3f) || !(truth.at(x, y, 0) > 1e-6f)) continue;
      ++compared;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(double(after.at(x, y, c)), double(truth.at(x, y, c)),
                    tolerance * double(before.at(x, y, c)))
            << x << " " << y;
    }
  EXPECT_GT(compared, 1000);
}

/// A layer of one voxel, 0.035 m, that lies between the lamp and the ball and on no other way of light
/// takes 1 - exp(-1.5) of it. Of 32 points across the box, 0.14 m apart, half the ways to the
/// ball have none in it, and 2.5 times the light would pass; of 256 each way has four.
TEST_F(InhomogeneousMediaTest, AThinLayerBeforeGlassTakesItsShare) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium = {};
  scene.medium.sigmaA = glm::vec3(40);
  scene::setGrid(scene.medium,
                 test::gridOf({2, 128, 2}, glm::vec3(-3, 0, -3), glm::vec3(3, 4.5f, 3),
                              [](const glm::vec3& p) { return p.y > 2.99f && p.y < 3.02f ? 1.f : 0.f; }));
  render::Renderer renderer(device(), scene);
  const Image ours = picture(renderer, settings(width, height, Term::caustic,
                                                {technique("surface_caustics", {{"medium_steps", "256"}})}));
  EXPECT_NEAR(mean(ours) / mean(reference(renderer, scene, Term::caustic, 64)), 1, 0.05);
}

TEST_F(InhomogeneousMediaTest, SmokeIsAsBrightAsTheReference) {
  const scene::Scene scene = asset("smoke");
  render::Renderer renderer(device(), scene);
  const auto ratio = [&](Term term, std::vector<render::TechniqueUse> techniques, int spp) {
    const Image ours = picture(renderer, settings(width, height, term, std::move(techniques)));
    return mean(ours) / mean(reference(renderer, scene, term, spp));
  };
  EXPECT_NEAR(ratio(Term::media, all("128"), 16), 1, 0.02);
  EXPECT_NEAR(ratio(Term::final, all("128"), 16), 1, 0.02);
  EXPECT_NEAR(ratio(Term::direct, {technique("sampled_area_light", {{"samples", "1"}})}, 2), 1, 0.02);
  EXPECT_NEAR(ratio(Term::caustic, all("256"), 64), 1, 0.1);
}

TEST_F(InhomogeneousMediaTest, MoreStepsComeNearerToTheTruth) {
  const scene::Scene scene = asset("smoke");
  render::Renderer renderer(device(), scene);
  const auto scattered = [&](const char* steps) {
    return picture(renderer,
                   settings(width, height, Term::media,
                            {technique("volume_caustics", {{"medium_steps", steps}, {"buffer_size", "48"}}),
                             technique("airlight", {{"medium_steps", steps}})}));
  };
  const Image truth = scattered("64");
  double last = 1;
  for (const char* steps : {"2", "6", "18"}) {
    const double error = rmseOf(scattered(steps), truth) / mean(truth);
    EXPECT_LT(error, 0.6 * last) << steps;
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

/// Stretches of a ray with ways through a grid at their nodes, of which one pass holds a part in software.
TEST_F(InhomogeneousMediaTest, AirlightOfManyStretchesAndStepsIsAllThere) {
  const scene::Scene scene = asset("smoke");
  render::Renderer renderer(device(), scene);
  const auto scattered = [&](const char* steps, const char* mediumSteps) {
    return picture(renderer,
                   settings(16, 12, Term::media,
                            {technique("airlight", {{"steps", steps}, {"medium_steps", mediumSteps}})}));
  };
  const Image few = scattered("128", "64"), many = scattered("1024", "256");
  EXPECT_LT(rmseOf(many, few) / mean(few), 0.02);
}

TEST_F(InhomogeneousMediaTest, SmokeIsMadeAnewWhenTimeGoesOnAndNotElse) {
  const scene::Scene scene = asset("smoke");
  render::Renderer renderer(device(), scene);
  render::Settings s = settings(width, height, Term::media, {technique("airlight")});
  s.dynamic = false;
  const Image first = picture(renderer, s);
  renderer.render();
  const auto smoke = [&] {
    for (const auto& report : renderer.explain())
      if (report.name == "smoke") return report.state;
    return frame::PassState::leftOut;
  };
  EXPECT_EQ(smoke(), frame::PassState::cached);
  EXPECT_TRUE(sameBits(first, renderer.read()));
  const int64_t compiled = device().counters().programsCompiled;
  renderer.setTime(1);
  renderer.render();
  EXPECT_EQ(smoke(), frame::PassState::run);
  const Image later = renderer.read();
  EXPECT_GT(rmseOf(first, later) / mean(first), 0.05);
  EXPECT_EQ(device().counters().programsCompiled, compiled);
  renderer.setTime(0);
  renderer.render();
  EXPECT_TRUE(sameBits(first, renderer.read())) << "the same time is the same smoke";
}

TEST_F(InhomogeneousMediaTest, AGridOfZerosIsTheSamePictureBitForBit) {
  scene::Scene scene = asset("glass_sphere");
  scene::Scene clear = scene;
  clear.medium = {};
  scene::setGrid(scene.medium, test::constantGrid(scene::evaluate(scene, 0).bounds, 0));
  render::Renderer with(device(), scene), without(device(), clear);
  EXPECT_TRUE(sameBits(picture(with, settings(width, height, Term::final, all())),
                       picture(without, settings(width, height, Term::final, all()))));
  EXPECT_EQ(stateOf(with, "airlight", "airlight"), "no medium scatters light");
  EXPECT_EQ(stateOf(with, "core", "transmittance"), "the scene has no medium");
}

TEST_F(InhomogeneousMediaTest, ScaleDoesNotMatter) {
  const scene::Scene scene = asset("smoke");
  render::Renderer renderer(device(), scene);
  const Image usual = picture(renderer, settings(width, height, Term::final, all()));
  for (const double factor : {1e-4, 1e4}) {
    const scene::Scene scaled = bench::stressed(scene, StressChange::sceneScale, factor);
    render::Renderer other(device(), scaled);
    EXPECT_NEAR(mean(picture(other, settings(width, height, Term::final, all()))) / mean(usual), 1, 2e-3)
        << factor;
  }
}

TEST_F(InhomogeneousMediaTest, ExtremesGiveFinitePictures) {
  for (const float thickness : {0.f, 1e-3f, 10.f, 1000.f}) {
    scene::Scene scene = asset("smoke");
    scene.medium.sigmaS = glm::vec3(thickness / 3);
    scene.medium.sigmaA = glm::vec3(0);
    render::Renderer renderer(device(), scene);
    for (const float g : {-0.99f, 0.99f}) {
      SCOPED_TRACE(fmt::format("thickness {} g {}", thickness, g));
      scene.medium.g = g;  // which the renderer reads in each frame
      const Image image = picture(renderer, settings(width, height, Term::media, all()));
      expectWithin(image, 0, 1e4f);
      if (thickness == 0) {
        EXPECT_EQ(mean(image), 0);
      }
    }
  }
}

/// Lines stand alone: of all light a black picture of them would pass as a part.
TEST_F(InhomogeneousMediaTest, LinesAloneAreTheReferencesAtExtremes) {
  for (const auto& [thickness, g] : {std::pair(1e-3f, 0.9f), std::pair(10.f, -0.9f)}) {
    SCOPED_TRACE(fmt::format("thickness {} g {}", thickness, g));
    scene::Scene scene = asset("smoke");
    scene.medium.sigmaS = glm::vec3(thickness / 3);
    scene.medium.sigmaA = glm::vec3(0);
    scene.medium.g = g;
    render::Renderer renderer(device(), scene);
    const Image lines = picture(
        renderer, settings(64, 48, Term::media, {technique("volume_caustics", {{"buffer_size", "64"}})}));
    EXPECT_NEAR(mean(lines) / meanOfLines(renderer, scene), 1, 0.1);
  }
}

TEST_F(InhomogeneousMediaTest, TexturedSpotsAreAsTheReferenceHasThem) {
  const scene::Scene scene = asset("stained_light");
  ASSERT_EQ(scene.lightTextures.size(), 1u);
  render::Renderer renderer(device(), scene);
  struct Question {
    Term term;
    std::vector<render::TechniqueUse> techniques;
    int spp;
    double within;
  };
  const Question questions[] = {
      {Term::direct, {technique("hard_shadow_map")}, 2, 0.01},
      {Term::direct, {technique("sampled_area_light", {{"samples", "1"}})}, 2, 0.01},
      {Term::media, {technique("airlight"), technique("volume_caustics")}, 32, 0.02},
      {Term::caustic, {technique("surface_caustics")}, 64, 0.1}};
  for (const Question& q : questions) {
    const Image ours = picture(renderer, settings(width, height, q.term, q.techniques));
    const Image truth = reference(renderer, scene, q.term, q.spp);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(meanOf(ours, c) / meanOf(truth, c), 1, q.within) << name(q.term) << " channel " << c;
  }
  scene::Scene plain = scene;
  for (scene::LightSource& light : plain.lights) light.texture = scene::kNone;
  plain.lightTextures.clear();
  render::Renderer white(device(), plain);
  const Image lit = picture(white, settings(width, height, Term::media, {technique("airlight")}));
  const Image stained = picture(renderer, settings(width, height, Term::media, {technique("airlight")}));
  EXPECT_LT(meanOf(stained, 1), 0.6 * meanOf(lit, 1)) << "the window takes light away";
}

}  // namespace
}  // namespace limn
