// The airlight of a ray with all worked out once (glsl/media/airlight_path.glsl) against the general
// functions.
#include "glsl/media/airlight_path.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "glsl/numeric/geometry.glsl"

namespace limn::glsl {
namespace {

constexpr int kSamples = 4;

/// One viewing ray, and a light or a point on it.
struct Case {
  Medium medium;
  Light light;
  AirlightRay ray;
  AirlightPath path;
  vec2 range;  // metres of the ray that lie in the medium's ball before the eye
};

class AirlightPathTest : public ::testing::TestWithParam<uint32_t> {
 protected:
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  vec3 direction() {
    const float z = uniform(-1, 1), angle = uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  vec3 somewhere(float reach) { return uniform(0, reach) * direction(); }

  Light someLight() {
    const uint32_t kind = GetParam();
    Light light{};
    light.direction = direction();
    const Frame frame = frame_around(-light.direction);
    light.axis_u = frame.t;
    light.axis_v = frame.b;
    light.position = somewhere(6);  // of lamps: in the medium or beside it
    light.emission = vec3(1, 2, 3);
    light.own_instance = no_instance;
    light.type = kind == light_kind_rectangle ? light_rectangle
                 : kind == light_kind_point   ? light_spot
                                              : light_directional;
    if (kind == light_kind_rectangle || kind == light_kind_distant_rectangle) {
      light.length_u = uniform(0.1f, 2);
      light.length_v = uniform(0.1f, 2);
    }
    if (kind == light_kind_disc) light.angular_diameter = uniform(0, 1) < 0.5f ? 0 : 0.1f;
    if (light.type != light_directional) {
      if (uniform(0, 1) < 0.5f) light.flags |= light_flag_cone;
      if (uniform(0, 1) < 0.5f) light.range = uniform(2, 8);
      if (kind == light_kind_rectangle && uniform(0, 1) < 0.5f) light.flags |= light_flag_two_sided;
      light.cos_outer = uniform(-0.2f, 0.8f);
      light.cos_inner = light.cos_outer + 0.2f;
    }
    EXPECT_EQ(light_kind(light), kind);
    return light;
  }

  Case someCase(float g) {
    Case c = begun(g);
    const vec3 source = GetParam() == light_kind_rectangle
                            ? c.light.position + uniform(-0.5f, 0.5f) * c.light.length_u * c.light.axis_u
                            : c.light.position;
    vec3 eye, way;
    do {
      eye = somewhere(8);
      way = direction();
      c.range = ball_range(c.medium.ball, eye, way);
      c.range.x = max(c.range.x, 0.f);
    } while (!(c.range.x + 0.1f < c.range.y));
    finish(c, source, eye, way);
    return c;
  }

  /// A case whose lamp or, if `camera`, whose eye is `distance` metres away; the lamp shines everywhere.
  Case farCase(float distance, bool camera) {
    Case c = begun(0);
    c.light.flags &= ~light_flag_cone;
    c.light.range = 0;
    if (!camera) c.light.position = distance * direction();
    vec3 eye, way;
    do {
      eye = camera ? distance * direction() : somewhere(8);
      way = normalize(c.medium.ball.centre + somewhere(4) - eye);
      c.range = ball_range(c.medium.ball, eye, way);
      c.range.x = max(c.range.x, 0.f);
    } while (!(c.range.x + 0.1f < c.range.y));
    finish(c, c.light.position, eye, way);
    return c;
  }

  /// Returns the radiance per unit of the variable at t metres from the eye.
  static vec3 density(const Case& c, float t) {
    const float q = t - c.path.nearest;
    return c.path.sent * (airlight_path_factor(c.path, GetParam(), q) *
                          medium_transmittance(c.medium, airlight_path_length(c.path, GetParam(), q)));
  }

  /// Returns metres of the ball between `from` and `end` metres along the unit vector `way`.
  static double inBall(const Ball& ball, const glm::dvec3& from, const glm::dvec3& way, double end) {
    const glm::dvec3 offset = from - glm::dvec3(ball.centre);
    const double nearest = -glm::dot(offset, way), radius{ball.radius};
    const glm::dvec3 across = offset + nearest * way;
    const double square = radius * radius - glm::dot(across, across);
    if (square <= 0) return 0;
    const double half = std::sqrt(square);
    return std::max(std::min(nearest + half, end) - std::max(nearest - half, 0.0), 0.0);
  }
  /// Returns those between light, the place `t` metres from the eye, and eye.
  static double trueLength(const Case& c, float t) {
    const glm::dvec3 eye(c.ray.eye), way = glm::normalize(glm::dvec3(c.ray.direction)),
                                     place = eye + double{t} * way;
    const glm::dvec3 offset = place - glm::dvec3(c.ray.source);
    const bool parallel = airlight_parallel(GetParam());
    const glm::dvec3 from = glm::normalize(parallel ? glm::dvec3(c.light.direction) : offset);
    return inBall(c.medium.ball, eye, way, double{t}) +
           inBall(c.medium.ball, place, -from, parallel ? 1e30 : glm::length(offset));
  }

 private:
  Case begun(float g) {
    Case c;
    c.medium = {vec3(0.1f, 0.2f, 0.3f), vec3(0.1f, 0.1f, 0.2f), g, {somewhere(1), 4}};
    c.light = someLight();
    return c;
  }
  static void finish(Case& c, const vec3& source, const vec3& eye, const vec3& way) {
    c.ray = airlight_ray(c.medium, c.light, source, airlight_part(c.light, kSamples), eye, way);
    c.path = airlight_path(c.medium, c.light, GetParam(), c.ray, kSamples);
  }

  std::mt19937 random_{23};
};

TEST_P(AirlightPathTest, PlacesScatterWhatTheyDo) {
  int lit = 0;
  for (const float g : {-0.99f, -0.5f, 0.f, 0.5f, 0.99f}) {
    for (int i = 0; i < 4000; ++i) {
      const Case c = someCase(g);
      const float t = mix(c.range.x, c.range.y, uniform(0.001f, 0.999f));
      const vec3 expected = airlight_density(c.medium, c.light, c.ray, t, kSamples), found = density(c, t);
      const vec3 place = airlight_path_place(c.path, t - c.path.nearest);
      EXPECT_LT(length(place - (c.ray.eye + t * c.ray.direction)), 1e-5f);
      EXPECT_FLOAT_EQ(airlight_path_variable(c.path, GetParam(), t), airlight_variable(c.ray, t));
      lit += expected.y > 0 ? 1 : 0;
      // Rounding: of places of some metres (1e-6 m) in the distance from the ray, at least 1 cm here but for
      // rare cases, in the angle from the peak of the phase function, which is 0.01 wide at g = 0.99, and on
      // the ramp of the cone.
      const float near = sqrt(c.path.across2);
      if (near < 0.01f) continue;
      const float tolerance = 2e-3f * expected.y + 2e-5f * max(c.path.sent.y, 0.f);
      EXPECT_NEAR(found.y, expected.y, tolerance)
          << g << " " << i << " at " << t << ", " << near << " m beside";
      EXPECT_NEAR(found.z * expected.y, expected.z * found.y, 1e-3f * expected.z * expected.y + 1e-12f);
    }
  }
  EXPECT_GT(lit, 5000);
}

TEST_P(AirlightPathTest, StretchesAreIntegratedAsTheyAre) {
  for (int i = 0; i < 2000; ++i) {
    const Case c = someCase(uniform(-0.5f, 0.5f));
    if (c.path.across2 < 0.01f) continue;
    const float from = airlight_path_variable(c.path, GetParam(), c.range.x);
    const float to = airlight_path_variable(c.path, GetParam(), c.range.y);
    const int steps = 1 + i % 40;
    const float stretch = (to - from) / float(steps);
    const int at = i % steps;
    const float a = from + float(at) * stretch, b = from + float(at + 1) * stretch;
    const vec2 start = airlight_end(c.path, GetParam(), a), end = airlight_end(c.path, GetParam(), b);
    // All of it, and a part.
    for (const vec2 shares : {vec2(-1, 1), vec2(-1, uniform(-0.9f, 0.9f)), vec2(uniform(-0.9f, 0.9f), 1)}) {
      const AirlightNodes nodes = airlight_nodes(GetParam(), 0.5f * stretch, shares.x, shares.y);
      vec3 found(0);
      for (const float share : {nodes.shares.x, nodes.shares.y})
        found += nodes.weight * density(c, c.path.nearest + airlight_between(start, end, share));
      const auto variable = [&](float share) {
        const float q = airlight_between(start, end, share);
        return airlight_path_variable(c.path, GetParam(), c.path.nearest + q);
      };
      const vec3 expected =
          airlight_stretch(c.medium, c.light, c.ray, variable(shares.x), variable(shares.y), kSamples);
      // Rounding of the angle, 2e-7, over that of the shortest part, and on the ramp of the cone.
      EXPECT_NEAR(found.y, expected.y, 1e-3f * expected.y + 2e-5f * nodes.weight * c.path.sent.y)
          << i << " " << shares.x << " " << shares.y;
    }
  }
}

/// Each of the roundings of places and directions, some eight of half an ulp, moves the place by 2^-24 of
/// the distance at most, and their sum by `moved`. Where a way grazes the ball of radius 4, the root of the
/// square of half its length grows by sqrt(4 * 4 moved) of it, and there are two ways.
TEST_P(AirlightPathTest, LampsAndCamerasFarAwayKeepTheLength) {
  for (const float distance : {4e3f, 4e4f}) {
    for (const bool camera : {true, false}) {
      const double moved = double{distance} * 0x1p-21;
      double sum = 0, most = 0;
      constexpr int kCases = 2000;
      for (int i = 0; i < kCases; ++i) {
        const Case c = farCase(distance, camera);
        const float t = mix(c.range.x, c.range.y, uniform(0.001f, 0.999f));
        const auto found = static_cast<double>(airlight_path_length(c.path, GetParam(), t - c.path.nearest));
        const double error = std::abs(found - trueLength(c, t));
        sum += error;
        most = std::max(most, error);
      }
      EXPECT_LT(sum / kCases, 4 * moved) << distance << (camera ? " camera" : " lamp");
      EXPECT_LT(most, 2 * (moved + std::sqrt(16 * moved))) << distance << (camera ? " camera" : " lamp");
    }
  }
}

TEST_P(AirlightPathTest, AStretchOfNoLengthHasNoLight) {
  const AirlightNodes nodes = airlight_nodes(GetParam(), 0, -1, 1);
  EXPECT_NEAR(nodes.weight, 0, 1e-19f);
  EXPECT_NEAR(nodes.shares.x, -gauss_node, 1e-6f);
  EXPECT_NEAR(nodes.shares.y, gauss_node, 1e-6f);
}

/// A light's range is about as large as its scene, which may have any size: floats need not hold its fourth
/// power, nor one over that. With even scattering and without a cone the factor is that of the range.
TEST(AirlightRanges, AreTheSameAtAllScales) {
  for (const float range : {1e-12f, 1.f, 1e12f}) {
    Light light{};
    light.type = light_point;
    light.direction = {0, -1, 0};
    light.emission = vec3(1);
    light.own_instance = no_instance;
    light.range = range;
    const Medium medium{vec3(0), vec3(1), 0, {vec3(0), range}};
    const AirlightRay ray =
        airlight_ray(medium, light, light.position, 0, range * vec3(-1, 0.1f, 0), vec3(1, 0, 0));
    const AirlightPath path = airlight_path(medium, light, light_kind_point, ray, 1);
    for (const float share : {-0.5f, 0.f, 0.7f, 0.9f}) {
      const float q = share * range;
      const float expected = range_factor(light, length(airlight_path_place(path, q)));
      EXPECT_NEAR(airlight_path_factor(path, light_kind_point, q), expected, 1e-5f) << range << " " << share;
    }
  }
}

/// As their names say, from angles that are nearly 0 to beyond where the series end.
TEST(AirlightTangents, KeepTheirPrecision) {
  for (float x = 1e-30f; x < 1.5f; x *= 1.01f) {
    for (const float angle : {x, -x}) {
      EXPECT_NEAR(airlight_tangent(angle) / std::tan(double{angle}), 1, 3e-7) << angle;
      EXPECT_NEAR(airlight_arc_tangent(angle) / std::atan(double{angle}), 1, 3e-7) << angle;
    }
  }
}

std::string lightKindName(const ::testing::TestParamInfo<uint32_t>& kind) {
  constexpr const char* names[] = {"Point", "Disc", "DistantRectangle", "Rectangle"};
  return names[kind.param];
}

INSTANTIATE_TEST_SUITE_P(Kinds, AirlightPathTest,
                         ::testing::Values(light_kind_point, light_kind_disc, light_kind_distant_rectangle,
                                           light_kind_rectangle),
                         lightKindName);

}  // namespace
}  // namespace limn::glsl
