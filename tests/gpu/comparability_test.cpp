// The GPU picture and the CPU reference answer the same question: same surfaces seen, same textures, normals,
// emission and background, same unshadowed light.
#include "tests/gpu/comparability.h"

#include <cstdlib>
#include <glm/gtc/quaternion.hpp>

#include "core/brdf/groove.h"
#include "core/brdf/measured_model.h"
#include "core/scene/camera.h"
#include "core/scene/material_model.h"
#include "core/scene/mip_chain.h"
#include "tests/gpu/render_test.h"
#include "tests/support/material_models.h"
#include "tests/support/test_scenes.h"

namespace limn {
namespace {

constexpr float kDegree = glsl::pi / 180;

struct Bound {
  double maskedShare = 0.005, albedo = 1.0 / 255, normalMedian = 0.1;  // degrees
};

void expectSameSurfaces(const test::Pair& pair, const Bound& bound = {}) {
  const test::Agreement found = test::agreement(pair.image, pair.reference);
  EXPECT_GT(found.covered, pair.image.pixelCount() / 50) << "nothing to compare";
  EXPECT_LT(found.maskedShare, bound.maskedShare);
  EXPECT_LT(found.albedo, bound.albedo);
  EXPECT_LT(found.normalMedian, bound.normalMedian);
  EXPECT_EQ(found.backgroundShare, 0) << "background pixels whose channels differ";
}

/// Mean absolute difference over the mean of the reference, of R, G, B where both see the same surface
/// (`covered`) or none.
double lightDifference(const test::Pair& pair, bool covered) {
  double difference = 0, sum = 0;
  const int coverage[2] = {pair.image.channel("coverage"), pair.reference.channel("coverage")};
  const int id[2] = {pair.image.channel("id"), pair.reference.channel("id")};
  for (int y = 0; y < pair.image.height(); ++y) {
    for (int x = 0; x < pair.image.width(); ++x) {
      const bool here = pair.reference.at(x, y, coverage[1]) > 0.5f;
      if (here != covered || (pair.image.at(x, y, coverage[0]) > 0.5f) != here) continue;
      if (pair.image.at(x, y, id[0]) != pair.reference.at(x, y, id[1])) continue;
      for (int c = 0; c < 3; ++c) {
        difference += std::abs(double(pair.image.at(x, y, c)) - pair.reference.at(x, y, c));
        sum += pair.reference.at(x, y, c);
      }
    }
  }
  EXPECT_GT(sum, 0) << "all black";
  return sum > 0 ? difference / sum : 1;
}

/// A texture of smooth bumps and hard edges, different in every channel.
scene::TextureImage patternImage(bool srgb, int width, int height, bool normals = false) {
  scene::TextureImage image;
  image.name = "pattern";
  image.srgb = srgb;
  scene::TextureImage::Level level{width, height, {}};
  const auto byte = [](float v) { return static_cast<uint8_t>(std::lround(255 * std::clamp(v, 0.f, 1.f))); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float s = std::sin(0.7f * static_cast<float>(x)), t = std::cos(0.5f * static_cast<float>(y));
      const bool tile = ((x / 8) + (y / 8)) % 2 != 0;
      const glm::vec3 n = glm::normalize(glm::vec3(0.5f * s, 0.4f * t, 1.f));
      const glm::vec3 colour =
          normals ? 0.5f * n + 0.5f : glm::vec3(tile ? 0.8f : 0.2f, 0.5f + 0.4f * s, 0.5f - 0.3f * t);
      for (int c = 0; c < 3; ++c) level.rgba.push_back(byte(colour[c]));
      level.rgba.push_back(byte(tile ? 1.f : 0.3f));
    }
  }
  image.levels.push_back(std::move(level));
  scene::buildMipChain(image);
  return image;
}

int addNode(scene::Scene& scene, int mesh, const scene::Transform& transform) {
  scene::Node node;
  node.mesh = mesh;
  node.transform = transform;
  scene.nodes.push_back(node);
  return static_cast<int>(scene.nodes.size()) - 1;
}

/// Spots: cone from 0.2 to 0.6 rad.
scene::LightSource light(uint32_t type, float intensity, float range = 0, float angle = 0) {
  scene::LightSource source;
  source.type = type;
  source.intensity = intensity;
  source.range = range;
  source.innerCone = 0.2f;
  source.outerCone = 0.6f;
  source.angle = angle;
  return source;
}

void addLight(scene::Scene& scene, const scene::LightSource& source, const glm::vec3& position,
              const glm::vec3& direction, glm::vec2 area = {0, 0}) {
  const int node = addNode(
      scene, scene::kNone,
      {.translation = position, .rotation = glm::quatLookAt(glm::normalize(direction), glm::vec3(0, 0, 1))});
  scene.nodes[static_cast<size_t>(node)].light = static_cast<int>(scene.lights.size());
  scene.nodes[static_cast<size_t>(node)].limnArea = area;
  scene.lights.push_back(source);
}

/// Sheets and spheres with every kind of texture, wrap mode, mirroring, cut-out and vertex colour, none
/// touching another.
scene::Scene texturedScene() {
  scene::Scene scene;
  scene.images = {patternImage(true, 64, 64), patternImage(false, 32, 64, true), patternImage(false, 33, 17)};
  scene::Material material;
  material.baseColourTexture = {0, scene::Wrap::repeat, scene::Wrap::mirror};
  material.normalTexture = {1, scene::Wrap::mirror, scene::Wrap::repeat};
  material.normalScale = 0.8f;
  material.metalRoughTexture = {2, scene::Wrap::clamp, scene::Wrap::clamp};
  const int plain = test::addMaterial(scene, material);
  material.doubleSided = true;
  material.emission = glm::vec3(2, 1, 0.5f);
  material.emissiveTexture = {0, scene::Wrap::mirror, scene::Wrap::clamp};
  const int twoSided = test::addMaterial(scene, material);
  material.alphaCutoff = 0.5f;
  material.emission = glm::vec3(0);
  const int cutOut = test::addMaterial(scene, material);

  scene::Primitive sheet = test::floorPrimitive(1, plain);
  for (glm::vec2& uv : sheet.uvs) uv = 3.f * uv - glm::vec2(0.7f, 1.3f);
  scene::Primitive ball = test::spherePrimitive(0.8f, plain, 24);
  for (size_t i = 0; i < ball.positions.size(); ++i) {
    ball.uvs[i] = glm::vec2(4, 2) * ball.uvs[i];
    const glm::vec3 p = ball.normals[i];
    ball.tangents.emplace_back(glm::normalize(glm::vec3(p.z, 0, -p.x) + glm::vec3(1e-6f, 0, 0)), 1.f);
    ball.colours.emplace_back(0.5f + 0.5f * p.x, 1.f, 0.6f, 1.f);
  }
  const auto mesh = [&](scene::Primitive primitive, int of) {
    primitive.material = of;
    return test::addMesh(scene, std::move(primitive));
  };
  const glm::quat upright = glm::angleAxis(70 * kDegree, glm::vec3(1, 0, 0));
  const glm::quat away = glm::angleAxis(-110 * kDegree, glm::vec3(1, 0, 0));
  addNode(scene, mesh(sheet, plain), {.translation = {-2.2f, 0, 0}, .rotation = upright});
  addNode(scene, mesh(sheet, plain), {.translation = {0, 0, 0}, .rotation = away});  // culled: shows its back
  addNode(scene, mesh(sheet, twoSided), {.translation = {2.2f, 0, 0}, .rotation = away});
  addNode(scene, mesh(sheet, cutOut),
          {.translation = {0, 2.3f, -1}, .rotation = upright, .scale = {1, 1, -1}});
  addNode(scene, mesh(ball, plain), {.translation = {-2.2f, -2.2f, 0}, .scale = {-1, 1, 1}});
  addNode(scene, mesh(ball, plain), {.translation = {0, -2.2f, 0}, .scale = {1.2f, 0.5f, 0.8f}});
  addNode(scene, mesh(ball, twoSided), {.translation = {2.2f, -2.2f, 0}, .scale = {1, -1, 1}});
  scene::Primitive floor = test::floorPrimitive(30, plain);
  for (glm::vec2& uv : floor.uvs) uv *= 40.f;
  addNode(scene, mesh(floor, plain), {.translation = {0, -3.5f, 0}});
  return scene;
}

/// The same, with height maps, repeated and clamped, in place of the normal map.
scene::Scene bumpyScene() {
  scene::Scene scene = texturedScene();
  constexpr glm::ivec2 size(33, 64);
  std::vector<float> values;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::vec2 p = 2 * glsl::pi * glm::vec2(x, y) / glm::vec2(size);
      values.push_back(0.5f * std::sin(2 * p.x) * std::cos(3 * p.y) + 0.3f * std::cos(p.x + p.y));
    }
  for (const relief::Wrap wrap : {relief::Wrap::periodic, relief::Wrap::clamped})
    scene.heights.emplace_back(size, values, glm::dvec2(1, 1.5), 0.08, 0, wrap);
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    scene.materials[i].normalTexture = {};
    scene.materials[i].height = static_cast<int>(i % scene.heights.size());
  }
  return scene;
}

/// A sky with a gradient and a soft sun.
scene::Environment sky() {
  scene::Environment environment;
  environment.width = 64;
  environment.height = 32;
  for (int y = 0; y < environment.height; ++y) {
    for (int x = 0; x < environment.width; ++x) {
      const float up = 1 - static_cast<float>(y) / 16,
                  sun = std::exp(-0.05f * static_cast<float>((x - 20) * (x - 20) + (y - 9) * (y - 9)));
      environment.texels.push_back(glm::vec3(0.6f + 0.2f * up, 0.6f, 0.7f + 0.3f * up) + 5.f * sun);
    }
  }
  environment.rotation = 0.4f;
  environment.scale = 1.5f;
  return environment;
}

class ComparabilityTest : public RenderTest {
 protected:
  test::Pair both(const scene::Scene& scene, const scene::CameraPose& camera, glm::ivec2 size, Term term,
                  int spp = 2, double time = 0, int animation = scene::kNone) {
    return test::renderBoth(device(), scene, scene::evaluate(scene, time, animation), camera, size, term, spp,
                            time, animation);
  }

  /// Direct light on one plane and nothing else: there is no shadow to differ in.
  double planeDifference(const scene::LightSource& source, const glm::vec3& position, glm::vec2 area, int spp,
                         scene::Material material = {}, std::vector<glm::vec3> measured = {}) {
    scene::Scene scene;
    scene.measured = std::move(measured);
    if (material.specularFactor == 1 && material.roughness == 1) {
      material.metallic = 0;
      material.specularFactor = 0;
      material.baseColour = {0.7f, 0.5f, 0.3f, 1};
    }
    addNode(scene, test::addMesh(scene, test::floorPrimitive(3, test::addMaterial(scene, material))), {});
    addLight(scene, source, position, -position, area);
    const auto camera = scene::lookAt({0.5f, 2.5f, 4}, {0, 0, 0}, 0.7f);
    return lightDifference(both(scene, camera, {48, 36}, Term::direct, spp), true);
  }
};

TEST_F(ComparabilityTest, SeesTheSameSurfacesInEveryAsset) {
  for (const char* name : {"atrium", "balls", "bump_sphere", "bump_wall", "cornell_box", "foliage_card",
                           "lights", "plant", "robot", "statue", "teapot", "white_furnace"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = asset(name);
    const double time = 0.7;
    Bound bound;
    if (std::string(name) == "plant" || std::string(name) == "foliage_card") bound.maskedShare = 0.02;
    expectSameSurfaces(
        both(scene, scene::evaluate(scene, time).cameras.at(0), {160, 120}, Term::final, 2, time), bound);
  }
}

TEST_F(ComparabilityTest, TexturesNormalMapsMirroringCutOutsAndVertexColoursAgree) {
  const scene::Scene scene = texturedScene();
  const test::Pair pair =
      both(scene, scene::lookAt({0.7f, 0.6f, 9}, {0, -0.4f, 0}, 0.8f), {192, 144}, Term::final);
  expectSameSurfaces(pair, {.maskedShare = 0.01});
  // A GPU filters textures of 8 bits with weights of 8 bits.
  EXPECT_LT(lightDifference(pair, true), device().software() ? 2e-3 : 4e-3) << "emission";
}

TEST_F(ComparabilityTest, HeightMapsAgreeMirroredMinifiedAndAtTheirEdges) {
  const scene::Scene scene = bumpyScene();
  const auto camera = scene::lookAt({0.7f, 0.6f, 9}, {0, -0.4f, 0}, 0.8f);
  expectSameSurfaces(both(scene, camera, {192, 144}, Term::final), {.maskedShare = 0.01});
  scene::Scene flat = bumpyScene();
  for (scene::Material& material : flat.materials) material.height = scene::kNone;
  const test::Pair bumpy = both(scene, camera, {48, 36}, Term::final);
  const test::Pair plain = both(flat, camera, {48, 36}, Term::final);
  EXPECT_GT(test::agreement(bumpy.image, plain.reference).normalTail, 5) << "degrees";
  EXPECT_GT(test::agreement(plain.image, bumpy.reference).normalTail, 5) << "degrees";
}

/// A sphere that has more and more triangles.
class Refining : public scene::GeometrySource {
 public:
  std::shared_ptr<const scene::Primitive> at(double time) override {
    const int rings = 6 + static_cast<int>(10 * time);
    if (rings != rings_) sphere_ = std::make_shared<scene::Primitive>(test::spherePrimitive(1, 0, rings));
    rings_ = rings;
    return sphere_;
  }

 private:
  int rings_ = 0;
  std::shared_ptr<const scene::Primitive> sphere_;
};

TEST_F(ComparabilityTest, GeometryOfASourceIsTheSameForBothWhoeverAsksFirst) {
  scene::Scene scene;
  scene::Material material;
  material.baseColour = {0.7f, 0.5f, 0.3f, 1};
  const int paint = test::addMaterial(scene, material);
  addNode(scene, test::addMesh(scene, test::floorPrimitive(3, paint)), {});
  scene.dynamic.push_back({"refining", std::make_shared<Refining>(), paint});
  addLight(scene, light(glsl::light_point, 20), {1, 3, 1}, {-1, -3, -1}, {});
  const auto camera = scene::lookAt({0.5f, 2.5f, 4}, {0, 0, 0}, 0.7f);
  Image last;
  for (const double time : {0.0, 2.0, 0.5}) {
    const test::Pair pair = both(scene, camera, {96, 72}, Term::direct, 2, time);
    expectSameSurfaces(pair);
    if (last.width() > 0) {
      EXPECT_FALSE(std::ranges::equal(last.data(), pair.image.data())) << "nothing changed";
    }
    last = pair.image;
  }
}

TEST_F(ComparabilityTest, BackgroundAgrees) {
  scene::Scene scene = texturedScene();
  scene.environment = sky();
  const test::Pair pair =
      both(scene, scene::lookAt({0.7f, -1, 9}, {0, 1.5f, 0}, 1.2f), {128, 96}, Term::final);
  EXPECT_LT(lightDifference(pair, false), 1e-3);
}

TEST_F(ComparabilityTest, PunctualLightsOnAPlaneAgree) {
  EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {}, 2), 0.01);
  EXPECT_LT(planeDifference(light(glsl::light_point, 20, 4), {0.5f, 2, 0.3f}, {}, 2), 0.01);
  EXPECT_LT(planeDifference(light(glsl::light_spot, 20), {1, 2, 0.3f}, {}, 2), 0.01);
  EXPECT_LT(planeDifference(light(glsl::light_directional, 3), {1, 2, 1}, {}, 2), 0.01);
  EXPECT_LT(planeDifference(light(glsl::light_directional, 3, 0, 0.03f), {1, 2, 1}, {}, 256), 0.01);
}

TEST_F(ComparabilityTest, RectanglesOnAPlaneAgree) {
  EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {1.5f, 0.8f}, 1024), 0.01);
  EXPECT_LT(planeDifference(light(glsl::light_spot, 20), {1, 2, 0.3f}, {0.5f, 0.8f}, 1024), 0.01);
}

TEST_F(ComparabilityTest, GlossyPlanesAgree) {
  scene::Material material;
  material.baseColour = {0.7f, 0.5f, 0.3f, 1};
  material.metallic = 0.3f;
  material.roughness = 0.4f;
  EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {}, 2, material), 0.01);
  // Linearly transformed cosines: their fit, not the geometry, is what differs.
  EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {1.5f, 0.8f}, 1024, material),
            0.03);
}

TEST_F(ComparabilityTest, MaterialModelsOnAPlaneAgree) {
  for (const test::NamedModel& named : test::materialModels()) {
    SCOPED_TRACE(named.name);
    scene::Material material;
    scene::setModel(material, named.model);
    EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {}, 2, material), 0.01);
    EXPECT_LT(planeDifference(light(glsl::light_directional, 3), {1, 2, 1}, {}, 2, material), 0.01);
    // 16 points stand for the rectangle.
    EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {0.4f, 0.3f}, 1024, material),
              0.02);
  }
}

TEST_F(ComparabilityTest, MeasuredMaterialsOnAPlaneAgree) {
  const brdf::BrdfFunction lobe = [](const glm::vec3& l, const glm::vec3& v) {
    return glm::vec3(0.1f, 0.05f, 0.02f) + 0.3f * std::pow(glm::normalize(l + v).z, 20.f);
  };
  const brdf::TabulatedBrdf isotropic = brdf::tabulate({30, 20, 20}, lobe);
  const brdf::AnisotropicTable grooves = brdf::GrooveBrdf(brdf::Groove{}).table(8);
  const auto expectSame = [&](const auto& table) {
    glsl::MaterialModel model = brdf::measuredModel(table).model;
    model.table = 3;  // a table begins where another one ends
    std::vector<glm::vec3> values(3, glm::vec3(9));
    values.insert(values.end(), table.values.begin(), table.values.end());
    scene::Material material;
    scene::setModel(material, model);
    EXPECT_LT(planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {}, 2, material, values), 0.01);
    EXPECT_LT(
        planeDifference(light(glsl::light_point, 20), {0.5f, 2, 0.3f}, {0.4f, 0.3f}, 1024, material, values),
        0.02);
  };
  expectSame(isotropic);
  expectSame(grooves);
}

TEST_F(ComparabilityTest, LightOfTheEnvironmentOnConvexBodiesAgrees) {
  const scene::Scene furnace = asset("white_furnace");
  EXPECT_LT(lightDifference(
                both(furnace, scene::evaluate(furnace, 0).cameras.at(0), {64, 48}, Term::direct, 256), true),
            0.01);
  scene::Scene scene;
  scene.environment = sky();
  scene::Material lambert;
  lambert.metallic = 0;
  lambert.specularFactor = 0;
  addNode(scene, test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene, lambert))), {});
  const auto camera = scene::lookAt({0.5f, 1, 3}, {0, 0, 0}, 0.8f);
  EXPECT_LT(lightDifference(both(scene, camera, {64, 48}, Term::direct, 1024), true), 0.01);
}

TEST_F(ComparabilityTest, SpecularSurfacesShowTheSameEnvironment) {
  for (const bool glass : {false, true}) {
    SCOPED_TRACE(glass ? "glass" : "mirror");
    scene::Scene scene;
    scene.environment = sky();
    scene::Material material;
    material.roughness = 0;
    material.metallic = glass ? 0.f : 1.f;
    material.transmission = glass ? 1.f : 0.f;
    material.thickness = glass ? 0.5f : 0.f;
    material.baseColour = {0.9f, 0.7f, 0.5f, 1};
    addNode(scene, test::addMesh(scene, test::spherePrimitive(1, test::addMaterial(scene, material))), {});
    const auto camera = scene::lookAt({0.5f, 1, 3}, {0, 0, 0}, 0.8f);
    EXPECT_LT(lightDifference(both(scene, camera, {96, 72}, Term::final, 2), true), 0.01);
  }
}

/// KHR_materials_volume: a body whose node makes it four times as large is four times as thick.
TEST_F(ComparabilityTest, ThicknessIsInTheSpaceOfTheMesh) {
  const auto seen = [&](float scale) {
    scene::Scene scene;
    scene.environment = sky();
    scene::Material glass;
    glass.roughness = 0;
    glass.metallic = 0;
    glass.transmission = 1;
    glass.thickness = 1 / scale;
    glass.attenuationDistance = 1;
    glass.attenuationColour = {0.9f, 0.3f, 0.1f};
    const int ball = test::addMesh(scene, test::spherePrimitive(1 / scale, test::addMaterial(scene, glass)));
    addNode(scene, ball, {.scale = glm::vec3(scale)});
    return both(scene, scene::lookAt({0.5f, 1, 3}, {0, 0, 0}, 0.8f), {48, 36}, Term::final, 2);
  };
  const test::Pair whole = seen(1), scaled = seen(4);
  EXPECT_LT(lightDifference(scaled, true), 0.01);
  EXPECT_LT(lightDifference({scaled.image, whole.reference}, true), 0.01);
}

/// Models that are not limn's: LIMN_MODELS names a folder of .glb files.
TEST_F(ComparabilityTest, SeesTheSameSurfacesInOutsideModels) {
  const char* folder = std::getenv("LIMN_MODELS");
  if (!folder) GTEST_SKIP() << "LIMN_MODELS names no folder of .glb files";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const scene::Scene scene = scene::load(entry.path());
    const double time = 0.7;
    const scene::Pose pose = scene::evaluate(scene, time);
    const auto camera = pose.cameras.empty() ? scene::frameBounds(pose.bounds) : pose.cameras.front();
    const test::Pair pair = test::renderBoth(device(), scene, pose, camera, {128, 96}, Term::final, 2, time);
    expectSameSurfaces(pair);
  }
}

}  // namespace
}  // namespace limn
