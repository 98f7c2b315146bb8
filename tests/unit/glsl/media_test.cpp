// Laws of media and smooth interfaces (glsl/scene/media.glsl), and of airlight.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/media/airlight.glsl"

namespace limn::glsl {
namespace {

/// f(cosine) integrated over the sphere, with steps that are fine where 1 - cosine is small.
template <class F>
double overSphere(const F& f) {
  constexpr int n = 200000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {  // theta = pi s^3
    const double s = (i + 0.5) / n, theta = M_PI * s * s * s;
    sum += f(theta) * 2 * M_PI * std::sin(theta) * 3 * M_PI * s * s / n;
  }
  return sum;
}

/// All directions count alike where light passes, by their cosine where it arrives: one over the mean cosine
/// of the disc's directions.
TEST(LightFluence, OfADiscIsOneOverItsMeanCosine) {
  for (const double diameter : {0.01, 0.5, 2.0, 3.1}) {
    Light sun{};
    sun.type = light_directional;
    sun.angular_diameter = float(diameter);
    constexpr int n = 100000;
    double passing = 0, arriving = 0;
    for (int i = 0; i < n; ++i) {
      const double angle = 0.5 * diameter * (i + 0.5) / n;
      passing += std::sin(angle);
      arriving += std::sin(angle) * std::cos(angle);
    }
    EXPECT_NEAR(double(light_fluence(sun)) * arriving / passing, 1, 1e-5) << diameter;
  }
  Light other{};
  for (const uint32_t type : {light_point, light_spot, light_directional, light_rectangle}) {
    other.type = type;
    EXPECT_EQ(light_fluence(other), 1.f) << type;
  }
}

TEST(PhaseFunction, IntegratesToOneAndHasItsMeanCosine) {
  for (const float g : {-0.99f, -0.7f, 0.f, 0.3f, 0.7f, 0.9f, 0.99f}) {
    const auto p = [&](double theta) {
      const double angle = g < 0 ? M_PI - theta : theta;  // fine steps at the peak
      const vec3 to(float(std::sin(angle)), 0, float(std::cos(angle)));
      return double(phase_function(g, vec3(0, 0, 1), to));
    };
    EXPECT_NEAR(overSphere(p), 1, 1e-4) << g;
    const double mean = overSphere([&](double theta) { return p(theta) * std::cos(theta); });
    EXPECT_NEAR(g < 0 ? -mean : mean, g, 1e-4) << g;
  }
}

TEST(PhaseFunction, PositiveGIsForward) {
  const vec3 forward(0, 0, 1);
  EXPECT_GT(phase_function(0.5f, forward, forward), 10 * phase_function(0.5f, forward, -forward));
  EXPECT_FLOAT_EQ(phase_function(0, forward, forward), 0.25f * inverse_pi);
}

TEST(Interface, ReflectionAndRefractionFollowSnellsLaw) {
  const vec3 n(0, 1, 0);
  for (const float ior : {1.0001f, 1.33f, 1.5f, 2.42f, 3.f})
    for (float angle = 0; angle < 1.55f; angle += 0.05f) {
      const vec3 l(std::sin(angle), std::cos(angle), 0);
      EXPECT_NEAR(distance(mirrored(l, n), vec3(-l.x, l.y, 0)), 0, 1e-6f);
      const vec3 t = refracted(l, n, 1 / ior);
      EXPECT_NEAR(length(t), 1, 1e-6f);
      EXPECT_NEAR(-t.x * ior, l.x, 2e-6f);
      EXPECT_LT(t.y, 0);
      const vec3 back = refracted(t, -n, ior);  // the path can be reversed
      EXPECT_NEAR(distance(back, l), 0, 2e-3f) << ior << " " << angle;
    }
}

TEST(Interface, TotalInternalReflectionBeyondTheCriticalAngle) {
  const vec3 n(0, 1, 0);
  for (const float ior : {1.0001f, 1.5f, 2.42f, 3.f}) {
    const float critical = std::asin(1 / ior);
    for (const float offset : {-1e-3f, 1e-3f}) {
      const float angle = critical + offset;
      const vec3 l(std::sin(angle), std::cos(angle), 0);
      EXPECT_EQ(refracted(l, n, ior) == vec3(0), offset > 0) << ior;
      EXPECT_EQ(fresnel_reflectance(l.y, ior, 1) == 1.0f, offset > 0) << ior;
    }
  }
}

TEST(Interface, FresnelIsTheSameFromBothSidesAndKeepsEnergy) {
  for (const float ior : {1.0001f, 1.5f, 2.42f, 3.f}) {
    const float normal = (ior - 1) / (ior + 1);
    EXPECT_NEAR(fresnel_reflectance(1, 1, ior), normal * normal, 1e-7f);
    EXPECT_NEAR(fresnel_reflectance(0, 1, ior), 1, 1e-6f);
    for (float cosine = 0.01f; cosine < 1; cosine += 0.01f) {
      const float there = fresnel_reflectance(cosine, 1, ior);
      const float inside = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
      EXPECT_NEAR(there, fresnel_reflectance(inside, ior, 1), 2e-4f) << ior << " " << cosine;
      Optics glass{vec3(1), 0, 1, ior, 1, vec3(1), 0};
      EXPECT_NEAR(optics_reflectance(glass, cosine, 1, ior).x + optics_transmittance(glass, cosine, 1, ior).x,
                  1, 1e-6f);
    }
  }
}

TEST(Interface, BrewstersAngleReflectsHalfOfTheOtherPolarisation) {
  const double angle = std::atan(1.5);
  const double perpendicular = std::pow(std::sin(angle - (M_PI / 2 - angle)), 2);
  EXPECT_NEAR(fresnel_reflectance(float(std::cos(angle)), 1, 1.5f), 0.5 * perpendicular, 1e-6);
}

TEST(Interface, ThinWallsDoNotBend) {
  const Optics wall{vec3(1), 0, 1, 1.5f, 0, vec3(1), 0};
  const vec3 direction = normalize(vec3(1, -2, 0.5f));
  EXPECT_EQ(specular_event(wall, direction, vec3(0, 1, 0), false).refracted, direction);
}

TEST(Ball, LengthOfARayInside) {
  const Ball ball{vec3(1, 2, 3), 2};
  const vec3 x(1, 0, 0);
  EXPECT_FLOAT_EQ(ball_length(ball, vec3(-5, 2, 3), x, 1e30f), 4);
  EXPECT_FLOAT_EQ(ball_length(ball, vec3(1, 2, 3), x, 1e30f), 2);
  EXPECT_FLOAT_EQ(ball_length(ball, vec3(1, 2, 3), x, 0.5f), 0.5f);
  EXPECT_FLOAT_EQ(ball_length(ball, vec3(5, 2, 3), x, 1e30f), 0);
  EXPECT_FLOAT_EQ(ball_length(ball, vec3(-5, 4.5f, 3), x, 1e30f), 0);
  EXPECT_FLOAT_EQ(ball_length_between(ball, vec3(0, 2, 3), vec3(2, 2, 3)), 2);
  EXPECT_EQ(ball_length_between(ball, vec3(1), vec3(1)), 0);
}

TEST(Ball, TransmittanceOfASlabIsExponentialAndNeverOverflows) {
  const Medium m{vec3(0.5f, 1, 1000), vec3(0), 0, {vec3(0), 1}};
  const vec3 t = medium_transmittance(m, ball_length_between(m.ball, vec3(-3, 0, 0), vec3(3, 0, 0)));
  EXPECT_NEAR(t.x, std::exp(-1.0), 1e-6);
  EXPECT_NEAR(t.y, std::exp(-2.0), 1e-6);
  EXPECT_EQ(t.z, 0);
}

/// Airlight of a point source of 1 W/sr, by brute force.
double bruteForce(const Medium& m, const vec3& source, const vec3& eye, const vec3& direction, double end) {
  constexpr int n = 400000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = end * (i + 0.5) / n;
    const vec3 x = eye + float(t) * direction, from = x - source;
    const double r = length(from);
    sum += end / n * m.scattering.x * phase_function(m.g, normalize(from), -direction) *
           std::exp(-m.extinction.x * (t + r)) / (r * r);
  }
  return sum;
}

TEST(Airlight, MeetsNumericQuadrature) {
  Light light{};
  light.position = vec3(0.4f, 0.7f, -3);
  light.emission = vec3(1);
  light.type = light_point;
  light.own_instance = no_instance;
  for (const float g : {-0.7f, 0.f, 0.7f, 0.9f})
    for (const float away : {0.7f, 0.1f, 0.01f}) {
      light.position.y = away;
      const Medium m{vec3(0.3f), vec3(0.2f), g, {vec3(0), 20}};
      const vec3 eye(0), direction = normalize(vec3(0.02f, 0, -1));
      const AirlightRay ray = airlight_ray(m, light, light.position, 0, eye, direction);
      vec3 sum(0);
      const float from = airlight_variable(ray, 0), to = airlight_variable(ray, 9);
      constexpr int steps = 32;
      for (int i = 0; i < steps; ++i)
        sum += airlight_stretch(m, light, ray, mix(from, to, i / float(steps)),
                                mix(from, to, (i + 1) / float(steps)), 1);
      const double exact = bruteForce(m, light.position, eye, direction, 9);
      EXPECT_NEAR(sum.x / exact, 1, 2e-3) << g << " " << away;
    }
}

TEST(Airlight, ParallelLightThroughASlab) {
  Light light{};
  light.direction = vec3(0, -1, 0);
  light.emission = vec3(2);
  light.type = light_directional;
  light.own_instance = no_instance;
  const Medium m{vec3(0), vec3(0.2f), 0, {vec3(0), 1}};  // extinction 0: nothing is lost
  const vec3 eye(0, 0, 3), direction(0, 0, -1);
  const AirlightRay ray = airlight_ray(m, light, vec3(0), 0, eye, direction);
  EXPECT_NEAR(airlight_stretch(m, light, ray, 2, 4, 1).x, 2 * 0.2 * 0.25 / M_PI * 2, 1e-6);
}

/// Places of random rays, and of rays through the apex, along the cone's side and across a half-space, are in
/// the range where the cone lets light pass and nowhere else.
TEST(Airlight, TheRangeOfAConeIsWhereItsFactorIsNotZero) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  const auto direction = [&] { return normalize(vec3(normal(random), normal(random), normal(random))); };
  Light light{};
  light.position = vec3(0.3f, -0.2f, 0.5f);
  light.type = light_spot;
  light.flags = light_flag_cone;
  light.own_instance = no_instance;
  const vec3 apex(light.position);
  int lit = 0;
  for (int i = 0; i < 4000; ++i) {
    const float angle = i % 5 == 0 ? 0.5f * pi : 0.02f + 1.5f * float(i % 97) / 97;
    const vec3 axis = direction();
    light.direction = axis;
    light.cos_inner = std::cos(0.9f * angle);
    light.cos_outer = i % 5 == 0 ? 0 : std::cos(angle);
    const vec3 beside = normalize(cross(axis, direction()));
    const vec3 side = std::cos(angle) * axis + std::sin(angle) * beside;
    const std::array ways{direction(), side, -side, axis, beside};
    const vec3 w = ways[std::size_t(i) % ways.size()];
    const vec3 eye = apex + (i % 7 == 0 ? -2.f * w : vec3(normal(random), normal(random), normal(random)));
    const vec2 range = light_cone_range(light, eye, w);
    for (float t = -8; t < 8; t += 0.11f) {
      const vec3 offset = eye + t * w - apex;
      const float past = dot(axis, normalize(offset)) - light.cos_outer;  // > 0: inside
      if (std::abs(past) < 1e-4f) continue;
      const bool inRange = range.x < t && t < range.y;
      EXPECT_EQ(inRange, past > 0) << i << " at " << t << ": " << range.x << " " << range.y;
      lit += past > 0;
    }
  }
  EXPECT_GT(lit, 100000);
  light.flags = 0;
  EXPECT_LT(light_cone_range(light, vec3(0), vec3(1, 0, 0)).x, -1e38f);
}

/// The same of the distance at which a light ends.
TEST(Airlight, TheBallOfALightIsWhereItsRangeLetsLightPass) {
  std::mt19937 random(8);
  std::normal_distribution<float> normal;
  const auto place = [&] { return vec3(normal(random), normal(random), normal(random)); };
  int lit = 0;
  for (int i = 0; i < 2000; ++i) {
    Light light{};
    light.type = i % 2 ? light_point : light_rectangle;
    light.position = place();
    light.range = 0.1f + 2 * float(i % 97) / 97;
    const vec3 eye = 2.f * place(), w = normalize(place());
    const vec2 range = light_ball_range(light, eye, w);
    for (float t = -8; t < 8; t += 0.11f) {
      const float distance = length(eye + t * w - vec3(light.position));
      if (std::abs(distance - light.range) < 1e-4f) continue;
      const bool passes = range_factor(light, distance) > 0;
      EXPECT_EQ(range.x < t && t < range.y, passes) << i << " at " << t << ": " << range.x << " " << range.y;
      lit += passes;
    }
  }
  EXPECT_GT(lit, 3000);
  Light light{};
  light.range = 0;
  EXPECT_LT(light_ball_range(light, vec3(0), vec3(1, 0, 0)).x, -1e38f);
  light.type = light_directional;
  light.range = 1;
  EXPECT_LT(light_ball_range(light, vec3(0), vec3(1, 0, 0)).x, -1e38f);
}

/// Of an area light whose centre stands for all of it: on the axis of a disc of the same area, which has a
/// closed form, the light is right far away and on the disc, and never more than (1 + sqrt(2)) / 2 times as
/// much.
TEST(Airlight, DiscsSendNoMoreThanTheirSolidAngle) {
  constexpr float side = 2;
  Light light{};
  light.direction = vec3(0, 0, 1);
  light.axis_u = vec3(1, 0, 0);
  light.length_u = side;
  light.axis_v = vec3(0, -1, 0);
  light.length_v = side;
  light.emission = vec3(3);
  light.type = light_rectangle;
  light.own_instance = no_instance;
  const Medium m{vec3(0), vec3(0.2f), 0, {vec3(0), 1000}};  // extinction 0: nothing is lost
  const double radius2 = side * side / M_PI;
  for (const float away : {1e-3f, 0.01f, 0.1f, 0.5f, 1.f, 2.f, 10.f, 100.f}) {
    const vec3 eye(0, 0, 1.001f * away), direction(0, 0, -1);
    const AirlightRay ray = airlight_ray(m, light, vec3(0), airlight_part(light, 1), eye, direction);
    const float step = 0.002f * away;
    const double scattered =
        airlight_stretch(m, light, ray, airlight_variable(ray, 0), airlight_variable(ray, step), 1).x / step;
    const double solidAngle = 2 * M_PI * (1 - away / std::sqrt(away * away + radius2));
    const double exact = 0.2 * 3 * solidAngle / (4 * M_PI);
    EXPECT_GT(scattered / exact, 0.999) << away;
    EXPECT_LT(scattered / exact, 0.5 * (1 + std::sqrt(2.0)) + 1e-3) << away;
    if (away < 0.02f || away > 5) {
      EXPECT_NEAR(scattered / exact, 1, 0.02) << away;
    }
  }
}

}  // namespace
}  // namespace limn::glsl
