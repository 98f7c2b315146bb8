// Fixture for tests that put the same question to the picture and to its reference and compare each with a
// closed form: what both have in common cannot be found wrong by comparing them.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/reference/reference.h"
#include "tests/gpu/render_test.h"
#include "tests/support/closed_forms.h"
#include "tests/support/scene_nodes.h"

namespace limn {

/// What is asked of both renderers.
struct Question {
  scene::CameraPose camera;
  Term term = Term::direct;
  std::vector<render::TechniqueUse> techniques = {};  ///< of the picture
  int spp = 2;                                        ///< of the reference
  int bounces = 0, interfaces = 0;                    ///< of the reference
  glm::ivec2 size{48, 48};
  bool background = false;                               ///< pixels without a surface are looked at, too
  SubsurfaceModel subsurface = SubsurfaceModel::bssrdf;  ///< of the reference
};

/// How far a picture is from a closed form, over the pixels for which there is one.
struct Deviation {
  int pixels = 0;
  double mean = 0;     ///< of the picture over that of the closed form, - 1
  double average = 0;  ///< mean of the absolute differences over the mean of the closed form
  double largest = 0;  ///< of the relative differences
};

class TruthTest : public RenderTest {
 protected:
  using dvec3 = glm::dvec3;
  using vec3 = glm::vec3;
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();  ///< no closed form here

  static Image pictureOf(const scene::Scene& scene, const Question& q) {
    render::Renderer renderer(device(), scene);
    render::Settings s = settings(q.size.x, q.size.y, q.term, q.techniques);
    s.channels = true;
    return picture(renderer, std::move(s), q.camera);
  }

  static Image referenceOf(const scene::Scene& scene, const Question& q) {
    const scene::Pose pose = scene::evaluate(scene, 0);
    reference::Request asked = test::request(scene, pose, q.camera, q.size, q.term, q.spp);
    asked.bounces = q.bounces;
    asked.interfaces = q.interfaces;
    asked.subsurface = q.subsurface;
    return reference::render(asked).image;
  }

  /// `expected` says, of what a pixel shows (position and unit direction from the eye), the radiance of its
  /// channel, or `nothing`.
  template <class Expected>
  static Deviation deviation(const scene::Scene& scene, const Question& q, const Image& image,
                             Expected expected, int channel = 0) {
    const test::ViewRays rays(q.camera, scene::evaluate(scene, 0).bounds, q.size);
    const int z = image.channel("Z"), coverage = image.channel("coverage");
    Deviation d;
    double sum = 0, truth = 0;
    for (int y = 0; y < q.size.y; ++y)
      for (int x = 0; x < q.size.x; ++x) {
        if (image.at(x, y, coverage) == 0.f && !q.background) continue;
        const dvec3 position = rays.eye() + double(image.at(x, y, z)) * rays.ray(x, y);
        const double e = expected(position, rays.direction(x, y)), value = double(image.at(x, y, channel));
        if (std::isnan(e)) continue;
        ++d.pixels;
        sum += value;
        truth += e;
        d.average += std::abs(value - e);
        d.largest = std::max(d.largest, e > 0 ? std::abs(value / e - 1) : std::abs(value));
      }
    if (!(truth > 0)) return d;
    d.mean = sum / truth - 1;
    d.average /= truth;
    return d;
  }

  struct Bound {
    double mean = 0.01, average = 0.01;
    double largest = std::numeric_limits<double>::infinity();
    int pixels = 500;  ///< at least
  };
  static void expectWithin(const Deviation& d, const Bound& bound) {
    EXPECT_GE(d.pixels, bound.pixels);
    EXPECT_LT(std::abs(d.mean), bound.mean) << "mean " << d.mean;
    EXPECT_LT(d.average, bound.average);
    EXPECT_LT(d.largest, bound.largest);
  }

  template <class Expected>
  static void expectReference(const scene::Scene& scene, const Question& q, Expected expected,
                              const Bound& bound) {
    SCOPED_TRACE("reference");
    expectWithin(deviation(scene, q, referenceOf(scene, q), expected), bound);
  }
  template <class Expected>
  static void expectPicture(const scene::Scene& scene, const Question& q, Expected expected,
                            const Bound& bound) {
    SCOPED_TRACE("picture");
    expectWithin(deviation(scene, q, pictureOf(scene, q), expected), bound);
  }
  template <class Expected>
  static void expectBoth(const scene::Scene& scene, const Question& q, Expected expected,
                         const Bound& bound) {
    expectPicture(scene, q, expected, bound);
    expectReference(scene, q, expected, bound);
  }
};

}  // namespace limn
