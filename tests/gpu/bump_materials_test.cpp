// Light from bump to bump of materials with a model and of translucent ones.
#include <algorithm>
#include <string>
#include <vector>

#include "core/scene/material_model.h"
#include "glsl/diffusion/boundary.glsl"
#include "tests/gpu/bump_bounces.h"

namespace limn {
namespace {

class BumpMaterialsTest : public BumpBouncesTest {
 protected:
  /// The scene with bumps that scatter below their surface, whose albedo is their base colour.
  static scene::Scene body(scene::Scene scene, float ior) {
    scene.materials[0].ior = ior;
    scene.materials[0].subsurface =
        scene::Subsurface{.extinction = glm::vec3(1e6f), .absorption = glm::vec3(0.1f)};
    return scene;
  }

  /// What leaves translucent bumps of the light that others send them, where it entered.
  Image subsurfaceLight(const scene::Scene& scene, const Values& values) {
    const Image direct = drawn(scene, Term::subsurface, {});
    Image all = drawn(scene, Term::subsurface, {technique("bump_interreflection", values)});
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) all.at(x, y, 0) -= direct.at(x, y, 0);
    return all;
  }
};

/// One bounce is as bright as the square of the albedo. That of Banks's kd is 8/3 of it, at most 1, as the
/// integral of cos(l) sin(l, t) over the hemisphere is 8/3. Through a coat of index 1.5 pass 1 - 0.0918 of
/// diffuse light (Duntley 1942), and 0.9082 / 1.5^2 = 0.4036 of what the base sends up, so that of a base of
/// albedo a leave 0.9082 a 0.4036 / (1 - a + 0.4036 a). Albedos that are stored in 16 bits and 0.0918 are off
/// by 1e-4.
TEST_F(BumpMaterialsTest, BumpsOfModelsReflectTheAlbedoOfTheirDiffusePart) {
  const scene::Scene lambertian = bumps(slantedLight(), eggCrate());
  const auto model = [](uint32_t kind, float kd, uint32_t options = 0) {
    glsl::MaterialModel m{};
    m.kind = kind;
    m.options = options;
    m.eta = glm::vec3(1.5f);
    m.exponent = 20;
    m.kd = glm::vec3(kd);
    return m;
  };
  const struct {
    const char* name;
    glsl::MaterialModel model;
    double albedo;
  } cases[] = {
      {"phong", model(glsl::model_phong, 0.5f), 0.5},
      {"banks", model(glsl::model_banks, 0.3f), 0.8},
      {"banks, bright", model(glsl::model_banks, 0.5f), 1},
      {"coat, sum", model(glsl::model_coated, 0.7f), 0.7},
      {"coat, blend", model(glsl::model_coated, 0.7f, glsl::model_option_blend), 0.7 * 0.9082},
      {"coat, physical", model(glsl::model_coated, 0.7f, glsl::model_option_physical),
       0.9082 * 0.7 * 0.4036 / (1 - 0.7 + 0.4036 * 0.7)},
  };
  for (const std::string& space : kSpaces) {
    const double plain = sumOf(light(lambertian, {{"space", space}}));
    ASSERT_GT(plain, 10);
    for (const auto& [name, of, albedo] : cases) {
      scene::Scene scene = lambertian;
      scene::setModel(scene.materials[0], of);
      const double ratio = albedo / static_cast<double>(kAlbedo);
      EXPECT_NEAR(sumOf(light(scene, {{"space", space}})) / plain, ratio * ratio, 1e-3)
          << name << ", " << space;
    }
  }
}

/// Without a boundary's reflection a translucent surface whose light leaves where it entered is a Lambertian
/// one. Albedos are stored in 16 bits; the mean reflectance at an index of 1 is 0 to within 1e-5.
TEST_F(BumpMaterialsTest, BumpsOfABodySendItsAlbedo) {
  const scene::Scene opaque = bumps({0, 1, 0}, groove());
  for (const std::string& space : kSpaces)
    for (const std::string bounces : {"1", "3"}) {
      SCOPED_TRACE(space + ", " + bounces);
      const Image expected = light(opaque, {{"space", space}, {"bounces", bounces}}),
                  found = subsurfaceLight(body(opaque, 1), {{"space", space}, {"bounces", bounces}});
      EXPECT_GT(sumOf(expected), 100);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) ASSERT_NEAR(found.at(x, y, 0), expected.at(x, y, 0), 2e-4f);
    }
}

/// The whole picture asks twice: for what bumps reflect at their boundaries, and for what enters them.
TEST_F(BumpMaterialsTest, FinalPicturesOfBodiesAreAlikeInBothSpaces) {
  const scene::Scene scene = body(bumps(slantedLight(), eggCrate()), 1.5f);
  const auto whole = [&](const std::string& space) {
    return sumOf(drawn(scene, Term::final, {technique("bump_interreflection", {{"space", space}})}));
  };
  EXPECT_NEAR(whole("texture") / whole("pixel"), 1, 0.01);
}

/// Both questions of the whole picture are about the same shadows and the same light on texels.
TEST_F(BumpMaterialsTest, WhatBodiesReflectAndWhatEntersThemShareShadowsAndTexels) {
  const scene::Scene scene = body(bumps(slantedLight(), eggCrate()), 1.5f);
  for (const std::string& space : kSpaces) {
    SCOPED_TRACE(space);
    std::vector<frame::PassReport> passes;
    drawn(scene, Term::final, {technique("bump_interreflection", {{"space", space}, {"bounces", "2"}})},
          &passes);
    const auto count = [&](const std::string& name) {  // a repeated one has a number behind its name
      return std::ranges::count_if(passes, [&](const frame::PassReport& pass) {
        return pass.technique == "bump_interreflection" && pass.name.starts_with(name);
      });
    };
    const bool texels = space == "texture";
    EXPECT_EQ(count("visibility"), 1);
    EXPECT_EQ(count("lit texels"), texels ? 1 : 0);
    EXPECT_EQ(count("gathered texels"), texels ? 2 : 0);
    EXPECT_EQ(count("bumps of pixels"), texels ? 4 : 0);
    EXPECT_EQ(count("paths of pixels"), texels ? 0 : 2);
  }
}

/// What an index of refraction changes of the second bounce over the first, at each pixel, is the mean share
/// of light that another boundary lets in.
TEST_F(BumpMaterialsTest, EachBumpOfABodyLetsInItsBoundarysShare) {
  constexpr float ior = 1.5f;
  const scene::Scene opaque = bumps({0, 1, 0}, groove());
  const auto bounced = [&](float index, const char* bounces) {
    return subsurfaceLight(body(opaque, index), {{"space", "texture"}, {"bounces", bounces}});
  };
  const Image first = bounced(ior, "1"), both = bounced(ior, "2"), plainFirst = bounced(1, "1"),
              plainBoth = bounced(1, "2");
  const auto secondOverFirst = [](const Image& one, const Image& two, int x, int y) {
    return two.at(x, y, 0) / one.at(x, y, 0) - 1;
  };
  const float share = glsl::diffusion_boundary(ior).entering;
  int counted = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      // Near crests, which see nothing of the other wall, nothing is left to divide by.
      if (plainFirst.at(x, y, 0) < 0.01f) continue;
      ASSERT_NEAR(secondOverFirst(first, both, x, y) / secondOverFirst(plainFirst, plainBoth, x, y), share,
                  0.01f);
      ++counted;
    }
  EXPECT_GT(counted, 4000);
}

}  // namespace
}  // namespace limn
