// Light that fog scatters once, against quadrature of its equation.
#include "core/shading/environment_decomposition.h"
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

/// Light of radiance 1 comes from everywhere, and nothing but the fog itself, a ball of radius R, is in its
/// way: at a place p it scatters L = sigma_s int phase exp(-sigma_t d) dw towards the eye, where d is the way
/// from p to the border.
TEST_F(MediaTruth, FogInAWhiteFurnaceMeetsQuadrature) {
  constexpr double absorbed = 0.1, scattered = 0.5;
  const dvec3 eye(0, 0.3, 2.4);
  scene::Scene scene;
  const int grey = test::addMaterial(scene, test::lambertian(0.5f));
  for (const float side : {-1.f, 1.f})  // the box of the scene, whose corners lie on the fog's border
    test::show(scene, test::quad(side * vec3(1), {1e-3f, 0, 0}, {0, 1e-3f, 0}, grey));
  scene.environment.width = 16;
  scene.environment.height = 8;
  scene.environment.texels.assign(128, vec3(1));
  scene.medium.sigmaA = vec3(float(absorbed));
  scene.medium.sigmaS = vec3(float(scattered));
  scene.environment.lights = shading::decomposeEnvironment(scene.environment, {0.02, 16}).lights;
  const scene::Bounds bounds = scene::evaluate(scene, 0).bounds;
  const double radius2 = std::pow(double(bounds.radius()), 2);
  EXPECT_NEAR(radius2, 3, 0.01);
  const auto inside = [&](const dvec3& p, const dvec3& w) {  // metres to the border
    const double b = glm::dot(p, w);
    return -b + std::sqrt(std::max(b * b - glm::dot(p, p) + radius2, 0.0));
  };
  for (const double g : {-0.4, 0.0, 0.9}) {
    SCOPED_TRACE(g);
    scene.medium.g = float(g);
    const auto expected = [&](const dvec3&, const dvec3& w) {
      const dvec3 u = glm::normalize(glm::cross(w, dvec3(0, 1, 0))), v = glm::cross(u, w);
      const double nearest = -glm::dot(eye, w), across2 = glm::dot(eye, eye) - nearest * nearest;
      if (across2 > radius2) return nothing;
      const double half = std::sqrt(radius2 - across2), begin = std::max(nearest - half, 0.0),
                   end = nearest + half;
      constexpr int steps = 32, polar = 96, azimuths = 12;
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        const double t = begin + (i + 0.5) * (end - begin) / steps;
        const dvec3 p = eye + t * w;
        for (int j = 0; j < polar; ++j)
          for (int k = 0; k < azimuths; ++k) {
            // By the phase function's own distribution of cosines (Henyey and Greenstein 1941).
            const double x = 2 * (j + 0.5) / polar - 1, s = (1 - g * g) / (1 + g * x);
            const double cosine = g != 0 ? (1 + g * g - s * s) / (2 * g) : x;
            const double sine = std::sqrt(1 - cosine * cosine), angle = 2 * M_PI * (k + 0.5) / azimuths;
            const dvec3 from = cosine * w + sine * (std::cos(angle) * u + std::sin(angle) * v);
            sum += std::exp(-(absorbed + scattered) * (t - begin + inside(p, from)));
          }
      }
      return scattered * sum * (end - begin) / (steps * polar * azimuths);
    };
    const Question q{.camera = scene::lookAt(vec3(eye), {0, 0, 0}, 0.7f),
                     .term = Term::media,
                     .techniques = {technique("hard_shadow_map"), technique("airlight")},
                     .spp = 512,
                     .size = {20, 20},
                     .background = true};
    expectReference(scene, q, expected, {.mean = 3e-3, .average = 0.012, .pixels = 350});
    // The lights that stand for it shine from the directions of their centres alone: 1 % too bright.
    if (g == 0) expectPicture(scene, q, expected, {.mean = 0.02, .average = 0.02, .pixels = 350});
  }
}

/// Asked for one by one, the lights that stand for an even environment scatter as much as the environment
/// does, of which a floor hides the lower half from fog below it.
TEST_F(MediaTruth, TheLightsOfAnEvenEnvironmentScatterAllItsLight) {
  scene::Scene scene;
  test::show(scene,
             test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, test::addMaterial(scene, test::lambertian(0.5f))));
  scene.environment.width = 16;
  scene.environment.height = 8;
  scene.environment.texels.assign(128, vec3(1));
  scene.environment.lights = shading::decomposeEnvironment(scene.environment, {0.02, 16}).lights;
  scene.medium.sigmaA = vec3(0.1f);
  scene.medium.sigmaS = vec3(0.4f);
  scene.medium.g = 0.3f;
  const scene::Pose pose = scene::evaluate(scene, 0);
  reference::Request asked = test::request(scene, pose, scene::lookAt({0, 1, 2.4f}, {0, 0.5f, 0}, 0.7f),
                                           glm::ivec2(8), Term::media, 256);
  const auto light = [&](int index) {
    asked.light = index;
    const Image image = reference::render(asked).image;
    double sum = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) sum += double(image.at(x, y, 0));
    return sum;
  };
  const int count = static_cast<int>(pose.lights.size());
  ASSERT_GT(count, 1);
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += light(i);
  EXPECT_NEAR(sum / light(reference::kAllLights), 1, 0.01);
  EXPECT_NEAR(light(count) / light(reference::kAllLights), 1, 1e-6);
}

/// Where light from the point `from` reaches p through a mirror on [0, 2]^2 in the plane of points whose
/// `axis` is 0.
bool passesMirror(const dvec3& from, const dvec3& p, int axis) {
  const dvec3 at = from + from[axis] / (from[axis] - p[axis]) * (p - from);
  const double other = std::abs(at[1 - axis]);  // an image's light comes through the image of the mirror
  return other < 2 && at.z > 0 && at.z < 2;
}

/// Fog before two mirrors that meet at a right angle is lit by a lamp and by its three images, of which the
/// reference has the one over both mirrors without limit alone. Seen from outside the fog, where it meets a
/// floor between the mirrors.
TEST_F(MediaTruth, FogInAMirrorCornerIsLitByThreeImages) {
  constexpr double absorbed = 0.1, scattered = 0.2, intensity = 3;
  const dvec3 lamp(0.7, 0.5, 0.6), eye(4), middle(1);
  scene::Scene scene;
  const int silver = test::addMaterial(scene, test::silver());
  test::show(scene, test::quad({0, 1, 1}, {0, 2, 0}, {0, 0, 2}, silver));  // x = 0, facing +x
  test::show(scene, test::quad({1, 0, 1}, {0, 0, 2}, {2, 0, 0}, silver));  // y = 0, facing +y
  test::show(scene,
             test::quad({1, 1, 0}, {2, 0, 0}, {0, 2, 0}, test::addMaterial(scene, test::lambertian(0.5f))));
  test::shine(scene, test::lamp(glsl::light_point, float(intensity)), vec3(lamp));
  scene.medium.sigmaA = vec3(float(absorbed));
  scene.medium.sigmaS = vec3(float(scattered));
  const auto expected = [&](bool both) {
    return [=](const dvec3& floor, const dvec3& w) {
      if (std::abs(floor.z) > 1e-3 || std::min(floor.x, floor.y) < 0.1 || std::max(floor.x, floor.y) > 1.4)
        return nothing;
      const double nearest = glm::dot(middle - eye, w), end = glm::length(floor - eye);
      const dvec3 across = eye + nearest * w - middle;
      const double begin = nearest - std::sqrt(3 - glm::dot(across, across));
      constexpr int steps = 1000;
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * (end - begin) / steps;
        const dvec3 p = eye + (begin + t) * w;
        for (const auto& [x, y] : {std::pair(1, 1), std::pair(-1, 1), std::pair(1, -1), std::pair(-1, -1)}) {
          const dvec3 from = dvec3(x, y, 1) * lamp;
          if ((x < 0 && !passesMirror(from, p, 0)) || (y < 0 && !passesMirror(from, p, 1))) continue;
          if (x + y == -2 && !both) continue;
          const double r = glm::length(p - from);
          sum += std::exp(-(absorbed + scattered) * (t + r)) / (r * r);
        }
      }
      return scattered / (4 * M_PI) * intensity * sum * (end - begin) / steps;
    };
  };
  Question q{.camera = scene::lookAt(vec3(eye), {0.7f, 0.7f, 0}, 0.3f), .term = Term::media, .spp = 512};
  expectReference(scene, q, expected(false), {.average = 0.3, .pixels = 300});
  q.interfaces = reference::kAllInterfaces;
  expectReference(scene, q, expected(true), {.average = 0.3, .pixels = 300});
}

}  // namespace
}  // namespace limn
