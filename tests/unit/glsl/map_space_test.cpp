// The space of a shadow map (glsl/shadow/map_space.glsl) against the general functions it stands for.
#include "glsl/shadow/map_space.glsl"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/shadow_kernel.glsl"
#include "tests/unit/glsl/shadow_thresholds.h"

namespace limn::glsl {
namespace {

constexpr uint32_t kKinds[] = {light_kind_point, light_kind_disc, light_kind_distant_rectangle,
                               light_kind_rectangle};

class MapSpace : public ::testing::TestWithParam<uint32_t> {
 protected:
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  vec3 somewhere(float reach) {
    return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)};
  }

  /// Returns a light at a random place that shines roughly downwards.
  Light someLight() {
    const uint32_t kind = GetParam();
    const Frame frame = frame_around(normalize(vec3(0.3f * somewhere(1).x, -1, 0.3f * somewhere(1).z)));
    Light light{};
    light.position = vec3(0, 10, 0) + somewhere(1);
    light.direction = frame.n;
    light.axis_u = frame.t;
    light.axis_v = -frame.b;
    light.own_instance = no_instance;
    light.type = kind == light_kind_rectangle ? light_rectangle
                 : kind == light_kind_point   ? light_point
                                              : light_directional;
    if (kind == light_kind_rectangle) {
      light.length_u = uniform(0.1f, 3);
      light.length_v = uniform(0.1f, 3);
    } else if (kind == light_kind_disc) {
      light.angular_diameter = uniform(0.01f, 0.5f);
    } else if (kind == light_kind_distant_rectangle) {
      light.position = -frame.n;
      light.length_u = uniform(0.05f, 0.5f);
      light.length_v = uniform(0.05f, 0.5f);
      light.solid_angle = 0.1f;
    }
    EXPECT_EQ(light_kind(light), kind);
    return light;
  }

  /// Returns a view of the light that lies off its axis.
  ShadowView someView(const Light& light) {
    const bool orthographic = light.type == light_directional;
    ShadowView view{};
    view.origin = orthographic ? vec3(0, 12, 0) : light.position;
    view.projection = orthographic ? shadow_orthographic : shadow_perspective;
    const Frame frame = frame_around(light.direction);
    view.axis_x = frame.t;
    view.axis_y = -frame.b;
    view.axis_z = frame.n;
    view.scale = orthographic ? uniform(0.03f, 0.1f) : uniform(0.2f, 1);
    view.middle = vec2(uniform(0.2f, 0.8f), uniform(0.2f, 0.8f));
    view.near = 0.5f;
    view.far = 25;
    view.size = 512;
    view.footprint = 1 / (view.scale * 512);
    return view;
  }

  struct Case {
    Light light;
    ShadowView view;
    vec3 receiver;
    LightView seen;
    ShadowReceiver general;
    MapReceiver in_map;
  };

  Case someCase() {
    Case c;
    c.light = someLight();
    c.view = someView(c.light);
    c.receiver = vec3(uniform(-3, 3), uniform(-1, 3), uniform(-3, 3));
    const vec3 normal = normalize(somewhere(1) + vec3(0, 1, 0));
    c.seen = light_view(c.light, c.receiver, normal, GetParam() == light_kind_point ? uniform(0, 2) : -1);
    c.general = shadow_receiver(c.view, c.receiver, normal, c.seen.axis, uniform(0, 4));
    c.in_map = map_receiver(c.view, c.general, false);
    return c;
  }

  int unsteady_ = 0;

 private:
  std::mt19937 random_{17};
};

TEST_P(MapSpace, TexelsBlockWhatTheyBlock) {
  int blocked = 0, near_edge = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Case c = someCase();
    const vec2 texel(std::floor(uniform(0, 512)), std::floor(uniform(0, 512)));
    const float stored = uniform(0, 1), depth = shadow_metres(c.view, stored);
    const vec3 b = shadow_texel_offset(c.view, ivec2(texel), stored);
    const float above = dot(c.general.normal, b) - c.general.height;
    const float nearer = c.general.depth - dot(c.general.axis, b);
    // Metres: rounding of what is about 30 m from the origin.
    constexpr float rounding = 1e-4f;
    EXPECT_NEAR(map_dot(c.view, c.in_map.plane, texel, depth) - c.in_map.height, above, rounding);
    EXPECT_NEAR(map_gap(c.view, c.in_map, texel, depth), nearer, rounding);
    blocked += shadow_blocks(c.general, b) ? 1 : 0;
    if (std::abs(above) < rounding || std::abs(nearer) < rounding) {
      ++near_edge;
      continue;
    }
    EXPECT_EQ(map_blocks(c.view, c.in_map, texel, depth), shadow_blocks(c.general, b)) << i;
  }
  EXPECT_GT(blocked, count / 20) << "both answers occur";
  EXPECT_LT(near_edge, count / 100);
}

TEST_P(MapSpace, RaysToTheLightLandWhereTheyDo) {
  int inside = 0, counted = 0;
  for (int i = 0; i < 20000; ++i) {
    const Case c = someCase();
    const vec2 u(uniform(0, 1), uniform(0, 1));
    const float gap = uniform(0, 0.95f) * (GetParam() == light_kind_distant_rectangle ? 10 : c.seen.depth);
    const MapKernel kernel = map_kernel(c.view, c.seen, c.receiver);
    vec3 slope;
    vec2 p;
    const bool counts = light_view_sample(c.seen, u, slope);
    const vec3 rise = light_view_rise(c.seen);
    if (std::abs(dot(slope, c.seen.normal)) > 1e-5f) {
      EXPECT_EQ(light_view_choose(c.seen, rise, u, p), counts) << i;
    }
    if (!counts) continue;
    ++counted;
    light_view_choose(c.seen, rise, u, p);
    const ShadowPoint at = shadow_project(c.view, c.receiver + gap * slope);
    const vec2 texel = map_texel(c.view, map_kernel_point(kernel, p, gap));
    if (!shadow_inside(at)) continue;
    ++inside;
    const vec2 expected = 512.f * at.uv;
    // Texels: places of some hundreds of texels that are divided by depths of at least 5 % of the receiver's.
    constexpr float rounding = 2e-2f;
    EXPECT_NEAR(texel.x, expected.x, rounding);
    EXPECT_NEAR(texel.y, expected.y, rounding);
    EXPECT_TRUE(map_holds(c.view, clamp(texel, 0.f, 511.9f)));
  }
  EXPECT_GT(counted, 3000);
  EXPECT_GT(inside, 500);
}

TEST_P(MapSpace, TheConeHoldsWhatLiesInIt) {
  int held = 0, tested = 0;
  for (int i = 0; i < 50000; ++i) {
    const Case c = someCase();
    if (!c.seen.extended || c.seen.masked) continue;
    // Around the ray to a point in or near the light.
    vec3 slope = light_view_point(c.seen, vec2(uniform(-0.5f, 1.5f), uniform(-0.5f, 1.5f)));
    const float gap = uniform(0.1f, 0.9f) * (GetParam() == light_kind_distant_rectangle ? 10 : c.seen.depth);
    const ShadowPoint at = shadow_project(c.view, c.receiver + gap * slope);
    if (!shadow_inside(at)) continue;
    const vec2 texel = floor(512.f * at.uv);
    const float stored = shadow_normalise(c.view, at.depth);
    if (!(stored > 0 && stored < 1)) continue;
    const vec3 b = shadow_texel_offset(c.view, ivec2(texel), stored);
    const float found = c.general.depth - dot(c.general.axis, b);
    if (!(found > 0.05f)) continue;
    const vec3 to = shadow_world_offset(c.view, b) - (c.receiver - c.view.origin);
    const float footprint = shadow_footprint(c.view, at.depth);
    const MapCone cone = map_cone(c.view, c.seen, c.receiver, c.in_map, c.general.axis);
    const auto contains = [&](float margin) {
      return light_view_contains(c.seen, to / found, (footprint + margin) / found);
    };
    // Metres: rounding of the offset decides within it.
    constexpr float rounding = 2e-4f;
    if (contains(rounding) != contains(-rounding)) continue;
    ++tested;
    held += contains(0) ? 1 : 0;
    EXPECT_EQ(map_cone_contains(c.view, c.seen, cone, texel, at.depth, found, footprint), contains(0)) << i;
  }
  EXPECT_GT(held, tested / 10);
  EXPECT_LT(held, tested * 9 / 10);
  EXPECT_GT(tested, 1000);
}

TEST_P(MapSpace, ThresholdsAndGapsOfBoxesAreTheGeneralOnes) {
  for (int i = 0; i < 20000; ++i) {
    const Case c = someCase();
    ShadowKernel kernel;
    kernel.low = vec2(uniform(0, 500), uniform(0, 500));
    kernel.high = kernel.low + vec2(uniform(0, 12), uniform(0, 12));
    kernel.weight = 1;
    const vec2 expected = shadow_threshold_range(c.view, c.general, kernel);
    const vec2 range = map_threshold_range(c.view, c.in_map, kernel.low, kernel.high);
    // A plane that the view sees edge-on has its depth from the quotient of two small numbers.
    const float at = shadow_threshold(c.view, c.general, kernel.low / 512.f);
    const float aside = shadow_threshold(c.view, c.general, (kernel.low + vec2(1e-3f)) / 512.f);
    if (std::abs(at - aside) < 1e-3f) {
      EXPECT_NEAR(map_threshold(c.view, c.in_map, kernel.low), at, 1e-3f);
      if (std::abs(range.x - expected.x) > 1e-2f || std::abs(range.y - expected.y) > 1e-2f) ++unsteady_;
    }
    const float least = uniform(0, 1);
    EXPECT_NEAR(map_gap_bound(c.view, c.in_map, kernel.low, kernel.high, shadow_metres(c.view, least)),
                shadow_gap_bound(c.view, c.general, kernel, least), 1e-4f);
  }
  EXPECT_LT(unsteady_, 200) << "of 20000: a corner where the plane is seen edge-on";
}

/// Where the tangent plane and the receiver's depth slope against each other, the greatest threshold lies
/// inside.
TEST_P(MapSpace, NoPlaceInABoxHasAThresholdBeyondItsRange) {
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Case c = someCase();
    ShadowKernel kernel;
    kernel.low = vec2(uniform(0, 400), uniform(0, 400));
    kernel.high = kernel.low + vec2(uniform(0, 100), uniform(0, 100));
    kernel.weight = 1;
    const vec2 range = map_threshold_range(c.view, c.in_map, kernel.low, kernel.high);
    const vec2 general = shadow_threshold_range(c.view, c.general, kernel);
    float corners = 0;
    for (const vec2& corner :
         {kernel.low, kernel.high, vec2(kernel.low.x, kernel.high.y), vec2(kernel.high.x, kernel.low.y)})
      corners = max(corners, map_threshold(c.view, c.in_map, corner));
    for (int k = 0; k < 8; ++k) {
      const vec2 place = mix(kernel.low, kernel.high, vec2(uniform(0, 1), uniform(0, 1)));
      const float at = map_threshold(c.view, c.in_map, place);
      constexpr float rounding = 1e-4f;
      EXPECT_LE(at, range.y + rounding) << i;
      EXPECT_GE(at, range.x - rounding) << i;
      inside += at > corners + rounding ? 1 : 0;
      // A plane seen edge-on has its depth from the quotient of two small numbers.
      const float same = shadow_threshold(c.view, c.general, place / 512.f);
      if (std::abs(same - at) < rounding) {
        EXPECT_LE(same, general.y + 0.01f) << i;
        EXPECT_GE(same, general.x - 0.01f) << i;
      }
    }
  }
  // The axis of other lights is the view's: the receiver's depth is one over the whole map.
  if (GetParam() == light_kind_point) {
    EXPECT_GT(inside, 100) << "corners alone do not bound it";
  }
}

/// Also where the light's centre lies beneath the tangent plane, and what blocks behind it.
TEST_P(MapSpace, BoundsOfABoxDecideAsItsTexelsDo) {
  int beneath = 0, blocked = 0;
  for (int i = 0; i < 40000; ++i) {
    const Case c = someCase();
    const vec2 low(std::floor(uniform(0, 400)), std::floor(uniform(0, 400)));
    const vec2 high = low + vec2(std::floor(uniform(0, 100)), std::floor(uniform(0, 100)));
    const vec2 range = map_threshold_range(c.view, c.in_map, low + vec2(0.5f), high + vec2(0.5f));
    const vec2 texel = floor(mix(low, high + vec2(0.99f), vec2(uniform(0, 1), uniform(0, 1))));
    const float stored = uniform(0, 1), depth = shadow_metres(c.view, stored);
    const vec3 b = shadow_texel_offset(c.view, ivec2(texel), stored);
    // Metres: where rounding decides.
    constexpr float rounding = 1e-3f;
    if (std::abs(dot(c.general.normal, b) - c.general.height) < rounding ||
        std::abs(c.general.depth - dot(c.general.axis, b)) < rounding)
      continue;
    const bool blocks = map_blocks(c.view, c.in_map, texel, depth);
    if (stored < range.x) {
      EXPECT_TRUE(blocks) << i;
    }
    if (stored >= range.y) {
      EXPECT_FALSE(blocks) << i;
    }
    if (!map_from_beneath(c.view, c.in_map)) continue;
    ++beneath;
    blocked += blocks ? 1 : 0;
  }
  EXPECT_GT(beneath, 400);
  EXPECT_GT(blocked, 40);
}

/// Of rectangles: the sides of other lights need not be the map's.
class MapBoxes : public MapSpace {};

TEST_P(MapBoxes, AKernelAcrossTheViewIsABoxOfTheMap) {
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    Case c = someCase();
    c.view.axis_x = c.light.axis_u;
    c.view.axis_y = c.light.axis_v;
    const LightView part = light_view_part(c.seen);
    const MapKernel general = map_kernel(c.view, part, c.receiver);
    const MapKernel across = map_kernel_across(c.view, part, c.receiver);
    const vec2 p(uniform(0, 1), uniform(0, 1));
    const float gap = uniform(0, 0.95f) * c.seen.depth;
    if (!(c.seen.depth > 0)) continue;
    const vec2 expected = map_texel(c.view, map_kernel_point(general, p, gap));
    if (!map_holds(c.view, expected)) continue;
    ++seen;
    const vec2 place = map_box_texel(map_box(c.view, across, gap), p);
    EXPECT_NEAR(place.x, expected.x, 2e-2f);
    EXPECT_NEAR(place.y, expected.y, 2e-2f);
    vec2 chosen, same;
    const bool counts = light_view_choose(c.seen, light_view_rise(c.seen), p, chosen);
    const vec3 slope = c.seen.centre + chosen.x * c.seen.side_u + chosen.y * c.seen.side_v;
    if (std::abs(dot(slope, c.seen.normal)) < 1e-5f) continue;
    EXPECT_EQ(light_view_choose(part, light_view_rise(part), p, same), counts);
  }
  EXPECT_GT(seen, 1000);
}

TEST(SampleSequence, StepsOfFixedPointAreTheSequence) {
  const vec2 shift(0.3f, 0.9f);
  uvec2 next(fixed_point(shift.x), fixed_point(shift.y));
  for (uint32_t i = 0; i < 5000; ++i) {
    const vec2 expected = fract(r2_sequence(i) + shift);
    // A circle: 0.99999998 and 0 are neighbours. Both roundings are of 2^-24.
    const vec2 off = abs(vec2(fixed_point_value(next.x), fixed_point_value(next.y)) - expected);
    EXPECT_LT(min(off.x, 1 - off.x), 1.3e-7f) << i;
    EXPECT_LT(min(off.y, 1 - off.y), 1.3e-7f) << i;
    next += r2_step;
  }
}

/// A set of points is a piece of the sequence, moved. Each has its counterpart on the other side of the
/// middle, so that the mean is the middle, which that of the sequence's first 16 points misses by 0.1.
TEST(SampleSequence, PointsOfASetLieAlikeOnAllSidesOfTheMiddle) {
  EXPECT_EQ(r2_point(0, 1), vec2(0.5f));
  for (const uint32_t count : {2u, 3u, 4u, 15u, 16u, 64u, 4096u}) {
    for (uint32_t i = 0; i < count; ++i) {
      // Of 2^-24 each of both points is rounded down.
      const vec2 both = r2_point(i, count) + r2_point(count - 1 - i, count);
      EXPECT_NEAR(both.x, 1, 2.5e-7f) << i << " of " << count;
      EXPECT_NEAR(both.y, 1, 2.5e-7f) << i << " of " << count;
      const vec2 off = abs(fract(r2_point(i, count) - r2_point(0, count)) - r2_sequence(i));
      EXPECT_LT(min(off.x, 1 - off.x), 2.5e-7f) << i << " of " << count;
      EXPECT_LT(min(off.y, 1 - off.y), 2.5e-7f) << i << " of " << count;
    }
  }
}

std::string kindName(const ::testing::TestParamInfo<uint32_t>& kind) {
  constexpr const char* names[] = {"Point", "Disc", "DistantRectangle", "Rectangle"};
  return names[kind.param];
}

INSTANTIATE_TEST_SUITE_P(Kinds, MapBoxes, ::testing::Values(light_kind_rectangle), kindName);
INSTANTIATE_TEST_SUITE_P(Kinds, MapSpace, ::testing::ValuesIn(kKinds), kindName);

}  // namespace
}  // namespace limn::glsl
