// Laws of media and smooth interfaces (glsl/scene/media.glsl), of airlight and of the weight of light lines.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "glsl/caustics/caustic_line.glsl"
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

/// The fragments of a line between two points of the picture, one per column or row that it touches, or of
/// `rectangles` one per pixel of length; their sum with the flux, sigma_s, phase function and transmittances
/// left out, over the pixel's solid angle. What lies behind `depth` is hidden; 0: nothing.
double sumOfFragments(vec3 from, vec3 to, float focal, bool rectangles, float depth = 0) {
  const vec3 direction = normalize(to - from);
  const vec2 a = vec2(from.x, from.y) / from.z, b = vec2(to.x, to.y) / to.z;
  const vec2 larger = std::abs(b.x - a.x) >= std::abs(b.y - a.y) ? vec2(1, 0) : vec2(0, 1);
  const vec2 axis = rectangles ? normalize(b - a) : dot(larger, b - a) < 0 ? -larger : larger;
  double sum = 0;
  for (float u = std::floor(focal * dot(axis, a)); u < focal * dot(axis, b); ++u) {
    const vec2 part = caustic_line_part(from, direction, axis, vec2(0, length(to - from)), depth,
                                        vec2(u / focal, (u + 1) / focal));
    if (!(part.x < part.y)) continue;
    const float l = caustic_line_position(from, direction, axis, axis * (0.5f * (part.x + part.y)));
    const vec3 x = from + l * direction;
    const float rate = dot(caustic_line_rate(x, direction), axis);
    const double cosine = x.z / length(x), share = double(part.y - part.x) * double(focal);
    sum += share * caustic_line_weight(x, rate, focal) * cosine * cosine * cosine / (focal * focal);
  }
  return sum;
}

/// The same by quadrature of the line: int dl / R^2.
double irradianceOfLine(vec3 from, vec3 to, float depth = 0) {
  double sum = 0;
  constexpr int n = 20000;
  for (int k = 0; k < n; ++k) {
    const vec3 x = mix(from, to, (k + 0.5f) / n);
    if (depth == 0 || x.z < depth) sum += length(to - from) / n / dot(x, x);
  }
  return sum;
}

/// In double precision fragments of these lines are off by up to 8e-5 where the focal length is 40 pixels.
TEST(CausticLine, FragmentsSumToTheIrradianceOfTheLineAtTheEye) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int i = 0; i < 60; ++i) {
    const vec3 from(2 * unit(random), 2 * unit(random), 3 + 2 * unit(random));
    const vec3 to = from + vec3(unit(random), unit(random), 0.9f * unit(random));
    if (to.z < 0.5f) continue;
    const float half = 0.5f * (from.z + to.z);
    const double exact = irradianceOfLine(from, to), exactHalf = irradianceOfLine(from, to, half);
    for (const bool rectangles : {false, true}) {
      SCOPED_TRACE(testing::Message() << "line " << i << (rectangles ? ", a rectangle" : ", by columns"));
      EXPECT_NEAR(sumOfFragments(from, to, 4000, rectangles) / exact, 1, 1e-3);
      EXPECT_NEAR(sumOfFragments(from, to, 40, rectangles) / exact, 1, 1e-3) << "a line of some pixels";
      EXPECT_NEAR(sumOfFragments(from, to, 40, rectangles, half) / exactHalf, 1, 1e-3) << "half of it hidden";
      EXPECT_EQ(sumOfFragments(from, to, 40, rectangles, 0.9f * std::min(from.z, to.z)), 0)
          << "all of it hidden";
    }
    const double cosine = [&] {
      const vec3 middle = 0.5f * (from + to);
      return double(middle.z / length(middle));
    }();
    const vec3 middle = 0.5f * (from + to), piece = 1e-3f * (to - from);
    double little = length(piece) / dot(middle, middle);
    EXPECT_NEAR(caustic_point_weight(middle - 0.5f * piece, middle + 0.5f * piece, 4000) /
                    (little * 4000.0 * 4000.0 / std::pow(cosine, 3)),
                1, 2e-3);
  }
}

/// A line that is seen end-on, from 1 to 10 m, in a medium that takes light on both ways: int exp(-2 k l) dl
/// / l^2. At its middle alone there would be a fortieth of it.
TEST(CausticLine, NodesOfAPointShareTheIntegralOverTheSquaredDistance) {
  constexpr int nodes = 8, steps = 100000;
  const vec3 along = normalize(vec3(0.2f, -0.1f, 1)), a = along, b = 10.f * along;
  for (const float k : {0.f, 0.1f, 0.5f}) {
    double sum = 0, expected = 0;
    for (int i = 0; i < nodes; ++i) {
      const float share = caustic_point_node(a, b, (float(i) + 0.5f) / nodes);
      sum += std::exp(-2 * double(k) * double(length(a + share * (b - a)))) * 0.9 / nodes;
    }
    for (int i = 0; i < steps; ++i) {
      const double l = 1 + 9 * (i + 0.5) / steps;
      expected += 9.0 / steps * std::exp(-2 * double(k) * l) / (l * l);
    }
    EXPECT_NEAR(sum / expected, 1, 0.003) << k;
  }
}

/// Of lines through the middle of the picture in directions that are even over the sphere: each has as many
/// fragments as its weight assumes, a metre of it rate * focal / away.
TEST(CausticLine, TheEvenWeightScattersAsMuchFromLinesInAllDirections) {
  constexpr int n = 200;
  constexpr float focal = 400;
  for (const bool rectangles : {false, true})
    for (const float away : {0.1f, 5.f}) {
      const vec3 x(0, 0, away);
      double exact = 0, even = 0;
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
          const double z = 2 * (i + 0.5) / n - 1, r = std::sqrt(1 - z * z), angle = 2 * M_PI * (k + 0.5) / n;
          const vec3 direction(float(r * std::cos(angle)), float(r * std::sin(angle)), float(z));
          const vec2 rates = abs(caustic_line_rate(x, direction));
          const float rate = rectangles ? length(rates) : std::max(rates.x, rates.y);
          const double fragments = double(rate) * double(focal / away);
          exact += fragments * double(caustic_line_weight(x, rate, focal));
          even += fragments * double(caustic_even_weight(away, focal, rectangles));
        }
      EXPECT_NEAR(even / exact, 1, 1e-3) << rectangles << " " << away;
    }
}

/// The widths of beams' sides in pixels, from none over parts of a pixel to many pixels.
constexpr float kWidths[] = {0, 1e-6f, 0.01f, 0.3f, 1, 2.7f, 40, 1000};

/// Pixels lie next to each other, so that whatever lies between them is counted once.
TEST(CausticBeam, ThePixelsAcrossABeamHaveAllItsLight) {
  for (const float a : kWidths)
    for (const float b : kWidths)
      for (const float shift : {0.f, 0.2f, 0.5f, 0.93f}) {
        const int reach = int(0.5f * (a + b)) + 3;
        double sum = 0;
        for (int i = -reach; i <= reach; ++i) {
          const float profile = caustic_beam_profile(a, b, float(i) + shift);
          ASSERT_GE(profile, 0);
          if (std::abs(float(i) + shift) > 0.501f * (a + b + 1)) {
            ASSERT_LT(profile, 1e-6f);
          }
          sum += double(profile);
        }
        EXPECT_NEAR(sum, 1, 2e-3) << a << " " << b << " " << shift;
      }
}

/// Along either side of a lattice, whatever the other one is: each beam holds the light of a parallelogram,
/// and there is one for every `step` pixels.
TEST(CausticBeam, BeamsOfALatticeAddUpToTheSameEverywhere) {
  for (const float step : kWidths) {
    if (step < 0.01f) continue;  // the sum has no end
    for (const float other : kWidths)
      for (const float place : {0.f, 0.13f, 0.5f, 0.77f}) {
        const int reach = int(0.5f * (step + other + 1) / step) + 3;
        double first = 0, second = 0;
        for (int i = -reach; i <= reach; ++i) {
          const float away = (float(i) - place) * step;
          first += double(caustic_beam_profile(step, other, away) * step);
          second += double(caustic_beam_profile(other, step, away) * step);
        }
        EXPECT_NEAR(first, 1, 2e-3) << step << " " << other << " " << place;
        EXPECT_NEAR(second, first, 1e-6) << step << " " << other << " " << place;
      }
  }
}

/// Sides that keep their length, shrink, turn over, or vanish, in all pairs, against places all along the
/// beam.
TEST(CausticBeam, NoPlaceIsNarrowerThanTheNarrowest) {
  constexpr vec2 kSides[] = {{0, 0},  {1, 1},     {1, 2},  {3, 0.5f},
                             {-1, 2}, {2, -0.1f}, {0, -4}, {1e-6f, -1e-6f}};
  const auto width = [](const vec2& u, const vec2& v, float share) {
    return abs(mix(u.x, u.y, share)) + abs(mix(v.x, v.y, share));
  };
  for (const vec2& u : kSides)
    for (const vec2& v : kSides) {
      const float narrowest = caustic_beam_narrowest(u, v);
      ASSERT_GE(narrowest, 0);
      ASSERT_LE(narrowest, 1);
      for (int i = 0; i <= 1000; ++i)
        ASSERT_LE(width(u, v, narrowest), width(u, v, float(i) / 1000) + 1e-6f)
            << u.x << " " << u.y << " " << v.x << " " << v.y << " " << i;
    }
}

/// One box of both widths, which has the same light, does not: this is what drew lines between beams.
TEST(CausticBeam, ABeamIsATrapezoidBeforePixelsBlurIt) {
  EXPECT_NEAR(caustic_beam_profile(100, 40, 0), 1.f / 100, 1e-6f);
  EXPECT_NEAR(caustic_beam_profile(100, 40, 29), 1.f / 100, 1e-6f);
  EXPECT_NEAR(caustic_beam_profile(100, 40, 50), 0.5f / 100, 1e-6f);
  EXPECT_NEAR(caustic_beam_profile(100, 40, -60), 0.25f / 100, 1e-6f);
  EXPECT_EQ(caustic_beam_profile(0, 0, 0.49f), 1);
  EXPECT_EQ(caustic_beam_profile(0, 0, 0.51f), 0);
}

}  // namespace
}  // namespace limn::glsl
