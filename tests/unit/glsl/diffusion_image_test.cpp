// Light below surfaces from points in the image (glsl/diffusion): planes seen from the eye, drawn points, and
// the estimator on analytic planes and spheres against closed forms and the figures that it was chosen by.
#include "tests/unit/glsl/diffusion_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "techniques/subsurface_scattering/pattern_weights.glsl"
#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

const PointSource kRed{vec3(1, 0, 0), 0, 1};

/// Mean distance between where light of skin1's red enters and where it leaves, mm.
constexpr float kMeanRadius = 3;

/// B / C at the distance x into the lit half of a plane, by quantiles of the radius.
double besideEdge(const DipoleColours& c, int channel, double x) {
  constexpr int kQuantiles = 1000;
  double sum = 0;
  for (int i = 0; i < kQuantiles; ++i) {
    const double r = double(diffusion_radius(c, channel, (float(i) + 0.5f) / kQuantiles));
    sum += r <= std::abs(x) ? (x > 0 ? 1 : 0) : 1 - std::acos(x / r) / M_PI;
  }
  return sum / kQuantiles;
}

TEST(ImagePoints, AFurnaceIsWhite) {
  // A wide plane at 40 degrees; points that leave the image are not counted.
  const vec3 normal = normalize(vec3(0.6f, 0.2f, -0.8f));
  const SeenImage image(planeBody(vec3(0, 0, 100), normal, [](const vec3&) { return vec3(1); }),
                        ivec2(33, 33), 0.01f);
  const ivec2 middle(16);
  for (const int samples : {1, 16, 64}) {
    for (const bool both : {false, true}) {
      ImageQuestion q;
      q.samples = samples;
      q.bothPlanes = both;
      const SeenPlace here = *image.at(middle);
      const vec3 dipole = gatheredLight(image, here, middle, kWhite.dipole, kRed, q);
      const vec3 normalised = gatheredLight(image, here, middle, kWhite.normalised, kRed, q);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(kWhite.dipole.reflectance[c] * dipole[c], 1, 1e-3);
        EXPECT_NEAR(kWhite.normalised.reflectance[c] * normalised[c], 1, 1e-3);
      }
    }
  }
}

TEST(ImagePoints, ShortMeanFreePathsAreLocal) {
  // Pixels of 1 m, and mean distances of 3 mm to 3e-6 mm: what enters at the pixel leaves there.
  const vec3 normal = normalize(vec3(0.6f, 0.2f, -0.8f));
  const auto light = [](const vec3& p) { return vec3(2 + std::sin(p.x), 1 + 0.5f * std::cos(p.y), 1); };
  const SeenImage image(planeBody(vec3(0, 0, 1e2f), normal, light), ivec2(9, 9), 0.01f);
  for (const float shorter : {1e3f, 1e6f, 1e9f}) {
    DipoleColours dipole = kSkin.dipole;
    NormalisedColours normalised = kSkin.normalised;
    dipole.extinction *= shorter;
    normalised.width /= shorter;
    for (int normalise = 0; normalise < 3; ++normalise) {
      ImageQuestion q;
      q.samples = 16;
      q.normalise = normalise;
      const SeenPlace here = *image.at(ivec2(4));
      const vec3 a = gatheredLight(image, here, ivec2(4), dipole, kRed, q);
      const vec3 b = gatheredLight(image, here, ivec2(4), normalised, kRed, q);
      // Without the sum of weights, channels have the noise of points that are drawn for another one.
      const int channels = normalise == entry_normalise_weights ? 3 : 1;
      for (int c = 0; c < channels; ++c) {
        EXPECT_NEAR(a[c] / here.entering[c], 1, 1e-3);
        EXPECT_NEAR(b[c] / here.entering[c], 1, 1e-3);
      }
    }
  }
}

struct Spread {
  double mean = 0, deviation = 0, farthest = 0;
};

/// The mean and deviation of red light over sets of points, and the largest value.
Spread overSets(const SeenImage& image, const SeenPlace& here, ivec2 pixel, ImageQuestion q, int sets,
                const PointSource& source = kRed) {
  Spread s;
  double squares = 0;
  for (int i = 0; i < sets; ++i) {
    q.first = i * q.samples;
    const double value = double(gatheredLight(image, here, pixel, kSkin.dipole, source, q).x);
    s.mean += value / sets;
    squares += value * value / sets;
    s.farthest = std::max(s.farthest, value);
  }
  s.deviation = std::sqrt(std::max(squares - s.mean * s.mean, 0.));
  return s;
}

/// A sphere from three radii, of which a place at an angle is looked at; light comes from the side.
struct Sphere {
  float radius;
  vec3 centre;
  explicit Sphere(float meanRadii) : radius(meanRadii * kMeanRadius), centre(0, 0, 3 * radius) {}
  vec3 normalAt(float degrees) const { return {std::sin(radians(degrees)), 0, -std::cos(radians(degrees))}; }
  float lit(const vec3& normal) const { return std::max(dot(normal, normalize(vec3(1, 0.5f, -1))), 0.f); }
  SeenImage image() const {
    const auto light = [*this](const vec3& p) { return vec3(lit((p - centre) / radius)); };
    return SeenImage(sphereBody(centre, radius, light), ivec2(1, 1), 1e-3f, vec2(0), true);
  }
  SeenPlace at(float degrees) const {
    const vec3 n = normalAt(degrees);
    return {centre + radius * n, n, vec3(lit(n))};
  }
  /// The integral over the sphere of red light, over C: chords have dA = 2 pi r dr.
  double integral(float degrees, bool seenOnly) const {
    constexpr int kDraws = 1 << 17;
    const Frame f = frame_around(normalAt(degrees));
    double sum = 0;
    for (uint i = 1; i <= kDraws; ++i) {
      const vec3 u = r3_sequence(i);
      const float r = diffusion_radius(kSkin.dipole, 0, u.y) / radius, angle = 2 * pi * u.x;
      if (r > 2) continue;
      const float cosine = 1 - 0.5f * r * r, sine = std::sqrt(std::max(1 - cosine * cosine, 0.f));
      const vec3 n = cosine * f.n + sine * (std::cos(angle) * f.t + std::sin(angle) * f.b);
      if (!seenOnly || dot(n, centre + radius * n) < 0) sum += double(lit(n));
    }
    return sum / kDraws;
  }
};

TEST(ImagePoints, SpheresMeetTheIntegralOverWhatIsSeen) {
  for (const float meanRadii : {1.7f, 3.4f, 10.f}) {
    const Sphere sphere(meanRadii);
    const SeenImage image = sphere.image();
    for (const float degrees : {0.f, 30.f, 50.f}) {
      ImageQuestion q;
      q.samples = 4096;
      q.normalise = entry_normalise_none;
      const Spread none = overSets(image, sphere.at(degrees), ivec2(0), q, 4);
      EXPECT_NEAR(none.mean / sphere.integral(degrees, true), 1, 0.02) << meanRadii << " " << degrees;
      q.bothPlanes = true;
      const Spread both = overSets(image, sphere.at(degrees), ivec2(0), q, 4);
      EXPECT_NEAR(both.mean / sphere.integral(degrees, true), 1, 0.02) << meanRadii << " " << degrees;
    }
  }
}

/// Of few points on a small sphere often none meets it: that is part of the mean. 16384 sets of 4 points have
/// a noise of 0.008.
TEST(ImagePoints, FewPointsMeetTheIntegralOverWhatIsSeen) {
  const Sphere sphere(0.7f);
  const SeenImage image = sphere.image();
  ImageQuestion q;
  q.samples = 4;
  q.normalise = entry_normalise_none;
  for (const float degrees : {0.f, 30.f})
    EXPECT_NEAR(overSets(image, sphere.at(degrees), ivec2(0), q, 16384).mean / sphere.integral(degrees, true),
                1, 0.03)
        << degrees;
}

TEST(ImagePoints, WeightsMeetWholeSpheresWhereTheyAreNotSmall) {
  constexpr float kRim = 67;  // of 70.5 degrees that are seen
  for (const float degrees : {0.f, 30.f, 50.f, kRim}) {
    const Sphere sphere(10);
    const Spread s = overSets(sphere.image(), sphere.at(degrees), ivec2(0), {}, 32);
    EXPECT_NEAR(s.mean / sphere.integral(degrees, false), 1, 0.03) << degrees;
  }
  // Measured at 3.4 mean radii: 1.012 1.018 1.041 1.093. At 0.7 it is 1.58 1.62 1.70 2.06, since the light
  // that is seen stands for that of the dark side, too.
  for (const float degrees : {0.f, 30.f, 50.f, kRim}) {
    const Sphere sphere(3.4f), small(0.7f);
    const Spread s = overSets(sphere.image(), sphere.at(degrees), ivec2(0), {}, 32);
    EXPECT_NEAR(s.mean / sphere.integral(degrees, false), 1, degrees < kRim ? 0.05 : 0.10) << degrees;
    const Spread brighter = overSets(small.image(), small.at(degrees), ivec2(0), {}, 32);
    EXPECT_LT(brighter.mean / small.integral(degrees, false), degrees < kRim ? 1.75 : 2.1) << degrees;
  }
}

TEST(ImagePoints, RimsAreWhereTheNormalisationsDiffer) {
  constexpr float kRim = 67;
  const Sphere sphere(3.4f);
  const SeenImage image = sphere.image();
  const SeenPlace here = sphere.at(kRim);
  const double whole = sphere.integral(kRim, false);
  ImageQuestion q;
  const Spread weights = overSets(image, here, ivec2(0), q, 64);
  q.normalise = entry_normalise_none;
  const Spread none = overSets(image, here, ivec2(0), q, 64);
  q.normalise = entry_normalise_count;
  const Spread count = overSets(image, here, ivec2(0), q, 64);
  EXPECT_LT(weights.deviation / weights.mean, 0.08);
  EXPECT_GT(none.deviation / none.mean, 0.5);
  EXPECT_GT(none.farthest, 2);  // a single point brings most of it
  EXPECT_GT(count.mean / whole, 2.5);
  EXPECT_LE(weights.farthest, 1);
}

TEST(ImagePoints, BothPlanesHelpAtRims) {
  constexpr float kRim = 67;
  const Sphere sphere(1.7f);
  const SeenImage image = sphere.image();
  const SeenPlace here = sphere.at(kRim);
  const double whole = sphere.integral(kRim, false);
  const auto error = [&](bool bothPlanes) {
    ImageQuestion q;
    q.bothPlanes = bothPlanes;
    const Spread s = overSets(image, here, ivec2(0), q, 64);
    return std::hypot(s.mean - whole, s.deviation);
  };
  EXPECT_LT(error(true), 0.85 * error(false));
  const auto noise = [&](bool bothPlanes) {
    ImageQuestion q;
    q.normalise = entry_normalise_none;
    q.bothPlanes = bothPlanes;
    return overSets(image, here, ivec2(0), q, 64).deviation;
  };
  EXPECT_LT(noise(true), 0.5 * noise(false));
}

TEST(ImagePoints, TexelsHaveTheirPlanes) {
  // Texels of 1.3 mean distances on a plane at 30 degrees: from their own positions the sum over all points
  // is far too large.
  const float pixel = 1.3f * kMeanRadius / 1000;
  const vec3 normal(std::sin(radians(30.f)), 0, -std::cos(radians(30.f)));
  const SeenImage image(planeBody(vec3(0, 0, 1000), normal, [](const vec3&) { return vec3(1); }),
                        ivec2(201, 201), pixel);
  ImageQuestion q;
  q.samples = 4096;
  q.normalise = entry_normalise_none;
  const SeenPlace here = *image.at(ivec2(100));
  EXPECT_NEAR(overSets(image, here, ivec2(100), q, 4).mean, 1, 0.02);
  q.texelPlaces = true;
  EXPECT_GT(overSets(image, here, ivec2(100), q, 4).mean, 1.4);
}

/// RMS error of skin1 over C along a line across a shadow's edge, without texels.
dvec3 errorOverEdge(const Matter& matter, const PointSource& source, int samples, int normalise) {
  const SeenImage image(
      planeBody(vec3(0, 0, 100), vec3(0, 0, -1), [](const vec3& p) { return vec3(p.x > 0 ? 1.f : 0.f); }),
      ivec2(1), 1e-3f, vec2(0), true);
  const float reach = std::max({matter.reach().x, matter.reach().y, matter.reach().z});
  constexpr int kPlaces = 24, kSets = 16;
  dvec3 squares(0);
  for (int i = 0; i < kPlaces; ++i) {
    const float x = 2 * reach * ((float(i) + 0.5f) / kPlaces * 2 - 1);
    const SeenPlace here{vec3(x, 0, 100), vec3(0, 0, -1), vec3(x > 0 ? 1.f : 0.f)};
    dvec3 truth;
    for (int c = 0; c < 3; ++c) truth[c] = besideEdge(matter.dipole, c, double(x));
    for (int set = 0; set < kSets; ++set) {
      ImageQuestion q;
      q.samples = samples;
      q.first = set * samples;
      q.normalise = normalise;
      const dvec3 error = dvec3(gatheredLight(image, here, ivec2(0), matter.dipole, source, q)) - truth;
      squares += error * error / double(kPlaces * kSets);
    }
  }
  return sqrt(squares);
}

TEST(ImagePoints, ErrorsFallFasterThanTheRoot) {
  const dvec3 few = errorOverEdge(kSkin, kRed, 16, entry_normalise_weights);
  const dvec3 more = errorOverEdge(kSkin, kRed, 64, entry_normalise_weights);
  const dvec3 many = errorOverEdge(kSkin, kRed, 256, entry_normalise_weights);
  EXPECT_LE(few.x, 0.07);
  for (int c = 0; c < 3; ++c) EXPECT_LE(more[c], 0.05 * 0.5) << c;  // the mean is a half
  EXPECT_LE(std::log(many.x / few.x) / std::log(16), -0.65) << few.x << " " << more.x << " " << many.x;
}

TEST(ImagePoints, TheFarthestChannelServesAllUnlessItIsFarBeyondOthers) {
  const PointSource all{vec3(1.f / 3), 0, 1};
  const dvec3 skin = errorOverEdge(kSkin, kRed, 64, entry_normalise_weights);
  const dvec3 mixed = errorOverEdge(kSkin, all, 64, entry_normalise_weights);
  EXPECT_LT(skin.x, mixed.x);
  const dvec3 ketchup = errorOverEdge(kKetchup, kRed, 64, entry_normalise_weights);
  const dvec3 mixedKetchup = errorOverEdge(kKetchup, all, 64, entry_normalise_weights);
  EXPECT_LT(2 * mixedKetchup.y, ketchup.y);
  EXPECT_LT(2 * mixedKetchup.z, ketchup.z);
}

/// Relative RMS errors of skin1 across shadows' edges in eight directions.
struct PatternErrors {
  dvec3 shared = dvec3(0);    ///< all pixels draw the same points
  dvec3 averaged = dvec3(0);  ///< those of 4 x 4 pixels or fewer differ, and are averaged as the shader does
};

/// `reach`: of red light, pixels. `samples`: points of each pixel.
PatternErrors errorsOfPatterns(float reach, int samples) {
  constexpr int kWidth = 20, kHeight = 14, kBlock = 4, kDirections = 8;
  const int margin = int(8 * reach) + 6;
  const float pixel = kSkin.reach().x / reach;
  const int side = pattern_side(kSkin.reach() / pixel, kBlock);
  const bool narrow = pattern_narrow(kSkin.reach() / pixel, side);
  const int end = pattern_end(side, narrow);
  const dvec3 shares(pattern_shares(kSkin.reach() / pixel));
  PatternErrors errors;
  double truths = 0;
  for (int direction = 0; direction < kDirections; ++direction) {
    const float angle = 0.1f + 2 * pi * float(direction) / kDirections;
    const vec3 towards(std::cos(angle), std::sin(angle), 0);
    const auto across = [&](const vec3& p) { return dot(p, towards) - 0.13f * float(direction) * pixel; };
    const SeenImage image(planeBody(vec3(0, 0, 100), vec3(0, 0, -1),
                                    [&](const vec3& p) { return vec3(across(p) > 0 ? 1.f : 0.f); }),
                          ivec2(kWidth, kHeight) + 2 * margin, pixel / 100);
    std::vector<dvec3> alike, interleaved;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const ivec2 p(margin + x, margin + y);
        ImageQuestion q;
        q.samples = samples;
        alike.emplace_back(gatheredLight(image, *image.at(p), p, kSkin.dipole, kRed, q));
        q.stride = kBlock * kBlock;
        q.first = pattern_set({x, y}, side, kBlock);
        interleaved.emplace_back(gatheredLight(image, *image.at(p), p, kSkin.dipole, kRed, q));
      }
    }
    for (int y = end; y < kHeight - end; ++y) {
      for (int x = end; x < kWidth - end; ++x) {
        dvec3 mean(0), truth;
        for (int j = -end; j <= end; ++j)
          for (int i = -end; i <= end; ++i)
            mean += static_cast<double>(pattern_weight(side, narrow, std::abs(i)) *
                                        pattern_weight(side, narrow, std::abs(j))) *
                    interleaved[size_t((y + j) * kWidth + x + i)];
        mean = mix(interleaved[size_t(y * kWidth + x)], mean, shares);
        const vec3 place = image.at(ivec2(margin + x, margin + y))->place;
        for (int c = 0; c < 3; ++c)
          truth[c] = besideEdge(kSkin.dipole, c, static_cast<double>(across(place)));
        const dvec3 one = alike[size_t(y * kWidth + x)] - truth, other = mean - truth;
        errors.shared += one * one;
        errors.averaged += other * other;
        truths += 1;
      }
    }
  }
  errors.shared = 2. * sqrt(errors.shared / truths);  // the mean is a half
  errors.averaged = 2. * sqrt(errors.averaged / truths);
  return errors;
}

TEST(ImagePoints, PatternsOfPixelsAverageOut) {
  // Part of what is left are the pixels themselves, as steps of which the image has slanting edges.
  for (const float reach : {11.f, 6.f, 4.5f, 4.2f, 4.f, 3.8f, 3.5f, 3.3f, 3.f}) {
    const PatternErrors e = errorsOfPatterns(reach, 16);
    EXPECT_LE(3 * e.averaged.x, e.shared.x) << reach;
    EXPECT_LE(e.averaged.x, 0.045) << reach;
    EXPECT_LE(e.averaged.y, 0.08) << reach;
  }
}

TEST(ImagePoints, PlacesOfPatternsCountOnce) {
  for (const int side : {2, 3, 4, 5, 8, 16}) {
    for (const bool narrow : {false, true}) {
      if (narrow && side < 4) continue;
      std::vector<float> places(size_t(side), 0.f);
      const int end = pattern_end(side, narrow);
      for (int t = -end; t <= end; ++t)
        places[size_t((t + 2 * side) % side)] += pattern_weight(side, narrow, std::abs(t));
      for (const float place : places) EXPECT_NEAR(place, 1.f / float(side), 1e-6f) << side;
      EXPECT_NE(pattern_weight(side, narrow, end), 0);
      EXPECT_EQ(pattern_weight(side, narrow, end + 1), 0);
      const vec3 shares(1, 0, 0.5f);
      const float packed = pattern_pack(side, narrow, shares);
      EXPECT_EQ(pattern_packed_side(packed), side);
      EXPECT_EQ(pattern_packed_narrow(packed), narrow);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(pattern_packed_shares(packed)[c], shares[c], 0.01f) << side;
    }
  }
  EXPECT_EQ(pattern_side(vec3(0.79f, 0.79f, 0.1f), 4), 1);
  EXPECT_EQ(pattern_side(vec3(0.1f, 3.3f, 0.1f), 4), 2);
  EXPECT_EQ(pattern_side(vec3(3.5f, 0.1f, 0.1f), 4), 4);
  EXPECT_EQ(pattern_side(vec3(6), 1), 1);
}

TEST(ImagePoints, WeightsStayBelowTheLightThatEnters) {
  Random random(3);
  const auto light = [](const vec3& p) {
    return vec3(0.5f + 0.5f * std::sin(40 * p.x) * std::cos(30 * p.y));
  };
  const vec3 centre(0, 0, 3);
  const SeenImage image(sphereBody(centre, 1, light), ivec2(64, 64), 0.012f);
  for (int i = 0; i < 1500; ++i) {
    const ivec2 pixel(int(random(10, 54)), int(random(10, 54)));
    const auto& here = image.at(pixel);
    if (!here) continue;
    const float eta = i % 2 == 0 ? 1.f : 3.f;
    const vec3 extinction =
        vec3(std::pow(10.f, random(-6, 6))) * vec3(1, random(0.1f, 10), random(0.01f, 100));
    const vec3 absorption(i % 3 == 0 ? 0.f : random(0, 1), i % 5 == 0 ? 1.f : random(0, 1), random(0, 1));
    const DiffusionBoundary boundary = diffusion_boundary(eta);
    const PointSource source{
        diffusion_drawn_channels(diffusion_reach(extinction, absorption, walk_reflectance(boundary))),
        i % 7 == 0 ? 0.25f : 0.f, 3};
    ImageQuestion q;
    q.samples = 16;
    q.bothPlanes = i % 11 == 0;
    const auto check = [&](const vec3& mean) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(mean[c], 0) << i;  // false for what is no number
        EXPECT_LE(mean[c], 1.0001f) << i;
      }
    };
    check(gatheredLight(image, *here, pixel, dipole_colours(extinction, absorption, boundary), source, q));
    check(
        gatheredLight(image, *here, pixel, normalised_colours(extinction, absorption, boundary), source, q));
  }
}

}  // namespace
}  // namespace limn::glsl
