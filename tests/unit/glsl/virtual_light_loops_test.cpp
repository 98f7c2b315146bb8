// What the loops over virtual lights work out once per receiver or per light, against the general functions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glsl/indirect/gather.glsl"
#include "glsl/indirect/light_map.glsl"
#include "glsl/surface/brdf_view.glsl"

namespace limn::glsl {
namespace {

class VirtualLightLoops : public ::testing::Test {
 protected:
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  vec3 direction() {
    std::normal_distribution<float> normal;
    return normalize(vec3(normal(random_), normal(random_), normal(random_)));
  }

 private:
  std::mt19937 random_{5};
};

/// 1 / m^2 at squared distance d2, as if no nearer than `nearest` metres.
float bounded_inverse_square(float d2, float nearest) {
  return 1 / max(d2, nearest * nearest);
}

/// What the bound cuts off: 1 / d^2 as at the distance footprint / sqrt(pi), where that is greater.
float residual_inverse_square(float d2, float nearest, float footprint) {
  return max(1 / max(d2, footprint * footprint * inverse_pi) - bounded_inverse_square(d2, nearest), 0.f);
}

TEST_F(VirtualLightLoops, GeometryIsTheCosinesOverTheBoundedSquare) {
  for (int i = 0; i < 20000; ++i) {
    const vec3 n = direction(), m = direction();
    const vec3 offset = std::exp(uniform(-7, 7)) * direction();
    const float nearest = i % 3 == 0 ? 0 : std::exp(uniform(-7, 3)), footprint = std::exp(uniform(-9, 3));
    const float a = dot(n, offset), b = -dot(m, offset), d2 = dot(offset, offset);
    if (a <= 0 || b <= 0) continue;
    const float cosines = a / std::sqrt(d2) * (b / std::sqrt(d2));
    const float exact = cosines * bounded_inverse_square(d2, nearest);
    EXPECT_NEAR(gather_geometry(a, b, d2, nearest * nearest), exact, 1e-5f * exact);
    const float residual = residual_inverse_square(d2, nearest, footprint);
    const float share = gather_residual(d2, nearest * nearest, footprint * footprint * inverse_pi);
    const float bounded = bounded_inverse_square(d2, nearest);
    // Both are differences, of which the larger term is rounded.
    EXPECT_NEAR(bounded * share, residual, 1e-6f * (residual + bounded));
    const float other = std::exp(uniform(-7, 3)), wider = bounded_inverse_square(d2, other);
    EXPECT_NEAR(bounded * gather_rebound(d2, nearest * nearest, other * other), wider, 1e-5f * wider);
  }
  EXPECT_TRUE(std::isfinite(gather_geometry(1e-30f, 1e-30f, 1e-30f, 0)));
  EXPECT_EQ(gather_geometry(0, 0, 0, 0), 0);
}

/// A Lambertian disc of unit radiance and area A gives a receiver above its middle that faces it
/// pi R^2 / (d^2 + R^2); a light of its flux, pi A, sends A along its normal.
TEST_F(VirtualLightLoops, APatchIsExactAboveTheMiddleOfADisc) {
  for (int i = 0; i < 1000; ++i) {
    const float radius = std::exp(uniform(-7, 7)), d = std::exp(uniform(-7, 7));
    const float area = pi * radius * radius;
    const double exact = double(pi) * radius * radius / (double(d) * d + double(radius) * radius);
    const float share = gather_patch_geometry(d, d, d * d, inverse_pi * area);
    EXPECT_NEAR(area * share, exact, 1e-5 * exact);
    const float least = uniform(0, 1) * inverse_pi * area;
    EXPECT_NEAR(share * (1 + gather_patch_residual(d * d, inverse_pi * area, least)),
                gather_patch_geometry(d, d, d * d, least), 1e-5f / (d * d + least));
    const float wider = gather_patch_geometry(d, d, d * d, 2 * area);
    EXPECT_NEAR(share * gather_patch_rebound(d * d, inverse_pi * area, 2 * area), wider, 1e-5f * wider);
  }
  EXPECT_TRUE(std::isfinite(gather_patch_geometry(1e-30f, 1e-30f, 1e-30f, 0)));
  EXPECT_TRUE(std::isfinite(gather_patch_residual(0, 1, 0)));
}

TEST_F(VirtualLightLoops, ThePartsOfTheBrdfAreTheGeneralOnes) {
  int upward = 0;
  for (int i = 0; i < 50000; ++i) {
    const SurfaceBrdf s = surface_brdf({uniform(0, 1), uniform(0, 1), uniform(0, 1)}, uniform(0, 1),
                                       uniform(0.1f, 1), uniform(0, 1), vec3(1), uniform(1, 2));
    const vec3 n = direction(), v = direction();
    // Half of them near the mirror direction, where the lobe has its peak.
    vec3 l = direction();
    if (i % 2 == 0) l = normalize(2 * dot(n, v) * n - v + 0.1f * l);
    if (dot(n, l) < 1e-3f) continue;
    ++upward;
    const BrdfParts general = brdf_parts(s, n, v, l);
    const BrdfParts parts = brdf_view_parts(brdf_view(s, n, v), l);
    // v.h is known to within the rounding of the lengths of v and l, 1e-7, over the length of their sum;
    // Schlick's weight over pi is 5 / pi times as steep. Either side has that error.
    EXPECT_NEAR(parts.diffuse, general.diffuse, 1e-6f + 4e-7f / length(v + l)) << i;
    // A lobe of alpha 1e-2 is as steep as 1e-7 of rounding in its half vector over 1e-2: 1e-5, to the fourth
    // power.
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(parts.specular[c], general.specular[c], 2e-4f * general.specular[c] + 1e-6f) << i;
  }
  EXPECT_GT(upward, 20000);
}

struct MapCase {
  VirtualPointLight light;
  LightMaps maps;
  ShadowView view;
  vec3 receiver, normal;
  vec3 from;     // from the light to the receiver
  float height;  // over the light's plane
};

class LightMap : public VirtualLightLoops {
 protected:
  MapCase someCase() {
    MapCase c;
    c.maps = light_maps(10, 64);
    do {
      c.light.position = 2.f * vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      c.light.cluster = 0;
      c.light.normal = direction();
      c.light.flux = vec4(1);
      c.receiver = c.light.position + uniform(0.1f, 5) * direction();
      c.normal = direction();
      c.from = c.receiver - c.light.position;
      c.height = dot(c.light.normal, c.from);
    } while (c.height <= 0 || dot(c.normal, c.from) >= 0);
    c.view = light_map_view(c.light, c.maps, 3);
    return c;
  }
};

TEST_F(LightMap, PlacesAreTheViews) {
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const MapCase c = someCase();
    const LightMapAxes axes = light_map_axes(c.light.normal);
    const LightMapPlace place = light_map_place(c.maps, axes, c.from, c.height);
    const vec3 local = shadow_local(c.view, c.receiver);
    EXPECT_LT(length(place.local - local), 1e-5f);
    EXPECT_NEAR(place.d2, dot(local, local), 2e-5f * place.d2);
    const ShadowPoint at = shadow_project(c.view, c.receiver);
    const vec2 exact = 64.f * at.uv;
    const vec2 to_edge = abs(exact - round(exact));
    if (min(to_edge.x, to_edge.y) < 1e-3f) continue;  // rounding decides
    EXPECT_EQ(place.inside, shadow_inside(at)) << i;
    if (!place.inside) continue;
    ++inside;
    EXPECT_EQ(place.texel, floor(exact)) << i;
  }
  EXPECT_GT(inside, 15000);
}

TEST_F(LightMap, ATexelBlocksWhereTheGeneralTestSaysSo) {
  int blocking = 0, tested = 0;
  for (int i = 0; i < 50000; ++i) {
    const MapCase c = someCase();
    const LightMapAxes axes = light_map_axes(c.light.normal);
    const LightMapPlace place = light_map_place(c.maps, axes, c.from, c.height);
    if (!place.inside) continue;
    const float bias = uniform(0, 2);
    const float stored =
        i % 10 == 0 ? 1 : shadow_normalise(c.view, std::sqrt(place.d2) * uniform(0.05f, 1.05f));
    if (stored < 0) continue;
    const vec3 b = shadow_texel_offset(c.view, ivec2(place.texel), stored);
    const ShadowReceiver general =
        shadow_receiver(c.view, c.receiver, c.normal, normalize(c.receiver - c.view.origin), bias);
    // Metres: rounding decides within it.
    constexpr float rounding = 1e-5f;
    if (std::abs(dot(general.normal, b) - general.height) < rounding ||
        std::abs(dot(general.axis, b) - general.depth) < rounding)
      continue;
    const bool exact = stored < 1 && shadow_blocks(general, b);
    ++tested;
    blocking += exact ? 1 : 0;
    EXPECT_EQ(light_map_blocks(c.maps, axes, place, stored, c.normal, dot(c.normal, c.from),
                               bias * c.view.footprint),
              exact)
        << i;
  }
  EXPECT_GT(tested, 30000);
  EXPECT_GT(blocking, tested / 5);
  EXPECT_LT(blocking, tested * 4 / 5);
}

TEST_F(LightMap, LightsWithoutFluxLookOutOfTheScene) {
  MapCase c = someCase();
  c.light.flux = vec4(0);
  const ShadowView view = light_map_view(c.light, c.maps, 0);
  EXPECT_GT(length(view.origin - c.light.position), 100 * c.view.far);
}

}  // namespace
}  // namespace limn::glsl
