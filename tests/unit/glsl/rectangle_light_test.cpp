// Geometry and irradiance of a rectangle light, against closed forms and double-precision integration.
#include "glsl/light/rectangle_light.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace limn::glsl {
namespace {

Rectangle rectangle(dvec3 centre, dvec3 u, dvec3 v) {
  return {vec3(centre), vec3(u), vec3(v)};
}

dmat3 randomRotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const dvec3 n = normalize(dvec3(normal(random), normal(random), normal(random)));
  const dvec3 t = normalize(cross(n, dvec3(normal(random), normal(random), normal(random))));
  return {t, cross(n, t), n};
}

/// Irradiance by Gauss-Legendre quadrature over (a, b) in double, n.P clipped at 0.
double irradianceByQuadrature(const Rectangle& r, const vec3& n, int cells = 400) {
  const dvec3 c(r.centre), u(r.u), v(r.v), normal(n), area = cross(u, v);
  const double node = 0.5 / std::sqrt(3.0);
  double sum = 0;
  for (int i = 0; i < cells * 2; ++i) {
    for (int j = 0; j < cells * 2; ++j) {
      const double a = (i / 2 + 0.5 + (i % 2 ? node : -node)) / cells - 0.5;
      const double b = (j / 2 + 0.5 + (j % 2 ? node : -node)) / cells - 0.5;
      const dvec3 p = c + a * u + b * v;
      const double d2 = dot(p, p);
      sum += std::max(0.0, dot(normal, p)) * std::abs(dot(p, area)) / (d2 * d2);
    }
  }
  return sum / (4.0 * cells * cells);
}

/// Form factor times pi of a rectangle a x b parallel to a small surface at distance h under one corner
/// (Howell, configuration factor C-11).
double cornerIrradiance(double a, double b, double h) {
  const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  return 0.5 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

TEST(RectangleLight, ParallelSurfaceUnderACornerIsTheClosedForm) {
  double worst = 0;
  for (double scale : {1e-4, 1.0, 1e4}) {
    for (double distance : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5}) {
      for (double aspect : {1.0, 0.1, 1e-3}) {
        const double a = scale, b = scale * aspect, h = scale * distance;
        const Rectangle r = rectangle({a / 2, b / 2, h}, {a, 0, 0}, {0, b, 0});
        const double expected = cornerIrradiance(a, b, h);
        const double error = std::abs(rectangle_irradiance(r, vec3(0, 0, 1)) / expected - 1);
        EXPECT_LT(error, 5e-6) << scale << ' ' << distance << ' ' << aspect;
        worst = std::max(worst, error);
      }
    }
  }
  RecordProperty("worst_relative_error_1e9", static_cast<int>(worst * 1e9));
}

TEST(RectangleLight, RandomPlacementsMatchQuadrature) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 60; ++i) {
    const dmat3 m = randomRotation(random);
    const double size = std::pow(10.0, 2 * unit(random) - 1.5);
    const dvec3 c = m * dvec3(2 * unit(random) - 1, 2 * unit(random) - 1, 1);
    const Rectangle r = rectangle(c, randomRotation(random)[0] * size, dvec3(0));
    const dvec3 side = normalize(cross(dvec3(r.u), randomRotation(random)[1]));
    const Rectangle full = {r.centre, r.u, vec3(side * size * unit(random))};
    const vec3 n = vec3(randomRotation(random)[2]);
    const double expected = irradianceByQuadrature(full, n);
    EXPECT_NEAR(rectangle_irradiance(full, n), expected, 1e-4 * expected + 3e-6) << i;
  }
}

// The classic form of Lambert's sum in double precision is the reference far away, where floats of it are
// noise.
double irradianceClassic(const Rectangle& r, const vec3& n) {
  const dvec3 c(r.centre), u(r.u), v(r.v);
  const dvec3 p[4] = {c - 0.5 * (u + v), c + 0.5 * (u - v), c + 0.5 * (u + v), c - 0.5 * (u - v)};
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const dvec3 normal = cross(p[i], p[(i + 1) % 4]);
    const double sine = length(normal);
    sum += std::atan2(sine, dot(p[i], p[(i + 1) % 4])) / sine * dot(normal, dvec3(n));
  }
  return std::abs(0.5 * sum);
}

TEST(RectangleLight, KeepsItsPrecisionAtEveryDistance) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (double distance : {2.0, 10.0, 100.0, 1e3, 1e4}) {
    for (int i = 0; i < 2000; ++i) {
      const dmat3 m = randomRotation(random), light = randomRotation(random);
      const double scale = std::pow(10.0, 8 * unit(random) - 4);
      const Rectangle r =
          rectangle(m[2] * (distance * scale), light[0] * scale, light[1] * (scale * unit(random)));
      const vec3 n = vec3(normalize(m[2] + 0.5 * m[0]));
      const double facing =
          std::abs(dot(normalize(dvec3(r.centre)), normalize(cross(dvec3(r.u), dvec3(r.v)))));
      if (facing < 0.05) continue;  // edge-on: the inputs' own rounding decides
      const double error = std::abs(rectangle_irradiance(r, n) / irradianceClassic(r, n) - 1);
      const double aspect = double(length(r.u)) / length(r.v);
      ASSERT_LT(error, (1e-6 + 2e-7 * aspect) / facing) << distance << ' ' << facing << ' ' << aspect;
      worst = std::max(worst, error * facing);
    }
  }
  RecordProperty("worst_relative_error_1e9", static_cast<int>(worst * 1e9));
}

TEST(RectangleLight, SeenEdgeOnItsErrorIsAbsolute) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const dmat3 m = randomRotation(random);
    const double height = std::pow(10.0, -6 * unit(random));
    const Rectangle r = rectangle(m * dvec3(2, 3 * unit(random) - 1.5, height), m[0], m[1]);
    const vec3 n = vec3(normalize(m[0] + 0.3 * m[2]));
    if (rectangle_above(r, n).count != 4) continue;
    ASSERT_NEAR(rectangle_irradiance(r, n), irradianceClassic(r, n), 1e-6);
  }
}

TEST(RectangleLight, DegeneratePlacesAreFiniteAndBounded) {
  const Rectangle flat = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const dvec3 receiver :
       {dvec3(0), dvec3(0.5, 0.5, 0), dvec3(0.5, 0, 0), dvec3(3, 0, 0), dvec3(0.5, 0.5, 1e-7),
        dvec3(0.5, 0.2, -1e-7), dvec3(0, 0, 1e-30), dvec3(1e4, 0, 0), dvec3(0, 0, 1e18)}) {
    for (const vec3 n : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), normalize(vec3(1, 1, 1e-4f))}) {
      Rectangle r = flat;
      r.centre = vec3(-receiver);
      const float e = rectangle_irradiance(r, n);
      EXPECT_TRUE(std::isfinite(e) && e >= 0 && e <= pi);
      const float solidAngle = rectangle_solid_angle(r, rectangle_above(r, n));
      EXPECT_TRUE(std::isfinite(solidAngle) && solidAngle >= 0 && solidAngle <= 6.2832f);
    }
  }
  const Rectangle nothing = rectangle({0, 0, 1}, {1, 0, 0}, {0, 0, 0});
  EXPECT_EQ(rectangle_irradiance(nothing, vec3(0, 0, 1)), 0);
  // A rectangle that fills the sky: pi, and half of it for a wall.
  const Rectangle sky = rectangle({0, 0, 1e-4}, {100, 0, 0}, {0, 100, 0});
  EXPECT_NEAR(rectangle_irradiance(sky, vec3(0, 0, 1)), pi, 1e-4);
  EXPECT_NEAR(rectangle_irradiance(sky, vec3(1, 0, 0)), pi / 2, 1e-4);
  EXPECT_NEAR(rectangle_irradiance(sky, vec3(0, 0, -1)), 0, 1e-6);
}

/// Of a receiver that touches the light both horizons, that of its triangle and that of its shading normal,
/// pass through it: they meet in a vertex where it is itself. No surface receives more than pi. Vertices are
/// rounded to 6e-8 sides and taken to be no nearer than 1e-7, so that the two edges of that one turn by 0.6
/// at most and add no more than half of pi.
TEST(RectangleLight, TouchedBetweenTwoHorizonsItIsFiniteAndBounded) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> inside(-0.4f, 0.4f);
  for (const float scale : {1e-6f, 1.f, 1e6f}) {
    for (int i = 0; i < 20000; ++i) {
      const vec3 centre(inside(random), i % 2 == 0 ? 0.f : inside(random), 2e-8f * inside(random));
      const Rectangle r{scale * centre, scale * vec3(1, 0, 0), scale * vec3(0, 1, 0)};
      const vec3 ng(randomRotation(random)[2]), n(randomRotation(random)[2]);
      const RectanglePart part = rectangle_part_above(r, rectangle_above(r, ng), n);
      const float irradiance = std::abs(dot(rectangle_vector_irradiance(r, part), n));
      EXPECT_TRUE(irradiance <= 1.5f * pi) << irradiance << " at scale " << scale;
    }
  }
}

TEST(RectangleLight, ClippingKeepsTheAreaAboveTheHorizon) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int pentagons = 0;
  for (int i = 0; i < 3000; ++i) {
    const dmat3 light = randomRotation(random);
    const Rectangle r =
        rectangle(randomRotation(random)[0] * unit(random), light[0], light[1] * unit(random));
    const vec3 n = vec3(randomRotation(random)[0]);
    const RectanglePart part = rectangle_above(r, n);
    pentagons += part.count == 5;
    const float share = rectangle_part_share(part);
    ASSERT_GE(share, 0);
    ASSERT_LE(share, 1);
    for (int k = 0; k < part.count; ++k) ASSERT_GE(dot(n, rectangle_point(r, part.vertex[k])), -1e-6f);
    // Complementary parts add up to the whole, in area and solid angle.
    const RectanglePart below = rectangle_above(r, -n);
    ASSERT_NEAR(share + rectangle_part_share(below), 1, 1e-5);
    if (i % 30 == 0) {
      int inside = 0;
      for (int k = 0; k < 10000; ++k) {
        const vec2 ab(float((k % 100 + 0.5) / 100 - 0.5), float((k / 100 + 0.5) / 100 - 0.5));
        inside += dot(n, rectangle_point(r, ab)) >= 0;
      }
      ASSERT_NEAR(share, inside / 10000.0, 0.015);
    }
    if (std::abs(dot(normalize(cross(r.u, r.v)), r.centre)) > 1e-2f && part.count > 0 && below.count > 0) {
      const float whole = rectangle_solid_angle(r, rectangle_whole());
      ASSERT_NEAR(rectangle_solid_angle(r, part) + rectangle_solid_angle(r, below), whole,
                  1e-5 + 1e-4 * whole);
    }
  }
  EXPECT_GT(pentagons, 100);
}

TEST(RectangleLight, SamplesAreUniformOverThePart) {
  const Rectangle r = rectangle({0.1, 0.2, 0.3}, {1, 0, 0}, {0, 1, 0});
  const vec3 n = normalize(vec3(0.8f, 0.5f, 0.3f));
  const RectanglePart part = rectangle_above(r, n);
  ASSERT_EQ(part.count, 5);
  const int count = 1000000, bins = 8;
  std::vector<double> counted(bins * bins), expected(bins * bins);
  double total = 0;
  for (int i = 0; i < count; ++i) {
    // Roberts' R2 sequence: evenly spread, aligned with no bin.
    const vec2 u(float(std::fmod(0.5 + i * 0.7548776662466927, 1.0)),
                 float(std::fmod(0.5 + i * 0.5698402909980532, 1.0)));
    const vec2 ab = rectangle_part_sample(part, u);
    ASSERT_GE(dot(n, rectangle_point(r, ab)), -1e-6f);
    const auto bin = [&](vec2 p) {
      const int x = std::clamp(int((p.x + 0.5f) * bins), 0, bins - 1);
      return x + bins * std::clamp(int((p.y + 0.5f) * bins), 0, bins - 1);
    };
    counted[bin(ab)] += 1;
    const vec2 grid = u - vec2(0.5f);
    if (dot(n, rectangle_point(r, grid)) >= 0) {
      expected[bin(grid)] += 1;
      total += 1;
    }
  }
  for (int i = 0; i < bins * bins; ++i) {
    EXPECT_NEAR(counted[i] / count, expected[i] / total, 1e-4) << i;
  }
}

TEST(RectangleLight, SolidAngleOfACubeFaceAndOfADistantSquare) {
  const Rectangle face = rectangle({0, 0, 1}, {2, 0, 0}, {0, 2, 0});
  EXPECT_NEAR(rectangle_solid_angle(face, rectangle_whole()), 4 * M_PI / 6, 1e-6);
  const Rectangle distant = rectangle({0, 3e4, 4e4}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(rectangle_solid_angle(distant, rectangle_whole()) / (0.8 / 2.5e9), 1, 1e-5);
}

TEST(RectangleLight, VisiblePartNeedsTheFrontOfTheLight) {
  Light light{};
  light.position = vec3(0, 2, 0);
  light.direction = vec3(0, -1, 0);
  light.axis_u = vec3(1, 0, 0);
  light.length_u = 2;
  light.axis_v = vec3(0, 0, -1);
  light.length_v = 1;
  light.type = light_rectangle;
  light.own_instance = no_instance;
  ASSERT_EQ(cross(light.axis_u, light.axis_v), -light.direction);
  EXPECT_EQ(rectangle_visible_part(light, vec3(0), vec3(0, 1, 0)).count, 4);
  EXPECT_EQ(rectangle_visible_part(light, vec3(0), vec3(0, -1, 0)).count, 0);
  EXPECT_EQ(rectangle_visible_part(light, vec3(0, 3, 0), vec3(0, -1, 0)).count, 0);
  EXPECT_EQ(rectangle_visible_part(light, vec3(0, 2, 0), vec3(0, 1, 0)).count, 0);
  EXPECT_NEAR(rectangle_part_share(rectangle_visible_part(light, vec3(0), vec3(1, 0, 0))), 0.5f, 1e-6f);
  light.flags = light_flag_two_sided;
  EXPECT_EQ(rectangle_visible_part(light, vec3(0, 3, 0), vec3(0, -1, 0)).count, 4);
  // Facing the light, the vector irradiance points to it.
  EXPECT_GT(rectangle_vector_irradiance(rectangle_from(light, vec3(0)), rectangle_whole()).y, 0);
}

}  // namespace
}  // namespace limn::glsl
