// Lines without a physical model: what the medium takes of them, and their derived brightness.
#include <cmath>

#include "core/bench/private/stress_scene.h"
#include "tests/gpu/media_harness.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

using glm::dvec3;

class KruegerCausticsTest : public MediaHarness {
 protected:
  static Image lines(const scene::Scene& scene,
                     const std::vector<std::pair<std::string, std::string>>& parameters = {}) {
    render::Renderer renderer(device(), scene);
    return picture(renderer,
                   settings(width, height, Term::media, {technique("krueger_caustics", parameters)}));
  }
};

/// A buffer of one texel has one ray: through the middle of the ball, which does not bend it. Of its line the
/// medium leaves exp(-sigma_t (s + d)), with s metres from the ball and d metres of the way to the eye, which
/// the scene's bounding sphere holds: the medium fills that (Beer's law). A fragment lies within a pixel of
/// the place of the line that is nearest to its viewing ray, and a pixel more in s is at most as much more in
/// d.
TEST_F(KruegerCausticsTest, TheMediumTakesLightAlongTheLineAndOnTheWayToTheEye) {
  scene::Scene scene = asset("glass_sphere");
  scene.medium.sigmaA = glm::vec3(0, 0.3f, 1);
  const dvec3 extinction(scene.medium.sigmaA + scene.medium.sigmaS);
  const auto line = [&](const char* attenuation) {
    return lines(scene, {{"buffer_size", "1"}, {"paths", "refraction"}, {"attenuation", attenuation}});
  };
  const Image taken = line("true"), whole = line("false");
  const scene::Pose pose = scene::evaluate(scene, 0);
  const test::ViewRays rays(pose.cameras.at(0), pose.bounds, {width, height});
  constexpr double radius = 0.5;
  const dvec3 ball(0, 1.5, 0), along = glm::normalize(ball - dvec3(pose.lights.at(0).position));
  const dvec3 start = ball + radius * along - rays.eye();
  const dvec3 medium = dvec3(pose.bounds.centre()) - rays.eye();
  const double outside = dot(medium, medium) - std::pow(double(pose.bounds.radius()), 2);
  ASSERT_GT(outside, 0) << "the eye lies before the medium";
  int seen = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!(whole.at(x, y, 1) > 0)) continue;
      ++seen;
      const dvec3 view = rays.direction(x, y);
      const double cosine = glm::dot(view, along), square = 1 - cosine * cosine;
      const double s = (cosine * glm::dot(view, start) - glm::dot(along, start)) / square;
      const double d = glm::length(start + s * along), middle = glm::dot(view, medium);
      const double clear = middle - std::sqrt(middle * middle - outside);
      const double pixel = d * glm::length(rays.ray(1, 0) - rays.ray(0, 0)) / std::sqrt(square);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(std::log(double(taken.at(x, y, c)) / whole.at(x, y, c)), -extinction[c] * (s + d - clear),
                    2 * extinction[c] * pixel + 1e-3)
            << x << " " << y;
    }
  EXPECT_GT(seen, 15) << "a line of a metre, where a pixel has 4 cm";
}

TEST_F(KruegerCausticsTest, TheSizeOfTheSceneDoesNotMatter) {
  const scene::Scene scene = asset("glass_sphere");
  const double usual = mean(lines(scene));
  EXPECT_GT(usual, 0);
  for (const double factor : {1e-4, 1e4})
    EXPECT_NEAR(mean(lines(bench::stressed(scene, StressChange::sceneScale, factor))) / usual, 1, 2e-3)
        << factor;
}

TEST_F(KruegerCausticsTest, ScaleIsAFactor) {
  const scene::Scene scene = asset("ring");
  EXPECT_NEAR(mean(lines(scene, {{"scale", "3"}})) / mean(lines(scene)), 3, 1e-3);
}

}  // namespace
}  // namespace limn
