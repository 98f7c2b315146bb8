// The light of lights at surface elements, against closed forms and with something in its way.
#include "core/radiosity/light_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/scene/light_texture.h"
#include "glsl/light/unshadowed_light.glsl"
#include "tests/support/scene_nodes.h"

namespace limn::radiosity {
namespace {

/// Everything with x below a number is out of sight: a ray that ends there, or goes there, is blocked.
class Curtain final : public Occlusion {
 public:
  explicit Curtain(float x) : x_(x) {}
  bool blocked(const glm::vec3& origin, const glm::vec3& direction, float end) const override {
    return std::isfinite(end) ? origin.x + direction.x * end < x_ : direction.x < x_;
  }

 private:
  float x_;
};

glsl::Light rectangle(float width) {
  glsl::Light light{};
  light.type = glsl::light_rectangle;
  light.position = {0, 0, 2};
  light.direction = {0, 0, -1};
  light.axis_u = {1, 0, 0};
  light.axis_v = {0, 1, 0};
  light.length_u = light.length_v = width;
  light.emission = {1, 2, 3};
  light.own_instance = glsl::no_instance;
  return light;
}

glsl::Light point() {
  glsl::Light light{};
  light.type = glsl::light_point;
  light.position = {0, 3, 4};
  light.emission = glm::vec3(50);
  return light;
}

LightAtPlace lightAt(const glsl::Light& light, float alpha, float curtain) {
  LightAtPlace sum;
  addLight(light, {.alpha = alpha, .seed = 7}, Curtain(curtain), 16, sum);
  return sum;
}

/// What the pieces bring together.
glm::vec3 total(const LightAtPlace& light) {
  glm::vec3 sum(0);
  for (const glsl::IncidentLight& incident : light.incident)
    sum += incident.irradiance * incident.direction.z;
  return sum;
}

TEST(LightSamplesTest, APointLightIsOneDirection) {
  const LightAtPlace seen = lightAt(point(), 1, -10);
  ASSERT_EQ(seen.incident.size(), 1u);
  EXPECT_NEAR(seen.irradiance.x, 50.0 / 25 * 0.8, 1e-5);
  EXPECT_NEAR(glm::length(seen.incident[0].direction - glm::vec3(0, 0.6f, 0.8f)), 0, 1e-6);
  EXPECT_NEAR(seen.incident[0].irradiance.x, 2, 1e-5);
  EXPECT_EQ(seen.incident[0].spread, 0);
  EXPECT_TRUE(lightAt(point(), 1, 10).incident.empty());
  glsl::Light below = point();
  below.position.z = -4;
  EXPECT_EQ(lightAt(below, 1, -10).irradiance, glm::vec3(0));
}

TEST(LightSamplesTest, RectanglesAreExactWhereNothingHidesThem) {
  for (const float width : {0.1f, 1.f, 5.f})
    for (const float alpha : {1.f, 0.1f, 0.01f}) {
      const glsl::Light light = rectangle(width);
      const LightAtPlace seen = lightAt(light, alpha, -100);
      const glsl::Rectangle r = glsl::rectangle_from(light, {0, 0, 0});
      const float exact = glm::dot(glsl::rectangle_vector_irradiance(r, glsl::rectangle_whole()), {0, 0, 1});
      EXPECT_NEAR(seen.irradiance.x / exact, 1, 1e-5);
      EXPECT_NEAR(total(seen).z / (3 * exact), 1, 1e-4);
      const bool wide = width / 2 > 2.5f * alpha;
      EXPECT_EQ(seen.incident.size() > 1, wide) << "in pieces where it is wide for the lobe";
      EXPECT_LE(seen.incident.size(), 64u);
    }
}

TEST(LightSamplesTest, HalfOfALightIsHiddenByACurtain) {
  for (const float alpha : {1.f, 0.05f}) {
    const LightAtPlace whole = lightAt(rectangle(1), alpha, -100), half = lightAt(rectangle(1), alpha, 0);
    EXPECT_NEAR(half.irradiance.x / whole.irradiance.x, 0.5, 0.07);
    EXPECT_NEAR(total(half).x / half.irradiance.x, 1, 1e-4);
    for (const glsl::IncidentLight& incident : half.incident) EXPECT_GT(incident.direction.x, 0);
  }
}

TEST(LightSamplesTest, ASunHasItsIrradianceWhateverItsAngle) {
  for (const float angle : {0.f, 0.01f, 0.5f}) {
    glsl::Light sun{};
    sun.type = glsl::light_directional;
    sun.direction = {0, -0.6f, -0.8f};
    sun.emission = glm::vec3(2);
    sun.angular_diameter = angle;
    const LightAtPlace seen = lightAt(sun, 1, -10);
    EXPECT_NEAR(seen.irradiance.x, 1.6, 1e-4);
    EXPECT_NEAR(total(seen).x, 1.6, 1e-3);
    EXPECT_EQ(lightAt(sun, 1, 10).irradiance, glm::vec3(0));
  }
}

/// The one ray misses the disc of the sun within its square for about a fifth of the seeds.
TEST(LightSamplesTest, ASunIsNotLostForWantOfRays) {
  glsl::Light sun{};
  sun.type = glsl::light_directional;
  sun.direction = {0, -0.6f, -0.8f};
  sun.emission = glm::vec3(2);
  sun.angular_diameter = 0.5f;
  for (uint32_t seed = 0; seed < 64; ++seed) {
    LightAtPlace seen, hidden;
    addLight(sun, {.seed = seed}, Curtain(-10), 1, seen);
    addLight(sun, {.seed = seed}, Curtain(10), 1, hidden);
    EXPECT_NEAR(seen.irradiance.x, 1.6, 1e-4) << seed;
    EXPECT_NEAR(total(seen).x, 1.6, 1e-3) << seed;
    EXPECT_EQ(hidden.irradiance, glm::vec3(0)) << seed;
    EXPECT_TRUE(hidden.incident.empty()) << seed;
  }
}

/// T_l of places on a floor, whose bounding sphere of radius sqrt(8) m the medium fills: exp(-extinction
/// times way), from a lamp's centre or, of light from far above, from the sphere on.
TEST(LightSamplesTest, AMediumTakesOfLightOnItsWay) {
  scene::Scene scene;
  test::show(scene,
             test::quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, test::addMaterial(scene, test::lambertian(0.5f))));
  const scene::Pose pose = scene::evaluate(scene, 0);
  const auto air = sceneOcclusion(scene, pose);
  scene.medium.sigmaA = {0.1f, 0.4f, 0};
  scene.medium.sigmaS = {0, 0.1f, 2};
  const auto fog = sceneOcclusion(scene, pose);
  const glm::dvec3 extinction(0.1, 0.5, 2);
  glsl::Light lamp = rectangle(0.5f), sun{};
  lamp.position = {0, 1, 0};
  lamp.direction = {0, -1, 0};
  lamp.axis_v = {0, 0, -1};
  sun.type = glsl::light_directional;
  sun.direction = {0, -1, 0};
  sun.emission = glm::vec3(2);
  sun.own_instance = glsl::no_instance;
  for (const glm::vec3& position : {glm::vec3(0), glm::vec3(1, 0, 0.5f)})
    for (const glsl::Light& light : {lamp, sun}) {
      const LitPlace place{.position = position, .normal = {0, 1, 0}, .clearance = 1e-4f};
      LightAtPlace clear, dim;
      addLight(light, place, *air, 16, clear);
      addLight(light, place, *fog, 16, dim);
      ASSERT_EQ(clear.incident.size(), 1u);
      ASSERT_EQ(dim.incident.size(), 1u);
      const double squared = double(glm::dot(position, position));
      const double way =
          light.type == glsl::light_directional ? std::sqrt(8 - squared) : std::sqrt(1 + squared);
      for (int c = 0; c < 3; ++c) {
        const double left = std::exp(-extinction[c] * way);
        EXPECT_NEAR(double(dim.irradiance[c]) / double(clear.irradiance[c]), left, 1e-4 * left) << c;
        EXPECT_NEAR(double(dim.incident[0].irradiance[c]) / double(clear.incident[0].irradiance[c]), left,
                    1e-4 * left)
            << c;
      }
    }
}

/// What elements of a floor send on of a spot that shines through a texture.
TEST(LightSamplesTest, TheTextureOfASpotColoursItsLight) {
  scene::Scene scene;
  test::show(scene,
             test::quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, test::addMaterial(scene, test::lambertian(0.5f))));
  test::shine(scene, test::lamp(glsl::light_spot, 10), {0, 1, 0});
  constexpr int side = scene::LightTexture::side;
  scene::LightTexture texture;
  for (int i = 0; i < side * side; ++i)
    texture.texels.emplace_back((float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side, 1);
  scene.lightTextures.push_back(texture);
  const auto lit = [&](int of) {
    scene.lights[0].texture = of;
    const scene::Pose pose = scene::evaluate(scene, 0);
    const SceneElements elements(scene, pose, 0.2f, 1u << 20);
    SampleSolver solver(elements.surfels(), elements.forest(), elements.space(), elements.materials(), {});
    lightLeaves(elements, pose.lights, Curtain(-100), 16, solver);
    solver.reflect();
    std::vector<glm::vec3> sent;
    for (const uint32_t leaf : elements.forest().leafOf())
      sent.push_back(solver.unshot(leaf, elements.space().direction({0, 1, 0})));
    return sent;
  };
  const std::vector<glm::vec3> white = lit(scene::kNone), coloured = lit(0);
  const scene::Pose pose = scene::evaluate(scene, 0);
  const SceneElements elements(scene, pose, 0.2f, 1u << 20);
  int bright = 0;
  for (size_t i = 0; i < white.size(); ++i) {
    const glm::vec3 place(elements.leaves()[elements.forest().leafOf()[i]].position);
    const glm::vec3 wanted = white[i] * scene::lightTextureAt(scene, pose.lights[0], place);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(coloured[i][c], wanted[c], 1e-5f * white[i][c]);
    bright += white[i].x > 0 && std::abs(coloured[i].x - coloured[i].y) > 0.1f * white[i].x;
  }
  EXPECT_GT(bright, 10) << "colours differ from place to place";
}

TEST(LightSamplesTest, AFlatLightDoesNotLightItself) {
  glsl::Light light = rectangle(1);
  light.position = {0, 0, 0};
  light.flags = glsl::light_flag_geometry | glsl::light_flag_two_sided;
  light.own_instance = 3;
  const auto irradiance = [&](uint32_t instance) {
    LightAtPlace sum;
    addLight(light, {.position = {0, 0, 1e-3f}, .normal = {0, 0, -1}, .instance = instance}, Curtain(-100),
             16, sum);
    EXPECT_EQ(sum.incident.empty(), sum.irradiance == glm::vec3(0));
    return sum.irradiance;
  };
  EXPECT_EQ(irradiance(3), glm::vec3(0));
  EXPECT_GT(irradiance(2).x, 1);
  EXPECT_GT(irradiance(glsl::no_instance).x, 1);
}

/// Elements of a lamp lie on either side of it by rounding. What its light brings back to it comes off the
/// floor, which gets nothing that the lamp reflects.
TEST(LightSamplesTest, ElementsOfALampAreNotLitByIt) {
  for (const float tilt : {0.f, 0.3f, 1.1f}) {
    scene::Scene scene;
    test::show(scene, test::quad({0, -2, 0}, {8, 0, 0}, {0, 0, -8},
                                 test::addMaterial(scene, test::lambertian(0.5f))));
    scene::Material emissive = test::lambertian(0.5f);
    emissive.emission = glm::vec3(10);
    emissive.doubleSided = true;
    scene::Primitive lamp = test::quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}, test::addMaterial(scene, emissive));
    lamp.emissiveParts = {{{.sideU = {1, 0, 0}, .sideV = {0, 0, -1}}}};
    test::show(scene, lamp,
               glm::rotate(glm::translate(glm::mat4(1), {0.37f, 1.71f, -0.23f}), tilt, {0.6f, 0.3f, 0.8f}));
    const scene::Pose pose = scene::evaluate(scene, 0);
    ASSERT_EQ(pose.lights.size(), 1u);
    ASSERT_EQ(pose.lights[0].own_instance, 1u);
    const SceneElements elements(scene, pose, 0.05f, 1u << 20);
    SampleSolver solver(elements.surfels(), elements.forest(), elements.space(), elements.materials(), {});
    solver.begin();
    lightLeaves(elements, pose.lights, Curtain(-100), 16, solver);
    solver.reflect();
    solver.shoot(Curtain(-100));
    float floor = 0, own = 0;
    for (size_t i = 0; i < elements.surfels().size(); ++i) {
      const float irradiance = solver.irradiance()[elements.forest().leafOf()[i]].x;
      float& most = elements.surfels().objects[i] == 1 ? own : floor;
      most = std::max(most, irradiance);
    }
    EXPECT_EQ(floor, 0) << tilt;
    EXPECT_GT(own, 0.01f) << tilt;
  }
}

}  // namespace
}  // namespace limn::radiosity
