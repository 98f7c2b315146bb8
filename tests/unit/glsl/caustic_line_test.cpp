// Laws of the weights with which light lines, and beams as wide as some pixels, are drawn.
#include "glsl/caustics/caustic_line.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace limn::glsl {
namespace {

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
