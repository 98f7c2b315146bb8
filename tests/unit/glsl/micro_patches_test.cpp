// Laws of the projection of micro-patches onto lights (glsl/shadow/micro_patches.glsl).
#include "glsl/shadow/micro_patches.glsl"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/glsl/shadow_thresholds.h"

namespace limn::glsl {
namespace {

constexpr int kMapTexels = 64;

Light lightWith(uint32_t type, const vec3& direction, float u, float v) {
  const Frame frame = frame_around(-direction);
  Light light{};
  light.position = vec3(0.2f, 5, -0.1f);
  light.direction = direction;
  light.axis_u = frame.t;
  light.length_u = u;
  light.axis_v = frame.b;
  light.length_v = v;
  light.angular_diameter = 0.2f;
  light.type = type;
  light.own_instance = no_instance;
  return light;
}

/// Looks along `direction`, not along the light's axis where they differ.
ShadowView viewOf(const Light& light, uint32_t kind, const vec3& direction) {
  const Frame frame = frame_around(-direction);
  ShadowView view{};
  const float scale = kind == shadow_perspective ? 0.5f : 0.1f;
  view.origin = light.position;
  view.near = 0.05f;
  view.axis_x = frame.t;
  view.scale = scale;
  view.axis_y = frame.b;
  view.footprint = 1 / (scale * kMapTexels);
  view.axis_z = direction;
  view.far = 20;
  view.middle = vec2(0.5f, 0.5f);
  view.projection = kind;
  view.size = kMapTexels;
  return view;
}

struct Setting {
  Light light;
  ShadowView view;
  vec3 p;
  LightView seen;
  ShadowReceiver receiver;
  PatchProjection projection;

  Setting(const Light& l, const ShadowView& v, const vec3& at)
      : light(l),
        view(v),
        p(at),
        seen(light_view(light, p, vec3(0, 1, 0), -1)),
        receiver(shadow_receiver(view, p, vec3(0, 1, 0), seen.axis, 1)),
        projection(patch_projection(view, receiver, seen, p, 1)) {}

  /// Metres from the receiver along the light's axis to a point of the map at depth z.
  float gap(vec2 texel, float z) const {
    const vec3 b = shadow_unproject_local(view, texel / float(kMapTexels), z);
    return -dot(seen.axis, view.origin + shadow_world_offset(view, b) - p);
  }
  /// Where the ray through a point of the map at depth z meets the light's box, in the projection's order.
  vec2 point(vec2 texel, float z) const {
    const vec3 b = shadow_unproject_local(view, texel / float(kMapTexels), z);
    const vec3 to = view.origin + shadow_world_offset(view, b) - p;
    const vec3 slope = to / -dot(seen.axis, to) - seen.centre;
    vec3 u, v;
    patch_sides(view, seen, 1, u, v);
    vec2 at(dot(slope, u) / dot(u, u), dot(slope, v) / dot(v, v));
    at = (at - seen.low) / (seen.high - seen.low);
    if (projection.swapped) at = vec2(at.y, at.x);
    if (projection.flipped.x) at.x = 1 - at.x;
    if (projection.flipped.y) at.y = 1 - at.y;
    return at;
  }
};

const vec3 down(0, -1, 0), aslant = normalize(vec3(0.5f, -1, 0.3f));

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const vec3& axis : {down, aslant}) {
    const Light rectangle = lightWith(light_rectangle, axis, 1.5f, 0.7f);
    all.emplace_back(rectangle, viewOf(rectangle, shadow_perspective, axis), vec3(0.4f, 0, 0.3f));
    all.emplace_back(rectangle, viewOf(rectangle, shadow_perspective, vec3(1, 0, 0)), vec3(6, 0, 0.3f));
    all.emplace_back(rectangle, viewOf(rectangle, shadow_perspective, vec3(0, 0, -1)), vec3(1, 0, -6));
    const Light sun = lightWith(light_directional, axis, 0, 0);
    all.emplace_back(sun, viewOf(sun, shadow_orthographic, axis), vec3(0.4f, 0, 0.3f));
  }
  return all;
}

TEST(MicroPatches, EndsOfAPatchAreThoseOfItsMiddleLines) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const Setting& s : settings()) {
    int compared = 0;
    for (int i = 0; i < 10000; ++i) {
      const vec2 centre(std::floor(kMapTexels * uniform(random)) + 0.5f,
                        std::floor(kMapTexels * uniform(random)) + 0.5f);
      const float z = 0.05f + 7 * uniform(random);
      const MicroPatch patch = micro_patch(s.projection, centre, 1, z, 0);
      const vec3 b = shadow_unproject_local(s.view, centre / float(kMapTexels), z);
      const float gap =
          shadow_gap(s.view, s.receiver, centre / float(kMapTexels), shadow_normalise(s.view, z));
      const bool before = s.seen.cone || gap < s.seen.depth;
      EXPECT_EQ(patch.blocks, before && shadow_blocks(s.receiver, b)) << i;
      if (!patch.blocks || gap < 0.5f) continue;
      ++compared;
      const auto near = [](float a, float expected) {
        EXPECT_NEAR(a, expected, 2e-3f * std::abs(expected) + 2e-3f);
      };
      const vec2 left = s.point(centre - vec2(0.5f, 0), z), right = s.point(centre + vec2(0.5f, 0), z);
      const vec2 below = s.point(centre - vec2(0, 0.5f), z), above = s.point(centre + vec2(0, 0.5f), z);
      near(patch.low.x, std::min(left.x, right.x));
      near(patch.high.x, std::max(left.x, right.x));
      near(patch.low.y, std::min(below.y, above.y));
      near(patch.high.y, std::max(below.y, above.y));
    }
    EXPECT_GT(compared, 100);
  }
}

/// Also beside the receiver, where gaps change much across a patch: a box that reached farther there would
/// cover lights that the patch is far aside of.
TEST(MicroPatches, BoxesHoldMiddleLinesAndReachNoFartherThanCorners) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  int beside = 0;
  for (const Setting& s : settings()) {
    for (int i = 0; i < 10000; ++i) {
      const vec2 centre(std::floor(kMapTexels * uniform(random)) + 0.5f,
                        std::floor(kMapTexels * uniform(random)) + 0.5f);
      const float z = 0.05f + 7 * uniform(random);
      vec2 low(3e38f), high(-3e38f);
      float least = 3e38f, most = 0;
      for (int k = 0; k < 4; ++k) {
        const vec2 corner = centre + vec2(k % 2, k / 2) - 0.5f;
        low = min(low, s.point(corner, z));
        high = max(high, s.point(corner, z));
        least = std::min(least, s.gap(corner, z));
        most = std::max(most, s.gap(corner, z));
      }
      const MicroPatch patch = micro_patch(s.projection, centre, 1, z, 1);
      if (!patch.blocks || least < 0.02f) continue;
      if (most > 2 * least) ++beside;
      const MicroPatch lines = micro_patch(s.projection, centre, 1, z, 0);
      for (int axis = 0; axis < 2; ++axis) {
        const float rounding = 5e-3f * std::max({std::abs(low[axis]), std::abs(high[axis]), 1.f});
        EXPECT_GE(patch.low[axis], low[axis] - rounding) << i;
        EXPECT_LE(patch.high[axis], high[axis] + rounding) << i;
        EXPECT_LE(patch.low[axis], lines.low[axis] + rounding) << i;
        EXPECT_GE(patch.high[axis], lines.high[axis] - rounding) << i;
      }
    }
  }
  EXPECT_GT(beside, 50);
}

/// The texels of one plane cover the light once, whichever way the map is turned against it.
TEST(MicroPatches, TexelsOfAPlaneCoverTheLightOnce) {
  for (int turn = 0; turn < 8; ++turn) {
    const Light light = lightWith(light_rectangle, down, 0.5f, 0.4f);
    ShadowView view = viewOf(light, shadow_perspective, down);
    const float angle = 0.3f * float(turn);
    const vec3 x(view.axis_x), y(view.axis_y);
    view.axis_x = std::cos(angle) * x + std::sin(angle) * y;
    view.axis_y = std::cos(angle) * y - std::sin(angle) * x;
    const Setting s(light, view, vec3(0.4f, 0, 0.3f));
    float area = 0;
    for (int i = 0; i < kMapTexels * kMapTexels; ++i) {
      const vec2 centre(float(i % kMapTexels) + 0.5f, float(i / kMapTexels) + 0.5f);
      const MicroPatch patch = micro_patch(s.projection, centre, 1, 0.7f, 0);
      EXPECT_TRUE(patch.blocks);
      const vec2 size = clamp(patch.high, vec2(0), vec2(1)) - clamp(patch.low, vec2(0), vec2(1));
      area += s.projection.area * size.x * size.y;
    }
    EXPECT_NEAR(area, 1, turn == 0 ? 1e-4f : 0.03f) << "turned by " << angle;
  }
}

TEST(MicroPatches, BoxesThatMayNotBlockDoNot) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const Setting& s : settings()) {
    int dismissed = 0, blocking = 0;
    for (int i = 0; i < 4000; ++i) {
      const vec2 low(kMapTexels * uniform(random), kMapTexels * uniform(random));
      const vec2 high = low + vec2(12 * uniform(random), 12 * uniform(random));
      const float z = 0.05f + 7 * uniform(random);
      const vec2 depths(z, z + uniform(random));
      float gap = 0;
      const bool may = patches_may_block(s.projection, low, high, depths, gap);
      dismissed += !may;
      for (int j = 0; j < 20; ++j) {
        const vec2 at = mix(low, high, vec2(uniform(random), uniform(random)));
        const float depth = mix(depths.x, depths.y, uniform(random));
        const vec3 b = shadow_unproject_local(s.view, at / float(kMapTexels), depth);
        const vec2 on = s.point(at, depth);
        const float found = s.receiver.depth - dot(s.receiver.axis, b);
        const bool before = s.seen.cone || found < s.seen.depth;
        const bool blocks =
            before && shadow_blocks(s.receiver, b) && min(on.x, on.y) > 1e-3f && max(on.x, on.y) < 0.999f;
        if (!blocks) continue;
        ++blocking;
        EXPECT_TRUE(may);
        EXPECT_GE(gap * 1.0001f, found);
      }
    }
    EXPECT_GT(dismissed, 1000);
    EXPECT_GT(blocking, 100);
  }
}

TEST(MicroPatches, ShareAboveAHorizon) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 300; ++i) {
    vec2 slope(uniform(random), uniform(random));
    if (i % 5 == 0) slope.x *= 1e-4f;
    if (i % 7 == 0) slope.y = 0;
    const float height = 0.8f * uniform(random);
    constexpr int side = 200;
    int above = 0;
    for (int j = 0; j < side * side; ++j) {
      const vec2 p((float(j % side) + 0.5f) / side, (float(j / side) + 0.5f) / side);
      above += height + dot(slope, p - 0.5f) >= 0 ? 1 : 0;
    }
    EXPECT_NEAR(half_plane_share(height, slope), float(above) / (side * side), 6e-3f)
        << height << " " << slope.x << " " << slope.y;
  }
  EXPECT_EQ(half_plane_share(1, vec2(0)), 1);
  EXPECT_EQ(half_plane_share(-1, vec2(0)), 0);
}

}  // namespace
}  // namespace limn::glsl
