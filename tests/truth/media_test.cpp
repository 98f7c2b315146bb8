// Light that fog scatters once, against quadrature of its equation.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;

class MediaTruth : public TruthTest {};

/// L = int sigma_s p(cos) I / r^2 exp(-sigma_t (t + r)) dt along the view, with Henyey and Greenstein's phase
/// function (1941): the medium fills the scene's bounding sphere, in which camera and lamp lie.
TEST_F(MediaTruth, AirlightOfALampMeetsQuadrature) {
  constexpr double absorbed = 0.1, scattered = 0.2, intensity = 3;
  const dvec3 lamp(0.3, 1.2, 0.1), eye(0, 1, 2.4);
  scene::Scene scene;
  test::show(scene,
             test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, test::addMaterial(scene, test::lambertian(0.5f))));
  test::shine(scene, test::lamp(glsl::light_point, float(intensity)), vec3(lamp));
  scene.medium.sigmaA = vec3(float(absorbed));
  scene.medium.sigmaS = vec3(float(scattered));
  for (const double g : {-0.4, 0.0, 0.6}) {
    SCOPED_TRACE(g);
    scene.medium.g = float(g);
    const Question q{.camera = scene::lookAt(vec3(eye), {0, 0.9f, 0}, 0.7f),
                     .term = Term::media,
                     .techniques = {technique("hard_shadow_map"), technique("airlight")},
                     .spp = 256,
                     .size = {24, 24},
                     .background = true};
    const auto expected = [&](const dvec3&, const dvec3& w) {
      const double b = glm::dot(eye, w);
      double end = -b + std::sqrt(b * b - glm::dot(eye, eye) + 8);
      const dvec3 floor = eye - w * (eye.y / w.y);
      if (w.y < 0 && std::max(std::abs(floor.x), std::abs(floor.z)) < 2) end = -eye.y / w.y;
      constexpr int steps = 2000;
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * end / steps;
        const dvec3 d = eye + t * w - lamp;
        const double r = glm::length(d), cosine = -glm::dot(d, w) / r;
        const double phase = (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        sum += phase / (r * r) * std::exp(-(absorbed + scattered) * (t + r));
      }
      return scattered * intensity * sum * end / steps;
    };
    expectBoth(scene, q, expected, {.average = 0.03});
  }
}

}  // namespace
}  // namespace limn
