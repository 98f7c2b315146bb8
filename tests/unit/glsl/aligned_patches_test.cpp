// Micro-patches where the map's axes are the light's (glsl/shadow/aligned_patches.glsl) against the general
// ones.
#include "glsl/shadow/aligned_patches.glsl"

#include <gtest/gtest.h>

#include <random>

namespace limn::glsl {
namespace {

constexpr int kTexels = 64;

class AlignedPatchTest : public ::testing::TestWithParam<uint32_t> {
 protected:
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

  /// Returns a rectangle (perspective) or a disc (orthographic) that shines roughly downwards.
  Light someLight() {
    const bool disc = GetParam() == shadow_orthographic;
    const Frame frame = frame_around(-normalize(vec3(uniform(-0.4f, 0.4f), -1, uniform(-0.4f, 0.4f))));
    Light light{};
    light.position = vec3(uniform(-1, 1), 5, uniform(-1, 1));
    light.direction = -frame.n;
    light.axis_u = frame.t;
    light.axis_v = frame.b;
    light.length_u = disc ? 0 : uniform(0.1f, 3);
    light.length_v = disc ? 0 : uniform(0.1f, 3);
    light.angular_diameter = uniform(0.02f, 0.5f);
    light.type = disc ? light_directional : light_rectangle;
    light.own_instance = no_instance;
    return light;
  }

  /// Returns its view along its axis, which is cut off the axis.
  ShadowView viewOf(const Light& light) {
    ShadowView view{};
    view.origin = light.position;
    view.near = 0.05f;
    view.axis_x = light.axis_u;
    view.scale = GetParam() == shadow_orthographic ? 0.1f : 0.5f;
    view.axis_y = light.axis_v;
    view.footprint = 1 / (view.scale * kTexels);
    view.axis_z = light.direction;
    view.far = 20;
    view.middle = vec2(uniform(0.3f, 0.7f), uniform(0.3f, 0.7f));
    view.projection = GetParam();
    view.size = kTexels;
    return view;
  }

  /// One receiver under a light.
  struct Case {
    ShadowView view;
    PatchProjection general;
    AlignedPatches aligned;
  };

  Case someCase() {
    const Light light = someLight();
    const ShadowView view = viewOf(light);
    const vec3 p(uniform(-1, 1), uniform(-0.2f, 0.5f), uniform(-1, 1));
    const vec3 normal = normalize(vec3(uniform(-1, 1), 1, uniform(-1, 1)));
    const LightView seen = light_view(light, p, normal, -1);
    const ShadowReceiver receiver = shadow_receiver(view, p, normal, seen.axis, 1);
    const PatchProjection general = patch_projection(view, receiver, seen, p, 1);
    return {view, general, aligned_patches(general, view.projection)};
  }

 private:
  std::mt19937 random_{11};
};

TEST_P(AlignedPatchTest, PatchesAreTheGeneralOnes) {
  int compared = 0, near_edge = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Case c = someCase();
    EXPECT_FALSE(c.general.swapped || c.general.flipped.x || c.general.flipped.y);
    EXPECT_NEAR(c.general.area, 1, 1e-5f);
    const ivec2 texel(int(uniform(0, kTexels)), int(uniform(0, kTexels)));
    const float cell = float(1 << int(uniform(0, 3)));
    const float z = uniform(0.05f, 6);
    const vec2 centre = vec2(texel) + 0.5f;
    // Nothing is turned, so that `spread` changes nothing.
    const MicroPatch expected = micro_patch(c.general, centre, cell, z, float(i & 1));
    const MicroPatch found =
        aligned_patch(c.aligned, c.view.projection, patch_line(c.aligned, 0, texel.x, cell),
                      patch_line(c.aligned, 1, texel.y, cell), z);
    // Metres: rounding of heights and gaps of some 10 m.
    const vec4 at = c.general.c0 + centre.x * c.general.cx + centre.y * c.general.cy +
                    z * (c.general.d0 + centre.x * c.general.dx + centre.y * c.general.dy);
    if (std::abs(at.w) < 1e-4f || std::abs(at.z) < 1e-4f) {
      ++near_edge;
      continue;
    }
    EXPECT_EQ(found.blocks, expected.blocks) << i;
    if (!found.blocks || at.z < 0.1f) continue;
    ++compared;
    // Some eight roundings of the gap (lengths of up to 10 m) and of a numerator's terms, divided by the gap.
    constexpr float rounding = 8 * 0x1p-24f;
    const vec2 terms =
        abs(c.aligned.over_gap) + c.aligned.depth * abs(c.aligned.fixed_part) +
        float(kTexels) * (abs(c.aligned.over_gap_step) + c.aligned.depth * abs(c.aligned.fixed_step));
    for (int axis = 0; axis < 2; ++axis) {
      const float widest = std::max(std::abs(expected.low[axis]), std::abs(expected.high[axis]));
      const float bound = rounding * (terms[axis] + 10 * widest) / at.z;
      EXPECT_NEAR(found.low[axis], expected.low[axis], bound) << i;
      EXPECT_NEAR(found.high[axis], expected.high[axis], bound) << i;
    }
  }
  EXPECT_GT(compared, count / 20);
  EXPECT_LT(near_edge, count / 100);
}

TEST_P(AlignedPatchTest, BoxesMayBlockWhereTheGeneralOnesMay) {
  int blocking = 0, differing = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Case c = someCase();
    const vec2 low(uniform(0, kTexels), uniform(0, kTexels));
    const vec2 high = low + vec2(uniform(0, 12), uniform(0, 12));
    const float z = uniform(0.05f, 6);
    const vec2 depths(z, z + uniform(0, 1));
    float expected_gap = 0, gap = 0;
    const bool expected = patches_may_block(c.general, low, high, depths, expected_gap);
    const bool found =
        aligned_patches_may_block(c.aligned, c.view.projection, patch_span(c.aligned, 0, low.x, high.x),
                                  patch_span(c.aligned, 1, low.y, high.y), depths, gap);
    differing += found != expected;
    if (!found || !expected) continue;
    ++blocking;
    EXPECT_NEAR(gap, expected_gap, 1e-5f) << i;
  }
  EXPECT_GT(blocking, count / 100);
  EXPECT_LE(differing, count / 2000) << "only where rounding decides";
}

INSTANTIATE_TEST_SUITE_P(Projections, AlignedPatchTest,
                         ::testing::Values(shadow_perspective, shadow_orthographic));

}  // namespace
}  // namespace limn::glsl
