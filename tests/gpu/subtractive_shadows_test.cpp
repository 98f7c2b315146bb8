// Subtractive shadows: what holds to the bit, what lies between nothing and the unshadowed light, what blocks
// of pixels cost, and levels of detail.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/scene/material_model.h"
#include "core/shading_maps/shading_maps.h"
#include "glsl/materials/material_model.glsl"
#include "tests/gpu/environment_harness.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using glm::vec3;

constexpr const char* kCombines[] = {"subtract", "ratio", "ratio_split", "add"};

class SubtractiveShadowsTest : public EnvironmentTest {
 protected:
  using Values = std::vector<std::pair<std::string, std::string>>;

  /// With the unshadowed light that core has, unless the values say otherwise.
  static render::TechniqueUse shadows(const Values& values) {
    Values all{{"unshadowed", "prefiltered"}};
    all.insert(all.end(), values.begin(), values.end());
    return technique("subtractive_shadows", all);
  }
  Image direct(render::Renderer& renderer, int width, int height,
               std::vector<render::TechniqueUse> techniques = {}) {
    return picture(renderer, settings(width, height, Term::direct, std::move(techniques)));
  }

  /// The same floor in the middle of a closed room of 20 m, whose walls are seen as well.
  static scene::Scene room() {
    scene::Scene scene = floor();
    const auto wall = [&](const glm::quat& turn, const vec3& middle) {
      scene::Node node;
      node.mesh = 0;
      node.transform.rotation = turn;
      node.transform.translation = middle;
      scene.nodes.push_back(node);
    };
    constexpr float right = 0.5f * glsl::pi;
    wall(glm::angleAxis(2 * right, vec3(1, 0, 0)), {0, 20, 0});
    wall(glm::angleAxis(right, vec3(1, 0, 0)), {0, 10, -10});
    wall(glm::angleAxis(-right, vec3(1, 0, 0)), {0, 10, 10});
    wall(glm::angleAxis(right, vec3(0, 0, 1)), {10, 10, 0});
    wall(glm::angleAxis(-right, vec3(0, 0, 1)), {-10, 10, 0});
    return scene;
  }

  /// Gives the half of the floor on the side of -x another material.
  static scene::Scene halved(scene::Scene scene, const scene::Material& other) {
    scene::Primitive near = scene.meshes[0].primitives[0], far = near;
    near.positions[1].x = near.positions[2].x = far.positions[0].x = far.positions[3].x = 0;
    for (scene::Primitive* half : {&near, &far}) {
      half->bounds = {};
      for (const vec3& v : half->positions) half->bounds.add(v);
    }
    near.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(other);
    scene.nodes[0].mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back({"halves of the floor", {near, far}, {}});
    return scene;
  }
  static scene::Material lambertian(const glm::vec4& colour) {
    scene::Material material;
    material.baseColour = colour;
    material.metallic = material.specularFactor = 0;
    return material;
  }
  /// A grey base under a perfect mirror, which adds all of the light to it.
  static scene::Material mirrored() {
    glsl::MaterialModel model{};
    model.kind = glsl::model_coated;
    model.eta = vec3(1e-3f);
    model.k = vec3(1000);
    model.kd = vec3(0.5f);
    scene::Material material;
    scene::setModel(material, model);
    return material;
  }

  /// A metal ball of radius 1 around the origin instead of the floor, seen from above.
  static scene::Scene ball(const glm::vec4& colour, float roughness) {
    scene::Scene scene = floor();
    scene.materials[0] = metal(colour, roughness);
    scene.meshes[0].primitives[0] = test::spherePrimitive(1, 0);
    return scene;
  }
  static scene::Material metal(const glm::vec4& colour, float roughness) {
    scene::Material material;
    material.baseColour = colour;
    material.metallic = 1;
    material.roughness = roughness;
    return material;
  }

  static double largestDifference(const Image& a, const Image& b) {
    double largest = 0;
    for (size_t i = 0; i < a.data().size(); ++i)
      largest = std::max(largest, static_cast<double>(std::abs(a.data()[i] - b.data()[i])));
    return largest;
  }
  static double largest(const Image& image) {
    return static_cast<double>(*std::ranges::max_element(image.data()));
  }
};

TEST_F(SubtractiveShadowsTest, WhereNothingIsHiddenTheLightIsTheUnshadowedOneToTheBit) {
  const scene::Scene scene = lit(floor(), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image unshadowed = direct(renderer, 37, 23);
  for (const char* combine : {"subtract", "ratio", "ratio_split"})
    for (const char* block : {"1", "2", "4", "32"})
      for (const char* lights : {"1", "25", "200"})
        EXPECT_LE(
            largestDifference(direct(renderer, 37, 23,
                                     {shadows({{"combine", combine}, {"block", block}, {"lights", lights}})}),
                              unshadowed),
            contraction())
            << combine << ' ' << block << ' ' << lights;
}

/// Where a budget of time may change the samples, passes of its own add them up: the first frame has all.
TEST_F(SubtractiveShadowsTest, AddedAtEveryPixelItIsTheSampledEnvironment) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image sampled =
      direct(renderer, 64, 48, {technique("sampled_environment_light", {{"samples", "40"}})});
  const auto added = [&](const char* time, const char* demodulate, const char* memory) {
    return direct(renderer, 64, 48,
                  {shadows({{"combine", "add"},
                            {"block", "1"},
                            {"lights", "40"},
                            {"frame_time", time},
                            {"demodulate", demodulate},
                            {"memory", memory}})});
  };
  EXPECT_EQ(largestDifference(added("0", "true", "256"), sampled), 0);
  for (const char* demodulate : {"true", "false"})
    for (const char* memory : {"256", "16"})
      EXPECT_LT(largestDifference(added("10000", demodulate, memory), sampled), 1e-5 * largest(sampled))
          << demodulate << ' ' << memory;
}

TEST_F(SubtractiveShadowsTest, OfTheSameLightsTheDifferenceIsTheSum) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const auto with = [&](const char* combine) {
    return direct(renderer, 64, 48,
                  {shadows({{"combine", combine},
                            {"block", "1"},
                            {"lights", "40"},
                            {"unshadowed", "lights"},
                            {"unshadowed_factor", "1"}})});
  };
  const Image added = with("add");
  for (const char* combine : {"subtract", "ratio", "ratio_split"})
    EXPECT_LT(largestDifference(with(combine), added), 1e-5 * largest(added)) << combine;
}

TEST_F(SubtractiveShadowsTest, LightLiesBetweenNothingAndTheUnshadowedLight) {
  for (const char* name : {"balls", "fresnel_spheres"}) {
    const scene::Scene scene = lit(coarse(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    const Image unshadowed = direct(renderer, 64, 48);
    for (const char* combine : {"subtract", "ratio", "ratio_split"})
      for (const char* block : {"1", "4"})
        for (const char* lights : {"1", "25"}) {
          const Image picture = direct(
              renderer, 64, 48, {shadows({{"combine", combine}, {"block", block}, {"lights", lights}})});
          for (size_t i = 0; i < picture.data().size(); ++i) {
            EXPECT_GE(picture.data()[i], 0) << name << combine << block;
            EXPECT_LE(picture.data()[i], unshadowed.data()[i] * (1 + 1e-5f)) << name << combine << block;
          }
        }
  }
}

/// U is what is hidden of it and what is left. In the middle of a block the shadow buffer has what is hidden
/// there.
TEST_F(SubtractiveShadowsTest, WhatIsShownAddsUpToTheUnshadowedLight) {
  constexpr int kWidth = 64, kHeight = 48, kSide = 4;
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image unshadowed = direct(renderer, kWidth, kHeight);
  const double most = largest(unshadowed), rounding = 5e-5 * most;  // shares are kept in 16 bits
  for (const char* combine : {"subtract", "ratio", "ratio_split"}) {
    const auto shown = [&](const char* show, const char* block) {
      return direct(
          renderer, kWidth, kHeight,
          {shadows({{"combine", combine}, {"demodulate", "false"}, {"block", block}, {"show", show}})});
    };
    for (const char* block : {"1", "4"}) {
      EXPECT_LE(largestDifference(shown("unshadowed", block), unshadowed), 1e-6 * most) << combine << block;
      Image sum = shown("hidden", block);
      const Image left = shown("light", block);
      EXPECT_GT(largest(sum), 10 * rounding) << combine << block;
      for (size_t i = 0; i < sum.data().size(); ++i) sum.data()[i] += left.data()[i];
      EXPECT_LT(largestDifference(sum, unshadowed), rounding) << combine << block;
    }
    const Image own = shown("hidden", "1"), buffer = shown("shadow_buffer", "4");
    EXPECT_EQ(largestDifference(shown("shadow_buffer", "1"), own), 0) << combine;
    EXPECT_GT(largestDifference(buffer, shown("hidden", "4")), 10 * rounding) << combine;
    // Blocks count from below, rows of the picture from above.
    for (int y = kSide / 2; y < kHeight; y += kSide)
      for (int x = kSide / 2; x < kWidth; x += kSide)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(buffer.at(x, kHeight - 1 - y, c), own.at(x, kHeight - 1 - y, c), rounding)
              << combine << ' ' << x << ' ' << y;
  }
  EXPECT_THAT(errorOf([&] {
                render::Renderer refused(device(), scene);
                direct(refused, kWidth, kHeight, {shadows({{"combine", "add"}, {"show", "hidden"}})});
              }),
              testing::HasSubstr("show goes with combine=subtract"));
}

TEST_F(SubtractiveShadowsTest, NoLightGetsIntoAClosedRoom) {
  const scene::Scene scene = lit(room(), sky(), 0);
  render::Renderer renderer(device(), scene);
  const double unshadowed = largest(direct(renderer, 32, 24));
  EXPECT_GT(unshadowed, 0.1);
  for (const char* combine : {"ratio", "ratio_split", "add"})
    for (const char* block : {"1", "4"})
      EXPECT_LT(largest(direct(renderer, 32, 24, {shadows({{"combine", combine}, {"block", block}})})),
                1e-5 * unshadowed)
          << combine << ' ' << block;
}

/// Blocks of a surface without diffuse light, or without some channel of it, tell those beside them what is
/// hidden there.
TEST_F(SubtractiveShadowsTest, NoLightGetsInBesideMetalsAndPureColours) {
  for (const scene::Material& other :
       {metal(glm::vec4(1), 0.5f), lambertian({1, 0, 0, 1}), lambertian({0, 0, 0, 1})}) {
    const scene::Scene scene = lit(halved(room(), other), sky(), 0);
    render::Renderer renderer(device(), scene);
    const double unshadowed = largest(direct(renderer, 32, 24));
    EXPECT_GT(unshadowed, 0.1);
    for (const char* combine : {"ratio", "ratio_split"})
      EXPECT_LT(largest(direct(renderer, 32, 24, {shadows({{"combine", combine}, {"block", "4"}})})),
                1e-5 * unshadowed)
          << combine << ' ' << other.metallic << ' ' << other.baseColour.r;
  }
}

/// A block beside a black one subtracts, or adds, as much as it would alone.
TEST_F(SubtractiveShadowsTest, BlackSurfacesLeaveTheirNeighboursLightAlone) {
  const scene::Scene scene = lit(halved(floor(), lambertian({0, 0, 0, 1})), uniform(1), 0);
  render::Renderer renderer(device(), scene);
  const Image picture = direct(renderer, 32, 24, {shadows({{"combine", "add"}, {"block", "4"}})});
  const float far = picture.at(31, 12, 0);
  EXPECT_GT(far, 0.5f);
  for (int x = 17; x < 32; ++x) EXPECT_NEAR(picture.at(x, 12, 0), far, 1e-4f) << x;
}

/// Half a floor of coats, on the side of -x, and half a glossy one: what is hidden of the coats' mirror is a
/// share, and that of lobes is light.
TEST_F(SubtractiveShadowsTest, CoatsAndLobesSideBySideKeepTheirOwnShadows) {
  scene::Scene bare = floor();
  bare.materials[0].specularFactor = 1;
  bare.materials[0].roughness = 0.3f;
  bare = halved(bare, mirrored());
  const auto shadowed = [&](const scene::Scene& scene, const char* combine) {
    render::Renderer renderer(device(), scene);
    return direct(renderer, 32, 24, {shadows({{"combine", combine}, {"block", "4"}})});
  };
  const auto unshadowed = [&](const scene::Scene& scene) {
    render::Renderer renderer(device(), scene);
    return direct(renderer, 32, 24);
  };
  const scene::Scene weak = lit(bare, uniform(1e-3f), 0), strong = lit(bare, uniform(10), 0);
  const Image open = unshadowed(weak);
  for (const char* combine : {"subtract", "ratio", "ratio_split"})
    EXPECT_LE(largestDifference(shadowed(weak, combine), open), 1e-6 * largest(open)) << combine;
  // A roof over the coats leaves the glossy floor beside it half of the sky.
  scene::Scene roofed = weak;
  scene::Node roof;
  roof.mesh = static_cast<int>(roofed.meshes.size());
  roof.transform.translation.y = 6;
  roofed.meshes.push_back({"roof", {roofed.meshes.back().primitives.front()}, {}});
  roofed.nodes.push_back(roof);
  const Image beside = shadowed(roofed, "subtract");
  for (int x = 17; x < 22; ++x) EXPECT_GT(beside.at(x, 12, 0), 0.2f * open.at(x, 12, 0)) << x;
  // All of what coats mirror is added, also beside bright lobes.
  const Image bright = unshadowed(strong), added = shadowed(strong, "add");
  for (int x = 4; x < 15; ++x)
    EXPECT_NEAR(added.at(x, 12, 0), bright.at(x, 12, 0), 0.1f * bright.at(x, 12, 0)) << x;
}

TEST_F(SubtractiveShadowsTest, BatchesOfAnySizeGiveTheSamePicture) {
  for (const char* name : {"balls", "fresnel_spheres"}) {
    const scene::Scene scene = lit(coarse(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    for (const char* combine : kCombines)
      for (const char* block : {"1", "4"}) {
        // Of coats one way to combine is enough: all hand on the same sums.
        if (name != std::string_view("balls") && combine != std::string_view("ratio_split")) continue;
        const auto with = [&](const char* memory) {
          return direct(renderer, 64, 48,
                        {shadows({{"combine", combine},
                                  {"block", block},
                                  {"lights", "40"},
                                  {"shadow_map_size", "256"},
                                  {"memory", memory}})});
        };
        // Shares are kept in 16 bits.
        EXPECT_LT(rmse(with("4"), with("256")), 2e-5) << name << combine << block;
      }
  }
}

/// Where surfaces have one colour, blocks that share light with it or without give the same picture. The lobe
/// is a tenth of the light of the floor. The ball reflects blue by Fresnel's term alone, next to nothing of
/// it where it faces the viewer.
TEST_F(SubtractiveShadowsTest, WeakLobesAreSharedWithoutTheirColours) {
  glsl::MaterialModel model{};
  model.kind = glsl::model_phong;
  model.kd = vec3(0.3f);
  model.ks = vec3(0.03f);
  model.exponent = 5;
  scene::Scene plane = floor();
  scene::setModel(plane.materials[0], model);
  for (const scene::Scene& bare : {plane, ball({1, 0.8f, 0, 1}, 0.8f)}) {
    const scene::Scene scene = lit(bare, uniform(1), 0);
    render::Renderer renderer(device(), scene);
    const auto added = [&](const char* demodulate) {
      return direct(renderer, 80, 80,
                    {shadows(
                        {{"combine", "add"}, {"block", "4"}, {"lights", "64"}, {"demodulate", demodulate}})})
          .select({"B"});
    };
    const Image plain = added("false");
    EXPECT_GT(mean(plain), 0);
    EXPECT_LT(rmse(added("true"), plain), 0.01 * mean(plain));
  }
}

TEST_F(SubtractiveShadowsTest, BlocksCostLittleWhereSurfacesAreSmooth) {
  const scene::Scene scene = asset("nine_spheres");
  render::Renderer renderer(device(), scene);
  const Image truth = reference(scene, settings(256, 192, Term::direct), 256);
  const auto error = [&](const char* combine, const char* block) {
    return rmse(direct(renderer, 256, 192, {shadows({{"combine", combine}, {"block", block}})}), truth);
  };
  for (const char* combine : {"ratio", "ratio_split", "subtract"}) {
    const double whole = error(combine, "1"), blocks = error(combine, "4");
    RecordProperty(combine, std::to_string(whole) + " " + std::to_string(blocks));
    EXPECT_LT(blocks, 1.3 * whole) << combine;
  }
}

/// Pictures smaller than a block, one light, a single bright texel, lobes as sharp as they get: nothing is
/// infinite, and nothing is brighter than without shadows. Smoother metals are mirrors, which have no light
/// here.
TEST_F(SubtractiveShadowsTest, ExtremesStayFinite) {
  scene::Environment spot = uniform(0);
  spot.texels[32 * 4 + 7] = vec3(1e6f);
  scene::Scene sharp = coarse("balls"), metals = sharp;
  for (scene::Material& material : sharp.materials) material.roughness = 0;
  for (scene::Material& material : metals.materials) material = metal(glm::vec4(1), 13 / 255.f);
  for (const auto& [surfaces, environment] :
       {std::pair(sharp, sky()), std::pair(sharp, spot), std::pair(metals, sky()), std::pair(metals, spot)}) {
    const scene::Scene scene = lit(surfaces, environment, 0);
    render::Renderer renderer(device(), scene);
    const double most = largest(direct(renderer, 21, 13));
    for (const char* combine : kCombines)
      for (const char* block : {"1", "32"})
        for (const char* lights : {"1", "4"}) {
          const Image picture = direct(
              renderer, 21, 13, {shadows({{"combine", combine}, {"block", block}, {"lights", lights}})});
          for (const float v : picture.data()) EXPECT_TRUE(std::isfinite(v) && v >= 0) << combine << block;
          const bool bounded = std::string_view(combine) != "add";
          EXPECT_TRUE(!bounded || largest(picture) <= most * (1 + 1e-5)) << combine << block;
        }
  }
}

TEST_F(SubtractiveShadowsTest, RegionsStandForAllOfTheLight) {
  const Values regions{{"block", "1"}, {"sampling", "regions"}, {"region_threshold", "0.1"}};
  const auto combined = [&](const char* combine) {
    Values values = regions;
    values.emplace_back("combine", combine);
    return shadows(values);
  };
  const scene::Scene plane = lit(floor(), uniform(0.7f), 0);
  render::Renderer above(device(), plane);
  const Image open = direct(above, 16, 12, {combined("add")});
  for (const float v : open.data()) EXPECT_NEAR(v, 0.7f, 0.02f * 0.7f);
  const scene::Scene scene = lit(asset("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const Image truth = reference(scene, settings(96, 72, Term::direct), 1024);
  for (const char* combine : {"add", "ratio_split"})
    EXPECT_NEAR(mean(direct(renderer, 96, 72, {combined(combine)})), mean(truth), 0.05 * mean(truth))
        << combine;
}

/// A budget that no frame keeps leads from the best level to the least one.
TEST_F(SubtractiveShadowsTest, LevelsBeginAtTheBestAndEndAtTheLeast) {
  const scene::Scene scene = lit(coarse("balls"), sky(), 0);
  render::Renderer renderer(device(), scene);
  const auto with = [&](const char* lights, const char* time) {
    return settings(64, 48, Term::direct,
                    {shadows({{"shadow_map_size", "64"},
                              {"combine", "ratio"},
                              {"block", "32"},
                              {"lights", lights},
                              {"frame_time", time}})});
  };
  const Image best = picture(renderer, with("40", "0")), least = picture(renderer, with("8", "0"));
  renderer.configure(with("40", "0.001"));
  renderer.render();
  EXPECT_LT(rmse(renderer.read(), best), 1e-6);
  for (int frame = 1; frame < 60; ++frame) renderer.render();
  EXPECT_LT(rmse(renderer.read(), least), 1e-6);
}

/// On the way from one level to the next, lights or blocks, each of eight frames changes the picture by an
/// eighth of what the level changes, whichever pixels tell the lights apart, and whichever batch they are in.
/// Light that is subtracted changes by an eighth before negative light is cut off, and what coats see changes
/// with the width of their mirrors besides.
TEST_F(SubtractiveShadowsTest, NoFrameChangesMoreThanItsShareOfALevel) {
  constexpr int kFramesOfLevel = 8;
  constexpr std::pair<const char*, const char*> kLevels[] = {
      {"14", "2"}, {"9", "2"}, {"8", "2"}, {"8", "4"}, {"8", "8"}};
  const auto fading = [&](const std::string& name, const Values& common, double clamped = 1) {
    const scene::Scene scene = lit(asset(name), sky(), 0);
    render::Renderer renderer(device(), scene);
    const auto with = [&](const std::pair<const char*, const char*>& level, const char* time) {
      Values values{
          {"shadow_map_size", "128"}, {"lights", level.first}, {"block", level.second}, {"frame_time", time}};
      values.insert(values.end(), common.begin(), common.end());
      return settings(48, 36, Term::direct, {shadows(values)});
    };
    std::vector<Image> levels;
    for (const auto& level : kLevels) levels.push_back(picture(renderer, with(level, "0")));
    const double rounding = 5e-5 * largest(levels.front());
    size_t level = 0;
    double most = 0;
    renderer.configure(with(kLevels[0], "0.001"));
    Image before = levels.front();
    for (int frame = 0; frame < 100 && level + 1 < levels.size(); ++frame) {
      renderer.render();
      Image now = renderer.read();
      const double whole = largestDifference(levels[level], levels[level + 1]);
      EXPECT_LT(largestDifference(now, before), clamped * whole / kFramesOfLevel + rounding)
          << name << " from level " << level << " at frame " << frame;
      most = std::max(most, largestDifference(now, before) / whole);
      if (largestDifference(now, levels[level + 1]) < rounding) ++level;
      before = std::move(now);
    }
    EXPECT_EQ(level + 1, levels.size()) << name;
    return std::to_string(most);
  };
  RecordProperty("subtract", fading("balls", {{"combine", "subtract"}}, 2));
  RecordProperty("ratios, in batches", fading("balls", {{"combine", "ratio_split"}, {"memory", "1"}}));
  RecordProperty("coats", fading("fresnel_spheres", {{"combine", "ratio_split"}}, 1.2));
}

/// Light comes from the same directions wherever the camera is: as it moves by a pixel a frame, the shadows
/// of 8 lights lie where they were, and those of blocks nearly so.
TEST_F(SubtractiveShadowsTest, ShadowsStandStillWhereTheCameraMoves) {
  constexpr int kWidth = 64, kHeight = 48;
  scene::Scene scene = lit(floor(), sky(), 0);
  scene::Node slab;  // above the camera
  slab.mesh = 0;
  slab.transform.translation = {0.5f, 5, 0.5f};
  slab.transform.scale = vec3(0.02f);
  scene.nodes.push_back(slab);
  render::Renderer renderer(device(), scene);
  const auto change = [&](const char* block) {
    renderer.configure(
        settings(kWidth, kHeight, Term::direct, {shadows({{"lights", "8"}, {"block", block}})}));
    scene::CameraPose camera = scene::evaluate(scene, 0).cameras.at(0);
    const float pixel = 2 * 4 * std::tan(0.5f * camera.yfov) / static_cast<float>(kHeight);
    Image before;
    double squares = 0, light = 0;
    for (int frame = 0; frame <= 4; ++frame) {
      renderer.setCamera(camera);
      renderer.render();
      const Image now = renderer.read();
      for (int y = 0; frame > 0 && y < kHeight; ++y)
        for (int x = 0; x + 1 < kWidth; ++x) {
          const double difference = static_cast<double>(now.at(x, y, 1) - before.at(x + 1, y, 1));
          squares += difference * difference;
          light += static_cast<double>(now.at(x, y, 1) * now.at(x, y, 1));
        }
      before = now;
      camera.worldToView[3].x -= pixel;
    }
    RecordProperty(block, std::to_string(std::sqrt(squares / light)));
    return std::sqrt(squares / light);
  };
  EXPECT_LT(change("1"), 0.005);
  EXPECT_LT(change("4"), 0.05);
}

/// The same as the camera rolls by quarters of a turn, which leave every pixel what it sees: a satin ball on
/// the floor, with highlights and a shadow.
TEST_F(SubtractiveShadowsTest, ShadowsStandStillWhereTheCameraTurns) {
  constexpr int kSide = 64;
  scene::Scene scene = lit(floor(), sky(), 0);
  scene.materials.push_back(metal(glm::vec4(1, 0.8f, 0.5f, 1), 0.3f));
  scene.meshes.push_back({"ball", {test::spherePrimitive(0.6f, 1)}, {}});
  scene::Node ball;
  ball.mesh = 1;
  ball.transform.translation = {0.2f, 0.6f, -0.1f};
  scene.nodes.push_back(ball);
  render::Renderer renderer(device(), scene);
  const auto change = [&](const char* block) {
    renderer.configure(settings(kSide, kSide, Term::direct, {shadows({{"lights", "8"}, {"block", block}})}));
    scene::CameraPose camera = scene::evaluate(scene, 0).cameras.at(0);
    glm::mat4 quarter(1);
    quarter[0] = {0, 1, 0, 0};
    quarter[1] = {-1, 0, 0, 0};
    Image before;
    double squares = 0, light = 0, unturned = 0;
    for (int frame = 0; frame <= 4; ++frame) {
      renderer.setCamera(camera);
      renderer.render();
      const Image now = renderer.read();
      for (int y = 0; frame > 0 && y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const float turned = now.at(y, kSide - 1 - x, 1), own = before.at(x, y, 1);
          squares += std::pow(double(turned) - own, 2);
          unturned += std::pow(double(now.at(x, y, 1)) - own, 2);
          light += double(own) * own;
        }
      before = now;
      camera.worldToView = quarter * camera.worldToView;
    }
    RecordProperty(block, std::to_string(std::sqrt(squares / light)));
    EXPECT_GT(std::sqrt(unturned / light), 0.1) << "the picture turns";
    return std::sqrt(squares / light);
  };
  EXPECT_LT(change("1"), 0.005);
  EXPECT_LT(change("4"), 0.05);
}

}  // namespace
}  // namespace limn
