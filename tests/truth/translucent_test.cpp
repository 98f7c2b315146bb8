// Light that enters smooth boundaries and leaves them again, by Fresnel's equations and their integrals. What
// happens below is the local limit: light leaves where it entered.
#include "tests/truth/truth_test.h"

namespace limn {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kIor = 1.4, kAlbedo = 0.6;

/// F_t of unpolarised light that meets a body of that index of refraction.
double transmitted(double cosine) {
  if (cosine <= 0) return 0;
  const double inside = std::sqrt(1 - (1 - cosine * cosine) / (kIor * kIor));
  const double across = (cosine - kIor * inside) / (cosine + kIor * inside);
  const double along = (kIor * cosine - inside) / (kIor * cosine + inside);
  return 1 - 0.5 * (across * across + along * along);
}

/// 1 - F_de, by the midpoint rule.
double transmittedOfDiffuse() {
  constexpr int n = 4096;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += transmitted((i + 0.5) / n) * 2 * (i + 0.5) / n;
  return sum / n;
}

/// What a place seen along `view` sends of the irradiance that enters it.
double left(double entering, double cosine) {
  static const double diffuse = transmittedOfDiffuse();
  return kAlbedo * entering * transmitted(cosine) / (M_PI * diffuse);
}

class TranslucentTruth : public TruthTest {
 protected:
  static int addBody(scene::Scene& scene, double albedo = kAlbedo) {
    scene::Material material = test::lambertian(float(albedo));
    material.ior = float(kIor);
    material.subsurface = scene::Subsurface{.extinction = vec3(1000), .absorption = vec3(0.02f)};
    return test::addMaterial(scene, material);
  }
  /// A floor in the plane y = 0.
  static scene::Scene floor() {
    scene::Scene scene;
    test::show(scene, test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, addBody(scene)));
    return scene;
  }
  static Question question(Term term, int spp = 2) {
    Question q{.camera = scene::lookAt({0.3f, 2.5f, 2.4f}, {0, 0, 0}, 0.8f), .term = term, .spp = spp};
    if (term != Term::direct) q.subsurface = SubsurfaceModel::local;
    return q;
  }
  static constexpr auto black = [](const dvec3&, const dvec3&) { return 0.0; };
};

TEST_F(TranslucentTruth, LightOfAPointEntersAndLeaves) {
  scene::Scene scene = floor();
  const dvec3 lamp(0.4, 0.7, -0.3);
  test::shine(scene, test::lamp(glsl::light_point, 7), vec3(lamp));
  const auto expected = [&](const dvec3& p, const dvec3& view) {
    const double distance = glm::length(lamp - p), cosine = lamp.y / distance;
    return left(7 * cosine * transmitted(cosine) / (distance * distance), -view.y);
  };
  for (const Term term : {Term::subsurface, Term::final})
    expectBoth(scene, question(term), expected, {.mean = 3e-3, .average = 3e-3, .largest = 0.02});
  expectBoth(scene, question(Term::direct), black, {});
}

/// Points of the lamp in a grid that is finer than that of the picture.
TEST_F(TranslucentTruth, LightOfARectangleEntersAtEachAngle) {
  scene::Scene scene = floor();
  const dvec3 centre(0.2, 0.5, 0.1);
  test::shine(scene, test::lamp(glsl::light_point, 6), vec3(centre));
  scene.nodes.back().limnArea = {1.2f, 0.8f};
  const auto expected = [&](const dvec3& p, const dvec3& view) {
    constexpr int side = 48;
    double entering = 0;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const dvec3 way =
            centre + dvec3(1.2 * ((i + 0.5) / side - 0.5), 0, 0.8 * ((j + 0.5) / side - 0.5)) - p;
        const double distance = glm::length(way), cosine = way.y / distance;
        entering += 6 * cosine * cosine * transmitted(cosine) / (distance * distance);
      }
    return left(entering / (side * side), -view.y);
  };
  expectPicture(scene, question(Term::subsurface), expected,
                {.mean = 5e-3, .average = 5e-3, .largest = 0.02});
  expectReference(scene, question(Term::subsurface, 64), expected, {.mean = 5e-3, .average = 0.05});
  Question sampled = question(Term::subsurface);
  sampled.techniques = {technique("sampled_area_light", {{"samples", "64"}})};
  expectPicture(scene, sampled, expected, {.mean = 0.01, .average = 0.06});  // of 64 points on a near lamp
}

/// A body that absorbs nothing sends back what enters it: of light 1 from everywhere, F_t of the view.
TEST_F(TranslucentTruth, AWhiteBodyInAWhiteFurnaceLacksItsReflectionAlone) {
  scene::Scene scene;
  test::show(scene, test::spherePrimitive(1, addBody(scene, 1)));
  scene.environment.width = 16;
  scene.environment.height = 8;
  scene.environment.texels.assign(128, vec3(1));
  const auto expected = [&](const dvec3& p, const dvec3& view) {
    const double cosine = -glm::dot(glm::normalize(p), view);
    return cosine > 0.2 ? transmitted(cosine) : nothing;
  };
  Question q = question(Term::subsurface, 64);
  q.camera = scene::lookAt({1, 1, 5}, {0, 0, 0}, 0.4f);
  expectPicture(scene, q, expected, {.mean = 2e-3, .average = 2e-3, .largest = 0.02});
  expectReference(scene, q, expected, {.mean = 5e-3, .average = 0.05});
  q.techniques = {technique("prefiltered_environment")};
  expectPicture(scene, q, expected, {.mean = 2e-3, .average = 2e-3, .largest = 0.02});
}

/// What comes over a white wall, by virtual lights: the picture's own noise is that of their number.
TEST_F(TranslucentTruth, LightOverOtherSurfacesEnters) {
  scene::Scene scene = floor();
  test::show(scene, test::quad({-1.5f, 1, 0}, {0, 0, -4}, {0, 2, 0},
                               test::addMaterial(scene, test::lambertian(0.8f))));
  test::shine(scene, test::lamp(glsl::light_point, 7), vec3(0, 1, 0));
  Question q = question(Term::subsurface, 256);
  const Image direct = pictureOf(scene, q), directTruth = referenceOf(scene, q);
  q.bounces = 1;
  const Image truth = referenceOf(scene, q);
  q.techniques = {technique("instant_radiosity", {{"vpls", "1024"}})};
  const Image both = pictureOf(scene, q);
  double sum = 0, expected = 0;
  for (int y = 0; y < q.size.y; ++y)
    for (int x = 0; x < q.size.x; ++x) {
      sum += double(both.at(x, y, 0)) - double(direct.at(x, y, 0));
      expected += double(truth.at(x, y, 0)) - double(directTruth.at(x, y, 0));
    }
  EXPECT_GT(expected, 1);
  EXPECT_NEAR(sum / expected, 1, 0.03);
}

TEST_F(TranslucentTruth, OpaqueScenesHaveNoPassesForBodies) {
  scene::Scene scene;
  test::show(scene, test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4},
                               test::addMaterial(scene, test::lambertian(float(kAlbedo)))));
  test::shine(scene, test::lamp(glsl::light_point, 7), vec3(0, 1, 0));
  render::Renderer renderer(device(), scene);
  for (const Term term : {Term::final, Term::subsurface}) {
    renderer.configure(settings(32, 32, term));
    renderer.render();
    for (const frame::PassReport& pass : renderer.explain())
      EXPECT_TRUE(pass.name != "entry gbuffer" && pass.name != "boundary gbuffer" &&
                  pass.name != "local subsurface light");
  }
  EXPECT_EQ(mean(renderer.read()), 0);
}

}  // namespace
}  // namespace limn
