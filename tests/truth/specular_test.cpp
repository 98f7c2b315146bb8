// What the camera sees in mirrors and in glass, and what a mirror sends into fog, where these have closed
// forms.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;

class SpecularTruth : public TruthTest {
 protected:
  static constexpr double albedo = 0.6, intensity = 10;
  static constexpr dvec3 lamp{0.3, 0.2, -1.5};

  /// A wall of 20 x 20 m at z = -3, facing +z, lit by a lamp.
  static scene::Scene wall() {
    scene::Scene scene;
    test::show(scene, test::quad({0, 0, -3}, {20, 0, 0}, {0, 20, 0},
                                 test::addMaterial(scene, test::lambertian(float(albedo)))));
    test::shine(scene, test::lamp(glsl::light_point, float(intensity)), vec3(lamp));
    return scene;
  }
  /// Its radiance where a ray from `origin` meets it.
  static double wallAlong(const dvec3& origin, const dvec3& direction) {
    const dvec3 towards = lamp - (origin + (-3 - origin.z) / direction.z * direction);
    return albedo / M_PI * intensity * towards.z / std::pow(glm::length(towards), 3);
  }
  static Question question(const scene::CameraPose& camera, int interfaces, int spp) {
    return {.camera = camera,
            .term = Term::specular,
            .techniques = {technique("image_space_refraction")},
            .spp = spp,
            .interfaces = interfaces};
  }
};

/// A metal shows what is mirrored in it times its reflectance, Schlick's approximation (1994) of Fresnel's
/// equations: f0 + (1 - f0) (1 - cos)^5.
TEST_F(SpecularTruth, AMetalShowsTheMirroredWallTimesItsReflectance) {
  for (const double f0 : {1.0, 0.4}) {
    SCOPED_TRACE(f0);
    scene::Scene scene = wall();
    scene::Material metal = test::silver();
    metal.baseColour = glm::vec4(vec3(float(f0)), 1);
    test::show(scene, test::quad({0, -1.2f, -1}, {2.4f, 0, 0}, {0, 0, -2}, test::addMaterial(scene, metal)));
    const auto expected = [&](const dvec3& p, const dvec3& w) {
      if (std::abs(p.y + 1.2) > 1e-3 || std::abs(p.x) > 1.15 || std::abs(p.z + 1) > 0.95) return nothing;
      const dvec3 up(0, 1, 0);
      return (f0 + (1 - f0) * std::pow(1 + glm::dot(w, up), 5)) * wallAlong(p, test::mirrored(w, up));
    };
    for (const int interfaces : {reference::kImageSpaceInterfaces, reference::kAllInterfaces}) {
      const Question q = question(scene::lookAt({0.1f, 0.4f, 3}, {0, -0.1f, -3}, 0.9f), interfaces, 2);
      expectReference(scene, q, expected, {.mean = 1e-3, .average = 1e-3, .pixels = 150});
    }
    expectPicture(scene, question(scene::lookAt({0.1f, 0.4f, 3}, {0, -0.1f, -3}, 0.9f), 2, 2), expected,
                  {.average = 0.01, .pixels = 150});
  }
}

/// A plate of glass, 1 m thick, shows the wall behind it, shifted aside, times what both interfaces pass,
/// (1 - F)^2; without a limit of interfaces each pair of reflections between its sides adds the wall where
/// light arrives that was shifted by their way, times F^2.
TEST_F(SpecularTruth, GlassShowsTheShiftedWallTimesWhatItsSidesPass) {
  constexpr double ior = 1.5;
  const dvec3 eye(0.2, 0.1, 3);
  scene::Scene scene = wall();
  const int glass = test::addMaterial(scene, test::glass(float(ior)));
  test::show(scene, test::joined(test::quad({0, 0, 0.5f}, {3, 0, 0}, {0, 2, 0}, glass),
                                 test::quad({0, 0, -0.5f}, {3, 0, 0}, {0, -2, 0}, glass)));
  const auto expected = [&](int pairs) {
    return [=](const dvec3&, const dvec3& w) {
      const auto covered = [](const dvec3& p) { return std::abs(p.x) < 1.45 && std::abs(p.y) < 0.95; };
      const dvec3 inside = test::snell(w, dvec3(0, 0, 1), 1 / ior), across = inside / -inside.z;
      const dvec3 front = eye + (0.5 - eye.z) / w.z * w, back = front + across;
      // The plate has no edges: where the camera sees one of its sides alone, it is a sheet.
      if (!covered(front) || !covered(back) || !covered(eye + (-0.5 - eye.z) / w.z * w)) return nothing;
      const double reflected = test::fresnel(-w.z, 1, ior);
      double sum = 0;
      for (int k = 0; k <= pairs; ++k) {
        const dvec3 exit = back + 2.0 * k * dvec3(across.x, across.y, 0);
        sum += std::pow(reflected, 2 * k) * wallAlong(exit, w);
      }
      return std::pow(1 - reflected, 2) * sum;
    };
  };
  const auto camera = scene::lookAt(vec3(eye), vec3(eye) - vec3(0, 0, 1), 0.8f);
  expectBoth(scene, question(camera, reference::kImageSpaceInterfaces, 2), expected(0),
             {.mean = 2e-3, .average = 0.005});
  expectReference(scene, question(camera, reference::kAllInterfaces, 512), expected(3),
                  {.mean = 2e-3, .average = 0.03});
}

/// Water shows what lies beyond its surface times what that passes and the square of the indices' ratio,
/// since radiance over n^2 goes along a ray (Veach 1997, section 5.2): from outside what lies in it is
/// darker, from within what lies outside brighter.
TEST_F(SpecularTruth, WaterShowsWhatLiesBeyondItByTheSquareOfTheIndices) {
  constexpr double ior = 1.33;
  for (const bool within : {false, true}) {
    SCOPED_TRACE(within ? "within" : "outside");
    const double here = within ? ior : 1, there = within ? 1 : ior;
    scene::Scene scene = wall();
    scene::Material water = test::glass(float(ior));
    water.doubleSided = true;
    test::show(scene, test::quad({0, 0, 0}, {6, 0, 0}, {0, within ? -6.f : 6.f, 0},
                                 test::addMaterial(scene, water)));
    const auto expected = [&](const dvec3& p, const dvec3& w) {
      const dvec3 passed = test::snell(w, dvec3(0, 0, 1), here / there), met = p - 3 / passed.z * passed;
      // What lies off the screen is not in the picture.
      if (std::abs(p.z) > 1e-3 || std::max(std::abs(met.x), std::abs(met.y)) > 2) return nothing;
      const double passes = 1 - test::fresnel(-w.z, here, there);
      return passes * std::pow(here / there, 2) * wallAlong(p, passed);
    };
    const auto camera = scene::lookAt({0.2f, 0.1f, 3}, {0.2f, 0.1f, 0}, 0.8f);
    expectBoth(scene, question(camera, reference::kImageSpaceInterfaces, 2), expected,
               {.mean = 2e-3, .average = 0.005});
  }
}

/// The sun and a mirror of 1 m in fog: along a view ray the fog scatters the sun's own light, but for the
/// mirror's shadow, and the beam that the mirror sends back, each dimmed over its way from where it enters
/// the bounding sphere and on to the eye, with Henyey and Greenstein's phase function (1941).
TEST_F(SpecularTruth, AMirroredBeamInFogMeetsQuadrature) {
  constexpr double absorbed = 0.05, scattered = 0.15, sun = 2, g = 0.4;
  const dvec3 light = glm::normalize(dvec3(1, 0, -1)), leaves(light.x, 0, -light.z);
  const dvec3 eye(0.6, -1.9, 0.8);
  scene::Scene scene;
  test::show(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, test::addMaterial(scene, test::silver())));
  test::show(scene,
             test::quad({0, 0, -1}, {4, 0, 0}, {0, 4, 0}, test::addMaterial(scene, test::lambertian(0.5f))));
  test::shine(scene, test::lamp(glsl::light_directional, float(sun)), vec3(0), vec3(light));
  scene.medium.sigmaA = vec3(float(absorbed));
  scene.medium.sigmaS = vec3(float(scattered));
  scene.medium.g = float(g);
  const scene::Bounds bounds = scene::evaluate(scene, 0).bounds;
  const dvec3 centre(bounds.centre());
  const double radius = double(bounds.radius());
  // Lengths at which a ray enters and leaves the fog.
  const auto within = [&](const dvec3& from, const dvec3& along) {
    const double b = glm::dot(from - centre, along);
    const double root =
        std::sqrt(std::max(b * b - glm::dot(from - centre, from - centre) + radius * radius, 0.0));
    return std::pair(-b - root, -b + root);
  };
  const auto phase = [](double cosine) {
    return (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  };
  const auto onMirror = [](const dvec3& p) { return std::abs(p.x) < 0.5 && std::abs(p.y) < 0.5; };
  const auto expected = [&](const dvec3&, const dvec3& w) {
    auto [begin, end] = within(eye, w);
    begin = std::max(begin, 0.0);
    const double mirror = -eye.z / w.z, floor = (-1 - eye.z) / w.z;
    if (mirror > 0 && onMirror(eye + mirror * w)) end = std::min(end, mirror);
    if (const dvec3 p = eye + floor * w; floor > 0 && std::max(std::abs(p.x), std::abs(p.y)) < 2)
      end = std::min(end, floor);
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = begin + (i + 0.5) * (end - begin) / steps;
      const dvec3 x = eye + t * w;
      const auto dimmed = [&, from = begin](double way) {
        return std::exp(-(absorbed + scattered) * (way + t - from));
      };
      const bool shadowed = x.z < 0 && onMirror(x - light * (x.z / light.z));
      if (!shadowed) sum += phase(-glm::dot(light, w)) * dimmed(within(x, -light).second);
      const double back = x.z / leaves.z;
      const dvec3 met = x - back * leaves;
      if (back > 0 && onMirror(met))
        sum += phase(-glm::dot(leaves, w)) * dimmed(back + within(met, -light).second);
    }
    return scattered * sun * sum * (end - begin) / steps;
  };
  Question q{
      .camera = scene::lookAt(vec3(eye), {0.5f, 0, 0.5f}, 0.8f),
      .term = Term::media,
      .techniques = {technique("hard_shadow_map"), technique("airlight"), technique("volume_caustics")},
      .spp = 256,
      .size = {24, 24},
      .background = true};
  expectPicture(scene, q, expected, {.mean = 0.02, .average = 0.04, .pixels = 500});
  for (const int interfaces : {0, reference::kAllInterfaces}) {
    q.interfaces = interfaces;
    expectReference(scene, q, expected, {.mean = 0.02, .average = 0.05, .pixels = 500});
  }
}

}  // namespace
}  // namespace limn
