// Blocks of pixels of subtractive shadows: what they tell those beside them, and what they cost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/gpu/subtractive_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using glm::vec3;

/// Vertical rods one pixel wide, 50 m above the floor and below a slab behind the camera, in columns that are
/// the middle of no block: their pixels have shadows of their own, to what 16 bits hold of a share.
TEST_F(SubtractiveShadowsTest, RodsNarrowerThanBlocksHaveShadowsOfTheirOwn) {
  constexpr int kWidth = 64, kHeight = 48, kSide = 4;
  constexpr float kEye = 100, kRods = 50;
  constexpr int kColumns[] = {5, 19, 32, 44, 57};
  scene::Scene bare = floor();
  scene::Node& camera = bare.nodes.back();
  camera.transform.translation.y = kEye;
  scene::Node slab;
  slab.mesh = 0;
  slab.transform.translation = {20, kEye + 5, 0};
  slab.transform.scale = vec3(0.6f);
  const float pixel = 2 * (kEye - kRods) * std::tan(0.5f * bare.cameras[0].yfov) / kHeight;
  bare.nodes.push_back(slab);
  for (const int column : kColumns) {
    EXPECT_NE(column % kSide, kSide / 2);
    const float x = (static_cast<float>(column) + 0.5f - 0.5f * kWidth) * pixel;
    test::show(bare, test::quad({x, kRods, 0}, {pixel, 0, 0}, {0, 0, -100}, 0));
  }
  const scene::Scene scene = lit(bare, sky(), 0);
  render::Renderer renderer(device(), scene);
  for (const char* combine : {"subtract", "ratio", "ratio_split"}) {
    const auto with = [&](const char* block) {
      return direct(renderer, kWidth, kHeight, {shadows({{"combine", combine}, {"block", block}})});
    };
    const Image own = with("1"), blocks = with("4");
    double off = 0, unlike = 0;  // of rods in blocks from those without; of rods from the floor to their left
    for (int y = 0; y < kHeight; ++y)
      for (const int x : kColumns)
        for (int c = 0; c < 3; ++c) {
          off = std::max(off, static_cast<double>(std::abs(blocks.at(x, y, c) - own.at(x, y, c))));
          unlike = std::max(unlike, static_cast<double>(std::abs(own.at(x - 1, y, c) - own.at(x, y, c))));
        }
    EXPECT_LE(off, 1e-4) << combine << ", rods and floor differ by " << unlike;
    EXPECT_GT(unlike, 1e-2) << combine;
  }
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

/// Half a floor without a lobe, on the side of -x under a roof, and half a rough metal: its pixels have what
/// they have where all of the floor is metal, whose blocks differ by a colour of 1e-6 instead of 1 alone.
TEST_F(SubtractiveShadowsTest, SurfacesWithoutLobesTellThoseBesideThemOfShadows) {
  scene::Scene metallic = floor();
  metallic.materials[0] = metal(glm::vec4(1), 0.8f);
  scene::Node roof;
  roof.mesh = 0;
  roof.transform.translation = {-30, 6, 0};
  roof.transform.scale = vec3(0.6f);
  metallic.nodes.push_back(roof);
  scene::Material plain = lambertian(glm::vec4(1));
  plain.roughness = metallic.materials[0].roughness;
  const scene::Scene whole = lit(metallic, uniform(1), 0), half = lit(halved(metallic, plain), uniform(1), 0);
  render::Renderer ofWhole(device(), whole), ofHalf(device(), half);
  for (const char* combine : {"subtract", "add"}) {
    const auto shadowed = [&](render::Renderer& renderer) {
      return direct(renderer, 32, 24, {shadows({{"combine", combine}, {"block", "4"}, {"lights", "64"}})});
    };
    const Image expected = shadowed(ofWhole), picture = shadowed(ofHalf);
    for (int x = 17; x < 32; ++x) {
      EXPECT_GT(expected.at(x, 12, 0), 0.05f) << combine << ' ' << x;
      EXPECT_NEAR(picture.at(x, 12, 0), expected.at(x, 12, 0), 1e-3f) << combine << ' ' << x;
    }
  }
}

/// Half a floor of coats, on the side of -x, and half a glossy one: what is hidden of the coats' mirror is a
/// share, and that of lobes is light.
TEST_F(SubtractiveShadowsTest, CoatsAndLobesSideBySideKeepTheirOwnShadows) {
  scene::Scene bare = floor();
  bare.materials[0].specularFactor = 1;
  bare.materials[0].roughness = 0.3f;
  bare = halved(bare, mirrored());
  const auto shadowed = [&](render::Renderer& renderer, const char* combine) {
    return direct(renderer, 32, 24, {shadows({{"combine", combine}, {"block", "4"}})});
  };
  const scene::Scene weak = lit(bare, uniform(1e-3f), 0), strong = lit(bare, uniform(10), 0);
  render::Renderer dim(device(), weak), bright(device(), strong);
  const Image open = direct(dim, 32, 24);
  for (const char* combine : {"subtract", "ratio", "ratio_split"})
    EXPECT_LE(largestDifference(shadowed(dim, combine), open), 1e-6 * largest(open)) << combine;
  // A roof over the coats leaves the glossy floor beside it half of the sky.
  scene::Scene roofed = weak;
  scene::Node roof;
  roof.mesh = static_cast<int>(roofed.meshes.size());
  roof.transform.translation.y = 6;
  roofed.meshes.push_back({"roof", {roofed.meshes.back().primitives.front()}, {}});
  roofed.nodes.push_back(roof);
  render::Renderer below(device(), roofed);
  const Image beside = shadowed(below, "subtract");
  for (int x = 17; x < 22; ++x) EXPECT_GT(beside.at(x, 12, 0), 0.2f * open.at(x, 12, 0)) << x;
  // All of what coats mirror is added, also beside bright lobes.
  const Image all = direct(bright, 32, 24), added = shadowed(bright, "add");
  for (int x = 4; x < 15; ++x)
    EXPECT_NEAR(added.at(x, 12, 0), all.at(x, 12, 0), 0.1f * all.at(x, 12, 0)) << x;
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

}  // namespace
}  // namespace limn
