// What soft shadows from variance shadow maps (vssm, savsm) promise beyond what every technique does.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <tuple>

#include "core/base/error.h"
#include "glsl/light/light_view.glsl"
#include "tests/gpu/planes_scene.h"
#include "tests/gpu/render_test.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

using Settings = std::map<std::string, std::string>;

class VarianceTechniqueTest : public PlanesTest {};

const Settings kVariants[] = {{{"subdivision", "uniform"}}, {{"subdivision", "adaptive"}},
                              {{"subdivision", "mixed"}},   {{"chebyshev", "pooled"}},
                              {{"search_rounds", "1"}},     {{"sat_bits", "15"}, {"sat_words", "1"}},
                              {{"sat_bits", "20"}},         {{"contact", "jittered"}},
                              {{"bounds", "nbuffer"}},      {{"bounds", "mip"}}};

TEST_F(VarianceTechniqueTest, ParallelPlanesAreExact) {
  // A square of side 1, one metre over the floor, under a light of side 0.8 at 4 metres.
  Planes s;
  s.addPlane(0.5f, at(0, 1, 0));
  for (Settings settings : kVariants) {
    settings["shadow_map_size"] = "1024";
    const Answer v = answer(s, settings);
    double squares = 0;
    int penumbra = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
        const vec3 p = s.position(v, x, y);
        const float exact = 1 - hiddenShare(p.x, 0.8f) * hiddenShare(p.z, 0.8f);
        if (exact < 0.02f || exact > 0.98f) continue;
        squares += std::pow(double{v.at(0, x, y)} - exact, 2);
        EXPECT_NEAR(v.at(0, x, y), exact, 0.06f) << p.x << " " << p.z << " " << settings.begin()->second;
        ++penumbra;
      }
    }
    EXPECT_GT(penumbra, 100);
    EXPECT_LT(std::sqrt(squares / penumbra), 0.012) << settings.begin()->second;
  }
}

TEST_F(VarianceTechniqueTest, KernelsThatAreAllLitOrAllBlockedAreExact) {
  for (const char* name : {"vssm", "savsm"}) {
    const Answer lit = answer(Planes(), {}, name);
    EXPECT_EQ(*std::ranges::min_element(lit.lights[0]), 1.f) << name;
    Planes roof;
    roof.addPlane(3, at(0, 2, 0));
    roof.camera = scene::lookAt({0, 1, 3}, {0, 0, 0}, 0.8f);
    const Answer dark = answer(roof, {}, name);
    int floor = 0;
    for (size_t i = 0; i < dark.instance.size(); ++i) {
      if (dark.instance[i] != 0) continue;
      ++floor;
      ASSERT_EQ(dark.lights[0][i], 0.f) << name;
    }
    EXPECT_GT(floor, 1000) << name;
  }
}

/// The horizon of a wall cuts the light along its diagonal: what blocks hides a part of the kernel, all of
/// what counts. cssm and moment_soft_shadow_map have a threshold for each part of the kernel, and texels in
/// parts that the horizon cuts, which would let light through.
TEST_F(VarianceTechniqueTest, WhatBlocksHidesTheLightAboveTheHorizon) {
  Planes s;
  s.addPlane(3, at(0, 3, 0));
  const vec3 normal = glm::normalize(vec3(1, 0, 1));
  // Half of the light's diagonal is 0.57 m.
  const glm::mat4 wall = at(0, 1, 0) * glm::translate(glm::mat4(1), -0.15f * normal) *
                         glm::rotate(glm::mat4(1), glm::half_pi<float>(), glm::normalize(vec3(1, 0, -1)));
  s.addPlane(0.8f, wall);
  s.camera = scene::lookAt({2, 1, 2}, {0, 1, 0}, 0.8f);
  for (const auto& [name, most] : {std::pair("vssm", 0.03), std::pair("savsm", 0.03), std::pair("cssm", 0.05),
                                   std::pair("moment_soft_shadow_map", 0.05)}) {
    const Answer v = answer(s, {{"shadow_map_size", "512"}, {"views", "1"}}, name);
    double sum = 0;
    int count = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] != 2) continue;
      sum += double{v.lights[0][i]};
      ++count;
    }
    EXPECT_GT(count, 1000);
    EXPECT_LT(sum / count, most) << name;
  }
}

/// From the floor the square covers 4 x 4 m of the light's 100 x 100, so that V is at least 0.9984. A hard
/// shadow is in so few pixels that their mean is 0.976.
TEST_F(VarianceTechniqueTest, LightsLargerThanTheSceneGiveFaintShadows) {
  Planes s(100, 4);
  s.addPlane(0.5f, at(0, 1, 0));
  std::vector<std::pair<std::string, Settings>> techniques{{"savsm", {}}, {"cssm", {}}};
  for (const Settings& settings : kVariants) techniques.emplace_back("vssm", settings);
  for (const auto& [name, settings] : techniques) {
    const Answer v = answer(s, settings, name);
    float least[] = {1, 1};  // of the floor and the square
    double sum = 0;
    int floor = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] > 1) continue;
      least[v.instance[i]] = std::min(least[v.instance[i]], v.lights[0][i]);
      if (v.instance[i] != 0) continue;
      sum += double{v.lights[0][i]};
      ++floor;
    }
    const std::string what =
        fmt::format("{} {}: least V {} on the floor (mean {:.4f}), {} on the square", name,
                    settings.empty() ? "" : settings.begin()->first + "=" + settings.begin()->second,
                    least[0], sum / floor, least[1]);
    EXPECT_GT(floor, 5000) << what;
    EXPECT_GT(least[0], 0.97f) << what;
    EXPECT_GT(least[1], 0.97f) << what;
    EXPECT_GT(sum / floor, 0.99) << what;
  }
}

TEST_F(VarianceTechniqueTest, DepthRangesOfTenThousandKeepTheirShadows) {
  // A leaf as near to the light as maps show surfaces, and a panel just over the floor, at the other end of
  // the range.
  Planes s(0.2f, 4);
  s.addPlane(1e-6f, at(0, 4 - 4.1e-4f, 0));
  s.addPlane(1.5f, at(0, 0.05f, 0));
  s.camera = scene::lookAt({0, 0.04f, 2.5f}, {0, 0, 0}, 0.8f);  // under the panel
  const Answer v = answer(s, {{"shadow_map_size", "512"}, {"views", "1"}, {"shadow_map_fit", "scene"}});
  ASSERT_EQ(v.maps.size(), 1u);
  EXPECT_GT(v.maps[0].far / v.maps[0].near, 9500.f);
  int lit = 0, umbra = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const vec3 p = s.position(v, x, y);
      if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
      const float aside = std::max(std::abs(p.x), std::abs(p.z));
      if (aside > 1.6f) {
        EXPECT_GT(v.at(0, x, y), 0.9f) << p.x << " " << p.z;
        ++lit;
      }
      if (aside > 0.05f && aside < 1.2f) {  // in the middle the leaf hides the panel from the light's centre
        EXPECT_LT(v.at(0, x, y), 0.1f) << p.x << " " << p.z;
        ++umbra;
      }
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(umbra, 100);
}

TEST_F(VarianceTechniqueTest, SurfacesInContactDoNotShadowEachOtherOrThemselves) {
  Planes s;
  s.addPlane(0.5f, at(0, 4e-6f, 0));  // 1e-6 of the scene's radius
  for (const Settings& settings : kVariants)
    EXPECT_EQ(*std::ranges::min_element(answer(s, settings).lights[0]), 1.f) << settings.begin()->second;
}

TEST_F(VarianceTechniqueTest, ManyDepthLayersStayBetweenDarkAndLight) {
  // Leaves at all heights and angles.
  Planes s(1);
  for (int i = 0; i < 40; ++i) {
    const auto f = static_cast<float>(i);
    s.addPlane(0.15f, at(std::sin(2.4f * f) * 0.6f, 0.3f + 0.05f * f, std::cos(2.4f * f) * 0.6f) *
                          glm::rotate(glm::mat4(1), 1.3f * f, vec3(0.4f, 1, 0.3f)));
  }
  const Answer truth = answer(s, {{"samples", "256"}}, "sampled_area_light");
  for (const Settings& settings : kVariants) {
    const Answer v = answer(s, settings);
    double squares = 0;
    int count = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] != 0 || truth.lights[0][i] > 0.98f) continue;
      squares += std::pow(double{v.lights[0][i]} - truth.lights[0][i], 2);
      ++count;
    }
    EXPECT_GT(count, 300);
    EXPECT_LT(std::sqrt(squares / count), 0.2) << settings.begin()->second;
  }
}

TEST_F(VarianceTechniqueTest, ReceiversSeenEdgeOnByTheLightAreFinite) {
  Planes s;
  // A wall in the plane x = 0, which holds the light's centre.
  s.addPlane(1, at(0, 1, 0) * glm::rotate(glm::mat4(1), glsl::pi / 2, {0, 0, 1}));
  s.camera = scene::lookAt({5, 2, 2}, {0, 1, 0}, 0.6f);
  for (const Settings& settings : kVariants) answer(s, settings);
  answer(s, {}, "savsm");
}

TEST_F(VarianceTechniqueTest, FacesOfAHemicubeCutNoHolesOrPatchesIntoShadows) {
  // A box of walls so near the light that its maps are a hemicube, and a panel whose shadow falls across
  // their edges.
  Planes s(0.5f, 1.8f);
  s.addPlane(2, at(1.5f, 1, 0) * glm::rotate(glm::mat4(1), glsl::pi / 2, {0, 0, 1}));
  s.addPlane(0.3f, at(0.7f, 1.1f, 0));
  s.camera = scene::lookAt({-3, 2, 4}, {0.7f, 0.7f, 0}, 0.8f);
  const Answer truth = answer(s, {{"samples", "256"}}, "sampled_area_light");
  for (const Settings& settings : kVariants) {
    const Answer v = answer(s, settings);
    double squares = 0;
    int shadowed = 0, patches = 0;
    for (size_t i = 0; i < v.instance.size(); ++i) {
      if (v.instance[i] != 0 && v.instance[i] != 1) continue;
      const float expected = truth.lights[0][i], error = v.lights[0][i] - expected;
      patches += std::abs(error) > 0.7f;
      if (expected > 0.98f) continue;
      squares += double{error} * error;
      ++shadowed;
    }
    EXPECT_GT(shadowed, 200);
    EXPECT_LT(std::sqrt(squares / shadowed), 0.1) << settings.begin()->second;
    EXPECT_LT(patches, 10) << settings.begin()->second;
  }
}

TEST_F(VarianceTechniqueTest, EarlyOutsChangeNextToNothing) {
  Planes s;
  s.addPlane(0.5f, at(0, 1, 0));
  for (const char* bounds : {"mip", "nbuffer", "windows"}) {
    const Answer with = answer(s, {{"bounds", bounds}, {"early_out", "on"}}),
                 without = answer(s, {{"bounds", bounds}, {"early_out", "off"}});
    for (size_t i = 0; i < with.instance.size(); ++i)
      ASSERT_NEAR(with.lights[0][i], without.lights[0][i], 1.f / 255) << bounds << " " << i;
  }
}

TEST_F(VarianceTechniqueTest, TighterBoundsChangeNextToNothing) {
  Planes s;
  s.addPlane(0.5f, at(0, 1, 0));
  for (const char* rounds : {"1", "4"}) {
    const Answer mip = answer(s, {{"bounds", "mip"}, {"search_rounds", rounds}});
    for (const char* bounds : {"nbuffer", "windows"}) {
      const Answer tighter = answer(s, {{"bounds", bounds}, {"search_rounds", rounds}});
      for (size_t i = 0; i < mip.instance.size(); ++i)
        ASSERT_NEAR(mip.lights[0][i], tighter.lights[0][i], 1.f / 255) << bounds << " " << i;
    }
  }
}

/// What lies outside the map is unoccluded. The horizon of a wall cuts a wide light, so that the middle of
/// what counts of it lies there: up to one map beyond the map, and up to four.
TEST_F(VarianceTechniqueTest, KernelsAreAsLitAsTheyReachOutOfTheMap) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(0.5f, addMaterial(scene)));
  addMesh(scene, floorPrimitive(1, 0));
  addInstance(scene, pose, 0, at(0, 0.5f, 0) * glm::rotate(glm::mat4(1), -glsl::pi / 2, {0, 0, 1}));
  addInstance(scene, pose, 1, at(0.1f, 2, 0));  // fills the map
  addLight(pose, rectangleLight({0.1f, 4, 0}, {0, -1, 0}, 12.2f, 0.2f));
  const scene::CameraPose camera = scene::lookAt({2, 0.05f, 0}, {0, 0.05f, 0}, 0.3f);
  for (const auto& [wide, ofBound] :
       {std::pair(12.2f, false), {12.2f, true}, {40.2f, false}, {40.2f, true}}) {
    bound = ofBound;
    pose.lights[0].length_u = wide;
    const float reach = 0.1f + 0.5f * wide;  // of the light before the wall
    const Answer v =
        visibility("savsm", {{"shadow_map_size", "256"}, {"shadow_map_fit", "scene"}}, scene, pose, camera);
    int foot = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const vec3 p = positionOf(v, camera, pose.bounds, x, y);
        // Higher up the receiver's depth is less than that of nothing, which Chebyshev's inequality needs.
        if (v.instance[static_cast<size_t>(y * side + x)] != 0 || p.y > 0.03f) continue;
        ++foot;
        const float exact = 1 - 1.1f / reach * (4 - p.y) / (2 - p.y);
        EXPECT_NEAR(v.at(0, x, y), exact, 0.05f) << p.y << " " << wide << " m, bound " << ofBound;
      }
    }
    EXPECT_GT(foot, 200);
  }
}

TEST_F(VarianceTechniqueTest, TablesWhoseSumsMayOverflowAreRefusedInOneLine) {
  struct Case {
    const char *technique, *bits, *words, *instead;
  };
  const Planes s;
  for (const Case& c : {Case{"savsm", "20", "1", "set sat_words=2 or"},
                        {"savsm", "24", "1", "set sat_words=2 sat_bits=22 or"},
                        {"savsm", "24", "2", "set sat_bits=22 or"},
                        {"vssm", "16", "1", "set sat_words=2 or"},
                        {"vssm", "24", "2", "set sat_bits=23 or"}}) {
    const Settings settings{{"sat_bits", c.bits}, {"sat_words", c.words}, {"shadow_map_size", "1024"}};
    EXPECT_THAT(errorOf([&] { answer(s, settings, c.technique); }),
                testing::AllOf(testing::HasSubstr(fmt::format("sat_bits={} sat_words={}", c.bits, c.words)),
                               testing::HasSubstr("1024 x 1024"), testing::HasSubstr(c.instead),
                               testing::Not(testing::HasSubstr("\n"))))
        << c.technique;
  }
}

/// The largest maps of some tables. Wide search kernels find the square from far beyond its penumbra, with as
/// many samples that none misses it from within.
TEST_F(VarianceTechniqueTest, TablesThatAreAcceptedHoldKernelsOfWideLights) {
  Planes s(2, 4);
  s.addPlane(0.5f, at(0, 1, 0));
  s.addPlane(1e-3f, at(0, 3.5f, 0));  // brings the near plane to the light, and covers no texel
  for (const auto& [bits, words, size] :
       {std::tuple("20", "1", "64"), std::tuple("16", "1", "256"), std::tuple("24", "2", "256")}) {
    const Answer v = answer(s,
                            {{"sat_bits", bits},
                             {"sat_words", words},
                             {"shadow_map_size", size},
                             {"shadow_map_fit", "scene"},
                             {"search", "near"},
                             {"blocker_samples", "4096"}},
                            "savsm");
    int lit = 0, umbra = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const vec3 p = s.position(v, x, y);
        if (v.instance[static_cast<size_t>(y * side + x)] != 0) continue;
        const float aside = std::max(std::abs(p.x), std::abs(p.z));
        if (aside > 1.5f) {
          EXPECT_EQ(v.at(0, x, y), 1.f) << p.x << " " << p.z << " sat_bits " << bits;
          ++lit;
        }
        if (aside < 0.1f) {
          EXPECT_LT(v.at(0, x, y), 0.05f) << p.x << " " << p.z << " sat_bits " << bits;
          ++umbra;
        }
      }
    }
    EXPECT_GT(lit, 1000);
    EXPECT_GT(umbra, 5);
  }
}

TEST_F(VarianceTechniqueTest, MapsOfAllSizesWorkOrAreRefusedInOneLine) {
  Planes s;
  s.addPlane(0.5f, at(0, 1, 0));
  for (const char* size : {"64", "513", "2048"}) {
    const Answer v = answer(s, {{"shadow_map_size", size}});
    EXPECT_LT(*std::ranges::min_element(v.lights[0]), 0.05f) << size;
  }
  Planes many(0.5f, 4);
  for (int i = 1; i < 6; ++i) addLight(many.pose, many.pose.lights[0]);
  try {
    answer(many, {{"shadow_map_size", "8192"}});
    FAIL() << "six tables of 1 GiB each were not refused";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("smaller shadow_map_size"));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
  }
}

using VarianceOnScenesTest = RenderTest;

/// Of the whole light, as published.
TEST_F(VarianceOnScenesTest, TighterBoundsAreNoWorseOnBalls) {
  const scene::Scene scene = asset("balls");
  render::Renderer renderer(device(), scene);
  const auto shadow = [&](const render::TechniqueUse& use) {
    return picture(renderer, settings(128, 96, Term::visibility, {use}, 0));
  };
  const Image truth =
                  shadow(technique("sampled_area_light", {{"samples", "256"}, {"shadow_map_size", "512"}})),
              mip = shadow(technique("vssm", {{"views", "1"}, {"bounds", "mip"}})),
              windows = shadow(technique("vssm", {{"views", "1"}, {"bounds", "windows"}})),
              nBuffer = shadow(technique("vssm", {{"views", "1"}, {"bounds", "nbuffer"}}));
  EXPECT_LE(rmse(windows, truth), rmse(mip, truth));
  EXPECT_LE(rmse(nBuffer, truth), rmse(mip, truth));
}

}  // namespace
}  // namespace limn
