// Coats under the environment: what they mirror and what they leave to their base, without a technique.
#include <cmath>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "glsl/light/coated_environment.glsl"
#include "glsl/materials/material_model.glsl"
#include "tests/gpu/render_test.h"
#include "tests/support/environment_maps.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kPixels = 96;
constexpr float kDistance = 3, kFieldOfView = 0.8f;

class CoatTest : public RenderTest {
 protected:
  static glsl::MaterialModel coat(vec3 kd, uint32_t options) {
    glsl::MaterialModel model{};
    model.kind = glsl::model_coated;
    model.options = options;
    model.eta = vec3(1.5f);
    model.kd = kd;
    return model;
  }

  /// The picture of a ball of radius 1 at the origin, from +z.
  Image ball(const glsl::MaterialModel& model, scene::Environment environment) {
    scene::Scene scene;
    scene::Material material;
    scene::setModel(material, model);
    scene::Node node;
    node.mesh = test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene, material)));
    scene.nodes.push_back(node);
    scene.environment = std::move(environment);
    render::Renderer renderer(device(), scene);
    renderer.configure(settings(kPixels, kPixels, Term::final));
    renderer.setCamera(scene::lookAt({0, 0, kDistance}, {0, 0, 0}, kFieldOfView));
    renderer.render();
    return renderer.read();
  }

  static vec3 linear(vec3 d) { return 1.f + 0.8f * d; }

  /// Compares a picture of the ball with light(normal, view), where n.v is above `leastCosine`. Interpolated
  /// normals are off by (pi / 48)^2 / 8 at most, mirror directions by twice that and by as much from chords
  /// of the sphere.
  template <class Light>
  static void expectOnBall(const Image& image, float leastCosine, float tolerance, const Light& light) {
    int seen = 0;
    for (int y = 0; y < kPixels; ++y)
      for (int x = 0; x < kPixels; ++x) {
        const vec2 place = (2.f * vec2(x, y) + 1.f) / static_cast<float>(kPixels) - 1.f;
        const float tangent = std::tan(0.5f * kFieldOfView);
        const vec3 ray = glm::normalize(vec3(tangent * place.x, -tangent * place.y, -1));
        // |(0, 0, distance) + t ray| = 1.
        const float half = kDistance * ray.z, inside = half * half - kDistance * kDistance + 1;
        if (inside < leastCosine * leastCosine) continue;
        const vec3 n = vec3(0, 0, kDistance) + (-half - std::sqrt(inside)) * ray;
        const vec3 expected = light(n, -ray);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y, c), expected[c], tolerance) << x << ' ' << y;
        ++seen;
      }
    EXPECT_GT(seen, 1000);
  }
};

/// Coats that leave all else to a white base: the ball is not seen before a white background.
TEST_F(CoatTest, MirrorAndWhiteBaseReflectAllLight) {
  const scene::Environment white = test::environmentOf(256, [](vec3) { return vec3(1); });
  for (const uint32_t options : {glsl::model_option_blend, glsl::model_option_physical})
    expectWithin(ball(coat(vec3(1), options), white), 0.999f, 1.001f);
  // What the coat mirrors is gained by a sum: 0.04 head-on.
  const Image sum = ball(coat(vec3(1), 0), white);
  EXPECT_NEAR(sum.at(kPixels / 2, kPixels / 2, 0), 1.04f, 1e-3f);
  expectWithin(sum, 0.999f, 2.001f);
}

/// A perfect mirror without a base shows the environment in the mirror direction.
TEST_F(CoatTest, MirrorsTheEnvironment) {
  glsl::MaterialModel mirror = coat(vec3(0), 0);
  mirror.eta = vec3(1e-3f);
  mirror.k = vec3(1000);
  expectOnBall(ball(mirror, test::environmentOf(256, linear)), 0.2f, 0.01f,
               [](vec3 n, vec3 v) { return linear(glm::reflect(-v, n)); });
}

/// Of L = 1 + d.a the irradiance is pi + 2 pi / 3 n.a, and what grazes of it is pi / 21 + pi / 84 n.a. Where
/// n.v is above 0.5 the coat mirrors at most 0.09 of the light; the mesh turns normals by 1e-3, and sums over
/// texels are off by 3e-4.
TEST_F(CoatTest, PhysicalBasesGetWhatEntersTheCoat) {
  const glsl::MaterialModel model = coat(vec3(0.8f), glsl::model_option_physical);
  expectOnBall(ball(model, test::environmentOf(256, linear)), 0.5f, 0.003f, [&](vec3 n, vec3 v) {
    const vec3 slope = linear(n) - 1.f;
    return glsl::reflected_whole(
        glsl::coated_environment(model, glm::dot(n, v), glsl::pi * (1.f + 2.f / 3 * slope),
                                 glsl::pi / 84 * (4.f + slope), linear(glm::reflect(-v, n))));
  });
}

/// A floor whose normals are turned away from the camera above it: the mirror direction lies below it.
TEST_F(CoatTest, NormalsTurnedAwayMirrorNothing) {
  scene::Scene scene;
  scene::Material material;
  scene::setModel(material, coat(vec3(0), 0));
  scene::Primitive floor = test::floorPrimitive(1, test::addMaterial(scene, material));
  floor.normals.assign(4, glm::normalize(vec3(0, -0.1f, -1)));
  scene::Node node;
  node.mesh = test::addMesh(scene, std::move(floor));
  scene.nodes.push_back(node);
  scene.environment = test::environmentOf(256, linear);
  for (const std::vector<render::TechniqueUse>& techniques :
       {std::vector<render::TechniqueUse>{}, {technique("prefiltered_environment", {{"size", "128"}})}}) {
    render::Renderer renderer(device(), scene);
    renderer.configure(settings(24, 24, Term::direct, techniques));
    renderer.setCamera(scene::lookAt({0, 3, 1}, {0, 0, 0}, 0.4f));
    renderer.render();
    expectWithin(renderer.read(), 0, 0);
  }
}

}  // namespace
}  // namespace limn
