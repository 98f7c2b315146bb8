// What indirect light gathered from virtual point lights promises beyond what every technique does.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/image/metrics.h"
#include "core/reference/reference.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

class IndirectPictureTest : public RenderTest {
 protected:
  Image indirect(render::Renderer& renderer, const std::string& name,
                 const std::vector<std::pair<std::string, std::string>>& values) {
    return picture(renderer, settings(96, 72, Term::indirect, {technique(name, values)}));
  }
};

TEST_F(IndirectPictureTest, SplittingAndMergingChangesNothing) {
  const scene::Scene scene = asset("lights");
  render::Renderer renderer(device(), scene);
  for (const char* block : {"3", "8"}) {
    const Image addressed = indirect(renderer, "reflective_shadow_map", {{"vpls", "300"}, {"block", block}});
    const Image split = indirect(renderer, "reflective_shadow_map",
                                 {{"vpls", "300"}, {"block", block}, {"interleaving", "split"}});
    EXPECT_TRUE(std::ranges::equal(addressed.data(), split.data())) << block;
  }
}

/// Each pixel of a block has other virtual lights, all of them together every one; where N is not divisible,
/// too.
TEST_F(IndirectPictureTest, InterleavingKeepsTheMean) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto mean = [&](const char* vpls, const char* block, const char* blur) {
    return IndirectPictureTest::mean(indirect(
        renderer, "reflective_shadow_map",
        {{"vpls", vpls}, {"block", block}, {"blur", blur}, {"clamp", "0.05"}, {"compensation", "false"}}));
  };
  for (const char* vpls : {"1024", "777"}) {
    const double all = mean(vpls, "1", "false");
    EXPECT_NEAR(mean(vpls, "8", "false") / all, 1, 0.02) << vpls;
    EXPECT_NEAR(mean(vpls, "8", "true") / all, 1, 0.02) << vpls;
    EXPECT_NEAR(mean(vpls, "5", "true") / all, 1, 0.02) << vpls;
  }
  EXPECT_NEAR(mean("1", "8", "false") / mean("1", "1", "false"), 1, 1e-6) << "no more pixels than lights";
}

/// A pixel's own lights are bounded as one sub-buffer of 64; with those that the blur brings it gets what is
/// between that bound and the one of all lights. Shares of unbounded light, so that the virtual lights' noise
/// does not count: without the blur's part a tenth is missing.
TEST_F(IndirectPictureTest, InterleavingKeepsTheBoundOfAHistory) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  using Values = std::vector<std::pair<std::string, std::string>>;
  for (const char* bound : {"distance", "patch"}) {
    const auto kept = [&](const char* block) {
      const auto mean = [&](const Values& bounds) {
        Values values{{"block", block}, {"history", "4"}};
        values.insert(values.end(), bounds.begin(), bounds.end());
        return IndirectPictureTest::mean(indirect(renderer, "reflective_shadow_map", values));
      };
      return mean({{"bound", bound}, {"clamp", "0.05"}}) / mean({{"bound", "distance"}, {"clamp", "0"}});
    };
    EXPECT_NEAR(kept("8"), kept("1"), 0.03) << bound;
  }
}

/// Pixels at edges are lit as though nothing were interleaved; where nothing is, there are none.
TEST_F(IndirectPictureTest, EdgesGetAllVirtualLights) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto lit = [&](const char* block, const char* edges, std::pair<std::string, std::string> other) {
    return indirect(renderer, "instant_radiosity",
                    {{"vpls", "256"}, {"map_size", "64"}, {"block", block}, {"edges", edges}, other});
  };
  const auto same = [](const Image& a, const Image& b) { return std::ranges::equal(a.data(), b.data()); };
  const std::pair<std::string, std::string> plain("history", "1");
  const Image all = lit("1", "0", plain), none = lit("8", "0", plain);
  EXPECT_TRUE(same(all, lit("1", "0.01", plain))) << "nothing is interleaved";
  EXPECT_TRUE(same(lit("8", "0", {"blur", "false"}), lit("8", "0.01", {"blur", "false"})))
      << "nothing is blurred";
  const Image some = lit("8", "0.1", plain);
  EXPECT_LT(rmse(some, all), 0.7 * rmse(none, all));
  EXPECT_TRUE(same(some, lit("8", "0.1", {"interleaving", "split"})));
  EXPECT_LT(rmse(lit("8", "1e-6", plain), all), 0.1 * rmse(none, all)) << "nearly all pixels are edges";
  for (const char* bound : {"distance", "patch"})
    for (const char* compensation : {"false", "true"}) {
      const auto also = [&](const char* block, const char* edges) {
        return indirect(renderer, "instant_radiosity",
                        {{"vpls", "256"},
                         {"map_size", "64"},
                         {"block", block},
                         {"edges", edges},
                         {"bound", bound},
                         {"compensation", compensation}});
      };
      const Image truth = also("1", "0");
      EXPECT_LT(rmse(also("8", "1e-6"), truth), 0.5 * rmse(also("8", "0"), truth)) << bound << compensation;
    }
}

/// With highlights, too: their part is not blurred away from what all lights give.
TEST_F(IndirectPictureTest, EdgesOfGlossySurfacesGetAllVirtualLights) {
  const scene::Scene scene = asset("glossy_sphere");
  render::Renderer renderer(device(), scene);
  const auto lit = [&](const char* block, const char* edges) {
    return indirect(renderer, "imperfect_shadow_maps", {{"vpls", "128"}, {"block", block}, {"edges", edges}});
  };
  const Image all = lit("1", "0");
  EXPECT_LT(rmse(lit("8", "1e-6"), all), 0.5 * rmse(lit("8", "0"), all));
}

TEST_F(IndirectPictureTest, CompensationGivesBackWhatTheClampTakes) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto mean = [&](const char* clamp, const char* compensation) {
    return IndirectPictureTest::mean(
        indirect(renderer, "reflective_shadow_map",
                 {{"vpls", "4096"}, {"block", "1"}, {"clamp", clamp}, {"compensation", compensation}}));
  };
  const double all = mean("0", "false");
  for (const char* clamp : {"0.03", "0.1"}) {
    EXPECT_LT(mean(clamp, "false"), 0.995 * all) << clamp;
    EXPECT_NEAR(mean(clamp, "true") / all, 1, 0.05) << clamp;
  }
}

TEST_F(IndirectPictureTest, ShadowsOfVirtualLightsOnlyTakeLightAway) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const std::vector<std::pair<std::string, std::string>> values{
      {"vpls", "128"}, {"block", "1"}, {"compensation", "false"}};
  const Image open = indirect(renderer, "reflective_shadow_map", values);
  const Image shadowed = indirect(renderer, "instant_radiosity", values);
  int brighter = 0;
  for (size_t i = 0; i < open.data().size(); ++i)
    brighter += shadowed.data()[i] > open.data()[i] * (1 + 1e-5f);
  EXPECT_EQ(brighter, 0);
  EXPECT_LT(mean(shadowed), 0.95 * mean(open));
  EXPECT_GT(mean(shadowed), 0.5 * mean(open));
}

/// Against path tracing, of one bounce, with the same 1024 virtual lights. The reference's noise is about 2 %
/// of the light, a ninth of the least error.
TEST_F(IndirectPictureTest, ErrorFallsWithTheNumberOfAreaLights) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  reference::Request asked = test::request(renderer, scene, {96, 72}, Term::indirect, 1024);
  asked.bounces = 1;
  const Image truth = reference::render(asked).image;
  CompareOptions options;
  options.maxMaskedShare = 0.02;
  std::vector<double> errors;
  std::string all;
  for (const char* vals : {"5", "10", "30", "100"}) {
    const Image seen = indirect(renderer, "clustered_visibility", {{"vpls", "1024"}, {"vals", vals}});
    errors.push_back(compareImages(seen, truth, options).rmse);
    all += fmt::format("{} area lights: RMSE {:.5f}; ", vals, errors.back());
  }
  for (size_t i = 1; i < errors.size(); ++i) EXPECT_LE(errors[i], 1.03 * errors[i - 1]) << all;
  EXPECT_LE(errors[2], 0.6 * errors[0]) << all;
}

/// A medium takes as much of the picture as of the reference, within what differs between the lamp's centre
/// and its other points. Without it on the lights' way the picture would keep about twice as much. Each
/// reference's mean has a noise below 0.5 %.
TEST_F(IndirectPictureTest, AMediumTakesAsMuchAsInTheReference) {
  scene::Scene scene = asset("cornell_box");
  const auto means = [&] {
    render::Renderer renderer(device(), scene);
    reference::Request asked = test::request(renderer, scene, {96, 72}, Term::indirect, 256);
    asked.bounces = 1;
    return std::pair(mean(indirect(renderer, "instant_radiosity", {{"vpls", "512"}, {"map_size", "64"}})),
                     mean(reference::render(asked).image.select({"R", "G", "B"})));
  };
  const auto [clear, clearTruth] = means();
  scene.medium.sigmaA = glm::vec3(0.5f);
  const auto [taken, takenTruth] = means();
  EXPECT_LT(takenTruth, 0.5 * clearTruth);
  EXPECT_NEAR((taken / clear) / (takenTruth / clearTruth), 1, 0.05);
}

TEST_F(IndirectPictureTest, BatchesOfMapsGiveTheSamePicture) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  for (const char* block : {"1", "4"}) {
    const Image once = indirect(renderer, "instant_radiosity",
                                {{"vpls", "90"}, {"map_size", "256"}, {"memory", "512"}, {"block", block}});
    const Image batches = indirect(renderer, "instant_radiosity",
                                   {{"vpls", "90"}, {"map_size", "256"}, {"memory", "16"}, {"block", block}});
    EXPECT_LT(rmse(once, batches), 1e-5 * mean(once)) << block;
  }
}

/// 128 MiB, the storage block that OpenGL promises, hold 128 maps of 512 texels. Splats that grow by less
/// than the maps leave holes: there is more light than behind those of smaller maps, and less than without
/// any.
TEST_F(IndirectPictureTest, MapsOfPointsComeInAsManyBatchesAsTheyNeed) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  const auto light = [&](const char* size, const char* splat) {
    return mean(indirect(renderer, "imperfect_shadow_maps",
                         {{"vpls", "130"}, {"map_size", size}, {"points", "64"}, {"splat", splat}}));
  };
  const double open = mean(indirect(renderer, "reflective_shadow_map", {{"vpls", "130"}}));
  const double large = light("512", "16");
  EXPECT_LT(large, 0.999 * open);
  EXPECT_GT(large, light("64", "4"));
}

TEST_F(IndirectPictureTest, NothingIsRedrawnWhileOnlyTheCameraMoves) {
  for (const float sigma : {0.f, 0.5f}) {
    scene::Scene scene = asset("cornell_box");
    scene.medium.sigmaA = glm::vec3(sigma);
    render::Renderer renderer(device(), scene);
    render::Settings s = settings(64, 48, Term::indirect, {technique("instant_radiosity", {{"vpls", "16"}})});
    s.dynamic = false;
    picture(renderer, s);
    renderer.setCamera(renderer.pose().cameras.at(1));
    renderer.render();
    std::vector<std::string> kept;
    for (const auto& pass : renderer.explain())
      if (pass.technique == "indirect" || pass.technique == "shadow" || pass.name == "paraboloid maps") {
        EXPECT_EQ(pass.state, frame::PassState::cached) << pass.name << ", medium of " << sigma;
        kept.push_back(pass.technique + " " + pass.name);
      }
    EXPECT_THAT(kept, testing::IsSupersetOf({"shadow reflective shadow maps", "indirect virtual lights",
                                             "instant_radiosity paraboloid maps"}))
        << sigma;
  }
}

}  // namespace
}  // namespace limn
