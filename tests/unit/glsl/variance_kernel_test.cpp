// Laws of the moments of variance soft shadow maps (glsl/shadow/variance_kernel.glsl).
#include "glsl/shadow/variance_kernel.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "glsl/shadow/shadow_kernel.glsl"
#include "tests/unit/glsl/shadow_thresholds.h"

namespace limn::glsl {
namespace {

TEST(VarianceKernel, TwoParallelPlanesAreExactAtEveryShare) {
  // p of n texels delta quanta before d, the rest at d: z_occ and the blocked share are exact.
  constexpr float n = 400, delta = 5000;
  const PlaceThresholds at{30000, 29990, vec2(0)};
  for (const float blocked : {4.f, 40.f, 200.f, 396.f, 400.f}) {
    const SubKernel s = sub_kernel(at, vec2(20), blocked * delta, blocked * delta * delta);
    EXPECT_EQ(sub_kernel_kind(s), sub_kernel_blocked);
    EXPECT_NEAR(chebyshev_blocked(n, s.first, sub_kernel_second(s)), blocked, 1e-3f * blocked);
    EXPECT_NEAR(blocker_distance(s.first, sub_kernel_second(s)), delta, 1e-3f * delta);
    EXPECT_FALSE(sub_kernel_contradicts(s, delta));
  }
}

TEST(VarianceKernel, SlopingPlanesAreNoVariance) {
  // A plane of 16 x 16 texels that changes by (3, 5) quanta per texel, a quarter of it behind a blocker.
  const PlaceThresholds at{30000, 29980, vec2(9, 25)};
  float first = 0, second = 0, planeFirst = 0, planeSecond = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const float plane = 3 * (static_cast<float>(x) - 7.5f) + 5 * (static_cast<float>(y) - 7.5f);
      const float before = x < 4 ? 4000.f : plane;
      planeFirst += plane;
      planeSecond += plane * plane;
      first += before;
      second += before * before;
    }
  }
  EXPECT_EQ(sub_kernel_kind(sub_kernel(at, vec2(16), planeFirst, planeSecond)), sub_kernel_lit);
  const SubKernel s = sub_kernel(at, vec2(16), first, second);
  EXPECT_NEAR(chebyshev_blocked(256, s.first, sub_kernel_second(s)), 64, 1.5f);
}

TEST(VarianceKernel, LitMeansThatFewerThanOneTexelIn256Blocks) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  int lit = 0;
  for (int i = 0; i < 20000; ++i) {
    const PlaceThresholds at{1000, 1000 - 50 * uniform(random), vec2(0)};
    const float spread = std::exp(8 * uniform(random)), centre = 2000 * uniform(random) - 1500;
    float first = 0, second = 0;
    int blocking = 0;
    for (int k = 0; k < 64; ++k) {
      const float before = centre + spread * (uniform(random) - 0.5f);
      first += before;
      second += before * before;
      blocking += before > at.unoccluded - at.blocking;
    }
    if (sub_kernel_kind(sub_kernel(at, vec2(8), first, second)) != sub_kernel_lit) continue;
    ++lit;
    EXPECT_EQ(blocking, 0);
  }
  EXPECT_GT(lit, 1000);
}

TEST(VarianceKernel, ThresholdsAreThoseOfShadowKernels) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 20000; ++i) {
    ShadowView view{};
    const bool perspective = i % 2 == 0;
    const float scale = perspective ? 0.625f : 0.1f;
    view.origin = vec3(0, 0, 0);
    view.near = 0.5f;
    view.axis_x = vec3(1, 0, 0);
    view.scale = scale;
    view.axis_y = vec3(0, 1, 0);
    view.footprint = 1 / (scale * 256);
    view.axis_z = vec3(0, 0, 1);
    view.far = 20;
    view.middle = vec2(0.5f, 0.5f);
    view.projection = perspective ? shadow_perspective : shadow_orthographic;
    view.size = 256;
    const vec3 receiver(4 * uniform(random) - 2, 4 * uniform(random) - 2, 8 + uniform(random));
    const vec3 normal = normalize(vec3(uniform(random) - 0.5f, uniform(random) - 0.5f, -0.6f));
    const ShadowReceiver r = shadow_receiver(view, receiver, normal, vec3(0, 0, 1), 1);
    const ShadowThresholds t = shadow_thresholds(view, r, dot(normal, receiver), 20, 65535);
    const vec2 texel(256 * uniform(random), 256 * uniform(random));
    const float stored = shadow_threshold(view, r, texel / 256.f), metres = shadow_metres(view, stored);
    EXPECT_NEAR(thresholds_at(t, texel).blocking / 65535, stored, 2e-6f);
    EXPECT_NEAR(threshold_gap(t, texel, metres), shadow_gap(view, r, texel / 256.f, stored), 2e-5f);
    if (stored < 1e-3f || stored > 0.999f) continue;
    EXPECT_TRUE(threshold_blocks(t, texel, metres * 0.9999f));
    EXPECT_FALSE(threshold_blocks(t, texel, metres * 1.0001f));
  }
}

TEST(VarianceKernel, ThresholdsHoldWhereverTheLightStands) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::array<int, 2> beneath{}, blocked{};  // in perspective and orthographic views
  for (int i = 0; i < 80000; ++i) {
    const size_t flat = i % 2;
    ShadowView view{};
    view.axis_x = vec3(1, 0, 0);
    view.axis_y = vec3(0, 1, 0);
    view.axis_z = vec3(0, 0, 1);
    view.near = 0.5f;
    view.far = 20;
    view.scale = flat == 1 ? 0.1f : 0.625f;
    view.footprint = 1 / (view.scale * 256);
    view.middle = vec2(0.5f);
    view.projection = flat == 1 ? shadow_orthographic : shadow_perspective;
    view.size = 256;
    const vec3 p(2 * uniform(random), 2 * uniform(random), 8);
    const vec3 normal = normalize(vec3(uniform(random), uniform(random), 0.2f * uniform(random)));
    const ShadowReceiver r = shadow_receiver(view, p, normal, vec3(0, 0, 1), 1);
    const ShadowThresholds t = shadow_thresholds(view, r, dot(normal, p), 20, 65535);
    const vec2 texel(128 + 128 * uniform(random), 128 + 128 * uniform(random));
    const float depth = 5.25f + 4.75f * uniform(random);
    const vec3 b = shadow_unproject_local(view, texel / 256.f, depth);
    const float above = flat == 1 ? -normal.z : -r.height;  // the plane, the light's centre
    // Where rounding decides, and where the centre lies in the plane.
    if (std::abs(dot(normal, b) - r.height) < 1e-4f || std::abs(above) < 1e-3f) continue;
    EXPECT_EQ(threshold_blocks(t, texel, depth), shadow_blocks(r, b)) << i;
    blocked[flat] += above < 0 && shadow_blocks(r, b);
    beneath[flat] += above < 0;
  }
  EXPECT_GT(std::ranges::min(beneath), 10000);
  EXPECT_GT(std::ranges::min(blocked), 500);
}

TEST(VarianceKernel, TexelsBehindThePlaneContradictItsTwoDepths) {
  // Half the texels block at 100 quanta, the others lie from 60 to 95 behind the plane: few seem to block,
  // from afar.
  for (float behind = 60; behind < 96; behind += 5) {
    const PlaceThresholds at{1000, 999, vec2(0)};
    const SubKernel s = sub_kernel(at, vec2(8), 32 * (100 - behind), 32 * (100 * 100 + behind * behind));
    EXPECT_EQ(sub_kernel_kind(s), sub_kernel_blocked);
    EXPECT_LT(chebyshev_blocked(64, s.first, sub_kernel_second(s)), 5);
    EXPECT_TRUE(sub_kernel_contradicts(s, 100));
  }
}

TEST(VarianceKernel, ConesGiveTheKernelsOfEveryGap) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 20000; ++i) {
    ShadowView view{};
    const bool perspective = i % 2 == 0;
    view.origin = vec3(0, 0, 0);
    view.near = 0.5f;
    view.axis_x = vec3(1, 0, 0);
    view.scale = perspective ? 0.625f : 0.1f;
    view.axis_y = vec3(0, 1, 0);
    view.axis_z = vec3(0, 0, 1);
    view.far = 20;
    view.middle = vec2(0.5f, 0.5f);
    view.projection = perspective ? shadow_perspective : shadow_orthographic;
    view.size = 256;
    const vec3 receiver(4 * uniform(random) - 2, 4 * uniform(random) - 2, 8 + uniform(random));
    LightView light{};
    light.centre = vec3(-receiver.x, -receiver.y, -receiver.z) / receiver.z;
    if (!perspective) light.centre = vec3(0, 0, -1);
    light.cone = !perspective;
    light.cap = 0.02f * uniform(random);
    light.side_u = vec3(perspective ? 0.1f : 1, 0, 0);
    light.side_v = vec3(0, perspective ? 0.2f : 1, 0);
    light.low = vec2(-0.5f, -0.5f * uniform(random));
    light.high = vec2(0.5f);
    const auto kernelAt = [&](float gap) {
      ShadowKernel kernel{};
      EXPECT_TRUE(shadow_kernel(view, light, receiver, gap, true, least_kernel_width, kernel));
      return kernel;
    };
    const ShadowKernel nominal = kernelAt(4);
    const KernelCone cone = kernel_cone(view, receiver, light.centre.z, nominal.low, nominal.high, 4);
    const float gap = 7 * uniform(random), scale = kernel_cone_scale(cone, gap);
    const ShadowKernel expected = kernelAt(gap);
    const float near = 1e-4f * (1 + expected.high.x - expected.low.x) + 1e-3f;
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(cone.apex[axis] + scale * cone.low[axis], expected.low[axis], near);
      EXPECT_NEAR(cone.apex[axis] + scale * cone.high[axis], expected.high[axis], near);
    }
  }
}

TEST(VarianceKernel, RangesBoundTheThresholdsOfABox) {
  const vec3 affine(0.3f, -0.02f, 0.05f);
  const vec2 range = threshold_range(affine, vec2(10, 20), vec2(14, 30));
  EXPECT_NEAR(range.x, threshold_value(affine, vec2(14, 20)), 1e-6f);
  EXPECT_NEAR(range.y, threshold_value(affine, vec2(10, 30)), 1e-6f);
}

TEST(VarianceKernel, QuotientsOfWholeNumbersAreExact) {
  std::mt19937 random(13);
  for (int i = 0; i < 200000; ++i) {
    const int a = static_cast<int>(random() % (1U << 22)), b = 1 + static_cast<int>(random() % 1023);
    ASSERT_EQ(whole_quotient(a, b), a / b);
  }
  for (int b = 1; b < 40; ++b) {
    for (int a = 0; a < 2000; ++a) ASSERT_EQ(whole_quotient(a, b), a / b);
  }
}

/// Bunnell's array: preorder, `child` is the next entry, `next` skips what lies below.
void listTree(uvec2 node, unsigned height, std::vector<uvec2>& nodes) {
  nodes.push_back(node);
  if (node.x == height) return;
  for (unsigned i = 0; i < 4; ++i) listTree(uvec2(node.x + 1, 4 * node.y + i), height, nodes);
}

TEST(VarianceKernel, QuadTreesAreWalkedInOrderWithoutAStack) {
  for (const unsigned height : {1u, 2u, 3u, 5u}) {
    std::vector<uvec2> expected, walked;
    listTree(uvec2(0), height, expected);
    for (uvec2 node(0); !quadtree_done(node);
         node = node.x < height ? quadtree_child(node) : quadtree_next(node)) {
      walked.push_back(node);
      ASSERT_LE(walked.size(), expected.size());
    }
    EXPECT_EQ(walked, expected);
    // Skipping every node of level 1 leaves the root and those four.
    int count = 0;
    for (uvec2 node(0); !quadtree_done(node); node = node.x < 1 ? quadtree_child(node) : quadtree_next(node))
      ++count;
    EXPECT_EQ(count, 5);
  }
  EXPECT_EQ(quadtree_place(uvec2(3, 0b110110)), ivec2(0b110 & 7, 0b101));
}

TEST(VarianceKernel, AxesCoverTheKernelAndNothingElse) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-20, 120);
  for (int i = 0; i < 20000; ++i) {
    const float a = uniform(random), b = uniform(random), low = std::min(a, b), high = std::max(a, b);
    const KernelAxis axis = kernel_axis(low, high, 100);
    const float inside = std::min(std::max(high, 0.f), 100.f) - std::min(std::max(low, 0.f), 100.f);
    EXPECT_NEAR(axis.before + static_cast<float>(axis.last - axis.first) + axis.after, inside, 2e-5f);
    EXPECT_GE(axis.before, 0);
    EXPECT_LE(axis.after, 1);
    const KernelAxis whole = kernel_axis_whole(low, high, 100);
    EXPECT_LE(static_cast<float>(whole.first), std::clamp(low, 0.f, 100.f));
    EXPECT_GE(static_cast<float>(whole.last), std::clamp(high, 0.f, 100.f));
    EXPECT_EQ(kernel_part(whole, 0, 5), whole.first);
    EXPECT_EQ(kernel_part(whole, 5, 5), whole.last);
  }
}

}  // namespace
}  // namespace limn::glsl
