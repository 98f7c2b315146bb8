// Virtual point lights carry the flux that the scene reflects.
#include <gmock/gmock.h>

#include <numeric>

#include "core/indirect/virtual_lights.h"
#include "core/scene/material_model.h"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/materials/model.glsl"
#include "glsl/numeric/sampling.glsl"
#include "glsl/surface/brdf.glsl"
#include "tests/gpu/gl_test.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

using namespace limn::test;
using glm::vec3;

constexpr float kPi = glsl::pi;

struct Sampled {
  std::vector<glsl::VirtualPointLight> lights;
  vec3 flux{0};       ///< of the lights together
  vec3 reflected{0};  ///< by the maps
};

scene::Material lambert(vec3 albedo) {
  scene::Material m;
  m.baseColour = glm::vec4(albedo, 1);
  m.metallic = 0;
  m.specularFactor = 0;
  return m;
}

class VirtualLightTest : public OncePerRenderer<SharedProgramsTest> {
 protected:
  Sampled sample(const scene::Scene& scene, const scene::Pose& pose, const indirect::VirtualLightDesc& desc) {
    std::vector<uint32_t> all(pose.lights.size());
    std::iota(all.begin(), all.end(), 0u);
    scene::GpuScene gpuScene(device(), scene);
    gpuScene.update(pose, scene::frameBounds(pose.bounds), {64, 64}, 0);
    FrameServices services;
    services.add<shadow::ShadowMapService>(device(), gpuScene);
    auto& service = services.add<indirect::VirtualLightService>(scene);
    frame::ResourcePool pool(device());
    frame::FrameGraph graph;
    const SceneHandles handles = gpuScene.import(graph);
    const auto building = services.begin(graph, handles, pose);
    const indirect::VirtualLights made = service.request(all, desc);
    EXPECT_EQ(service.request(all, desc).lights, made.lights) << "made once whoever asks";
    graph.output(made.lights);
    graph.output(made.reflected);
    graph.prepare(device(), shaders(), pool);
    graph.execute();
    Sampled out;
    out.lights.resize(static_cast<size_t>(desc.count));
    graph.buffer(made.lights).read(0, out.lights.data(), out.lights.size() * sizeof(out.lights[0]));
    std::vector<glm::vec4> layers(static_cast<size_t>(made.maps.layers));
    graph.buffer(made.reflected).read(0, layers.data(), layers.size() * sizeof(layers[0]));
    for (const glm::vec4& layer : layers) out.reflected += vec3(layer);
    for (const glsl::VirtualPointLight& light : out.lights) {
      out.flux += vec3(light.flux);
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(vec3(light.flux), vec3(0))));
      EXPECT_NEAR(glm::length(light.normal), 1, 1e-4f);
      EXPECT_FALSE(glm::any(glm::isnan(light.position)));
    }
    gpuScene.forget();
    return out;
  }

  static void expectFlux(const Sampled& s, vec3 expected, float tolerance) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(s.reflected[c], expected[c], tolerance * expected[c]) << "maps, channel " << c;
      EXPECT_NEAR(s.flux[c], s.reflected[c], 1e-4f * s.reflected[c]) << "virtual lights, channel " << c;
    }
  }

  /// A box of side 2 that faces inwards.
  static void addBox(scene::Scene& scene, scene::Pose& pose, int material) {
    const int mesh = addMesh(scene, floorPrimitive(1, material));
    for (const auto& [angle, axis] :
         {std::pair(0.f, vec3(1, 0, 0)), std::pair(kPi, vec3(1, 0, 0)), std::pair(0.5f * kPi, vec3(1, 0, 0)),
          std::pair(-0.5f * kPi, vec3(1, 0, 0)), std::pair(0.5f * kPi, vec3(0, 0, 1)),
          std::pair(-0.5f * kPi, vec3(0, 0, 1))}) {
      const glm::mat4 turn = glm::rotate(glm::mat4(1), angle, axis);
      addInstance(scene, pose, mesh, turn * glm::translate(glm::mat4(1), {0, -1, 0}));
    }
  }
};

constexpr vec3 colour(0.2f, 0.5f, 0.8f);

TEST_F(VirtualLightTest, SpotOverAPlane) {
  for (const float scale : {1.f, 1e-4f, 1e4f}) {
    scene::Scene scene;
    addMesh(scene, floorPrimitive(20 * scale, addMaterial(scene, lambert(colour))));
    scene::Pose pose;
    addInstance(scene, pose, 0);
    glsl::Light light = spotLight(vec3(1, 3, 0.5f) * scale, {0.2f, -1, 0.1f}, 0.7f);
    light.emission = glm::vec3(5, 5, 5);
    addLight(pose, light);
    const float inner = light.cos_inner, outer = light.cos_outer;
    const float solid = 2 * kPi * (1 - inner + (inner - outer) / 3);
    const Sampled s = sample(scene, pose, {.count = 1000});
    expectFlux(s, colour * 5.f * solid, 0.01f);
    for (const glsl::VirtualPointLight& v : s.lights) {
      if (v.flux.x == 0) continue;
      EXPECT_NEAR(v.position.y / scale, 0, 1e-4f);
      EXPECT_NEAR(v.normal.y, 1, 1e-3f);
    }
  }
}

TEST_F(VirtualLightTest, PointLightInABox) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, pointLight({0.3f, -0.2f, 0.5f}));
  // A power of two, odd, fewer than the layers, and one.
  for (const int count : {1024, 777, 3, 1}) {
    SCOPED_TRACE(count);
    expectFlux(sample(scene, pose, {.count = count}), colour * 4.f * kPi, 0.01f);
  }
}

TEST_F(VirtualLightTest, StandForTheSurfacesThatTheLightSees) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, pointLight({0.3f, -0.2f, 0.5f}));
  const auto area = [&](int lightSamples) {
    double sum = 0;
    const Sampled s = sample(scene, pose, {.count = 4096, .lightSamples = lightSamples});
    for (const glsl::VirtualPointLight& light : s.lights) sum += light.area;
    return sum;
  };
  EXPECT_NEAR(area(1), 6 * 4, 0.02 * 6 * 4);
  // All points on a light see the same walls.
  pose.lights = {rectangleLight({0, 0, 0}, {0, -1, 0}, 0.5f, 0.25f, true)};
  for (const int lightSamples : {1, 16}) EXPECT_NEAR(area(lightSamples), 6 * 4, 0.02 * 6 * 4) << lightSamples;
}

TEST_F(VirtualLightTest, LightsThatSeeOnlyBackFacesReflectNothing) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, spherePrimitive(1, addMaterial(scene, lambert(colour))));
  addInstance(scene, pose, 0);
  addLight(pose, pointLight({0, 0, 0}));
  EXPECT_EQ(sample(scene, pose, {.count = 100}).flux, vec3(0));
  scene.materials[0].doubleSided = true;
  expectFlux(sample(scene, pose, {.count = 100}), colour * 4.f * kPi, 0.01f);
}

TEST_F(VirtualLightTest, ParallelLightOnAPlane) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0.3f, -1, 0.2f}, 0.02f));
  const float cosine = 1 / glm::length(vec3(0.3f, -1, 0.2f));
  expectFlux(sample(scene, pose, {.count = 500}), colour * 16.f * cosine, 0.01f);
  expectFlux(sample(scene, pose, {.count = 500, .lightSamples = 4}), colour * 16.f * cosine, 0.01f);
}

/// Half a radian to all sides: points on the disc shine along directions whose mean cosine is 0.94, and give
/// a floor that faces the disc its irradiance together. 16 points of the sequence have that mean to a
/// thousandth.
TEST_F(VirtualLightTest, AWideDiscGivesItsIrradiance) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0, -1, 0}, 1));
  for (const int samples : {1, 16})
    expectFlux(sample(scene, pose, {.count = 500, .lightSamples = samples}), colour * 16.f, 0.01f);
}

/// The upper face of a cube around the receivers, with the irradiance 1 on what is perpendicular to each of
/// its directions: pi F over its solid angle of 2 pi / 3 on a floor (tests/unit/glsl/virtual_light_test.cpp
/// has F), 0.83. As one direction it would give 1.
TEST_F(VirtualLightTest, ADistantRectangleIsNoDirection) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  glsl::Light light = directionalLight({0, -1, 0}, 0);
  light.position = {0, 1, 0};
  light.length_u = light.length_v = 2;
  light.flags = glsl::light_flag_environment;
  light.solid_angle = 2 * kPi / 3;
  addLight(pose, light);
  const float given = 6 / kPi * std::sqrt(0.5f) * std::atan(std::sqrt(0.5f));
  expectFlux(sample(scene, pose, {.count = 500}), colour * (16 * given), 0.01f);
}

/// Light of a narrow spot is as long on its way as the spot hangs high, to 0.13 %: T = exp(-sigma h) in each
/// channel. Nothing but the medium differs, so that texels and their rounding are the same.
TEST_F(VirtualLightTest, TheMediumTakesOfTheLightOnItsWay) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(colour))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, spotLight({0, 1, 0}, {0, -1, 0}, 0.05f));
  const vec3 clear = sample(scene, pose, {.count = 64}).reflected;
  scene.medium.sigmaA = {0.7f, 0.2f, 0};
  scene.medium.sigmaS = {0.3f, 0, 0};
  for (const int sets : {1, 4}) {
    const Sampled s = sample(scene, pose, {.count = 64, .sets = sets});
    expectFlux(s, clear * vec3(std::exp(-1.f), std::exp(-0.2f), 1), 0.005f);
  }
}

/// A floor that is black around a small square in its middle, above which the medium's ball, the floor's
/// bounding sphere, reaches up by its radius r: parallel light is taken from there on. The square lies 0.01 m
/// above the ball's plane and is 0.14 m wide to its corners: of sigma = 0.5 that is 0.4 %.
TEST_F(VirtualLightTest, ParallelLightIsTakenFromWhereItEntersTheMedium) {
  scene::Scene scene;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, lambert(vec3(0)))));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addInstance(scene, pose, addMesh(scene, floorPrimitive(0.1f, addMaterial(scene, lambert(colour)))),
              at(0, 0.01f, 0));
  addLight(pose, directionalLight({0, -1, 0}, 0));
  const vec3 clear = sample(scene, pose, {.count = 64}).reflected;
  ASSERT_GT(clear.x, 0);
  scene.medium.sigmaA = {0.5f, 0.25f, 0};
  const float r = pose.bounds.radius();
  const vec3 expected = clear * vec3(std::exp(-0.5f * r), std::exp(-0.25f * r), 1);
  const vec3 found = sample(scene, pose, {.count = 64}).reflected;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.01f * expected[c]) << c;
}

TEST_F(VirtualLightTest, RectanglesOneAndTwoSided) {
  for (const bool twoSided : {false, true}) {
    scene::Scene scene;
    scene::Pose pose;
    addBox(scene, pose, addMaterial(scene, lambert(colour)));
    addLight(pose, rectangleLight({0, 0.5f, 0}, {0, -1, 0}, 0.5f, 0.25f, twoSided));
    const vec3 expected = colour * (kPi * 0.125f * (twoSided ? 2.f : 1.f));
    for (const int samples : {1, 5})
      expectFlux(sample(scene, pose, {.count = 300, .lightSamples = samples}), expected, 0.01f);
  }
}

/// A square of 2 m, half a metre above the floor: what the square below it gets is exact, which points of the
/// light's intensity would miss by far.
TEST_F(VirtualLightTest, ALargeRectangleIsNoPoint) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(20, addMaterial(scene, lambert(colour))));
  addInstance(scene, pose, 0);
  const glsl::Light light = rectangleLight({0, 0.5f, 0}, {0, -1, 0}, 2, 2, false);
  addLight(pose, light);
  constexpr int side = 200;
  double below = 0, asPoint = 0;
  for (int i = 0; i < side * side; ++i) {
    const glm::vec2 u = 2.f * glsl::grid_point(i, side) - 1.f;
    const vec3 p(u.x, 0, u.y);
    below += glsl::rectangle_irradiance(glsl::rectangle_from(light, p), {0, 1, 0});
    const double d2 = glm::dot(p, p) + 0.25;
    asPoint += 4 * 0.25 / (d2 * d2);
  }
  below *= 4.0 / (side * side);
  asPoint *= 4.0 / (side * side);
  ASSERT_GT(asPoint, 1.3 * below);
  for (const int samples : {1, 4}) {
    const Sampled s = sample(scene, pose, {.count = 8192, .mapSize = 512, .lightSamples = samples});
    expectFlux(s, colour * (4 * kPi), 0.01f);
    double found = 0;
    for (const glsl::VirtualPointLight& v : s.lights)
      if (std::abs(v.position.x) < 1 && std::abs(v.position.z) < 1) found += v.flux.x;
    EXPECT_NEAR(found, colour.x * below, 0.02 * colour.x * below) << samples << " samples";
  }
}

/// Irradiance at points on the walls of a box, in which nothing hides anything: few virtual lights for each
/// map of a light that is drawn from many points are no reason for more noise.
TEST_F(VirtualLightTest, PointsOfOneLightAddLittleNoise) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, rectangleLight({0.1f, 0.8f, -0.2f}, {0, -1, 0}, 0.5f, 0.4f, false));
  std::vector<std::pair<vec3, vec3>> receivers;  // points and normals
  for (const auto& [axis, wall] :
       {std::pair(0, -1.f), std::pair(0, 1.f), std::pair(1, -1.f), std::pair(2, -1.f)})
    for (int i = 0; i < 10 * 10; ++i) {
      const glm::vec2 u = 2.f * glsl::grid_point(i, 10) - 1.f;
      vec3 point(0), normal(0);
      point[axis] = wall;
      normal[axis] = -wall;
      point[(axis + 1) % 3] = u.x;
      point[(axis + 2) % 3] = u.y;
      receivers.emplace_back(point, normal);
    }
  const auto irradiance = [&](const indirect::VirtualLightDesc& desc) {
    std::vector<double> out;
    const Sampled s = sample(scene, pose, desc);
    for (const auto& [point, normal] : receivers) {
      double sum = 0;
      for (const glsl::VirtualPointLight& light : s.lights) {
        const vec3 to = light.position - point;
        const float d2 = glm::dot(to, to);
        if (d2 > 0)
          sum += light.flux.x / kPi * std::max(glm::dot(normal, to), 0.f) *
                 std::max(-glm::dot(light.normal, to), 0.f) / (d2 * std::max(d2, 0.01f));
      }
      out.push_back(sum);
    }
    return out;
  };
  const std::vector<double> expected = irradiance({.count = 16384});
  const auto error = [&](int count, int lightSamples) {
    const std::vector<double> found = irradiance({.count = count, .lightSamples = lightSamples});
    double sum = 0;
    for (size_t i = 0; i < found.size(); ++i) sum += (found[i] - expected[i]) * (found[i] - expected[i]);
    return std::sqrt(sum / std::inner_product(expected.begin(), expected.end(), expected.begin(), 0.0));
  };
  for (const int count : {256, 1024}) {
    const double one = error(count, 1);
    for (const int lightSamples : {16, 64})
      EXPECT_LT(error(count, lightSamples), 1.4 * one)
          << count << " virtual lights, " << lightSamples << " points";
  }
}

TEST_F(VirtualLightTest, SeveralLightsShareThemByFlux) {
  scene::Scene scene;
  scene::Pose pose;
  addBox(scene, pose, addMaterial(scene, lambert(colour)));
  addLight(pose, pointLight({0.3f, -0.2f, 0.5f}));
  glsl::Light strong = spotLight({0, 0.5f, 0}, {0, -1, 0}, 0.5f);
  strong.emission = glm::vec3(0, 100, 0);
  addLight(pose, strong);
  glsl::Light dark = pointLight({0, 0, 0});
  dark.emission = glm::vec3(0);
  addLight(pose, dark);
  const float solid = 2 * kPi * (1 - strong.cos_inner + (strong.cos_inner - strong.cos_outer) / 3);
  const vec3 fromStrong = colour * vec3(0, 100, 0) * solid, fromPoint = colour * 4.f * kPi;
  const Sampled s = sample(scene, pose, {.count = 900});
  expectFlux(s, fromPoint + fromStrong, 0.01f);
  int green = 0;
  for (const glsl::VirtualPointLight& v : s.lights) green += v.flux.x == 0 && v.flux.y >= 0;
  const float share = (fromStrong.y) / (fromStrong.y + fromPoint.x + fromPoint.y + fromPoint.z);
  EXPECT_NEAR(static_cast<float>(green) / 900, share, 0.03f);
  expectFlux(sample(scene, pose, {.count = 2}), fromPoint + fromStrong, 0.01f);
}

/// Half of a floor reflects a channel whose mean over the map is below the least float where that of the one
/// sample, if it falls on that half, is not.
TEST_F(VirtualLightTest, ChannelsTooWeakForASumAreLost) {
  for (const float red : {-0.1f, 0.1f}) {
    scene::Scene scene;
    scene::Pose pose;
    addMesh(scene, floorPrimitive(0.1f, addMaterial(scene, lambert({1, 1, 0}))));
    addMesh(scene, floorPrimitive(0.1f, addMaterial(scene, lambert({0, 1, 0}))));
    addInstance(scene, pose, 0, at(red, 0, 0));
    addInstance(scene, pose, 1, at(-red, 0, 0));
    glsl::Light light = directionalLight({0, -1, 0}, 0);
    for (float weak = 1e-36f; weak > 2e-38f; weak *= 0.7f) {
      light.emission = vec3(weak, 1, 0);
      pose.lights.clear();
      pose.lightNames.clear();
      addLight(pose, light);
      EXPECT_GT(sample(scene, pose, {.count = 1, .mapSize = 16}).flux.y, 0) << weak;
    }
  }
}

TEST_F(VirtualLightTest, NothingToLightIsHarmless) {
  scene::Scene scene;
  scene::Pose pose;
  addMesh(scene, floorPrimitive(1, addMaterial(scene, lambert(colour))));
  addInstance(scene, pose, 0);
  addLight(pose, spotLight({0, 2, 0}, {0, 1, 0}, 0.5f));
  EXPECT_EQ(sample(scene, pose, {.count = 64}).flux, vec3(0));
}

/// Fresnel's layer takes its part: the diffuse reflectance of the BRDF itself, integrated.
TEST_F(VirtualLightTest, AlbedoIsTheDiffusePartOfTheBrdf) {
  scene::Scene scene;
  scene::Material material = lambert(colour);
  material.specularFactor = 1;
  material.metallic = 0.25f;
  material.roughness = 0.4f;
  addMesh(scene, floorPrimitive(2, addMaterial(scene, material)));
  scene::Pose pose;
  addInstance(scene, pose, 0);
  const vec3 towards = glm::normalize(vec3(-0.8f, 1, 0.3f));
  addLight(pose, directionalLight(-towards, 0));
  const glsl::SurfaceBrdf s = glsl::surface_brdf(colour, 0.25f, 0.4f, 1, vec3(1), 1.5f);
  double weight = 0;
  constexpr int side = 300;
  const vec3 up(0, 0, 1), l(std::sqrt(1 - towards.y * towards.y), 0, towards.y);
  for (int i = 0; i < side * side; ++i) {
    const vec3 v = glsl::sample_cosine({(i % side + 0.5f) / side, (i / side + 0.5f) / side});
    weight += glsl::brdf_diffuse_weight(s, glsl::half_vector(up, v, l).v_dot_h);
  }
  weight /= side * side;
  expectFlux(sample(scene, pose, {.count = 128}), s.diffuse * 16.f * towards.y * static_cast<float>(weight),
             0.01f);
}

/// Vertices have colours for metallic-roughness; a model's are its own.
TEST_F(VirtualLightTest, AModelReflectsItsAlbedoWhateverColoursVerticesHave) {
  glsl::MaterialModel matte{};
  matte.kind = glsl::model_phong;
  matte.exponent = 1;
  matte.kd = colour;
  scene::Scene scene;
  scene::Material material = lambert(vec3(1));
  scene::setModel(material, matte);
  scene::Primitive floor = floorPrimitive(2, addMaterial(scene, material));
  floor.colours.assign(floor.positions.size(), glm::vec4(0.1f, 0.2f, 0.3f, 1));
  addMesh(scene, floor);
  scene::Pose pose;
  addInstance(scene, pose, 0);
  addLight(pose, directionalLight({0, -1, 0}, 0));
  expectFlux(sample(scene, pose, {.count = 128}), colour * 16.f, 0.01f);
}

}  // namespace
}  // namespace limn
