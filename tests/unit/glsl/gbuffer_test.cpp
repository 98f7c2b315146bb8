// Packing a surface into G-buffer texels and back, with the rounding of the texture formats.
#include "glsl/surface/gbuffer.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glsl/surface/brdf.glsl"

namespace limn::glsl {
namespace {

// Half a diagonal step of 1/32767, times the octahedral map's largest stretch, 3.
constexpr float kNormalError = 3 * 0.70711f / 32767 * 1.01f;

vec2 asSnorm16(vec2 v) {
  return unpackSnorm2x16(packSnorm2x16(v));
}
vec4 asUnorm8(vec4 v) {
  return unpackUnorm4x8(packUnorm4x8(v));
}
vec4 asUnorm16(vec4 v) {
  const vec2 low = unpackUnorm2x16(packUnorm2x16(vec2(v.x, v.y)));
  const vec2 high = unpackUnorm2x16(packUnorm2x16(vec2(v.z, v.w)));
  return {low.x, low.y, high.x, high.y};
}
vec4 asHalf(vec4 v) {
  const vec2 low = unpackHalf2x16(packHalf2x16(vec2(v.x, v.y)));
  const vec2 high = unpackHalf2x16(packHalf2x16(vec2(v.z, v.w)));
  return {low.x, low.y, high.x, high.y};
}

vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(GBuffer, OctahedralNormalsKeepTheStatedError) {
  std::mt19937 random(1);
  float worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const vec3 n = randomDirection(random);
    worst = std::max(worst, length(n - octahedral_decode(asSnorm16(octahedral_encode(n)))));
  }
  EXPECT_LT(worst, kNormalError);
  RecordProperty("worst_radians", std::to_string(worst));
  for (int axis = 0; axis < 3; ++axis) {
    for (float sign : {-1.f, 1.f}) {
      vec3 n(0);
      n[axis] = sign;
      EXPECT_LT(length(n - octahedral_decode(asSnorm16(octahedral_encode(n)))), 1e-6f);
    }
  }
}

TEST(GBuffer, SurfaceSurvivesTheTexturesWithinHalfAStep) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  for (int i = 0; i < 20000; ++i) {
    GBufferSurface s;
    s.normal = randomDirection(random);
    s.geometric_normal = randomDirection(random);
    s.base_colour = {unit(random), unit(random), unit(random)};
    s.metallic = unit(random);
    s.roughness = unit(random);
    s.specular_factor = unit(random);
    s.specular_colour = {unit(random), unit(random), unit(random)};
    s.ior = 1 + 2 * unit(random);
    s.emission = 100.f * vec3(unit(random), unit(random), unit(random));
    s.flags = random() & 0xffu;
    GBufferTexels t = gbuffer_pack(s);
    t.normal = asSnorm16(t.normal);
    t.geometric_normal = asSnorm16(t.geometric_normal);
    t.albedo = asUnorm16(t.albedo);
    t.material = asUnorm8(t.material);
    t.emission = asHalf(t.emission);
    const GBufferSurface r = gbuffer_unpack(t);
    ASSERT_LT(length(r.normal - s.normal), kNormalError);
    ASSERT_LT(length(r.geometric_normal - s.geometric_normal), kNormalError);
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(sqrt(r.base_colour[c]), sqrt(s.base_colour[c]), 0.51f / 65535);
      ASSERT_NEAR(r.specular_colour[c], s.specular_colour[c], 0.501f / 30);
      ASSERT_NEAR(r.emission[c], s.emission[c], s.emission[c] / 2048 + 1e-6f);
    }
    ASSERT_NEAR(r.metallic, s.metallic, 0.51f / 65535);
    ASSERT_NEAR(r.roughness, s.roughness, 0.501f / 255);
    ASSERT_NEAR(r.specular_factor, s.specular_factor, 0.501f / 255);
    ASSERT_NEAR(r.ior, s.ior, 0.00501f);
    ASSERT_EQ(r.flags, s.flags);
  }
}

/// Those of glass, water and skin are exact; materials that were converted from a specular colour reflect all
/// of it.
TEST(GBuffer, IndicesOfRefractionReachThoseOfMetals) {
  const auto stored = [](float ior) {
    GBufferSurface s{};
    s.normal = s.geometric_normal = {0, 0, 1};
    s.ior = ior;
    GBufferTexels t = gbuffer_pack(s);
    t.material = asUnorm8(t.material);
    return gbuffer_unpack(t).ior;
  };
  for (const float ior : {1.f, 1.33f, 1.4f, 1.5f, 2.42f, 3.f}) EXPECT_NEAR(stored(ior), ior, 1e-6f);
  for (const float ior : {3.01f, 5.f, 20.f, 100.f}) {
    const auto reflectance = [](float n) { return std::pow((n - 1) / (n + 1), 2.f); };
    EXPECT_NEAR(reflectance(stored(ior)), reflectance(ior), 0.0091f) << ior;
  }
  EXPECT_GT(surface_brdf(vec3(0.5f), 0, 0.5f, 1, vec3(1), stored(1000)).f0.x, 0.99f);
}

TEST(GBuffer, SpecularColourIsExactAtBothEnds) {
  for (const vec3 colour : {vec3(0), vec3(1), vec3(1, 0, 1), vec3(0, 1, 0)}) {
    EXPECT_EQ(colour_from_half_bits(asHalf(vec4(colour_to_half_bits(colour))).x), colour);
  }
}

}  // namespace
}  // namespace limn::glsl
