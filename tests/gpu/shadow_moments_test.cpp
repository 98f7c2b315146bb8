// The shadow of a square as a whole: how much of the floor's light it takes, where its middle lies and how
// far it spreads along either axis, which have closed forms under lights that face the floor. A lookup half a
// texel aside, sides of a light that are confused, or a kernel somewhat too wide change them, where errors of
// single pixels hide it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tests/gpu/planes_scene.h"

namespace limn {
namespace {

using namespace limn::test;

/// A shadow, with what is hidden of the light as a density: by x and z, m.
struct DarkFloor {
  double area = 0;  ///< m^2: of a hard shadow that takes as much
  glm::dvec2 middle{0};
  glm::dvec2 spread{0};  ///< variance, m^2
  double brightest = 0;  ///< V at most within `umbra` of the middle
};

class ShadowMomentsTest : public PlanesTest {
 protected:
  /// A square of side 1 m, 1 m above the floor. Nothing of its shadow lies behind it for a camera on the side
  /// of z, or of x.
  static Planes square(bool fromX = false) {
    Planes s;
    s.addPlane(0.5f, at(0, 1, 0));
    s.camera = scene::lookAt(fromX ? glm::vec3(6, 5, 0) : glm::vec3(0, 5, 6), {0, 0, 0}, 0.36f);
    return s;
  }

  static DarkFloor dark(const Planes& s, const Answer& v, double umbra = 0) {
    glsl::FrameBlock frame{};
    scene::setCamera(frame, s.camera, s.pose.bounds, v.width, v.height);
    const glm::dvec3 across(glm::vec3(frame.view_ray_dx)), along(glm::vec3(frame.view_ray_dy));
    const double pixel = glm::length(glm::cross(across, along));  // m^2, 1 m before the eye
    const double height = double{frame.camera_position.y};
    DarkFloor found;
    for (int y = 0; y < v.height; ++y) {
      for (int x = 0; x < v.width; ++x) {
        const auto i = static_cast<size_t>(y * v.width + x);
        if (v.instance[i] != 0) continue;
        const glm::vec3 p = s.position(v, x, y);
        const glm::dvec2 place(p.x, p.z);
        const double seen = double{v.at(0, x, y)};
        const double hidden = std::pow(double{v.depth[i]}, 3) * pixel / height * (1 - seen);
        found.area += hidden;
        found.middle += hidden * place;
        found.spread += hidden * place * place;
        if (std::max(std::abs(place.x), std::abs(place.y)) < umbra)
          found.brightest = std::max(found.brightest, seen);
      }
    }
    found.middle /= found.area;
    found.spread = found.spread / found.area - found.middle * found.middle;
    return found;
  }
};

/// How far a technique with the best of its settings may be off, relative to the closed form.
struct SoftShadow {
  const char* name;
  std::map<std::string, std::string> settings;
  double area = 0.03, spread = 0.04;
};

/// savsm takes the mean of all blockers for the depth of each.
const SoftShadow kSoftShadows[] = {
    {"pcss", {{"blocker_samples", "256"}, {"filter_samples", "256"}}},
    {"pcss", {{"search", "near"}, {"blocker_samples", "256"}, {"filter_samples", "256"}}},
    {"pcss", {{"search", "narrowed"}, {"blocker_samples", "256"}, {"filter_samples", "256"}}},
    {"savsm", {{"blocker_samples", "256"}}, 0.04, 0.08},
    {"savsm", {{"search", "near"}, {"blocker_samples", "256"}}, 0.04, 0.08},
    {"vssm", {{"views", "1"}}},
    {"vssm", {{"views", "2"}}},
    {"cssm", {}},
    {"moment_soft_shadow_map", {{"views", "1"}}},
    {"moment_soft_shadow_map", {{"views", "2"}}},
    {"backprojection", {{"patches", "256"}, {"views", "1"}}},
    {"backprojection", {{"patches", "256"}, {"views", "2"}}},
    {"bitmask_soft_shadows", {{"patches", "256"}, {"sample_points", "256"}}},
    {"sampled_area_light", {{"samples", "256"}}},
    {"ray_traced_area_light", {{"rays", "64"}, {"filter", "none"}}},
};

/// Half a texel of their maps, 512 of them across 8 m, is 7.8 mm on the floor.
constexpr double kAside = 0.0055;

std::string called(const SoftShadow& c) {
  std::string all = c.name;
  for (const auto& [parameter, value] : c.settings) all += " " + parameter + "=" + value;
  return all;
}

std::map<std::string, std::string> inMaps(const SoftShadow& c) {
  std::map<std::string, std::string> settings = c.settings;
  const bool traced = std::string(c.name) == "ray_traced_area_light";
  if (!traced) settings["shadow_map_size"] = "512";
  return settings;
}

/// Seen from the light the square hides (4/3)^2 m^2 of the floor, and for each point of the light that lies d
/// aside a square d / 3 to the other side: both variances add up.
TEST_F(ShadowMomentsTest, ALongLightSpreadsTheShadowOfASquareAlongItsLength) {
  constexpr double lengths[] = {3, 0.3}, hard = 16.0 / 9;
  Planes s = square();
  s.pose.lights[0].length_u = float(lengths[0]);
  s.pose.lights[0].length_v = float(lengths[1]);
  for (const SoftShadow& c : kSoftShadows) {
    SCOPED_TRACE(called(c));
    const DarkFloor found = dark(s, visibility(c.name, inMaps(c), s.scene, s.pose, s.camera));
    EXPECT_NEAR(found.area / hard, 1, c.area);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(found.middle[i], 0, kAside) << i;
      const double light = lengths[i] / 3;
      EXPECT_NEAR(found.spread[i] / ((hard + light * light) / 12), 1, c.spread) << i;
    }
  }
}

/// What a sample of the light casts lies aside by a third of the way that the sample does. Together they lie
/// where the light's shadow does, however few they are. Edges of a hard shadow are half a texel and half a
/// pixel off at most, 7.8 and 11 mm.
TEST_F(ShadowMomentsTest, FewSamplesOfALightDoNotMoveItsShadow) {
  Planes s = square();
  s.pose.lights[0].length_u = 3;
  s.pose.lights[0].length_v = 0.3f;
  for (const char* samples : {"4", "16"}) {
    const DarkFloor found =
        dark(s, answer(s, {{"samples", samples}, {"shadow_map_size", "512"}}, "sampled_area_light"));
    EXPECT_NEAR(found.middle.x, 0, 0.019) << samples;
  }
}

/// Where no penumbra reaches all is dark, whatever part of the disc a kernel is made for. The variance of a
/// sun's disc along an axis is a quarter of its squared radius, which is 2 % less where it is even in solid
/// angle, and of the square as large pi / 12.
TEST_F(ShadowMomentsTest, ASunSpreadsTheShadowOfASquareToAllSides) {
  constexpr double angle = 0.6;
  const double radius = std::tan(0.5 * angle), exact = 1.0 / 12 + 0.25 * radius * radius;
  Planes s = square();
  s.pose.lights[0] = directionalLight({0, -1, 0}, float(angle));
  for (const SoftShadow& c : kSoftShadows) {
    SCOPED_TRACE(called(c));
    const DarkFloor found =
        dark(s, visibility(c.name, inMaps(c), s.scene, s.pose, s.camera), 0.5 - radius - 0.05);
    EXPECT_NEAR(found.area, 1, c.area);
    EXPECT_LT(found.brightest, 0.02);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(found.middle[i], 0, kAside) << i;
      EXPECT_NEAR(found.spread[i] / exact, 1, std::max(c.spread, 0.05)) << i;
    }
  }
}

/// Hard shadows have the edges that the map's texels and the picture's pixels give them, which are the same
/// to both sides of the axis that the camera looks along. Half a texel, of 64 across 8 m, is 62 mm.
TEST_F(ShadowMomentsTest, HardShadowsLieBelowWhatThrowsThem) {
  for (const bool fromX : {false, true}) {
    Planes s = square(fromX);
    s.pose.lights[0] = pointLight({0, 4, 0});
    for (const char* filter : {"nearest", "2x2"}) {
      const DarkFloor found =
          dark(s, answer(s, {{"filter", filter}, {"shadow_map_size", "64"}}, "hard_shadow_map"));
      EXPECT_GT(found.area, 1) << filter;
      EXPECT_NEAR(found.middle[fromX ? 1 : 0], 0, 0.01) << filter;
    }
  }
}

/// The filter of pcf is 5 texels wide, 78 mm on the floor, whatever the light's size.
TEST_F(ShadowMomentsTest, FixedKernelsNeitherMoveNorWidenAShadow) {
  Planes s = square();
  s.pose.lights[0].length_u = s.pose.lights[0].length_v = 0.1f;
  const DarkFloor found = dark(s, answer(s, {{"kernel", "5"}, {"shadow_map_size", "512"}}, "pcf"));
  constexpr double hard = 16.0 / 9, width = 5 * 8.0 / 512;
  EXPECT_NEAR(found.area / hard, 1, 0.03);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(found.middle[i], 0, kAside) << i;
    EXPECT_NEAR(found.spread[i] / ((hard + width * width) / 12), 1, 0.03) << i;
  }
}

}  // namespace
}  // namespace limn
